/* SPDX-License-Identifier: BSD-3-Clause
 * Both branches together. What holds the tip on its way out (tethers, several necks) ends in ruptures: only what lies
 * beyond the last of them can be free. Where that is less than the far half, its level is taken with the approach's
 * tilt and wave; where its level is further below the approach than drag explains, nothing is free. */
#include "curves/joint.h"

#include <math.h>

#include "core/same_bits.h"
#include "curves/bend.h"
#include "curves/curves.h"
#include "curves/film.h"
#include "curves/line.h"
#include "curves/parts.h"
#include "curves/ruptures.h"
#include "internal/curves.h"

static const double deepest_of_many = 5.0; /* standard deviations that the lowest of many points may lie too low */
static const double far_part = 0.5;        /* of the travel: a tail as long is judged by itself */
static const double own_tilt = 0.25;       /* of the travel, from where a tail may show a tilt of its own (drift) */
static const double contradiction = 4.0;   /* standard deviations */
static const double no_line = 3.0;         /* times the approach's scatter: a line through contact scatters as much */
static const double plausible = 0.1;       /* likelihood of a squeeze film that counts */
static const double slow = 2.0;            /* times the visible force: drift makes no more of it */

/* The depth at the lowest point, which noise picks as too deep: by the rupture that ends its piece, or by the piece. */
static void refine_dip(const nt_curve_outside *out, nt_curve_reading *reading)
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
    const int torn = row < reading->ruptures && (out->after[row] - lowest <= NT_CURVE_MOST_WIDTH ||
                                                 out->piece[k].end >= out->after[row] - 2 * nt_curve_step_width(out));
    const double z = retract->z[retract->lowest];
    const double over =
        nt_curve_baseline_at(&retract->baseline, z) - nt_curve_baseline_at(&reading->approach.baseline, z);
    const long before = row ? out->after[row - 1] : 0;
    const long first = out->piece[k].first > before ? out->piece[k].first : before;
    const long limit = row < reading->ruptures ? out->after[row] : out->count;
    nt_curve_measured line = nt_curve_line_at(out, first, limit < out->piece[k].end ? limit : out->piece[k].end, z);
    if (isnan(line.value))
        line = nt_curve_line_at(out, lowest - NT_CURVE_MOST_WIDTH > before ? lowest - NT_CURVE_MOST_WIDTH : before,
                                lowest + NT_CURVE_MOST_WIDTH < limit ? lowest + NT_CURVE_MOST_WIDTH : limit, z);
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

/* The same baseline seen from another z. */
static nt_curve_baseline seen_from(const nt_curve_baseline *baseline, double z_mean)
{
    nt_curve_baseline found = *baseline;
    const double shift = z_mean - baseline->z_mean, bow = baseline->bend.bow;
    found.force += (baseline->slope + bow * shift) * shift;
    found.slope += 2.0 * bow * shift;
    found.wave = shifted(&baseline->wave, shift);
    found.z_mean = z_mean;
    return found;
}

/* The approach's baseline, `force` above it at z_mean, where its level is known to that variance. */
static nt_curve_baseline beside(const nt_curve_baseline *approach, double z_mean, double force, double variance)
{
    nt_curve_baseline found = seen_from(approach, z_mean);
    found.force += force;
    found.force_variance = variance;
    return found;
}

/* A line through the tail, over the approach's baseline. */
static nt_curve_baseline tail_line(const nt_curve_outside *out, long from, double *room)
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
static nt_curve_baseline over_tail(const nt_curve_outside *out, long from, nt_curve_reading *reading, double *room)
{
    const nt_curve_baseline *approach = &reading->approach.baseline;
    const nt_curve_baseline line = tail_line(out, from, room);
    const double n = (double)(out->count - from), travel = out->z[out->count - 1] - out->z[0];
    const double known = approach->noise.flicker + approach->noise.white / n; /* a longer record than the tail */
    nt_curve_baseline found = beside(approach, line.z_mean, line.force, fmax(line.force_variance, known));
    found.scatter = line.scatter;
    found.nearest = out->z[from];
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
    reading->offset = seen_from(approach, z).force - baseline->force; /* waves are common to both */
    reading->offset_sigma = sqrt(sigma * sigma + baseline->force_variance);
}

/* The approach less the middle of what drag can be, where nothing is free; below it by up to the tail's offset, where
 * that tail is a line as the approach's and the tip was torn off before: another tether that holds to the end looks the
 * same as a film or a step of the level. */
