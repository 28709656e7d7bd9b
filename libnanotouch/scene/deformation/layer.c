/* SPDX-License-Identifier: BSD-3-Clause
 * A layer bonded to rigid ground (Chen and Engel 1972): it answers q by Q(t) = q(t) + sum_n W_n cos(k_n t) C_n, where
 * C_n = Int q cos(k_n t) dt, as a half-space answers Q. In contact the surface follows the tip, so that Q is known for
 * t < a, Q0 = E*(-h - t^2/R)/2, and q = Q0 - sum_n W_n cos(k_n t) C_n there (Lebedev and Ufliand 1958):
 *
 *     (I + G W) C = Int_0^a Q0 cos(k_n t) dt + Int_a q cos(k_n t) dt        G_nm = Int_0^a cos(k_n t) cos(k_m t) dt
 */
#include <math.h>
#include <string.h>

#include "scene/deformation/deform.h"

enum { WAVES = NT_DEFORM_WAVES, NODES = NT_DEFORM_NODES };

#define FAR 16.0   /* series of the sine integral */
#define SHORT 0.05 /* k a, below which a series is nearer than the closed form */

/* Int_0^a of cos(k t) and t^2 cos(k t). */
static double first(double k, double a)
{
    return k * a > 0.0 ? sin(k * a) / k : a;
}

static double second(double k, double a)
{
    const double y = k * a, y2 = y * y;
    if (y < SHORT)
        return a * a * a * (1.0 / 3.0 - y2 / 10.0 + y2 * y2 / 168.0);
    return (a * a * sin(y) + 2.0 * a * cos(y) / k - 2.0 * sin(y) / (k * k)) / k;
}

/* Int_0^y sin(t)/t dt: its series, or far out its asymptotic one. */
static double sine_integral(double y)
{
    const double y2 = y * y;
    double sum = 0.0, term = y;
    if (y > FAR) {
        const double f = (1.0 - (2.0 - (24.0 - 720.0 / y2) / y2) / y2) / y;
        const double g = (1.0 - (6.0 - (120.0 - 5040.0 / y2) / y2) / y2) / y2;
        return 0.5 * NT_PI - f * cos(y) - g * sin(y);
    }
    for (int n = 1; fabs(term) > 1e-17 * y || n < y; n += 2) {
        sum += term / n;
        term *= -y2 / ((n + 1.0) * (n + 2.0));
    }
    return sum;
}

/* What the solution is wanted for: each node, -Q0's part of h, and its part of R. */
typedef struct columns {
    double *node; /* [wave][node] */
    double h[WAVES], R[WAVES];
} columns;

static void swap_rows(double S[WAVES][WAVES], columns *c, int one, int two)
{
    for (int j = 0; j < WAVES + NODES + 2 && one != two; ++j) {
        double *x = j < WAVES ? &S[one][j] : &c->node[one * NODES + j - WAVES];
        double *y = j < WAVES ? &S[two][j] : &c->node[two * NODES + j - WAVES];
        if (j >= WAVES + NODES) {
            x = j == WAVES + NODES ? &c->h[one] : &c->R[one];
            y = j == WAVES + NODES ? &c->h[two] : &c->R[two];
        }
        const double keep = *x;
        *x = *y;
        *y = keep;
    }
}

/* Row `to` less `factor` times row `from`. */
static void subtract(columns *c, int count, int to, int from, double factor)
{
    for (int j = 0; j < count; ++j)
        c->node[to * NODES + j] -= factor * c->node[from * NODES + j];
    c->h[to] -= factor * c->h[from];
    c->R[to] -= factor * c->R[from];
}

/* Solves S X = c in place: Gauss with row pivots, then back. */
static void solve(double S[WAVES][WAVES], columns *c, int count)
{
    for (int n = 0; n < WAVES; ++n) {
        int best = n;
        for (int i = n + 1; i < WAVES; ++i)
            if (fabs(S[i][n]) > fabs(S[best][n]))
                best = i;
        swap_rows(S, c, n, best);
        for (int i = n + 1; i < WAVES; ++i) {
            const double factor = S[i][n] / S[n][n];
            for (int j = n; j < WAVES && factor != 0.0; ++j)
                S[i][j] -= factor * S[n][j];
            subtract(c, count, i, n, factor);
        }
    }
    for (int n = WAVES - 1; n >= 0; --n) {
        subtract(c, count, n, n, 1.0 - 1.0 / S[n][n]);
        for (int i = 0; i < n; ++i)
            subtract(c, count, i, n, S[i][n]);
    }
}

/* C by nodes, h and R; then W C. */
static void answer(const nt_deform_mesh *mesh, const nt_deform_sample *sample, const nt_deform_spectrum *s, columns *c)
{
    const double a = mesh->a, half = 0.5 * sample->modulus;
    double S[WAVES][WAVES];
    for (int n = 0; n < WAVES; ++n) {
        c->h[n] = half * first(s->k[n], a);
        c->R[n] = half / sample->radius * second(s->k[n], a);
        for (int m = 0; m < WAVES; ++m)
            S[n][m] = (n == m) + 0.5 * s->weight[m] * (first(fabs(s->k[n] - s->k[m]), a) + first(s->k[n] + s->k[m], a));
    }
    if (a > 0.0)
        solve(S, c, mesh->count);
    for (int n = 0; n < WAVES; ++n) {
        for (int i = 0; i < mesh->count; ++i)
            c->node[n * NODES + i] *= s->weight[n];
        c->h[n] *= s->weight[n];
        c->R[n] *= s->weight[n];
    }
}

void nt_deform_layer_add(nt_deform_mesh *mesh, const nt_deform_sample *sample, const nt_deform_spectrum *s,
                         double *waves)
{
    columns c = {.node = waves + WAVES * NODES};
    memcpy(c.node, waves, WAVES * NODES * sizeof *waves);
    answer(mesh, sample, s, &c);
    for (int n = 0; n < WAVES; ++n) {
        const double *wave = waves + n * NODES, *answered = c.node + n * NODES;
        const double rim = 2.0 / sample->modulus * cos(s->k[n] * mesh->a), inside = 4.0 * first(s->k[n], mesh->a);
        const double apex = -2.0 / NT_PI * s->k[n] * sine_integral(s->k[n] * mesh->a);
        for (int i = 0; i < mesh->count; ++i) {
            mesh->K0[i] += rim * answered[i];
            mesh->load[i] -= inside * answered[i];
            mesh->under_load[i] += apex * answered[i];
            mesh->bend[0][i] -= 8.0 / sample->modulus / mesh->area[i] * wave[i] * c.R[n];
            mesh->bend[1][i] -= 8.0 / sample->modulus / mesh->area[i] * wave[i] * c.h[n];
            for (int j = i; j < mesh->count; ++j)
                mesh->K[i][j] += wave[i] * answered[j];
        }
        mesh->edge[0] -= rim * c.R[n];
        mesh->edge[1] -= rim * c.h[n];
        mesh->under[0] -= apex * c.R[n];
        mesh->under[1] -= apex * c.h[n];
        mesh->push[0] += inside * c.R[n];
        mesh->push[1] += inside * c.h[n];
    }
}
