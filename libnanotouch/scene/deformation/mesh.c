/* SPDX-License-Identifier: BSD-3-Clause
 * Axisymmetric pressures on a half-space or layer. By Abel's transform the kernel has no singularity (method of
 * dimensionality reduction, Popov and Hess 2015): with r^2 = a^2 + x, t^2 = a^2 + tau^2
 *
 *     q(t) = Int_t^inf p r dr/sqrt(r^2 - t^2)      U_el = 4/E* Int q^2 dt      u_j = dU_el/d(p_j dA_j)
 *
 * p is a polynomial of x on each panel: with sigma^2 = x - tau^2 its q is exact by Gauss. A layer bonded to rigid
 * ground adds 8/(pi E*) Int (X(k t) - 1) (Int q cos(k t) dt)^2 dk to U_el. */
#include <math.h>
#include <string.h>

#include "core/same_bits.h"
#include "scene/deformation/deform.h"

enum { N = NT_DEFORM_ORDER, NT = 2 * NT_DEFORM_ORDER + 4, PIECES = 6 }; /* NT is a multiple of ROWS */

/* Legendre polynomials 0 .. N - 1 at y in -1..1. */
static void legendre(double y, double P[N])
{
    P[0] = 1.0;
    P[1] = y;
    for (int k = 2; k < N; ++k)
        P[k] = ((2.0 * k - 1.0) * y * P[k - 1] - (k - 1.0) * P[k - 2]) / k;
}

/* Gauss' nodes and weights on 0..1: Newton on the Legendre polynomial. */
static void gauss(int count, double *nodes, double *weights)
{
    for (int i = 0; i < count; ++i) {
        double y = -cos(NT_PI * (i + 0.75) / (count + 0.5)), slope = 1.0;
        for (int step = 0; step < 8; ++step) {
            double before = 1.0, here = y;
            for (int k = 2; k <= count; ++k) {
                const double next = ((2.0 * k - 1.0) * y * here - (k - 1.0) * before) / k;
                before = here;
                here = next;
            }
            slope = count * (y * here - before) / (y * y - 1.0);
            y -= here / slope;
        }
        nodes[i] = 0.5 * (1.0 + y);
        weights[i] = 1.0 / ((1.0 - y * y) * slope * slope);
    }
}

/* From values at the nodes of a panel to Legendre coefficients: L[k][j]. */
typedef struct basis {
    double x[N], w[N], L[N][N];
} basis;

static basis basis_of(void)
{
    basis b;
    gauss(N, b.x, b.w);
    for (int j = 0; j < N; ++j) {
        double P[N];
        legendre(2.0 * b.x[j] - 1.0, P);
        for (int k = 0; k < N; ++k)
            b.L[k][j] = (2.0 * k + 1.0) * b.w[j] * P[k];
    }
    return b;
}

double nt_deform_mesh_tail(const nt_deform_mesh *mesh, const double *values, int panel)
{
    double tail = 0.0;
    for (int k = N - 2; k < N; ++k) {
        double sum = 0.0;
        for (int j = 0; j < N; ++j)
            sum += mesh->L[k][j] * values[panel * N + j];
        tail = fmax(tail, fabs(sum));
    }
    return tail;
}

double nt_deform_mesh_at(const nt_deform_mesh *mesh, const double *values, double x)
{
    const double last = mesh->edges[mesh->panels], inside = fmin(fmax(x, 0.0), last);
    int panel = 0;
    double P[N], sum = 0.0;
    while (panel < mesh->panels - 1 && inside > mesh->edges[panel + 1])
        ++panel;
    const double width = mesh->edges[panel + 1] - mesh->edges[panel];
    legendre(2.0 * (inside - mesh->edges[panel]) / width - 1.0, P);
    for (int k = 0; k < N; ++k)
        for (int j = 0; j < N; ++j)
            sum += P[k] * mesh->L[k][j] * values[panel * N + j];
    return x > last ? sum * sqrt(last / x) : sum;
}

