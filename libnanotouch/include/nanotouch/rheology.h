/* SPDX-License-Identifier: BSD-3-Clause
 * Linear viscoelasticity of a sample: Young's relaxation modulus E(t), its integral, the creep compliance J(t), and
 * E(t) as a sum of exponentials ("arms" of a generalized Maxwell model), which is what contacts are computed with
 * (viscoelastic.h). docs/rheology.md has the equations. All functions: thread-safe, no state. NaN in, NaN out. */
#ifndef NANOTOUCH_RHEOLOGY_H
#define NANOTOUCH_RHEOLOGY_H

#include "nanotouch/advanced/field.h"

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
/* The integral of E from 0 to t [Pa s]. */
NT_API double nt_rheology_relaxation_integral(const nt_rheology *rheology, double time);
/* J(t), the strain at t under a unit stress since 0 [1/Pa]. */
NT_API double nt_rheology_creep(const nt_rheology *rheology, double time);

/* --- E(t) as a sum of exponentials --- */

enum { NT_SPECTRUM_ARMS = 40 };
typedef struct nt_spectrum {
    int count;
    double equilibrium_modulus;      /* [Pa] */
    double moduli[NT_SPECTRUM_ARMS]; /* E_k, none below 0 [Pa] */
    double rates[NT_SPECTRUM_ARMS];  /* 1/tau_k [1/s] */
    double error;                    /* max |sum/E(t) - 1|, at 24 times among those asked for; 0: the sum is E(t) */
} nt_spectrum;
typedef struct nt_time_range {
    double shortest, longest; /* [s] */
} nt_time_range;
/* As few arms as keep `error` (1e-8 .. 0.1) of E(t) between two times, 0 < shortest <= longest. Below the shortest time
 * the integral of E is kept: a power law's last arm stands for all that relax faster. Rates do not depend on moduli
 * and exponent. NT_E_CAPACITY, with the error that NT_SPECTRUM_ARMS arms reach in spectrum->error (it is written then,
 * too); NT_E_NOT_FINITE, NT_E_RANGE. */
NT_API nt_status nt_rheology_discretize(const nt_rheology *rheology, const nt_time_range *range, double error,
                                        nt_spectrum *spectrum);

enum { NT_RHEOLOGY_PARAMETERS = 1 + 2 * NT_RHEOLOGY_ARMS };
/* How many parameters a fit varies, in this order: power_law: modulus, exponent; the others: equilibrium_modulus, then
 * for each arm its modulus and its relaxation time. */
NT_API int nt_rheology_parameter_count(const nt_rheology *rheology);
#ifdef __cplusplus
}
#endif
#endif
