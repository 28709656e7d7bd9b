// SPDX-License-Identifier: BSD-3-Clause
// What the chapters share: arrays in, errors out.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>

#include "nanotouch/nanotouch.h"

namespace py = pybind11;
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

void bind_contact(py::module_ &module);
void bind_contact_reduced(py::module_ &module);
void bind_maugis_bank(py::module_ &module);
void bind_forces(py::module_ &module);
void bind_friction(py::module_ &module);
void bind_geometry(py::module_ &module);
void bind_margins(py::module_ &module);
void bind_materials(py::module_ &module);
void bind_surface(py::module_ &module);
void bind_descriptions(py::module_ &module);
void bind_particle(py::module_ &module);
void bind_pushed(py::module_ &module);
void bind_rod(py::module_ &module);
void bind_plan(py::module_ &module);
void bind_plasticity(py::module_ &module);
void bind_rheology(py::module_ &module);
void bind_scan(py::module_ &module);
void bind_steady(py::module_ &module);
void bind_tapping(py::module_ &module);
void bind_terrain(py::module_ &module);
void bind_interaction(py::module_ &module);
void bind_control(py::module_ &module);
void bind_faults(py::module_ &module);
void bind_hal(py::module_ &module);
void bind_session(py::module_ &module);
void bind_frames(py::module_ &module);
void bind_commands(py::module_ &module);
void bind_view(py::module_ &module);
void bind_curves(py::module_ &module);
void bind_linux(py::module_ &module);
void bind_c_header(py::module_ &module);

// Of a value out of its range.
inline nt_problem problem_of(const char *field, const char *unit, double value, double minimum, double maximum)
{
    nt_problem problem{};
    problem.field = field;
    problem.unit = unit;
    problem.value = value;
    problem.minimum = minimum;
    problem.maximum = maximum;
    return problem;
}

// Raises the Python exception of a status, with this message.
[[noreturn]] void raise(nt_status status, const std::string &message);
// Raises the Python exception of a status; `what` says what was attempted. Returns only for NT_OK.
void raise_on(nt_status status, const std::string &what);
// The same with the offending field, its value, unit and range.
void raise_on(nt_status status, const nt_problem &problem, const std::string &what);

// A law of one scalar applied to every element of an array: {U, F, k, a} of the same shape, without the GIL.
template <class Law> py::tuple map_law(const Array &in, Law law)
{
    const std::vector<py::ssize_t> shape(in.shape(), in.shape() + in.ndim());
    py::array_t<double> U(shape), F(shape), k(shape), a(shape);
    const double *x = in.data();
    double *out[4] = {U.mutable_data(), F.mutable_data(), k.mutable_data(), a.mutable_data()};
    const py::ssize_t count = in.size();
    {
        py::gil_scoped_release release;
        for (py::ssize_t i = 0; i < count; ++i) {
            const nt_law_value value = law(x[i]);
            out[0][i] = value.U;
            out[1][i] = value.F;
            out[2][i] = value.k;
            out[3][i] = value.a;
        }
    }
    return py::make_tuple(U, F, k, a);
}

// Leads something along a path of points x, y, z, without the GIL: one row of so many numbers for each. `step` goes to
// a point and fills the row; its first refusal ends the way, and is raised.
template <class Step> Array run_along(const Array &points, py::ssize_t columns, const char *what, Step step)
{
    const py::ssize_t count = points.size() / 3;
    Array rows(std::vector<py::ssize_t>{count, columns});
    double *row = rows.mutable_data();
    const double *point = points.data();
    nt_status status = NT_OK;
    {
        py::gil_scoped_release release;
        for (py::ssize_t i = 0; i < count && status == NT_OK; ++i)
            status = step(point + 3 * i, row + columns * i);
    }
    raise_on(status, what);
    return rows;
}
