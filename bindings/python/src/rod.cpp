// SPDX-License-Identifier: BSD-3-Clause
// rod.h: a rod that a tip pushes. A state is one array: pose, tip, force, three energies, then the pulls.
#include <array>
#include <cstring>

#include "chapters.h"

enum { OF_STATE = 10 }; // numbers before the pulls

static std::unique_ptr<nt_rod> make(const std::vector<double> &values)
{
    int count = 0;
    const nt_field *fields = nt_rod_fields(&count);
    if (static_cast<int>(values.size()) != count)
        throw std::invalid_argument("rod: one value for each field");
    auto made = std::make_unique<nt_rod>(nt_rod_defaults());
    for (int i = 0; i < count; ++i)
        nt_field_set(&fields[i], made.get(), values[i]);
    nt_problem problem{};
    raise_on(nt_rod_check(made.get(), &problem), problem, "rod");
    return made;
}

static void put(const nt_rod_state &state, double *row)
{
    std::memcpy(row, state.pose, sizeof state.pose);
    std::memcpy(row + 3, state.tip, sizeof state.tip);
    std::memcpy(row + 5, state.force, sizeof state.force);
    const double energies[] = {state.stored, state.dissipated, state.work};
    std::memcpy(row + 7, energies, sizeof energies);
}

static Array array_of(const nt_rod &self, const nt_rod_state &state)
{
    const py::ssize_t count = static_cast<py::ssize_t>(self.elements);
    Array made(std::vector<py::ssize_t>{OF_STATE + 2 * count});
    put(state, made.mutable_data());
    std::memcpy(made.mutable_data() + OF_STATE, state.pulls, sizeof(double) * 2 * static_cast<size_t>(count));
    return made;
}

static nt_rod_state state_of(const nt_rod &self, const Array &values)
{
    const py::ssize_t count = static_cast<py::ssize_t>(self.elements);
    if (values.size() != OF_STATE + 2 * count)
        throw std::invalid_argument("rod: a state of a rod with as many elements");
    nt_rod_state state{};
    const double *row = values.data();
    std::memcpy(state.pose, row, sizeof state.pose);
    std::memcpy(state.tip, row + 3, sizeof state.tip);
    std::memcpy(state.force, row + 5, sizeof state.force);
    state.stored = row[7];
    state.dissipated = row[8];
    state.work = row[9];
    std::memcpy(state.pulls, row + OF_STATE, sizeof(double) * 2 * static_cast<size_t>(count));
    return state;
}

static Array place(const nt_rod &self, const std::array<double, 3> &pose, const std::array<double, 2> &tip)
{
    nt_rod_state state{};
    raise_on(nt_rod_place(&self, pose.data(), tip.data(), &state), "rod: the tip touches it");
    return array_of(self, state);
}

// The state at the end, and a row for each point of the path.
static py::tuple run(const nt_rod &self, const Array &from, const Array &tips)
{
    nt_rod_state state = state_of(self, from);
    const py::ssize_t count = tips.size() / 2;
    Array rows(std::vector<py::ssize_t>{count, OF_STATE});
    double *row = rows.mutable_data();
    const double *tip = tips.data();
    nt_status status = NT_OK;
    {
        py::gil_scoped_release release;
        for (py::ssize_t i = 0; i < count && status == NT_OK; ++i, row += OF_STATE) {
            status = nt_rod_advance(&self, &state, tip + 2 * i);
            put(state, row);
        }
    }
    raise_on(status, "rod");
    return py::make_tuple(array_of(self, state), rows);
}

void bind_rod(py::module_ &module)
{
    py::class_<nt_rod>(module, "Rod")
        .def(py::init(&make))
        .def("place", &place)
        .def("run", &run)
        .def("half_width", &nt_rod_half_width)
        .def("friction", &nt_rod_friction)
        .def("stiffness", &nt_rod_stiffness);
    module.def("rod_turning_point", &nt_rod_turning_point);
}
