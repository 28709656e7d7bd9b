/* SPDX-License-Identifier: BSD-3-Clause
 * Piezoelectric z stage, Eq. 13 with its unit error repaired (erratum E15: the tip force enters as f/k_stage):
 *     x'' / wn^2 + x' / (wn Q) + x = P[u] - f / k_stage.
 * P is what the ceramic makes of its voltage, open loop:
 *  - hysteresis, a sum of play operators max(u - r, min(u + r, p)) with thresholds r = X/2, X/4, ... of the half travel
 *    X and weights 3 h r/X (Prandtl-Ishlinskii). Weights over spacing are constant, so that small strokes follow
 *    Rayleigh's law, the loop opening as the square of the stroke; at full stroke it opens by h of it.
 * Rate-independent, and passive: each play only ever takes energy. The rest of the weight is linear, so that +-X maps
 * to +-X.
 *  - creep, decades 0.1, 1, 10, 100 s of first-order lags, each adding `creep` of the way in its time: log t, nearly.
 * Slew limit, travel and steps belong to whoever drives it. */
#include <math.h>
#include <stddef.h>

#include "core/clamp.h"
#include "dynamics/dynamics.h"
#include "nanotouch/material.h"
#include "oscillator.h"

#define NEGLIGIBLE 1e-3 /* share of the stage's damping that a load may undo */
#define FIRST_CREEP 0.1 /* shortest time constant of the creep [s] */

/* load: stiffness over that of the stage. */
static nt_oscillator_constants constants_of(const nt_stage *stage, double load)
{
    const double wn = 2.0 * NT_PI * stage->resonance;
    return (nt_oscillator_constants){1.0 / (wn * wn), 1.0 / (wn * stage->quality), 1.0 + load};
}

nt_status nt_stage_model_init(nt_stage_model *model, const nt_stage *stage, double period)
{
    nt_rig rig = nt_rig_defaults();
    rig.stage = *stage;
    const nt_status status = nt_rig_check(&rig, NULL);
    if (status != NT_OK)
        return status;
    if (!isfinite(period))
        return NT_E_NOT_FINITE;
    if (period <= 0.0)
        return NT_E_RANGE;

    const nt_oscillator_constants constants = constants_of(stage, 0.0);
    nt_stage_model made = {.oscillator = nt_oscillator_over(&constants, period), .period = period, .stage = *stage};
    double time = FIRST_CREEP;
    for (int i = 0; i < NT_STAGE_CREEPS; i++, time *= 10.0)
        made.creep_rate[i] = -expm1(-period / time);
    *model = made;
    return NT_OK;
}

/* P[u] without creep. */
static double with_hysteresis(const nt_stage *stage, nt_stage_state *state, double command)
{
    double share = 0.5, sum = 0.0, linear = 1.0;
    for (int i = 0; i < NT_STAGE_PLAYS; i++, share *= 0.5) {
        const double reach = share * 0.5 * stage->travel, weight = 3.0 * stage->hysteresis * share;
        state->play[i] = fmax(command - reach, fmin(command + reach, state->play[i]));
        sum += weight * state->play[i];
        linear -= weight * (1.0 - share);
    }
    return linear * command + sum;
}

static double with_creep(const nt_stage_model *model, nt_stage_state *state, double target)
{
    double crept = target;
    for (int i = 0; i < NT_STAGE_CREEPS; i++) {
        crept += model->stage.creep * state->creep[i];
        state->creep[i] += model->creep_rate[i] * (target - state->creep[i]);
    }
    return crept;
}

/* The stage on a load that is stiff enough to be felt within its ringing: held over the period its force would come
 * late and feed the resonance, so its spring is the stage's own. */
static nt_oscillator loaded(const nt_stage_model *model, double stiffness)
{
    const double rate = 2.0 * NT_PI * model->stage.resonance, share = stiffness / model->stage.stiffness;
    if (share * model->stage.quality * lesser(rate * model->period, 1.0) < NEGLIGIBLE)
        return model->oscillator;
    const nt_oscillator_constants constants = constants_of(&model->stage, share);
    return nt_oscillator_over(&constants, model->period);
}

void nt_stage_set_plays(nt_stage_state *state, double command)
{
    double share = 0.5;
    for (int i = 0; i < NT_STAGE_PLAYS; i++, share *= 0.5)
        state->play[i] = (1.0 - share) * command;
}

void nt_stage_set_hysteresis(nt_stage_model *model, nt_stage_state *state, double hysteresis, double command)
{
    const double before = with_hysteresis(&model->stage, state, command);
    if (model->stage.hysteresis == 0.0)
        nt_stage_set_plays(state, command);
    model->stage.hysteresis = hysteresis;
    state->shift += before - with_hysteresis(&model->stage, state, command);
}

void nt_stage_step(const nt_stage_model *model, nt_stage_state *state, double command, const nt_stage_load *load)
{
    const nt_stage *stage = &model->stage;
    const nt_oscillator o = loaded(model, load->stiffness);
    double target = command;
    if (stage->hysteresis > 0.0)
        target = with_hysteresis(stage, state, target);
    target += state->shift;
    if (stage->creep > 0.0)
        target = with_creep(model, state, target);
    const double ahead = target - load->force / stage->stiffness - state->position, speed = state->speed;
    state->position += o.xf * ahead + o.xv * speed;
    state->speed = o.vf * ahead + o.vv * speed;
}
