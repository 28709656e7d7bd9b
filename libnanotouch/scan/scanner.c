/* SPDX-License-Identifier: BSD-3-Clause
 * One tick after the other: the place, the lever there, the reading, the loop, the stage. */
#include "internal/dynamics.h"
#include "internal/random.h"
#include "internal/scan.h"
#include "internal/tapping.h"
#include "nanotouch/advanced/scan.h"

#include <math.h>
#include <stddef.h>

#include "answer.h"
#include "core/problem.h"
#include "dynamics/dynamics.h"
#include "nanotouch/material.h"
#include "scan/flow.h"
#include "scan/scan.h"
#include "scene/interaction.h"

#define CLEARANCE 2e-9 /* above first touch where a scan begins to come down [m] */
#define ENGAGE 12.0    /* time constants of the loop until it holds */
enum { ENGAGE_TICKS_MAX = 2000000 };

static int is_tapping(const nt_scanner *s)
{
    return s->scan.zloop.mode != NT_ZLOOP_CONTACT;
}

/* Phase feedback takes 90 degrees for free: driven at the resonance, within a tenth of its width. */
static nt_status check_resonance(const nt_scanner *s, nt_problem *problem)
{
    const double width = 0.05 / s->lever.quality, f0 = s->probe.resonance;
    if (s->scan.zloop.mode != NT_ZLOOP_PHASE || fabs(s->lever.ratio - 1.0) <= width)
        return NT_OK;
    return nt_problem_set(problem, "drive.frequency", "Hz", s->lever.ratio * f0, (1.0 - width) * f0,
                          (1.0 + width) * f0);
}

static nt_status prepare(nt_scanner *made, const nt_scanner_inputs *in, nt_problem *problem)
{
    nt_status status = nt_scan_check(in->scan, problem);
    if (status == NT_OK)
        status = nt_rig_check(in->rig, problem);
    if (status == NT_OK && is_tapping(made))
        status = nt_tapping_init(&made->lever, &in->rig->probe, in->drive, 1e-9, problem);
    if (status == NT_OK && is_tapping(made))
        status = check_resonance(made, problem);
    if (status == NT_OK)
        status = nt_stage_model_init(&made->stage, &in->rig->stage, made->period);
    return status;
}

nt_status nt_scanner_init(nt_scanner *scanner, const nt_scanner_inputs *in, nt_problem *problem)
{
    if (scanner == NULL || in == NULL || in->scan == NULL || in->rig == NULL || in->plan == NULL)
        return NT_E_ARGUMENT;
    nt_scanner made = {.scan = *in->scan, .probe = in->rig->probe, .plan = in->plan};
    if (is_tapping(&made) && in->drive == NULL)
        return NT_E_ARGUMENT;
    made.period = 1.0 / made.scan.zloop.rate;
    const nt_status status = prepare(&made, in, problem);
    if (status != NT_OK)
        return status;
    if (is_tapping(&made))
        made.steps = nt_flow_steps(&made.lever, made.period);
    const nt_raster *raster = &made.scan.raster;
    made.ticks = lround(0.5 * made.scan.zloop.rate / raster->line_rate);
    if ((double)made.ticks < raster->pixels)
        return nt_problem_set(problem, "raster.line_rate", "Hz", raster->line_rate, 1e-3,
                              0.5 * made.scan.zloop.rate / raster->pixels);
    if (is_tapping(&made))
        nt_tap_answers(&made.lever, made.plan, &made.scan.zloop, made.answer);
    const double advised = nt_scanner_gain(&made);
    made.integral = made.scan.zloop.integral > 0.0 ? made.scan.zloop.integral : advised;
    const double most = made.integral * nt_scanner_margins(&made).gain;
    if (!(made.integral < most))
        return nt_problem_set(problem, "zloop.integral", "1/s", made.integral, 0.0, most);
    *scanner = made;
    return NT_OK;
}

/* The lever at rest over a place, as a field of its height. */
typedef struct grip {
    const nt_plan *plan;
    const nt_place *place;
    nt_interaction_state *contact;
} grip;

static nt_law_value grip_eval(void *context, double z)
{
    const grip *g = context;
    return nt_interaction_eval_gap(g->plan, g->contact, g->place, z - g->place->surface.z);
}

static void grip_advance(void *context, double z)
{
    const grip *g = context;
    nt_interaction_advance_gap(g->plan, g->contact, g->place, z - g->place->surface.z);
}

/* What a tick shows. */
typedef struct reading {
    double signal, error, phase, peak, lateral; /* [m], [m], [rad], [N], [N] */
} reading;

/* On the way up a stroke lags by this much: half the opening in the middle. */
static double play(double hysteresis, double stroke, double share)
{
    return 2.0 * hysteresis * stroke * share * (1.0 - share);
}

