/* SPDX-License-Identifier: BSD-3-Clause
 * The equilibrium of tip and sample: Newton on the gaps at the nodes of a mesh that follows the pressure. In contact
 * the surface follows the tip, so that q(t) = E* (delta - t^2/R)/2 is known for t < a; it is continuous at a, since the
 * pressure is finite there (Maugis 1992, with any law in place of Dugdale's). */
#include <math.h>
#include <string.h>

#include "scene/deformation/deform.h"

enum { N = NT_DEFORM_ORDER, STEPS = 40, SLOPES = 12, MESHES = 24, TWICE = 2, HALVINGS = 24, HALVINGS_IN_CONTACT = 4 };
enum { MOST_MESHES = 3000 };  /* of one table, which takes 50 to 800: what comes to no end is told in seconds */
enum { FULL = HALVINGS / 4 }; /* what a step counts that no mesh resolves, which a shorter one may not cure */

#define CONVERGED 1e-11 /* of the largest gap */
#define AHEAD 0.7       /* of the way to where a law diverges */
#define TOLERABLE 10.0  /* times what a panel must resolve */
#define LITTLE 0.1      /* of a gap: so small a step leaves slopes as they are */
#define SLOW 0.1        /* from step to step */

double nt_deform_rim(const nt_deform_solver *s, double h, double x, double *slope)
{
    const double a = s->mesh.a, R = s->sample->radius, r2 = a * a + x, arc = asin(fmin(a / sqrt(r2), 1.0));
    *slope = -2.0 / NT_PI * arc;
    return 2.0 / NT_PI * ((-h - 0.5 * r2 / R) * arc + 0.5 * a / R * sqrt(x));
}

/* The same at a node, with what a layer adds. */
static double rim_at(const nt_deform_solver *s, int node, double *slope)
{
    const nt_deform_mesh *m = &s->mesh;
    *slope = 0.0;
    if (!(m->a > 0.0))
        return 0.0;
    const double u = nt_deform_rim(s, s->h, m->x[node], slope);
    *slope += m->bend[1][node];
    return u + m->bend[0][node] + m->bend[1][node] * s->h;
}

/* row -= factor by: where most of the time of a table is spent, in blocks that compilers turn into vectors. */
static void subtract(double *restrict row, const double *restrict by, double factor, int n)
{
    enum { BLOCK = 4 };
    int j = 0;
    for (; j + BLOCK <= n; j += BLOCK)
        for (int k = 0; k < BLOCK; ++k)
            row[j + k] -= factor * by[j + k];
    for (; j < n; ++j)
        row[j] -= factor * by[j];
}

