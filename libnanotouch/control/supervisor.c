/* SPDX-License-Identifier: BSD-3-Clause
 * What happens when something is wrong: RUN, HOLD, RETRACT, LATCHED as a pure function of sample, command and limits
 * (docs/safety.md holds the table). Jump-in and pull-off are the physics of the scene and trip nothing. */
#include <math.h>

#include "nanotouch/control.h"

#define STALE_HOLD_PERIODS 2.0
#define STALE_RETRACT_PERIODS 5.0
#define STUCK_SAMPLES 200u

const char *nt_reason_name(uint32_t reason)
{
    switch (reason) {
    case NT_REASON_INVALID:
        return "invalid sample";
    case NT_REASON_SATURATED:
        return "deflection saturated";
    case NT_REASON_FORCE_LIMIT:
        return "force limit";
    case NT_REASON_STALE:
        return "stale sample";
    case NT_REASON_STUCK:
        return "sensor stuck";
    case NT_REASON_FOLLOW:
        return "stage does not follow";
    case NT_REASON_UNSTABLE:
        return "loop unstable";
    case NT_REASON_EMERGENCY_STOP:
        return "emergency stop";
    case NT_REASON_LIMIT_SWITCH:
        return "limit switch";
    case NT_REASON_OPERATOR_CLIPPED:
        return "operator force clipped";
    case NT_REASON_COMMAND_LIMITED:
        return "command limited";
    default:
        return "";
    }
}

static nt_state worse(nt_state a, nt_state b)
{
    return a > b ? a : b;
}

/* NaN fails every comparison. */
static int is_within(double value, double range)
{
    return fabs(value) <= range;
}

/* Numbers that no sensor of this rig can give (twice its range) are as bad as no numbers. The deflection is judged by
 * its force. */
static int is_valid(const nt_touch *touch, const nt_sample *sample)
{
    const nt_rig *rig = &touch->rig;
    return !(sample->flags & NT_SAMPLE_INVALID) && is_within(sample->master_position, rig->master.travel) &&
           is_within(sample->operator_force, 2.0 * rig->master.gauge_range) &&
           is_within(sample->stage_position, rig->stage.travel) && isfinite(sample->deflection) &&
           isfinite(sample->x) && isfinite(sample->y) && isfinite(sample->age) && sample->age >= 0.0;
}

/* One bad sample: hold, reuse nothing; the second in a row: retract. Never "zero force". */
static nt_state judge_validity(const nt_touch *touch, nt_supervisor_state *state, const nt_sample *sample)
{
    if (is_valid(touch, sample)) {
        state->invalid_run = 0;
        return NT_RUN;
    }
    state->reasons |= NT_REASON_INVALID;
    return ++state->invalid_run > 1 ? NT_RETRACT : NT_HOLD;
}

static nt_state judge_force(const nt_touch *touch, nt_supervisor_state *state, const nt_sample *sample)
{
    nt_state verdict = NT_RUN;
    if (fabs(sample->deflection) >= nt_probe_deflection_range(&touch->rig.probe)) {
        state->reasons |= NT_REASON_SATURATED;
        verdict = NT_RETRACT;
    }
    if (fabs(touch->rig.probe.spring_constant * sample->deflection) > touch->settings.limits.force) {
        state->reasons |= NT_REASON_FORCE_LIMIT;
        verdict = NT_RETRACT;
    }
    if (fabs(sample->operator_force) >= touch->rig.master.gauge_range)
        state->reasons |= NT_REASON_OPERATOR_CLIPPED;
    return verdict;
}

static nt_state judge_age(const nt_touch *touch, nt_supervisor_state *state, const nt_sample *sample)
{
    if (sample->age <= STALE_HOLD_PERIODS * touch->period)
        return NT_RUN;
    state->reasons |= NT_REASON_STALE;
    return sample->age > STALE_RETRACT_PERIODS * touch->period ? NT_RETRACT : NT_HOLD;
}

/* A live sensor shows its noise: identical codes while z moves mean that it is dead. Needs noise above one step. The
 * count stands at STUCK_SAMPLES until z has moved, so that HOLD comes before LATCHED. */
static nt_state judge_stuck(const nt_touch *touch, nt_supervisor_state *state, const nt_sample *sample)
{
    const nt_probe *probe = &touch->rig.probe;
    if (!(probe->noise > 6.0 * probe->resolution))
        return NT_RUN;
    const int saturated = fabs(sample->deflection) >= nt_probe_deflection_range(probe); /* shows no noise */
    if (saturated || sample->deflection != state->stuck_deflection) {
        state->stuck_deflection = sample->deflection;
        state->stuck_position = sample->stage_position;
        state->stuck_run = 0;
        return NT_RUN;
    }
    const int moved = fabs(sample->stage_position - state->stuck_position) > 5.0 * touch->rig.stage.resolution;
    if (state->stuck_run < STUCK_SAMPLES || (moved && state->stuck_run < 2u * STUCK_SAMPLES))
        ++state->stuck_run;
    if (state->stuck_run < STUCK_SAMPLES || !moved)
        return NT_RUN;
    state->reasons |= NT_REASON_STUCK;
    return state->stuck_run < 2u * STUCK_SAMPLES ? NT_HOLD : NT_LATCHED;
}

/* Off its command for half the allowed time: hold; for all of it: latched. */
static nt_state judge_follow(const nt_touch *touch, nt_supervisor_state *state, const nt_sample *sample,
                             double reference)
{
    const nt_limits *limits = &touch->settings.limits;
    if (fabs(sample->stage_position - reference) <= limits->follow_error) {
        state->follow_time = 0.0;
        return NT_RUN;
    }
    state->follow_time += touch->period;
    if (state->follow_time <= 0.5 * limits->follow_time)
        return NT_RUN;
    state->reasons |= NT_REASON_FOLLOW;
    return state->follow_time > limits->follow_time ? NT_LATCHED : NT_HOLD;
}

static nt_state judge_stops(nt_supervisor_state *state, const nt_sample *sample)
{
    nt_state verdict = NT_RUN;
    if (sample->flags & NT_SAMPLE_LIMIT_SWITCH) {
        state->reasons |= NT_REASON_LIMIT_SWITCH;
        verdict = NT_RETRACT;
    }
    if (sample->flags & NT_SAMPLE_EMERGENCY_STOP) {
        state->reasons |= NT_REASON_EMERGENCY_STOP;
        verdict = NT_LATCHED;
    }
    return verdict;
}

nt_state nt_supervisor_step(const nt_touch *touch, nt_supervisor_state *state, const nt_sample *sample,
                            double reference, int unstable)
{
    /* RETRACT and LATCHED keep the reason that led there */
    if (state->state < NT_RETRACT)
        state->reasons = 0;
    nt_state verdict = judge_stops(state, sample);
    const nt_state validity = judge_validity(touch, state, sample);
    verdict = worse(verdict, validity);
    if (validity == NT_RUN) {
        verdict = worse(verdict, judge_force(touch, state, sample));
        verdict = worse(verdict, judge_age(touch, state, sample));
        verdict = worse(verdict, judge_stuck(touch, state, sample));
        verdict = worse(verdict, judge_follow(touch, state, sample, reference));
    }
    if (unstable) {
        state->reasons |= NT_REASON_UNSTABLE;
        verdict = worse(verdict, NT_HOLD);
    }
    state->state = state->state >= NT_RETRACT ? worse(state->state, verdict) : verdict;
    return state->state;
}