/* Also between two lines. */
static nt_pose pose_at(const nt_scanner *s, double line, double share, int back, double time)
{
    const nt_raster *raster = &s->scan.raster;
    const double along = (back ? 1.0 - share : share) - 0.5 / raster->pixels, across = line / raster->lines;
    const double lag = play(raster->hysteresis, raster->width, along);
    const double x = raster->x + along * raster->width + (back ? lag : -lag);
    const double y = raster->y + across * raster->height - play(raster->hysteresis, raster->height, across);
    return (nt_pose){x - raster->drift_x * time, y - raster->drift_y * time,
                     raster->tilt_x * x + raster->tilt_y * y + raster->drift * time};
}

nt_pose nt_scanner_at(const nt_scanner *scanner, long line, double share, int back, double time)
{
    return pose_at(scanner, (double)line, share, back, time);
}

/* The sample there, as the scanner holds it. */
static nt_place place_at(const nt_scanner *s, const nt_pose *at)
{
    nt_place place = nt_interaction_place(s->plan, at->x, at->y);
    place.surface.z += at->z;
    return place;
}

/* What the loop compares with its set point, both as an amplitude. */
static double lag_as_amplitude(const nt_scanner *s, double lag)
{
    const double A0 = s->lever.free_amplitude, sine = sin(lag);
    return lag <= 0.5 * NT_PI ? A0 * sine : A0 * (2.0 - sine);
}

static nt_status read_tapping(const nt_scanner *s, nt_scanner_state *state, const nt_place *place, reading *out)
{
    const nt_tapping_over over = {s->plan, place, -state->stage.position};
    nt_flow_value now = {0};
    double peak = -HUGE_VAL;
    for (int i = 0; i < s->steps; i++) {
        now = nt_flow_step_in(&s->lever, &state->flow, &over, s->period / s->steps, &state->table);
        peak = fmax(peak, now.peak_force);
    }
    const double lock_in = s->scan.zloop.lock_in;
    const double share = lock_in > 0.0 ? -expm1(-s->period / lock_in) : 1.0;
    state->measured += share * (now.amplitude - state->measured);
    state->lag += share * (now.phase - state->lag);
    out->signal = state->measured;
    out->phase = state->lag;
    out->peak = peak;
    out->lateral = 0.0;
    out->error = s->scan.zloop.mode == NT_ZLOOP_PHASE
                     ? lag_as_amplitude(s, s->scan.zloop.set_phase) - lag_as_amplitude(s, state->lag)
                     : s->scan.zloop.set_amplitude * s->lever.free_amplitude - state->measured;
    return isfinite(now.amplitude) ? NT_OK : NT_E_NOT_FINITE;
}

static nt_status read_contact(const nt_scanner *s, nt_scanner_state *state, const nt_place *place, const nt_pose *at,
                              reading *out)
{
    grip g = {s->plan, place, &state->contact};
    const nt_force_field field = {grip_eval, grip_advance, &g, s->plan->length};
    const nt_status status = nt_cantilever_settle(&state->lever, &s->probe, &field, -state->stage.position, NULL);
    if (status != NT_OK)
        return status;
    const nt_pose slid = {at->x, at->y, state->lever.tip_height - place->surface.z};
    nt_interaction_slide_gap(s->plan, &state->contact, &state->slide, place, &slid);
    const double k = s->probe.spring_constant, normal = k * state->lever.deflection;
    const double lateral = normal * (place->surface.zx + s->scan.raster.tilt_x) - state->slide.friction.force[0];
    const nt_readout *seen = &s->scan.readout;
    state->measured = (normal + seen->normal_per_lateral * lateral) / k;
    out->signal = state->measured;
    out->phase = 0.0;
    out->peak = normal;
    out->error = s->scan.zloop.set_force / k - state->measured;
    out->lateral = lateral + seen->lateral_per_normal * normal;
    if (seen->lateral_noise > 0.0)
        out->lateral += seen->lateral_noise * nt_noise_normal(&state->noise);
    return NT_OK;
}

static nt_status tick(const nt_scanner *s, nt_scanner_state *state, const nt_pose *at, reading *out)
{
    const nt_place place = place_at(s, at);
    const nt_status status =
        is_tapping(s) ? read_tapping(s, state, &place, out) : read_contact(s, state, &place, at, out);
    if (status != NT_OK)
        return status;
    if (s->scan.zloop.noise > 0.0) {
        const double noise = s->scan.zloop.noise * nt_noise_normal(&state->noise);
        out->signal += noise;
        out->error -= noise;
    }
    const nt_stage_load load = {0.0, 0.0};
    nt_stage_step(&s->stage, &state->stage, -state->command, &load); /* computing takes this tick */
    state->command += (is_tapping(s) ? 1.0 : -1.0) * s->integral * s->period * out->error; /* more force: down */
    state->time += s->period;
    return NT_OK;
}

