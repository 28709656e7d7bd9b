/* SPDX-License-Identifier: BSD-3-Clause
 * The slow flow of a tapping lever, and the averages of the force that it needs.
 *
 * Averages: over the way s = pi - psi from the lowest point, where the gap is low + A cos(alpha) (1 - cos s). Gauss
 * points between the gaps where the force has a kink or jump (first touch, capture, release) and, for forces that fall
 * with the gap, in shells that grow by 4. Down and up differ between capture and release alone. The loss is not
 * integrated: jumps lose what their law says, and the damping of the contact has the area of its own loop.
 *
 * Strang's splitting: the free lever is exact (Z - Z_free turns and decays), and with the lever held the force turns Z
 * by fc/(2 r |Z|), which does not change fc, and shortens it by fs/(2 r). */
#include <math.h>
#include <stddef.h>

#include "core/same_bits.h"
#include "edges.h"
#include "internal/tapping.h"
#include "nanotouch/advanced/tapping.h"
#include "nanotouch/material.h"
#include "scan/flow.h"
#include "scene/parts.h"

#define SETTLED 1e-9  /* change per radian over A0 and 1/Q */
#define NARROW 20e-12 /* width of a cell in the gap [m] */
#define CELLS 50.0    /* of the free amplitude */
#define ALIKE 0.03    /* radii of places in a cell, relative */
#define LONGEST 0.25  /* step, over sqrt(Q) periods of the drive: longer ones ring on hard samples */
#define TURN 0.05     /* of the lag by the force in one step [rad] */
enum { PATIENCE = 60, HALVINGS = 8 };

typedef struct swing {
    const nt_tapping *lever;
    const nt_tapping_over *over;
    double amplitude, low, top; /* A of q, gaps [m] */
    int before, after;          /* attached on the way down before capture, and on the way up before release */
} swing;

static double angle_at(const swing *w, double gap)
{
    const double c = 1.0 - (gap - w->low) / (0.5 * (w->top - w->low));
    return acos(fmax(-1.0, fmin(1.0, c)));
}

static nt_law_value law_at(const swing *w, int attached, double gap)
{
    const nt_interaction_state history = {attached, 0.0, 0.0};
    return nt_interaction_eval_gap(w->over->plan, &history, w->over->place, gap);
}

/* Adds the forces between two angles; down and up are one where the history does not matter. */
static void add_segment(const swing *w, double from, double to, nt_flow_average *sum)
{
    const nt_tapping *lever = w->lever;
    const double k = lever->spring_constant, half = 0.5 * (w->top - w->low);
    const double drag = 2.0 * lever->viscosity * lever->cosine * lever->rate * lever->ratio * w->amplitude;
    for (int i = 0; i < POINTS; i++) {
        const double s = from + points[i] * (to - from), c = cos(s), gap = w->low + half * (1.0 - c);
        const double weight = weights[i] * (to - from) / NT_PI;
        const nt_law_value up = law_at(w, w->after, gap);
        const double down = w->before == w->after ? up.F : law_at(w, w->before, gap).F;
        sum->cosine -= weight * c * (down + up.F) / k;
        sum->mean += 0.5 * weight * (down + up.F) / k;
        if (drag > 0.0)
            sum->sine += 2.0 * weight * drag * up.a * sin(s) * sin(s) / k;
    }
}

/* Where the lever swings over a place. */
static double middle_of(const nt_tapping *lever, const nt_flow_state *state, const nt_tapping_over *over)
{
    const double ground = over->base_height - (over->place != NULL ? over->place->surface.z : 0.0);
    return ground + lever->cosine * state->mean;
}

nt_flow_average nt_flow_average_at(const nt_tapping *lever, const nt_tapping_over *over, int attached, double amplitude,
                                   double low)
{
    nt_interaction_state history = {attached, 0.0, 0.0};
    swing w = {lever, over, amplitude, low, low + 2.0 * lever->cosine * amplitude, attached, 0};
    nt_interaction_advance_gap(over->plan, &history, over->place, w.low);
    w.after = history.attached;
    nt_interaction_advance_gap(over->plan, &history, over->place, w.top);
    nt_flow_average sum = {.low = w.low, .attached = history.attached};
    const nt_edges edges = nt_edges_of(over, w.low, w.top, w.after);
    double from = 0.0;
    for (int i = 0; i < edges.count; i++) {
        const double to = i == edges.count - 1 ? NT_PI : angle_at(&w, edges.at[i]);
        add_segment(&w, from, to, &sum);
        from = to;
    }
    const double jumps = history.dissipated / lever->cosine;
    sum.sine += jumps / (NT_PI * lever->spring_constant * amplitude);
    sum.loss = NT_PI * lever->spring_constant * amplitude * sum.sine;
    sum.peak = fmax(law_at(&w, w.after, w.low).F, law_at(&w, w.before, w.top).F);
    return sum;
}

static double broad(const nt_tapping *lever)
{
    return lever->free_amplitude / CELLS;
}

