/* SPDX-License-Identifier: BSD-3-Clause
 * Both branches together. What holds the tip on its way out (tethers, several necks) ends in ruptures: only what lies
 * beyond the last of them can be free. Where that is less than the far half, its level is taken with the approach's
 * tilt and wave; where its level is further below the approach than drag explains, nothing is free. */
#include "curves/joint.h"

#include "core/same_bits.h"
#include "curves/film.h"
#include "curves/line.h"
#include "curves/parts.h"
#include "curves/pieces.h"
#include "curves/robust.h"

enum {
    LEAST_WIDTH = 3,
    MOST_WIDTH = 12, /* points of the means on both sides of a step */
    LONG_PIECE = 4   /* blocks: shorter ones may carry a step */
};
static const double clear = 5.0;                                  /* standard deviations of a step */
static const double share_of_deepest = 0.01, share_of_rise = 0.6; /* that a rupture makes at least */
static const double over_decoys = 1.5;                            /* times the largest jump that can be none */
static const double sharp = 0.3;                                  /* of a step, that two points make where it begins */
static const double deepest_of_many = 5.0; /* standard deviations that the lowest of many points may lie too low */
static const double bent = 1.5;            /* times the noise: residuals of a line that is none */
static const double far_part = 0.5;        /* of the travel: a tail as long is judged by itself */
static const double own_tilt = 0.25;       /* of the travel, from where a tail may show a tilt of its own (drift) */
static const double contradiction = 4.0;   /* standard deviations */

/* The retraction over the approach's baseline, outside contact. */
typedef struct outside {
    const double *z;
    double *over; /* force above the approach's baseline [N] */
    long count;
    double noise, deepest; /* [N] */
    double decoy;          /* largest jump that can be no rupture [N] */
    nt_curve_piece piece[NT_PIECE_BLOCKS];
    int pieces;
    long after[NT_CURVE_RUPTURES];   /* first point after each rupture */
    double sigma[NT_CURVE_RUPTURES]; /* of its force [N] */
} outside;

static double clamp(double value, double low, double high)
{
    return fmin(fmax(value, low), high);
}

static long step_width(const outside *out)
{
    return (long)clamp((double)(out->count / NT_PIECE_BLOCKS + 1), LEAST_WIDTH, MOST_WIDTH);
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

/* From where the force is no longer above the approach's baseline. */
static outside outside_contact(const nt_curve_reading *reading, double *room)
{
    const nt_curve_branch *retract = &reading->retract;
    long start = 0;
    nt_curve_baseline_of(&retract->baseline, retract->z, retract->count, room);
    nt_curve_baseline_of(&reading->approach.baseline, retract->z, retract->count, room + retract->count);
    for (long i = 0; i < retract->count; i++) {
        room[i] += retract->force[i] - room[retract->count + i];
        start = room[i] > room[start] ? i : start;
    }
    while (start < retract->count && room[start] > reading->approach.visible)
        start++;
    outside found = {
        .z = retract->z + start, .over = room + start, .count = retract->count - start, .noise = retract->noise};
    for (long i = 0; i < found.count; i++)
        found.deepest = fmax(found.deepest, -found.over[i]);
    return found;
}

static double jump_between(const outside *out, const nt_curve_piece *piece)
{
    return piece[1].level - piece[0].level - piece[0].slope * (out->z[piece[1].first] - out->z[piece[0].first]);
}

/* A straight line through the points from .. end - 1, at z, and the standard deviation of that. */
static nt_curve_measured line_at(const outside *out, long from, long end, double at)
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
    if (count < LEAST_WIDTH || !(spread > 0.0) || squares > bent * bent * out->noise * out->noise)
        return (nt_curve_measured){NAN, NAN};
    return (nt_curve_measured){force + slope * (at - z), out->noise * sqrt(1.0 / count + (at - z) * (at - z) / spread)};
}

/* The force at z near the end of a piece: by all of the piece where it is straight, else by its last 12 points, else
 * the lowest of these. */
static nt_curve_measured force_at(const outside *out, long first, long end, double z)
{
    nt_curve_measured found = line_at(out, first, end, z);
    const long last = end - MOST_WIDTH > first ? end - MOST_WIDTH : first;
    if (isnan(found.value))
        found = line_at(out, last, end, z);
    return isnan(found.value) ? (nt_curve_measured){nt_curve_lowest(out->over + last, end - last), out->noise} : found;
}

