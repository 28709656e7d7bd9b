/* SPDX-License-Identifier: BSD-3-Clause
 * What happens when something is wrong: RUN, HOLD, RETRACT, LATCHED as a pure function of sample, command and limits
 * (docs/safety.md holds the table). Jump-in and pull-off are the physics of the scene and trip nothing. */
#include "internal/control.h"
#include "nanotouch/control.h"

#include <math.h>

#include "control/follow.h"
#include "control/lift.h"
#include "control/stuck.h"
#include "core/clamp.h"
#include "core/same_bits.h"

#define STALE_HOLD_PERIODS 2.0
#define STALE_RETRACT_PERIODS 5.0
#define LATE_PERIODS 0.2
#define MOST_LATE 1000.0 /* periods: what a stop makes up for in one tick */
#define LATE_TICKS 5u    /* in a row: HOLD, until as many punctual ones have made up for them */

nt_supervisor_state nt_supervisor_start(void)
{
    return (nt_supervisor_state){.state = NT_RUN,
                                 .deflection = {.value = NAN},
                                 .amplitude = {.value = NAN},
                                 .power = NAN,
                                 .surface = NAN,
                                 .expected = NAN}; /* nothing seen yet */
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

static int is_within_sideways(const nt_supervisor *supervisor, const nt_sample *sample)
{
    return is_within(sample->master_position[NT_X], supervisor->master_range) &&
           is_within(sample->master_position[NT_Y], supervisor->master_range);
}

/* A lever that shows lateral forces does so always. */
static int shows_sideways(const nt_supervisor *supervisor, const nt_sample *sample)
{
    return supervisor->lateral_stiffness == 0.0 ||
           (isfinite(sample->deflection[NT_X]) && isfinite(sample->deflection[NT_Y]));
}

/* A lever that taps shows amplitude and lag always; a lock-in amplifier's noise may bring a small one below 0. */
static int shows_tapping(const nt_supervisor *supervisor, const nt_sample *sample)
{
    const double most = supervisor->amplitude.most;
    return most == 0.0 || (is_within(sample->amplitude, 2.0 * most) && isfinite(sample->lag));
}

static uint32_t bit(int holds, uint32_t channel)
{
    return holds ? channel : 0u;
}

/* Numbers that no sensor of this rig can give (twice its range) are as bad as no numbers. The deflection is judged by
 * its force. */
static uint32_t seen_of_master(const nt_supervisor *supervisor, const nt_sample *sample)
{
    const double gauge = supervisor->gauge_range;
    return bit(is_within(sample->master_position[NT_Z], supervisor->master_range), NT_SEES_MASTER) |
           bit(gauge == 0.0 || is_within(sample->operator_force[NT_Z], 2.0 * gauge), NT_SEES_OPERATOR) |
           bit(!supervisor->leads_sideways || is_within_sideways(supervisor, sample), NT_SEES_SIDEWAYS);
}

static uint32_t seen_of_slave(const nt_supervisor *supervisor, const nt_sample *sample)
{
    const double *stage = sample->stage_position;
    const int has_place = isfinite(stage[NT_X] - stage[NT_Y]); /* both */
    return bit(has_place && is_within(stage[NT_Z], supervisor->stage_range), NT_SEES_STAGE) |
           bit(isfinite(sample->deflection[NT_Z]), NT_SEES_DEFLECTION) |
           bit(shows_sideways(supervisor, sample), NT_SEES_LATERAL) |
           bit(shows_tapping(supervisor, sample), NT_SEES_TAPPING);
}

/* Below 0: a clock has jumped. */
static int is_fresh(double age, double period)
{
    return age >= 0.0 && age <= STALE_HOLD_PERIODS * period;
}

static nt_state blame(nt_supervisor_state *state, uint32_t reason, nt_state verdict)
{
    state->reasons |= reason;
    return verdict;
}

/* One bad sample: hold, and nothing of what is bad is used; the second in a row: retract. Never "zero force". */
static nt_state judge_validity(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample)
{
    const uint32_t flags = sample->flags, bad = flags & (NT_SAMPLE_INVALID | NT_SAMPLE_DEVICE_LOST);
    const uint32_t master = !bad || flags & NT_SAMPLE_SLAVE_ALONE ? seen_of_master(supervisor, sample) : 0u;
    const uint32_t slave = !bad || flags & NT_SAMPLE_MASTER_ALONE ? seen_of_slave(supervisor, sample) : 0u;
    state->seen = (is_fresh(sample->master_age, supervisor->master_period) ? master : 0u) |
                  (is_fresh(sample->age, supervisor->period) ? slave : 0u);
    if (!bad && (master | slave) == NT_SEES_ALL && sample->age >= 0.0 && sample->age < HUGE_VAL) {
        state->invalid_run = 0;
        return NT_RUN;
    }
    return blame(state, NT_REASON_INVALID, ++state->invalid_run > 1 ? NT_RETRACT : NT_HOLD);
}

static int is_saturated(const nt_supervisor *supervisor, const nt_sample *sample)
{
    return sample->flags & NT_SAMPLE_SATURATED || fabs(sample->deflection[NT_Z]) >= supervisor->deflection_range;
}

/* Does the sample tell how the force changes? A sensor that shows noise again does. */
static int tells_force(const nt_supervisor *supervisor, const nt_supervisor_state *state, const nt_sample *sample)
{
    return isfinite(sample->deflection[NT_Z]) && !is_saturated(supervisor, sample) &&
           state->deflection.run < NT_STUCK_SAMPLES;
}

static int is_held_too_hard(const nt_supervisor *supervisor, const nt_sample *sample)
{
    const double stiffness = supervisor->lateral_stiffness;
    return stiffness > 0.0 && stiffness * hypotenuse(sample->deflection[NT_X], sample->deflection[NT_Y]) >
                                  supervisor->limits.lateral_force;
}

static nt_state judge_force(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample,
                            int saturated)
{
    const double force = supervisor->spring_constant * sample->deflection[NT_Z];
    nt_state verdict = NT_RUN;
    if (saturated)
        verdict = blame(state, NT_REASON_SATURATED, NT_RETRACT);
    if (fabs(force) > supervisor->limits.force)
        verdict = blame(state, NT_REASON_FORCE_LIMIT, NT_RETRACT);
    if (is_held_too_hard(supervisor, sample))
        verdict = blame(state, NT_REASON_LATERAL, NT_RETRACT);
    if (supervisor->gauge_range > 0.0 && fabs(sample->operator_force[NT_Z]) >= supervisor->gauge_range)
        state->reasons |= NT_REASON_OPERATOR_CLIPPED;
    return verdict;
}

/* The tip's travel since it was last free. A surface that passes by below rises and falls: its travel is not counted.
 */
static nt_state judge_indentation(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample,
                                  int moves_sideways)
{
    const double travel = sample->stage_position[NT_Z] - sample->deflection[NT_Z]; /* of the tip, towards the sample */
    const int is_free = fabs(supervisor->spring_constant * sample->deflection[NT_Z]) <= supervisor->free_force;
    if (is_free || isnan(state->surface))
        state->surface = travel;
    else if (moves_sideways)
        state->surface = travel - state->indentation;
    state->indentation = travel - state->surface;
    return state->indentation > supervisor->limits.indentation ? blame(state, NT_REASON_INDENTATION, NT_RETRACT)
                                                               : NT_RUN;
}

/* A hand that is no longer heard of: the stage stays, the force fades. Nothing says that the tip is in danger. */
static nt_state judge_master_age(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample)
{
    return !is_fresh(sample->master_age, supervisor->master_period) ? blame(state, NT_REASON_MASTER_STALE, NT_HOLD)
                                                                    : NT_RUN;
}

static nt_state judge_age(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample)
{
    if (sample->age <= STALE_HOLD_PERIODS * supervisor->period)
        return judge_master_age(supervisor, state, sample);
    const int retracts = sample->age > STALE_RETRACT_PERIODS * supervisor->period;
    return blame(state, NT_REASON_STALE, retracts ? NT_RETRACT : NT_HOLD);
}

/* NaN is late. */
static nt_state judge_lateness(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample)
{
    const int is_late = !(sample->lateness <= LATE_PERIODS * supervisor->period);
    const int held = state->late_run > LATE_TICKS;
    if (is_late) {
        ++state->late_ticks;
        state->late_run = state->late_run + 1 < LATE_TICKS ? state->late_run + 1 : 2u * LATE_TICKS;
    } else if (held) {
        --state->late_run;
    } else {
        state->late_run = 0;
    }
    return state->late_run > LATE_TICKS ? blame(state, NT_REASON_LATE, NT_HOLD) : NT_RUN;
}

/* HOLD steps the probe away (touch.c); if that changes nothing for as many samples again: LATCHED. */
static nt_state judge_stuck(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample,
                            int saturated)
{
    const nt_stuck_limits limits = {supervisor->stuck_distance, supervisor->noise};
    const double *position = sample->stage_position;
    nt_state verdict = nt_stuck_judge(&limits, &state->deflection, sample->deflection[NT_Z], position, saturated);
    if (supervisor->amplitude.stuck.distance != 0.0)
        verdict = worse(
            verdict, nt_stuck_judge(&supervisor->amplitude.stuck, &state->amplitude, sample->amplitude, position, 0));
    return verdict == NT_RUN ? NT_RUN : blame(state, NT_REASON_STUCK, verdict);
}

/* The drive's power is no less than what the medium takes and the swing gains, for the contact only takes:
 *     D Q f0/f A sin(phi) >= A^2 + Q/w0 (A^2)',   A e^(-i phi) of the tip's way.
 * Where it is less by far, this is another drive, or another Q: the set point is held by hitting harder. */
static int is_of_this_drive(const nt_amplitude_limits *tap, nt_supervisor_state *state, const nt_sample *sample)
{
    const double sine = sample->amplitude * sin(sample->lag);
    const double cosine = sample->amplitude * cos(sample->lag) + tap->shake, square = sine * sine + cosine * cosine;
    if (isnan(state->power)) {
        state->power = sine;
        state->loss = square;
    }
    state->power = sine + tap->kept * (state->power - sine);
    state->loss = square + tap->kept * (state->loss - square);
    const double needed = state->loss + tap->memory * (square - state->loss);
    return tap->reach * state->power >= tap->share * needed - tap->lost * tap->lost;
}

/* A drive that is gone looks like hard contact: the servo draws the tip up, and the amplitude has to come back while
 * lever and lock-in amplifier can follow. It tells of no force: LATCHED, and the tip lifts. */
static nt_state judge_amplitude(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample)
{
    const nt_amplitude_limits *tap = &supervisor->amplitude;
    if (tap->most == 0.0)
        return NT_RUN;
    const int is_lost = sample->amplitude < tap->lost || sample->amplitude > tap->most;
    state->lost_run = is_lost ? state->lost_run + 1u : 0u;
    const int is_another = !is_of_this_drive(tap, state, sample);
    return is_another || state->lost_run > tap->settling ? blame(state, NT_REASON_AMPLITUDE, NT_LATCHED) : NT_RUN;
}

/* NaN or infinite: nobody knows how late, and nothing is made up for. */
static double known_lateness(const nt_supervisor *supervisor, const nt_sample *sample)
{
    return sample->lateness > 0.0 && isfinite(sample->lateness)
               ? lesser(sample->lateness, MOST_LATE * supervisor->period)
               : 0.0;
}

static nt_state judge_follow(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample)
{
    const double position = sample->stage_position[NT_Z];
    const nt_state found = nt_follow_is_off(supervisor, state, position)
                               ? nt_follow_judge(supervisor, state, tells_force(supervisor, state, sample))
                               : NT_RUN;
    const nt_state place = found == NT_RUN ? NT_RUN : blame(state, NT_REASON_FOLLOW, found);
    return nt_lift_rises(supervisor, state, position) ? place
                                                      : worse(place, blame(state, NT_REASON_FOLLOW, NT_LATCHED));
}

static nt_state judge_growth(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample)
{
    const double force = supervisor->spring_constant * sample->deflection[NT_Z];
    const int helps = nt_lift_helps(supervisor, state, force, sample->stage_position[NT_Z]);
    return helps ? NT_RUN : blame(state, NT_REASON_FOLLOW, NT_LATCHED);
}

/* Does it move as it is told, and does lifting help? */
static nt_state judge_motion(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample)
{
    if (sample->age > STALE_HOLD_PERIODS * supervisor->period)
        return NT_RUN;
    const nt_state growth = judge_growth(supervisor, state, sample);
    return worse(growth, judge_follow(supervisor, state, sample));
}

/* Of a sample that is not valid only this is used, and only to stop: a reading that is a measurement may say that it
 * does not move as it is told. */
static nt_state judge_remains(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample)
{
    const nt_state growth = state->seen & NT_SEES_DEFLECTION ? judge_growth(supervisor, state, sample) : NT_RUN;
    return state->seen & NT_SEES_STAGE ? worse(growth, judge_follow(supervisor, state, sample)) : growth;
}

/* In a stop: is there force at the tip, or may there be? */
static int may_press(const nt_supervisor *supervisor, const nt_supervisor_state *state, const nt_sample *sample)
{
    const int reads = state->invalid_run == 0 && sample->age <= STALE_HOLD_PERIODS * supervisor->period &&
                      !(state->reasons & NT_REASON_STUCK);
    return !reads || fabs(supervisor->spring_constant * sample->deflection[NT_Z]) > supervisor->free_force;
}

static nt_state judge_stops(nt_supervisor_state *state, const nt_sample *sample)
{
    nt_state verdict = NT_RUN;
    if (sample->flags & NT_SAMPLE_LIMIT_SWITCH)
        verdict = blame(state, NT_REASON_LIMIT_SWITCH, NT_RETRACT);
    if (sample->flags & NT_SAMPLE_EMERGENCY_STOP)
        verdict = blame(state, NT_REASON_EMERGENCY_STOP, NT_LATCHED);
    if (sample->flags & NT_SAMPLE_DEVICE_LOST)
        verdict = blame(state, NT_REASON_DEVICE, NT_LATCHED);
    return verdict;
}

/* What only a valid sample can tell. */
static nt_state judge_measured(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample,
                               const nt_situation *situation)
{
    const int saturated = is_saturated(supervisor, sample);
    nt_state verdict = judge_force(supervisor, state, sample, saturated);
    verdict = worse(verdict, judge_indentation(supervisor, state, sample, situation->moves_sideways));
    verdict = worse(verdict, judge_amplitude(supervisor, state, sample));
    verdict = worse(verdict, judge_age(supervisor, state, sample));
    verdict = worse(verdict, judge_motion(supervisor, state, sample));
    return worse(verdict, judge_stuck(supervisor, state, sample, saturated));
}

/* RETRACT and LATCHED are not left by themselves. */
static nt_state take(nt_supervisor_state *state, nt_state verdict)
{
    state->state = state->state >= NT_RETRACT ? worse(state->state, verdict) : verdict;
    return state->state;
}

nt_state nt_supervisor_step(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample,
                            const nt_situation *situation)
{
    if (state->state < NT_RETRACT) /* else the reason that led there stays */
        state->reasons = 0;
    state->late = known_lateness(supervisor, sample);
    nt_follow_expect(supervisor, state, situation->reference);
    nt_state verdict = judge_stops(state, sample);
    const nt_state validity = judge_validity(supervisor, state, sample);
    verdict = worse(verdict, validity);
    verdict = worse(verdict, validity == NT_RUN ? judge_measured(supervisor, state, sample, situation)
                                                : judge_remains(supervisor, state, sample));
    verdict = worse(verdict, judge_lateness(supervisor, state, sample));
    if (situation->unstable)
        verdict = worse(verdict, blame(state, NT_REASON_UNSTABLE, NT_HOLD));
    state->presses = may_press(supervisor, state, sample);
    return take(state, verdict);
}

nt_state nt_supervisor_fail_law(nt_supervisor_state *state)
{
    return take(state, blame(state, NT_REASON_LAW, ++state->law_run > 1 ? NT_RETRACT : NT_HOLD));
}

nt_status nt_supervisor_arm(nt_supervisor_state *state, int confirmed)
{
    if (state->state == NT_LATCHED && !confirmed)
        return NT_E_STATE;
    nt_supervisor_state fresh = nt_supervisor_start();
    fresh.deflection = state->deflection;
    fresh.deflection.run = 0;
    fresh.deflection.position[NT_Z] = 0.0;
    fresh.amplitude = state->amplitude;
    fresh.amplitude.run = 0;
    fresh.surface = state->surface;
    fresh.indentation = state->indentation;
    fresh.late_ticks = state->late_ticks;
    fresh.expected = state->expected;
    *state = fresh;
    return NT_OK;
}
