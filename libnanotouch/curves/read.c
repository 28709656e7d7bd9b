/* SPDX-License-Identifier: BSD-3-Clause
 * A whole curve: its values are checked, its branches read one after the other. */
#include <math.h>
#include <stddef.h>

#include "curves/bend.h"
#include "curves/flicker.h"
#include "curves/joint.h"
#include "curves/line.h"
#include "curves/parts.h"
#include "curves/robust.h"

static const double largest_value = 1.0; /* m or N: beyond, the unit is surely not SI */

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

nt_status nt_curve_read(const nt_curve *curve, const nt_curve_choice *choice, double *work, nt_curve_reading *reading,
                        nt_problem *problem)
{
    double *free = work;
    *reading = (nt_curve_reading){.contact_point = {NAN, NAN}};
    const nt_status status = read_branches(curve, choice, &free, reading, problem);
    if (status != NT_OK)
        return status;
    reading->offset = reading->offset_sigma = NAN;
    reading->pull_off_sigma = reading->retract.count ? reading->retract.dip.sigma : (double)NAN;
    reading->pull_off_least = reading->pull_off_most =
        reading->retract.count ? reading->retract.dip.value : (double)NAN;
    if (choice->kind == NT_CURVE_AUTO && reading->approach.count && reading->retract.count)
        nt_curve_join(curve, free, reading);
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
