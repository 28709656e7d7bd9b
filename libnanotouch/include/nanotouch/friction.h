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

#ifdef __cplusplus
}
#endif
#endif
