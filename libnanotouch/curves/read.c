/* SPDX-License-Identifier: BSD-3-Clause
 * A whole curve: its values are checked, its branches read one after the other. */
#include <math.h>
#include <stddef.h>

#include "core/problem.h"
#include "curves/bend.h"
#include "curves/flicker.h"
#include "curves/joint.h"
#include "curves/line.h"
#include "curves/parts.h"
#include "curves/ringing.h"
#include "curves/robust.h"
#include "curves/straight.h"
#include "internal/curves.h"

static const double largest_value = 1.0; /* m or N: beyond, the unit is surely not SI */
static const double faint = 2.0;         /* times the visible force, below which a dip is hardly told from noise */
static const double unseen = 0.95;       /* of a step between samples: a tear lies anywhere in it */
static const double two_sided = 1.959963984540054; /* standard deviations of an interval of 95 % */

long nt_curve_work_size(long points)
{
    return 14 * points + NT_WAVE_GRID; /* two kept arrays, and what the baseline of the longer branch takes */
}

const char *nt_curve_contact_method_name(nt_curve_contact_method method)
{
    static const char *const names[NT_CURVE_METHODS] = {"crossing", "deviation", "hertz", "two_lines", "gradient"};
    return (unsigned)method < NT_CURVE_METHODS ? names[method] : NULL;
}

static nt_status check_values(const double values[], long count, const nt_problem *column, nt_problem *problem)
{
    const int good = nt_curve_all_within(values, count, largest_value);
    for (long i = 0; !good && i < count; i++)
        if (!(fabs(values[i]) <= largest_value)) {
            *problem = nt_problem_of(column->field, column->unit, values[i], -largest_value, largest_value);
            return isfinite(values[i]) ? NT_E_RANGE : NT_E_NOT_FINITE;
        }
    return NT_OK;
}

nt_status nt_curve_segment_check(const nt_curve_segment *segment, nt_problem *problem)
{
    nt_problem ignored;
    nt_problem *found = problem ? problem : &ignored;
    nt_status status = check_values(segment->z, segment->count, &(nt_problem){.field = "z", .unit = "m"}, found);
    if (status == NT_OK)
        status = check_values(segment->force, segment->count, &(nt_problem){.field = "force", .unit = "N"}, found);
    if (status != NT_OK)
        return status;
    if (nt_curve_highest(segment->z, segment->count) > nt_curve_lowest(segment->z, segment->count))
        return NT_OK;
    *found = nt_problem_of("z (travel)", "m", 0.0, 1e-18, largest_value);
    return NT_E_RANGE;
}

/* How a branch is read. */
typedef struct manner {
    const nt_curve_choice *choice;
    nt_problem *problem;
} manner;

/* Puts the bow of another baseline into one that was found without it. */
static void add_bow(const nt_curve_baseline *from, nt_curve_baseline *baseline)
{
    const double bow = from->bend.bow, x = baseline->z_mean - from->z_mean;
    baseline->force += bow * x * x;
    baseline->slope += 2.0 * bow * x;
    baseline->bend.bow = bow;
}

/* A branch over its own baseline, its point noise known; bowed: a baseline whose bow it has too, or NULL. *free: where
 * its arrays go, and is moved on behind them. */
static nt_status read_branch(const nt_curve_segment *segment, const manner *how, const nt_curve_baseline *bowed,
                             double **free, nt_curve_branch *branch)
{
    double *work = *free + 2 * segment->count;
    nt_curve_segment level = *segment;
    nt_curve_baseline baseline;
    if (bowed) {
        for (long i = 0; i < segment->count; i++) {
            const double x = segment->z[i] - bowed->z_mean;
            work[i] = segment->force[i] - bowed->bend.bow * x * x;
        }
        level.force = work;
        work += segment->count;
    }
    const nt_status status = nt_curve_baseline_over(&level, how->choice, branch->noise, work, &baseline, how->problem);
    if (status != NT_OK)
        return status;
    if (bowed)
        add_bow(bowed, &baseline);
    nt_curve_read_events(segment, &baseline, branch->noise, *free, branch);
    *free += 2 * segment->count;
    return NT_OK;
}

/* The retraction beside an approach that was read. A bow is even: what the free parts show is taken off the retraction
 * too. kept: the approach's arrays; *free: behind them. */
