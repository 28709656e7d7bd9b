/* SPDX-License-Identifier: BSD-3-Clause
 * Before arming: two halves of a tare, whose means give bias and drift; then the stage draws back, is read, and comes
 * back. Drawing back is the safe direction: it needs neither model nor sensor. */
#include "internal/rig.h"
#include "nanotouch/advanced/control.h"

#include <math.h>

#include "control/preflight.h"
#include "core/clamp.h"
#include "core/problem.h"
#include "core/rig.h"
#include "nanotouch/material.h"

#define TARE_HALF 0.05     /* [s] */
#define LEAST_SAMPLES 25.0 /* of half a tare */
#define MOVE_TIME 0.02     /* and at least ten periods of the resonance, which a smooth move then does not excite [s] */
#define MOVE_OSCILLATIONS 10.0
#define MOVE_STEPS 20.0  /* of the stage's read-out or command, the coarser */
#define LEAST_MOVE 10e-9 /* [m] */
#define TOLERANCE 0.5    /* of the move that the read-out must show, and of what hysteresis leaves of it, 1 - 2 h */

void nt_tare_apply(const nt_tare *tare, const nt_probe *probe, nt_sample *sample)
{
    if (fabs(sample->deflection[NT_Z]) >= nt_probe_deflection_range(probe))
        sample->flags |= NT_SAMPLE_SATURATED;
    sample->deflection[NT_Z] -= tare->deflection;
    sample->operator_force[NT_Z] -= tare->operator_force;
}

nt_preflight nt_preflight_make(const nt_rig *rig, const nt_settings *settings)
{
    const double rate = settings->gains.rate;
    const double move = greater(MOVE_TIME, MOVE_OSCILLATIONS / rig->stage.resonance);
    const double lag = settings->gains.delay + rig->converters.dac_latency * rate;
    const nt_rig real = nt_rig_with_steps(rig);
    const double step = greater(real.stage.resolution, real.stage.command_resolution);
    const double distance = greater(LEAST_MOVE, MOVE_STEPS * step);
    return (nt_preflight){.rig = real,
                          .limits = settings->limits,
                          .period = 1.0 / rate,
                          .ticks = (uint32_t)ceil(greater(LEAST_SAMPLES, TARE_HALF * rate)),
                          .move = (uint32_t)ceil(greater(LEAST_SAMPLES, move * rate) + lag),
                          .distance = lesser(distance, 0.25 * rig->stage.travel)};
}

double nt_preflight_time(const nt_preflight *preflight)
{
    return preflight->period * (2.0 * preflight->ticks + 4.0 * preflight->move + 1.0);
}

static int is_good(const nt_preflight *preflight, const nt_sample *sample)
{
    const int measures_hand = preflight->rig.master.gauge;
    return sample->flags == 0u && isfinite(sample->deflection[NT_Z]) && isfinite(sample->stage_position[NT_Z]) &&
           (!measures_hand || isfinite(sample->operator_force[NT_Z]));
}

static nt_preflight_verdict judge(nt_preflight_state *state, double value, double limit, nt_preflight_verdict bad)
{
    if (fabs(value) <= limit)
        return NT_PREFLIGHT_RUNNING;
    state->measure = value;
    return bad;
}

/* The means of the halves lie `ticks` apart. */
static nt_preflight_verdict judge_tare(const nt_preflight *preflight, nt_preflight_state *state)
{
    const nt_limits *limits = &preflight->limits;
    const double count = (double)preflight->ticks, apart = count * preflight->period;
    const nt_tare *sums = state->sums;
    state->tare.deflection = (sums[0].deflection + sums[1].deflection) / (2.0 * count);
    state->tare.operator_force = (sums[0].operator_force + sums[1].operator_force) / (2.0 * count);
    const struct {
        double value, limit;
        nt_preflight_verdict bad;
    } rules[] = {
        {state->tare.deflection, limits->deflection_bias, NT_PREFLIGHT_DEFLECTION_BIAS},
        {(sums[1].deflection - sums[0].deflection) / (count * apart), limits->deflection_drift,
         NT_PREFLIGHT_DEFLECTION_DRIFT},
        {state->tare.operator_force, limits->gauge_bias, NT_PREFLIGHT_GAUGE_BIAS},
        {(sums[1].operator_force - sums[0].operator_force) / (count * apart), limits->gauge_drift,
         NT_PREFLIGHT_GAUGE_DRIFT},
    };
    nt_preflight_verdict verdict = NT_PREFLIGHT_RUNNING;
    for (int i = 0; i < 4 && verdict == NT_PREFLIGHT_RUNNING; ++i)
        verdict = judge(state, rules[i].value, rules[i].limit, rules[i].bad);
    return verdict;
}

/* A reading at the end of its range says no more than that the bias is at least this: no mean is waited for. */
static nt_preflight_verdict judge_reading(const nt_preflight *preflight, nt_preflight_state *state, double deflection)
{
    const int saturated = fabs(deflection) >= nt_probe_deflection_range(&preflight->rig.probe);
    const double limit = saturated ? preflight->limits.deflection_bias : HUGE_VAL;
    return judge(state, deflection, limit, NT_PREFLIGHT_DEFLECTION_BIAS);
}

