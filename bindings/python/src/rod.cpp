// SPDX-License-Identifier: BSD-3-Clause
// advanced/manipulation.h: a rod that a tip pushes. A state is one array: pose, tip, force, three energies, then the
// pulls.
#include <array>
#include <cstring>

#include "chapters.h"
#include "internal/manipulation.h"

enum { POSE = 0, BASE = 3, TIP = 6, FORCE = 9, ENERGIES = 12, RESISTANCE = 15, OF_STATE = 16 }; // before the pulls

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
    const double energies[] = {state.stored, state.dissipated, state.work};
    std::memcpy(row + POSE, state.pose, sizeof state.pose);
    std::memcpy(row + BASE, state.base, sizeof state.base);
    std::memcpy(row + TIP, state.tip, sizeof state.tip);
    std::memcpy(row + FORCE, state.force, sizeof state.force);
    std::memcpy(row + ENERGIES, energies, sizeof energies);
    row[RESISTANCE] = state.resistance;
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
    std::memcpy(state.pose, row + POSE, sizeof state.pose);
    std::memcpy(state.base, row + BASE, sizeof state.base);
    std::memcpy(state.tip, row + TIP, sizeof state.tip);
    std::memcpy(state.force, row + FORCE, sizeof state.force);
    state.stored = row[ENERGIES];
    state.dissipated = row[ENERGIES + 1];
    state.work = row[ENERGIES + 2];
    state.resistance = row[RESISTANCE];
    std::memcpy(state.pulls, row + OF_STATE, sizeof(double) * 2 * static_cast<size_t>(count));
    return state;
}

static Array place(const nt_rod &self, const std::array<double, 3> &pose, const std::array<double, 3> &base)
{
    nt_rod_state state{};
    raise_on(nt_rod_place(&self, pose.data(), base.data(), &state), "rod: the tip touches it");
    return array_of(self, state);
}

// The state at the end, and a row for each point of the path.
static py::tuple run(const nt_rod &self, const Array &from, const Array &bases)
{
    nt_rod_state state = state_of(self, from);
    const Array rows = run_along(bases, OF_STATE, "rod", [&](const double *base, double *row) {
        const nt_status status = nt_rod_advance(&self, &state, base);
        put(state, row);
        return status;
    });
    return py::make_tuple(array_of(self, state), rows);
}

void bind_rod(py::module_ &module)
{
    py::class_<nt_rod, std::shared_ptr<nt_rod>>(module, "Rod")
        .def(py::init(&make))
        .def("place", &place)
        .def("run", &run)
        .def("half_width", &nt_rod_half_width)
        .def("friction", &nt_rod_friction)
        .def("stiffness", &nt_rod_stiffness);
    module.def("rod_turning_point", &nt_rod_turning_point);
}
