/* SPDX-License-Identifier: BSD-3-Clause
 * Private. Particles of a set: their laws, at rest, and what their contacts are. */
#ifndef NANOTOUCH_MANIPULATION_SET_H
#define NANOTOUCH_MANIPULATION_SET_H

#include "manipulation/balance.h"

/* The fields of an nt_particle_contact of a description `type`. */
#define PARTICLE_CONTACT(type, side, of)                                                                               \
    NT_FIELD(type, side.model, "hertz|dmt|jkr|maugis", 0.0, 3.0, "contact law " of),                                   \
        NT_FIELD(type, side.effective_modulus, "Pa", 1e2, 1e13, "E* " of),                                             \
        NT_FIELD(type, side.work_of_adhesion, "J/m^2", 0.0, 10.0, "w " of),                                            \
        NT_FIELD(type, side.cohesive_stress, "Pa", 0.0, 1e12, "sigma0 " of ", for maugis"),                            \
        NT_FIELD(type, side.effective_shear_modulus, "Pa", 1.0, 1e13, "G* " of ", 1/G* = sum of (2 - nu)/G"),          \
        NT_FIELD(type, side.shear_strength, "Pa", 0.0, 1e12, "tau " of ", friction per contact area"),                 \
        NT_FIELD(type, side.coefficient, "", 0.0, 100.0, "alpha " of ", friction per load inside the contact"),        \
        NT_FIELD(type, side.rolling_distance, "m", 0.0, 1e-3, "xi " of ", way that it rolls before it gives way")

/* A contact made ready; `radius` reduced [m]. What was given has been checked, all but the cohesive stress. */
nt_status particle_laws(nt_particle_laws *laws, const nt_particle_contact *given, double radius);
/* NT_OK, or what no contact may be: G* over E*, a sphere that adhesion flattens. names: of both fields. */
nt_status particle_check_contact(const nt_particle_contact *contact, double radius, const char *const names[2],
                                 nt_problem *problem);
/* What a state has: no more of it than its particles. */
void particles_copy(nt_particles_state *to, const nt_particles_state *from);
/* On the substrate, unstrained. */
nt_particle_state particle_at_rest(const nt_pushing *pushing, double x, double y);
/* Fills in contacts, attached, normals and stored of all, from their places, tip and bristles. */
nt_status particles_contacts(const nt_particles *by, nt_particles_state *state);

#endif
