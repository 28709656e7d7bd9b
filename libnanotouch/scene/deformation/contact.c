/* SPDX-License-Identifier: BSD-3-Clause
 * Adhesive contact of a sample that other laws press on, too: the equilibrium at a radius of contact. Where the surface
 * follows the tip q(t) = E* (delta - t^2/R)/2, t < a; from there to the end of adhesion, at gap h0, the pressure
 * is -sigma0 (Maugis 1992); outside it is that of the law. q is continuous at a, since all pressures are finite. The
 * end of adhesion is an edge of the mesh, found by its gap: a step of the pressure, to which Newton is blind. */
#include <math.h>
#include <string.h>

#include "scene/deformation/deform.h"

enum { N = NT_DEFORM_ORDER, OUTER = NT_DEFORM_PANELS - 3, MOST_MESHES = 800 };
enum { NEWTONS = 40, EDGES = 60, KINKS = 8, SECANTS = 8 };

#define FADED 1e-7    /* of the energy where adhesion ends: the mesh goes so far */
#define CUT 20.0      /* tip radii: a law that fades slower is cut there; at half a radius its far part was felt */
#define FIRST 0.1     /* of the width of adhesion: the first panel outside, where the gap rises most steeply */
#define OCTAVES 1.7   /* from panel to panel, if there is room */
#define WIDEST 4.0    /* coarser is not resolved */
#define SETTLED 1e-11 /* of the gaps */
#define AHEAD 0.7     /* of a gap, in one step */
#define LITTLE 0.1    /* of a gap: so small a step leaves slopes as they are */
#define SLOW 0.1      /* from step to step */
#define PLACED 1e-3   /* of x: where a kink of the law is */
#define NEARBY 0.3    /* of a panel: an edge so close to a kink gives way */
#define LEAST 0.01    /* of the law, in one step on the way to all of it */
#define FARTHEST 1e-2 /* [m] */
#define LONGEST 0.2   /* step over ln e */
#define END 1e-7      /* of h0: where adhesion ends */
#define NUDGE 3e-4    /* of the end of adhesion, for its slope */

/* How far the law reaches outside adhesion [m]. */
static double reach_of(const nt_deform_sample *sample)
{
    const double W = fabs(sample->law(sample->context, sample->range).energy);
    double rise = fmax(sample->length, sample->range);
    while (fabs(sample->law(sample->context, sample->range + rise).energy) > FADED * W && rise < CUT * sample->radius)
        rise *= 1.3;
    return rise;
}

static void put_kink(nt_deform_edges *list, double x)
{
    for (int i = 2; i < list->count; ++i) {
        if (list->at[i] < x)
            continue;
        const double width = list->at[i] - list->at[i - 1];
        if (list->at[i] - x < NEARBY * width) {
            list->at[i] = x;
        } else if (i > 2 && x - list->at[i - 1] < NEARBY * width) {
            list->at[i - 1] = x;
        } else if (list->count <= NT_DEFORM_PANELS) {
            for (int j = list->count++; j > i; --j)
                list->at[j] = list->at[j - 1];
            list->at[i] = x;
        }
        return;
    }
}

/* Beyond the end of adhesion each panel is farther out by the same ratio; 0 where that is too coarse. */
static int edges_of(const nt_deform_solver *s, double a, double e, nt_deform_edges *list)
{
    const double far = 2.0 * s->sample->radius * s->reach + a * a + 4.0 * e, octaves = log2(far / e / FIRST);
    const int panels = (int)fmin(fmax(ceil(octaves / OCTAVES), 3.0), OUTER);
    list->count = 0;
    list->at[list->count++] = 0.0;
    list->at[list->count++] = e;
    for (int i = 0; i <= panels; ++i)
        list->at[list->count++] = e + far * pow(2.0, octaves * ((double)i / panels - 1.0));
    for (int i = 0; i < s->sample->end_count; ++i)
        if (s->kink[i] > e)
            put_kink(list, s->kink[i]);
    return octaves < WIDEST * OUTER;
}

/* No gap outside adhesion is below h0, but on the way: there the law stays, since it may have a pole. */
static nt_pressure law_of(const nt_deform_solver *s, int node)
{
    if (node < N)
        return (nt_pressure){0.0, -s->sample->stress, 0.0};
    const int inside = s->gap[node] < s->sample->range;
    nt_pressure p = nt_deform_law(s, inside ? s->sample->range : s->gap[node]);
    p.pressure *= s->share;
    p.slope *= inside ? 0.0 : s->share;
    return p;
}

