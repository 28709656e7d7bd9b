/* SPDX-License-Identifier: BSD-3-Clause
 * The modes: who moves the stage, and what the operator feels of it. */
#include "control/modes.h"

#include <math.h>

#include "control/motor.h"
#include "control/observe.h"
#include "core/clamp.h"
#include "internal/control.h"

#define FOUND_SHARE 0.9 /* of the set-point: the surface is found */

/* Moves the reference towards `wanted`, no faster than the stage may go and inside its travel; 1 if it is there. */
static int move_reference(const nt_touch *touch, nt_touch_state *state, nt_sum wanted)
{
    const nt_sum slewed = clamp(wanted, state->reference - touch->stage_step, state->reference + touch->stage_step);
    state->reference = clamp(slewed, -touch->stage_end, touch->stage_end);
    if (state->reference == wanted)
        return 1;
    state->supervisor.reasons |= NT_REASON_COMMAND_LIMITED;
    return 0;
}

static double step_of(const nt_touch *touch, double speed)
{
    return speed * touch->period;
}

/* A virtual tool without mass: a spring holds it to the master, a damper to the ground, the tip's force acts on it, and
 * the stage follows it. The operator feels the spring, never a contact stiffer than it, and what comes late through the
 * stage moves the tool alone. At rest the spring's force is alpha_f f_s. One implicit step; the spring's force [N]. */
static double couple(const nt_touch *touch, nt_touch_state *state)
{
    const nt_gains *gains = &touch->settings.gains;
    const nt_signals *signals = &state->signals;
    const double reflected = signals->scaling.alpha_f * state->projected_force;
    if (gains->coupling_stiffness == 0.0)
        return reflected;
    const double drag = gains->coupling_damping * gains->rate; /* over a period [N/m] */
    const double stretch = state->stretch + signals->master_speed * touch->period;
    state->stretch = (drag * stretch + reflected) / (gains->coupling_stiffness + drag);
    return gains->coupling_stiffness * state->stretch;
}

static void engage(const nt_touch *touch, nt_touch_state *state)
{
    const double ramp = touch->settings.gains.ramp_time;
    state->engaged = ramp > 0.0 ? lesser(1.0, state->engaged + touch->period / ramp) : 1.0;
}

static double run_touch(const nt_touch *touch, nt_touch_state *state)
{
    nt_signals *signals = &state->signals;
    signals->felt_force = couple(touch, state) / signals->scaling.alpha_f;
    signals->target = signals->scaling.alpha_p * (signals->master_position - state->stretch) + state->offset;
    const nt_effort effort = touch->law(touch->settings.control.context, &touch->settings.gains, signals);
    if (!isfinite(effort.motor_force) || !isfinite(effort.stage))
        return NAN;
    move_reference(touch, state, effort.stage);
    engage(touch, state);
    return state->engaged * effort.motor_force + nt_passivity_damping_force(&touch->passivity, &state->passivity);
}

/* By how much a lever that taps swings too far [m]. A lag counts as the amplitude that a contact without loss would
 * have, A0 sin(phi), beyond 90 degrees as A0 (2 - sin(phi)): far from the sample it is A0 (scan.h). */
static double swing_error(const nt_touch *touch, const nt_touch_state *state)
{
    const nt_tap *tap = &touch->settings.tap;
    if (tap->hold == 0)
        return state->amplitude - tap->set_amplitude * touch->drive_amplitude;
    const double sine = sin(state->lag), read = cos(state->lag) >= 0.0 ? sine : 2.0 - sine;
    return (read - sin(tap->set_phase)) * touch->drive_amplitude;
}

/* How far the height servo would go in this period towards the set-point [m]: down for more force, or where the swing
 * is larger than what is held. */
static double height_step(const nt_touch *touch, const nt_touch_state *state)
{
    const nt_gains *gains = &touch->settings.gains;
    const double force_error = (gains->set_point - state->signals.slave_force) / touch->rig.probe.spring_constant;
    const double error = state->mode == NT_MODE_TAPPING ? swing_error(touch, state) : force_error;
    return step_of(touch, gains->height_gain * error);
}

static double run_topography(const nt_touch *touch, nt_touch_state *state)
{
    move_reference(touch, state, state->reference + height_step(touch, state));
    engage(touch, state);
    const double height_position = (state->reference - state->offset) / state->signals.scaling.alpha_p;
    return state->engaged * nt_motor_height(&touch->settings.gains, height_position, state->signals.master_position);
}

static double run_approach(const nt_touch *touch, nt_touch_state *state)
{
    const double most = step_of(touch, touch->settings.gains.approach_speed);
    const int is_free = state->signals.slave_force <= touch->supervisor.free_force; /* or drawn in */
    const double step = is_free ? most : clamp(height_step(touch, state), -most, most);
    move_reference(touch, state, state->reference + step);
    if (state->signals.slave_force >= FOUND_SHARE * touch->settings.gains.set_point)
        state->phase = NT_PHASE_DONE;
    return nt_mode_release(touch, state);
}

static double run_curve(const nt_touch *touch, nt_touch_state *state)
{
    const nt_gains *gains = &touch->settings.gains;
    const double step = step_of(touch, gains->approach_speed);
    if (state->phase == NT_PHASE_DOWN) {
        const int moved = move_reference(touch, state, state->reference + step);
        state->turn = state->reference;
        if (!moved || state->signals.slave_force >= gains->set_point)
            state->phase = NT_PHASE_UP;
    } else if (state->phase == NT_PHASE_UP) {
        const nt_sum end = state->turn - gains->curve_length;
        const int moved = move_reference(touch, state, greater(end, state->reference - step));
        if (!moved || state->reference <= end)
            state->phase = NT_PHASE_DONE;
    }
    return nt_mode_release(touch, state);
}

/* A mode is left as a stop is: the force fades out where the stage stands. */
static double leave(const nt_touch *touch, nt_touch_state *state)
{
    const double force = nt_mode_release(touch, state);
    if (state->fade.left > 0.0)
        return force;
    state->mode = state->wanted_mode;
    state->phase = NT_PHASE_DOWN;
    return force;
}

double nt_mode_run(const nt_touch *touch, nt_touch_state *state)
{
    if (state->mode != state->wanted_mode)
        return leave(touch, state);
    if (state->clutch_open)
        return nt_mode_release(touch, state);
    switch (state->mode) {
    case NT_MODE_TOUCH:
        return run_touch(touch, state);
    case NT_MODE_TOPOGRAPHY:
    case NT_MODE_TAPPING:
        return run_topography(touch, state);
    case NT_MODE_APPROACH:
        return run_approach(touch, state);
    case NT_MODE_CURVE:
        return run_curve(touch, state);
    }
    return NAN;
}

double nt_mode_release(const nt_touch *touch, nt_touch_state *state)
{
    const nt_signals *signals = &state->signals;
    state->stretch = state->sideways[NT_X] = state->sideways[NT_Y] = 0.0; /* nothing is owed to the hand any more */
    state->offset = state->reference - signals->scaling.alpha_p * signals->master_position;
    (void)nt_motor_fade(touch, state);
    return nt_motor_faded(touch, state, NT_Z, nt_observe_speed(state));
}

double nt_mode_stop(const nt_touch *touch, nt_touch_state *state, double distance)
{
    if (state->retracted < distance) {
        const double time = touch->period + state->supervisor.late;
        const double step = lesser(touch->settings.limits.retract_speed * time, distance - state->retracted);
        state->retracted += step;
        state->reference = greater(state->reference - step, -touch->stage_end);
    }
    return nt_mode_release(touch, state);
}
