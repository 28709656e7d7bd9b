/* SPDX-License-Identifier: BSD-3-Clause
 * The folds of Maugis-Dugdale without iteration: y of each is a smooth function of lambda, taken from polynomials
 * (tools/maugis_folds.py, exact to a rounding), and the branch is explicit in y.
 *
 *     displacement fold   y = (lambda - lambda_0) p(w)     w = sqrt(x_e - lambda_0/lambda)
 *     load fold           y = lambda^1.5 p(sqrt lambda)    below lambda = 1, lambda p(1/lambda) above it
 *     zero load           y = lambda^0.5 p(sqrt lambda)    below lambda = 1, lambda p(1/lambda) above it
 *
 * The load fold goes as lambda^1.5 towards DMT, and all as lambda towards JKR. The displacement fold passes y = 0 at
 * lambda_0 and would end, as a square root, a little below it, at lambda_0/lambda = x_e; in w it does not. */
#include "contact/maugis/folds.h"

#include <math.h>

#include "contact/maugis/apart.h"
#include "contact/maugis/functions.h"
#include "core/variants.h"

#include "contact/maugis/fold_polynomials.inc"

/* The polynomial at 0 <= t <= 1, in pairs: shorter chains than Horner's. */
static inline double polynomial_at(const double of[PIECES][COEFFICIENTS], double t)
{
    const double place = t * PIECES;
    const int piece = place < PIECES - 1 ? (int)place : PIECES - 1;
    const double *c = of[piece], s = 2.0 * (place - piece) - 1.0, s2 = s * s, s4 = s2 * s2;
    const double low = ((c[0] + s * c[1]) + s2 * (c[2] + s * c[3])) + s4 * ((c[4] + s * c[5]) + s2 * (c[6] + s * c[7]));
    const double high = ((c[8] + s * c[9]) + s2 * (c[10] + s * c[11])) + s4 * c[12];
    return low + s4 * s4 * high;
}

/* Selections in place of jumps: lambdas of an array are in no order that a processor could foresee. */
static inline double grip_parameter(double lambda, double inverse)
{
    const double beyond = (lambda - CENTRE) - CENTRE_REST, square = BEYOND - CENTRE * inverse;
    const double w = sqrt(square > FIRST * FIRST ? square : FIRST * FIRST);
    const double y = beyond * polynomial_at(grip, (w - FIRST) * PER_WIDTH);
    return beyond > 0.0 ? y : 0.0;
}

double nt_maugis_grip_parameter(double lambda)
{
    return grip_parameter(lambda, 1.0 / lambda);
}

enum { TOUCH, GRIP, LOAD, ZERO, POINTS };

typedef struct {
    double P[POINTS], d[POINTS], a[POINTS];
} points;

/* y comes in three numbers: read as a row of what was just stored one by one, it would wait until the stores are done.
 * At TOUCH it is 0. */
NT_VARIANTS static void points_fill(double lambda, double grip_y, double load_y, double zero_y, points *of)
{
    static const double is_grip[POINTS] = {[GRIP] = 1.0}, is_load[POINTS] = {[LOAD] = 1.0},
                        is_zero[POINTS] = {[ZERO] = 1.0};
    for (int i = 0; i < POINTS; i++) {
        const double y = is_grip[i] * grip_y + is_load[i] * load_y + is_zero[i] * zero_y;
        const nt_maugis_equilibrium at = nt_maugis_equilibrium_of(lambda, nt_maugis_functions_at(y));
        of->P[i] = at.P;
        of->d[i] = at.d;
        of->a[i] = at.a;
    }
}

void nt_maugis_folds_find(nt_maugis *maugis)
{
    const double lambda = maugis->lambda, onset = -2.0 / (NT_PI * lambda), c = nt_maugis_apart_fold(lambda);
    const double inverse = 1.0 / lambda, root = sqrt(lambda);
    const int low = lambda < 1.0;
    const double t = low ? root : inverse;
    points at;
    maugis->fold_y = grip_parameter(lambda, inverse);
    maugis->load_fold_y = (low ? lambda * root : lambda) * polynomial_at(low ? load_low : load_high, t);
    const double zero_y = (low ? root : lambda) * polynomial_at(low ? zero_low : zero_high, t);
    points_fill(lambda, maugis->fold_y, maugis->load_fold_y, zero_y, &at);
    const int in_contact = maugis->fold_y > 0.0;
    nt_maugis_folds *folds = &maugis->folds; /* number by number: a copy of the struct waits for what was stored */
    folds->pull_off_load = at.P[LOAD];
    folds->pull_off_radius = at.a[LOAD];
    folds->pull_off_indentation = at.d[LOAD];
    folds->grip_in_contact = in_contact;
    folds->grip_load = in_contact ? at.P[GRIP] : -0.5 * NT_PI * lambda * c * c;
    folds->grip_radius = at.a[GRIP];
    folds->grip_indentation = in_contact ? at.d[GRIP] : onset - 0.5 * c * c;
    folds->zero_load_radius = at.a[ZERO];
    folds->zero_load_indentation = at.d[ZERO];
    folds->touch_load = at.P[TOUCH];
    folds->touch_indentation = at.d[TOUCH];
    folds->onset_indentation = onset;
}
