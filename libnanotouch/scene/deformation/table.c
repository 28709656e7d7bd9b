/* SPDX-License-Identifier: BSD-3-Clause
 * The force of a sample that deforms as cubics, each as long as the tolerance lets it be; U is their integral.
 *
 * Apart the cubics are in h; in contact in sqrt(h_touch - h), for F - F_touch begins with terms in h and h^(3/2);
 * before a jump, where F - F_jump begins with a square root, in sqrt(h - h_jump). v grows inwards. */
#include <math.h>

#include "scene/deformation/cubic.h"
#include "scene/deformation/march.h"

#define FIRST_STEP 0.5 /* of the length over which the law falls */
#define FIRST_RIM 0.05 /* of sqrt(2 R l): the first radius of contact */
#define MESH 0.1       /* of the tolerance: what a panel must resolve, which is far more than the error of its force */
#define SHORTER 0.8    /* steps of the centre gap, over the pole, on the way to a jump */
#define BEFORE_JUMP 1e-4 /* of that gap: the table ends so much before it */
#define STILL 1e-8       /* dh/d(centre) in a jump */
#define TOUCHING 1e-4    /* of the length over which the law falls: a surface that bulges so far touches the tip */
#define SMALLEST 1e-7    /* of the first step */
#define RISES 2.0        /* d(centre)/dh: the gap under the apex closes so much faster than the bodies approach */
#define STEEP 30.0       /* the same, where nothing pulls yet */
#define JUMPS 3.0        /* times the pull at the jump: what a panel resolves, a tolerance of */
#define NEARER 0.3       /* of a step that is too long for the solver: the next */
#define WIDER 4.0        /* of the first radius of contact: the next */
#define PEAKS 0.01       /* of the largest pressure on a layer, which nodes have to tell between them */
#define KEPT 0.6         /* of the gap under the apex, from point to point */

enum { NARROWINGS = 40, FAILURES = 5, WIDENINGS = 2 };

typedef nt_deform_maker maker;

static nt_deform_node node_of(const maker *m, int part, const nt_deform_point *point)
{
    const double v = v_of(m->table, part, point->h);
    return (nt_deform_node){v, point->F, point->k * metric(part, v), point->k, 0.0, point->a, point->peak};
}

static double held(const maker *m, const nt_deform_point *point)
{
    return m->hold == NT_DEFORM_GAP ? point->h : m->hold == NT_DEFORM_CENTRE ? point->centre : point->a;
}

static double over(double error, double value, double scale)
{
    return fabs(error) / fmax(fabs(value), scale);
}

/* How far the cubic between two nodes is from a point between them, in the norm of the range. */
static double distance(const maker *m, const nt_deform_node ends[2], int part, const nt_deform_point *between)
{
    const nt_deform_range *range = m->range;
    double c[4];
    cubic(&ends[0], &ends[1], c);
    const double v = v_of(m->table, part, between->h), t = v - ends[0].v;
    double error = over(force_at(c, t) - between->F, between->F, range->scale);
    if (range->stiffness) /* largest beside the middle, where a cubic's slope is best */
        error = fmax(error, 4.0 * over((force_at(c, t) - between->F) / (metric(part, v) * t), between->k,
                                       range->stiffness_scale));
    if (range->radius_scale > 0.0) {
        const double share = t / (ends[1].v - ends[0].v), a = ends[0].a + share * (ends[1].a - ends[0].a);
        error = fmax(error, over(a - between->a, between->a, range->radius_scale));
    }
    const double peak = range->attracts ? (double)NAN : nt_deform_peak_between(ends, between->F);
    if (m->table->layered && between->peak > 0.0 && !isnan(peak))
        error = fmax(error, range->tolerance * fabs(peak / between->peak - 1.0) / PEAKS);
    return error;
}

static nt_status add(maker *m, nt_deform_node node)
{
    if (m->table->count >= NT_DEFORM_TABLE)
        return NT_E_CAPACITY;
    m->table->node[m->table->count++] = node;
    return NT_OK;
}

static int is_done(const maker *m)
{
    const int pressed = m->last.F >= m->range->load && !(m->range->touches && m->hold != NT_DEFORM_CONTACT);
    return pressed || m->last.h <= m->range->nearest;
}

/* Whether a step passes over much of the gap under the apex: a law of short range could hide there, or a narrow part of
 * one's own. */
static int leaps(const maker *m, const nt_deform_point *next)
{
    const nt_deform_sample *sample = m->solver.sample;
    const double centre = m->last.centre;
    if (m->hold == NT_DEFORM_CONTACT)
        return 0;
    if (sample->reach && next->centre < sample->reach(sample->context, centre))
        return 1;
    return centre > -sample->pole && next->centre < KEPT * centre;
}

/* Where the solver came to no end, it stands close to a fold if the gap under the apex changes much faster there than
 * the bodies approach: no finer table passes it, held at the gap of the bodies. */
static int folds_ahead(maker *m)
{
    nt_deform_point near;
    if (m->hold != NT_DEFORM_GAP)
        return 0;
    if (m->last.k < 0.0 && m->last.slope > RISES)
        return 1;
    const nt_status status = nt_deform_go(&m->solver, m->hold, m->solver.h, &near);
    return status == NT_OK && fabs(near.slope) > STEEP;
}

