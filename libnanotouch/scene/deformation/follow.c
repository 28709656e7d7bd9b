/* SPDX-License-Identifier: BSD-3-Clause
 * The mesh of a sample that deforms follows the pressure: panels are cut where pressure or gap are not resolved, edges
 * are put where a law has a kink, and what is finer than it need be is joined. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "scene/deformation/deform.h"

enum { N = NT_DEFORM_ORDER };

#define BENT 1e-3      /* last coefficients of the gap over the gap */
#define LEFT_OVER 20.0 /* of the tolerance: the force beyond the mesh, which counts as that of rigid bodies */
#define CLOSE 0.35     /* of a panel: an edge so close to a kink is moved there */
#define FURTHER 3.0    /* the mesh grows by */
#define WIDEST 4.0     /* of R^2: the mesh ends there */
#define FINE 2e-3      /* of what a panel must resolve: it can be twice as wide */
#define UNFELT 1.0     /* of what a panel must resolve: what the place of a kink may do to the force */
#define UNEVEN 8.0     /* times how far the middle gap is off: what an uneven gap does to the force, no more */
#define LITTLE 0.03    /* of the energy of a panel */
#define ROUNDING 1e-12 /* of x: inside a panel, not on its edge */
#define PLACED 2e-4    /* of x: nearer to a kink no edge has to be */
#define GRADED 4.0     /* times x: the edge after a kink */
#define BEFORE 1e-9    /* of the gap of a kink: where the law is still that before it */

/* The length over which the law falls at a gap [m]. */
static double length_at(const nt_deform_solver *s, double gap)
{
    const nt_pressure p = nt_deform_law(s, gap);
    const double length = fabs(p.energy / p.pressure);
    return isfinite(length) && length > 0.0 ? length : 1e-9;
}

/* The gaps on another mesh: what lifts them off the undeformed one is smooth. */
void nt_deform_move(nt_deform_solver *s, const double *edges, int panels, double a)
{
    nt_deform_mesh *m = &s->mesh;
    const double R2 = 2.0 * s->sample->radius, a2 = m->a * m->a;
    const nt_deform_mesh *old = m;
    double lift[NT_DEFORM_NODES], moved[NT_DEFORM_NODES], x[NT_DEFORM_NODES];
    const int same = panels == m->panels && memcmp(edges, m->edges, (size_t)(panels + 1) * sizeof *edges) == 0;
    if (same && a == m->a)
        return;
    for (int i = 0; i < m->count; ++i)
        lift[i] = s->gap[i] - s->h - (a2 + m->x[i]) / R2;
    /* the nodes of the new mesh lie as those of the old one within their panels */
    for (int i = 0; i < panels * N; ++i) {
        const double at = (m->x[i % N] - m->edges[0]) / (m->edges[1] - m->edges[0]);
        x[i] = edges[i / N] + (edges[i / N + 1] - edges[i / N]) * at;
        moved[i] = s->h + (a * a + x[i]) / R2 + nt_deform_mesh_at(old, lift, x[i] + a * a - a2);
    }
    memcpy(m->edges, edges, (size_t)(panels + 1) * sizeof *edges);
    m->panels = panels;
    m->a = a;
    nt_deform_mesh_make(m, s->sample, s->A[0]);
    memcpy(s->gap, moved, (size_t)m->count * sizeof *moved);
}

/* At the nodes; of their size all that is pressed, or the scale [N]. */
static double pressures(const nt_deform_solver *s, double *p)
{
    double all = 0.0;
    for (int i = 0; i < s->mesh.count; ++i) {
        p[i] = nt_deform_law(s, s->gap[i]).pressure;
        all += fabs(p[i]) * s->mesh.area[i];
    }
    return fmax(all, s->scale);
}

/* Per panel, in what is tolerated: the last coefficients of pressure and gap. */
static double roughness(const nt_deform_solver *s, int panel, const double *p, double all)
{
    const nt_deform_mesh *m = &s->mesh;
    double least = INFINITY;
    for (int i = panel * N; i < (panel + 1) * N; ++i)
        least = fmin(least, s->gap[i]);
    const double width = m->edges[panel + 1] - m->edges[panel];
    const double tail = nt_deform_mesh_tail(m, p, panel) * NT_PI * width / all;
    const double bent = nt_deform_mesh_tail(m, s->gap, panel) / fmax(least, length_at(s, 0.0));
    return fmax(tail / s->tolerance, bent / BENT);
}