static void press(const nt_deform_solver *s, nt_deform_pressed *p)
{
    for (int j = 0; j < s->mesh.count; ++j) {
        const nt_pressure at = law_of(s, j);
        p->pressure[j] = at.pressure;
        p->slope[j] = at.slope;
    }
}

/* What is left of the equations: each gap, and the radius of contact or, `held`, the h that there is. */
static void residual(const nt_deform_solver *s, int held, const nt_deform_pressed *p, double *b)
{
    const nt_deform_mesh *m = &s->mesh;
    const int n = m->count;
    double slope;
    for (int i = 0; i < n; ++i)
        b[i] = s->h + 0.5 * (m->a * m->a + m->x[i]) / s->sample->radius + nt_deform_rim(s, s->h, m->x[i], &slope) +
               nt_deform_dot(m->K[i], p->pressure, n) - s->gap[i];
    b[n] = held ? 0.0 : s->h + m->a * m->a / s->sample->radius + nt_deform_dot(m->K0, p->pressure, n);
}

/* Their slopes, factored; 0 where that cannot be. */
static int factor(nt_deform_solver *s, int held, const nt_deform_pressed *p)
{
    const nt_deform_mesh *m = &s->mesh;
    const int n = m->count;
    for (int i = 0; i < n; ++i) {
        double slope;
        (void)nt_deform_rim(s, s->h, m->x[i], &slope);
        for (int j = 0; j < n; ++j)
            s->A[i][j] = (i == j) - m->K[i][j] * p->slope[j];
        s->A[i][n] = -1.0 - slope;
        s->A[n][i] = held ? 0.0 : -m->K0[i] * p->slope[i];
    }
    s->A[n][n] = -1.0;
    s->factored = nt_deform_factor(s, n + 1) ? n : 0;
    s->factored_held = held;
    return s->factored > 0;
}

static nt_deform_step newton_step(nt_deform_solver *s, int held, int fresh)
{
    const int n = s->mesh.count;
    const nt_deform_step none = {NAN, NAN};
    nt_deform_pressed p = {{0.0}, {0.0}};
    double b[NT_DEFORM_NODES + 1], ahead = 1.0, far = 0.0, near = 0.0, most = 0.0;
    press(s, &p);
    residual(s, held, &p, b);
    if (fresh && !factor(s, held, &p))
        return none;
    nt_deform_back(s, b, n + 1);
    for (int i = N; i < n; ++i) {
        near = s->gap[i] > 0.0 ? fmax(near, fabs(b[i]) / s->gap[i]) : (double)INFINITY;
        if (-b[i] > AHEAD * s->gap[i])
            ahead = fmin(ahead, AHEAD * s->gap[i] / -b[i]);
    }
    for (int i = 0; i < n; ++i) {
        s->gap[i] += ahead * b[i];
        far = fmax(far, fabs(s->gap[i]));
        most = fmax(most, fabs(b[i]));
    }
    s->h += ahead * b[n];
    return (nt_deform_step){most / (far + fabs(s->h)), near};
}

/* Slopes are found again only where the last step changed them much, or did not come much nearer: those of the mesh
 * before most often do. */
static nt_status newton(nt_deform_solver *s, int held)
{
    int fresh = s->factored != s->mesh.count || s->factored_held != held;
    double before = INFINITY;
    for (int i = 0; i < NEWTONS; ++i) {
        const nt_deform_step by = newton_step(s, held, fresh);
        if (!isfinite(by.far))
            return NT_E_NO_CONVERGENCE;
        if (by.far < SETTLED)
            return NT_OK;
        fresh = by.near > LITTLE || by.far > SLOW * before;
        before = by.far;
    }
    return NT_E_NO_CONVERGENCE;
}

/* The gap where adhesion ends. */
static double end_gap(const nt_deform_solver *s)
{
    const nt_deform_mesh *m = &s->mesh;
    double slope, g = s->h + 0.5 * (m->a * m->a + m->edges[1]) / s->sample->radius;
    g += nt_deform_rim(s, s->h, m->edges[1], &slope);
    for (int j = 0; j < m->count; ++j)
        g += m->K1[j] * law_of(s, j).pressure;
    return g;
}

/* The gap that is left where adhesion ends at e, over h0, less 1; NaN where there is no equilibrium. */
static double excess(nt_deform_solver *s, double a, double e, int held)
{
    nt_deform_edges list;
    if (!edges_of(s, a, e, &list) || !nt_deform_may_mesh(s))
        return NAN;
    nt_deform_move(s, list.at, list.count - 1, a);
    return newton(s, held) == NT_OK ? end_gap(s) / s->sample->range - 1.0 : (double)NAN;
}

