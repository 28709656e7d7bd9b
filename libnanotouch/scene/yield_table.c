/* SPDX-License-Identifier: BSD-3-Clause
 * The force of a sample that yields as cubics, each as long as the tolerance lets it be; U is their integral.
 *
 * Apart the cubics are in h; in contact in sqrt(h_touch - h), for F - F_touch begins with terms in h and h^(3/2);
 * before a jump, where F - F_jump begins with a square root, in sqrt(h - h_jump). v grows inwards. */
#include <math.h>

#include "scene/yield.h"

#define FIRST_STEP 0.5 /* of the length over which the law falls */
#define FIRST_RIM 0.05 /* of sqrt(2 R l): the first radius of contact */
#define MESH 0.1       /* of the tolerance: what a panel must resolve, which is far more than the error of its force */
#define SHORTER 0.8    /* steps of the centre gap, over the pole, on the way to a jump */
#define BEFORE_JUMP 1e-4 /* of that gap: the table ends so much before it */
#define SMALLEST 1e-7    /* of the first step */
#define KEPT 0.6         /* of the gap under the apex, from point to point */

/* The cubic of a cell at t = v - v0, and its slope. */
static void cubic(const nt_yield_node *from, const nt_yield_node *to, double c[4])
{
    const double w = to->v - from->v, rise = (to->F - from->F) / w;
    c[0] = from->F;
    c[1] = from->slope;
    c[2] = (3.0 * rise - 2.0 * from->slope - to->slope) / w;
    c[3] = (from->slope + to->slope - 2.0 * rise) / (w * w);
}

static double force_at(const double c[4], double t)
{
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

static double slope_at(const double c[4], double t)
{
    return c[1] + t * (2.0 * c[2] + 3.0 * t * c[3]);
}

/* Whether v is a square root in the part of a node: -1 before a jump, 1 in contact, 0: v = -h. */
static int part_of(const nt_yield_table *table, int node)
{
    return node >= table->apart ? 1 : table->jumps ? -1 : 0;
}

static double v_of(const nt_yield_table *table, int part, double h)
{
    return part == 0 ? -h : part > 0 ? sqrt(fmax(table->touch - h, 0.0)) : -sqrt(fmax(h - table->touch, 0.0));
}

/* -dh/dv */
static double metric(int part, double v)
{
    return part == 0 ? 1.0 : 2.0 * fabs(v);
}

/* U from v0 to v0 + t: Int F (-dh/dv) dv. */
static double work(const double c[4], int part, double v0, double t)
{
    double sum = 0.0, power = t;
    for (int i = 0; i < 4; ++i) {
        sum += c[i] * (part == 0 ? power / (i + 1.0) : 2.0 * part * (v0 * power / (i + 1.0) + power * t / (i + 2.0)));
        power *= t;
    }
    return sum;
}

nt_law_value nt_yield_table_eval(const nt_yield_table *table, double h)
{
    const nt_yield_node *node = table->node;
    const int contact = h < table->touch && table->apart < table->count;
    int low = contact ? table->apart : 0, high = contact ? table->count - 1 : table->apart - 1;
    const int part = part_of(table, low);
    const double v = v_of(table, part, h), past = v - node[high].v;
    if (past >= 0.0) { /* deeper than the table: with its last slope */
        const double F = node[high].F, k = node[high].k, d = high == table->count - 1 ? table->last - h : 0.0;
        return (nt_law_value){node[high].U + d * (F + 0.5 * k * d), F + k * d, k, node[high].a};
    }
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (v < node[middle].v)
            high = middle;
        else
            low = middle;
    }
    double c[4];
    cubic(&node[low], &node[high], c);
    const double t = v - node[low].v, m = metric(part, v);
    const double k = m > 0.0 ? slope_at(c, t) / m : node[low].k;
    const double share = t / (node[high].v - node[low].v);
    return (nt_law_value){node[low].U + work(c, part, node[low].v, t), force_at(c, t), k,
                          node[low].a + share * (node[high].a - node[low].a)};
}

