/* SPDX-License-Identifier: BSD-3-Clause
 * A whole curve: its values are checked, its branches read one after the other. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/same_bits.h"
#include "curves/bend.h"
#include "curves/film.h"
#include "curves/flicker.h"
#include "curves/joint.h"
#include "curves/line.h"
#include "curves/parts.h"
#include "curves/robust.h"

static const double largest_value = 1.0; /* m or N: beyond, the unit is surely not SI */
static const double plausible = 0.1;     /* likelihood of a squeeze film that counts */

/* Two kept arrays, and what the baseline of the longer branch takes; the force without a bow lies behind them. */
static long before_forces(long points)
{
    return 14 * points + NT_WAVE_GRID;
}

long nt_curve_work_size(long points)
{
    return before_forces(points) + points;
}

const char *nt_curve_contact_method_name(nt_curve_contact_method method)
{
    static const char *const names[NT_CURVE_METHODS] = {"crossing", "deviation", "hertz", "two_lines", "gradient"};
    return (unsigned)method < NT_CURVE_METHODS ? names[method] : NULL;
}

static nt_status check_values(const double values[], long count, const nt_problem *column, nt_problem *problem)
{
    int bad = 0;
    for (long i = 0; i < count; i++) /* without a branch, several at once */
        bad |= !(fabs(values[i]) <= largest_value);
    for (long i = 0; bad && i < count; i++)
        if (!(fabs(values[i]) <= largest_value)) {
            *problem = (nt_problem){column->field, column->unit, values[i], -largest_value, largest_value};
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
    *found = (nt_problem){"z (travel)", "m", 0.0, 1e-18, largest_value};
    return NT_E_RANGE;
}

/* Baselines of both branches first, since they share their noise; *free: behind what is kept of the work. */
static nt_status read_branches(const nt_curve *curve, const nt_curve_choice *choice, double **free,
                               nt_curve_reading *reading, nt_problem *problem)
{
    const nt_curve_segment *segments[2] = {&curve->approach, &curve->retract};
    nt_curve_branch *branches[2] = {&reading->approach, &reading->retract};
    nt_curve_baseline baselines[2];
    double noise[2];
    int read = 0;
    for (int i = 0; i < 2; i++) {
        if (segments[i]->count < NT_CURVE_FEWEST)
            continue;
        nt_status status = nt_curve_segment_check(segments[i], problem);
        if (status != NT_OK)
            return status;
        noise[i] = nt_curve_point_noise(segments[i]->force, segments[i]->count, *free);
        status = nt_curve_baseline_over(segments[i], choice, noise[i], *free, baselines + i, problem);
        if (status != NT_OK)
            return status;
        read++;
    }
    if (choice->kind == NT_CURVE_AUTO && read == 2)
        nt_curve_share_noise(segments, baselines, *free);
    for (int i = 0; i < 2; i++) {
        if (segments[i]->count < NT_CURVE_FEWEST)
            continue;
        nt_curve_read_events(segments[i], baselines + i, noise[i], *free, branches[i]);
        *free += 2 * segments[i]->count;
    }
    return NT_OK;
}

/* The curve without a bow; both its forces in room. */
static nt_curve without(const nt_curve_bow *bow, const nt_curve *curve, double *room)
{
    nt_curve level = *curve;
    const nt_curve_segment *from[2] = {&curve->approach, &curve->retract};
    nt_curve_segment *to[2] = {&level.approach, &level.retract};
    for (int branch = 0; branch < 2; branch++) {
        for (long i = 0; i < from[branch]->count; i++) {
            const double x = from[branch]->z[i] - bow->middle;
            room[i] = from[branch]->force[i] - bow->size * x * x;
        }
        to[branch]->force = room;
        room += from[branch]->count;
    }
    return level;
}

static void add_bow(const nt_curve_bow *bow, nt_curve_baseline *baseline)
{
    const double x = baseline->z_mean - bow->middle;
    baseline->force += bow->size * x * x;
    baseline->slope += 2.0 * bow->size * x;
    baseline->bend.bow = bow->size;
}

/* By how much a bow of size 1 lowers the pull-off, over a baseline that it bent too [m^2]. */
static double lowered_by_bow(const nt_curve_bow *bow, const nt_curve_reading *reading)
{
    const nt_curve_branch *retract = &reading->retract;
    const nt_curve_baseline *baseline = &retract->baseline;
    const double last = retract->z[retract->count - 1], z = retract->z[retract->lowest];
    const double level = baseline->z_mean - bow->middle, there = z - bow->middle;
    if (reading->support == NT_CURVE_SHARED || reading->support == NT_CURVE_BOUND)
        return there * there - level * level; /* the approach's tilt */
    const double half = 0.5 * (last - baseline->nearest), away = z - baseline->z_mean;
    return away * away - half * half / 3.0;
}

/* A bow that is not known well leaves the pull-off as uncertain; it may be a film instead where that is likely. */
static void doubt_bow(const nt_curve_bow *bow, nt_curve_reading *reading)
{
    const double lowered = lowered_by_bow(bow, reading), doubt = bow->sigma * lowered;
    if (bow->film > plausible)
        reading->pull_off_least = fmax(reading->pull_off_least - fmax(bow->size * lowered, 0.0), 0.0);
    reading->pull_off_sigma = hypotenuse(reading->pull_off_sigma, doubt);
    reading->retract.dip.sigma = hypotenuse(reading->retract.dip.sigma, doubt);
}

/* A film that cannot be excluded holds the lever as adhesion does. */
static void doubt_film(const nt_curve_bow *bow, nt_curve_reading *reading)
{
    nt_curve_branch *retract = &reading->retract;
    if (!retract->dips)
        reading->pull_off_least = 0.0;
    else if (bow->film > plausible) {
        const double least = fmin(nt_curve_held_beyond_film(reading), reading->pull_off_least);
        retract->dip.sigma = hypotenuse(retract->dip.sigma, (reading->pull_off_least - least) / sqrt(12.0));
        reading->pull_off_least = least;
    }
}

/* The pull-off of a retraction that is not judged beside an approach. */
static void take_dip(nt_curve_reading *reading)
{
    const nt_curve_measured none = {NAN, NAN}, dip = reading->retract.count ? reading->retract.dip : none;
    reading->pull_off_least = reading->pull_off_most = dip.value;
    reading->pull_off_sigma = dip.sigma;
}

static void join_level(const nt_curve *curve, const nt_curve_bow *bow, double *free, nt_curve_reading *reading)
{
    take_dip(reading);
    nt_curve_join(curve, free, reading);
    doubt_film(bow, reading);
    doubt_bow(bow, reading);
}

/* The retraction beside the approach. A bow of the free approach is taken off both before they are judged, and is part
 * of the retraction's baseline; the approach is left as it was read, for nt_curve_unbend. */
static nt_status join(const nt_curve *curve, double *work, double *free, nt_curve_reading *reading, nt_problem *problem)
{
    const nt_curve_choice choice = {.kind = NT_CURVE_AUTO};
    const nt_curve_branch approach = reading->approach;
    const nt_curve_bow bow = nt_curve_find_bow(&approach);
    double *again = work;
    if (bow.size == 0.0) {
        join_level(curve, &bow, free, reading);
        return NT_OK;
    }
    const nt_curve level = without(&bow, curve, work + before_forces(approach.count + reading->retract.count));
    const nt_status status = read_branches(&level, &choice, &again, reading, problem);
    if (status != NT_OK)
        return status;
    join_level(&level, &bow, free, reading);
    add_bow(&bow, &reading->retract.baseline);
    nt_curve_read_events(&curve->approach, &approach.baseline, approach.noise, free, &reading->approach);
    memcpy(work, free, 2 * (size_t)approach.count * sizeof *free);
    reading->approach.z = work;
    reading->approach.force = work + approach.count;
    return NT_OK;
}

nt_status nt_curve_read(const nt_curve *curve, const nt_curve_choice *choice, double *work, nt_curve_reading *reading,
                        nt_problem *problem)
{
    double *free = work;
    *reading = (nt_curve_reading){.contact_point = {NAN, NAN}};
    nt_status status = read_branches(curve, choice, &free, reading, problem);
    if (status != NT_OK)
        return status;
    reading->offset = reading->offset_sigma = NAN;
    take_dip(reading);
    if (choice->kind == NT_CURVE_AUTO && reading->approach.count && reading->retract.count)
        status = join(curve, work, free, reading, problem);
    if (status != NT_OK)
        return status;
    if (choice->kind == NT_CURVE_AUTO && reading->approach.count)
        nt_curve_unbend(&curve->approach, work, free, &reading->approach);
    const nt_curve_branch *first = reading->approach.count ? &reading->approach : &reading->retract;
    if (first->count) {
        nt_curve_find_contact(first, curve->spring_constant, free, reading);
        return NT_OK;
    }
    if (problem)
        *problem = (nt_problem){
            "points of a branch", "",
            (double)(curve->approach.count > curve->retract.count ? curve->approach.count : curve->retract.count),
            NT_CURVE_FEWEST, 1e9};
    return NT_E_RANGE;
}
