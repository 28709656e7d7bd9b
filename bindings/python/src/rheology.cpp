// SPDX-License-Identifier: BSD-3-Clause
// rheology.h
#include <vector>

#include "chapters.h"
#include "internal/rheology.h"

static nt_rheology rheology_of(int kind, const std::vector<double> &numbers, const std::vector<double> &moduli,
                               const std::vector<double> &times)
{
    if (numbers.size() != 4 || moduli.size() != times.size() || moduli.size() > NT_RHEOLOGY_ARMS)
        throw std::invalid_argument("rheology: 4 numbers, and a time for each of up to 8 moduli");
    nt_rheology rheology = nt_rheology_defaults();
    rheology.kind = static_cast<nt_rheology_kind>(kind);
    rheology.modulus = numbers[0];
    rheology.exponent = numbers[1];
    rheology.reference_time = numbers[2];
    rheology.equilibrium_modulus = numbers[3];
    rheology.arm_count = static_cast<int>(moduli.size());
    for (std::size_t k = 0; k < moduli.size(); ++k) {
        rheology.arm_moduli[k] = moduli[k];
        rheology.relaxation_times[k] = times[k];
    }
    nt_problem problem{};
    raise_on(nt_rheology_check(&rheology, &problem), problem, "rheology");
    return rheology;
}

// One of the functions of time, for each of an array.
static py::array_t<double> map_times(const nt_rheology &rheology, const Array &times,
                                     double (*function)(const nt_rheology *, double))
{
    py::array_t<double> out(std::vector<py::ssize_t>(times.shape(), times.shape() + times.ndim()));
    const double *t = times.data();
    double *value = out.mutable_data();
    const py::ssize_t count = times.size();
    {
        py::gil_scoped_release release;
        for (py::ssize_t i = 0; i < count; ++i)
            value[i] = function(&rheology, t[i]);
    }
    return out;
}

// E_inf, moduli, rates, error.
static py::tuple discretize(const nt_rheology &rheology, double shortest, double longest, double error)
{
    nt_spectrum spectrum{};
    const nt_time_range range = {shortest, longest};
    raise_on(nt_rheology_discretize(&rheology, &range, error, &spectrum),
             "rheology: a sum of exponentials for these times and this error");
    return py::make_tuple(spectrum.equilibrium_modulus,
                          std::vector<double>(spectrum.moduli, spectrum.moduli + spectrum.count),
                          std::vector<double>(spectrum.rates, spectrum.rates + spectrum.count), spectrum.error);
}

static nt_viscoelastic contact_of(const nt_shape &shape, const nt_rheology &rheology, double poisson_ratio,
                                  double thickness, double spring_constant)
{
    const nt_viscoelastic contact = {shape, rheology, poisson_ratio, thickness, spring_constant};
    nt_problem problem{};
    raise_on(nt_viscoelastic_check(&contact, &problem), problem, "viscoelastic contact");
    return contact;
}

// Forces, indentations, derivatives (or None), arms, error of the kernel, whether springs followed it.
static py::tuple run(const nt_viscoelastic &contact, const Array &times, const Array &positions, double first_touch,
                     bool with_derivatives)
{
    const py::ssize_t count = times.size();
    if (positions.size() != count)
        throw std::invalid_argument("viscoelastic contact: as many positions as times");
    const py::ssize_t columns = 1 + nt_rheology_parameter_count(&contact.rheology);
    py::array_t<double> forces(count), indentations(count);
    py::array_t<double> derivatives(
        std::vector<py::ssize_t>{with_derivatives ? count : 0, with_derivatives ? columns : 0});
    std::vector<double> workspace(
        static_cast<std::size_t>(nt_viscoelastic_workspace(&contact, static_cast<long>(count), with_derivatives)));
    nt_viscoelastic_result result{};
    result.forces = forces.mutable_data();
    result.indentations = indentations.mutable_data();
    result.derivatives = with_derivatives ? derivatives.mutable_data() : nullptr;
    const nt_viscoelastic_path path = {times.data(), positions.data(), first_touch, static_cast<long>(count),
                                       workspace.data()};
    nt_problem problem{};
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_viscoelastic_run(&contact, &path, &result, &problem);
    }
    raise_on(status, problem, "viscoelastic contact");
    const py::object by = with_derivatives ? py::object(derivatives) : py::object(py::none());
    return py::make_tuple(forces, indentations, by, result.arms, result.kernel_error, result.by_springs != 0);
}

// The same with adhesion: forces, indentations, arms, what the bulk still relaxes, what is lost at the edge.
static py::tuple run_adhesive(const nt_viscoelastic &contact, const Array &times, const Array &positions,
                              double first_touch, double work_of_adhesion, double crack_length)
{
    const py::ssize_t count = times.size();
    if (positions.size() != count)
        throw std::invalid_argument("viscoelastic contact: as many positions as times");
    py::array_t<double> forces(count), indentations(count);
    nt_viscoelastic_result result{};
    result.forces = forces.mutable_data();
    result.indentations = indentations.mutable_data();
    const nt_viscoelastic_path path = {times.data(), positions.data(), first_touch, static_cast<long>(count), nullptr};
    const nt_viscoelastic_adhesion adhesion = {work_of_adhesion, crack_length};
    nt_problem problem{};
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_viscoelastic_run_adhesive(&contact, &adhesion, &path, &result, &problem);
    }
    raise_on(status, problem, "viscoelastic contact with adhesion");
    return py::make_tuple(forces, indentations, result.arms, result.bulk_error, result.dissipated);
}

static py::list fields()
{
    int count = 0;
    const nt_field *field = nt_rheology_fields(&count);
    py::list rows;
    for (int i = 0; i < count; ++i)
        rows.append(py::make_tuple(field[i].name, field[i].unit, field[i].minimum, field[i].maximum, field[i].doc));
    return rows;
}

void bind_rheology(py::module_ &module)
{
    py::class_<nt_rheology>(module, "Rheology")
        .def(py::init(&rheology_of))
        .def("relaxation",
             [](const nt_rheology &self, const Array &t) { return map_times(self, t, nt_rheology_relaxation); })
        .def("relaxation_integral", [](const nt_rheology &self,
                                       const Array &t) { return map_times(self, t, nt_rheology_relaxation_integral); })
        .def("creep", [](const nt_rheology &self, const Array &t) { return map_times(self, t, nt_rheology_creep); })
        .def("discretize", &discretize)
        .def_property_readonly_static("fields", [](const py::object &) { return fields(); });
    py::class_<nt_viscoelastic>(module, "Viscoelastic")
        .def(py::init(&contact_of))
        .def("run", &run)
        .def("run_adhesive", &run_adhesive);
}