static nt_curve_baseline bound(const nt_curve *curve, double most, double below, const nt_curve_reading *reading)
{
    const nt_curve_baseline *approach = &reading->approach.baseline;
    const double width = most - curve->least_drag, middle = curve->least_drag + 0.5 * width;
    const double variance = width * width / 12.0 + below * below;
    return beside(approach, approach->z_mean, -middle, approach->force_variance + variance);
}

/* How much the force grew between samples where the lowest point was torn off: no sample shows the last of it. */
static double growth(const nt_curve_outside *out, const nt_curve_reading *reading)
{
    const long lowest = reading->retract.lowest - (reading->retract.count - out->count);
    for (int row = 0; row < reading->ruptures; row++) {
        const long last = out->after[row] - 1;
        if (last >= NT_CURVE_LEAST_WIDTH && last - lowest <= NT_CURVE_LEAST_WIDTH &&
            lowest - last <= NT_CURVE_LEAST_WIDTH && reading->retract.dips)
            return fmax(out->over[last - NT_CURVE_LEAST_WIDTH] - out->over[last], 0.0) / NT_CURVE_LEAST_WIDTH;
    }
    return 0.0;
}

static void widen(const nt_curve *curve, double most, double offset_below, double unseen, nt_curve_reading *reading)
{
    nt_curve_measured *dip = &reading->retract.dip;
    const double width = most - curve->least_drag, offset = reading->offset;
    double below = 0.0, above = 0.0;
    reading->pull_off_sigma = dip->sigma;
    if (reading->support == NT_CURVE_BOUND) {
        const double open = width * width / 12.0 + offset_below * offset_below;
        below = fmin(fmax(0.5 * width, offset_below), dip->value);
        above = 0.5 * width;
        reading->pull_off_sigma = sqrt(fmax(dip->sigma * dip->sigma - open, 0.0));
    } else if (offset > curve->least_drag + contradiction * reading->offset_sigma || reading->retract.dips) {
        above = fmax(offset - curve->least_drag, 0.0);
        dip->sigma = hypotenuse(dip->sigma, above / sqrt(12.0));
    }
    reading->pull_off_least = dip->value - below;
    reading->pull_off_most = dip->value + above + unseen;
}

/* By how much a bow of size 1 lowers the pull-off, over a baseline that it bent too [m^2]. */
static double lowered_by_bow(const nt_curve_bend_doubts *doubts, const nt_curve_reading *reading)
{
    const nt_curve_branch *retract = &reading->retract;
    const nt_curve_baseline *baseline = &retract->baseline;
    const double z = retract->z[retract->lowest], there = z - doubts->middle, level = baseline->z_mean - doubts->middle;
    if (reading->support == NT_CURVE_BOUND)
        return there * there - doubts->half * doubts->half / 3.0;
    if (reading->support == NT_CURVE_SHARED)
        return there * there - level * level; /* the approach's tilt */
    const double half = 0.5 * (retract->z[retract->count - 1] - baseline->nearest), away = z - baseline->z_mean;
    return away * away - half * half / 3.0;
}

/* A bow that is not known well leaves the pull-off as uncertain; it may be a film instead where that is likely. */
static void doubt_bow(const nt_curve_bend_doubts *doubts, nt_curve_reading *reading)
{
    const double lowered = lowered_by_bow(doubts, reading), doubt = doubts->bow_sigma * lowered;
    if (doubts->film > plausible)
        reading->pull_off_least -= fmax(reading->retract.baseline.bend.bow * lowered, 0.0);
    reading->pull_off_sigma = hypotenuse(reading->pull_off_sigma, doubt);
    reading->retract.dip.sigma = hypotenuse(reading->retract.dip.sigma, doubt);
}