/* Secants over ln e, from the last slope; most often two or three. */
static nt_status find_by_secants(nt_deform_solver *s, double a, double guess)
{
    double x = log(guess), f = excess(s, a, guess, 0);
    for (int i = 0; i < SECANTS && s->end_slope > 0.0; ++i) {
        if (fabs(f) < END) {
            s->end = exp(x);
            return NT_OK;
        }
        const double far = -f / s->end_slope, next = x + fmin(fmax(far, -LONGEST), LONGEST);
        const double there = excess(s, a, exp(next), 0);
        if (!(fabs(there) < fabs(f)))
            break;
        s->end_slope = (there - f) / (next - x);
        x = next;
        f = there;
    }
    s->end_slope = 0.0;
    return NT_E_NO_CONVERGENCE;
}

/* By false position (Illinois) over ln e, in a bracket. */
static nt_status find_in_bracket(nt_deform_solver *s, double a, double guess)
{
    double low = log(guess), high = low, spread = 0.05, f_low = excess(s, a, guess, 0), f_high = f_low;
    for (int i = 0; i < EDGES && f_low > 0.0; ++i, spread *= 2.0) {
        high = low;
        f_high = f_low;
        f_low = excess(s, a, exp(low -= spread), 0);
    }
    for (int i = 0; i < EDGES && f_high < 0.0; ++i, spread *= 2.0) {
        low = high;
        f_low = f_high;
        f_high = excess(s, a, exp(high += spread), 0);
    }
    for (int i = 0; i < EDGES && f_low <= 0.0 && f_high >= 0.0; ++i) {
        const double middle = f_high > f_low ? (low * f_high - high * f_low) / (f_high - f_low) : low;
        const double f = excess(s, a, exp(middle), 0);
        if (fabs(f) < END) {
            s->end = exp(middle);
            s->end_slope = fmax((f_high - f_low) / (high - low), 0.0);
            return NT_OK;
        }
        if (f > 0.0) {
            high = middle;
            f_high = f;
            f_low *= 0.5;
        } else {
            low = middle;
            f_low = f;
            f_high *= 0.5;
        }
    }
    return NT_E_NO_CONVERGENCE;
}

/* Puts the kinks of the law where they are now; whether one of them has moved. */
static int place_kinks(nt_deform_solver *s)
{
    const nt_deform_mesh *m = &s->mesh;
    int moved = 0;
    for (int i = 0; i < s->sample->end_count; ++i) {
        double low = m->edges[1], high = m->edges[m->panels];
        const double end = s->sample->ends[i];
        if (nt_deform_mesh_at(m, s->gap, low * (1.0 + 1e-9)) > end || nt_deform_mesh_at(m, s->gap, high) < end)
            continue;
        for (int k = 0; k < 50; ++k) {
            const double middle = 0.5 * (low + high);
            *(nt_deform_mesh_at(m, s->gap, middle) < end ? &low : &high) = middle;
        }
        moved |= fabs(high - s->kink[i]) > PLACED * high;
        s->kink[i] = high;
    }
    return moved;
}

nt_status nt_deform_settle_contact(nt_deform_solver *s, double a, double guess)
{
    nt_status status = NT_E_NO_CONVERGENCE;
    for (int i = 0; i < KINKS; ++i) {
        status = find_by_secants(s, a, i == 0 ? guess : s->end);
        if (status != NT_OK)
            status = find_in_bracket(s, a, i == 0 ? guess : s->end);
        if (status != NT_OK || !place_kinks(s))
            return status;
    }
    return status;
}

/* What was found. With U stationary in a and in where adhesion ends: F does not depend on a, and on e by
 * dF/de = -pi (sigma0 + p) dg/dh, g the gap there. */
