// SPDX-License-Identifier: BSD-3-Clause
// advanced/manipulation.h: spheres on a substrate, and the tip that pushes them
#include <array>
#include <cstring>
#include <memory>

#include "chapters.h"
#include "internal/manipulation.h"

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
    const Array rows = run_along(tips, COLUMNS, "particle", [&](const double *tip, double *row) {
        const nt_status status = nt_particle_advance(&self, &state, tip);
        put(state, row);
        return status;
    });
    return py::make_tuple(state, rows);
}

static py::tuple row_of(const nt_particle_state &state)
{
    double row[COLUMNS];
    put(state, row);
    return py::make_tuple(std::vector<double>(row, row + COLUMNS), std::vector<double>(state.tip, state.tip + 3));
}

// The fields of both tables, one after the other.
static std::unique_ptr<nt_particles> make_set(const std::vector<double> &values)
{
    int count = 0, more = 0;
    const nt_field *fields = nt_particle_fields(&count), *others = nt_particles_fields(&more);
    if (static_cast<int>(values.size()) != count + more)
        throw std::invalid_argument("particles: one value for each field");
    nt_particles_setup setup = nt_particles_defaults();
    for (int i = 0; i < count; ++i)
        nt_field_set(&fields[i], &setup.particle, values[i]);
    for (int i = 0; i < more; ++i)
        nt_field_set(&others[i], &setup, values[count + i]);
    auto made = std::make_unique<nt_particles>();
    nt_problem problem{};
    raise_on(nt_particles_init(made.get(), &setup, &problem), problem, "particles");
    return made;
}

static nt_particles_state begin(const nt_particles &self, const std::array<double, 3> &base)
{
    nt_particles_state state{};
    raise_on(nt_particles_begin(&self, base.data(), &state), "particles: the tip begins above the substrate");
    return state;
}

static nt_particles_state lay(const nt_particles &self, nt_particles_state state, int number,
                              const std::array<double, 2> &place)
{
    raise_on(nt_particles_lay(&self, &state, number, place.data()),
             "particles: a place on the substrate that neither the tip nor another one touches");
    return state;
}

enum { SET_TIP = 0, SET_FORCE = 3, SET_ENERGIES = 6, SET_COLUMNS = 9, ONE_COLUMNS = 11 };

// Of the tip, then of each particle: place, turns, force on the tip, whether the tip touches, modes.
static void put_set(const nt_particles_state &state, double *row)
{
    const double energies[] = {state.stored, state.dissipated, state.work};
    std::memcpy(row + SET_TIP, state.tip, sizeof state.tip);
    std::memcpy(row + SET_FORCE, state.force, sizeof state.force);
    std::memcpy(row + SET_ENERGIES, energies, sizeof energies);
    for (int i = 0; i < state.count; ++i) {
        const nt_particle_state &of = state.particles[i];
        double *one = row + SET_COLUMNS + ONE_COLUMNS * i;
        std::memcpy(one, of.position, sizeof of.position);
        std::memcpy(one + 3, of.turned, sizeof of.turned);
        std::memcpy(one + 6, of.force, sizeof of.force);
        one[9] = of.attached[NT_AT_TIP];
        one[10] = of.modes;
    }
}

static py::tuple run_set(const nt_particles &self, nt_particles_state state, const Array &bases)
{
    const py::ssize_t columns = SET_COLUMNS + ONE_COLUMNS * state.count;
    const Array rows = run_along(bases, columns, "particles", [&](const double *base, double *row) {
        const nt_status status = nt_particles_advance(&self, &state, base);
        put_set(state, row);
        return status;
    });
    return py::make_tuple(state, rows);
}

static std::vector<double> row_of_set(const nt_particles_state &state)
{
    std::vector<double> row(SET_COLUMNS + ONE_COLUMNS * state.count);
    put_set(state, row.data());
    return row;
}

static void bind_set(py::module_ &module)
{
    py::class_<nt_particles_state>(module, "ParticlesState")
        .def("read", &row_of_set)
        .def_property_readonly(
            "base", [](const nt_particles_state &self) { return std::vector<double>(self.base, self.base + 3); });
    py::class_<nt_particles, std::shared_ptr<nt_particles>>(module, "Particles")
        .def(py::init(&make_set))
        .def("begin", &begin)
        .def("lay", &lay)
        .def("run", &run_set);
}

void bind_particle(py::module_ &module)
{
    bind_set(module);
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
