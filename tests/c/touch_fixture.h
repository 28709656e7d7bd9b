/* SPDX-License-Identifier: BSD-3-Clause
 * The touch step on a plant that can be written down: a master exactly under the hold, a stage that stands where it was
 * told to a period ago, a surface that is a spring. No noise, no steps. */
#ifndef TESTS_TOUCH_FIXTURE_H
#define TESTS_TOUCH_FIXTURE_H

#include <math.h>

#include "larger.h"
#include "nanotouch/touch.h"

typedef struct bench {
    nt_touch touch;
    nt_touch_state state;
    nt_sample sample;
    nt_command command;
    double surface, stiffness; /* stage travel at first touch [m]; of the contact [N/m] */
    double push;               /* of the hand [N] */
    double x, v;               /* of the master [m], [m/s] */
    double hand_energy;        /* that the hand has given [J] */
    double largest_force;      /* on the sample [N] */
    double fastest_motor;      /* largest step of the motor's force [N] */
    double fastest_stage;      /* of the stage's command [m] */
} bench;

static inline nt_rig quiet_rig(void)
{
    nt_rig rig = nt_rig_defaults();
    rig.probe.noise = rig.probe.resolution = 0.0;
    rig.stage.resolution = rig.stage.command_resolution = 0.0;
    rig.master.resolution = rig.master.gauge_noise = rig.master.gauge_resolution = 0.0;
    return rig;
}

static inline nt_status bench_open(bench *b, const nt_rig *rig, const nt_settings *settings, nt_mode mode)
{
    const bench fresh = {.surface = 100e-9, .stiffness = 40.0};
    *b = fresh;
    const nt_status status = nt_touch_make(&b->touch, rig, settings, mode, NULL);
    if (status == NT_OK)
        b->state = nt_touch_start(&b->touch, 0.0, 0.0, 0.0);
    return status;
}

static inline double bench_force(const bench *b)
{
    const double k_c = b->touch.rig.probe.spring_constant;
    return larger(0.0, b->sample.stage_position[NT_Z] - b->surface) * k_c * b->stiffness / (k_c + b->stiffness);
}

static inline void bench_advance_master(bench *b, double force)
{
    const nt_master *master = &b->touch.rig.master;
    const double m = master->mass, d = master->damping, T = b->touch.period, a = exp(-d * T / m);
    const double moved = m / d * (1.0 - a) * b->v + (T / d - m / (d * d) * (1.0 - a)) * force;
    b->hand_energy += b->push * moved;
    b->x += moved;
    b->v = a * b->v + (1.0 - a) / d * force;
}

static inline void bench_tick(bench *b)
{
    const nt_command last = b->command;
    b->sample.stage_position[NT_Z] = b->command.stage_position[NT_Z];
    b->sample.deflection[NT_Z] = bench_force(b) / b->touch.rig.probe.spring_constant;
    b->sample.master_position[NT_Z] = b->x;
    b->sample.operator_force[NT_Z] = b->push;
    nt_touch_step(&b->touch, &b->state, &b->sample, &b->command);
    bench_advance_master(b, b->push + b->command.motor_force[NT_Z]);
    b->largest_force = larger(b->largest_force, bench_force(b));
    b->fastest_motor = larger(b->fastest_motor, fabs(b->command.motor_force[NT_Z] - last.motor_force[NT_Z]));
    b->fastest_stage = larger(b->fastest_stage, fabs(b->command.stage_position[NT_Z] - last.stage_position[NT_Z]));
    ++b->sample.tick;
}

static inline void bench_run(bench *b, double push, double time)
{
    b->push = push;
    for (double t = 0.0; t < time; t += b->touch.period)
        bench_tick(b);
}

#endif