static nt_status judge(const nt_curve *curve, const manner *how, double *kept, double **free, nt_curve_reading *reading)
{
    nt_curve_branch *approach = &reading->approach, *retract = &reading->retract;
    const nt_curve_segment *segment = &curve->retract;
    const long n = segment->count;
    double *room = *free + 2 * n, *outside = room + 4 * n, *work[2] = {kept, outside + 2 * n};
    nt_curve_outside out = nt_curve_outside_contact(segment, outside, reading);
    const long first = out.free + (out.free ? (out.count - out.free) / 20 : 0);
    const nt_curve_branch tail = {
        .z = out.z + first, .force = out.over + first, .count = out.count - first, .visible = approach->visible};
    const nt_curve_bend_doubts doubts = nt_curve_unbend(&curve->approach, &tail, work, approach);
    const int bowed = approach->baseline.bend.bow != 0.0;
    const nt_status status = read_branch(segment, how, bowed ? &approach->baseline : NULL, free, retract);
    if (status != NT_OK)
        return status;
    nt_curve_share_noise((nt_curve_branch *[2]){approach, retract});
    reading->pull_off_least = reading->pull_off_most = retract->dip.value;
    reading->pull_off_sigma = retract->dip.sigma;
    nt_curve_join(curve, &doubts, &out, room, reading);
    nt_curve_doubt_level(&doubts, approach);
    return NT_OK;
}

/* One branch alone, or both without a look at the other. */
static void judge_alone(const nt_curve *curve, const manner *how, double *work[2], nt_curve_reading *reading)
{
    const nt_curve_branch none = {.count = 0};
    const nt_curve_measured no_dip = {NAN, NAN}, dip = reading->retract.count ? reading->retract.dip : no_dip;
    reading->pull_off_least = reading->pull_off_most = dip.value;
    reading->pull_off_sigma = dip.sigma;
    if (how->choice->kind != NT_CURVE_AUTO || !reading->approach.count)
        return;
    const nt_curve_bend_doubts doubts = nt_curve_unbend(&curve->approach, &none, work, &reading->approach);
    nt_curve_doubt_level(&doubts, &reading->approach);
}

/* Checks a segment, and its point noise; count 0 where it is none. */
static nt_status prepare(const nt_curve_segment *segment, double *work, nt_curve_branch *branch, nt_problem *problem)
{
    if (segment->count < NT_CURVE_FEWEST)
        return NT_OK;
    const nt_status status = nt_curve_segment_check(segment, problem);
    if (status != NT_OK)
        return status;
    branch->noise = nt_curve_point_noise(segment->force, segment->count, work);
    branch->count = segment->count;
    return NT_OK;
}

/* *free: moved on behind what is kept of the work. */
static nt_status read_both(const nt_curve *curve, const manner *how, double **free, nt_curve_reading *reading)
{
    nt_curve_branch *approach = &reading->approach, *retract = &reading->retract;
    double *kept = *free;
    nt_status status = prepare(&curve->approach, *free, approach, how->problem);
    if (status == NT_OK)
        status = prepare(&curve->retract, *free, retract, how->problem);
    if (status == NT_OK && approach->count)
        status = read_branch(&curve->approach, how, NULL, free, approach);
    if (status != NT_OK)
        return status;
    if (approach->count && retract->count && how->choice->kind == NT_CURVE_AUTO)
        return judge(curve, how, kept, free, reading);
    if (retract->count)
        status = read_branch(&curve->retract, how, NULL, free, retract);
    if (status == NT_OK)
        judge_alone(curve, how, (double *[2]){kept, *free}, reading);
    return status;
}

/* A short hold tears between two samples: its force grows with the lever's stiffness until then, and its last reading
 * may hardly stand out of the noise. The upper end of a faint pull-off holds what the force grows by after the lowest
 * reading. */
static void hold_last_reading(double spring_constant, nt_curve_reading *reading)
{
    const nt_curve_branch *retract = &reading->retract;
    const long lowest = retract->lowest;
    const int is_faint = retract->dip.value < faint * retract->visible;
    if (!is_faint || lowest + 1 >= retract->count || isnan(spring_constant))
        return;
    const double step = retract->z[lowest + 1] - retract->z[lowest];
    const double end = -retract->force[lowest] + unseen * spring_constant * step;
    reading->pull_off_most = fmax(reading->pull_off_most, end - two_sided * reading->pull_off_sigma);
}

nt_status nt_curve_read(const nt_curve *curve, const nt_curve_choice *choice, double *work, nt_curve_reading *reading,
                        nt_problem *problem)
{
    double *free = work;
    const manner how = {choice, problem};
    *reading = (nt_curve_reading){.contact_point = {NAN, NAN}, .offset = NAN, .offset_sigma = NAN};
    const nt_status status = read_both(curve, &how, &free, reading);
    if (status != NT_OK)
        return status;
    if (reading->retract.count) {
        nt_curve_doubt_ringing(reading);
        hold_last_reading(curve->spring_constant, reading);
    }
    if (choice->kind == NT_CURVE_AUTO)
        nt_curve_doubt_straightness(reading);
    const nt_curve_branch *first = reading->approach.count ? &reading->approach : &reading->retract;
    if (first->count) {
        nt_curve_find_contact(first, curve->spring_constant, free, reading);
        return NT_OK;
    }
    if (problem)
        *problem = nt_problem_of(
            "points of a branch", "",
            (double)(curve->approach.count > curve->retract.count ? curve->approach.count : curve->retract.count),
            NT_CURVE_FEWEST, 1e9);
    return NT_E_RANGE;
}