/* Makes the cell around a place of the plane; 0 where there may be none. */
static int make_cell(const nt_tapping *lever, const nt_tapping_over *over, double amplitude, double low,
                     nt_flow_cell *cell)
{
    const double width = broad(lever), capture = nt_plan_capture_gap(over->plan, over->place);
    nt_place blunter = {0};
    if (over->place != NULL)
        blunter = *over->place;
    nt_flow_cell made = {.low = NARROW * floor(low / NARROW),
                         .amplitude = width * floor(amplitude / width),
                         .radius = blunter.radius.radius,
                         .is_made = 1};
    blunter.radius.radius *= 1.0 + ALIKE;
    const nt_tapping_over there = {over->plan, over->place != NULL ? &blunter : NULL, over->base_height};
    cell->is_made = 0;
    if (made.amplitude < width || (made.low <= capture && capture <= made.low + NARROW))
        return 0;
    for (int i = 0; i < 5; i++) {
        const double A = made.amplitude + (i % 4 / 2) * width, at = made.low + (i % 2) * NARROW;
        made.corner[i] = nt_flow_average_at(lever, i < 4 ? over : &there, 0, A, at);
        if (made.corner[i].attached)
            return 0;
    }
    *cell = made;
    return 1;
}

/* A place in a cell: shares of its widths, and of the larger radius. */
typedef struct in_cell {
    double low, amplitude, radius;
} in_cell;

static double between(const nt_flow_cell *cell, const in_cell *in, size_t offset)
{
    double at[5];
    for (int i = 0; i < 5; i++)
        at[i] = *(const double *)(const void *)((const char *)&cell->corner[i] + offset);
    const double x = in->low, y = in->amplitude;
    const double flat = (1.0 - y) * ((1.0 - x) * at[0] + x * at[1]) + y * ((1.0 - x) * at[2] + x * at[3]);
    return flat + in->radius * (at[4] - at[0]);
}

/* Where it is in a cell; 0 beyond it. */
static int find_in(const nt_tapping *lever, const nt_flow_cell *cell, double radius, double low, double amplitude,
                   in_cell *in)
{
    in->low = (low - cell->low) / NARROW;
    in->amplitude = (amplitude - cell->amplitude) / broad(lever);
    in->radius = radius > 0.0 ? (radius / cell->radius - 1.0) / ALIKE : 0.0;
    return cell->is_made && in->low >= 0.0 && in->low < 1.0 && in->amplitude >= 0.0 && in->amplitude < 1.0 &&
           fabs(in->radius) <= 1.0;
}

static nt_flow_cell *cell_at(const nt_tapping *lever, nt_flow_table *table, double low, double amplitude)
{
    const long i = (long)floor(low / NARROW), j = (long)floor(amplitude / broad(lever));
    return &table->cell[(i & 15) + 16 * (j & 3)];
}

/* The average by a cell, which is made where it is not there; else by itself. */
static nt_flow_average average_in(const nt_tapping *lever, const nt_flow_state *state, const nt_tapping_over *over,
                                  double amplitude, nt_flow_table *table)
{
    const double low = middle_of(lever, state, over) - lever->cosine * amplitude;
    if (table == NULL || state->attached || over->plan->properties != NULL || !(fabs(low) < 1e-3))
        return nt_flow_average_at(lever, over, state->attached, amplitude, low);
    const double radius = over->place != NULL ? over->place->radius.radius : 0.0;
    nt_flow_cell *cell = cell_at(lever, table, low, amplitude);
    in_cell in;
    if (!find_in(lever, cell, radius, low, amplitude, &in)) {
        if (!make_cell(lever, over, amplitude, low, cell))
            return nt_flow_average_at(lever, over, 0, amplitude, low);
        find_in(lever, cell, radius, low, amplitude, &in);
    }
    return (nt_flow_average){.cosine = between(cell, &in, offsetof(nt_flow_average, cosine)),
                             .sine = between(cell, &in, offsetof(nt_flow_average, sine)),
                             .mean = between(cell, &in, offsetof(nt_flow_average, mean)),
                             .low = low,
                             .peak = between(cell, &in, offsetof(nt_flow_average, peak)),
                             .loss = between(cell, &in, offsetof(nt_flow_average, loss))};
}

nt_flow_state nt_flow_free(const nt_tapping *tapping)
{
    const double r = tapping->ratio, real = 1.0 - r * r, imaginary = r / tapping->quality;
    const double square = real * real + imaginary * imaginary;
    return (nt_flow_state){.real = tapping->strength * real / square,
                           .imaginary = -tapping->strength * imaginary / square};
}

static nt_flow_value value_of(const nt_tapping *lever, const nt_flow_state *state, const nt_flow_average *sum)
{
    const double real = state->real - (lever->at_base ? lever->strength : 0.0);
    const double amplitude = hypotenuse(state->real, state->imaginary);
    return (nt_flow_value){.amplitude = hypotenuse(real, state->imaginary),
                           .phase = atan2(-state->imaginary, real),
                           .mean = sum->mean,
                           .peak_force = sum->peak,
                           .lowest_gap = sum->low,
                           .virial = 0.5 * lever->spring_constant * amplitude * sum->cosine,
                           .tip_loss = sum->loss};
}

