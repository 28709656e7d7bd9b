/* SPDX-License-Identifier: BSD-3-Clause
 * Johnson, Kendall, Roberts 1971: adhesion of zero range, the limit lambda -> infinity of Maugis-Dugdale (the paper's
 * lost Eq. 10; erratum E11). In Maugis' units (reduced.h), with s = sqrt(a):
 *
 *     P = s^6 - sqrt(6) s^3          d = s^4 - 4 s_f^3 s          s_f = 6^(-1/6)
 *
 * s_f is the displacement fold, d_f = -3 s_f^4. Around it, with v = s - s_f,
 *
 *     d - d_f = v^2 (v^2 + 4 s_f v + 6 s_f^2)                                                       (fold)
 *
 * exactly, so that Z = sqrt(d - d_f) is found from v without cancellation and v from Z by Newton's method, on the
 * stable branch (v > 0) and on the unstable one (-s_f < v < 0) alike. */
#include "internal/contact.h"
#include "nanotouch/contact.h"

#include <float.h>
#include <math.h>
#include <stdint.h>

#include "contact/block.h"
#include "contact/reduced.h"
#include "core/same_bits.h"
#include "core/variants.h"
#include "nanotouch/material.h"

#define SQRT_6 2.44948974278317809820
#define FOLD_S 0.74183637559040225786  /* s_f = 6^(-1/6) */
#define FOLD_D -0.90856029641606982945 /* d_f = -3 * 6^(-2/3) */

enum { MAX_ITERATIONS = 60 };

/* v at a reduced indentation d >= d_f: v sqrt(v^2 + 4 s_f v + 6 s_f^2) = +-Z (fold). The left side is monotone on both
 * branches; Newton starts from the root of its tangent at the fold, corrected for large Z. */
typedef struct {
    double target, lo, hi; /* +-Z; bounds of v */
} goal;

static inline double within(double v, double lo, double hi)
{
    const double above = v > lo ? v : lo;
    return above < hi ? above : hi;
}

static inline double start_v(double d, int stable, goal *wanted)
{
    const double above = d - FOLD_D, Z = sqrt(above > 0.0 ? above : 0.0), root = stable ? sqrt(Z) : 0.0;
    *wanted = (goal){stable ? Z : -Z, stable ? 0.0 : -FOLD_S, root};
    return within(wanted->target / (SQRT_6 * FOLD_S + root), wanted->lo, wanted->hi);
}

static inline double newton_v(double v, goal wanted)
{
    const double root = sqrt(v * v + 4.0 * FOLD_S * v + 6.0 * FOLD_S * FOLD_S);
    const double slope = root + v * (v + 2.0 * FOLD_S) / root;
    return within(v - (v * root - wanted.target) / slope, wanted.lo, wanted.hi);
}

static double solve_v(double d, int stable)
{
    goal wanted;
    double v = start_v(d, stable, &wanted);
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        const double next = newton_v(v, wanted);
        if (fabs(next - v) <= DBL_EPSILON * fabs(next))
            return next;
        v = next;
    }
    return v;
}

/* The same for a block, stable: until the last has converged; what has, stays. */
NT_VARIANTS static void solve_block(const double *d, double *v)
{
    double target[NT_BLOCK], hi[NT_BLOCK];
    int64_t done[NT_BLOCK] = {0}, all = 0;
    for (int i = 0; i < NT_BLOCK; i++) {
        goal wanted;
        v[i] = start_v(d[i], 1, &wanted);
        target[i] = wanted.target;
        hi[i] = wanted.hi;
    }
    for (int n = 0; n < MAX_ITERATIONS && !all; n++) {
        all = -1;
        for (int i = 0; i < NT_BLOCK; i++) {
            const double next = newton_v(v[i], (goal){target[i], 0.0, hi[i]});
            const int64_t stop = -(int64_t)(fabs(next - v[i]) <= DBL_EPSILON * fabs(next));
            v[i] = done[i] ? v[i] : next;
            done[i] |= stop;
            all &= done[i];
        }
    }
}

/* {U, F, k, a} at v. */
static inline nt_law_value value_at(double d, double v, int stable)
{
    const double s = FOLD_S + v;
    const double a = s * s, s3 = a * s, a3 = s3 * s3, size = fabs(v);
    const double resolved = size > NT_FOLD_RESOLUTION * FOLD_S ? size : NT_FOLD_RESOLUTION * FOLD_S;
    const double slope_d = 4.0 * (stable ? resolved : -resolved) * (a + s * FOLD_S + FOLD_S * FOLD_S); /* d(d)/ds */
    return (nt_law_value){
        .U = 0.75 * (d * d * a - 2.0 / 3.0 * d * a3 + 0.2 * a3 * a * a) - a * a,
        .F = a3 - SQRT_6 * s3,
        .k = (6.0 * s3 * a - 3.0 * SQRT_6 * a) / slope_d,
        .a = a,
    };
}

