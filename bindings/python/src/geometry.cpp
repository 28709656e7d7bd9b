// SPDX-License-Identifier: BSD-3-Clause
// geometry.h
#include <algorithm>
#include <limits>

#include "chapters.h"
#include "internal/geometry.h"

static constexpr double missing = std::numeric_limits<double>::quiet_NaN(); // where there is no solution

static nt_shape shape_of(int kind, int sides, double radius, double half_angle, double transition)
{
    const nt_shape shape = {static_cast<nt_shape_kind>(kind), sides, radius, half_angle, transition};
    nt_problem problem{};
    raise_on(nt_shape_check(&shape, &problem), problem, "shape");
    return shape;
}

// What numpy broadcasts before the call: arrays of the same shape.
static py::ssize_t common_size(const Array &first, const Array &second)
{
    if (first.size() != second.size())
        throw std::invalid_argument("arrays of different sizes");
    return first.size();
}

static py::array_t<double> like(const Array &array)
{
    return py::array_t<double>(std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()));
}

// out_j[i] = f(first[i], second[i], out) for the N numbers that f writes, without the GIL.
template <int N, class Function> static py::tuple map_pairs(const Array &first, const Array &second, Function f)
{
    const py::ssize_t count = common_size(first, second);
    const double *x = first.data(), *y = second.data();
    py::array_t<double> arrays[N];
    double *out[N];
    for (int j = 0; j < N; ++j) {
        arrays[j] = like(first);
        out[j] = arrays[j].mutable_data();
    }
    {
        py::gil_scoped_release release;
        for (py::ssize_t i = 0; i < count; ++i) {
            double numbers[N];
            f(x[i], y[i], numbers);
            for (int j = 0; j < N; ++j)
                out[j][i] = numbers[j];
        }
    }
    py::tuple columns(N);
    for (int j = 0; j < N; ++j)
        columns[static_cast<std::size_t>(j)] = arrays[j];
    return columns;
}

static void put(const nt_law_value &value, double *out)
{
    out[0] = value.U, out[1] = value.F, out[2] = value.k, out[3] = value.a;
}

static py::tuple eval(const nt_shape &shape, const Array &indentation, const Array &modulus)
{
    return map_pairs<4>(indentation, modulus,
                        [&shape](double d, double E, double *out) { put(nt_shape_eval(&shape, E, d), out); });
}

static py::tuple indentation_at(const nt_shape &shape, const Array &force, const Array &modulus)
{
    return map_pairs<1>(force, modulus,
                        [&shape](double F, double E, double *out) { *out = nt_shape_indentation(&shape, E, F); });
}

static py::tuple validity(const nt_shape &shape, const Array &radius, const Array &indentation, double thickness)
{
    return map_pairs<5>(radius, indentation, [&shape, thickness](double a, double d, double *out) {
        nt_contact_validity found = {missing, missing, missing, missing, 0};
        const bool judged = nt_contact_validity_of(&shape, a, d, thickness, &found) == NT_OK;
        const double numbers[] = {found.radius_ratio, found.slope, found.strain, found.thickness_ratio,
                                  judged ? found.outside : missing};
        std::copy(numbers, numbers + 5, out);
    });
}

// Columns: indentation, deflection, then {U, F, k, a} of the tip.
static py::tuple solve(const nt_shape &shape, const Array &displacement, const Array &modulus, double spring_constant,
                       double angle)
{
    const nt_lever lever = {spring_constant, angle};
    return map_pairs<6>(displacement, modulus, [&](double D, double E, double *out) {
        nt_stage_displacement found = {missing, missing, {missing, missing, missing, missing}};
        (void)nt_stage_displacement_solve(&shape, E, &lever, D, &found);
        out[0] = found.indentation, out[1] = found.deflection;
        put(found.value, out + 2);
    });
}

static nt_jkr_shape jkr_of(const nt_shape &shape, double modulus, double work_of_adhesion)
{
    const nt_jkr_shape contact = {shape, modulus, work_of_adhesion};
    nt_problem problem{};
    raise_on(nt_jkr_shape_check(&contact, &problem), problem, "adhesive shape");
    return contact;
}

static py::tuple jkr_eval(const nt_jkr_shape &contact, const Array &indentation, int branch)
{
    return map_law(indentation, [&contact, branch](double d) {
        nt_law_value value = {missing, missing, missing, missing};
        (void)nt_jkr_shape_eval(&contact, d, static_cast<nt_branch>(branch), &value);
        return value;
    });
}

static py::array_t<double> jkr_indentation(const nt_jkr_shape &contact, const Array &force, int branch)
{
    py::array_t<double> out = like(force);
    const double *F = force.data();
    double *d = out.mutable_data();
    const py::ssize_t count = force.size();
    py::gil_scoped_release release;
    for (py::ssize_t i = 0; i < count; ++i) {
        d[i] = missing;
        (void)nt_jkr_shape_indentation(&contact, F[i], static_cast<nt_branch>(branch), &d[i]);
    }
    return out;
}

static void bind_adhesive(py::module_ &module)
{
    py::class_<nt_jkr_shape>(module, "JkrShape")
        .def(py::init(&jkr_of))
        .def("eval", &jkr_eval)
        .def("indentation", &jkr_indentation)
        .def_property_readonly("pull_off_force", [](const nt_jkr_shape &c) { return nt_jkr_shape_pull_off_force(&c); })
        .def_property_readonly("pull_off_indentation",
                               [](const nt_jkr_shape &c) { return nt_jkr_shape_pull_off_indentation(&c); });
    module.attr("lambda_per_tabor") = NT_LAMBDA_PER_TABOR;
    module.def("tabor_mu", [](double radius, double modulus, double work, double distance) {
        const nt_contact contact = {radius, modulus, work, 0.0};
        return nt_tabor_mu(&contact, distance);
    });
    module.def("cohesive_stress_of_range", &nt_cohesive_stress_of_range);
    module.def("cohesive_stress_laplace", &nt_cohesive_stress_laplace);
    module.def("effective_radius", &nt_effective_radius);
}

void bind_geometry(py::module_ &module)
{
    py::class_<nt_shape>(module, "Shape")
        .def(py::init(&shape_of))
        .def("eval", &eval)
        .def("indentation", &indentation_at)
        .def("validity", &validity)
        .def("stage_displacement", &solve);
    module.def("pyramid_equivalent_angle", &nt_pyramid_equivalent_angle);
    module.def("stage_displacement_approximate",
               [](const Array &displacement, double radius, double modulus, double spring_constant, double angle) {
                   const nt_contact contact = {radius, modulus, 0.0, 0.0};
                   const nt_lever lever = {spring_constant, angle};
                   return map_pairs<1>(displacement, displacement, [&](double D, double, double *out) {
                       *out = nt_stage_displacement_approximate(&contact, &lever, D);
                   });
               });
    bind_adhesive(module);
}
