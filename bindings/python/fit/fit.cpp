// SPDX-License-Identifier: BSD-3-Clause
// fit.h: the extension _fit, apart from _core because of Ceres' licence.
#include "internal/fit.h"
#include "nanotouch/fit.h"

#include "../src/chapters.h"
#include "batch.h"
#include "law.h"

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

static Options options_of_model(const std::string &name)
{
    for (int i = 0; i < NT_FIT_CUSTOM; ++i)
        if (const auto model = static_cast<nt_fit_model>(i); name == nt_fit_describe(model).name)
            return {nt_fit_defaults(model), nullptr};
    throw py::key_error(name);
}

static Options options_of_law(const std::string &name, const py::list &parameters, const py::function &force)
{
    auto own = std::make_shared<PythonLaw>(name, parameters, force);
    return {nt_fit_defaults_for(&own->law), own};
}

static nt_fit_quantity quantity_at(const Options &options, int i)
{
    return nt_fit_quantity_of(&options, static_cast<nt_fit_parameter>(i));
}

static int index_of(const Options &options, const std::string &name)
{
    for (int i = 0; i < NT_FIT_PARAMETERS; ++i)
        if (quantity_at(options, i).name && name == quantity_at(options, i).name)
            return i;
    throw py::key_error(name);
}

// (name, unit, minimum, maximum) of every parameter by its place; None where the model has none.
static py::tuple parameters_of(const Options &options)
{
    py::list found;
    for (int i = 0; i < NT_FIT_PARAMETERS; ++i) {
        const nt_fit_quantity quantity = quantity_at(options, i);
        if (quantity.name)
            found.append(py::make_tuple(quantity.name, quantity.unit, quantity.minimum, quantity.maximum));
        else
            found.append(py::none());
    }
    return found;
}

// The rows of the built-in models, by name.
static py::dict models()
{
    py::dict found;
    for (int i = 0; i < NT_FIT_CUSTOM; ++i) {
        const auto model = static_cast<nt_fit_model>(i);
        const nt_fit_description words = nt_fit_describe(model);
        py::dict row;
        row["title"] = words.title;
        row["law"] = words.law;
        row["valid"] = words.valid;
        row["scaling"] = words.scaling;
        row["tip"] = words.tip;
        row["sides"] = words.sides < 0 ? py::object(py::none()) : py::int_(words.sides);
        row["exponent"] = words.exponent;
        row["adhesive"] = words.pull_off > 0.0;
        row["transition"] = words.lambda;
        const Options options{nt_fit_defaults(model), nullptr};
        py::list own; // name, unit, minimum, maximum
        for (int p = 0; p < NT_FIT_OWN; ++p)
            if (const nt_fit_quantity quantity = quantity_at(options, p); quantity.name)
                own.append(py::make_tuple(quantity.name, quantity.unit, quantity.minimum, quantity.maximum));
        row["parameters"] = own;
        found[words.name] = row;
    }
    return found;
}

template <class Number> static py::array_t<Number> array_of(const Number (&values)[NT_FIT_PARAMETERS])
{
    return py::array_t<Number>(NT_FIT_PARAMETERS, values);
}

py::dict result_dict(const nt_fit_result &result)
{
    py::array_t<double> covariance({int(NT_FIT_PARAMETERS), int(NT_FIT_PARAMETERS)});
    std::copy_n(&result.covariance[0][0], NT_FIT_PARAMETERS * NT_FIT_PARAMETERS, covariance.mutable_data());
    py::dict out;
    out["value"] = array_of(result.value);
    out["sigma"] = array_of(result.sigma);
    out["from_tear"] = array_of(result.from_tear);
    out["identifiable"] = std::vector<bool>(result.identifiable, result.identifiable + NT_FIT_PARAMETERS);
    out["covariance"] = covariance;
    out["residual_rms"] = result.residual_rms;
    out["residual_noise"] = result.residual_noise;
    out["residuals_are_noise"] = bool(result.residuals_are_noise);
    out["misfit"] = result.misfit;
    out["chi_square"] = result.chi_square;
    out["transition_parameter"] = result.transition_parameter;
    out["pull_off_force"] = result.pull_off_force;
    out["contact_radius"] = result.contact_radius;
    out["contact_stiffness"] = result.contact_stiffness;
    out["iterations"] = result.iterations;
    out["converged"] = bool(result.converged);
    out["message"] = std::string(result.message);
    return out;
}

static void raise(const Options &options, nt_status status, const nt_problem &problem)
{
    if (options.own)
        options.own->rethrow();
    raise_on(status, problem, "fit");
}

