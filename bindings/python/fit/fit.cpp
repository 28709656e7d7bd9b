// SPDX-License-Identifier: BSD-3-Clause
// fit.h: the extension _fit, apart from _core because of Ceres' licence.
#include "nanotouch/fit.h"

#include "../src/chapters.h"

static Array column(const Array &values, const char *name)
{
    if (values.ndim() != 1)
        throw py::value_error(std::string(name) + " must have one dimension");
    return values;
}

static nt_fit_data data_of(const Array &position, const Array &force)
{
    if (position.size() != force.size())
        throw py::value_error("position and force differ in length");
    return {position.data(), force.data(), static_cast<long>(position.size()), 1, 1};
}

static int index_of(const std::string &name)
{
    for (int i = 0; i < NT_FIT_PARAMETERS; ++i)
        if (name == nt_fit_parameter_name(static_cast<nt_fit_parameter>(i)))
            return i;
    throw py::key_error(name);
}

static py::dict result_dict(const nt_fit_result &result)
{
    py::array_t<double> covariance({int(NT_FIT_PARAMETERS), int(NT_FIT_PARAMETERS)});
    std::copy_n(&result.covariance[0][0], NT_FIT_PARAMETERS * NT_FIT_PARAMETERS, covariance.mutable_data());
    py::dict out;
    out["value"] = std::vector<double>(result.value, result.value + NT_FIT_PARAMETERS);
    out["sigma"] = std::vector<double>(result.sigma, result.sigma + NT_FIT_PARAMETERS);
    out["identifiable"] = std::vector<bool>(result.identifiable, result.identifiable + NT_FIT_PARAMETERS);
    out["covariance"] = covariance;
    out["residual_rms"] = result.residual_rms;
    out["misfit"] = result.misfit;
    out["transition_parameter"] = result.transition_parameter;
    out["pull_off_force"] = result.pull_off_force;
    out["contact_radius"] = result.contact_radius;
    out["contact_stiffness"] = result.contact_stiffness;
    out["iterations"] = result.iterations;
    out["converged"] = bool(result.converged);
    out["message"] = std::string(result.message);
    return out;
}

static py::dict run(const nt_fit_options &options, const Array &position, const Array &force)
{
    const nt_fit_data data = data_of(column(position, "position"), column(force, "force"));
    nt_fit_result result;
    nt_problem problem{};
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_fit_run(&options, &data, &result, &problem);
    }
    raise_on(status, problem, "fit");
    return result_dict(result);
}

// Force and indentation of the model at every position.
static py::tuple evaluate(const nt_fit_options &options, const std::vector<double> &value, const Array &position)
{
    if (value.size() != NT_FIT_PARAMETERS)
        throw py::value_error("value must have one number for each parameter");
    py::array_t<double> force(position.size()), indentation(position.size());
    double *F = force.mutable_data(), *delta = indentation.mutable_data();
    for (py::ssize_t i = 0; i < position.size(); ++i) {
        nt_fit_point point;
        raise_on(nt_fit_model_at(&options, value.data(), position.data()[i], &point), "model");
        F[i] = point.force;
        delta[i] = point.indentation;
    }
    return py::make_tuple(force, indentation);
}

PYBIND11_MODULE(_fit, module)
{
    py::list parameters;
    for (int i = 0; i < NT_FIT_PARAMETERS; ++i) {
        const auto parameter = static_cast<nt_fit_parameter>(i);
        parameters.append(py::make_tuple(nt_fit_parameter_name(parameter), nt_fit_parameter_unit(parameter)));
    }
    module.attr("parameters") = py::tuple(parameters);
    module.def("model_has", [](int model, const std::string &name) {
        return nt_fit_model_has(static_cast<nt_model>(model), static_cast<nt_fit_parameter>(index_of(name))) != 0;
    });
    py::class_<nt_fit_options>(module, "Options")
        .def(py::init([](int model) { return nt_fit_defaults(static_cast<nt_model>(model)); }), py::arg("model"))
        .def("start", [](nt_fit_options &o, const std::string &name,
                         double value) { o.parameter[index_of(name)].initial = value; })
        .def("hold",
             [](nt_fit_options &o, const std::string &name, double value) {
                 nt_fit_start &start = o.parameter[index_of(name)];
                 start.initial = value;
                 start.fixed = 1;
             })
        .def("free", [](nt_fit_options &o, const std::string &name) { o.parameter[index_of(name)].fixed = 0; })
        .def("bound",
             [](nt_fit_options &o, const std::string &name, double minimum, double maximum) {
                 o.parameter[index_of(name)].minimum = minimum;
                 o.parameter[index_of(name)].maximum = maximum;
             })
        .def("is_free",
             [](const nt_fit_options &o, const std::string &name) {
                 const int i = index_of(name);
                 return !o.parameter[i].fixed && nt_fit_model_has(o.model, static_cast<nt_fit_parameter>(i));
             })
        .def_readwrite("radius", &nt_fit_options::radius)
        .def_readwrite("spring_constant", &nt_fit_options::spring_constant)
        .def_property(
            "loss", [](const nt_fit_options &o) { return static_cast<int>(o.loss); },
            [](nt_fit_options &o, int loss) { o.loss = static_cast<nt_fit_loss>(loss); })
        .def_readwrite("loss_scale", &nt_fit_options::loss_scale)
        .def_readwrite("force_noise", &nt_fit_options::force_noise)
        .def_readwrite("pull_off_force", &nt_fit_options::pull_off_force)
        .def_readwrite("pull_off_sigma", &nt_fit_options::pull_off_sigma)
        .def_readwrite("compliance_sigma", &nt_fit_options::compliance_sigma)
        .def_readwrite("max_iterations", &nt_fit_options::max_iterations);
    module.def("run", &run, py::arg("options"), py::arg("position"), py::arg("force"));
    module.def("evaluate", &evaluate, py::arg("options"), py::arg("value"), py::arg("position"));
}