/* Four sums side by side. */
double nt_deform_dot(const double *row, const double *by, int n)
{
    enum { BLOCK = 4 };
    double sum[BLOCK] = {0.0};
    int j = 0;
    for (; j + BLOCK <= n; j += BLOCK)
        for (int k = 0; k < BLOCK; ++k)
            sum[k] += row[j + k] * by[j + k];
    for (; j < n; ++j)
        sum[0] += row[j] * by[j];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* Whether there is work left for n equations. */
static int may_solve(nt_deform_solver *s, int n)
{
    const double of_full = (double)n / NT_DEFORM_NODES;
    if (!s->work)
        return 1;
    *s->work -= of_full * of_full * of_full;
    return *s->work > 0.0;
}

static void swap(double *x, double *y)
{
    const double keep = *x;
    *x = *y;
    *y = keep;
}

int nt_deform_factor(nt_deform_solver *s, int n)
{
    if (!may_solve(s, n))
        return 0;
    for (int c = 0; c < n; ++c) {
        int best = c;
        for (int i = c + 1; i < n; ++i)
            if (fabs(s->A[i][c]) > fabs(s->A[best][c]))
                best = i;
        if (!(fabs(s->A[best][c]) > 0.0))
            return 0;
        s->pivot[c] = best;
        for (int j = 0; j < n && best != c; ++j)
            swap(&s->A[c][j], &s->A[best][j]);
        for (int i = c + 1; i < n; ++i) {
            s->A[i][c] /= s->A[c][c];
            subtract(&s->A[i][c + 1], &s->A[c][c + 1], s->A[i][c], n - c - 1);
        }
    }
    return 1;
}

void nt_deform_back(const nt_deform_solver *s, double *b, int n)
{
    for (int c = 0; c < n; ++c)
        swap(&b[c], &b[s->pivot[c]]);
    for (int i = 1; i < n; ++i)
        b[i] -= nt_deform_dot(s->A[i], b, i);
    for (int i = n - 1; i >= 0; --i)
        b[i] = (b[i] - nt_deform_dot(&s->A[i][i + 1], &b[i + 1], n - i - 1)) / s->A[i][i];
}

int nt_deform_eliminate(nt_deform_solver *s, double *b, int n)
{
    if (!nt_deform_factor(s, n))
        return 0;
    nt_deform_back(s, b, n);
    return isfinite(b[0]);
}

static void press(const nt_deform_solver *s, nt_deform_pressed *p)
{
    for (int j = 0; j < s->mesh.count; ++j) {
        const nt_pressure at = nt_deform_law(s, s->gap[j]);
        p->pressure[j] = at.pressure;
        p->slope[j] = at.slope;
    }
}

/* What is left of the equations: each gap, and what is held. */
static void residual(const nt_deform_solver *s, nt_deform_hold hold, double value, const nt_deform_pressed *p,
                     double *b)
{
    const nt_deform_mesh *m = &s->mesh;
    const int n = m->count;
    const double u0 = nt_deform_dot(m->K0, p->pressure, n);
    double slope;
    for (int i = 0; i < n; ++i)
        b[i] = s->h + 0.5 * (m->a * m->a + m->x[i]) / s->sample->radius + rim_at(s, i, &slope) +
               nt_deform_dot(m->K[i], p->pressure, n) - s->gap[i];
    b[n] = value - s->h - (hold == NT_DEFORM_CENTRE ? u0 : 0.0);
    if (hold == NT_DEFORM_CONTACT)
        b[n] = s->h + m->a * m->a / s->sample->radius + u0 + m->edge[0] + m->edge[1] * s->h;
}

/* Their slopes. */
static void tangent(nt_deform_solver *s, nt_deform_hold hold, const nt_deform_pressed *p)
{
    const nt_deform_mesh *m = &s->mesh;
    const int n = m->count;
    const double sign = hold == NT_DEFORM_GAP ? 0.0 : hold == NT_DEFORM_CENTRE ? 1.0 : -1.0;
    for (int i = 0; i < n; ++i) {
        double slope;
        (void)rim_at(s, i, &slope);
        for (int j = 0; j < n; ++j)
            s->A[i][j] = -m->K[i][j] * p->slope[j];
        s->A[i][i] += 1.0;
        s->A[i][n] = -1.0 - slope;
        s->A[n][i] = sign * m->K0[i] * p->slope[i];
    }
    s->A[n][n] = hold == NT_DEFORM_CONTACT ? -1.0 - m->edge[1] : 1.0;
}

/* With the slopes as they are, or not `fresh`, as they were in the last step that was. */
static nt_deform_step newton_step(nt_deform_solver *s, nt_deform_hold hold, double value, int fresh)
{
    const int n = s->mesh.count;
    const nt_deform_step none = {NAN, NAN};
    nt_deform_pressed p = {{0.0}, {0.0}};
    double b[NT_DEFORM_NODES + 1], ahead = 1.0, near = 0.0, far = 0.0, most = 0.0;
    press(s, &p);
    residual(s, hold, value, &p, b);
    if (fresh) {
        tangent(s, hold, &p);
        if (!nt_deform_factor(s, n + 1))
            return none;
    }
    nt_deform_back(s, b, n + 1);
    for (int i = 0; i < n; ++i) {
        const double left = s->gap[i] - s->sample->pole;
        near = left > 0.0 ? fmax(near, fabs(b[i]) / left) : (double)INFINITY;
        if (-b[i] > AHEAD * left)
            ahead = fmin(ahead, AHEAD * left / -b[i]);
    }
    for (int i = 0; i < n; ++i) {
        s->gap[i] += ahead * b[i];
        far = fmax(far, fabs(s->gap[i]));
        most = fmax(most, fabs(b[i]));
        if (!isfinite(s->gap[i]))
            return none;
    }
    s->h += ahead * b[n];
    return (nt_deform_step){most / (far + fabs(s->h)), near};
}

/* Slopes are found again only where the last step changed them much, or did not come much nearer. From a start that is
 * near enough that takes one to five times; what takes more most often comes to no end. */
static nt_status newton(nt_deform_solver *s, nt_deform_hold hold, double value)
{
    double before = INFINITY;
    for (int i = 0, fresh = 1, slopes = 0; i < STEPS && slopes < SLOPES; ++i) {
        slopes += fresh;
        const nt_deform_step by = newton_step(s, hold, value, fresh);
        if (isnan(by.far))
            return NT_E_NO_CONVERGENCE;
        if (by.far < CONVERGED)
            return NT_OK;
        fresh = by.near > LITTLE || by.far > SLOW * before;
        before = by.far;
    }
    return NT_E_NO_CONVERGENCE;
}

/* Newton, a better mesh, Newton, ...; what a full mesh does not resolve has to be within the tolerance of others. */
static nt_status settle(nt_deform_solver *s, nt_deform_hold hold, double value)
{
    nt_deform_edges list;
    for (int i = 0; i < MESHES && nt_deform_may_mesh(s); ++i) {
        s->graded = i >= TWICE;
        const nt_status status = newton(s, hold, value);
        if (status != NT_OK)
            return status;
        if (!nt_deform_refine(s, &list))
            return NT_OK;
        if (list.count <= NT_DEFORM_PANELS + 1) {
            nt_deform_move(s, list.at, list.count - 1, s->mesh.a);
            continue;
        }
        if (!nt_deform_coarsen(s))
            return s->rough < TOLERABLE ? NT_OK : NT_E_CAPACITY;
    }
    return NT_E_NO_CONVERGENCE;
}

nt_status nt_deform_begin(nt_deform_solver *s, const nt_deform_sample *sample, double gap)
{
    s->sample = sample;
    s->left = MOST_MESHES;
    s->h = gap;
    s->mesh.a = 0.0;
    s->mesh.panels = 4;
    for (int i = 0; i <= 4; ++i)
        s->mesh.edges[i] = i == 0 ? 0.0 : 2.0 * sample->radius * sample->length * pow(2.0, i - 1);
    nt_deform_mesh_make(&s->mesh, sample, s->A[0]);
    for (int i = 0; i < s->mesh.count; ++i)
        s->gap[i] = gap + 0.5 * s->mesh.x[i] / sample->radius;
    return settle(s, NT_DEFORM_GAP, gap);
}

/* --- One point --- */

/* Of the whole: F, k, the gap under the apex and its slope in h, by the tangent at fixed a. */
static int report(nt_deform_solver *s, nt_deform_point *point)
{
    const nt_deform_mesh *m = &s->mesh;
    const int n = m->count;
    const double R = s->sample->radius, E = s->sample->modulus, a = m->a;
    nt_deform_pressed p = {{0.0}, {0.0}};
    double y[NT_DEFORM_NODES];
    press(s, &p);
    for (int i = 0; i < n; ++i) {
        double slope;
        (void)rim_at(s, i, &slope);
        y[i] = 1.0 + slope;
        for (int j = 0; j < n; ++j)
            s->A[i][j] = (i == j) - m->K[i][j] * p.slope[j];
    }
    if (!nt_deform_eliminate(s, y, n))
        return 0;
    const nt_pressure outer = nt_deform_law(s, nt_deform_outer_gap(s));
    double F = 2.0 * NT_PI * R * outer.energy, k = 2.0 * NT_PI * R * outer.pressure, u0 = 0.0, u0_slope = 0.0;
    for (int j = 0; j < n; ++j) {
        const double weight = a > 0.0 ? m->load[j] : m->area[j];
        F += weight * p.pressure[j];
        k -= weight * p.slope[j] * y[j];
        u0 += m->K0[j] * p.pressure[j];
        u0_slope += m->K0[j] * p.slope[j] * y[j];
    }
    *point = (nt_deform_point){s->h, F, k, s->h + u0, 1.0 + u0_slope, a, 0.0};
    if (a > 0.0) {
        F += 2.0 * E * a * (-s->h - a * a / (3.0 * R)) + m->push[0] + m->push[1] * s->h;
        *point = (nt_deform_point){s->h, F, k + 2.0 * E * a - m->push[1], 0.0, 0.0, a, 0.0};
    }
    point->peak = nt_deform_peak_of(s, point->centre);
    return isfinite(point->F) && isfinite(point->k);
}

static double value_of(const nt_deform_solver *s, nt_deform_hold hold)
{
    double u0 = 0.0;
    if (hold == NT_DEFORM_GAP)
        return s->h;
    if (hold == NT_DEFORM_CONTACT)
        return s->mesh.a;
    for (int j = 0; j < s->mesh.count; ++j)
        u0 += s->mesh.K0[j] * nt_deform_law(s, s->gap[j]).pressure;
    return s->h + u0;
}

nt_deform_state nt_deform_keep(const nt_deform_solver *s)
{
    nt_deform_state state = {.h = s->h, .a = s->mesh.a, .end = s->end, .panels = s->mesh.panels};
    memcpy(state.gap, s->gap, sizeof state.gap);
    memcpy(state.edges, s->mesh.edges, sizeof state.edges);
    return state;
}

void nt_deform_restore(nt_deform_solver *s, const nt_deform_state *state)
{
    nt_deform_move(s, state->edges, state->panels, state->a);
    memcpy(s->gap, state->gap, sizeof s->gap);
    s->h = state->h;
    s->end = state->end;
}

static int sticks(const nt_deform_solver *s)
{
    return s->sample->stress > 0.0;
}

/* One step, from and back to what was found last. */
static nt_status step_to(nt_deform_solver *s, nt_deform_hold hold, double value)
{
    const nt_deform_state before = nt_deform_keep(s);
    if (hold == NT_DEFORM_CONTACT && !sticks(s))
        nt_deform_move(s, before.edges, before.panels, value);
    const nt_status status =
        sticks(s) ? nt_deform_settle_contact(s, value, s->end * value / before.a) : settle(s, hold, value);
    if (status != NT_OK)
        nt_deform_restore(s, &before);
    return status;
}

static int report_of(nt_deform_solver *s, nt_deform_point *point)
{
    return sticks(s) ? nt_deform_report_contact(s, point) : report(s, point);
}

nt_status nt_deform_go(nt_deform_solver *s, nt_deform_hold hold, double value, nt_deform_point *point)
{
    double here = value_of(s, hold), target = value;
    if (!sticks(s))
        (void)nt_deform_coarsen(s);
    for (int halvings = 0; halvings < (sticks(s) ? HALVINGS_IN_CONTACT : HALVINGS);) {
        const nt_status status = step_to(s, hold, target);
        if (status != NT_OK) {
            target = 0.5 * (here + target);
            halvings += status == NT_E_CAPACITY ? FULL : 1;
            continue;
        }
        if (target == value)
            return !point || report_of(s, point) ? NT_OK : NT_E_NO_CONVERGENCE;
        here = target;
        target = value;
    }
    return NT_E_NO_CONVERGENCE;
}