int nt_deform_report_contact(nt_deform_solver *s, nt_deform_point *point)
{
    const nt_deform_mesh *m = &s->mesh;
    const int n = m->count;
    const double R = s->sample->radius, E = s->sample->modulus, a = m->a, h = s->h, e = m->edges[1];
    double y[NT_DEFORM_NODES + 1], slope, F, k, g_h;
    nt_deform_pressed p = {{0.0}, {0.0}};
    press(s, &p);
    for (int i = 0; i < n; ++i) {
        (void)nt_deform_rim(s, h, m->x[i], &slope);
        y[i] = 1.0 + slope;
    }
    y[n] = 0.0;
    if (!factor(s, 1, &p))
        return 0;
    nt_deform_back(s, y, n + 1);
    const nt_pressure outer = nt_deform_law(s, nt_deform_outer_gap(s));
    F = 2.0 * NT_PI * R * outer.energy + 2.0 * E * a * (-h - a * a / (3.0 * R));
    k = 2.0 * NT_PI * R * outer.pressure + 2.0 * E * a;
    (void)nt_deform_rim(s, h, e, &slope);
    g_h = 1.0 + slope;
    for (int j = 0; j < n; ++j) {
        F += m->load[j] * p.pressure[j];
        k -= m->load[j] * p.slope[j] * y[j];
        g_h += m->K1[j] * p.slope[j] * y[j];
    }
    const double stress = s->sample->stress + nt_deform_law(s, s->sample->range).pressure;
    *point = (nt_deform_point){h, F, k, 0.0, 0.0, a, 0.0};
    const double wider = excess(s, a, e * (1.0 + NUDGE), 1), narrower = excess(s, a, e * (1.0 - NUDGE), 1);
    point->k -= NT_PI * stress * g_h * g_h / ((wider - narrower) * s->sample->range / (2.0 * NUDGE * e));
    (void)excess(s, a, e, 1);
    return isfinite(point->F) && isfinite(point->k);
}

/* Adhesion alone, which is linear; then with more and more of the law. */
nt_status nt_deform_begin_contact(nt_deform_solver *s, const nt_deform_sample *sample, double a)
{
    nt_deform_edges list;
    s->sample = sample;
    s->reach = reach_of(sample);
    s->end = 2.0 * sample->radius * sample->range;
    s->h = -a * a / sample->radius;
    s->left = MOST_MESHES;
    s->factored = 0;
    s->share = s->end_slope = 0.0;
    s->mesh.a = a;
    for (int i = 0; i < NT_DEFORM_ENDS; ++i)
        s->kink[i] = 0.0;
    if (!edges_of(s, a, s->end, &list))
        return NT_E_NO_CONVERGENCE;
    s->mesh.panels = list.count - 1;
    memcpy(s->mesh.edges, list.at, (size_t)list.count * sizeof *list.at);
    nt_deform_mesh_make(&s->mesh, sample, s->A[0]);
    for (int i = 0; i < s->mesh.count; ++i)
        s->gap[i] = sample->range;
    nt_status status = nt_deform_settle_contact(s, a, s->end);
    for (double done = 0.0, width = 0.25; status == NT_OK && done < 1.0;) {
        const nt_deform_state before = nt_deform_keep(s);
        s->share = fmin(done + width, 1.0);
        status = nt_deform_settle_contact(s, a, s->end);
        if (status == NT_OK) {
            done = s->share;
            width *= 2.0;
        } else if ((width *= 0.4) > LEAST) {
            nt_deform_restore(s, &before);
            status = NT_OK;
        }
    }
    return status;
}

/* 2 pi R Int W from a gap on, of rigid bodies; Simpson over ln gap [J]. */
static double energy_beyond(const nt_deform_sample *sample, double gap)
{
    enum { STEPS_OUT = 400 };
    const double width = log(FARTHEST / gap) / STEPS_OUT;
    double sum = 0.0;
    for (int i = 0; i <= STEPS_OUT; ++i) {
        const double g = gap * exp(width * i), weight = i == 0 || i == STEPS_OUT ? 1.0 : i % 2 ? 4.0 : 2.0;
        sum += weight * sample->law(sample->context, g).energy * g;
    }
    return 2.0 * NT_PI * sample->radius * sum * width / 3.0;
}

double nt_deform_energy_in_contact(const nt_deform_solver *s)
{
    const nt_deform_mesh *m = &s->mesh;
    const double a = m->a, R = s->sample->radius, E = s->sample->modulus, d = -s->h;
    const double held = nt_deform_law(s, s->sample->range).energy, adhesion = s->sample->stress;
    double U = E * a * (d * d + a * a / R * (-2.0 / 3.0 * d + 0.2 * a * a / R));
    U += NT_PI * a * a * (held - adhesion * s->sample->range);
    for (int i = 0; i < m->count; ++i) {
        double u = 0.0;
        for (int j = 0; j < m->count; ++j)
            u += m->K[i][j] * law_of(s, j).pressure;
        U += 0.5 * m->area[i] * law_of(s, i).pressure * u;
        U += m->area[i] *
             (i < N ? held - adhesion * (s->sample->range - s->gap[i]) : nt_deform_law(s, s->gap[i]).energy);
    }
    return U + energy_beyond(s->sample, nt_deform_outer_gap(s));
}