static double sum_of(const double v[N])
{
    return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]));
}

/* sums[k] = Sum_i w[i] P_k(y[i]), all points side by side: a mesh takes most of its time here. */
static void legendre_sums(const double w[N], const double y[N], double sums[N])
{
    double before[N], here[N];
    for (int i = 0; i < N; ++i) {
        before[i] = w[i];
        here[i] = w[i] * y[i];
    }
    sums[0] = sum_of(before);
    sums[1] = sum_of(here);
    for (int k = 2; k < N; ++k) {
        const double ahead = (2.0 * k - 1.0) / k, behind = (k - 1.0) / k;
        for (int i = 0; i < N; ++i) {
            const double next = ahead * y[i] * here[i] - behind * before[i];
            before[i] = here[i];
            here[i] = next;
        }
        sums[k] = sum_of(here);
    }
}

/* q(tau) of a unit pressure at each node of the panels from `first` on; those before it lie inside tau. */
static void abel_row(const nt_deform_mesh *mesh, const basis *b, double tau, int first, double row[NT_DEFORM_NODES])
{
    for (int panel = first; panel < mesh->panels; ++panel) {
        const double e0 = mesh->edges[panel], e1 = mesh->edges[panel + 1], per_width = 2.0 / (e1 - e0);
        const double low = sqrt(fmax(e0 - tau * tau, 0.0)), high = sqrt(fmax(e1 - tau * tau, 0.0));
        double w[N], y[N], c[N], sum[N] = {0.0};
        for (int i = 0; i < N; ++i) {
            const double sigma = low + (high - low) * b->x[i];
            w[i] = b->w[i] * (high - low);
            y[i] = (tau * tau + sigma * sigma - e0) * per_width - 1.0;
        }
        legendre_sums(w, y, c);
        for (int k = 0; k < N; ++k)
            for (int j = 0; j < N; ++j)
                sum[j] += c[k] * b->L[k][j];
        memcpy(row + (size_t)panel * N, sum, sizeof sum);
    }
}

/* Of a bonded layer (Chen and Engel 1972). */
static nt_deform_spectrum spectrum_of(const nt_deform_sample *sample)
{
    static const double pieces[PIECES + 1] = {0.0, 0.5, 1.5, 3.0, 6.0, 10.0, 16.0};
    const double nu = sample->poisson_ratio;
    const basis b = basis_of();
    nt_deform_spectrum s;
    for (int i = 0; i < NT_DEFORM_WAVES; ++i) {
        const double from = pieces[i / N], width = pieces[i / N + 1] - from, kappa = from + width * b.x[i % N];
        const double top = (3.0 - 4.0 * nu) * sinh(2.0 * kappa) - 2.0 * kappa;
        const double bottom =
            (3.0 - 4.0 * nu) * cosh(2.0 * kappa) + 2.0 * kappa * kappa + 5.0 - 12.0 * nu + 8.0 * nu * nu;
        s.k[i] = kappa / sample->thickness;
        s.weight[i] = 2.0 / NT_PI * sample->share * width * b.w[i % N] / sample->thickness * (top / bottom - 1.0);
    }
    return s;
}

/* Some t of the quadrature: their rows, and weights. */
enum { ROWS = 4 };
typedef struct rows {
    double row[ROWS][NT_DEFORM_NODES], weight[ROWS];
} rows;

/* Into K (here: of the energy) and load, of the nodes from `first` on. */
static void add_rows(nt_deform_mesh *mesh, const rows *of, int first)
{
    const int count = mesh->count;
    for (int i = first; i < count; ++i) {
        double *restrict K = mesh->K[i], scaled[ROWS];
        for (int k = 0; k < ROWS; ++k)
            mesh->load[i] += 4.0 * (scaled[k] = of->weight[k] * of->row[k][i]);
        for (int j = i; j < count; ++j)
            K[j] += (scaled[0] * of->row[0][j] + scaled[1] * of->row[1][j]) +
                    (scaled[2] * of->row[2][j] + scaled[3] * of->row[3][j]);
    }
}

