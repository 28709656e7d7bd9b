// SPDX-License-Identifier: BSD-3-Clause
// fit.h: whole curves over time.
#include "nanotouch/fit.h"

#include <algorithm>
#include <vector>

#include "../src/chapters.h"
#include "batch.h"

using Marks = py::array_t<unsigned char, py::array::c_style | py::array::forcecast>;

// A recorded curve; the arrays stay with their owner.
struct Path {
    Array times, positions, forces;
    Marks fitted;
    std::vector<long> starts;
    nt_fit_path c() const
    {
        return {times.data(),
                positions.data(),
                forces.data(),
                fitted.data(),
                static_cast<long>(times.size()),
                starts.data(),
                static_cast<int>(starts.size())};
    }
};

static Path path_of(const Array &times, const Array &positions, const Array &forces, const Marks &fitted,
                    const std::vector<long> &starts)
{
    for (const py::ssize_t size : {positions.size(), forces.size(), fitted.size()})
        if (times.ndim() != 1 || size != times.size())
            throw py::value_error("times, positions, forces and fitted must be equal arrays of one dimension");
    for (std::size_t i = 0; i < starts.size(); ++i)
        if (starts[i] < (i ? starts[i - 1] + 1 : 0) || starts[i] >= times.size())
            throw py::value_error("starts must grow and stay within the points");
    return {times, positions, forces, fitted, starts};
}

// shape: kind, sides, radius, half angle
static nt_fit_path_options options_of(const std::tuple<int, int, double, double> &shape, int kind, int arms)
{
    nt_fit_path_options options = nt_fit_path_defaults();
    options.contact.shape.kind = static_cast<nt_shape_kind>(std::get<0>(shape));
    options.contact.shape.sides = std::get<1>(shape);
    options.contact.shape.radius = std::get<2>(shape);
    options.contact.shape.half_angle = std::get<3>(shape);
    options.contact.rheology.kind = static_cast<nt_rheology_kind>(kind);
    options.contact.rheology.arm_count = arms;
    for (int k = 1; k < std::min(arms, int(NT_RHEOLOGY_ARMS)); ++k) { // where the fit begins is guessed
        options.contact.rheology.arm_moduli[k] = options.contact.rheology.arm_moduli[0];
        options.contact.rheology.relaxation_times[k] = options.contact.rheology.relaxation_times[0];
    }
    return options;
}

static void hold(nt_fit_path_options *options, int place, double value)
{
    if (place < 0 || place >= NT_FIT_PATH_PARAMETERS)
        throw py::index_error("no such parameter");
    options->start[place] = value;
    options->held |= 1U << place;
}

static py::dict dict_of(const nt_fit_path_result &result)
{
    py::dict out;
    const auto size = py::ssize_t(NT_FIT_PATH_PARAMETERS);
    Array value(size), sigma(size), covariance(std::vector<py::ssize_t>{size, size});
    std::copy_n(result.value, size, value.mutable_data());
    std::copy_n(result.sigma, size, sigma.mutable_data());
    std::copy_n(&result.covariance[0][0], size * size, covariance.mutable_data());
    out["value"] = value;
    out["sigma"] = sigma;
    out["covariance"] = covariance;
    out["free_exponent"] = result.free_exponent;
    out["chi_square"] = result.chi_square;
    out["bins"] = result.bins;
    out["correlation"] = result.correlation;
    out["peak"] = result.peak;
    out["indentation"] = result.indentation;
    out["contact_time"] = result.contact_time;
    out["kernel_error"] = result.kernel_error;
    out["by_springs"] = result.by_springs != 0;
    out["iterations"] = result.iterations;
    out["converged"] = result.converged != 0;
    out["held"] = result.held;
    return out;
}

// Result, fitted force and indentation at every point.
static py::tuple run(const nt_fit_path_options &options, const Path &path)
{
    Array forces(path.times.size()), indentations(path.times.size());
    const nt_fit_path given = path.c();
    nt_fit_path_result result{};
    nt_problem problem{};
    nt_status status;
    double *force = forces.mutable_data(), *indentation = indentations.mutable_data();
    {
        py::gil_scoped_release release;
        status = nt_fit_path_run(&options, &given, &result, &problem);
        if (status == NT_OK)
            status = nt_fit_path_model(&options, &result, &given, force, indentation);
    }
    raise_on(status, problem, "viscoelastic fit");
    return py::make_tuple(dict_of(result), forces, indentations);
}

void bind_path(py::module_ &module)
{
    py::class_<Path>(module, "Path").def(py::init(&path_of));
    py::class_<nt_fit_path_options>(module, "PathOptions")
        .def(py::init(&options_of))
        .def("hold", [](nt_fit_path_options &o, int place, double value) { hold(&o, place, value); })
        .def("start",
             [](nt_fit_path_options &o, int place, double value) {
                 const unsigned held = o.held;
                 hold(&o, place, value);
                 o.held = held;
             })
        .def_property(
            "radius", [](const nt_fit_path_options &o) { return o.contact.shape.radius; },
            [](nt_fit_path_options &o, double value) { o.contact.shape.radius = value; })
        .def_property(
            "poisson_ratio", [](const nt_fit_path_options &o) { return o.contact.poisson_ratio; },
            [](nt_fit_path_options &o, double value) { o.contact.poisson_ratio = value; })
        .def_property(
            "thickness", [](const nt_fit_path_options &o) { return o.contact.thickness; },
            [](nt_fit_path_options &o, double value) { o.contact.thickness = value; })
        .def_property(
            "spring_constant", [](const nt_fit_path_options &o) { return o.contact.spring_constant; },
            [](nt_fit_path_options &o, double value) { o.contact.spring_constant = value; })
        .def_readwrite("noise", &nt_fit_path_options::noise)
        .def_readwrite("tilt_position", &nt_fit_path_options::tilt_position)
        .def_readwrite("drag_height", &nt_fit_path_options::drag_height)
        .def_readwrite("max_iterations", &nt_fit_path_options::max_iterations);
    module.attr("path_background") =
        static_cast<int>(NT_FIT_PATH_CONTACT); // place of the first that is not the rheology's
    module.def("run_path", &run);
}
