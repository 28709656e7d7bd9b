/* SPDX-License-Identifier: BSD-3-Clause
 * Ruptures: jumps between the straight pieces of a retraction outside contact. They have to exceed the noise, and the
 * largest jump that can be none. */
#include "curves/ruptures.h"

#include <math.h>

#include "curves/parts.h"
#include "curves/robust.h"

enum { LONG_PIECE = 4 };                                          /* blocks: shorter ones may carry a step */
static const double clear = 5.0;                                  /* standard deviations of a step */
static const double share_of_deepest = 0.01, share_of_rise = 0.6; /* that a rupture makes at least */
static const double over_decoys = 1.5;                            /* times the largest jump that can be none */
static const double out_of_contact = 0.5; /* of the deepest force: until there it may fall as it likes */
static const double sharp = 0.3;          /* of a step, that two points make where it begins */
static const double bent = 1.5;           /* times the noise: residuals of a line that is none */

static double clamp(double value, double low, double high)
{
    return fmin(fmax(value, low), high);
}

long nt_curve_step_width(const nt_curve_outside *out)
{
    return (long)clamp((double)(out->count / NT_PIECE_BLOCKS + 1), NT_CURVE_LEAST_WIDTH, NT_CURVE_MOST_WIDTH);
}

/* Largest change between neighbouring means of the free approach, up or down. */
static double approach_decoy(const nt_curve_branch *approach, long width)
{
    const long contact = approach->repulsive > approach->lowest ? approach->repulsive : approach->lowest;
    double largest = 0.0;
    for (long i = contact + 2 * width; i + width <= approach->count; i += width)
        largest = fmax(largest, fabs(nt_curve_step_at(approach->force, i, width)));
    return largest;
}

static double jump_between(const nt_curve_outside *out, const nt_curve_piece *piece)
{
    return piece[1].level - piece[0].level - piece[0].slope * (out->z[piece[1].first] - out->z[piece[0].first]);
}

/* A straight line through the points from .. end - 1, at z, and the standard deviation of that. */
nt_curve_measured nt_curve_line_at(const nt_curve_outside *out, long from, long end, double at)
{
    const double count = (double)(end - from);
    double z = 0.0, force = 0.0, spread = 0.0, product = 0.0, squares = 0.0;
    for (long k = from; k < end; k++) {
        z += out->z[k] / count;
        force += out->over[k] / count;
    }
    for (long k = from; k < end; k++) {
        spread += (out->z[k] - z) * (out->z[k] - z);
        product += (out->z[k] - z) * (out->over[k] - force);
    }
    const double slope = spread > 0.0 ? product / spread : 0.0;
    for (long k = from; k < end; k++) {
        const double rest = out->over[k] - force - slope * (out->z[k] - z);
        squares += rest * rest / count;
    }
    if (count < NT_CURVE_LEAST_WIDTH || !(spread > 0.0) || squares > bent * bent * out->noise * out->noise)
        return (nt_curve_measured){NAN, NAN};
    return (nt_curve_measured){force + slope * (at - z), out->noise * sqrt(1.0 / count + (at - z) * (at - z) / spread)};
}

/* The force at z near the end of a piece: by all of the piece where it is straight, else by its last 12 points, else
 * the lowest of these. */
static nt_curve_measured force_at(const nt_curve_outside *out, long first, long end, double z)
{
    nt_curve_measured found = nt_curve_line_at(out, first, end, z);
    const long last = end - NT_CURVE_MOST_WIDTH > first ? end - NT_CURVE_MOST_WIDTH : first;
    if (isnan(found.value))
        found = nt_curve_line_at(out, last, end, z);
    return isnan(found.value) ? (nt_curve_measured){nt_curve_lowest(out->over + last, end - last), out->noise} : found;
}

/* Mean of `count` points from `first` on, as far as there are such [N]. */
static double mean_of(const nt_curve_outside *out, long first, long count)
{
    const long from = first > 0 ? first : 0, to = first + count < out->count ? first + count : out->count;
    double sum = 0.0;
    for (long i = from; i < to; i++)
        sum += out->over[i];
    return to > from ? sum / (double)(to - from) : (double)NAN;
}

/* Index of the first point after the largest step about the end of a piece; 0 where none makes a rupture. Most of the
 * rise over five blocks has to happen within one: a force that comes back gradually is no rupture. */
