/* SPDX-License-Identifier: BSD-3-Clause
 * What every law of a gap must keep to, checked in the same way for all. Include after cmocka.h. */
#ifndef FORCE_LAWS_H
#define FORCE_LAWS_H

#include "assertions.h"
#include "nanotouch/types.h"

/* A law as the checks see it. FORCE_LAW(nt_vdw, nt_vdw_eval) defines nt_vdw_eval_at and nt_vdw_eval_over for it. */
typedef struct force_law {
    nt_law_value (*at)(const void *parameters, double gap);
    void (*over)(const void *parameters, const nt_strided *arrays);
    const void *parameters;
    double minimum_gap;
} force_law;

#define FORCE_LAW(type, eval)                                                                                          \
    static nt_law_value eval##_at(const void *parameters, double gap)                                                  \
    {                                                                                                                  \
        return eval((const type *)parameters, gap);                                                                    \
    }                                                                                                                  \
    static void eval##_over(const void *parameters, const nt_strided *arrays)                                          \
    {                                                                                                                  \
        eval##_n((const type *)parameters, arrays);                                                                    \
    }

/* F = -dU/dh and k = -dF/dh between two gaps: five points with step 2e-3 h, truncation (2e-3)^4 times the fifth
 * derivative, some hundred for the steepest power law (an exponential: to gaps of some ten decay lengths); rounding
 * 1e-16/2e-3 of the largest term. `scale` U, F, k: what counts as 0. */
static inline void assert_slopes(const force_law *law, const double gaps[2], nt_law_value scale)
{
    for (double gap = gaps[0]; gap < gaps[1]; gap *= 1.37) {
        const double h = 2e-3 * gap;
        nt_law_value at[5];
        for (int i = 0; i < 5; i++)
            at[i] = law->at(law->parameters, gap + (i - 2) * h);
        const double F = -(8.0 * (at[3].U - at[1].U) - (at[4].U - at[0].U)) / (12.0 * h);
        const double k = -(8.0 * (at[3].F - at[1].F) - (at[4].F - at[0].F)) / (12.0 * h);
        assert_within(at[2].F, F, 3e-8 * fabs(F) + 1e-12 * (fabs(at[2].U) / gap + scale.F) + 1e-12 * scale.U / gap);
        assert_within(at[2].k, k, 3e-8 * fabs(k) + 1e-12 * (fabs(at[2].F) / gap + scale.k) + 1e-12 * scale.F / gap);
        assert_true(at[2].a == 0.0);
    }
}

/* Below the minimum gap: F stays, U goes on as F says, nothing jumps; also at 0, denormal, negative, -infinite gaps. */
static inline void assert_held(const force_law *law)
{
    const double minimum = law->minimum_gap;
    const nt_law_value at = law->at(law->parameters, minimum);
    const double gaps[] = {0.5 * minimum, 5e-324, 0.0, -5e-324, -1e-9, -1.0};
    for (size_t i = 0; i < sizeof gaps / sizeof *gaps; i++) {
        const nt_law_value value = law->at(law->parameters, gaps[i]);
        if (!(gaps[i] < minimum))
            continue;
        assert_true(value.F == at.F && value.k == 0.0 && value.a == 0.0);
        assert_within(value.U, at.U + at.F * (minimum - gaps[i]), 1e-14 * (fabs(value.U) + fabs(at.U)));
    }
    const nt_law_value deep = law->at(law->parameters, -INFINITY);
    assert_true(deep.F == at.F && deep.k == 0.0);
    assert_true(at.F == 0.0 ? deep.U == at.U : isinf(deep.U) && (deep.U > 0.0) == (at.F > 0.0));
}

/* NaN in, NaN out; nothing is left at an infinite gap; the largest double is as good as that. */
static inline void assert_ends(const force_law *law)
{
    const nt_law_value nan_value = law->at(law->parameters, NAN);
    assert_true(isnan(nan_value.U) && isnan(nan_value.F) && isnan(nan_value.k));
    const nt_law_value away = law->at(law->parameters, INFINITY);
    assert_true(away.U == 0.0 && away.F == 0.0 && away.k == 0.0 && away.a == 0.0);
    const nt_law_value far = law->at(law->parameters, 1.7e308);
    assert_true(fabs(far.U) < 1e-300 && fabs(far.F) < 1e-300 && fabs(far.k) < 1e-300);
}

/* The array form gives the bits of the scalar form, with strides, in place, and where outputs are left out. */
static inline void assert_array(const force_law *law)
{
    double in[22], F[33], k[11], U[11], a[11];
    for (int i = 0; i < 22; i++)
        in[i] = i == 6 ? (double)NAN : 1e-10 * exp(0.5 * i) - 2e-10;
    const nt_strided strided = {.in = in, .F = F, .count = 11, .in_stride = 2, .out_stride = 3};
    law->over(law->parameters, &strided);
    const nt_strided rest = {.in = in, .U = U, .k = k, .a = a, .count = 11, .in_stride = 2, .out_stride = 1};
    law->over(law->parameters, &rest);
    for (int i = 0; i < 11; i++) {
        const nt_law_value value = law->at(law->parameters, in[2 * i]);
        if (i == 3) {
            assert_true(isnan(F[9]) && isnan(U[3]) && isnan(k[3]));
            continue;
        }
        assert_true(F[3 * i] == value.F && U[i] == value.U && k[i] == value.k && a[i] == value.a);
    }
    const nt_strided in_place = {.in = in, .F = in, .count = 11, .in_stride = 2, .out_stride = 2};
    law->over(law->parameters, &in_place);
    for (int i = 0; i < 11; i++)
        assert_true(in[2 * i] == F[3 * i] || (isnan(in[2 * i]) && isnan(F[3 * i])));
}

static inline void assert_keeps_the_rules(const force_law *law)
{
    assert_held(law);
    assert_ends(law);
    assert_array(law);
}

/* Integral of f from 0 to infinity: Simpson in ln x from exp(-40) to exp(40) units. */
static inline double integral_to_infinity(double f(double x, const void *context), const void *context, double unit)
{
    enum { N = 20000 };
    const double step = 80.0 / N;
    double sum = 0.0;
    for (int i = 0; i <= N; i++) {
        const double x = unit * exp(-40.0 + i * step);
        sum += (i == 0 || i == N ? 1.0 : i % 2 ? 4.0 : 2.0) * f(x, context) * x;
    }
    return sum * step / 3.0;
}

#endif
