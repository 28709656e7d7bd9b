// SPDX-License-Identifier: BSD-3-Clause
// friction.h, advanced/corrugation.h
#include <cstring>

#include "chapters.h"
#include "internal/friction.h"
#include "nanotouch/advanced/corrugation.h"

// Rows of (way x, way y) and (radius, load) from a state (6 numbers, as nt_friction_state): rows of states after each.
static Array run(const nt_friction &friction, const Array &from, const Array &ways, const Array &contacts)
{
    static_assert(sizeof(nt_friction_state) == 6 * sizeof(double) && sizeof(nt_friction_contact) == 2 * sizeof(double));
    const py::ssize_t count = ways.shape(0);
    if (from.size() != 6 || ways.size() != 2 * count || contacts.size() != 2 * count)
        throw std::invalid_argument("friction: a state of 6, and rows of 2 numbers");
    Array after(std::vector<py::ssize_t>{count, 6});
    nt_friction_state state;
    std::memcpy(&state, from.data(), sizeof state);
    const nt_friction_path path = {reinterpret_cast<const nt_friction_contact *>(contacts.data()),
                                   reinterpret_cast<const double (*)[2]>(ways.data()),
                                   reinterpret_cast<nt_friction_state *>(after.mutable_data()),
                                   static_cast<long>(count)};
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_friction_run_n(&friction, &state, &path);
    }
    raise_on(status, "friction");
    return after;
}

static py::array_t<double> compressive_load(int model, const nt_contact &contact, const Array &force,
                                            const Array &radius)
{
    if (force.size() != radius.size())
        throw std::invalid_argument("compressive load: as many forces as radii");
    py::array_t<double> out(std::vector<py::ssize_t>(force.shape(), force.shape() + force.ndim()));
    const double *F = force.data(), *a = radius.data();
    double *load = out.mutable_data();
    const py::ssize_t count = force.size();
    {
        py::gil_scoped_release release;
        for (py::ssize_t i = 0; i < count; ++i)
            load[i] = nt_compressive_load(static_cast<nt_model>(model), &contact, {0.0, F[i], 0.0, a[i]});
    }
    return out;
}

static nt_friction friction_of(double modulus, double compliance, double strength, double coefficient)
{
    const nt_friction friction = {modulus, compliance, strength, coefficient};
    nt_problem problem{};
    raise_on(nt_friction_check(&friction, &problem), problem, "friction");
    return friction;
}

static nt_corrugation corrugation_of(double energy, double period, double stiffness, double damping, double temperature)
{
    const nt_corrugation corrugation = {energy, period, stiffness, damping, temperature};
    nt_problem problem{};
    raise_on(nt_corrugation_check(&corrugation, &problem), problem, "corrugation");
    return corrugation;
}

static double mean_force(const nt_corrugation &corrugation, double speed)
{
    double force = 0.0;
    nt_problem problem{};
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_corrugation_mean_force(&corrugation, speed, &force, &problem);
    }
    raise_on(status, problem, "corrugation");
    return force;
}

void bind_friction(py::module_ &module)
{
    py::class_<nt_friction>(module, "Friction")
        .def(py::init(&friction_of))
        .def("run", &run)
        .def("stiffness", [](const nt_friction &self, double radius) { return nt_friction_stiffness(&self, radius); })
        .def("limit",
             [](const nt_friction &self, double radius, double load) {
                 const nt_friction_contact contact = {radius, load};
                 return nt_friction_limit(&self, &contact);
             })
        .def_static("effective_shear_modulus",
                    [](double tip, double tip_ratio, double sample, double sample_ratio) {
                        return nt_effective_shear_modulus({tip, tip_ratio}, {sample, sample_ratio});
                    })
        .def_static("compressive_load", [](int model, double radius, double modulus, double adhesion, double stress,
                                           const Array &force, const Array &contact_radius) {
            return compressive_load(model, {radius, modulus, adhesion, stress}, force, contact_radius);
        });
    py::class_<nt_corrugation>(module, "Corrugation")
        .def(py::init(&corrugation_of))
        .def("mean_force", &mean_force)
        .def_property_readonly("onset", [](const nt_corrugation &self) { return nt_corrugation_onset(&self); })
        .def_property_readonly("largest_force",
                               [](const nt_corrugation &self) { return nt_corrugation_largest_force(&self); });
}
