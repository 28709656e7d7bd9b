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

enum { N = NT_DEFORM_ORDER, NT = 2 * NT_DEFORM_ORDER + 4, PIECES = 6 };

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

/* q(tau) of a unit pressure at each node. */
static void abel_row(const nt_deform_mesh *mesh, const basis *b, double tau, double row[NT_DEFORM_NODES])
{
    for (int panel = 0; panel < mesh->panels; ++panel) {
        const double e0 = mesh->edges[panel], e1 = mesh->edges[panel + 1];
        const double low = sqrt(fmax(e0 - tau * tau, 0.0)), high = sqrt(fmax(e1 - tau * tau, 0.0));
        double c[N] = {0.0};
        for (int i = 0; i < N && high > 0.0; ++i) {
            const double sigma = low + (high - low) * b->x[i];
            double P[N];
            legendre(2.0 * (tau * tau + sigma * sigma - e0) / (e1 - e0) - 1.0, P);
            for (int k = 0; k < N; ++k)
                c[k] += b->w[i] * (high - low) * P[k];
        }
        for (int j = 0; j < N; ++j) {
            double sum = 0.0;
            for (int k = 0; k < N; ++k)
                sum += c[k] * b->L[k][j];
            row[panel * N + j] = sum;
        }
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

/* One t of the quadrature into K (here: of the energy) and load. */
static void add_row(nt_deform_mesh *mesh, const double row[NT_DEFORM_NODES], double weight)
{
    for (int i = 0; i < mesh->count; ++i) {
        const double scaled = weight * row[i];
        mesh->load[i] += 4.0 * scaled;
        for (int j = i; j < mesh->count && scaled != 0.0; ++j)
            mesh->K[i][j] += scaled * row[j];
    }
}

static void add_waves(const nt_deform_mesh *mesh, const nt_deform_spectrum *s, const double row[NT_DEFORM_NODES],
                      double *waves, const double tw[2])
{
    for (int n = 0; n < NT_DEFORM_WAVES; ++n) {
        const double wave = tw[1] * cos(s->k[n] * tw[0]);
        for (int i = 0; i < mesh->count; ++i)
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
    double y[NT], w[NT], row[NT_DEFORM_NODES];
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
    memset(waves, 0, NT_DEFORM_WAVES * NT_DEFORM_NODES * sizeof *waves);
    for (int panel = 0; panel < mesh->panels; ++panel)
        for (int i = 0; i < NT; ++i) {
            const double span = sqrt(mesh->edges[panel + 1]) - sqrt(mesh->edges[panel]);
            const double tau = sqrt(mesh->edges[panel + 1]) - span * y[i] * y[i], t = hypotenuse(tau, mesh->a);
            abel_row(mesh, &b, tau, row);
            const double weight = 2.0 * span * y[i] * w[i] * tau / t;
            add_row(mesh, row, weight);
            for (int j = 0; j < mesh->count && panel == 0 && sample->stress > 0.0; ++j) /* u(r) by Abel */
                mesh->K1[j] += 4.0 / (NT_PI * sample->modulus) * weight / sqrt(mesh->edges[1] - tau * tau) * row[j];
            if (layered)
                add_waves(mesh, &s, row, waves, (double[2]){t, weight});
        }
    abel_row(mesh, &b, 0.0, row);
    for (int i = 0; i < mesh->count; ++i)
        mesh->K0[i] = 2.0 / sample->modulus * row[i];
    if (layered)
        nt_deform_layer_add(mesh, sample, &s, waves);
    for (int i = 0; i < mesh->count; ++i)
        for (int j = i; j < mesh->count; ++j) {
            const double twice = 8.0 / sample->modulus * mesh->K[i][j];
            mesh->K[i][j] = twice / mesh->area[i];
            mesh->K[j][i] = twice / mesh->area[j];
        }
}
