// SPDX-License-Identifier: BSD-3-Clause
// margins.h
#include "internal/margins.h"
#include "control.h"
#include "descriptions.h"
#include "internal/control.h"

using Rig = Described<nt_rig>;
using Settings = Described<nt_settings>;

static py::dict margins(const Rig &rig, const Settings &settings, double stiffness, const std::string &mode)
{
    nt_margins m;
    const nt_verdict verdict = nt_margins_judge(&rig.value, &settings.value, stiffness, mode_of(mode), &m);
    const nt_servo_equivalent equivalent = nt_servo_equivalent_of(&rig.value, &settings.value, stiffness);
    py::dict out;
    out["loop_stiffness"] = m.loop_stiffness;
    out["loop_delay"] = m.loop_delay;
    out["stability_limit"] = m.stability_limit;
    out["margin"] = m.margin;
    out["pad_limit"] = m.pad_limit;
    out["mass_limit"] = m.mass_limit;
    out["quantisation_step"] = m.quantisation_step;
    out["force_noise"] = m.force_noise;
    out["height_margin"] = m.height_margin;
    out["exact_limit"] = m.exact_limit;
    out["exact_frequency"] = m.exact_frequency;
    out["force_gain_limit"] = m.force_gain_limit;
    out["integral_limit"] = m.integral_limit;
    out["coupling_margin"] = m.coupling_margin;
    out["bandwidth"] = nt_margins_bandwidth(&equivalent.rig, &equivalent.gains, equivalent.contact_stiffness);
    out["least"] = verdict.margin;
    out["rule"] = verdict.rule;
    out["force_gain"] = equivalent.gains.force_gain;
    out["damping"] = equivalent.rig.master.damping;
    return out;
}

static py::dict calm(const Rig &rig, const Settings &settings, double stiffness)
{
    const nt_calm found = nt_margins_calm(&rig.value, &settings.value, stiffness);
    const std::vector<double> parts(found.parts, found.parts + NT_RIPPLE_SOURCES);
    py::dict out;
    out["ripple"] = found.ripple;
    out["parts"] = py::tuple(py::cast(parts));
    out["felt"] = found.felt;
    out["ringing"] = found.ringing;
    out["slewing"] = found.slewing;
    out["least"] = found.margin;
    out["rule"] = found.rule;
    return out;
}

// path (real, imaginary), impedance (real, imaginary) and Llewellyn's number at every frequency, one row each.
static py::array_t<double> response(const Rig &rig, const Settings &settings, double stiffness,
                                    const Array &frequencies)
{
    const py::ssize_t count = frequencies.size();
    const nt_servo_equivalent equivalent = nt_servo_equivalent_of(&rig.value, &settings.value, stiffness);
    py::array_t<double> out({count, py::ssize_t{5}});
    double *row = out.mutable_data();
    for (py::ssize_t i = 0; i < count; ++i, row += 5) {
        const nt_loop_response at = nt_margins_response(&equivalent.rig, &equivalent.gains,
                                                        equivalent.contact_stiffness, frequencies.data()[i]);
        row[0] = at.path[0];
        row[1] = at.path[1];
        row[2] = at.impedance[0];
        row[3] = at.impedance[1];
        row[4] = at.llewellyn;
    }
    return out;
}

static py::dict resolution(const Rig &rig, const Settings &settings, double slave_path)
{
    const nt_resolution r = nt_resolution_compute(&rig.value, &settings.value.gains, slave_path);
    py::dict out;
    out["slave_step"] = r.slave_step;
    out["slave_force"] = r.slave_force;
    out["slave_steps"] = r.slave_steps;
    out["force_steps"] = r.force_steps;
    out["master_steps"] = r.master_steps;
    out["gauge_steps"] = r.gauge_steps;
    out["master_travel"] = r.master_travel;
    out["master_force"] = r.master_force;
    return out;
}

py::dict motor_bound_as_dict(const nt_motor_bound &bound)
{
    py::dict out;
    out["force"] = bound.force;
    out["speed"] = bound.speed;
    out["fade_time"] = bound.fade_time;
    out["delay"] = bound.delay;
    out["energy"] = bound.energy;
    return out;
}

void bind_margins(py::module_ &module)
{
    module.def("motor_bound", [](const Rig &rig, const Settings &settings) {
        return motor_bound_as_dict(nt_motor_bound_compute(&rig.value, &settings.value));
    });
    module.def("margins", &margins);
    module.def("calm", &calm);
    module.attr("CLEARLY_FELT") = NT_CLEARLY_FELT;
    module.attr("RINGING_MOST") = NT_RINGING_MOST;
    module.def("felt_alpha_f",
               [](const Rig &rig, const Settings &settings, double pull_off, double load, double stiffness) {
                   return nt_margins_felt_alpha_f(&rig.value, &settings.value, pull_off, load, stiffness);
               });
    module.def("loop_response", &response);
    module.def("resolution", &resolution);
    module.def("jury_limit",
               [](const Rig &rig, double period) { return nt_margins_jury_limit(&rig.value.master, period); });
}
