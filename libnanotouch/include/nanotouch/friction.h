/* SPDX-License-Identifier: BSD-3-Clause
 * Friction of a tip that slides: a contact that sticks like a spring in the plane and slips at a limit.
 *
 * Stick: 8 a G* of the contact (Mindlin 1949, whole contact stuck) in series with the lateral compliance of tip and
 * lever. Slip: the force stays on the circle |f| = tau0 pi a^2 + alpha N_c. What slips, and what a changing contact
 * gives up, becomes heat; nothing of it comes back. All functions: thread-safe, no state but the caller's. */
#ifndef NANOTOUCH_FRICTION_H
#define NANOTOUCH_FRICTION_H

#include "nanotouch/advanced/field.h"
#include "nanotouch/contact.h"
#include "nanotouch/material.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a pair of materials and a lever are like sideways. */
typedef struct nt_friction {
    double effective_shear_modulus; /* G* [Pa] */
    double lateral_compliance;      /* of tip and lever, at the apex; 0: rigid [m/N] */
    double shear_strength;          /* tau0, of the contact area [Pa] */
    double coefficient;             /* alpha, of the load inside the contact [-] */
} nt_friction;
/* Silicon on silicon (G* = 15.2 GPa), rigid lever, tau0 = 100 MPa, alpha = 0.1. */
NT_API nt_friction nt_friction_defaults(void);
/* The table of its fields, with units and ranges; *count (NULL allowed) its length. */
NT_API const nt_field *nt_friction_fields(int *count);
/* NT_OK, or NT_E_NOT_FINITE / NT_E_RANGE with the first offending field in *problem (NULL allowed). */
NT_API nt_status nt_friction_check(const nt_friction *friction, nt_problem *problem);

/* G* [Pa] of two bodies: 1/G* = (2 - nu_1)/G_1 + (2 - nu_2)/G_2, G = E/(2 (1 + nu)) (Mindlin 1949). NaN in, NaN out. */
NT_API double nt_effective_shear_modulus(nt_material tip, nt_material sample);
/* Force that presses inside the contact [N], >= 0: the integral of the positive part of the pressure. `law` is what the
 * model returned. Hertz and DMT: 4/3 E* a^3/R; JKR and Maugis: less, their rim pulls (Maugis 1992, pressure of a
 * Dugdale zone; JKR is its limit). At pull-off the net load is negative, this one is not. NaN in, NaN out. */
NT_API NT_REALTIME double nt_compressive_load(nt_model model, const nt_contact *contact, nt_law_value law);

/* The contact that a step slides on. */
typedef struct nt_friction_contact {
    double radius;           /* a, >= 0 [m] */
    double compressive_load; /* N_c, >= 0 [N] */
} nt_friction_contact;
/* Stiffness of stick, contact and lever in series [N/m]; 0 without a contact. */
NT_API NT_REALTIME double nt_friction_stiffness(const nt_friction *friction, double radius);
/* Largest force, tau0 pi a^2 + alpha N_c [N]. */
NT_API NT_REALTIME double nt_friction_limit(const nt_friction *friction, const nt_friction_contact *contact);

/* History. Copyable; zero is "never touched". Always stored + dissipated = work. */
typedef struct nt_friction_state {
    double force[2];   /* of the surface on the tip, x and y [N] */
    double stiffness;  /* of the last contact [N/m] */
    double stored;     /* in the spring, |force|^2/(2 stiffness) [J] */
    double dissipated; /* heat so far, grows only [J] */
    double work;       /* done by the hand so far [J] */
} nt_friction_state;

/* Goes on to another contact, then by a way [m] along a straight line, x and y. At the new contact, before the way: one
 * that has grown keeps its force, one that has shrunk its elastic slip, and what is beyond the limit is cut; all that
 * the spring loses by this is heat. Along the way the solution is exact, so that its parts give the same as the whole:
 * on the circle the angle t between pull and way falls as tan(t/2) exp(-K s/F).
 * NT_OK; NT_E_NOT_FINITE or NT_E_RANGE (radius or load below 0) with the state left alone. */
NT_API NT_REALTIME nt_status nt_friction_advance(const nt_friction *friction, nt_friction_state *state,
                                                 const nt_friction_contact *contact, const double way[2]);

/* Many steps: contacts[i] and ways[i][0..1] in; the state after each step to states[i]. Stops at the first step that
 * is refused; the states from there on are left alone. */
typedef struct nt_friction_path {
    const nt_friction_contact *contacts;
    const double (*ways)[2]; /* [m] */
    nt_friction_state *states;
    long count;
} nt_friction_path;
/* From *state, which is left where the last step ended. */
NT_API nt_status nt_friction_run_n(const nt_friction *friction, nt_friction_state *state, const nt_friction_path *path);

/* --- Corrugation (Prandtl 1928, Tomlinson 1929): one tip on a spring over an atomic lattice,
 *     V = -E0/2 cos(2 pi x/a) + k/2 (x - X)^2, gamma dx/dt = -dV/dx (+ thermal noise). --- */
typedef struct nt_corrugation {
    double energy;      /* E0, from valley to top [J] */
    double period;      /* a, of the lattice [m] */
    double stiffness;   /* k, of contact and lever: nt_friction_stiffness [N/m] */
    double damping;     /* gamma, of the tip that slides [N s/m] */
    double temperature; /* T, 0: athermal [K] */
} nt_corrugation;
/* E0 = 0.4 eV, a = 0.5 nm, k = 1 N/m, gamma = 1e-6 N s/m, T = 0 (NaCl(001) in its range). */
NT_API nt_corrugation nt_corrugation_defaults(void);
/* The table of its fields, with units and ranges; *count (NULL allowed) its length. */
NT_API const nt_field *nt_corrugation_fields(int *count);
/* NT_OK, or NT_E_NOT_FINITE / NT_E_RANGE with the first offending field in *problem (NULL allowed). */
NT_API nt_status nt_corrugation_check(const nt_corrugation *corrugation, nt_problem *problem);
/* eta = 2 pi^2 E0/(k a^2) [-]. Above 1 the tip sticks and slips; at 1 and below it slides without friction as v -> 0.
 */
NT_API double nt_corrugation_onset(const nt_corrugation *corrugation);
/* pi E0/a, the largest force of the lattice [N]. */
NT_API double nt_corrugation_largest_force(const nt_corrugation *corrugation);
/* Mean force on the support [N] at a speed v > 0 [m/s], once the motion repeats; gamma v/(pi E0/a) 1e-12 .. 10, eta <=
 * 20. T = 0: the equation of motion, by an L-stable Rosenbrock method, within 1e-3 (1e-6 pi E0/a at least). T > 0: hops
 * between wells, forwards and backwards, at Kramers' rates with their integrals; within 2 % of Langevin's equation for
 * eta >= 3, kT/E0 1/500 .. 1/13 and gamma v/(pi E0/a) <= 0.1 (2 kT/E0)^1.5, where heat and not the speed decides when
 * the tip slips (docs/friction.md). NT_E_RANGE outside of these, with what is, in *problem (NULL allowed);
 * NT_E_NOT_FINITE, NT_E_NO_CONVERGENCE. Takes some 20 ms with T > 0. */
NT_API nt_status nt_corrugation_mean_force(const nt_corrugation *corrugation, double speed, double *force,
                                           nt_problem *problem);
#define NT_CORRUGATION_ONSET_MAX 20.0

#ifdef __cplusplus
}
#endif
#endif
