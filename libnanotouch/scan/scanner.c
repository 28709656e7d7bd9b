/* SPDX-License-Identifier: BSD-3-Clause
 * One tick after the other: the place, the lever there, the reading, the loop, the stage. */
#include "nanotouch/scan.h"

#include <math.h>
#include <stddef.h>

#include "core/problem.h"

#define CLEARANCE 2e-9 /* above first touch where a scan begins to come down [m] */
#define ENGAGE 12.0    /* time constants of the loop until it holds */
enum { ENGAGE_TICKS_MAX = 2000000 };

static int is_tapping(const nt_scanner *s)
{
    return s->scan.zloop.mode == NT_ZLOOP_TAPPING;
}

static nt_status prepare(nt_scanner *made, const nt_scanner_inputs *in, nt_problem *problem)
{
    nt_status status = nt_scan_check(in->scan, problem);
    if (status == NT_OK)
        status = nt_rig_check(in->rig, problem);
    if (status == NT_OK && is_tapping(made))
        status = nt_tapping_init(&made->lever, &in->rig->probe, in->drive, 1e-9, problem);
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
    const nt_raster *raster = &made.scan.raster;
    made.ticks = lround(0.5 * made.scan.zloop.rate / raster->line_rate);
    if ((double)made.ticks < raster->pixels)
        return nt_problem_set(problem, "raster.line_rate", "Hz", raster->line_rate, 1e-3,
                              0.5 * made.scan.zloop.rate / raster->pixels);
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
    double signal, error, phase, peak; /* [m], [m], [rad], [N] */
} reading;

static nt_place place_at(const nt_scanner *s, const nt_scanner_state *state, double x, double y)
{
    const nt_raster *raster = &s->scan.raster;
    nt_place place = nt_interaction_place(s->plan, x, y);
    place.surface.z += raster->tilt_x * x + raster->tilt_y * y + raster->drift * state->time;
    return place;
}

static nt_status read_tapping(const nt_scanner *s, nt_scanner_state *state, const nt_place *place, reading *out)
{
    const nt_tapping_over over = {s->plan, place, -state->stage.position};
    const nt_flow_value now = nt_flow_step(&s->lever, &state->flow, &over, s->period);
    const double lock_in = s->scan.zloop.lock_in;
    const double share = lock_in > 0.0 ? -expm1(-s->period / lock_in) : 1.0;
    state->measured += share * (now.amplitude - state->measured);
    out->signal = state->measured;
    out->phase = now.phase;
    out->peak = now.peak_force;
    out->error = s->scan.zloop.set_amplitude * s->lever.free_amplitude;
    return isfinite(now.amplitude) ? NT_OK : NT_E_NOT_FINITE;
}

static nt_status read_contact(const nt_scanner *s, nt_scanner_state *state, const nt_place *place, reading *out)
{
    grip g = {s->plan, place, &state->contact};
    const nt_force_field field = {grip_eval, grip_advance, &g, s->plan->length};
    const nt_status status = nt_cantilever_settle(&state->lever, &s->probe, &field, -state->stage.position, NULL);
    state->measured = state->lever.deflection;
    out->signal = state->measured;
    out->phase = 0.0;
    out->peak = s->probe.spring_constant * state->measured;
    out->error = s->scan.zloop.set_force / s->probe.spring_constant;
    return status;
}

static nt_status tick(const nt_scanner *s, nt_scanner_state *state, double x, double y, reading *out)
{
    const nt_place place = place_at(s, state, x, y);
    const nt_status status = is_tapping(s) ? read_tapping(s, state, &place, out) : read_contact(s, state, &place, out);
    if (status != NT_OK)
        return status;
    if (s->scan.zloop.noise > 0.0)
        out->signal += s->scan.zloop.noise * nt_noise_normal(&state->noise);
    out->error -= out->signal;
    const nt_stage_load load = {0.0, 0.0};
    nt_stage_step(&s->stage, &state->stage, -state->command, &load); /* computing takes this tick */
    state->command += (is_tapping(s) ? 1.0 : -1.0) * s->integral * s->period * out->error; /* more force: down */
    state->time += s->period;
    return NT_OK;
}

static double y_of(const nt_scanner *s, long line)
{
    const nt_raster *raster = &s->scan.raster;
    return raster->y + ((double)line + 0.5) * raster->height / raster->lines;
}

nt_status nt_scanner_engage(const nt_scanner *scanner, nt_scanner_state *state, long line, uint64_t seed)
{
    if (scanner == NULL || state == NULL)
        return NT_E_ARGUMENT;
    nt_scanner_state made = {.time = 2.0 * (double)(line * scanner->ticks) * scanner->period,
                             .noise = nt_noise_of(seed, (uint32_t)line)};
    const double x = scanner->scan.raster.x, y = y_of(scanner, line);
    const nt_place place = place_at(scanner, &made, x, y);
    double above = CLEARANCE;
    if (is_tapping(scanner)) {
        made.flow = nt_flow_free(&scanner->lever);
        made.measured = scanner->lever.free_amplitude;
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
        const nt_status status = tick(scanner, &made, x, y, &now);
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
    const nt_raster *raster = &s->scan.raster;
    const double y = y_of(s, line);
    const long pixels = (long)raster->pixels;
    long done = 0;
    for (long pixel = 0; pixel < pixels; pixel++) {
        const long until = (pixel + 1) * s->ticks / pixels, count = until - done,
                   at = back ? pixels - 1 - pixel : pixel;
        double height = 0.0, error = 0.0, signal = 0.0, phase = 0.0, peak = -HUGE_VAL;
        for (; done < until; done++) {
            const double share = ((double)done + 0.5) / (double)s->ticks;
            const double x = raster->x + (back ? 1.0 - share : share) * raster->width;
            reading now;
            const nt_status status = tick(s, state, x, y, &now);
            if (status != NT_OK)
                return status;
            height += state->command / (double)count;
            error += now.error / (double)count;
            signal += now.signal / (double)count;
            phase += now.phase / (double)count;
            peak = fmax(peak, now.peak);
        }
        put(row->height, at, height);
        put(row->error, at, error);
        put(row->signal, at, signal);
        put(row->phase, at, phase);
        put(row->peak_force, at, peak);
    }
    return NT_OK;
}

nt_status nt_scanner_line(const nt_scanner *scanner, nt_scanner_state *state, long line, nt_scan_row *trace,
                          nt_scan_row *retrace)
{
    if (scanner == NULL || state == NULL || trace == NULL || retrace == NULL)
        return NT_E_ARGUMENT;
    const nt_status status = half_line(scanner, state, line, 0, trace);
    return status == NT_OK ? half_line(scanner, state, line, 1, retrace) : status;
}
