// SPDX-License-Identifier: BSD-3-Clause
// view.h: what is drawn of a contact
#include "nanotouch/advanced/view.h"
#include "chapters.h"

#include "descriptions.h"

static_assert(sizeof(nt_view_point) == 2 * sizeof(double), "points are rows of two numbers");
static_assert(sizeof(nt_view_profile) == 3 * sizeof(double), "profiles are rows of three numbers");

// Rows of gap and force of one part of the curve.
static py::array_t<double> curve(const nt_plan &plan, int part, double nearest, double farthest, long count)
{
    std::vector<nt_view_point> points(static_cast<size_t>(count));
    const nt_view_range range = {static_cast<nt_view_part>(part), nearest, farthest};
    const long made = nt_view_curve(&plan, nullptr, &range, points.data(), count);
    py::array_t<double> rows({static_cast<py::ssize_t>(made), py::ssize_t{2}});
    std::copy_n(reinterpret_cast<const double *>(points.data()), 2 * made, rows.mutable_data());
    return rows;
}

// Of a pose (gap, force, the tip's share): rows of deformed tip, deformed sample, rigid tip at each r; a, c, attached.
static py::tuple section(const nt_plan &plan, const std::array<double, 3> &at, const Array &r)
{
    const nt_view_pose pose = {at[0], at[1], at[2]};
    const nt_view_contact contact = nt_view_contact_at(&plan, nullptr, &pose);
    py::array_t<double> rows({r.size(), py::ssize_t{3}});
    nt_view_section(&contact, r.data(), reinterpret_cast<nt_view_profile *>(rows.mutable_data()),
                    static_cast<long>(r.size()));
    return py::make_tuple(rows, contact.contact_radius, contact.cohesive_radius, contact.attached != 0);
}

void bind_view(py::module_ &module)
{
    module.def("view_curve", &curve);
    module.def("view_section", &section);
    module.def("view_tip_share", [](const Described<nt_scene> &scene) { return nt_view_tip_share(&scene.value); });
}
