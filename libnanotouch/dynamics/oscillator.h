/* SPDX-License-Identifier: BSD-3-Clause
 * m x'' + b x' + k x = f with f held: the exact transition over any time. Private. */
#ifndef NANOTOUCH_DYNAMICS_OSCILLATOR_H
#define NANOTOUCH_DYNAMICS_OSCILLATOR_H

#include "nanotouch/dynamics.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Mass m > 0 [kg], damping b >= 0 [N s/m], stiffness k >= 0 [N/m], or in any other consistent units. */
typedef struct nt_oscillator_constants {
    double mass, damping, stiffness;
} nt_oscillator_constants;

/* The transition over a time t >= 0 [s], each entry to about (1 + omega t) 2^-50. */
nt_oscillator nt_oscillator_over(const nt_oscillator_constants *constants, double t);

/* How long until the speed is 0 again under a held force [s]: above 0 if it moves now, infinite if that never happens.
 * pull: f - k x now [N]; speed [m/s], not 0. */
double nt_oscillator_turns_after(const nt_oscillator_constants *constants, double pull, double speed);

#ifdef __cplusplus
}
#endif
#endif