/* Mean of `count` points from `first` on, as far as there are such [N]. */
static double mean_of(const outside *out, long first, long count)
{
    const long from = first > 0 ? first : 0, to = first + count < out->count ? first + count : out->count;
    double sum = 0.0;
    for (long i = from; i < to; i++)
        sum += out->over[i];
    return to > from ? sum / (double)(to - from) : (double)NAN;
}

/* Index of the first point after the largest step about the end of a piece; 0 where none makes a rupture. Most of the
 * rise over five blocks has to happen within one: a force that comes back gradually is no rupture. */
static long rupture_after(const outside *out, long end, double *step)
{
    const long block = out->count / NT_PIECE_BLOCKS + 1, width = step_width(out), from = end - 2 * block;
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

/* What jumps downwards between long pieces, or anywhere on the free approach, is no rupture. */
static double largest_decoy(const outside *out, const nt_curve_branch *approach)
{
    const long least = LONG_PIECE * (out->count / NT_PIECE_BLOCKS + 1);
    const nt_curve_piece *piece = out->piece;
    double largest = approach_decoy(approach, step_width(out));
    for (int k = 0; k + 1 < out->pieces; k++)
        if (piece[k].end - piece[k].first >= least && piece[k + 1].end - piece[k + 1].first >= least)
            largest = fmax(largest, -jump_between(out, piece + k));
    return largest;
}

/* The first point of the rise itself, which means on both sides smear. */
static long edge_of(const outside *out, long after, double step)
{
    for (long i = after - step_width(out) > 1 ? after - step_width(out) : 1; i < after; i++)
        if (out->over[i] - out->over[i - 1] > sharp * step + 2.0 * out->noise)
            return i;
    return after;
}

/* A row of the table: the force is that of the last point before the rise. */
static void add_rupture(outside *out, const nt_curve_piece *piece, long after, double step, nt_curve_reading *reading)
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
static long find_ruptures(outside *out, const nt_curve_branch *approach, nt_curve_reading *reading)
{
    long free = 0;
    out->pieces = nt_curve_cut(out->z, out->over, out->count, out->piece);
    out->decoy = largest_decoy(out, approach);
    for (int k = 0; k + 1 < out->pieces; k++) {
        double step;
        const long after = rupture_after(out, out->piece[k].end, &step);
        if (after <= free + step_width(out))
            continue;
        add_rupture(out, out->piece + k, edge_of(out, after, step), step, reading);
        free = after;
    }
    return free;
}

/* The depth at the lowest point, which noise picks as too deep: by the rupture that ends its piece, or by the piece. */
static void refine_dip(const outside *out, nt_curve_reading *reading)
{
    nt_curve_branch *retract = &reading->retract;
    const long lowest = retract->lowest - (retract->count - out->count);
    int k = out->pieces - 1, row = 0;
    while (k >= 0 && out->piece[k].first > lowest)
        k--;
    while (row < reading->ruptures && out->after[row] <= lowest)
        row++;
    if (!retract->dips || k < 0 || lowest < 0)
        return;
    const double level = nt_curve_branch_sigma(retract, retract->z[retract->lowest]); /* noise and baseline */
    const double known = sqrt(fmax(level * level - retract->noise * retract->noise, 0.0));
    const int torn = row < reading->ruptures && (out->after[row] - lowest <= MOST_WIDTH ||
                                                 out->piece[k].end >= out->after[row] - 2 * step_width(out));
    const double z = retract->z[retract->lowest];
    const double over =
        nt_curve_baseline_at(&retract->baseline, z) - nt_curve_baseline_at(&reading->approach.baseline, z);
    const long before = row ? out->after[row - 1] : 0;
    const long first = out->piece[k].first > before ? out->piece[k].first : before;
    const long limit = row < reading->ruptures ? out->after[row] : out->count;
    nt_curve_measured line = line_at(out, first, limit < out->piece[k].end ? limit : out->piece[k].end, z);
    if (isnan(line.value))
        line = line_at(out, lowest - MOST_WIDTH > before ? lowest - MOST_WIDTH : before,
                       lowest + MOST_WIDTH < limit ? lowest + MOST_WIDTH : limit, z);
    nt_curve_measured better = {over - line.value, line.sigma};
    if (torn)
        better = (nt_curve_measured){reading->rupture[row].force, out->sigma[row]};
    if (fabs(better.value - retract->dip.value) < deepest_of_many * retract->noise + better.sigma)
        retract->dip = (nt_curve_measured){better.value, hypotenuse(known, fmax(better.sigma, retract->noise))};
}

/* The same wave seen from another zero of x. */
static nt_curve_wave shifted(const nt_curve_wave *wave, double by)
{
    const double phase = wave->period > 0.0 ? 6.28318530717958647693 / wave->period * by : 0.0;
    const double c = cos(phase), s = sin(phase);
    return (nt_curve_wave){wave->period, wave->cosine * c + wave->sine * s, wave->sine * c - wave->cosine * s};
}

/* The approach's baseline, `force` above it at z_mean, where its level is known to that variance. */
static nt_curve_baseline beside(const nt_curve_baseline *approach, double z_mean, double force, double variance)
{
    nt_curve_baseline found = *approach;
    found.force = approach->force + approach->slope * (z_mean - approach->z_mean) + force;
    found.wave = shifted(&approach->wave, z_mean - approach->z_mean);
    found.z_mean = z_mean;
    found.force_variance = variance;
    return found;
}

/* A line through the tail, over the approach's baseline. */
static nt_curve_baseline tail_line(const outside *out, long from, double *room)
{
    const long n = out->count - from;
    nt_curve_free tail = {room, room + n, room + 2 * n, room + 3 * n, room + 4 * n, room + 5 * n, n, 0.0, 0.0, 0.0};
    for (long i = 0; i < n; i++)
        tail.z_mean += out->z[from + i] / (double)n;
    for (long i = 0; i < n; i++) {
        tail.x[i] = out->z[from + i] - tail.z_mean;
        tail.force[i] = out->over[from + i];
    }
    return nt_curve_line(&tail);
}

/* The baseline of what lies beyond the last rupture: its own line where it is long or shows a tilt of its own, else its
 * level with the approach's tilt. */
static nt_curve_baseline over_tail(const outside *out, long from, nt_curve_reading *reading, double *room)
{
    const nt_curve_baseline *approach = &reading->approach.baseline;
    const nt_curve_baseline line = tail_line(out, from, room);
    const double n = (double)(out->count - from), travel = out->z[out->count - 1] - out->z[0];
    const double known = approach->noise.flicker + approach->noise.white / n; /* a longer record than the tail */
    nt_curve_baseline found = beside(approach, line.z_mean, line.force, fmax(line.force_variance, known));
    found.scatter = line.scatter;
    reading->support = NT_CURVE_SHARED;
    const double length = (out->z[out->count - 1] - out->z[from]) / travel;
    const double doubt = sqrt(line.slope_variance + approach->slope_variance);
    if (length < own_tilt || (length < far_part && fabs(line.slope) < contradiction * doubt))
        return found;
    found.slope += line.slope;
    found.slope_variance = line.slope_variance;
    reading->support = NT_CURVE_TAIL;
    return found;
}

/* The offset of a baseline below the approach's at the middle of its points, and the variance of that. */
static void compare(const nt_curve_baseline *baseline, nt_curve_reading *reading)
{
    const nt_curve_baseline *approach = &reading->approach.baseline;
    const double z = baseline->z_mean, sigma = nt_curve_baseline_sigma(approach, z);
    const double line = approach->force + approach->slope * (z - approach->z_mean); /* waves are common to both */
    reading->offset = line - baseline->force;
    reading->offset_sigma = sqrt(sigma * sigma + baseline->force_variance);
}

/* The approach less the middle of what drag can be, where nothing is free. */
static nt_curve_baseline bound(const nt_curve *curve, double most, const nt_curve_reading *reading)
{
    const nt_curve_baseline *approach = &reading->approach.baseline;
    const double width = most - curve->least_drag, middle = curve->least_drag + 0.5 * width;
    return beside(approach, approach->z_mean, -middle, approach->force_variance + width * width / 12.0);
}

/* How much the force grew between samples where the lowest point was torn off: no sample shows the last of it. */
static double growth(const outside *out, const nt_curve_reading *reading)
{
    const long lowest = reading->retract.lowest - (reading->retract.count - out->count);
    for (int row = 0; row < reading->ruptures; row++) {
        const long last = out->after[row] - 1;
        if (last >= LEAST_WIDTH && last - lowest <= LEAST_WIDTH && lowest - last <= LEAST_WIDTH &&
            reading->retract.dips)
            return fmax(out->over[last - LEAST_WIDTH] - out->over[last], 0.0) / LEAST_WIDTH;
    }
    return 0.0;
}

static void widen(const nt_curve *curve, double most, double unseen, nt_curve_reading *reading)
{
    nt_curve_measured *dip = &reading->retract.dip;
    const double width = most - curve->least_drag, offset = reading->offset;
    double below = 0.0, above = 0.0;
    reading->pull_off_sigma = dip->sigma;
    if (reading->support == NT_CURVE_BOUND) {
        below = fmin(0.5 * width, dip->value);
        above = 0.5 * width;
        reading->pull_off_sigma = sqrt(fmax(dip->sigma * dip->sigma - width * width / 12.0, 0.0));
    } else if (offset > curve->least_drag + contradiction * reading->offset_sigma || reading->retract.dips) {
        above = fmax(offset - curve->least_drag, 0.0);
        dip->sigma = hypotenuse(dip->sigma, above / sqrt(12.0));
    }
    reading->pull_off_least = dip->value - below;
    reading->pull_off_most = dip->value + above + unseen;
}

/* What a squeeze film adds to the depth: taken off where the free retraction shows it too, else left open. */
static void take_off_film(const outside *out, long free, nt_curve_reading *reading)
{
    nt_curve_branch *retract = &reading->retract;
    nt_curve_measured *dip = &retract->dip;
    const nt_curve_film none = {0}, film = dip->value > 0.0 ? nt_curve_find_film(&reading->approach) : none;
    if (!(film.strength > 0.0))
        return;
    const double z = retract->z[retract->lowest], there = fmin(nt_curve_film_at(&film, z), dip->value);
    const double doubt = there * film.sigma / film.strength;
    reading->pull_off_least = fmax(reading->pull_off_least - there - 2.0 * doubt, 0.0);
    if (!nt_curve_film_is_odd(&film, out->z, out->over, out->count, free ? out->z[free] : out->z[0])) {
        dip->sigma = hypotenuse(dip->sigma, there / sqrt(12.0));
        return;
    }
    dip->value -= there;
    dip->sigma = hypotenuse(dip->sigma, doubt);
    reading->pull_off_sigma = hypotenuse(reading->pull_off_sigma, doubt);
    if (dip->value < retract->visible) {
        dip->value = 0.0;
        retract->dips = 0;
    }
}

/* Whether all points of the retraction's own baseline lie beyond the last rupture. */
static int is_free(const nt_curve_baseline *own, const outside *out, long free)
{
    return free == 0 || out->z[free] < own->nearest;
}

void nt_curve_join(const nt_curve *curve, double *room, nt_curve_reading *reading)
{
    nt_curve_branch *retract = &reading->retract;
    const long n = retract->count; /* room: 4 n for nt_curve_read_events, n for the force outside, 5 n for its tail */
    outside out = outside_contact(reading, room + 4 * n);
    nt_curve_baseline baseline = retract->baseline;
    if (out.count < NT_CURVE_FEWEST)
        return;
    const long free = find_ruptures(&out, &reading->approach, reading), count = out.count - free;
    reading->support = NT_CURVE_TAIL;
    const int own = is_free(&baseline, &out, free);
    if (!own && count >= NT_CURVE_FEWEST)
        baseline = over_tail(&out, free + count / 20, reading, room + 5 * n);
    compare(&baseline, reading);
    const double offset = fmax(reading->offset, curve->least_drag); /* all of it drag, where that is unknown */
    const double most = curve->most_drag > 0.0 ? curve->most_drag : offset;
    if ((!own && count < NT_CURVE_FEWEST) || reading->offset > most + contradiction * reading->offset_sigma) {
        reading->support = NT_CURVE_BOUND;
        baseline = bound(curve, most, reading);
    }
    for (int i = 0; i < reading->ruptures; i++) {
        nt_curve_rupture *rupture = &reading->rupture[i];
        rupture->force +=
            nt_curve_baseline_at(&baseline, rupture->z) - nt_curve_baseline_at(&reading->approach.baseline, rupture->z);
    }
    if (!own || reading->support == NT_CURVE_BOUND) /* another baseline than it was read with */
        nt_curve_read_events(&curve->retract, &baseline, retract->noise, room - 2 * n, retract);
    refine_dip(&out, reading);
    widen(curve, most, growth(&out, reading), reading);
    take_off_film(&out, free, reading);
}
