/* SPDX-License-Identifier: BSD-3-Clause
 * Linear viscoelasticity of a sample: Young's relaxation modulus E(t), its integral, the creep compliance J(t), and
 * E(t) as a sum of exponentials ("arms" of a generalized Maxwell model), which is what contacts are computed with.
 * docs/rheology.md has the equations. All functions: thread-safe, no state. NaN in, NaN out. */
#ifndef NANOTOUCH_RHEOLOGY_H
#define NANOTOUCH_RHEOLOGY_H

#include "nanotouch/advanced/field.h"
#include "nanotouch/advanced/geometry.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum nt_rheology_kind {
    NT_RHEOLOGY_ELASTIC,               /* of a scene: its sample does not relax. No kernel */
    NT_RHEOLOGY_POWER_LAW,             /* E = modulus (t/reference_time)^-exponent */
    NT_RHEOLOGY_STANDARD_LINEAR_SOLID, /* E = E_inf + E_1 exp(-t/tau_1): one arm */
    NT_RHEOLOGY_PRONY                  /* E = E_inf + Sum E_k exp(-t/tau_k) */
} nt_rheology_kind;
enum { NT_RHEOLOGY_COUNT = NT_RHEOLOGY_PRONY + 1, NT_RHEOLOGY_ARMS = 8 };

/* How the modulus of a sample relaxes. Fields that its kind does not name are not read. */
typedef struct nt_rheology {
    nt_rheology_kind kind;
    int arm_count;                             /* of a prony series, 1 .. NT_RHEOLOGY_ARMS */
    double modulus;                            /* of a power law at the reference time [Pa] */
    double exponent;                           /* beta of a power law, 0 (elastic) .. 0.85 [-] */
    double reference_time;                     /* t_0 of a power law [s] */
    double equilibrium_modulus;                /* E_inf; 0: a fluid [Pa] */
    double arm_moduli[NT_RHEOLOGY_ARMS];       /* E_k [Pa] */
    double relaxation_times[NT_RHEOLOGY_ARMS]; /* tau_k [s] */
} nt_rheology;
/* A power law, 1 kPa at 1 s, exponent 0.2; arms: one of 1 kPa and 0.1 s beside E_inf = 1 kPa. */
NT_API nt_rheology nt_rheology_defaults(void);
/* The table of its fields but the arms, with units and ranges; *count (NULL allowed) its length. */
NT_API const nt_field *nt_rheology_fields(int *count);
/* NT_OK, or NT_E_ARGUMENT / NT_E_NOT_FINITE / NT_E_RANGE with the first offending field in *problem (NULL allowed). */
NT_API nt_status nt_rheology_check(const nt_rheology *rheology, nt_problem *problem);

/* E(t) [Pa] of a checked description, at a time >= 0 [s] (below 0: NaN, here and in the two that follow). */
NT_API double nt_rheology_relaxation(const nt_rheology *rheology, double time);
/* J(t), the strain at t under a unit stress since 0 [1/Pa]. */
NT_API double nt_rheology_creep(const nt_rheology *rheology, double time);

/* --- E(t) as a sum of exponentials --- */

enum { NT_SPECTRUM_ARMS = 40 };

enum { NT_RHEOLOGY_PARAMETERS = 1 + 2 * NT_RHEOLOGY_ARMS };

/* --- A rigid tip on a linear viscoelastic sample: the force along any history of the probe's base.
 *
 * Without adhesion: while the contact grows F = 1/(1 - nu^2) Int E(t - s) dg(delta(s)) (Lee and Radok 1960), g(delta)
 * the elastic law over E*; while it shrinks the integral ends at the time t_1 when the contact was last as large (Ting
 * 1966). The base moves in straight lines between the points given; a lever bends in between: delta = position -
 * contact - F/k_c. --- */

/* A contact. E(t) is Young's modulus of the sample; Poisson's ratio does not change in time. */
typedef struct nt_viscoelastic {
    nt_shape shape; /* PARABOLOID, SPHERE, CONE (also a pyramid) or PUNCH */
    nt_rheology rheology;
    double poisson_ratio;   /* nu, of the sample [-] */
    double thickness;       /* h, of a layer bonded to rigid ground; 0: a half-space. PARABOLOID and CONE, nu = 0.5: the
                             * polynomials of the fit models "layer" and "layer_cone", contact radius up to 2 h [m] */
    double spring_constant; /* k_c; 0: rigid, the indentation is given [N/m] */
} nt_viscoelastic;
/* A paraboloid of 5 um on nt_rheology_defaults(), nu = 0.5, a half-space, a rigid lever. */
NT_API nt_viscoelastic nt_viscoelastic_defaults(void);
/* NT_OK, or NT_E_ARGUMENT / NT_E_NOT_FINITE / NT_E_RANGE with the offending field in *problem (NULL
 * allowed). */
NT_API nt_status nt_viscoelastic_check(const nt_viscoelastic *contact, nt_problem *problem);

/* The points of a history. */
typedef struct nt_viscoelastic_path {
    const double *times;     /* increasing [s] */
    const double *positions; /* of the base, towards the sample; the first one out of contact [m] */
    double contact;          /* position of first touch, z_0 [m] */
    long count;              /* 2 or more */
    double *workspace;       /* nt_viscoelastic_workspace() doubles */
} nt_viscoelastic_path;

