// SPDX-License-Identifier: BSD-3-Clause
// tapping.h: a driven lever over a place
#include "descriptions.h"

namespace
{

// Lever, drive and plan; the plan is kept alive by the Python object.
struct Tapping {
    nt_tapping lever;
    const nt_plan *plan;
};

// position, speed, step, attached, dissipated, port
using State = std::tuple<double, double, double, bool, double, double>;

} // namespace

static std::unique_ptr<Tapping> make(const Described<nt_rig> &rig, const Described<nt_drive> &drive, double tolerance,
                                     const nt_plan &plan)
{
    auto made = std::make_unique<Tapping>();
    made->plan = &plan;
    nt_problem problem{};
    raise_on(nt_tapping_init(&made->lever, &rig.value.probe, &drive.value, tolerance, &problem), problem, "tapping");
    return made;
}

static State tuple_of(const nt_tapping_state &s)
{
    return {s.position, s.speed, s.step, s.contact.attached != 0, s.contact.dissipated, s.contact.port};
}

static nt_tapping_state state_of(const State &s)
{
    return {std::get<0>(s), std::get<1>(s), std::get<2>(s), {std::get<3>(s) ? 1 : 0, std::get<4>(s), std::get<5>(s)}};
}

// in the order of nt_tapping_value
static py::tuple tuple_of(const nt_tapping_value &v)
{
    return py::make_tuple(v.amplitude, v.phase, v.mean, v.peak_force, v.pull, v.lowest_gap, v.contact_time,
                          v.drive_work, v.medium_loss, v.tip_loss, v.jump_loss, v.mean_force, v.virial, v.energy_error,
                          v.virial_error, v.change, v.steps, v.evaluations);
}

// From a state over (x, y) with the base at z: the state after it, the value, and whether it settled with its periods.
static py::tuple run(const Tapping &self, const State &from, const nt_pose &base, long periods)
{
    nt_tapping_state state = state_of(from);
    nt_tapping_value value{};
    nt_solve_info info{};
    nt_status status;
    {
        py::gil_scoped_release release;
        const nt_place place = nt_interaction_place(self.plan, base.x, base.y);
        const nt_tapping_over over = {self.plan, &place, base.z};
        status = periods > 0 ? nt_tapping_run(&self.lever, &state, &over, periods, &value)
                             : nt_tapping_settle(&self.lever, &state, &over, &value, &info);
    }
    if (periods > 0 || status != NT_E_NO_CONVERGENCE)
        raise_on(status, "tapping");
    return py::make_tuple(tuple_of(state), tuple_of(value), status == NT_OK, info.iterations);
}

void bind_tapping(py::module_ &module)
{
    py::class_<Tapping>(module, "Tapping")
        .def(py::init(&make), py::arg("rig"), py::arg("drive"), py::arg("tolerance"), py::arg("plan"),
             py::keep_alive<1, 5>())
        .def("free", [](const Tapping &self) { return tuple_of(nt_tapping_free(&self.lever)); })
        .def("run", [](const Tapping &self, const State &state, double x, double y, double z,
                       long periods) { return run(self, state, {x, y, z}, periods); })
        .def_property_readonly("strength", [](const Tapping &self) { return self.lever.strength; })
        .def_property_readonly("frequency",
                               [](const Tapping &self) { return self.lever.ratio * self.lever.rate / (2.0 * NT_PI); });
}
