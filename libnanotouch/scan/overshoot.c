/* SPDX-License-Identifier: BSD-3-Clause
 * How hard a tapping lever may hit on its way from one motion to another.
 *
 * Of tapping.h, with g = -fc [m] (repulsion above 0), u the depth of the lowest point along q, and phi the lag of q:
 *     2 r A' = D sin(phi) - r A/Q - fs,    2 r A phi' = -g + D cos(phi) - (1 - r^2) A,    u' = A' + v/w0,
 * v the speed at which base and sample come together. The product g u' gives for a way that goes deeper throughout
 *     integral of g du <= A integral of (D sin(phi) + 2 r v/w0 - r A/Q)(-dphi) + D cos(phi) u + (r^2 - 1) A u:
 * the lag falls from where attraction ends to where the bracket is 0. A loss fs only takes from it. So the depth has a
 * largest value, and with it the force. Nor does the lag begin beyond where D cos(phi) = -(largest attraction) + (1 -
 * r^2) A, as there phi' <= 0, or where the bracket is 0. */
#include <math.h>
#include <stddef.h>

#include "internal/scan.h"
#include "nanotouch/advanced/scan.h"
#include "nanotouch/material.h"
#include "scan/flow.h"

#define OUTSIDE 20e-9 /* gap where the way begins: repulsion farther out is weak [m] */
#define FINE 0.02e-9  /* step of the way near the surface [m] */
enum { SWINGS = 24, STEPS = 4000 };

/* One swing over a place. */
typedef struct fall {
    const nt_scanner *scanner;
    const nt_tapping_over *over;
    const nt_relief *relief;
    double amplitude; /* A of q [m] */
    double least;     /* that the loop lets it fall to [m] */
} fall;

/* From what the lever does to what the stage does [s]. */
static double delay_of(const nt_scanner *s)
{
    return s->scan.zloop.lock_in + s->period + 1.0 / (2.0 * NT_PI * s->stage.stage.resonance * s->stage.stage.quality);
}

/* How fast base and sample come together [m/s]: the sample rises, and the loop lowers the base where it reads too much.
 */
static double approach_of(const fall *f, double first)
{
    const nt_scanner *s = f->scanner;
    const nt_zloop *loop = &s->scan.zloop;
    const double A0 = s->lever.free_amplitude, q = s->stage.stage.quality, K = s->integral;
    const double beyond = q > 0.5 ? 1.0 + exp(-NT_PI / sqrt(4.0 * q * q - 1.0)) : 1.0; /* of the stage's speed */
    double error = f->amplitude + delay_of(s) * f->relief->rise - loop->set_amplitude * A0;
    if (loop->mode == NT_ZLOOP_PHASE) /* the amplifier may still show where the lag was */
        error = A0 * (2.0 - sin(fmax(first, 0.5 * NT_PI)) - sin(loop->set_phase));
    return f->relief->rise + K * error * (error > 0.0 ? beyond : 1.0);
}

/* Where a lever comes from that is nowhere held by attraction: off the repulsive motion of the least amplitude, freely
 * along the chord Z0 + t (Z_free - Z0) until it has this one. */
static double lag_let_go(const fall *f, double loss)
{
    const nt_tapping *lever = &f->scanner->lever;
    const double A = f->amplitude, Q = lever->quality, D = lever->strength, A0 = D * Q;
    const double sine = (f->least / Q + loss) / D;
    if (sine >= 1.0 || A >= A0 || f->least >= A)
        return sine >= 1.0 ? NT_PI : asin(fmin(1.0, (A / Q + loss) / D));
    const double x = f->least * sqrt(1.0 - sine * sine), y = f->least * sine, dx = -x, dy = A0 - y;
    const double a = dx * dx + dy * dy, b = x * dx + y * dy, c = f->least * f->least - A * A;
    const double t = (-b + sqrt(b * b - a * c)) / a;
    return atan2(y + t * dy, x + t * dx);
}

/* What drive and approach may put into a tap that goes deeper and deeper, and how far a tick takes them together: in it
 * place and base stand still, and then they jump. */