nt_status nt_scanner_engage(const nt_scanner *scanner, nt_scanner_state *state, long line, uint64_t seed)
{
    if (scanner == NULL || state == NULL)
        return NT_E_ARGUMENT;
    nt_scanner_state made = {.line = line,
                             .time = 2.0 * (double)(line * scanner->ticks) * scanner->period,
                             .noise = nt_noise_of(seed, (uint32_t)line)};
    const nt_pose at = nt_scanner_at(scanner, line, 0.0, 0, made.time);
    const nt_place place = place_at(scanner, &at);
    double above = CLEARANCE;
    if (is_tapping(scanner)) {
        made.flow = nt_flow_free(&scanner->lever);
        made.measured = scanner->lever.free_amplitude;
        made.lag = 0.5 * NT_PI;
        above += scanner->lever.free_amplitude;
    }
    made.command = place.surface.z + above;
    made.stage.position = -made.command;
    if (scanner->stage.stage.hysteresis > 0.0)
        nt_stage_set_plays(&made.stage, -made.command);
    made.lever = nt_cantilever_at(made.command);
    const double time = made.time, step = scanner->integral * scanner->period;
    const double pull = nt_scanner_parachute(scanner, above, scanner->integral); /* time constants to come down */
    const long ticks = (long)fmin(ENGAGE_TICKS_MAX, ceil((ENGAGE + fabs(pull)) / step));
    reading now;
    for (long i = 0; i < ticks; i++) {
        made.time = time;
        const nt_status status = tick(scanner, &made, &at, &now);
        if (status != NT_OK)
            return status;
    }
    made.time = time;
    *state = made;
    return NT_OK;
}

static void put(double *channel, long pixel, double value)
{
    if (channel != NULL)
        channel[pixel] = value;
}

static nt_status half_line(const nt_scanner *s, nt_scanner_state *state, long line, int back, nt_scan_row *row)
{
    const long pixels = (long)s->scan.raster.pixels;
    long done = 0;
    for (long pixel = 0; pixel < pixels; pixel++) {
        const long until = (pixel + 1) * s->ticks / pixels, count = until - done,
                   at = back ? pixels - 1 - pixel : pixel;
        double height = 0.0, error = 0.0, signal = 0.0, phase = 0.0, lateral = 0.0, peak = -HUGE_VAL;
        for (; done < until; done++) {
            const nt_pose way = nt_scanner_at(s, line, ((double)done + 0.5) / (double)s->ticks, back, state->time);
            reading now;
            const nt_status status = tick(s, state, &way, &now);
            if (status != NT_OK)
                return status;
            height += state->command / (double)count;
            error += now.error / (double)count;
            signal += now.signal / (double)count;
            phase += now.phase / (double)count;
            lateral += now.lateral / (double)count;
            peak = fmax(peak, now.peak);
        }
        put(row->height, at, height);
        put(row->error, at, error);
        put(row->signal, at, signal);
        put(row->phase, at, phase);
        put(row->peak_force, at, peak);
        put(row->lateral, at, lateral);
    }
    return NT_OK;
}

/* From the beginning of the line where the tip stands to that of another one, no faster than along a line, but within
 * half a line's time. In one tick a slope across the lines would be a step, which the tip hits. No time of the image.
 */
static nt_status turn(const nt_scanner *s, nt_scanner_state *state, long line)
{
    const nt_raster *raster = &s->scan.raster;
    const double lines = (double)(line - state->line), time = state->time,
                 way = fabs(lines) * raster->height / raster->lines;
    const long ticks = (long)ceil((double)s->ticks * fmin(1.0, way / raster->width));
    for (long i = 1; i <= ticks; i++) {
        const nt_pose at = pose_at(s, (double)state->line + lines * (double)i / (double)ticks, 0.0, 0, time);
        reading lost;
        const nt_status status = tick(s, state, &at, &lost);
        if (status != NT_OK)
            return status;
    }
    state->time = time;
    state->line = line;
    return NT_OK;
}

nt_status nt_scanner_line(const nt_scanner *scanner, nt_scanner_state *state, long line, nt_scan_row *trace,
                          nt_scan_row *retrace)
{
    if (scanner == NULL || state == NULL || trace == NULL || retrace == NULL)
        return NT_E_ARGUMENT;
    nt_status status = turn(scanner, state, line);
    if (status == NT_OK)
        status = half_line(scanner, state, line, 0, trace);
    return status == NT_OK ? half_line(scanner, state, line, 1, retrace) : status;
}
