/* SPDX-License-Identifier: BSD-3-Clause
 * Scales that change while the loop runs (docs/control.md). By Eq. 16 the operator's contact is the tip's, stretched by
 * 1/alpha_p in length and alpha_f in force: it holds gamma S, gamma = alpha_f/alpha_p. dS is what comes through the
 * port; gamma' S would be made by the computer. So gamma rises only as fast as a tank pays gamma' S, and the tank holds
 * what the operator has lost in the master's damping. In free air S = 0 and everything is allowed. */
#include <math.h>

#include "core/clamp.h"
#include "core/same_bits.h"
#include "nanotouch/scaling.h"
#include "nanotouch/servo.h"

#define TANK 0.05         /* share of the gauge's range over the master's travel that the tank can hold */
#define FREE_SIGMA 6.0    /* of the force noise: below it is free air */
#define INCOME_SHARE 0.5  /* of the damping; the rest is left to holds and delays (passivity.c) */
#define FASTEST_SHARE 0.5 /* of a scale, in one period */

nt_rescale nt_rescale_make(const nt_rig *rig, const nt_settings *settings)
{
    const nt_servo_equivalent equivalent = nt_servo_equivalent_of(rig, settings, INFINITY);
    const double T = 1.0 / settings->gains.rate;
    const nt_probe *probe = &equivalent.rig.probe;
    const double noise =
        probe->spring_constant * probe->sensitivity * hypotenuse(FREE_SIGMA * probe->noise / 6.0, probe->resolution);
    return (nt_rescale){.share = lesser(FASTEST_SHARE, T / greater(settings->gains.ramp_time, T)),
                        .threshold = noise,
                        .spring_constant = rig->probe.spring_constant,
                        .income =
                            INCOME_SHARE * equivalent.rig.master.damping * T / (1.0 + equivalent.gains.force_gain),
                        .capacity = TANK * rig->master.gauge_range * rig->master.travel,
                        .factors = {settings->gains.alpha_f_approach, 1.0, settings->gains.alpha_f_retract}};
}

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