static nt_law_value eval_reduced(double d, int stable)
{
    return value_at(d, solve_v(d, stable), stable);
}

nt_status nt_jkr_eval(const nt_contact *contact, double indentation, nt_branch branch, nt_law_value *value)
{
    if (!nt_branch_is_known(branch))
        return NT_E_ARGUMENT;
    if (!isfinite(indentation))
        return NT_E_NOT_FINITE;
    const int unstable = branch == NT_BRANCH_UNSTABLE;
    const nt_reduced_units units = nt_reduced_units_of(contact);
    if (unstable && (indentation < FOLD_D * units.indentation || indentation >= 0.0))
        return NT_E_NO_SOLUTION;
    const double lowest = branch == NT_BRANCH_APPROACH ? 0.0 : FOLD_D * units.indentation;
    if (indentation < lowest) {
        *value = (nt_law_value){0};
        return NT_OK;
    }
    if (!(indentation < NT_REDUCED_HERTZ * units.indentation)) {
        *value = nt_hertz_eval(contact, indentation);
        return NT_OK;
    }
    const nt_law_value reduced = eval_reduced(indentation / units.indentation, !unstable);
    *value = nt_reduced_to_si(&reduced, &units);
    return NT_OK;
}

NT_VARIANTS static void values_fill(const nt_reduced_units *units, const int64_t *apart, const double *d,
                                    const double *v, nt_law_block *block)
{
    for (int i = 0; i < NT_BLOCK; i++) {
        const nt_law_value reduced = value_at(d[i], v[i], 1);
        const nt_law_value value = nt_reduced_to_si(&reduced, units);
        block->U[i] = apart[i] ? 0.0 : value.U;
        block->F[i] = apart[i] ? 0.0 : value.F;
        block->k[i] = apart[i] ? 0.0 : value.k;
        block->a[i] = apart[i] ? 0.0 : value.a;
    }
}

int nt_jkr_block(const nt_contact *contact, nt_branch branch, nt_law_block *block)
{
    const nt_reduced_units units = nt_reduced_units_of(contact);
    const double lowest = branch == NT_BRANCH_APPROACH ? 0.0 : FOLD_D * units.indentation;
    double d[NT_BLOCK], v[NT_BLOCK];
    int64_t apart[NT_BLOCK], hertz = 0;
    for (int i = 0; i < NT_BLOCK; i++) {
        apart[i] = -(int64_t)(block->in[i] < lowest);
        hertz |= -(int64_t)(block->in[i] >= NT_REDUCED_HERTZ * units.indentation);
        d[i] = apart[i] ? 0.0 : block->in[i] / units.indentation;
    }
    if (hertz)
        return 0;
    solve_block(d, v);
    values_fill(&units, apart, d, v, block);
    return 1;
}

nt_status nt_jkr_indentation(const nt_contact *contact, double force, nt_branch branch, double *indentation)
{
    if (!nt_branch_is_known(branch))
        return NT_E_ARGUMENT;
    if (!isfinite(force))
        return NT_E_NOT_FINITE;
    const int unstable = branch == NT_BRANCH_UNSTABLE;
    const nt_reduced_units units = nt_reduced_units_of(contact);
    if (force < -nt_jkr_pull_off_force(contact) || (unstable && force >= 0.0))
        return NT_E_NO_SOLUTION;
    if (units.load == 0.0 || force / units.load > NT_REDUCED_HERTZ * sqrt(NT_REDUCED_HERTZ)) {
        *indentation = nt_hertz_indentation(contact, force);
        return NT_OK;
    }
    const double P = force / units.load;
    const double larger = P + 3.0 + sqrt(fmax(6.0 * P + 9.0, 0.0)); /* a^3; the two roots multiply to P^2 */
    const double s2 = cube_root(unstable ? P * P / larger : larger), s = sqrt(s2);
    *indentation = s * (s * s2 - 4.0 * FOLD_S * FOLD_S * FOLD_S) * units.indentation;
    return NT_OK;
}

double nt_jkr_pull_off_force(const nt_contact *contact)
{
    return 1.5 * NT_PI * contact->radius * contact->work_of_adhesion;
}

double nt_jkr_pull_off_indentation(const nt_contact *contact)
{
    return FOLD_D * nt_reduced_units_of(contact).indentation;
}