/* Whether the gap under the apex closes ever faster than the bodies approach before they touch: that is a jump. Held at
 * that gap, the solver passes either. */
static int jumps_first(maker *m)
{
    static const double left[] = {0.6, 0.3, 0.1, 0.0, 1.0}; /* of that gap; and back */
    nt_deform_point point = m->last;
    for (size_t i = 0; i < sizeof left / sizeof *left; ++i)
        if (nt_deform_go(&m->solver, NT_DEFORM_CENTRE, left[i] * m->last.centre, &point) != NT_OK ||
            !(point.slope > 0.0))
            return 1;
    return 0;
}

/* Goes on by the gap under the apex, to where the bodies touch. */
static nt_status march_to_touch(maker *m, int part, double step)
{
    m->hold = NT_DEFORM_CENTRE;
    m->end = 0.0;
    --m->table->count;
    return nt_deform_march(m, part, step);
}

/* Point after point until what is held is at its end, or the range is. */
nt_status nt_deform_march(maker *m, int part, double step)
{
    const double direction = m->hold == NT_DEFORM_CONTACT ? 1.0 : -1.0, least = SMALLEST * step;
    nt_status status = add(m, node_of(m, part, &m->last));
    int failed = 0;
    while (status == NT_OK && !is_done(m)) {
        const double from = held(m, &m->last), left = direction * (m->end - from);
        if (left < least)
            return NT_OK;
        const double to =
            step > 0.7 * left ? (step >= left ? m->end : from + 0.5 * (m->end - from)) : from + direction * step;
        nt_deform_point between = {0}, next = {0};
        status = nt_deform_go(&m->solver, m->hold, 0.5 * (from + to), &between);
        if (status == NT_OK)
            status = nt_deform_go(&m->solver, m->hold, to, &next);
        if (status != NT_OK) { /* too far, as through where the bodies touch; a rim that no mesh resolves */
            const int narrow = m->hold == NT_DEFORM_CONTACT && from == 0.0 && failed < WIDENINGS;
            step = (narrow ? WIDER : NEARER) * fabs(to - from);
            if (folds_ahead(m))
                return m->range->attracts || jumps_first(m) ? NT_E_NO_SOLUTION
                                                            : march_to_touch(m, part, FIRST_STEP * m->last.centre);
            if (step < least || ++failed > FAILURES)
                return status;
            status = NT_OK;
            continue;
        }
        if (leaps(m, &next)) {
            step = 0.5 * fabs(to - from);
            if (step < least)
                return NT_E_NO_CONVERGENCE;
            continue;
        }
        if (m->hold == NT_DEFORM_GAP && !m->range->attracts &&
            (next.centre <= 0.0 || between.centre <= 0.0)) /* the bodies touch */
            return march_to_touch(m, part, m->last.centre);
        const nt_deform_node ends[2] = {m->table->node[m->table->count - 1], node_of(m, part, &next)};
        if (!(ends[1].v > ends[0].v)) /* back through a fold */
            return NT_E_NO_CONVERGENCE;
        const double error = distance(m, ends, part, &between) / m->range->tolerance;
        const double factor = fmin(fmax(0.9 * pow(fmax(error, 1e-9), -0.25), 0.25), 2.5);
        step = fabs(to - from) * factor;
        if (step < least)
            return NT_E_NO_CONVERGENCE;
        if (error > 1.0)
            continue;
        m->last = next;
        failed = 0;
        status = add(m, ends[1]);
    }
    return status;
}

/* No jump, but contact takes hold where this gap is left under the apex. */
static nt_status end_at(maker *m, double centre)
{
    const double pole = m->solver.sample->pole;
    nt_deform_point point;
    const nt_status status = nt_deform_go(&m->solver, NT_DEFORM_CENTRE, centre, &point);
    m->table->jumps = 1;
    m->table->touch = point.h;
    m->pull = fmax(fabs(point.F), fabs(point.k) * (centre - pole)); /* of laws that cancel, too */
    m->hold = NT_DEFORM_CENTRE;
    m->end = centre + BEFORE_JUMP * (centre - pole);
    return status;
}

/* No jump: the table ends at the nearest h, or at a gap under the apex. */
static nt_status end_at_centre(maker *m)
{
    return m->range->centre > 0.0 ? end_at(m, m->range->centre) : NT_OK;
}

/* dh/d(centre), which passes through 0 in a jump. */
static double rise_of(const nt_deform_point *point)
{
    return point->slope != 0.0 ? 1.0 / point->slope : -1.0;
}

/* Between a point before the jump and one behind it, which becomes that of the jump: by false position (Illinois). */
static nt_status narrow_jump(maker *m, const nt_deform_point *before, nt_deform_point *behind)
{
    double high = before->centre, low = behind->centre, f_high = rise_of(before), f_low = rise_of(behind);
    for (int i = 0; i < NARROWINGS && f_high > 0.0; ++i) {
        const double middle = (low * f_high - high * f_low) / (f_high - f_low);
        const nt_status status = nt_deform_go(&m->solver, NT_DEFORM_CENTRE, middle, behind);
        const double f = rise_of(behind);
        if (status != NT_OK)
            return status;
        if (fabs(f) < STILL)
            break;
        *(f > 0.0 ? &high : &low) = middle;
        f_high = f > 0.0 ? f : 0.5 * f_high;
        f_low = f > 0.0 ? 0.5 * f_low : f;
    }
    return NT_OK;
}