/* What a squeeze film adds to the depth: taken off where the free retraction shows it too, else left open. */
static void take_off_film(const nt_curve_outside *out, double sigma, nt_curve_reading *reading)
{
    nt_curve_branch *retract = &reading->retract;
    nt_curve_measured *dip = &retract->dip;
    const nt_curve_bend *film = &reading->approach.baseline.bend;
    if (film->film == 0.0 || !retract->dips)
        return;
    const double there = fmin(nt_curve_film_at(film, retract->z[retract->lowest]), dip->value);
    const double doubt = there * sigma / nt_curve_film_at(film, film->nearest);
    reading->pull_off_least -= there + 2.0 * doubt;
    if (!nt_curve_film_is_odd(film, out->z, out->over, out->count, out->z[out->free])) {
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

/* A hold whose force declines slowly until it tears may be a constant one over drift. */
static void doubt_decline(const nt_curve_outside *out, nt_curve_reading *reading)
{
    const nt_curve_branch *retract = &reading->retract;
    const long lowest = retract->lowest - (retract->count - out->count);
    int row = 0;
    while (row < reading->ruptures && out->after[row] <= lowest)
        row++;
    if (row == reading->ruptures || !retract->dips)
        return;
    const double torn = reading->rupture[row].force, decline = retract->dip.value - torn;
    if (decline > 0.0 && decline < slow * reading->approach.visible)
        reading->pull_off_least = fmin(reading->pull_off_least, torn);
}

/* What the interval of the pull-off has to hold besides the baseline's offset. */
static void leave_open(const nt_curve_outside *out, const nt_curve_bend_doubts *doubts, nt_curve_reading *reading)
{
    nt_curve_measured *dip = &reading->retract.dip;
    const double before = reading->pull_off_least, depth = dip->value;
    doubt_decline(out, reading);
    take_off_film(out, doubts->film_sigma, reading);
    doubt_bow(doubts, reading);
    if (reading->retract.dips) {
        const int judged = doubts->half > 0.0 || !(doubts->film > 0.0); /* else too little is free to say */
        const double held = nt_curve_held_beyond_film(depth, judged ? 0.0 : reading->approach.visible, reading);
        reading->pull_off_least = fmin(reading->pull_off_least, held);
    }
    reading->pull_off_least = reading->retract.dips ? fmax(reading->pull_off_least, 0.0) : 0.0;
    dip->sigma = hypotenuse(dip->sigma, (before - reading->pull_off_least) / sqrt(12.0));
}

/* Whether all points of the retraction's own baseline lie beyond the last rupture, and are a line as the approach's. */
static int is_free(const nt_curve_baseline *own, const nt_curve_outside *out)
{
    return (out->free == 0 || out->z[out->free] < own->nearest) &&
           !(own->scatter > no_line * fmax(out->straight.scatter, out->noise));
}

/* Finds what the retraction's baseline rests on, and reads its events over the best there is. */
static void join(const nt_curve *curve, const nt_curve_outside *out, double *room, nt_curve_reading *reading)
{
    nt_curve_branch *retract = &reading->retract;
    const long n = retract->count; /* room: 4 n for nt_curve_read_events, 2 n for the force outside, 5 n for its tail */
    nt_curve_baseline baseline = retract->baseline;
    const long count = out->count - out->free;
    reading->support = NT_CURVE_TAIL;
    const int own = is_free(&baseline, out);
    if (!own && count >= NT_CURVE_FEWEST)
        baseline = over_tail(out, out->free + count / 20, reading, room + 6 * n);
    compare(&baseline, reading);
    const double offset = fmax(reading->offset, curve->least_drag); /* all of it drag, where that is unknown */
    const double most = curve->most_drag > 0.0 ? curve->most_drag : offset;
    double below = 0.0;
    if ((!own && count < NT_CURVE_FEWEST) || reading->offset > most + contradiction * reading->offset_sigma) {
        reading->support = NT_CURVE_BOUND;
        below = own && reading->ruptures ? fmax(offset - 0.5 * (most + curve->least_drag), 0.0) : 0.0;
        baseline = bound(curve, most, below, reading);
    }
    for (int i = 0; i < reading->ruptures; i++) {
        const double z = reading->rupture[i].z;
        reading->rupture[i].force += nt_curve_baseline_at(&baseline, z) - nt_curve_baseline_at(&out->straight, z);
    }
    if (!own || reading->support == NT_CURVE_BOUND) /* another baseline than it was read with */
        nt_curve_read_events(&curve->retract, &baseline, retract->noise, room - 2 * n, retract);
    refine_dip(out, reading);
    widen(curve, most, below, growth(out, reading), reading);
}

void nt_curve_join(const nt_curve *curve, const nt_curve_bend_doubts *doubts, nt_curve_outside *out, double *room,
                   nt_curve_reading *reading)
{
    double *film = &reading->approach.baseline.bend.film;
    const double strength = *film;
    if (out->count < NT_CURVE_FEWEST)
        return;
    *film = 0.0; /* on the retraction it has the other sign */
    nt_curve_renew_outside(out, reading);
    join(curve, out, room, reading);
    *film = strength;
    leave_open(out, doubts, reading);
}