typedef struct supply {
    double work;     /* at once [m^2], HUGE_VAL without an end */
    double by_depth; /* [m] */
    double jump;     /* [m] */
} supply;

static supply supply_of(const fall *f, double attraction, double loss)
{
    const nt_tapping *lever = &f->scanner->lever;
    const double r = lever->ratio, A = f->amplitude, D = lever->strength, share = r * A / lever->quality / D;
    const double least = (-attraction + fmin(0.0, 1.0 - r * r) * A) / D;
    double first = least > -1.0 ? acos(least) : NT_PI;
    if (fabs(r - 1.0) * lever->quality < 0.05 && attraction * attraction < D * D * (1.0 - share * share))
        first = fmin(first, lag_let_go(f, loss));
    const double speed = fmax(0.0, approach_of(f, first)), jump = speed * f->scanner->period;
    const double level = share - 2.0 * r * speed / (lever->rate * lever->cosine) / D; /* sin(phi) of the bracket's 0 */
    if (level <= -1.0)
        return (supply){HUGE_VAL, 0.0, jump};
    if (level >= 1.0 || first <= asin(level))
        return (supply){0.0, D, jump};
    const double end = asin(level), begin = fmin(first, NT_PI - end);
    return (supply){A * D * (cos(end) - cos(begin) - level * (begin - end)),
                    D * cos(fmax(0.0, end)) + fmax(0.0, r * r - 1.0) * A, jump};
}

/* The force at the greatest depth; HUGE_VAL where a tip that deep may stay in the sample, or no depth was the greatest.
 */
static double force_of(const fall *f)
{
    const nt_tapping *lever = &f->scanner->lever;
    double low = OUTSIDE, taken = 0.0, depth = 0.0, attraction = 0.0;
    supply may = {0.0, 0.0, 0.0};
    nt_flow_average now = nt_flow_average_at(lever, f->over, 0, f->amplitude, low);
    double before = -now.cosine;
    int ended = 0;
    for (int i = 0; i < STEPS && !ended; i++) {
        const double step = fmax(FINE, 0.05 * low), du = step / lever->cosine;
        low -= step;
        now = nt_flow_average_at(lever, f->over, now.attached, f->amplitude, low);
        const double g = -now.cosine;
        taken += 0.5 * (before + g) * du;
        depth += du;
        attraction = fmax(attraction, -g);
        before = g;
        if (taken <= 0.0) { /* attraction has not ended yet */
            taken = depth = 0.0;
            may = supply_of(f, attraction, now.sine);
        } else if (isinf(may.work))
            return HUGE_VAL;
        else
            ended = taken > may.work + may.by_depth * depth;
    }
    low -= may.jump;
    if (!ended || -low > lever->cosine * f->amplitude)
        return HUGE_VAL;
    return nt_flow_average_at(lever, f->over, now.attached, f->amplitude, low).peak;
}

double nt_scanner_peak_bound(const nt_scanner *scanner, const nt_place *place, const nt_relief *relief)
{
    const nt_tapping_over over = {scanner->plan, place, 0.0};
    const double largest = scanner->lever.strength * scanner->lever.quality / scanner->lever.ratio;
    const nt_zloop *loop = &scanner->scan.zloop;
    const double set = loop->mode == NT_ZLOOP_PHASE ? sin(loop->set_phase) : loop->set_amplitude;
    const double lag = fmin(relief->height, relief->rise * (1.0 / scanner->integral + delay_of(scanner)));
    const double least = set * scanner->lever.free_amplitude - lag;
    if (least <= 0.0) /* the lever may stop, and be pressed on */
        return HUGE_VAL;
    double most = -HUGE_VAL;
    for (int i = 0; i <= SWINGS; i++) { /* dense at the least ones, where a tip may stay in the sample */
        const double share = (double)i / SWINGS;
        const fall f = {scanner, &over, relief, least + (largest - least) * share * share, least};
        most = fmax(most, force_of(&f));
    }
    return most;
}
