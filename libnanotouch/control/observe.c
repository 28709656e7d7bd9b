/* SPDX-License-Identifier: BSD-3-Clause
 * What a sample says, channel by channel. A signal that is derived from others is as valid as they are: a fault of one
 * device never freezes or distorts what the other one shows. After a gap of n periods a speed is the mean over these, a
 * low-pass is where it would be had it been given that all along, and no energy is counted for a time in which not
 * everything was seen. */
#include "control/observe.h"

#include <math.h>

#include "control/sideways.h"
#include "core/clamp.h"
#include "internal/control.h"

/* A single reading that nothing real can have made gives way to the one between it and the last two; a true jump shows
 * one period late. */
static double without_spike(const nt_touch *touch, nt_touch_state *state, double deflection)
{
    const double last = state->deflections[0], before = state->deflections[1];
    state->deflections[1] = last;
    state->deflections[0] = deflection;
    if (fabs(deflection - last) <= touch->spike)
        return deflection;
    return greater(lesser(deflection, last), lesser(greater(deflection, last), before));
}

/* Of a low-pass, over so many periods: 1 - (1 - each)^periods, rounded alike everywhere. */
static double share_of(double each, uint32_t periods)
{
    if (periods == 1u)
        return each;
    double kept = 1.0;
    for (double base = 1.0 - each; periods > 0u; periods >>= 1u, base *= base)
        if (periods & 1u)
            kept *= base;
    return 1.0 - kept;
}

static double rate_of(const nt_touch *touch, uint32_t periods)
{
    const double rate = touch->settings.gains.rate;
    return periods == 1u ? rate : rate / periods;
}

/* Position along z and speed, by differences. After a gap it is indexed anew: what was not seen moves nothing. */
static void follow_master(const nt_touch *touch, nt_touch_state *state, double position)
{
    nt_signals *signals = &state->signals;
    const uint32_t periods = state->gaps.position;
    signals->master_speed = (position - signals->master_position) * rate_of(touch, periods);
    signals->smooth_speed += share_of(touch->speed_filter, periods) * (signals->master_speed - signals->smooth_speed);
    signals->master_position = position;
    if (periods > 1u)
        state->offset = state->reference - signals->scaling.alpha_p * position;
    state->gaps.position = 0;
}

static void follow_operator(const nt_touch *touch, nt_touch_state *state, double force)
{
    nt_signals *signals = &state->signals;
    const uint32_t periods = state->gaps.force;
    signals->operator_force = touch->rig.master.gauge ? force : 0.0;
    signals->smooth_force += share_of(touch->force_filter, periods) * (signals->operator_force - signals->smooth_force);
    state->gaps.force = 0;
}

static void follow_slave(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample)
{
    nt_signals *signals = &state->signals;
    const double position = sample->stage_position[NT_Z];
    signals->stage_speed = (position - signals->stage_position) * rate_of(touch, state->gaps.slave);
    signals->stage_position = position;
    signals->slave_force = touch->rig.probe.spring_constant * without_spike(touch, state, sample->deflection[NT_Z]);
    state->amplitude = sample->amplitude;
    state->lag = sample->lag;
    nt_sideways_read(touch, state, sample);
    state->gaps.slave = 0;
}

/* A new alpha_p counts from where the master is: no bump. */
static void rescale(const nt_touch *touch, nt_touch_state *state)
{
    nt_signals *signals = &state->signals;
    const double alpha_p = state->rescale.now.alpha_p;
    nt_rescale_step(&touch->rescale, &state->rescale, signals->slave_force, signals->stage_position,
                    signals->smooth_speed);
    signals->scaling = state->rescale.now;
    state->offset += (alpha_p - signals->scaling.alpha_p) * signals->master_position;
}

/* What goes in at the hand, and what comes out at the tip at the operator's scale; behind a virtual coupling, whose
 * spring stores energy, what goes into that. Not counted: it only goes on from here. */
static void watch_energy(const nt_touch *touch, nt_touch_state *state, double stage_step, int counts)
{
    const nt_signals *signals = &state->signals;
    const nt_scaling *scaling = &signals->scaling;
    nt_passivity_state *passivity = &state->passivity;
    const uint64_t acting = state->ticks + NT_TOUCH_SENT - 1u - touch->delay; /* the tick whose force has been held */
    const double hand_force =
        touch->rig.master.gauge ? signals->operator_force : -state->sent[acting % NT_TOUCH_SENT][NT_Z];
    const nt_port hand = {hand_force, signals->master_position};
    const int coupled = touch->settings.gains.coupling_stiffness > 0.0;
    const double tip_step =
        coupled ? signals->master_position - passivity->last_hand.position : stage_step / scaling->alpha_p;
    const nt_port tip = {scaling->alpha_f * (coupled ? signals->felt_force : state->projected_force),
                         passivity->last_tip.position + tip_step};
    if (!counts) {
        passivity->last_hand = hand;
        passivity->last_tip = tip;
        return;
    }
    nt_passivity_step(&touch->passivity, passivity, &hand, &tip);
    state->signals.gain_factor = passivity->gain;
}

/* All of it is seen, and was so in the period before: energy is counted. Where the gauge is at its end the hand gives
 * more than it can tell. */
static void observe_all(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample)
{
    const int goes_on = state->gaps.position == 1u && state->gaps.force == 1u && state->gaps.slave == 1u;
    const double stage_step = sample->stage_position[NT_Z] - state->signals.stage_position;
    follow_master(touch, state, sample->master_position[NT_Z]);
    if (touch->leads_sideways)
        nt_sideways_follow_hand(touch, state, sample);
    follow_operator(touch, state, sample->operator_force[NT_Z]);
    follow_slave(touch, state, sample);
    rescale(touch, state);
    /* without a motor no loop closes through the hand, and a servo is meant to move it */
    const int closes = touch->rig.master.motor && state->mode == NT_MODE_TOUCH;
    if (closes)
        watch_energy(touch, state, stage_step, goes_on && !(state->supervisor.reasons & NT_REASON_OPERATOR_CLIPPED));
    if (touch->feels_sideways)
        nt_sideways_watch(touch, state, sample, closes && goes_on);
}

static void observe_seen(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample)
{
    const uint32_t seen = state->supervisor.seen,
                   slave = NT_SEES_ALL & ~(NT_SEES_MASTER | NT_SEES_OPERATOR | NT_SEES_SIDEWAYS);
    if (seen & NT_SEES_MASTER)
        follow_master(touch, state, sample->master_position[NT_Z]);
    if (touch->leads_sideways) {
        nt_sample read = *sample;
        if (!(seen & NT_SEES_SIDEWAYS))
            read.master_position[NT_X] = read.master_position[NT_Y] = NAN;
        nt_sideways_follow_hand(touch, state, &read);
    }
    if (seen & NT_SEES_OPERATOR)
        follow_operator(touch, state, sample->operator_force[NT_Z]);
    if ((seen & slave) == slave)
        follow_slave(touch, state, sample);
}

void nt_observe(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample)
{
    ++state->gaps.position;
    ++state->gaps.force;
    ++state->gaps.slave;
    if (state->supervisor.seen == NT_SEES_ALL)
        observe_all(touch, state, sample);
    else
        observe_seen(touch, state, sample);
}

double nt_observe_speed(const nt_touch_state *state)
{
    return state->gaps.position > 0u ? 0.0 : state->signals.smooth_speed;
}
