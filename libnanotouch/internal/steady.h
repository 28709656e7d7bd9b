/* SPDX-License-Identifier: BSD-3-Clause
 * The steady motion of a tapping lever to a demanded accuracy, by the cheapest tier that keeps it: one harmonic, where
 * the slow flow rests; harmonic balance with as many as it needs (nt_balance); the time domain (tapping.h). */
#ifndef NANOTOUCH_INTERNAL_STEADY_H
#define NANOTOUCH_INTERNAL_STEADY_H

#include "internal/balance.h"
#include "nanotouch/advanced/scan.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum nt_steady_tier { NT_STEADY_FLOW, NT_STEADY_BALANCE, NT_STEADY_TIME } nt_steady_tier;

/* What is wanted. */
typedef struct nt_steady {
    const nt_tapping *lever; /* its tolerance counts in the time domain */
    const nt_plan *plan;
    const nt_place *place; /* NULL: a flat at z = 0 */
    double accuracy; /* of the amplitude over A0, and of the peak force over the larger of itself and the pull-off,
                        1e-6 .. 0.5; below 2e-4 it takes the time domain [-] */
} nt_steady;

typedef struct nt_steady_value {
    nt_steady_tier tier;
    int harmonics; /* NT_STEADY_TIME: 0, all */
    /* As nt_balance_value; bounds are 0 in the time domain, whose error is the lever's tolerance. */
    double base_height, amplitude, mean, lowest_gap; /* [m] */
    double phase;                                    /* [rad] */
    double peak_force, force_bound;                  /* [N] */
    double contact_time;                             /* [-] */
    double tip_loss;                                 /* [J] */
    double amplitude_bound;                          /* [m] */
    nt_tapping_state state;                          /* at w t = 0, to go on from in the time domain */
    long evaluations; /* of the force: the cost. That of the curve, some 50 000, is not in it */
} nt_steady_value;

/* The motion that a lever comes to on its way to the target; curve of nt_balance_trace. Where
 * harmonic balance finds no motion for a height, the time domain is asked from the free swing. NT_E_ARGUMENT,
 * NT_E_RANGE (accuracy), NT_E_NO_CONVERGENCE: no motion repeats each period. */
NT_API nt_status nt_steady_find(const nt_steady *steady, const nt_balance_curve *curve, const nt_balance_target *target,
                                nt_steady_value *value);

/* One line of an image in which the loop has settled at each pixel: no lag, no noise, no scanner. Rows as of
 * nt_scanner_line, with error and lateral force 0. Pixels follow one another along the line from where the tip has come
 * down on its first one; where harmonic balance does not keep the accuracy it comes down anew, as by nt_steady_find.
 * NT_E_NO_CONVERGENCE: at `*pixel` (NULL allowed) no motion of the set point repeats. Tapping
 * modes only: NT_E_ARGUMENT in contact mode. */
NT_API nt_status nt_steady_line(const nt_scanner *scanner, double accuracy, long line, nt_scan_row *row, long *pixel);

#ifdef __cplusplus
}
#endif
#endif
