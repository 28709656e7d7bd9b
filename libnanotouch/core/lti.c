/* SPDX-License-Identifier: BSD-3-Clause
 * Exact zero-order-hold discretisation: with u constant, (x, u)' = [[A, B], [0, 0]] (x, u), so that one matrix
 * exponential gives phi and gamma (Van Loan 1978). The exponential is scaled to |M| < 1/2, where 17 terms of Taylor's
 * series are exact to rounding, and squared back. It is kept as X = exp(M) - 1, (1 + X)^2 - 1 = 2 X + X^2, so that the
 * small entries of a short period keep their relative accuracy. */
#include "lti.h"

#include <math.h>

enum { SIZE = NT_LTI_MAX + 1, TERMS = 17, SQUARINGS_MAX = 42 };

typedef struct matrix {
    int n;
    double at[SIZE][SIZE];
} matrix;

static matrix matrix_product(const matrix *p, const matrix *q)
{
    matrix r = {.n = p->n};
    for (int i = 0; i < p->n; i++)
        for (int k = 0; k < p->n; k++)
            for (int j = 0; j < p->n; j++)
                r.at[i][j] += p->at[i][k] * q->at[k][j];
    return r;
}

/* Largest row sum. */
static double matrix_norm(const matrix *m)
{
    double norm = 0.0;
    for (int i = 0; i < m->n; i++) {
        double sum = 0.0;
        for (int j = 0; j < m->n; j++)
            sum += fabs(m->at[i][j]);
        if (sum > norm || isnan(sum))
            norm = sum;
    }
    return norm;
}

/* exp(M) - 1 = M (1 + M/2 (1 + M/3 (...))), for |M| < 1/2. */
static matrix series_expm1(const matrix *m)
{
    matrix sum = {.n = m->n};
    for (int term = TERMS; term >= 1; term--) {
        for (int i = 0; i < m->n; i++)
            sum.at[i][i] += 1.0;
        sum = matrix_product(m, &sum);
        for (int i = 0; i < m->n; i++)
            for (int j = 0; j < m->n; j++)
                sum.at[i][j] /= term;
    }
    return sum;
}

static matrix matrix_expm1(matrix m, int squarings)
{
    for (int i = 0; i < m.n; i++)
        for (int j = 0; j < m.n; j++)
            m.at[i][j] = ldexp(m.at[i][j], -squarings);
    matrix x = series_expm1(&m);
    for (int s = 0; s < squarings; s++) {
        const matrix square = matrix_product(&x, &x);
        for (int i = 0; i < m.n; i++)
            for (int j = 0; j < m.n; j++)
                x.at[i][j] = 2.0 * x.at[i][j] + square.at[i][j];
    }
    return x;
}

nt_status nt_lti_discretise(const nt_lti *continuous, double period, nt_lti *discrete)
{
    const int n = continuous->order;
    if (n < 1 || n > NT_LTI_MAX)
        return NT_E_ARGUMENT;
    matrix m = {.n = n + 1};
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++)
            m.at[i][j] = continuous->a[i][j] * period;
        m.at[i][n] = continuous->b[i] * period;
    }
    const double norm = matrix_norm(&m);
    if (!isfinite(norm) || !isfinite(period))
        return NT_E_NOT_FINITE;
    const int squarings = norm < 0.5 ? 0 : ilogb(norm) + 2;
    if (period <= 0.0 || squarings > SQUARINGS_MAX)
        return NT_E_RANGE;

    const matrix x = matrix_expm1(m, squarings);
    nt_lti result = {.order = n};
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++)
            result.a[i][j] = x.at[i][j] + (i == j ? 1.0 : 0.0);
        result.b[i] = x.at[i][n];
    }
    *discrete = result;
    return NT_OK;
}
