/* SPDX-License-Identifier: BSD-3-Clause
 * The table of a law of one's own: cells of the fifth degree in U, which have the law's U, F and k at both ends, split
 * where they err most; what the law states of itself is compared with all samples. */
#include <math.h>
#include <stddef.h>

#include "scene/terms/term.h"

#define FIRST_CELLS 16
#define FARTHEST 0.1     /* [m] */
#define END 1e-9         /* the table ends where the bound has fallen to this share of its first value */
#define TOLERANCE 1e-9   /* of a force, or of SMALL times the largest one: no cell is split below it */
#define SMALL 1e-4       /* forces below this share of the largest are not resolved better */
#define FELT 1e-2        /* the same where a law is judged */
#define NARROWEST 1e-6   /* width of a cell over its gap: at a kink of the force more does not help */
#define STIFFNESS 1e-3   /* what an error of k counts beside one of F when cells are split */
#define DISAGREE 1e-2    /* F is not -dU/dh beyond this share, or k not -dF/dh beyond ten times it */
#define TABLED 2.0       /* the error oscillates within a cell: what was sampled may be half of it */
#define BOUND_HOLDS 1e-9 /* a bound may be this share too small, by rounding */
#define REACHED 1e1      /* times the largest load: a force beyond it is felt only where more pulls, which S is then */
#define LOST 1e-3        /* of a force: where the table is off by more, it has not seen a part of the law */
#define BEYOND 1.1       /* ratio of gaps at which it is held to its bound beyond the table */
enum { INSIDE = 3, LOOKS = 2048 }; /* samples inside a cell; of all the law */

/* The law at both ends of a cell and inside, and how far the polynomial is off. */
typedef struct cell {
    double force, stiffness;             /* largest of its samples [N, N/m] */
    double force_error, stiffness_error; /* [N, N/m] */
} cell;

typedef struct builder {
    nt_custom_table *table;
    const nt_custom_term *custom;
    nt_law_value ends[NT_CUSTOM_CELLS + 1];
    cell cells[NT_CUSTOM_CELLS];
    double felt; /* nothing presses the tip to where the force is larger [N] */
    nt_problem *problem;
} builder;

static int is_finite(nt_law_value value)
{
    return isfinite(value.U) && isfinite(value.F) && isfinite(value.k);
}

static nt_status sample(const builder *b, double gap, nt_law_value *value)
{
    *value = b->custom->law(b->custom->context, gap);
    if (is_finite(*value))
        return NT_OK;
    b->problem->unit = "m"; /* at this gap */
    b->problem->value = b->problem->minimum = b->problem->maximum = gap;
    return NT_E_NOT_FINITE;
}

/* Hermite's polynomial of U over t = (h - h0)/w: U, -F w, k w^2 at t = 0 and 1. */
static void fit(const builder *b, int i)
{
    const nt_law_value first = b->ends[i], last = b->ends[i + 1];
    const double w = b->table->gap[i + 1] - b->table->gap[i];
    double *c = b->table->U[i];
    c[0] = first.U;
    c[1] = -first.F * w;
    c[2] = 0.5 * first.k * w * w;
    const double A = last.U - c[0] - c[1] - c[2], B = -last.F * w - c[1] - 2.0 * c[2], C = last.k * w * w - 2.0 * c[2];
    c[3] = 10.0 * A - 4.0 * B + 0.5 * C;
    c[4] = -15.0 * A + 7.0 * B - C;
    c[5] = 6.0 * A - 3.0 * B + 0.5 * C;
}

static nt_status measure(builder *b, int i)
{
    const double start = b->table->gap[i], w = b->table->gap[i + 1] - start, *c = b->table->U[i];
    cell *m = &b->cells[i];
    fit(b, i);
    *m = (cell){fmax(fabs(b->ends[i].F), fabs(b->ends[i + 1].F)), fmax(fabs(b->ends[i].k), fabs(b->ends[i + 1].k)), 0.0,
                0.0};
    for (int j = 1; j <= INSIDE; ++j) {
        const double t = (double)j / (INSIDE + 1);
        nt_law_value truth;
        const nt_status status = sample(b, start + t * w, &truth);
        if (status != NT_OK)
            return status;
        const double F = -(c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * (4.0 * c[4] + t * 5.0 * c[5])))) / w;
        const double k = (2.0 * c[2] + t * (6.0 * c[3] + t * (12.0 * c[4] + t * 20.0 * c[5]))) / (w * w);
        m->force = fmax(m->force, fabs(truth.F));
        m->stiffness = fmax(m->stiffness, fabs(truth.k));
        m->force_error = fmax(m->force_error, fabs(F - truth.F));
        m->stiffness_error = fmax(m->stiffness_error, fabs(k - truth.k));
    }
    return NT_OK;
}

