// SPDX-License-Identifier: BSD-3-Clause
// scan.h, tapping.h: a raster with its z loop, and the slow flow of amplitude and lag
#include <atomic>

#include "descriptions.h"
#include "internal/scan.h"
#include "internal/tapping.h"
#include "nanotouch/advanced/scan.h"

namespace
{

// Lever, drive and plan; the plan is kept alive by the Python object.
struct Flow {
    nt_tapping lever;
    const nt_plan *plan;
};

// real, imaginary, mean, attached
using FlowState = std::tuple<double, double, double, bool>;

// Of a strip: lines that are finished, and whether it is to end.
struct Progress {
    std::atomic<long> lines{0};
    std::atomic<bool> ends{false};
};

constexpr py::ssize_t channels = 6; // of nt_scan_row

} // namespace

static nt_flow_state state_of(const FlowState &s)
{
    return {std::get<0>(s), std::get<1>(s), std::get<2>(s), std::get<3>(s) ? 1 : 0};
}

static FlowState tuple_of(const nt_flow_state &s)
{
    return {s.real, s.imaginary, s.mean, s.attached != 0};
}

// in the order of nt_flow_value
static py::tuple tuple_of(const nt_flow_value &v)
{
    return py::make_tuple(v.amplitude, v.phase, v.mean, v.peak_force, v.lowest_gap, v.virial, v.tip_loss);
}

static std::unique_ptr<Flow> make_flow(const Described<nt_rig> &rig, const Described<nt_drive> &drive,
                                       const nt_plan &plan)
{
    auto made = std::make_unique<Flow>();
    made->plan = &plan;
    nt_problem problem{};
    raise_on(nt_tapping_init(&made->lever, &rig.value.probe, &drive.value, 1e-9, &problem), problem, "tapping");
    return made;
}

// Over (x, y) with the base at z: a time further, or 0: until it settles.
static py::tuple go_on(const Flow &self, const FlowState &from, const nt_pose &base, double time)
{
    nt_flow_state state = state_of(from);
    nt_flow_value value{};
    nt_solve_info info{};
    nt_status status = NT_OK;
    {
        py::gil_scoped_release release;
        const nt_place place = nt_interaction_place(self.plan, base.x, base.y);
        const nt_tapping_over over = {self.plan, &place, base.z};
        if (time > 0.0)
            value = nt_flow_step(&self.lever, &state, &over, time);
        else
            status = nt_flow_settle(&self.lever, &state, &over, &value, &info);
    }
    if (status != NT_E_NO_CONVERGENCE)
        raise_on(status, "slow flow");
    return py::make_tuple(tuple_of(state), tuple_of(value), status == NT_OK, info.iterations);
}

static std::unique_ptr<nt_scanner> make_scanner(const Described<nt_scan> &scan, const Described<nt_rig> &rig,
                                                const Described<nt_drive> &drive, const nt_plan &plan)
{
    auto made = std::make_unique<nt_scanner>();
    const nt_scanner_inputs inputs = {&scan.value, &rig.value, &drive.value, &plan};
    nt_problem problem{};
    raise_on(nt_scanner_init(made.get(), &inputs, &problem), problem, "scan");
    return made;
}

static nt_scan_row row_of(double *at, long pixels)
{
    return {at, at + pixels, at + 2 * pixels, at + 3 * pixels, at + 4 * pixels, at + 5 * pixels};
}

// Lines from one engagement into `out`, (lines, 2, channels, pixels), there and back, in the order of nt_scan_row. It
// begins a line earlier, which is not kept: which of two motions the lever taps with is that of the surface, not of the
// coming down. It ends after the line in hand when it is asked to.
static void strip(const nt_scanner &self, long first, uint64_t seed, py::array_t<double, py::array::c_style> out,
                  Progress &progress)
{
    const long pixels = static_cast<long>(self.scan.raster.pixels);
    if (out.ndim() != 4 || out.shape(1) != 2 || out.shape(2) != channels || out.shape(3) != pixels)
        throw py::value_error("strip: out is not (lines, 2, 6, pixels)");
    const long count = static_cast<long>(out.shape(0));
    double *at = out.mutable_data();
    nt_status status;
    {
        py::gil_scoped_release release;
        nt_scanner_state state;
        nt_scan_row lost{};
        status = nt_scanner_engage(&self, &state, first > 0 ? first - 1 : 0, seed);
        if (status == NT_OK && first > 0)
            status = nt_scanner_line(&self, &state, first - 1, &lost, &lost);
        for (long line = first; line < first + count && status == NT_OK && !progress.ends;
             ++line, at += 2 * channels * pixels) {
            nt_scan_row trace = row_of(at, pixels), retrace = row_of(at + channels * pixels, pixels);
            status = nt_scanner_line(&self, &state, line, &trace, &retrace);
            progress.lines += status == NT_OK;
        }
    }
    raise_on(status, "scan");
}

void bind_scan(py::module_ &module)
{
    py::class_<Flow>(module, "Flow")
        .def(py::init(&make_flow), py::arg("rig"), py::arg("drive"), py::arg("plan"), py::keep_alive<1, 4>())
        .def("free", [](const Flow &self) { return tuple_of(nt_flow_free(&self.lever)); })
        .def("go_on", [](const Flow &self, const FlowState &state, double x, double y, double z, double time) {
            return go_on(self, state, {x, y, z}, time);
        });
    py::class_<Progress>(module, "ScanProgress")
        .def(py::init<>())
        .def_property_readonly("lines", [](const Progress &self) { return self.lines.load(); })
        .def("end", [](Progress &self) { self.ends = true; });
    py::class_<nt_scanner>(module, "Scanner")
        .def(py::init(&make_scanner), py::arg("scan"), py::arg("rig"), py::arg("drive"), py::arg("plan"),
             py::keep_alive<1, 5>())
        .def("strip", &strip, py::arg("first"), py::arg("seed"), py::arg("out").noconvert(), py::arg("progress"))
        .def("peak_bound",
             [](const nt_scanner &self, double x, double y, double rise, double height) {
                 const nt_place place = nt_interaction_place(self.plan, x, y);
                 const nt_relief relief = {rise, height};
                 return nt_scanner_peak_bound(&self, &place, &relief);
             })
        .def("speed",
             [](const nt_scanner &self, double slope, double error) { return nt_scanner_speed(&self, slope, error); })
        .def("parachute", [](const nt_scanner &self, double height,
                             double speed) { return nt_scanner_parachute(&self, height, speed); })
        .def_property_readonly("margins",
                               [](const nt_scanner &self) {
                                   const nt_zloop_margins found = nt_scanner_margins(&self);
                                   return py::make_tuple(found.gain, found.phase, found.speed);
                               })
        .def_property_readonly("noise", [](const nt_scanner &self) { return nt_scanner_noise(&self); })
        .def_property_readonly("advised", [](const nt_scanner &self) { return nt_scanner_gain(&self); })
        .def_property_readonly("integral", [](const nt_scanner &self) { return self.integral; });
}