/* The x at which the gap is `end`, in a panel; NaN if it is not there. */
static double crossing(const nt_deform_solver *s, int panel, double end)
{
    const nt_deform_mesh *m = &s->mesh;
    double low = m->edges[panel], high = m->edges[panel + 1];
    if (!(nt_deform_mesh_at(m, s->gap, low * (1.0 + 1e-12)) < end && nt_deform_mesh_at(m, s->gap, high) >= end))
        return NAN;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        if (nt_deform_mesh_at(m, s->gap, middle) < end)
            low = middle;
        else
            high = middle;
    }
    return high;
}

/* A list that is full is longer than any mesh, and refused as such. */
static void insert(nt_deform_edges *list, double x)
{
    if (list->count == (int)(sizeof list->at / sizeof *list->at))
        return;
    int i = list->count++;
    for (; i > 0 && list->at[i - 1] > x; --i)
        list->at[i] = list->at[i - 1];
    list->at[i] = x;
}

/* How near to a kink at x its edge has to be: an edge off by dx has the law's change of slope over dx/(2 R) of gap, on
 * the ring pi dx. Neighbours far wider than x do not know it nearer where a pressure only begins. */
static double near_kink(const nt_deform_solver *s, double end, double x, double all)
{
    const double unfelt = UNFELT * s->tolerance * all / NT_PI, R = s->sample->radius;
    const nt_pressure before = nt_deform_law(s, end * (1.0 - BEFORE)), after = nt_deform_law(s, end * (1.0 + BEFORE));
    const double bend = fabs(before.slope - after.slope), jump = fabs(before.pressure - after.pressure);
    const double by_slope = sqrt(4.0 * R * unfelt / fmax(bend, DBL_MIN)), by_jump = unfelt / fmax(jump, DBL_MIN);
    return fmax(PLACED * x, fmin(x, fmin(by_slope, by_jump)));
}

/* Where the panels on both sides of an edge see the kink at places that are farther apart, the edge goes back and forth
 * between them: the wider one is cut, near the edge if it is far wider than x. */
static void part(const nt_deform_solver *s, nt_deform_edges *list, int edge, double near)
{
    const nt_deform_mesh *m = &s->mesh;
    const double at = m->edges[edge], before = at - m->edges[edge - 1], after = m->edges[edge + 1] - at;
    const double left = nt_deform_mesh_at(m, s->gap, at * (1.0 - 1e-12)),
                 right = nt_deform_mesh_at(m, s->gap, at * (1.0 + 1e-12));
    if (fabs(right - left) * 2.0 * s->sample->radius > near)
        insert(list, after > before ? fmin(at + 0.5 * after, GRADED * at) : at - 0.5 * before);
}

/* An edge at a kink of the law: the one that was there for it before is moved, else there is one more. */
static int place_kink(const nt_deform_solver *s, nt_deform_edges *list, int panel, double x, double near)
{
    const double width = s->mesh.edges[panel + 1] - s->mesh.edges[panel];
    int nearest = 1;
    for (int i = 1; i < list->count; ++i)
        if (fabs(list->at[i] - x) < fabs(list->at[nearest] - x))
            nearest = i;
    if (fabs(list->at[nearest] - x) < near)
        return 0;
    if (fabs(list->at[nearest] - x) < CLOSE * width) {
        --list->count;
        for (int i = nearest; i < list->count; ++i)
            list->at[i] = list->at[i + 1];
    }
    insert(list, x);
    return 1;
}

/* A panel on which the gap grows evenly presses what the energies at its ends tell. */
typedef struct evenly {
    double E, per_energy; /* energy at its start [J/m^2], force per energy [m^2] */
} evenly;

/* What the pressure at the nodes of a panel leaves out of that, up to a share of the panel [N]. */
static double left_out(const nt_deform_solver *s, int panel, const double *p, const evenly *by, double share)
{
    const nt_deform_mesh *m = &s->mesh;
    const double low = m->edges[panel], x = low + share * (m->edges[panel + 1] - low);
    double seen = 0.0;
    for (int i = panel * N; i < (panel + 1) * N; ++i) {
        const double there = share < 1.0 ? nt_deform_mesh_at(m, p, low + share * (m->x[i] - low)) : p[i];
        seen += share * m->area[i] * there;
    }
    return (by->E - nt_deform_law(s, nt_deform_mesh_at(m, s->gap, x)).energy) * by->per_energy - seen;
}

/* A law so short that no node of a panel sees it: what is left out, in what is tolerated, and the x that cuts the panel
 * nearest to that law. 0 where no more is left out than an uneven gap explains, and where the bodies overlap: such a
 * gap only tells that they touch before. */
