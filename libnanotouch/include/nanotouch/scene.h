/* SPDX-License-Identifier: BSD-3-Clause
 * What there is (nt_scene), and the force between its tip and its surface as a sum of laws on one pose
 * (nt_interaction_*). What is computed is decided once, by a plan (plan.h). */
#ifndef NANOTOUCH_SCENE_H
#define NANOTOUCH_SCENE_H

#include "nanotouch/field.h"
#include "nanotouch/material.h"
#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct nt_tip {
    double radius;         /* R of the apex [m] */
    double half_angle;     /* psi of the cone above it [rad] */
    double youngs_modulus; /* E_t [Pa] */
    double poisson_ratio;  /* nu_t [-] */
} nt_tip;

typedef struct nt_specimen {
    double youngs_modulus; /* E_s [Pa] */
    double poisson_ratio;  /* nu_s [-] */
    double roughness;      /* b, peak to peak, below what the surface map shows [m] */
} nt_specimen;

typedef struct nt_medium {
    double temperature;       /* T [K] */
    double relative_humidity; /* [-]; 0 is dry gas or vacuum: no meniscus */
    double surface_tension;   /* gamma_L of the condensed liquid [N/m]; 0: no meniscus */
    double molar_volume;      /* V_m of the liquid [m^3/mol] */
    double meniscus_radius;   /* r1 [m]; 0: from the Kelvin equation */
    double film_thickness;    /* e of the adsorbed film on each surface [m] */
} nt_medium;

typedef struct nt_adhesion {
    double work_of_adhesion;     /* w of the dry solids [J/m^2] */
    double equilibrium_distance; /* z0 (the paper's a0): atoms in contact [m] */
    double hamaker_constant;     /* H through the dry medium [J] */
    double contact_potential;    /* U = (phi_1 - phi_2)/e [V]; 0 for the same or non-conducting materials */
} nt_adhesion;

typedef struct nt_scene {
    nt_tip tip;
    nt_specimen sample;
    nt_medium medium;
    nt_adhesion adhesion;
} nt_scene;

/* The paper's scene: silicon tip (R = 20 nm) on silicon (E = 135 GPa, nu = 0.35) in air of 40 % humidity. */
NT_API nt_scene nt_scene_defaults(void);
/* Every field once: dotted name, unit, range, offset. One table for checks, bindings, TOML and docs. */
NT_API const nt_field *nt_scene_fields(int *count);
/* NT_OK, or the first offending field in *problem (NULL allowed). */
NT_API nt_status nt_scene_check(const nt_scene *scene, nt_problem *problem);

/* Where the adhesion in contact comes from. One source at a time: the van der Waals and capillary forces at contact are
 * the same adhesion that w already puts into the contact law (erratum E5b). */
typedef enum nt_adhesion_source {
    NT_ADHESION_NONE,    /* w = 0: Hertz */
    NT_ADHESION_SOLID,   /* atoms against atoms: w, over the range of the atomic potential */
    NT_ADHESION_MENISCUS /* water bridge: w = 2 gamma_L over h0 = 2 r1, the Laplace pressure (erratum E12) */
} nt_adhesion_source;
NT_API nt_adhesion_source nt_scene_adhesion_source(const nt_scene *scene);
/* r1: as given, or by the Kelvin equation from humidity and temperature [m]. */
NT_API double nt_scene_meniscus_radius(const nt_scene *scene);

/* The history of one contact. Copyable; zero is "never touched". */
typedef struct nt_interaction_state {
    int attached; /* 1: in contact, or held by the meniscus or the attraction that contact has left */
} nt_interaction_state;

/* Force on the tip at a pose. */
typedef struct nt_interaction_value {
    double U;          /* energy [J] */
    double Fx, Fy, Fz; /* force on the tip [N] */
    double k;          /* dFz/d(delta) [N/m] */
    double a;          /* contact radius [m] */
    double gap;        /* h of the undeformed bodies [m] */
} nt_interaction_value;

struct nt_plan;

/* The vertical law at a gap [m]: pure, may be called at trial gaps. A gap inside the capture range counts as captured.
 */
NT_API NT_REALTIME nt_law_value nt_interaction_eval_gap(const struct nt_plan *plan, const nt_interaction_state *state,
                                                        double gap);
/* The same at a pose over the plan's surface, with lateral forces: F = -grad U. */
NT_API NT_REALTIME nt_interaction_value nt_interaction_eval(const struct nt_plan *plan,
                                                            const nt_interaction_state *state, const nt_pose *pose);
/* Commits history once per accepted step: captured (contact, meniscus formed) or let go (pull-off, meniscus ruptured).
 */
NT_API NT_REALTIME void nt_interaction_advance(const struct nt_plan *plan, nt_interaction_state *state, double gap);

#ifdef __cplusplus
}
#endif
#endif
