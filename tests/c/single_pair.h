/* SPDX-License-Identifier: BSD-3-Clause
 * The touch step in double and in single precision, side by side: the same samples and requests for both, the plant
 * driven by the double one. Master exactly under the hold, stage where it was told to a period ago, a surface that
 * pulls and pushes, noise; and whatever can be wrong with a sample. */
#ifndef TESTS_SINGLE_PAIR_H
#define TESTS_SINGLE_PAIR_H

#include "adversary_draws.h"
#include "nanotouch_single_of.h"

typedef struct pair {
    nt_touch touch;
    nt_touch_state state;
    nt_command command;
    ntf_touch single;
    ntf_touch_state single_state;
    ntf_command single_command;
    nt_random noise;
    double x, v;                     /* of the master [m], [m/s] */
    double push;                     /* of the hand [N] */
    double surface, stiffness, pull; /* stage travel at first touch [m]; [N/m]; [N] */
    uint32_t ticks;
    nt_sample sample;
} pair;

/* A sample that both can hold. */
static inline nt_sample in_single(const nt_sample *sample)
{
    const ntf_sample s = ntf_sample_of(sample);
    nt_sample same = *sample;
    same.age = (double)s.age;
    same.master_age = (double)s.master_age;
    same.lateness = (double)s.lateness;
    for (int i = 0; i < NT_AXES; ++i) {
        same.master_position[i] = (double)s.master_position[i];
        same.operator_force[i] = (double)s.operator_force[i];
        same.stage_position[i] = (double)s.stage_position[i];
        same.deflection[i] = (double)s.deflection[i];
    }
    return same;
}

static inline nt_status pair_open(pair *p, const nt_rig *rig, const nt_settings *settings, nt_mode mode, uint64_t seed)
{
    *p = (pair){.noise = nt_random_seed(seed), .surface = 100e-9, .stiffness = 40.0};
    const nt_status status = nt_touch_make(&p->touch, rig, settings, mode, NULL);
    if (status != NT_OK)
        return status;
    p->single = ntf_touch_of(&p->touch);
    p->state = nt_touch_start(&p->touch, 0.0, 0.0, 0.0);
    p->single_state = ntf_touch_start(&p->single, 0.0f, 0.0f, 0.0f);
    return NT_OK;
}

/* Of the lever, against the surface; before it a pull that fades over 2 nm [m]. */
static inline double deflection_of(const pair *p, double travel)
{
    const double k_c = p->touch.rig.probe.spring_constant, in = travel - p->surface;
    const double force =
        in > 0.0 ? in * k_c * p->stiffness / (k_c + p->stiffness) - p->pull : -p->pull * exp(in / 2e-9);
    return force / k_c;
}

static inline double with_steps(double value, double step)
{
    return step > 0.0 ? step * floor(value / step + 0.5) : value;
}

static inline void move_master(pair *p, double force)
{
    const nt_master *master = &p->touch.rig.master;
    const double m = master->mass, d = master->damping, T = p->touch.period, a = exp(-d * T / m);
    const double end = 0.49 * master->travel;
    p->x += m / d * (1.0 - a) * p->v + (T / d - m / (d * d) * (1.0 - a)) * force;
    p->v = a * p->v + (1.0 - a) / d * force;
    if (fabs(p->x) > end) {
        p->x = copysign(end, p->x);
        p->v = 0.0;
    }
}

/* What the rig shows in this tick. */
static inline void pair_measure(pair *p)
{
    const nt_rig *rig = &p->touch.rig;
    const double sigma = rig->probe.sensitivity * rig->probe.noise / 6.0;
    nt_sample *s = &p->sample;
    *s = (nt_sample){.tick = p->ticks};
    for (int i = 0; i < NT_AXES; ++i)
        s->stage_position[i] = p->command.stage_position[i];
    const double deflection = deflection_of(p, s->stage_position[NT_Z]) + sigma * nt_random_normal(&p->noise);
    s->deflection[NT_Z] = with_steps(deflection, rig->probe.sensitivity * rig->probe.resolution);
    s->stage_position[NT_Z] = with_steps(s->stage_position[NT_Z], rig->stage.resolution);
    s->master_position[NT_Z] = with_steps(p->x, rig->master.resolution);
    s->operator_force[NT_Z] = rig->master.gauge ? with_steps(p->push, rig->master.gauge_resolution) : 0.0;
}

/* Both step on the same sample, but that each sees where its own command has led: an integral is bounded by nothing
 * else. Steps and noise are those of the first. */
static inline void pair_step(pair *p)
{
    const nt_sample sample = in_single(&p->sample);
    const double mine = p->command.stage_position[NT_Z], other = (double)p->single_command.stage_position[NT_Z];
    ntf_sample single = ntf_sample_of(&sample);
    single.stage_position[NT_Z] = (float)(sample.stage_position[NT_Z] + (other - mine));
    single.deflection[NT_Z] = (float)(sample.deflection[NT_Z] + (deflection_of(p, other) - deflection_of(p, mine)));
    nt_touch_step(&p->touch, &p->state, &sample, &p->command);
    ntf_touch_step(&p->single, &p->single_state, &single, &p->single_command);
    move_master(p, p->push + p->command.motor_force[NT_Z]);
    ++p->ticks;
}

#endif