/* --- Making it --- */

typedef struct maker {
    nt_yield_table *table;
    nt_yield_solver solver;
    const nt_yield_range *range;
    nt_yield_hold hold;
    double end; /* of what is held */
    nt_yield_point last;
} maker;

static nt_yield_node node_of(const nt_yield_table *table, int part, const nt_yield_point *point)
{
    const double v = v_of(table, part, point->h);
    return (nt_yield_node){v, point->F, point->k * metric(part, v), point->k, 0.0, point->a};
}

static double held(const maker *m, const nt_yield_point *point)
{
    return m->hold == NT_YIELD_GAP ? point->h : m->hold == NT_YIELD_CENTRE ? point->centre : point->a;
}

static double over(double error, double value, double scale)
{
    return fabs(error) / fmax(fabs(value), scale);
}

/* How far the cubic between two nodes is from a point between them, in the norm of the range. */
static double distance(const maker *m, const nt_yield_node ends[2], int part, const nt_yield_point *between)
{
    const nt_yield_range *range = m->range;
    double c[4];
    cubic(&ends[0], &ends[1], c);
    const double v = v_of(m->table, part, between->h), t = v - ends[0].v;
    double error = over(force_at(c, t) - between->F, between->F, range->scale);
    if (range->stiffness) /* largest beside the middle, where a cubic's slope is best */
        error = fmax(error, 4.0 * over((force_at(c, t) - between->F) / (metric(part, v) * t), between->k,
                                       range->stiffness_scale));
    return error;
}

static nt_status add(maker *m, nt_yield_node node)
{
    if (m->table->count >= NT_YIELD_TABLE)
        return NT_E_NO_CONVERGENCE;
    m->table->node[m->table->count++] = node;
    return NT_OK;
}

static int is_done(const maker *m)
{
    return m->last.F >= m->range->load || m->last.h <= m->range->nearest;
}

/* Whether a step passes over much of the gap under the apex: a law of short range could hide there. */
static int leaps(const maker *m, const nt_yield_point *next)
{
    const double centre = m->last.centre;
    return m->hold != NT_YIELD_CONTACT && centre > -m->solver.sample->pole && next->centre < KEPT * centre;
}

/* Point after point until what is held is at its end, or the range is. */
static nt_status march(maker *m, int part, double step)
{
    const double direction = m->hold == NT_YIELD_CONTACT ? 1.0 : -1.0, least = SMALLEST * step;
    nt_status status = add(m, node_of(m->table, part, &m->last));
    while (status == NT_OK && !is_done(m)) {
        const double from = held(m, &m->last), left = direction * (m->end - from);
        if (left < least)
            return NT_OK;
        const double to =
            step > 0.7 * left ? (step >= left ? m->end : from + 0.5 * (m->end - from)) : from + direction * step;
        nt_yield_point between = {0}, next = {0};
        status = nt_yield_go(&m->solver, m->hold, 0.5 * (from + to), &between);
        if (status == NT_OK)
            status = nt_yield_go(&m->solver, m->hold, to, &next);
        if (status != NT_OK)
            return status;
        if (leaps(m, &next)) {
            step = 0.5 * fabs(to - from);
            if (step < least)
                return NT_E_NO_CONVERGENCE;
            continue;
        }
        if (m->hold == NT_YIELD_GAP && !m->range->attracts &&
            (next.centre <= 0.0 || between.centre <= 0.0)) { /* the bodies touch */
            m->hold = NT_YIELD_CENTRE;
            m->end = 0.0;
            step = m->last.centre;
            --m->table->count;
            return march(m, part, step);
        }
        const nt_yield_node ends[2] = {m->table->node[m->table->count - 1], node_of(m->table, part, &next)};
        const double error = distance(m, ends, part, &between) / m->range->tolerance;
        const double factor = fmin(fmax(0.9 * pow(fmax(error, 1e-9), -0.25), 0.25), 2.5);
        step = fabs(to - from) * factor;
        if (step < least)
            return NT_E_NO_CONVERGENCE;
        if (error > 1.0)
            continue;
        m->last = next;
        status = add(m, ends[1]);
    }
    return status;
}

