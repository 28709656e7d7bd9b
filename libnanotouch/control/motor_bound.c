/* SPDX-License-Identifier: BSD-3-Clause
 * What is promised to the hand. A force that falls in a line from F gives a hand that moves at v the energy
 * |F| v T/2 within T; a handle of mass m that is let go gains the impulse J = |F| T/2 besides, and is given
 * J v + J^2/(2 m) in all. */
#include "internal/control.h"
#include "nanotouch/advanced/control.h"

#include <math.h>

#include "control/motor.h"
#include "control/sampled.h"
#include "core/clamp.h"

#define HAND_ENERGY 1e-3  /* W [J] */
#define RELEASED_MASS 0.1 /* of a handle that is let go [kg] */

nt_motor_bound nt_motor_bound_compute(const nt_rig *rig, const nt_settings *settings)
{
    const nt_master *master = &rig->master;
    const nt_limits *limits = &settings->limits;
    const double mass = lesser(RELEASED_MASS, master->mass), speed = master->max_speed;
    const double most = master->motor ? limits->motor_force : 0.0;
    const int sideways = nt_sideways_is_felt(rig);
    const double force[NT_AXES] = {sideways ? most : 0.0, sideways ? most : 0.0, most};
    nt_motor_bound bound = {.force = sideways ? sqrt(3.0) * most : most,
                            .speed = 0.5 * (speed + sqrt(speed * speed + 2.0 * HAND_ENERGY / mass)),
                            .delay = settings->gains.delay / settings->gains.rate + rig->converters.dac_latency};
    bound.fade_product = 2.0 * HAND_ENERGY / bound.speed;
    bound.fade_time = nt_motor_fade_time(bound.fade_product, limits->motor_rate, force);
    const double impulse = bound.force * (0.5 * bound.fade_time + bound.delay);
    bound.energy = impulse * (speed + 0.5 * impulse / mass);
    return bound;
}
