/* SPDX-License-Identifier: BSD-3-Clause
 * Private. One step of a particle: the minimum of its energy and of what its bristles take. */
#ifndef NANOTOUCH_MANIPULATION_BALANCE_H
#define NANOTOUCH_MANIPULATION_BALANCE_H

#include "nanotouch/particle.h"

enum { FREEDOMS = 6 }; /* displacement of the centre, and R times its turn [m] */

/* All that stays the same in a step. */
typedef struct balance {
    const nt_pushing *pushing;
    const nt_particle_state *from;                    /* with the bristles' limits of now */
    double tip[3];                                    /* where the step ends */
    double limits[NT_PARTICLE_CONTACTS][NT_BRISTLES]; /* in newtons, of R times an angle, too [N] */
    double normals[NT_PARTICLE_CONTACTS][3];          /* from the other body to the centre */
    int attached[NT_PARTICLE_CONTACTS];               /* becomes 1 once a contact is found on the way */
} balance;

/* What there is at a motion. */
typedef struct balance_value {
    double cost;               /* energy of the contacts, cost of the bristles [J] */
    double gradient[FREEDOMS]; /* [N] */
    double tip_force[3];       /* on the tip [N] */
    double scale;              /* sum of the sizes of all forces [N] */
    nt_law_value contacts[NT_PARTICLE_CONTACTS];
    double stretches[NT_PARTICLE_CONTACTS][NT_BRISTLES][3]; /* [m] */
} balance_value;

/* Fills in contacts, attached, normal and stored of a state, from its position, tip and bristles. */
nt_status balance_contacts(const nt_pushing *pushing, nt_particle_state *state);
/* The motion [m] of the particle, and what there is then. NT_E_NO_CONVERGENCE. */
nt_status balance_find(balance *step, double motion[FREEDOMS], balance_value *value);

#endif
