/* SPDX-License-Identifier: BSD-3-Clause
 * Haptic master with the hand that holds it, Eq. 12: M x'' + B x' + K (x - rest) + f_C sgn(x') = f, with M = m + m_h, B
 * = b + b_h, K = k_h and f held over the period, between hard end stops.
 *
 * Friction makes it piecewise linear. Within a period the arm moves one way under f - f_C or f + f_C until its speed is
 * 0, at a moment known in closed form; there it sticks while |f - K (x - rest)| <= f_C, or else moves on. So sticking
 * and slipping are exact and do not chatter. An end stop takes all of the momentum (inelastic): the arm stands there
 * until it is driven back. */
#include <math.h>
#include <stddef.h>

#include "dynamics/dynamics.h"
#include "oscillator.h"

enum { TURNS_MAX = 64 }; /* of a swinging arm within one period */

static nt_oscillator_constants constants_of(const nt_master_model *model)
{
    return (nt_oscillator_constants){model->master.mass + model->hand.mass, model->master.damping + model->hand.damping,
                                     model->hand.stiffness};
}

nt_status nt_master_model_init(nt_master_model *model, const nt_master *master, const nt_hand *hand, double period)
{
    nt_rig rig = nt_rig_defaults();
    rig.master = *master;
    if (hand != NULL)
        rig.hand = *hand;
    const nt_status status = nt_rig_check(&rig, NULL);
    if (status != NT_OK)
        return status;
    if (!isfinite(period))
        return NT_E_NOT_FINITE;
    if (period <= 0.0)
        return NT_E_RANGE;
    nt_master_model made = {.period = period, .master = *master, .hand = rig.hand};
    const nt_oscillator_constants constants = constants_of(&made);
    made.oscillator = nt_oscillator_over(&constants, period);
    *model = made;
    return NT_OK;
}

/* One transition; pull: f - K (x - rest). */
static void move(const nt_oscillator *o, nt_master_state *state, double pull)
{
    state->position += o->xv * state->speed + o->xf * pull;
    state->speed = o->vv * state->speed + o->vf * pull;
}

/* Which way the arm goes, or is about to: -1, 1; 0 if it sticks. */
static double way_of(const nt_master_model *model, const nt_master_state *state, double pull)
{
    if (state->speed != 0.0)
        return state->speed > 0.0 ? 1.0 : -1.0;
    if (fabs(pull) <= model->master.friction)
        return 0.0;
    return pull > 0.0 ? 1.0 : -1.0;
}

/* What friction leaves of a pull; nothing where the arm sticks. */
static double beyond_friction(const nt_master_model *model, const nt_master_state *state, double pull)
{
    const double way = way_of(model, state, pull);
    return way == 0.0 ? 0.0 : pull - way * model->master.friction;
}

static void step_with_friction(const nt_master_model *model, nt_master_state *state, double force, double rest)
{
    const nt_oscillator_constants constants = constants_of(model);
    double left = model->period;
    for (int turn = 0; turn < TURNS_MAX && left > 0.0; turn++) {
        const double spring = force - model->hand.stiffness * (state->position - rest);
        const double way = way_of(model, state, spring);
        if (way == 0.0)
            return;
        const double pull = spring - way * model->master.friction;
        /* from rest it moves off along the pull: only its own spring can turn it, after half a swing */
        const double moving = state->speed != 0.0 ? state->speed : way * 1e-300;
        const double until = nt_oscillator_turns_after(&constants, pull, moving);
        if (!(until < left)) {
            const nt_oscillator rest_of_it = nt_oscillator_over(&constants, left);
            move(left < model->period ? &rest_of_it : &model->oscillator, state, pull);
            return;
        }
        const nt_oscillator part = nt_oscillator_over(&constants, until);
        move(&part, state, pull);
        state->speed = 0.0;
        left -= until;
    }
}

void nt_master_step(const nt_master_model *model, nt_master_state *state, double force, double rest)
{
    if (model->master.friction > 0.0)
        step_with_friction(model, state, force, rest);
    else
        move(&model->oscillator, state, force - model->hand.stiffness * (state->position - rest));

    const double stop = model->master.travel / 2.0;
    if (state->position > stop || state->position < -stop) {
        state->position = state->position > 0.0 ? stop : -stop;
        state->speed = state->acceleration = 0.0;
        return;
    }
    const nt_oscillator_constants c = constants_of(model);
    const double pull = force - c.stiffness * (state->position - rest) - c.damping * state->speed;
    state->acceleration = (model->master.friction > 0.0 ? beyond_friction(model, state, pull) : pull) / c.mass;
}

double nt_master_grip_force(const nt_master_model *model, const nt_master_state *state, double effort, double rest)
{
    const nt_hand *h = &model->hand;
    return effort - h->mass * state->acceleration - h->damping * state->speed - h->stiffness * (state->position - rest);
}