/* Largest |F| and |k| of all samples where |F| is no more than a force. */
static cell largest(const builder *b, double felt)
{
    cell all = {0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < b->table->count; ++i) {
        if (fmin(fabs(b->ends[i].F), fabs(b->ends[i + 1].F)) > felt)
            continue;
        all.force = fmax(all.force, b->cells[i].force);
        all.stiffness = fmax(all.stiffness, b->cells[i].stiffness);
        all.force_error = fmax(all.force_error, b->cells[i].force_error);
        all.stiffness_error = fmax(all.stiffness_error, b->cells[i].stiffness_error);
    }
    return all;
}

static double relative(double error, double size, double all)
{
    return error > 0.0 ? error / fmax(size, all) : 0.0;
}

/* The cell that is most worth splitting; -1 if none is. */
static int worst(const builder *b)
{
    const cell all = largest(b, b->felt);
    double most = TOLERANCE;
    int found = -1;
    for (int i = 0; i < b->table->count; ++i) {
        const cell *m = &b->cells[i];
        const double error = fmax(relative(m->force_error, m->force, SMALL * all.force),
                                  STIFFNESS * relative(m->stiffness_error, m->stiffness, SMALL * all.stiffness));
        if (error > most && b->table->gap[i + 1] - b->table->gap[i] > NARROWEST * b->table->gap[i]) {
            most = error;
            found = i;
        }
    }
    return found;
}

static nt_status split(builder *b, int i, double middle)
{
    nt_custom_table *table = b->table;
    for (int j = table->count; j > i; --j) {
        table->gap[j + 1] = table->gap[j];
        b->ends[j + 1] = b->ends[j];
    }
    for (int j = table->count - 1; j > i; --j) {
        b->cells[j + 1] = b->cells[j];
        for (int n = 0; n < 6; ++n)
            table->U[j + 1][n] = table->U[j][n];
    }
    table->gap[i + 1] = middle;
    ++table->count;
    nt_status status = sample(b, middle, &b->ends[i + 1]);
    if (status == NT_OK)
        status = measure(b, i);
    return status == NT_OK ? measure(b, i + 1) : status;
}

/* Splits the worst cells until none is worth it, or there are so many. */
static nt_status refine(builder *b, int most)
{
    nt_status status = NT_OK;
    for (int i = worst(b); i >= 0 && b->table->count < most && status == NT_OK; i = worst(b))
        status = split(b, i, sqrt(b->table->gap[i] * b->table->gap[i + 1]));
    return status;
}

/* A narrow part of the law may lie between all samples: looks more closely, and splits a cell where it is. What a cell
 * is off by at its own samples is left to be split for that. */
static nt_status look(builder *b)
{
    nt_custom_table *table = b->table;
    const double first = table->gap[0], ratio = table->gap[table->count] / first;
    const cell all = largest(b, b->felt);
    nt_status status = NT_OK;
    for (int n = 0; n < LOOKS && status == NT_OK && table->count < NT_CUSTOM_CELLS; ++n) {
        const double gap = first * pow(ratio, (n + 0.5) / LOOKS);
        const int i = nt_custom_cell(table, gap);
        nt_law_value truth;
        status = i < 0 ? NT_OK : sample(b, gap, &truth);
        if (i < 0 || status != NT_OK)
            continue;
        const double start = table->gap[i], w = table->gap[i + 1] - start, t = (gap - start) / w, *c = table->U[i];
        const double F = -(c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * (4.0 * c[4] + t * 5.0 * c[5])))) / w;
        const double off = fabs(F - truth.F), narrowest = NARROWEST * start;
        const double felt = fmax(LOST * fmax(fabs(truth.F), SMALL * all.force), TABLED * b->cells[i].force_error);
        if (off > felt && fmin(gap - start, w) > narrowest)
            status = split(b, i, gap);
    }
    return status;
}