static void add_waves(const nt_deform_mesh *mesh, const nt_deform_spectrum *s, const double row[NT_DEFORM_NODES],
                      int first, double *waves, const double tw[2])
{
    for (int n = 0; n < NT_DEFORM_WAVES; ++n) {
        const double wave = tw[1] * cos(s->k[n] * tw[0]);
        for (int i = first; i < mesh->count; ++i)
            waves[n * NT_DEFORM_NODES + i] += wave * row[i];
    }
}

static void place_nodes(nt_deform_mesh *mesh, const basis *b)
{
    mesh->count = mesh->panels * N;
    for (int i = 0; i < mesh->count; ++i) {
        const double from = mesh->edges[i / N], width = mesh->edges[i / N + 1] - from;
        mesh->x[i] = from + width * b->x[i % N];
        mesh->area[i] = NT_PI * width * b->w[i % N];
    }
}

void nt_deform_mesh_make(nt_deform_mesh *mesh, const nt_deform_sample *sample, double *waves)
{
    const basis b = basis_of();
    const int layered = sample->thickness > 0.0;
    double y[NT], w[NT];
    rows at;
    nt_deform_spectrum s;
    if (layered)
        s = spectrum_of(sample);
    gauss(NT, y, w);
    memcpy(mesh->L, b.L, sizeof mesh->L);
    place_nodes(mesh, &b);
    memset(mesh->K, 0, sizeof mesh->K);
    memset(mesh->load, 0, sizeof mesh->load);
    memset(mesh->K1, 0, sizeof mesh->K1);
    memset(mesh->bend, 0, sizeof mesh->bend);
    memset(mesh->edge, 0, sizeof mesh->edge);
    memset(mesh->push, 0, sizeof mesh->push);
    memset(mesh->under, 0, sizeof mesh->under);
    memset(mesh->under_load, 0, sizeof mesh->under_load);
    if (layered)
        memset(waves, 0, NT_DEFORM_WAVES * NT_DEFORM_NODES * sizeof *waves);
    for (int panel = 0; panel < mesh->panels; ++panel)
        for (int i = 0; i < NT; ++i) {
            const double span = sqrt(mesh->edges[panel + 1]) - sqrt(mesh->edges[panel]);
            const double tau = sqrt(mesh->edges[panel + 1]) - span * y[i] * y[i], t = hypotenuse(tau, mesh->a);
            double *row = at.row[i % ROWS];
            abel_row(mesh, &b, tau, panel, row);
            const double weight = at.weight[i % ROWS] = 2.0 * span * y[i] * w[i] * tau / t;
            if (i % ROWS == ROWS - 1)
                add_rows(mesh, &at, panel * N);
            for (int j = 0; j < mesh->count && panel == 0 && sample->stress > 0.0; ++j) /* u(r) by Abel */
                mesh->K1[j] += 4.0 / (NT_PI * sample->modulus) * weight / sqrt(mesh->edges[1] - tau * tau) * row[j];
            if (layered)
                add_waves(mesh, &s, row, panel * N, waves, (double[2]){t, weight});
        }
    abel_row(mesh, &b, 0.0, 0, at.row[0]);
    for (int i = 0; i < mesh->count; ++i)
        mesh->K0[i] = 2.0 / sample->modulus * at.row[0][i];
    if (layered)
        nt_deform_layer_add(mesh, sample, &s, waves);
    for (int i = 0; i < mesh->count; ++i)
        for (int j = i; j < mesh->count; ++j) {
            const double twice = 8.0 / sample->modulus * mesh->K[i][j];
            mesh->K[i][j] = twice / mesh->area[i];
            mesh->K[j][i] = twice / mesh->area[j];
        }
}
