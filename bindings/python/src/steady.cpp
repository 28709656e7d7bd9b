// SPDX-License-Identifier: BSD-3-Clause
// internal/balance.h, internal/steady.h: steady tapping to a demanded accuracy
#include "internal/steady.h"
#include "internal/balance.h"
#include "nanotouch/advanced/scan.h"

#include <algorithm>

#include "descriptions.h"

namespace
{

// Lever, drive and plan; the plan is kept alive by the Python object.
struct Steady {
    nt_tapping lever;
    double accuracy;
    const nt_plan *plan;
};

} // namespace

static std::unique_ptr<Steady> make(const Described<nt_rig> &rig, const Described<nt_drive> &drive, double accuracy,
                                    const nt_plan &plan)
{
    auto made = std::make_unique<Steady>();
    made->plan = &plan;
    made->accuracy = accuracy;
    nt_problem problem{};
    const double tolerance = std::min(1e-8, 1e-4 * accuracy); // a motion has settled within 30 of them
    raise_on(nt_tapping_init(&made->lever, &rig.value.probe, &drive.value, tolerance, &problem), problem, "tapping");
    return made;
}

// Tier, harmonics, and in the order of nt_steady_value.
static py::tuple tuple_of(const nt_steady_value &v)
{
    return py::make_tuple(static_cast<int>(v.tier), v.harmonics, v.base_height, v.amplitude, v.phase, v.mean,
                          v.peak_force, v.lowest_gap, v.contact_time, v.tip_loss, v.amplitude_bound, v.force_bound,
                          py::make_tuple(v.state.position, v.state.speed, 0.0, v.state.contact.attached != 0),
                          v.evaluations);
}

// All motions over (x, y): base height, amplitude, phase, peak force, stable, piece; (6, n).
static py::array_t<double> trace(const Steady &self, double x, double y)
{
    auto curve = std::make_unique<nt_balance_curve>();
    nt_status status;
    {
        py::gil_scoped_release release;
        const nt_place place = nt_interaction_place(self.plan, x, y);
        const nt_balance balance = {&self.lever, self.plan, &place, 1, 0.0};
        status = nt_balance_trace(&balance, curve.get());
    }
    raise_on(status, "harmonic balance");
    py::array_t<double> out({py::ssize_t{6}, static_cast<py::ssize_t>(curve->count)});
    auto at = out.mutable_unchecked<2>();
    for (int i = 0; i < curve->count; ++i) {
        const auto &point = curve->at[i];
        const double values[] = {point.base_height, point.amplitude,          point.phase,
                                 point.peak_force,  point.stable ? 1.0 : 0.0, static_cast<double>(point.piece)};
        for (int row = 0; row < 6; ++row)
            at(row, i) = values[row];
    }
    return out;
}

// The motion of a target over (x, y), or None where none repeats.
static py::object find(const Steady &self, const std::pair<double, double> &at, const std::pair<int, double> &wanted,
                       bool lifted)
{
    auto curve = std::make_unique<nt_balance_curve>();
    nt_steady_value value{};
    nt_status status;
    {
        py::gil_scoped_release release;
        const nt_place place = nt_interaction_place(self.plan, at.first, at.second);
        const nt_balance balance = {&self.lever, self.plan, &place, 1, 0.0};
        const nt_steady steady = {&self.lever, self.plan, &place, self.accuracy};
        const nt_balance_target target = {static_cast<nt_balance_aim>(wanted.first), wanted.second, lifted ? 1 : 0};
        status = nt_balance_trace(&balance, curve.get());
        if (status == NT_OK)
            status = nt_steady_find(&steady, curve.get(), &target, &value);
    }
    if (status == NT_E_NO_CONVERGENCE)
        return py::none();
    raise_on(status, "steady tapping");
    return tuple_of(value);
}

// A line of an image, (channels, pixels) in the order of nt_scan_row, and the first pixel where no motion repeats, or
// -1.
static py::tuple steady_line(const nt_scanner &scanner, double accuracy, long line)
{
    const long pixels = static_cast<long>(scanner.scan.raster.pixels);
    py::array_t<double> out({py::ssize_t{6}, static_cast<py::ssize_t>(pixels)});
    double *at = out.mutable_data();
    nt_scan_row row = {at, at + pixels, at + 2 * pixels, at + 3 * pixels, at + 4 * pixels, at + 5 * pixels};
    nt_status status;
    long pixel = -1;
    {
        py::gil_scoped_release release;
        status = nt_steady_line(&scanner, accuracy, line, &row, &pixel);
    }
    if (status != NT_E_NO_CONVERGENCE)
        raise_on(status, "steady image");
    return py::make_tuple(out, pixel);
}

void bind_steady(py::module_ &module)
{
    py::class_<Steady>(module, "Steady")
        .def(py::init(&make), py::arg("rig"), py::arg("drive"), py::arg("accuracy"), py::arg("plan"),
             py::keep_alive<1, 5>())
        .def("trace", &trace)
        .def("find", &find);
    module.def("steady_line", &steady_line);
}