static long rupture_after(const nt_curve_outside *out, long end, double *step)
{
    const long block = out->count / NT_PIECE_BLOCKS + 1, width = nt_curve_step_width(out), from = end - 2 * block;
    long best = 0;
    *step = 0.0;
    for (long i = from > width ? from : width; i <= end + 2 * block && i + width <= out->count; i++) {
        const double tried = nt_curve_step_at(out->over, i, width);
        if (tried > *step) {
            *step = tried;
            best = i;
        }
    }
    const double rise = mean_of(out, best + 2 * block, block) - mean_of(out, best - 3 * block, block);
    const double least = fmax(clear * out->noise * sqrt(2.0 / (double)width), share_of_deepest * out->deepest);
    const int seen = *step > least && *step > over_decoys * out->decoy && !(*step < share_of_rise * rise);
    return seen ? best : 0;
}

/* What jumps downwards between long pieces, or anywhere on the free approach, is no rupture. The force may fall at once
 * where the tip comes out of contact. */
static double largest_decoy(const nt_curve_outside *out, const nt_curve_branch *approach)
{
    const long least = LONG_PIECE * (out->count / NT_PIECE_BLOCKS + 1);
    const nt_curve_piece *piece = out->piece;
    double largest = approach_decoy(approach, nt_curve_step_width(out));
    long held = 0;
    while (held < out->count && out->over[held] > -out_of_contact * out->deepest)
        held++;
    for (int k = 0; k + 1 < out->pieces; k++)
        if (piece[k].first >= held && piece[k].end - piece[k].first >= least &&
            piece[k + 1].end - piece[k + 1].first >= least)
            largest = fmax(largest, -jump_between(out, piece + k));
    return largest;
}

/* The first point of the rise itself, which means on both sides smear. */
static long edge_of(const nt_curve_outside *out, long after, double step)
{
    for (long i = after - nt_curve_step_width(out) > 1 ? after - nt_curve_step_width(out) : 1; i < after; i++)
        if (out->over[i] - out->over[i - 1] > sharp * step + 2.0 * out->noise)
            return i;
    return after;
}

/* A row of the table: the force is that of the last point before the rise. */
static void add_rupture(nt_curve_outside *out, const nt_curve_piece *piece, long after, double step,
                        nt_curve_reading *reading)
{
    const int row = reading->ruptures;
    if (row == NT_CURVE_RUPTURES)
        return;
    const long before = row ? out->after[row - 1] : 0, first = piece->first > before ? piece->first : before;
    const nt_curve_measured force = force_at(out, first < after - 1 ? first : after - 1, after, out->z[after - 1]);
    reading->rupture[row] = (nt_curve_rupture){out->z[after - 1], -force.value, piece->slope, step};
    out->after[row] = after;
    out->sigma[row] = force.sigma;
    reading->ruptures++;
}

/* Fills the table of ruptures; returns the index from which on the tip may be free. */
static long find_ruptures(nt_curve_outside *out, const nt_curve_branch *approach, nt_curve_reading *reading)
{
    long free = 0;
    out->pieces = nt_curve_cut(out->z, out->over, out->count, out->piece);
    out->decoy = largest_decoy(out, approach);
    for (int k = 0; k + 1 < out->pieces; k++) {
        double step;
        const long after = rupture_after(out, out->piece[k].end, &step);
        if (after <= free + nt_curve_step_width(out))
            continue;
        add_rupture(out, out->piece + k, edge_of(out, after, step), step, reading);
        free = after;
    }
    return free;
}

nt_curve_outside nt_curve_outside_contact(const nt_curve_segment *retract, double *room, nt_curve_reading *reading)
{
    const long count = retract->count;
    double *over = room + count;
    long start = 0;
    nt_curve_order(retract, &reading->approach.baseline, room);
    for (long i = 1; i < count; i++)
        start = over[i] > over[start] ? i : start;
    while (start < count && over[start] > reading->approach.visible)
        start++;
    nt_curve_outside found = {.z = room + start,
                              .over = over + start,
                              .count = count - start,
                              .straight = reading->approach.baseline,
                              .noise = reading->retract.noise};
    for (long i = 0; i < found.count; i++)
        found.deepest = fmax(found.deepest, -found.over[i]);
    if (found.count >= NT_CURVE_FEWEST)
        found.free = find_ruptures(&found, &reading->approach, reading);
    return found;
}

void nt_curve_renew_outside(nt_curve_outside *out, const nt_curve_reading *reading)
{
    const nt_curve_branch *retract = &reading->retract;
    const long start = retract->count - out->count;
    double *level = out->over + out->count;
    out->z = retract->z + start;
    nt_curve_baseline_of(&retract->baseline, out->z, out->count, out->over);
    nt_curve_baseline_of(&reading->approach.baseline, out->z, out->count, level);
    for (long i = 0; i < out->count; i++)
        out->over[i] += retract->force[start + i] - level[i];
}
