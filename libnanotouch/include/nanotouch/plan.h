/* SPDX-License-Identifier: BSD-3-Clause
 * What has to be computed for a scene, and why: the contact law by its true error at this lambda, the non-contact terms
 * by a bound on what leaving them out costs. Immutable after nt_plan_make. */
#ifndef NANOTOUCH_PLAN_H
#define NANOTOUCH_PLAN_H

#include "nanotouch/contact.h"
#include "nanotouch/forces.h"
#include "nanotouch/scene.h"
#include "nanotouch/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How true the felt force must be. */
typedef struct nt_demand {
    double relative_accuracy; /* |dF| / max(|F|, |F_pull-off|) [-], 1e-6 .. 0.5 */
    double force_floor;       /* forces below this cannot be felt [N], >= 0 */
    double maximum_load;      /* the largest load that will be visited [N], > 0 */
} nt_demand;
/* 1 %, 0 N, 2.2 uN. */
NT_API nt_demand nt_demand_defaults(void);
NT_API nt_status nt_demand_check(const nt_demand *demand, nt_problem *problem);

/* One law of the plan, in or out. */
typedef struct nt_plan_term {
    const char *name; /* "maugis", "vdw", "electrostatic"; static storage */
    int included;
    double bound; /* included contact law: its relative error; left out: the largest force it could add [N] */
} nt_plan_term;

enum { NT_PLAN_CONTACT, NT_PLAN_VDW, NT_PLAN_ELECTROSTATIC, NT_PLAN_TERMS };

typedef struct nt_plan {
    nt_plan_term terms[NT_PLAN_TERMS];
    nt_adhesion_source source;
    nt_contact_law contact;
    double lambda; /* Maugis' parameter of the contact [-] */
    nt_vdw vdw;    /* tail: before the meniscus forms, or outside the range of the solid's own adhesion */
    nt_electrostatic electrostatic;
    double capture_gap; /* on approach adhesion takes hold here: meniscus formed, or onset of the Dugdale stress [m] */
    double release_gap; /* on retraction under grips it lets go here [m] */
    double pull_off_force;     /* load control, tails included, positive [N] */
    double maximum_stiffness;  /* k of the contact at the maximum load [N/m] */
    double contact_strain;     /* a/R at the maximum load: above 0.3 the paraboloid is outside its validity [-] */
    const nt_surface *surface; /* dilated surface, borrowed; NULL: flat at z = 0 */
} nt_plan;

/* Decides for a scene (checked here) and a demand. surface: borrowed, NULL for a flat at z = 0. On failure *plan is
 * untouched and *problem (NULL allowed) names the field. */
NT_API nt_status nt_plan_make(nt_plan *plan, const nt_scene *scene, const nt_demand *demand, const nt_surface *surface,
                              nt_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
