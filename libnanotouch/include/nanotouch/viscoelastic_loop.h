/* SPDX-License-Identifier: BSD-3-Clause
 * The same contact in a loop: any motion tick by tick, with contact lost and made again, in a state of fixed size.
 *
 * Method of dimensionality reduction (Popov, Hess 2015): the tip presses independent springs, each of them the kernel's
 * arms. One that the tip presses goes with it; one that it does not carries no force and recovers. For a tip that moves
 * straight within a tick each arm is exact. The force is that at the tick's end, and with it no motion gives energy:
 * work is never less than the change of the stored energy, arm by arm. */
#ifndef NANOTOUCH_VISCOELASTIC_LOOP_H
#define NANOTOUCH_VISCOELASTIC_LOOP_H

#include "nanotouch/viscoelastic.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { NT_LOOP_SPRINGS = 128, NT_LOOP_ARMS = 32 };

/* What a loop is made for. */
typedef struct nt_viscoelastic_demand {
    double period;          /* of a tick [s] */
    double max_indentation; /* [m] */
    double longest_time;    /* over which the sample's memory counts; of a power law [s] */
    double kernel_error;    /* of E(t) from one period on, 1e-8 .. 0.1 [-] */
    int springs;            /* 8 .. NT_LOOP_SPRINGS; a punch has one */
} nt_viscoelastic_demand;
/* 1 ms, 1 um, 100 s, 1e-3, 64 springs. */
NT_API nt_viscoelastic_demand nt_viscoelastic_demand_defaults(void);

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
/* NT_OK; as nt_viscoelastic_check, or NT_E_RANGE with the field of the demand; NT_E_CAPACITY: more than NT_LOOP_ARMS
 * are needed, with the error that they would leave in *problem. The lever is not read: a loop has its own. */
NT_API nt_status nt_viscoelastic_bed_make(const nt_viscoelastic *contact, const nt_viscoelastic_demand *demand,
                                          nt_viscoelastic_bed *bed, nt_problem *problem);

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
