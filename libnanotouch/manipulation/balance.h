/* SPDX-License-Identifier: BSD-3-Clause
 * Private. One step of particles and tip: the minimum of their energy and of what their bristles take.
 *
 * A link is a contact of a particle with another body. The motion has six freedoms for each particle, then one for each
 * axis along which the tip hangs on a spring of its lever. */
#ifndef NANOTOUCH_MANIPULATION_BALANCE_H
#define NANOTOUCH_MANIPULATION_BALANCE_H

#include "nanotouch/advanced/manipulation.h"

enum {
    FREEDOMS = 6, /* of a particle: displacement of its centre, and R times its turn [m] */
    BALANCE_FREEDOMS = FREEDOMS * NT_PARTICLES + 3,
    BALANCE_LINKS = NT_PARTICLE_CONTACTS * NT_PARTICLES + NT_PARTICLE_PAIRS
};
/* Bodies of a link that are no particles. */
enum { BODY_SUBSTRATE = -1, BODY_TIP = -2 };

typedef struct balance_link {
    const nt_particle_laws *laws;
    const nt_bristle *bristles; /* three, as the step begins */
    double limits[NT_BRISTLES]; /* in newtons, of R times an angle, too [N] */
    double normal[3];           /* from the other body to the particle, as the step begins */
    int particle, other;
    int attached; /* becomes 1 once a contact is found on the way */
} balance_link;

/* All that stays the same in a step. */
typedef struct balance {
    const nt_particle *particle;
    int particles, links, freedoms;
    double from[NT_PARTICLES][3]; /* their centres [m] */
    double tip[3];                /* its apex, as the step begins [m] */
    double base[3];               /* where the step ends [m] */
    double lever[3];              /* [N/m] */
    int tip_freedom[3];           /* its place in the motion; -1: the tip is held at the base */
    balance_link link[BALANCE_LINKS];
} balance;

typedef struct balance_link_value {
    nt_law_value contact;
    double normal[3];
    double stretches[NT_BRISTLES][3]; /* [m] */
} balance_link_value;

/* What there is at a motion. */
typedef struct balance_value {
    double cost;                       /* energy of contacts and lever, cost of the bristles [J] */
    double gradient[BALANCE_FREEDOMS]; /* [N] */
    double tip[3];                     /* apex [m] */
    double tip_force[3];               /* on the tip [N] */
    double tip_shares[NT_PARTICLES][3];
    double scale; /* sum of the sizes of all forces [N] */
    balance_link_value link[BALANCE_LINKS];
} balance_value;
typedef double balance_matrix[BALANCE_FREEDOMS][BALANCE_FREEDOMS];

/* Which axes of the tip are free; number of freedoms. */
void balance_count(balance *step);
/* Unit vector from the tip to the centre, and how deep they overlap [m]; a cone's flank has one elevation. */
double balance_tip_indentation(const nt_particle *particle, const double centre[3], const double tip[3], double n[3]);
nt_status balance_contact(const nt_particle_laws *laws, int attached, double indentation, nt_law_value *value);
/* What there is at a motion; fails as the contact laws. */
nt_status balance_value_at(const balance *step, const double motion[], balance_value *value);
/* Second derivatives, their lower half. A contact's negative stiffness counts by its size, so that each step goes down.
 */
void balance_hessian(const balance *step, const balance_value *value, balance_matrix hessian);
/* The Cholesky factor of H + damping tr(H), in its lower half. 0: it is not positive. */
int balance_factor(balance_matrix hessian, int freedoms, double damping);
/* x = -(H + damping tr(H))^-1 g, of the lower half of H; 0 where that is not positive. */
int balance_solve(balance_matrix hessian, int freedoms, double damping, const double g[], double x[]);
/* The motion [m] to the minimum, and what there is then. NT_E_NO_CONVERGENCE. */
nt_status balance_find(balance *step, double motion[], balance_value *value);
/* How the force on the tip falls as a tip that is held along z goes up [N/m]. */
double balance_resistance(const balance *step, const balance_value *value);

#endif