/* What is computed, `count` of each; those that are NULL are left out. */
typedef struct nt_viscoelastic_result {
    double *forces;       /* F, never below 0 [N] */
    double *indentations; /* delta = position - contact - F/k_c; below 0: above the sample [m] */
    double *derivatives; /* of F: rows of 1 + nt_rheology_parameter_count(): by `contact`, then by the parameters of the
                          * rheology in their order [N over the parameter's unit] */
    int arms;            /* of the sum of exponentials */
    double kernel_error; /* of it [1], as nt_spectrum.error; the force errs by some tenth of that */
    int by_springs;      /* 1: a contact that had shrunk grew again, and 128 springs followed it; 3e-4 of F_max */
    double bulk_error;   /* with adhesion: what the bulk still relaxes, estimated, over the max |F| [-] */
    double dissipated;   /* with adhesion: at the contact's edge [J] */
} nt_viscoelastic_result;

/* Doubles that a history of so many points needs, with derivatives or without. */
NT_API long nt_viscoelastic_workspace(const nt_viscoelastic *contact, long count, int with_derivatives);
/* Along a history. The derivatives are those of the discretized law, exact but for the grid of the first steps of a
 * contact. NT_OK; NT_E_NOT_FINITE or NT_E_RANGE with a problem (the field and its value: times that do not increase, a
 * first point in contact, a layer or a sphere pressed beyond its law). */
NT_API nt_status nt_viscoelastic_run(const nt_viscoelastic *contact, const nt_viscoelastic_path *path,
                                     nt_viscoelastic_result *result, nt_problem *problem);

/* --- The same contact in a loop: any motion tick by tick, with contact lost and made again, in a state of fixed size.
 *
 * Method of dimensionality reduction (Popov, Hess 2015): the tip presses independent springs, each of them the kernel's
 * arms. One that the tip presses goes with it; one that it does not carries no force and recovers. For a tip that moves
 * straight within a tick each arm is exact. The force is that at the tick's end, and with it no motion gives energy:
 * work is never less than the change of the stored energy, arm by arm. --- */

enum { NT_LOOP_SPRINGS = 128, NT_LOOP_ARMS = 32 };

/* A contact made ready for ticks of one length. Read-only from then on; may be shared. */
typedef struct nt_viscoelastic_bed {
    int springs, arms;
    double period;                  /* [s] */
    double max_indentation;         /* [m] */
    double factor;                  /* 1/(1 - nu^2) [-] */
    double equilibrium_modulus;     /* [Pa] */
    double modulus_over_period;     /* E_inf + Sum E_k phi_k: what a tick feels, an arm that relaxes faster as a dashpot
                                       [Pa] */
    double kernel_error;            /* of the arms, as nt_spectrum.error */
    double moduli[NT_LOOP_ARMS];    /* E_k [Pa] */
    double decay[NT_LOOP_ARMS];     /* exp(-period/tau_k) [-] */
    double follow[NT_LOOP_ARMS];    /* phi_k = (1 - decay) tau_k/period [-] */
    double depth[NT_LOOP_SPRINGS];  /* D_i, indentation at which a spring is reached [m] */
    double weight[NT_LOOP_SPRINGS]; /* its share of the contact's stiffness over E [m] */
} nt_viscoelastic_bed;

/* Where the contact is and what it remembers. Copyable; zero is "never touched". */
typedef struct nt_viscoelastic_state {
    double indentation;                      /* delta at the last tick [m] */
    double force;                            /* on the tip, >= 0 [N] */
    double stiffness;                        /* dF/d(delta) of the tick [N/m] */
    int pressed;                             /* springs that the tip presses */
    int touched;                             /* springs that it ever has pressed */
    double u[NT_LOOP_SPRINGS];               /* [m] */
    double z[NT_LOOP_ARMS][NT_LOOP_SPRINGS]; /* of each arm's spring [m] */
} nt_viscoelastic_state;

/* --- With adhesion: the loss at the edge of the contact --- */

/* JKR's contact with E_inf, whose edge is a crack with w_eff(v): w times Persson and Brener's ratio (Phys. Rev. E 71
 * (2005) 036123) while it opens, w over that ratio while it closes (Greenwood, J. Phys. D 37 (2004) 2557: the product
 * is about w^2). The ratio is 1 at rest and E_0/E_inf at high speed. */
typedef struct nt_viscoelastic_adhesion {
    double work_of_adhesion; /* w, of an edge at rest [J/m^2] */
    double crack_length;     /* a_0, of the process zone at that edge: about E* w/(2 pi sigma^2) for a cohesive stress
                              * sigma; at most a tenth of JKR's contact radius without load [m] */
} nt_viscoelastic_adhesion;
/* Along a history. Forces go below 0. Paraboloid on a half-space; standard linear solid or Prony series with E_inf > 0.
 * It holds while the bulk has relaxed: the base may move no faster than makes bulk_error 5 %. No derivatives; the
 * workspace is not used. NT_OK, or as nt_viscoelastic_run; NT_E_RANGE with the field that lies outside
 * ("rheology.kind", "shape.kind", "thickness", "crack_length", "speed"). */
NT_API nt_status nt_viscoelastic_run_adhesive(const nt_viscoelastic *contact, const nt_viscoelastic_adhesion *adhesion,
                                              const nt_viscoelastic_path *path, nt_viscoelastic_result *result,
                                              nt_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