/* Cells of even ratio from the hold to where the bound has fallen off, then split. */
static nt_status build(builder *b, double hold)
{
    nt_custom_table *table = b->table;
    const double first = b->custom->bound(b->custom->context, hold);
    double end = 2.0 * hold;
    if (!isfinite(first)) {
        *b->problem = nt_problem_of(NULL, "N", first, 0.0, INFINITY);
        return NT_E_RANGE;
    }
    while (end < FARTHEST && !(b->custom->bound(b->custom->context, end) <= END * fmin(first, b->felt)))
        end *= 2.0;
    table->count = FIRST_CELLS;
    for (int i = 0; i <= FIRST_CELLS; ++i) {
        table->gap[i] = i == 0 ? hold : hold * pow(end / hold, (double)i / FIRST_CELLS);
        const nt_status status = sample(b, table->gap[i], &b->ends[i]);
        if (status != NT_OK)
            return status;
    }
    for (int i = 0; i < FIRST_CELLS; ++i) {
        const nt_status status = measure(b, i);
        if (status != NT_OK)
            return status;
    }
    nt_status status = refine(b, NT_CUSTOM_CELLS / 2); /* room for what is not seen yet */
    if (status == NT_OK)
        status = look(b);
    return status == NT_OK ? refine(b, NT_CUSTOM_CELLS) : status;
}

/* Energy, force and stiffness are one law: cells err little in F, and most of them in k (a force may have kinks). */
static nt_status check_derivatives(const builder *b)
{
    const cell all = largest(b, INFINITY);
    double off = 0.0;
    int wrong = 0;
    for (int i = 0; i < b->table->count; ++i) {
        const cell *m = &b->cells[i];
        off = fmax(off, relative(m->force_error, m->force, FELT * all.force));
        wrong += relative(m->stiffness_error, m->stiffness, SMALL * all.stiffness) > 10.0 * DISAGREE;
    }
    if (off <= DISAGREE && 4 * wrong <= b->table->count)
        return NT_OK;
    b->problem->value = fmax(off, (double)wrong / b->table->count);
    b->problem->maximum = DISAGREE;
    return NT_E_RANGE;
}

/* Refusals name the bound: the field is taken away. */
static nt_status check_stated(const builder *b, double stated, double force)
{
    if (stated >= force * (1.0 - BOUND_HOLDS) && isfinite(stated))
        return NT_OK;
    *b->problem = nt_problem_of(NULL, "N", stated, force, INFINITY);
    return NT_E_RANGE;
}

/* Beyond the last gap the table is 0, on the word of the bound. A law that is no number so far out is not judged. */
static nt_status check_beyond(const builder *b)
{
    nt_status status = NT_OK;
    for (double gap = b->table->gap[b->table->count] * BEYOND; gap < FARTHEST && status == NT_OK; gap *= BEYOND) {
        const double force = fabs(b->custom->law(b->custom->context, gap).F);
        if (isfinite(force))
            status = check_stated(b, b->custom->bound(b->custom->context, gap), force);
    }
    return status;
}

/* No sample at a gap or beyond it exceeds the bound. */
static nt_status check_bound(const builder *b)
{
    nt_custom_table *table = b->table;
    double force = 0.0, stiffness = 0.0;
    for (int i = table->count; i >= 0; --i) {
        if (i < table->count) {
            force = fmax(force, b->cells[i].force);
            stiffness = fmax(stiffness, NT_SAMPLED * b->cells[i].stiffness);
        } else
            force = fabs(b->ends[i].F);
        const double stated = b->custom->bound(b->custom->context, table->gap[i]);
        const nt_status status = check_stated(b, stated, force);
        if (status != NT_OK)
            return status;
        table->largest_force[i] = stated;
        table->largest_stiffness[i] = stiffness;
    }
    return check_beyond(b);
}

/* Beyond the last gap U stays 0, so that it has no step: of all cells what it has there is taken off. */
static void finish(const builder *b)
{
    nt_custom_table *table = b->table;
    const cell all = largest(b, b->felt);
    for (int i = 0; i < table->count; ++i)
        table->U[i][0] -= b->ends[table->count].U;
    table->force_error = TABLED * all.force_error + table->largest_force[table->count];
    table->stiffness_error = TABLED * all.stiffness_error + fabs(b->ends[table->count].k);
}

nt_status nt_custom_tabulate(nt_custom_table *table, const nt_custom_term *custom, const nt_scene *scene,
                             nt_problem *problem)
{
    builder b = {.table = table, .custom = custom, .felt = REACHED * scene->range.maximum_load, .problem = problem};
    nt_status status = build(&b, scene->adhesion.equilibrium_distance);
    if (status == NT_OK)
        status = check_derivatives(&b);
    if (status == NT_OK)
        status = check_bound(&b);
    if (status == NT_OK)
        finish(&b);
    return status;
}

int nt_custom_cell(const nt_custom_table *table, double gap)
{
    int low = 0, high = table->count;
    if (!(gap < table->gap[high]))
        return -1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (gap < table->gap[middle])
            high = middle;
        else
            low = middle;
    }
    return low;
}
