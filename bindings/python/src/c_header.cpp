// SPDX-License-Identifier: BSD-3-Clause
// force_table.h, and the constants of plan and touch step in single precision, as C.
#include "control.h"
#include "descriptions.h"
#include "nanotouch/advanced/force_table.h"
#include "nanotouch_single_text.hpp"

namespace
{
struct ForceTable {
    std::vector<nt_force_piece> pieces = std::vector<nt_force_piece>(NT_FORCE_PIECES);
    nt_force_table table{};
};

std::unique_ptr<ForceTable> table_of(const nt_plan &plan)
{
    auto made = std::make_unique<ForceTable>();
    nt_problem problem{};
    raise_on(nt_force_table_make(&made->table, made->pieces.data(), NT_FORCE_PIECES, &plan, &problem), problem,
             "force table");
    return made;
}

std::string piece_text(const nt_force_piece &piece)
{
    std::string text = "    {" + nt_number_text(piece.gap) + ", " + nt_number_text(piece.per_width) + ", {";
    for (int i = 0; i < 4; ++i)
        text += (i ? ", " : "") + nt_number_text(piece.cubic[i]);
    return text + "}},\n";
}

// The pieces; and what goes into the struct behind the pointer to them.
py::tuple text_of_table(const ForceTable &held)
{
    const nt_force_table &table = held.table;
    std::string pieces = "{\n";
    for (int i = 0; i < table.contact + table.apart; ++i)
        pieces += piece_text(held.pieces[static_cast<size_t>(i)]);
    std::string rest = "    " + std::to_string(table.contact) + ", /* contact */\n    " + std::to_string(table.apart) +
                       ", /* apart */\n";
    const std::pair<const char *, float> numbers[] = {{"capture_gap", table.capture_gap},
                                                      {"release_gap", table.release_gap},
                                                      {"farthest", table.farthest},
                                                      {"scale", table.scale},
                                                      {"bound", table.bound},
                                                      {"fold_distance", table.fold_distance}};
    for (const auto &[name, value] : numbers)
        rest += "    " + nt_number_text(value) + ", /* " + name + " */\n";
    return py::make_tuple(pieces + "}", rest);
}

std::string touch_text(const Described<nt_rig> &rig, const Described<nt_settings> &settings, const std::string &mode)
{
    nt_touch touch;
    nt_problem problem{};
    raise_on(nt_touch_make(&touch, &rig.value, &settings.value, mode_of(mode), &problem), problem, "touch step");
    return nt_text_of(touch, "");
}

// Force and stiffness along gaps, in their order, as the controller computes them.
py::tuple run(const ForceTable &held, const py::array_t<float, py::array::c_style | py::array::forcecast> &gaps,
              bool is_attached)
{
    const py::ssize_t count = gaps.size();
    py::array_t<float> force(count), stiffness(count);
    int attached = is_attached;
    for (py::ssize_t i = 0; i < count; ++i) {
        const nt_force_here here = nt_force_table_eval(&held.table, &attached, gaps.data()[i]);
        force.mutable_data()[i] = here.force;
        stiffness.mutable_data()[i] = here.stiffness;
    }
    return py::make_tuple(force, stiffness);
}
} // namespace

void bind_c_header(py::module_ &module)
{
    py::class_<ForceTable>(module, "ForceTable")
        .def(py::init(&table_of))
        .def("text", &text_of_table)
        .def("run", &run)
        .def_property_readonly("pieces", [](const ForceTable &t) { return t.table.contact + t.table.apart; })
        .def_property_readonly("scale", [](const ForceTable &t) { return t.table.scale; })
        .def_property_readonly("bound", [](const ForceTable &t) { return t.table.bound; })
        .def_property_readonly("fold_distance", [](const ForceTable &t) { return t.table.fold_distance; })
        .def_property_readonly("capture_gap", [](const ForceTable &t) { return t.table.capture_gap; })
        .def_property_readonly("release_gap", [](const ForceTable &t) { return t.table.release_gap; })
        .def_property_readonly("farthest", [](const ForceTable &t) { return t.table.farthest; });
    module.def("touch_text", &touch_text);
}