/* Where the surface jumps: the smallest h over the gap under the apex, which falls all the way. Without a jump before
 * the nearest h the table ends there. */
static nt_status find_jump(maker *m)
{
    const double pole = m->solver.sample->pole;
    nt_deform_point point = m->last, before = point;
    double low = point.centre;
    nt_status status = NT_OK;
    while (point.slope > 0.0) {
        if (m->range->centre > 0.0 ? point.centre <= m->range->centre : point.h <= m->range->nearest)
            return end_at_centre(m);
        before = point;
        low = pole + SHORTER * (low - pole);
        if (low - pole < TOUCHING * m->solver.sample->length)
            return end_at(m, low);
        status = nt_deform_go(&m->solver, NT_DEFORM_CENTRE, low, &point);
        if (status != NT_OK)
            return status;
    }
    status = narrow_jump(m, &before, &point);
    if (status != NT_OK)
        return status;
    if (m->range->centre > 0.0 ? point.centre <= m->range->centre : point.h <= m->range->nearest)
        return end_at_centre(m);
    m->table->jumps = 1;
    m->table->touch = point.h;
    m->pull = fabs(point.F);
    m->hold = NT_DEFORM_CENTRE;
    m->end = point.centre + BEFORE_JUMP * (point.centre - pole);
    return NT_OK;
}

static nt_status begin(maker *m)
{
    const nt_status status = nt_deform_begin(&m->solver, m->solver.sample, m->range->farthest);
    return status == NT_OK ? nt_deform_go(&m->solver, NT_DEFORM_GAP, m->range->farthest, &m->last) : status;
}

/* Where the pull at the jump is small beside the scale, by a mesh that resolves it: the place of the jump is known to
 * the tolerance, too. */
static nt_status find_jump_again(maker *m)
{
    m->solver.scale = JUMPS * m->pull;
    m->table->jumps = 0;
    const nt_status status = begin(m);
    return status == NT_OK ? find_jump(m) : status;
}

static nt_status make_apart(maker *m, double length)
{
    nt_status status = begin(m);
    m->hold = NT_DEFORM_GAP;
    m->end = m->range->nearest;
    double step = FIRST_STEP * length;
    if (m->range->attracts && status == NT_OK) {
        status = find_jump(m);
        if (status == NT_OK && m->table->jumps && JUMPS * m->pull < m->solver.scale)
            status = find_jump_again(m);
        if (status == NT_OK)
            status = begin(m);
        if (m->table->jumps)
            step = FIRST_STEP * (1.0 - SHORTER) * (m->last.centre - m->solver.sample->pole);
    }
    if (status == NT_OK)
        status = nt_deform_march(m, m->table->jumps ? -1 : 0, step);
    return status;
}

/* U of each node; of a contact that holds it begins with `energy`. */
void nt_deform_integrate(nt_deform_table *table, double energy)
{
    for (int i = 0; i < table->count; ++i) {
        const int part = part_of(table, i);
        double c[4];
        if (i == 0 || i == table->apart) {
            table->node[i].U = table->holds && i == table->apart ? energy : i == 0 ? 0.0 : table->node[i - 1].U;
            continue;
        }
        cubic(&table->node[i - 1], &table->node[i], c);
        table->node[i].U =
            table->node[i - 1].U + work(c, part, table->node[i - 1].v, table->node[i].v - table->node[i - 1].v);
    }
}

nt_status nt_deform_table_make(nt_deform_table *table, const nt_deform_sample *sample, const nt_deform_range *range)
{
    static const nt_deform_table empty = {0};
    maker m = {.pull = INFINITY};
    m.table = table;
    m.range = range;
    m.solver.sample = sample;
    m.solver.tolerance = MESH * range->tolerance * (range->stiffness ? NT_DEFORM_STIFFER : 1.0);
    m.solver.scale = range->scale;
    m.solver.work = range->work;
    *table = empty;
    table->touch = -INFINITY;
    table->layered = sample->thickness > 0.0;
    nt_status status = make_apart(&m, sample->length);
    table->apart = table->count;
    if (status == NT_OK && !table->jumps)
        table->touch = range->attracts ? m.last.h : m.hold == NT_DEFORM_CENTRE ? m.last.h : (double)-INFINITY;
    if (status == NT_OK && !range->attracts && m.hold == NT_DEFORM_CENTRE && !is_done(&m)) {
        m.hold = NT_DEFORM_CONTACT;
        m.end = INFINITY;
        m.last.a = 0.0;
        status = nt_deform_march(&m, 1, FIRST_RIM * sqrt(2.0 * sample->radius * sample->length));
    }
    table->first = range->farthest;
    table->last = m.last.h;
    nt_deform_integrate(table, 0.0);
    return status;
}
