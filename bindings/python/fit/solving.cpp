// SPDX-License-Identifier: BSD-3-Clause
// fit.h, third part: a fit with what is known beforehand, and what it is worth.
#include "batch.h"
#include "internal/fit.h"

namespace
{

struct Solution : nt_fit_solution {
    std::shared_ptr<PythonLaw> own;
    Options used() const
    {
        return {options, own};
    }
};

nt_fit_data data_of(const Array &position, const Array &force)
{
    if (position.ndim() != 1 || force.ndim() != 1 || position.size() != force.size())
        throw py::value_error("position and force must have one dimension and the same length");
    return {position.data(), force.data(), static_cast<long>(position.size()), 1, 1};
}

void raise(const std::shared_ptr<PythonLaw> &own, nt_status status, const nt_problem &problem)
{
    if (own)
        own->rethrow();
    raise_on(status, problem, "fit");
}

Solution solve(const Options &options, const nt_fit_known &known, const Array &position, const Array &force)
{
    const nt_fit_data data = data_of(position, force);
    Solution solution{{}, options.own};
    nt_problem problem{};
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_fit_solve(&options, &known, &data, &solution, &problem);
    }
    raise(options.own, status, problem);
    return solution;
}

py::array_t<double> shift(const Solution &solution, const Array &position, const Array &force, int changed)
{
    const nt_fit_data data = data_of(position, force);
    py::array_t<double> found(NT_FIT_PARAMETERS);
    double *out = found.mutable_data();
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_fit_shift(&solution, &data, static_cast<nt_fit_calibration>(changed), out);
    }
    raise(solution.own, status, nt_problem{});
    return found;
}

py::tuple bounds(const Solution &solution, const Array &position, const Array &force, int place)
{
    if (place < 0 || place >= NT_FIT_PARAMETERS)
        throw py::index_error();
    const nt_fit_data data = data_of(position, force);
    double found[2];
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_fit_bounds(&solution, &data, static_cast<nt_fit_parameter>(place), found);
    }
    raise(solution.own, status, nt_problem{});
    return py::make_tuple(found[0], found[1]);
}

double steep_width(const Options &options, const std::vector<double> &value)
{
    if (value.size() != NT_FIT_PARAMETERS)
        throw py::value_error("value must have one number for each parameter");
    double width = 0.0;
    raise(options.own, nt_fit_steep_width(&options, value.data(), &width), nt_problem{});
    return width;
}

void bind_known(py::module_ &module)
{
    py::class_<nt_fit_known>(module, "Known")
        .def(py::init([] { return nt_fit_known{}; }))
        .def("noises",
             [](nt_fit_known &known, double point, double white, double flicker) {
                 known.noise = point;
                 known.free = {white, flicker};
             })
        .def("baseline",
             [](nt_fit_known &known, double position, double level_sigma, double tilt_sigma) {
                 known.baseline_position = position;
                 known.level_sigma = level_sigma;
                 known.tilt_sigma = tilt_sigma;
             })
        .def("tear",
             [](nt_fit_known &known, double position, double sigma) {
                 known.tear_position = position;
                 known.tear_sigma = sigma;
             })
        .def("hold",
             [](nt_fit_known &known, int place) { // in Options.parameters
                 if (place < 0 || place >= NT_FIT_PARAMETERS)
                     throw py::index_error();
                 known.held[place] = 1;
             })
        .def_readwrite("sensitivity_sigma", &nt_fit_known::sensitivity_sigma)
        .def_property(
            "fit_offset", [](const nt_fit_known &known) { return known.fit_offset != 0; },
            [](nt_fit_known &known, bool fit_offset) { known.fit_offset = fit_offset; });
}

} // namespace

void bind_solving(py::module_ &module)
{
    bind_known(module);
    py::class_<Solution>(module, "Solution")
        .def_property_readonly("found", [](const Solution &solution) { return result_dict(solution.fit); })
        .def_property_readonly("options", &Solution::used)
        .def_readonly("count", &Solution::count)
        .def_readonly("rating", &Solution::rating)
        .def_readonly("flags", &Solution::flags)
        .def_property_readonly("exact", [](const Solution &solution) { return solution.exact != 0; })
        .def_readonly("any_sensitivity", &Solution::any_sensitivity)
        .def_readonly("any_modulus", &Solution::any_modulus)
        .def_readonly("any_rms", &Solution::any_rms)
        .def_property_readonly(
            "half_modulus",
            [](const Solution &solution) { return py::make_tuple(solution.half_modulus[0], solution.half_modulus[1]); })
        .def_property_readonly(
            "power", [](const Solution &solution) { return py::make_tuple(solution.power[0], solution.power[1]); })
        .def("shift", &shift, py::arg("position"), py::arg("force"), py::arg("changed"))
        .def("bounds", &bounds, py::arg("position"), py::arg("force"), py::arg("place"));
    py::dict calibrations;
    calibrations["spring_constant"] = int(NT_FIT_SPRING_CONSTANT);
    calibrations["radius"] = int(NT_FIT_RADIUS);
    calibrations["half_angle"] = int(NT_FIT_HALF_ANGLE);
    calibrations["thickness"] = int(NT_FIT_THICKNESS);
    module.attr("calibrations") = calibrations;
    module.def("solve", &solve, py::arg("options"), py::arg("known"), py::arg("position"), py::arg("force"));
    module.def("steep_width", &steep_width, py::arg("options"), py::arg("value"));
}