/* Z - Z_free turns and decays by exp(i (1 - r^2 + i r/Q) t/(2 r)). */
static void swing_freely(const nt_tapping *lever, nt_flow_state *state, double t)
{
    const double r = lever->ratio, turn = 0.5 * (1.0 - r * r) / r * t, decay = exp(-0.5 * t / lever->quality);
    const nt_flow_state free = nt_flow_free(lever);
    const double x = state->real - free.real, y = state->imaginary - free.imaginary, c = cos(turn), s = sin(turn);
    state->real = free.real + decay * (c * x - s * y);
    state->imaginary = free.imaginary + decay * (s * x + c * y);
}

/* One step; 0 where the force would turn the lag too far, with the state as it was. */
static int step_by(const nt_tapping *lever, nt_flow_state *state, const nt_tapping_over *over, double t,
                   nt_flow_table *table, double most, nt_flow_value *value)
{
    nt_flow_state next = *state;
    swing_freely(lever, &next, 0.5 * t);
    const double r = lever->ratio, amplitude = hypotenuse(next.real, next.imaginary);
    const nt_flow_average sum = average_in(lever, &next, over, amplitude, table);
    /* Z' = -i/(2 r) (fc - i fs) Z/|Z| */
    const double turn = -0.5 * sum.cosine / (r * amplitude) * t, c = cos(turn), s = sin(turn);
    if (fabs(turn) > most)
        return 0;
    next.mean -= expm1(-0.5 * t / lever->quality) * (sum.mean - next.mean); /* rings down as Z does */
    next.attached = sum.attached;
    const double shrunk = fmax(0.0, 1.0 - 0.5 * sum.sine / (r * amplitude) * t);
    const double x = next.real, y = next.imaginary;
    nt_flow_state middle = next; /* of the kick: a value before it would be of first order in t */
    const double mean = 0.5 * (1.0 + shrunk), half = sqrt(0.5 * (1.0 + c)), other = 0.5 * s / half;
    middle.real = mean * (half * x - other * y);
    middle.imaginary = mean * (other * x + half * y);
    *value = value_of(lever, &middle, &sum);
    next.real = shrunk * (c * x - s * y);
    next.imaginary = shrunk * (s * x + c * y);
    swing_freely(lever, &next, 0.5 * t);
    *state = next;
    return 1;
}

nt_flow_value nt_flow_step(const nt_tapping *tapping, nt_flow_state *state, const nt_tapping_over *over, double time)
{
    return nt_flow_step_in(tapping, state, over, time, NULL);
}

nt_flow_value nt_flow_step_in(const nt_tapping *tapping, nt_flow_state *state, const nt_tapping_over *over, double time,
                              nt_flow_table *table)
{
    const double t = tapping->rate * time;
    nt_flow_value value = {0}, now;
    double peak = -HUGE_VAL;
    int parts = 1; /* of the time, each as long as what is left of it allows */
    for (int done = 0; done < parts;) {
        const double most = parts < 1 << HALVINGS ? TURN : HUGE_VAL;
        if (step_by(tapping, state, over, t / parts, table, most, &now)) {
            value = now;
            peak = fmax(peak, now.peak_force);
            done++;
        } else {
            parts *= 2;
            done *= 2;
        }
    }
    value.peak_force = peak;
    return value;
}

int nt_flow_steps(const nt_tapping *tapping, double time)
{
    const double periods = time * tapping->ratio * tapping->rate / (2.0 * NT_PI);
    return (int)ceil(fmax(1.0, periods / (LONGEST * sqrt(tapping->quality))));
}

nt_status nt_flow_settle(const nt_tapping *tapping, nt_flow_state *state, const nt_tapping_over *over,
                         nt_flow_value *value, nt_solve_info *info)
{
    if (tapping == NULL || state == NULL || over == NULL || over->plan == NULL || value == NULL)
        return NT_E_ARGUMENT;
    const double period = 2.0 * NT_PI / (tapping->ratio * tapping->rate), step = 2.0 * period;
    const long most = (long)(PATIENCE * tapping->quality / 2.0);
    const double still = SETTLED * tapping->free_amplitude * tapping->rate * step / tapping->quality;
    double change = HUGE_VAL;
    long n = 0;
    for (; n < most && change > still; n++) {
        const nt_flow_state before = *state;
        *value = nt_flow_step(tapping, state, over, step);
        change = hypotenuse(hypotenuse(state->real - before.real, state->imaginary - before.imaginary),
                            state->mean - before.mean);
        if (!isfinite(change))
            return NT_E_NOT_FINITE;
    }
    if (info != NULL)
        *info = (nt_solve_info){(int)n, change / tapping->free_amplitude};
    return change > still ? NT_E_NO_CONVERGENCE : NT_OK;
}
