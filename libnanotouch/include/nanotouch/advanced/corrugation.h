/* SPDX-License-Identifier: BSD-3-Clause
 * Corrugation (Prandtl 1928, Tomlinson 1929): one tip on a spring over an atomic lattice,
 *     V = -E0/2 cos(2 pi x/a) + k/2 (x - X)^2, gamma dx/dt = -dV/dx (+ thermal noise). */
#ifndef NANOTOUCH_CORRUGATION_H
#define NANOTOUCH_CORRUGATION_H

#include "nanotouch/advanced/field.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What holds the tip: lattice, spring, damping, heat. */
typedef struct nt_corrugation {
    double energy;      /* E0, from valley to top [J] */
    double period;      /* a, of the lattice [m] */
    double stiffness;   /* k, of contact and lever: nt_friction_stiffness [N/m] */
    double damping;     /* gamma, of the tip that slides [N s/m] */
    double temperature; /* T, 0: athermal [K] */
} nt_corrugation;
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
