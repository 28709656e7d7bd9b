// SPDX-License-Identifier: BSD-3-Clause
// particle.h: a sphere on a substrate, and the tip that pushes it
#include <array>
#include <cstring>
#include <memory>

#include "chapters.h"

static std::unique_ptr<nt_pushing> make(const std::vector<double> &values)
{
    int count = 0;
    const nt_field *fields = nt_particle_fields(&count);
    if (static_cast<int>(values.size()) != count)
        throw std::invalid_argument("particle: one value for each field");
    nt_particle particle = nt_particle_defaults();
    for (int i = 0; i < count; ++i)
        nt_field_set(&fields[i], &particle, values[i]);
    auto made = std::make_unique<nt_pushing>();
    nt_problem problem{};
    raise_on(nt_pushing_init(made.get(), &particle, &problem), problem, "particle");
    return made;
}

static nt_particle_state place(const nt_pushing &self, double x, double y, const std::array<double, 3> &tip)
{
    nt_particle_state state{};
    raise_on(nt_particle_place(&self, x, y, tip.data(), &state),
             "particle: a place on the substrate that the tip does not touch");
    return state;
}

enum { POSITION = 0, TURNED = 3, FORCE = 6, ENERGIES = 9, CONTACTS = 12, GIVEN = 16, MODES = 22, COLUMNS = 23 };

static void put(const nt_particle_state &state, double *row)
{
    const double energies[] = {state.stored, state.dissipated, state.work};
    std::memcpy(row + POSITION, state.position, sizeof state.position);
    std::memcpy(row + TURNED, state.turned, sizeof state.turned);
    std::memcpy(row + FORCE, state.force, sizeof state.force);
    std::memcpy(row + ENERGIES, energies, sizeof energies);
    for (int i = 0; i < NT_PARTICLE_CONTACTS; ++i) {
        row[CONTACTS + 2 * i] = state.contacts[i].F;
        row[CONTACTS + 2 * i + 1] = state.contacts[i].a;
        for (int j = 0; j < NT_BRISTLES; ++j)
            row[GIVEN + NT_BRISTLES * i + j] = state.bristles[i][j].given;
    }
    row[MODES] = state.modes;
}

// The state at the end, and a row for each point of the path.
static py::tuple run(const nt_pushing &self, nt_particle_state state, const Array &tips)
{
    const py::ssize_t count = tips.size() / 3;
    Array rows(std::vector<py::ssize_t>{count, COLUMNS});
    double *row = rows.mutable_data();
    const double *tip = tips.data();
    nt_status status = NT_OK;
    {
        py::gil_scoped_release release;
        for (py::ssize_t i = 0; i < count && status == NT_OK; ++i, row += COLUMNS) {
            status = nt_particle_advance(&self, &state, tip + 3 * i);
            put(state, row);
        }
    }
    raise_on(status, "particle");
    return py::make_tuple(state, rows);
}

static py::tuple row_of(const nt_particle_state &state)
{
    double row[COLUMNS];
    put(state, row);
    return py::make_tuple(std::vector<double>(row, row + COLUMNS), std::vector<double>(state.tip, state.tip + 3));
}

void bind_particle(py::module_ &module)
{
    py::class_<nt_particle_state>(module, "ParticleState").def("read", &row_of);
    py::class_<nt_pushing>(module, "Pushing")
        .def(py::init(&make))
        .def("place", &place)
        .def("run", &run)
        .def("limit",
             [](const nt_pushing &self, int contact, int bristle, double radius, double load) {
                 const nt_friction_contact at = {radius, load};
                 return nt_particle_limit(&self.laws[contact], bristle, &at);
             })
        .def("stiffness", [](const nt_pushing &self, int contact, int bristle,
                             double radius) { return nt_particle_stiffness(&self.laws[contact], bristle, radius); })
        .def("rest", [](const nt_pushing &self, int contact) {
            const nt_particle_laws &laws = self.laws[contact];
            return py::make_tuple(laws.pull_off, laws.rest_radius, laws.rest_indentation);
        });
}
