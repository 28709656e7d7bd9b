// SPDX-License-Identifier: BSD-3-Clause
// plasticity.h
#include <array>
#include <cstring>
#include <optional>

#include "chapters.h"
#include "internal/plasticity.h"

static nt_indentation indentation_of(double radius, double modulus, double strength)
{
    const nt_indentation made = {radius, modulus, strength};
    nt_problem problem{};
    raise_on(nt_indentation_check(&made, &problem), problem, "indentation");
    return made;
}

// A row of the 9 numbers of a first loading for each contact radius.
static Array first(const nt_indentation &self, const Array &radii)
{
    static_assert(sizeof(nt_first_loading) == 9 * sizeof(double));
    Array rows(std::vector<py::ssize_t>{radii.size(), 9});
    auto *row = reinterpret_cast<nt_first_loading *>(rows.mutable_data());
    for (py::ssize_t i = 0; i < radii.size(); ++i)
        row[i] = nt_indentation_first(&self, radii.data()[i]);
    return rows;
}

static Array each(const nt_indentation &self, const Array &values, double (*function)(const nt_indentation *, double))
{
    Array out(std::vector<py::ssize_t>{values.size()});
    for (py::ssize_t i = 0; i < values.size(); ++i)
        out.mutable_data()[i] = function(&self, values.data()[i]);
    return out;
}

// The state (6 numbers) after each indentation.
static Array run(const nt_indentation &self, const Array &from, const Array &depths)
{
    static_assert(sizeof(nt_indentation_state) == 6 * sizeof(double));
    if (from.size() != 6)
        throw std::invalid_argument("indentation: a state of 6 numbers");
    nt_indentation_state state;
    std::memcpy(&state, from.data(), sizeof state);
    Array after(std::vector<py::ssize_t>{depths.size(), 6});
    raise_on(nt_indentation_run_n(&self, &state, depths.data(),
                                  reinterpret_cast<nt_indentation_state *>(after.mutable_data()),
                                  static_cast<long>(depths.size())),
             "indentation");
    return after;
}

using Numbers = std::array<double, 6>;

static nt_imprint imprint_of(const Numbers &n)
{
    return {{n[0], n[1]}, {n[2], n[3]}, n[4], n[5]};
}

static nt_displacement displacement_of(double piled_up, double debris, double ridge_width)
{
    const nt_displacement made = {piled_up, debris, ridge_width};
    nt_problem problem{};
    raise_on(nt_displacement_check(&made, &problem), problem, "displacement");
    return made;
}

// First row, rows, first column, columns of the pixels of an edit, and its four volumes.
static py::tuple tuple_of(const nt_edit &edit)
{
    return py::make_tuple(edit.first_y, edit.count_y, edit.first_x, edit.count_x, edit.removed, edit.piled_up,
                          edit.densified, edit.debris);
}

static nt_height_map map_of(const Array &heights, double dy, double dx)
{
    return {heights.data(), static_cast<long>(heights.shape(1)), static_cast<long>(heights.shape(0)), dx, dy};
}

// All of a map; the edits below look at their own pixels only.
static void check_map(const Array &heights, double dy, double dx)
{
    const nt_height_map map = map_of(heights, dy, dx);
    nt_problem problem{};
    raise_on(nt_height_map_check(&map, &problem), problem, "heights");
}

static py::tuple extent(const nt_displacement &self, const Array &heights, double dy, double dx, const Numbers &imprint)
{
    const nt_height_map map = map_of(heights, dy, dx);
    const nt_imprint made = imprint_of(imprint);
    nt_edit edit{};
    nt_problem problem{};
    raise_on(nt_imprint_extent(&made, &self, &map, &edit, &problem), problem, "imprint");
    return tuple_of(edit);
}

static py::tuple edit(const nt_displacement &self, py::array_t<double, py::array::c_style> heights, double dy,
                      double dx, const std::optional<Numbers> &before, const Numbers &after)
{
    const nt_height_map map = map_of(heights, dy, dx);
    const nt_imprint made = imprint_of(after), gone = before ? imprint_of(*before) : made;
    const nt_imprint_change change = {before ? &gone : nullptr, &made, &self};
    nt_edit done{};
    nt_problem problem{};
    raise_on(nt_imprint_edit(heights.mutable_data(), &map, &change, &done, &problem), problem, "imprint");
    return tuple_of(done);
}

static nt_scratching scratching_of(double radius, double hardness, double shear, double thickness, double substrate)
{
    const nt_scratching made = {radius, hardness, shear, thickness, substrate};
    nt_problem problem{};
    raise_on(nt_scratching_check(&made, &problem), problem, "scratching");
    return made;
}

static py::tuple scratch(const nt_scratching &self, double load)
{
    nt_groove groove{};
    nt_problem problem{};
    raise_on(nt_scratch(&self, load, &groove, &problem), problem, "scratching");
    return py::make_tuple(groove.depth, groove.width, groove.ploughing, groove.shearing, groove.layer_load,
                          groove.is_cut_through != 0);
}

void bind_plasticity(py::module_ &module)
{
    py::class_<nt_indentation>(module, "Indentation")
        .def(py::init(&indentation_of))
        .def("first", &first)
        .def("radius_at_depth",
             [](const nt_indentation &self, const Array &d) { return each(self, d, nt_indentation_radius_at_depth); })
        .def("radius_at_load",
             [](const nt_indentation &self, const Array &F) { return each(self, F, nt_indentation_radius_at_load); })
        .def("run", &run)
        .def_property_readonly("yield_load",
                               [](const nt_indentation &self) { return nt_indentation_yield_load(&self); })
        .def_property_readonly("plastic_load",
                               [](const nt_indentation &self) { return nt_indentation_plastic_load(&self); });
    py::class_<nt_displacement>(module, "Displacement")
        .def(py::init(&displacement_of))
        .def("extent", &extent)
        .def("edit", &edit)
        .def_static("check_map", &check_map)
        .def_static("volume", [](const Numbers &imprint) {
            const nt_imprint made = imprint_of(imprint);
            return nt_imprint_volume(&made);
        });
    py::class_<nt_scratching>(module, "Scratching").def(py::init(&scratching_of)).def("scratch", &scratch);
    module.def("worn_volume", &nt_worn_volume);
    module.def("worn_flat", &nt_worn_flat);
}
