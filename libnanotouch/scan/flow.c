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

#include "nanotouch/flow.h"
#include "nanotouch/material.h"

#define NEAREST 0.25e-9 /* thickness of the first shell [m] */
#define GROWTH 4.0
#define SETTLED 1e-9 /* change per radian over A0 and 1/Q */
enum { POINTS = 5, EDGES_MAX = 12, PATIENCE = 60 };

static const double points[POINTS] = {0.04691007703066800, 0.23076534494715845, 0.5, 0.76923465505284155,
                                      0.95308992296933200};
static const double weights[POINTS] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                       0.23931433524968324, 0.11846344252809454};

/* What the force does in a period of amplitude A. */
typedef struct average {
    double cosine; /* fc [m] */
    double sine;   /* fs [m] */
    double mean;   /* <F>/k [m] */
    double low;    /* gap [m] */
    double peak;   /* [N] */
    double loss;   /* [J] */
    int attached;  /* at the top, afterwards */
} average;

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

static void add_edge(double *edges, int *count, const swing *w, double gap)
{
    if (gap <= w->low || gap >= w->top || *count == EDGES_MAX)
        return;
    int i = (*count)++;
    for (; i > 0 && edges[i - 1] > gap; i--)
        edges[i] = edges[i - 1];
    edges[i] = gap;
}

/* Gaps between which the force is smooth, the top last. */
static int edges_of(const swing *w, double edges[EDGES_MAX + 1])
{
    const nt_plan *plan = w->over->plan;
    int count = 0;
    add_edge(edges, &count, w, 0.0);
    if (isfinite(plan->capture_gap))
        add_edge(edges, &count, w, plan->capture_gap);
    if (w->after && isfinite(plan->release_gap))
        add_edge(edges, &count, w, plan->release_gap);
    const double start = fmax(w->low, 0.0);
    for (double shell = NEAREST; count < EDGES_MAX && start + shell < 0.7 * w->top; shell *= GROWTH)
        add_edge(edges, &count, w, start + shell);
    edges[count++] = w->top;
    return count;
}

static nt_law_value law_at(const swing *w, int attached, double gap)
{
    const nt_interaction_state history = {attached, 0.0, 0.0};
    return nt_interaction_eval_gap(w->over->plan, &history, w->over->place, gap);
}

/* Adds the forces between two angles; down and up are one where the history does not matter. */
static void add_segment(const swing *w, double from, double to, average *sum)
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

static average average_of(const nt_tapping *lever, const nt_flow_state *state, const nt_tapping_over *over,
                          double amplitude)
{
    const double ground = over->base_height - (over->place != NULL ? over->place->surface.z : 0.0);
    const double middle = ground + lever->cosine * state->mean, reach = lever->cosine * amplitude;
    nt_interaction_state history = {state->attached, 0.0, 0.0};
    swing w = {lever, over, amplitude, middle - reach, middle + reach, state->attached, 0};
    nt_interaction_advance_gap(over->plan, &history, over->place, w.low);
    w.after = history.attached;
    nt_interaction_advance_gap(over->plan, &history, over->place, w.top);
    average sum = {.low = w.low, .attached = history.attached};
    double edges[EDGES_MAX + 1], from = 0.0;
    const int count = edges_of(&w, edges);
    for (int i = 0; i < count; i++) {
        const double to = i == count - 1 ? NT_PI : angle_at(&w, edges[i]);
        add_segment(&w, from, to, &sum);
        from = to;
    }
    const double jumps = history.dissipated / lever->cosine;
    sum.sine += jumps / (NT_PI * lever->spring_constant * amplitude);
    sum.loss = NT_PI * lever->spring_constant * amplitude * sum.sine;
    sum.peak = fmax(law_at(&w, w.after, w.low).F, law_at(&w, w.before, w.top).F);
    return sum;
}

nt_flow_state nt_flow_free(const nt_tapping *tapping)
{
    const double r = tapping->ratio, real = 1.0 - r * r, imaginary = r / tapping->quality;
    const double square = real * real + imaginary * imaginary;
    return (nt_flow_state){.real = tapping->strength * real / square,
                           .imaginary = -tapping->strength * imaginary / square};
}

static nt_flow_value value_of(const nt_tapping *lever, const nt_flow_state *state, const average *sum)
{
    const double real = state->real - (lever->at_base ? lever->strength : 0.0);
    const double amplitude = hypot(state->real, state->imaginary);
    return (nt_flow_value){.amplitude = hypot(real, state->imaginary),
                           .phase = atan2(-state->imaginary, real),
                           .mean = sum->mean,
                           .peak_force = sum->peak,
                           .lowest_gap = sum->low,
                           .virial = 0.5 * lever->spring_constant * amplitude * sum->cosine,
                           .tip_loss = sum->loss};
}

nt_flow_value nt_flow_now(const nt_tapping *tapping, const nt_flow_state *state, const nt_tapping_over *over)
{
    const average sum = average_of(tapping, state, over, hypot(state->real, state->imaginary));
    return value_of(tapping, state, &sum);
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

nt_flow_value nt_flow_step(const nt_tapping *tapping, nt_flow_state *state, const nt_tapping_over *over, double time)
{
    const double t = tapping->rate * time, r = tapping->ratio;
    swing_freely(tapping, state, 0.5 * t);
    const double amplitude = hypot(state->real, state->imaginary);
    const average sum = average_of(tapping, state, over, amplitude);
    state->mean = sum.mean;
    state->attached = sum.attached;
    const nt_flow_value value = value_of(tapping, state, &sum);
    /* Z' = -i/(2 r) (fc - i fs) Z/|Z| */
    const double turn = -0.5 * sum.cosine / (r * amplitude) * t, c = cos(turn), s = sin(turn);
    const double shrunk = fmax(0.0, 1.0 - 0.5 * sum.sine / (r * amplitude) * t);
    const double x = state->real, y = state->imaginary;
    state->real = shrunk * (c * x - s * y);
    state->imaginary = shrunk * (s * x + c * y);
    swing_freely(tapping, state, 0.5 * t);
    return value;
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
        change = hypot(state->real - before.real, state->imaginary - before.imaginary);
        if (!isfinite(change))
            return NT_E_NOT_FINITE;
    }
    if (info != NULL)
        *info = (nt_solve_info){(int)n, change / tapping->free_amplitude};
    return change > still ? NT_E_NO_CONVERGENCE : NT_OK;
}