static void weigh(const nt_preflight *preflight, nt_preflight_state *state, const nt_sample *sample)
{
    nt_tare *sum = &state->sums[state->tick >= preflight->ticks];
    sum->deflection += sample->deflection[NT_Z];
    if (preflight->rig.master.gauge)
        sum->operator_force += sample->operator_force[NT_Z];
    state->rest += sample->stage_position[NT_Z];
}

/* Where the stage shall be `tick` ticks after the tare: back, wait, forth, wait. */
static double drawn_back(const nt_preflight *preflight, uint32_t tick)
{
    const double phase = (double)tick / preflight->move;
    if (phase < 1.0)
        return -0.5 * preflight->distance * (1.0 - cos(NT_PI * phase));
    if (phase < 2.0)
        return -preflight->distance;
    return phase < 3.0 ? -0.5 * preflight->distance * (1.0 + cos(NT_PI * (phase - 2.0))) : 0.0;
}

/* How far the read-out must have gone back at least, and may have at most [m]. */
static double least_move(const nt_preflight *preflight)
{
    return (1.0 - TOLERANCE) * (1.0 - 2.0 * preflight->rig.stage.hysteresis) * preflight->distance;
}

static double most_move(const nt_preflight *preflight)
{
    return (1.0 + TOLERANCE) * preflight->distance;
}

static nt_preflight_verdict judge_move(const nt_preflight *preflight, nt_preflight_state *state)
{
    const double half = preflight->move / 2u; /* the last samples of the wait that were added up */
    const double moved = state->lifted / half - state->rest / (2.0 * preflight->ticks);
    if (-moved >= least_move(preflight) && -moved <= most_move(preflight))
        return NT_PREFLIGHT_RUNNING;
    state->measure = moved;
    return NT_PREFLIGHT_STAGE;
}

nt_preflight_verdict nt_preflight_step(const nt_preflight *preflight, nt_preflight_state *state,
                                       const nt_sample *sample, nt_command *command)
{
    if (state->verdict != NT_PREFLIGHT_RUNNING)
        return state->verdict;
    if (!is_good(preflight, sample)) {
        state->measure = (double)sample->flags;
        return state->verdict = NT_PREFLIGHT_BAD_SAMPLE;
    }
    const uint32_t tare = 2u * preflight->ticks, move = preflight->move;
    if (state->tick < tare) {
        weigh(preflight, state, sample);
        state->verdict = judge_reading(preflight, state, sample->deflection[NT_Z]);
    }
    if (state->tick + 1u == tare && state->verdict == NT_PREFLIGHT_RUNNING)
        state->verdict = judge_tare(preflight, state);
    if (state->tick >= tare + 2u * move - move / 2u && state->tick < tare + 2u * move)
        state->lifted += sample->stage_position[NT_Z];
    if (state->tick + 1u == tare + 2u * move)
        state->verdict = judge_move(preflight, state);
    command->stage_position[NT_Z] = state->tick < tare ? 0.0 : drawn_back(preflight, state->tick - tare + 1u);
    ++state->tick;
    if (state->verdict == NT_PREFLIGHT_RUNNING && state->tick == tare + 4u * move)
        state->verdict = NT_PREFLIGHT_PASSED;
    return state->verdict;
}

/* What the flags of a sample say, the gravest first. */
static nt_problem bad_sample(uint32_t flags)
{
    static const struct {
        uint32_t flag;
        const char *field;
    } named[] = {
        {NT_SAMPLE_EMERGENCY_STOP, "emergency stop before arming"},
        {NT_SAMPLE_DEVICE_LOST, "device lost before arming"},
        {NT_SAMPLE_LIMIT_SWITCH, "limit switch before arming"},
        {NT_SAMPLE_SATURATED, "deflection at the end of its range before arming"},
        {NT_SAMPLE_INVALID, "invalid sample before arming"},
    };
    for (size_t i = 0; i < sizeof named / sizeof *named; ++i)
        if (flags & named[i].flag)
            return nt_problem_of(named[i].field, "no|yes", 1.0, 0.0, 0.0);
    return nt_problem_of("a sample before arming", "", NAN, -INFINITY, INFINITY);
}

nt_problem nt_preflight_problem(const nt_preflight *preflight, const nt_preflight_state *state)
{
    const nt_limits *limits = &preflight->limits;
    const double value = state->measure;
    switch (state->verdict) {
    case NT_PREFLIGHT_BAD_SAMPLE:
        return bad_sample((uint32_t)value);
    case NT_PREFLIGHT_DEFLECTION_BIAS:
        return nt_problem_of("deflection bias", "m", value, -limits->deflection_bias, limits->deflection_bias);
    case NT_PREFLIGHT_DEFLECTION_DRIFT:
        return nt_problem_of("deflection drift", "m/s", value, -limits->deflection_drift, limits->deflection_drift);
    case NT_PREFLIGHT_GAUGE_BIAS:
        return nt_problem_of("gauge bias", "N", value, -limits->gauge_bias, limits->gauge_bias);
    case NT_PREFLIGHT_GAUGE_DRIFT:
        return nt_problem_of("gauge drift", "N/s", value, -limits->gauge_drift, limits->gauge_drift);
    case NT_PREFLIGHT_STAGE:
        return nt_problem_of("stage sign test", "m", value, -most_move(preflight), -least_move(preflight));
    case NT_PREFLIGHT_RUNNING:
    case NT_PREFLIGHT_PASSED:
        break;
    }
    return nt_problem_of("", "", 0.0, 0.0, 0.0);
}