/* Where the surface jumps: the smallest h over the gap under the apex, which falls all the way. Without a jump before
 * the nearest h the table ends there. */
static nt_status find_jump(maker *m)
{
    const double pole = m->solver.sample->pole;
    double high = m->last.centre, low = high;
    nt_yield_point point = m->last;
    while (point.slope > 0.0) {
        if (point.h <= m->range->nearest)
            return NT_OK;
        high = low;
        low = pole + SHORTER * (low - pole);
        const nt_status status = nt_yield_go(&m->solver, NT_YIELD_CENTRE, low, &point);
        if (status != NT_OK)
            return status;
    }
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        const nt_status status = nt_yield_go(&m->solver, NT_YIELD_CENTRE, middle, &point);
        if (status != NT_OK)
            return status;
        *(point.slope > 0.0 ? &high : &low) = middle;
    }
    if (point.h <= m->range->nearest)
        return NT_OK;
    m->table->jumps = 1;
    m->table->touch = point.h;
    m->hold = NT_YIELD_CENTRE;
    m->end = high + BEFORE_JUMP * (high - pole);
    return NT_OK;
}

static nt_status begin(maker *m)
{
    const nt_status status = nt_yield_begin(&m->solver, m->solver.sample, m->range->farthest);
    return status == NT_OK ? nt_yield_go(&m->solver, NT_YIELD_GAP, m->range->farthest, &m->last) : status;
}

static nt_status make_apart(maker *m, double length)
{
    nt_status status = begin(m);
    m->hold = NT_YIELD_GAP;
    m->end = m->range->nearest;
    double step = FIRST_STEP * length;
    if (m->range->attracts && status == NT_OK) {
        status = find_jump(m);
        if (status == NT_OK)
            status = begin(m);
        if (m->table->jumps)
            step = FIRST_STEP * (1.0 - SHORTER) * (m->last.centre - m->solver.sample->pole);
    }
    if (status == NT_OK)
        status = march(m, m->table->jumps ? -1 : 0, step);
    return status;
}

/* U of each node; the last h. */
static void integrate(nt_yield_table *table)
{
    for (int i = 1; i < table->count; ++i) {
        const int part = part_of(table, i);
        double c[4];
        if (i == table->apart) {
            table->node[i].U = table->node[i - 1].U;
            continue;
        }
        cubic(&table->node[i - 1], &table->node[i], c);
        table->node[i].U =
            table->node[i - 1].U + work(c, part, table->node[i - 1].v, table->node[i].v - table->node[i - 1].v);
    }
}

nt_status nt_yield_table_make(nt_yield_table *table, const nt_yield_sample *sample, const nt_yield_range *range)
{
    static const nt_yield_table empty = {0};
    maker m;
    m.table = table;
    m.range = range;
    m.solver.sample = sample;
    m.solver.tolerance = MESH * range->tolerance;
    *table = empty;
    table->touch = -INFINITY;
    nt_status status = make_apart(&m, sample->length);
    table->apart = table->count;
    if (status == NT_OK && !table->jumps)
        table->touch = range->attracts ? m.last.h : m.hold == NT_YIELD_CENTRE ? m.last.h : (double)-INFINITY;
    if (status == NT_OK && !range->attracts && m.hold == NT_YIELD_CENTRE && !is_done(&m)) {
        m.hold = NT_YIELD_CONTACT;
        m.end = INFINITY;
        m.last.a = 0.0;
        status = march(&m, 1, FIRST_RIM * sqrt(2.0 * sample->radius * sample->length));
    }
    table->first = range->farthest;
    table->last = m.last.h;
    integrate(table);
    return status;
}