static py::dict run(const Options &options, const Array &position, const Array &force)
{
    const nt_fit_data data = data_of(column(position, "position"), column(force, "force"));
    nt_fit_result result;
    nt_problem problem{};
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_fit_run(&options, &data, &result, &problem);
    }
    raise(options, status, problem);
    return result_dict(result);
}

static std::vector<nt_fit_point> points_of(const Options &options, const std::vector<double> &value,
                                           const Array &position)
{
    if (value.size() != NT_FIT_PARAMETERS)
        throw py::value_error("value must have one number for each parameter");
    const nt_fit_data data{position.data(), nullptr, static_cast<long>(position.size()), 1, 1};
    std::vector<nt_fit_point> points(static_cast<std::size_t>(position.size()));
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_fit_model_n(&options, value.data(), &data, points.data());
    }
    raise(options, status, nt_problem{});
    return points;
}

// Force and indentation of the model at every position, and whether the contact is held there.
static py::tuple evaluate(const Options &options, const std::vector<double> &value, const Array &position)
{
    const std::vector<nt_fit_point> points = points_of(options, value, position);
    py::array_t<double> force(position.size()), indentation(position.size());
    py::array_t<bool> held(position.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        force.mutable_data()[i] = points[i].force;
        indentation.mutable_data()[i] = points[i].indentation;
        held.mutable_data()[i] = points[i].held != 0;
    }
    return py::make_tuple(force, indentation, held);
}

// d force/d parameter in SI, shape (points, parameters).
static py::array_t<double> gradient(const Options &options, const std::vector<double> &value, const Array &position)
{
    const std::vector<nt_fit_point> points = points_of(options, value, position);
    py::array_t<double> found({position.size(), py::ssize_t(NT_FIT_PARAMETERS)});
    for (std::size_t i = 0; i < points.size(); ++i)
        std::copy_n(points[i].gradient, NT_FIT_PARAMETERS, found.mutable_data() + i * NT_FIT_PARAMETERS);
    return found;
}

static double tear_position(const Options &options, const std::vector<double> &value)
{
    if (value.size() != NT_FIT_PARAMETERS)
        throw py::value_error("value must have one number for each parameter");
    double position = 0.0;
    raise(options, nt_fit_tear_position(&options, value.data(), &position), nt_problem{});
    return position;
}

static void bind_options(py::module_ &module)
{
    const auto start = [](Options &o, const std::string &name) -> nt_fit_start & {
        return o.parameter[index_of(o, name)];
    };
    py::class_<Options>(module, "Options")
        .def(py::init(&options_of_model), py::arg("model"))
        .def(py::init(&options_of_law), py::arg("name"), py::arg("parameters"), py::arg("force"))
        .def_property_readonly("parameters", &parameters_of)
        .def("start", [=](Options &o, const std::string &name, double value) { start(o, name).initial = value; })
        .def("know",
             [=](Options &o, const std::string &name, double value, double sigma) {
                 start(o, name) = {value, start(o, name).minimum, start(o, name).maximum, sigma, 0};
             })
        .def("hold",
             [=](Options &o, const std::string &name, double value) {
                 start(o, name).initial = value;
                 start(o, name).fixed = 1;
             })
        .def("free", [=](Options &o, const std::string &name) { start(o, name).fixed = 0; })
        .def("bound",
             [=](Options &o, const std::string &name, double minimum, double maximum) {
                 start(o, name).minimum = minimum;
                 start(o, name).maximum = maximum;
             })
        .def("is_free", [=](Options &o, const std::string &name) { return !start(o, name).fixed; })
        .def_readwrite("radius", &Options::radius)
        .def_readwrite("half_angle", &Options::half_angle)
        .def_readwrite("spring_constant", &Options::spring_constant)
        .def_readwrite("tilt_position", &Options::tilt_position)
        .def_property(
            "loss", [](const Options &o) { return static_cast<int>(o.loss); },
            [](Options &o, int loss) { o.loss = static_cast<nt_fit_loss>(loss); })
        .def_readwrite("loss_scale", &Options::loss_scale)
        .def_readwrite("force_noise", &Options::force_noise)
        .def_readwrite("tear_position", &Options::tear_position)
        .def_readwrite("tear_sigma", &Options::tear_sigma)
        .def_readwrite("max_iterations", &Options::max_iterations);
}

PYBIND11_MODULE(_fit, module)
{
    bind_options(module);
    bind_batch(module);
    bind_solving(module);
    bind_path(module);
    module.def("models", &models);
    module.def("run", &run, py::arg("options"), py::arg("position"), py::arg("force"));
    module.def("evaluate", &evaluate, py::arg("options"), py::arg("value"), py::arg("position"));
    module.def("gradient", &gradient, py::arg("options"), py::arg("value"), py::arg("position"));
    module.def("tear_position", &tear_position, py::arg("options"), py::arg("value"));
}