static double unseen(const nt_deform_solver *s, int panel, const double *p, double all, double *cut)
{
    const nt_deform_mesh *m = &s->mesh;
    const double low = m->edges[panel], high = m->edges[panel + 1], middle = 0.5 * (low + high);
    const double near = nt_deform_mesh_at(m, s->gap, low + ROUNDING * high), far = nt_deform_mesh_at(m, s->gap, high);
    if (!(near >= 0.0 && far > near))
        return 0.0;
    const evenly by = {nt_deform_law(s, near).energy, NT_PI * (high - low) / (far - near)};
    const double pressed = (by.E - nt_deform_law(s, far).energy) * by.per_energy, out = left_out(s, panel, p, &by, 1.0);
    if (!(fabs(out) > s->tolerance * all))
        return 0.0;
    const double uneven = fabs(nt_deform_mesh_at(m, s->gap, middle) - 0.5 * (near + far)) / (far - near);
    if (!(fabs(out) > UNEVEN * uneven * fabs(pressed) + s->tolerance * all))
        return 0.0;
    const int inner = fabs(left_out(s, panel, p, &by, 0.5)) > 0.5 * fabs(out);
    double from = inner ? 0.0 : 0.5, to = inner ? 0.5 : 1.0; /* nearly all of it lies on one side */
    for (int i = 0; i < 50; ++i) {
        const double share = 0.5 * (from + to), before = left_out(s, panel, p, &by, share) / out;
        *(before < (inner ? 1.0 - LITTLE : LITTLE) ? &from : &to) = share;
    }
    *cut = low + to * (high - low);
    return fabs(out) / (s->tolerance * all);
}

/* Cuts what is not resolved, puts edges at kinks, goes further out where force is left; whether anything changed. */
int nt_deform_refine(nt_deform_solver *s, nt_deform_edges *list)
{
    const nt_deform_mesh *m = &s->mesh;
    double p[NT_DEFORM_NODES];
    int changed = 0;
    list->count = m->panels + 1;
    memcpy(list->at, m->edges, (size_t)list->count * sizeof *m->edges);
    const double all = pressures(s, p);
    s->rough = 0.0;
    for (int panel = 0; panel < m->panels && all > 0.0; ++panel) {
        int kinked = 0;
        for (int i = 0; i < s->sample->end_count; ++i) {
            const double end = s->sample->ends[i], x = crossing(s, panel, end);
            if (isnan(x))
                continue;
            const double near = near_kink(s, end, x, all);
            const int placed = place_kink(s, list, panel, x, near);
            const int edge = panel + (x > 0.5 * (m->edges[panel] + m->edges[panel + 1]));
            if (placed && s->graded && edge > 0 && edge < m->panels)
                part(s, list, edge, near);
            kinked |= placed;
        }
        double rough = roughness(s, panel, p, all);
        double cut = 0.5 * (m->edges[panel] + m->edges[panel + 1]);
        changed |= kinked;
        if (!kinked && rough <= 1.0)
            rough = unseen(s, panel, p, all, &cut);
        if (kinked || rough <= 1.0)
            continue;
        s->rough = fmax(s->rough, rough);
        insert(list, cut);
        changed = 1;
    }
    const double R = s->sample->radius, last = m->edges[m->panels];
    const double outer = fabs(nt_deform_law(s, nt_deform_outer_gap(s)).energy) * 2.0 * NT_PI * R;
    if (outer > LEFT_OVER * s->tolerance * all && last < WIDEST * R * R) {
        insert(list, FURTHER * last);
        s->rough = fmax(s->rough, outer / (LEFT_OVER * s->tolerance * all));
        changed = 1;
    }
    return changed;
}

/* Drops every second edge between panels that are far finer than they need to be; whether there were any. */
int nt_deform_coarsen(nt_deform_solver *s)
{
    const nt_deform_mesh *m = &s->mesh;
    double p[NT_DEFORM_NODES], edges[NT_DEFORM_PANELS + 1];
    int count = 0, dropped = 0;
    const double all = pressures(s, p);
    edges[count++] = 0.0;
    for (int panel = 0; panel < m->panels; ++panel) {
        const int inner = panel + 1 < m->panels && !dropped && all > 0.0;
        dropped = inner && roughness(s, panel, p, all) < FINE && roughness(s, panel + 1, p, all) < FINE;
        if (!dropped)
            edges[count++] = m->edges[panel + 1];
    }
    const int fewer = count - 1 < m->panels;
    nt_deform_move(s, edges, count - 1, m->a);
    return fewer;
}
