/* SPDX-License-Identifier: BSD-3-Clause
 * Scales that change while the loop runs (docs/control.md). By Eq. 16 the operator's contact is the tip's, stretched by
 * 1/alpha_p in length and alpha_f in force: it holds gamma S, gamma = alpha_f/alpha_p. dS is what comes through the
 * port; gamma' S would be made by the computer. So gamma rises only as fast as a tank pays gamma' S, and the tank holds
 * what the operator has lost in the master's damping. In free air S = 0 and everything is allowed. */
#include "core/clamp.h"
#include "internal/control.h"
#include "nanotouch/control.h"

nt_rescale_state nt_rescale_start(const nt_rescale *rescale, const nt_scaling *scaling)
{
    nt_rescale_state state = {.now = *scaling, .wanted = *scaling};
    state.now.alpha_f *= rescale->factors[NT_REGION_APPROACH];
    return state;
}

/* Free air is left by pressing; a pull that follows contact is adhesion, and the next free air ends it. */
static nt_region region_of(const nt_rescale *rescale, nt_region last, double force)
{
    if (force > rescale->threshold)
        return NT_REGION_INDENT;
    if (force < -rescale->threshold)
        return last == NT_REGION_APPROACH ? NT_REGION_APPROACH : NT_REGION_RETRACT;
    return last == NT_REGION_RETRACT ? NT_REGION_APPROACH : last;
}

static double towards(double now, double wanted, double share)
{
    return clamp(wanted, now * (1.0 - share), now * (1.0 + share));
}

void nt_rescale_step(const nt_rescale *rescale, nt_rescale_state *state, double slave_force, double stage_position,
                     double master_speed)
{
    state->work += slave_force * (stage_position - state->last_position);
    state->last_position = stage_position;
    state->tank = lesser(state->tank + rescale->income * master_speed * master_speed, rescale->capacity);
    const int is_free = slave_force <= rescale->threshold && slave_force >= -rescale->threshold;
    if (is_free)
        state->work = 0.0;
    state->region = region_of(rescale, state->region, slave_force);
    const double alpha_f = state->wanted.alpha_f * rescale->factors[state->region];
    nt_scaling *now = &state->now;
    if (now->alpha_f == alpha_f && now->alpha_p == state->wanted.alpha_p)
        return;
    const nt_scaling next = {towards(now->alpha_p, state->wanted.alpha_p, rescale->share),
                             towards(now->alpha_f, alpha_f, rescale->share)};
    /* the lever's own energy at least, where a surface has risen under a stage that stands */
    const double held =
        is_free ? 0.0 : greater(state->work, 0.5 * slave_force * slave_force / rescale->spring_constant);
    const double price = (next.alpha_f / next.alpha_p - now->alpha_f / now->alpha_p) * held;
    if (price > state->tank)
        return;
    state->tank -= greater(price, 0.0);
    *now = next;
}
