/* SPDX-License-Identifier: BSD-3-Clause
 * The kernel as a sum of exponentials, and a contact tick by tick. */
#ifndef NANOTOUCH_INTERNAL_RHEOLOGY_H
#define NANOTOUCH_INTERNAL_RHEOLOGY_H

#include "nanotouch/rheology.h"

#ifdef __cplusplus
extern "C" {
#endif

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

/* What a loop is made for. */
typedef struct nt_viscoelastic_demand {
    double period;          /* of a tick [s] */
    double max_indentation; /* [m] */
    double longest_time;    /* over which the sample's memory counts; of a power law [s] */
    double kernel_error;    /* of E(t) from one period on, 1e-8 .. 0.1 [-] */
    int springs;            /* 8 .. NT_LOOP_SPRINGS; a punch has one */
} nt_viscoelastic_demand;

/* As few arms as keep `error` (1e-8 .. 0.1) of E(t) between two times, 0 < shortest <= longest. Below the shortest time
 * the integral of E is kept: a power law's last arm stands for all that relax faster. Rates do not depend on moduli
 * and exponent. NT_E_CAPACITY, with the error that NT_SPECTRUM_ARMS arms reach in spectrum->error (it is written then,
 * too); NT_E_NOT_FINITE, NT_E_RANGE. */
NT_API nt_status nt_rheology_discretize(const nt_rheology *rheology, const nt_time_range *range, double error,
                                        nt_spectrum *spectrum);
/* How many parameters a fit varies, in this order: power_law: modulus, exponent; the others: equilibrium_modulus, then
 * for each arm its modulus and its relaxation time. */
NT_API int nt_rheology_parameter_count(const nt_rheology *rheology);
/* The integral of E from 0 to t [Pa s]. */
NT_API double nt_rheology_relaxation_integral(const nt_rheology *rheology, double time);
/* 1 ms, 1 um, 100 s, 1e-3, 64 springs. */
NT_API nt_viscoelastic_demand nt_viscoelastic_demand_defaults(void);
/* NT_OK; as nt_viscoelastic_check, or NT_E_RANGE with the field of the demand; NT_E_CAPACITY: more than NT_LOOP_ARMS
 * are needed, with the error that they would leave in *problem. The lever is not read: a loop has its own. */
NT_API nt_status nt_viscoelastic_bed_make(const nt_viscoelastic *contact, const nt_viscoelastic_demand *demand,
                                          nt_viscoelastic_bed *bed, nt_problem *problem);
/* The tip moves straight to this indentation [m] within one period. NT_OK; NT_E_NOT_FINITE or NT_E_RANGE (beyond
 * max_indentation) with the state left alone. The same calls give the same bits. */
NT_API NT_REALTIME nt_status nt_viscoelastic_advance(const nt_viscoelastic_bed *bed, nt_viscoelastic_state *state,
                                                     double indentation);
/* Elastic energy in all springs [J]. */
NT_API double nt_viscoelastic_stored(const nt_viscoelastic_bed *bed, const nt_viscoelastic_state *state);
/* Stiffness [N/m] that margins and bounds must count at an indentation that the contact may have: all springs that it
 * reaches, over one period. */
NT_API double nt_viscoelastic_max_stiffness(const nt_viscoelastic_bed *bed, double indentation);

#ifdef __cplusplus
}
#endif
#endif
