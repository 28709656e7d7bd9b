/* SPDX-License-Identifier: BSD-3-Clause
 * What is drawn for a run against the guarantee (adversary.h): scene, rig, settings, surface, and how far the truth is
 * off what is believed. Every range stands here in numbers of its own: none follows from the library's defaults. */
#ifndef TESTS_ADVERSARY_DRAWS_H
#define TESTS_ADVERSARY_DRAWS_H

#include <math.h>

#include "adversary_dice.h"
#include "control/margins.h"
#include "core/rig.h"
#include "larger.h"

/* Gels to diamond, sharp to blunt, dry to wet, in vacuum, in a liquid, charged. */
static inline void draw_scene(plot *p, dice *d)
{
    nt_scene *scene = &p->setup.scene;
    const int soft = chance(d, 0.08); /* one that deforms under forces before contact takes long to compute */
    scene->sample.youngs_modulus = soft ? magnitude(d, 1e6, 5e9) : magnitude(d, 5e9, 1e12);
    scene->sample.poisson_ratio = between(d, 0.1, 0.5);
    scene->tip.radius = magnitude(d, 5e-9, 300e-9);
    scene->adhesion.work_of_adhesion = magnitude(d, 1e-3, 0.3);
    const double z0 = scene->adhesion.equilibrium_distance; /* H = 12 pi z0^2 w of van der Waals' force alone */
    scene->adhesion.hamaker_constant = 37.7 * z0 * z0 * scene->adhesion.work_of_adhesion * magnitude(d, 0.1, 1.5);
    scene->adhesion.contact_potential = chance(d, 0.7) ? 0.0 : between(d, -3.0, 3.0);
    scene->medium.kind = choose(d, 3);
    scene->medium.relative_humidity = chance(d, 0.3) ? 0.0 : between(d, 0.05, 0.9);
    if (scene->medium.kind != NT_MEDIUM_LIQUID)
        return;
    scene->medium.ionic_strength = magnitude(d, 0.1, 500.0);
    scene->tip.surface_potential = between(d, -0.1, 0.1);
    scene->sample.surface_potential = between(d, -0.1, 0.1);
}

typedef enum relief { RELIEF_BUMPS, RELIEF_ROUGH, RELIEF_STEPS, RELIEFS } relief;

/* Bumps, waves at random, or steps that go up in one pixel; 1 to 100 nm high. The tip may go anywhere on them. */
static inline void draw_surface(plot *p, dice *d)
{
    enum { WAVES = 6 };
    const relief kind = (relief)choose(d, RELIEFS);
    const double pitch = magnitude(d, 2e-9, 100e-9), height = magnitude(d, 0.3e-9, 100e-9);
    double waves[WAVES][3];
    for (int k = 0; k < WAVES; ++k) {
        waves[k][0] = between(d, 0.0, 1.5);
        waves[k][1] = between(d, -1.5, 1.5);
        waves[k][2] = between(d, 0.0, 6.2832);
    }
    const int period = 4 + choose(d, 12);
    for (int i = 0; i < MAP * MAP; ++i) {
        const double x = i % MAP, y = i / MAP;
        double z = sin(waves[0][0] * x + waves[0][2]) * cos(waves[0][1] * y);
        for (int k = 1; k < WAVES && kind == RELIEF_ROUGH; ++k)
            z += sin(waves[k][0] * x + waves[k][1] * y + waves[k][2]) / k;
        if (kind == RELIEF_STEPS)
            z = (i % MAP) % period < period / 2;
        p->heights[i] = height * z;
    }
    p->setup.map = (nt_height_map){p->heights, MAP, MAP, pitch, pitch};
    p->setup.x = p->setup.y = 0.5 * pitch * (MAP - 1);
}

static inline void draw_probe(plot *p, dice *d)
{
    nt_probe *probe = &p->setup.rig.probe;
    probe->spring_constant = magnitude(d, 0.05, 60.0);
    probe->tilt = chance(d, 0.5) ? 0.0 : between(d, 0.0, 0.3);
    probe->sensitivity = magnitude(d, 5e-9, 300e-9);
    probe->range = magnitude(d, 1.0, 10.0);
    probe->noise = chance(d, 0.1) && p->kind != ATTACK_FAULT ? 0.0 : probe->range * magnitude(d, 1e-4, 1e-2);
    probe->resolution = probe->range * exp2(-floor(between(d, 13.0, 20.0)));
    probe->resonance = 15e3 * pow(probe->spring_constant / 0.05, 0.45) * magnitude(d, 0.5, 2.0); /* as levers are */
    probe->quality = magnitude(d, 2.0, 1000.0);
    probe->spring_constant_sigma = between(d, 0.0, 0.15);
    probe->sensitivity_sigma = between(d, 0.0, 0.1);
    probe->drift = magnitude(d, 1e-13, 1e-8);
}

static inline void draw_stage(plot *p, dice *d)
{
    nt_stage *stage = &p->setup.rig.stage;
    stage->resonance = magnitude(d, 150.0, 5000.0);
    stage->quality = magnitude(d, 1.0, 60.0);
    stage->stiffness = magnitude(d, 1e4, 1e7);
    stage->travel = magnitude(d, 5e-6, 200e-6);
    stage->resolution = magnitude(d, 1e-11, 10e-9);
    stage->command_resolution = magnitude(d, 1e-11, 3e-9);
    stage->noise = chance(d, 0.5) ? 0.0 : magnitude(d, 1e-11, 1e-9);
    stage->max_speed = magnitude(d, 30e-6, 1e-3);
    stage->hysteresis = chance(d, 0.6) ? 0.0 : between(d, 0.0, 0.3);
    stage->creep = chance(d, 0.6) ? 0.0 : between(d, 0.0, 0.02);
    stage->drift = magnitude(d, 1e-11, 1e-7);
    stage->slip = magnitude(d, 1e-9, 100e-9);
}

static inline void draw_master(plot *p, dice *d)
{
    nt_master *master = &p->setup.rig.master;
    nt_hand *hand = &p->setup.rig.hand;
    master->mass = magnitude(d, 0.03, 1.0);
    master->damping = magnitude(d, 10.0, 300.0);
    master->friction = chance(d, 0.7) ? 0.0 : between(d, 0.0, 0.3);
    master->travel = magnitude(d, 5e-3, 0.1);
    master->resolution = magnitude(d, 1e-6, 1e-4);
    master->max_force = magnitude(d, 2.0, 20.0);
    master->gauge = !chance(d, 0.25);
    master->gauge_resolution = magnitude(d, 1e-3, 2e-2);
    master->motor = !chance(d, 0.15);
    master->rate = chance(d, 0.8) ? 0.0 : magnitude(d, 200.0, 2000.0);
    master->axes = chance(d, 0.8) ? 1.0 : 3.0;
    if (chance(d, 0.7))
        return;
    hand->damping = magnitude(d, 0.1, 10.0);
    hand->stiffness = magnitude(d, 10.0, 1000.0);
    hand->relaxation = magnitude(d, 0.01, 1.0);
    hand->random_force = between(d, 0.0, 5.0);
    hand->random_rate = magnitude(d, 1.0, 3000.0);
}

static inline void draw_rig(plot *p, dice *d)
{
    nt_converters *converters = &p->setup.rig.converters;
    draw_probe(p, d);
    draw_stage(p, d);
    draw_master(p, d);
    p->rate = magnitude(d, 1e3, 20e3);
    if (chance(d, 0.5))
        return;
    converters->adc_bits = floor(between(d, 14.0, 24.0));
    converters->dac_bits = floor(between(d, 16.0, 24.0));
    converters->adc_latency = between(d, 0.0, 0.9) / p->rate;
    converters->dac_latency = between(d, 0.0, 1.5) / p->rate;
}

/* The force at the hand where the limit trips is drawn, and a stability margin of 1.6 to 100 by rule R1: the scales
 * follow. Drawn again where another rule has less to give. */
static inline void draw_scales(plot *p, dice *d)
{
    const nt_rig *rig = &p->setup.rig;
    nt_gains *gains = &p->settings.gains;
    nt_margins margins;
    const double delay = nt_margins_loop_delay(rig, gains), lift = 1.0 + gains->stage_integral * delay;
    for (int attempt = 0; attempt < 8; ++attempt) {
        const double stiffness = rig->master.damping / (delay * lift * magnitude(d, 1.6, 100.0));
        gains->alpha_f = magnitude(d, 0.1, 10.0) / p->settings.limits.force;
        gains->alpha_p = stiffness / ((1.0 + gains->force_gain) * gains->alpha_f * rig->probe.spring_constant);
        if (nt_margins_judge(rig, &p->settings, INFINITY, NT_MODE_TOUCH, &margins).margin >= 1.5)
            return;
        gains->force_gain *= 0.7;
    }
}

static inline void draw_limits(plot *p, dice *d)
{
    const nt_rig *rig = &p->setup.rig;
    nt_limits *limits = &p->settings.limits;
    const double saturation = rig->probe.spring_constant * nt_probe_deflection_range(&rig->probe);
    const double sigma = nt_probe_force_noise(&rig->probe);
    limits->force = larger(20.0 * sigma, saturation * magnitude(d, 3e-3, 0.98));
    limits->indentation = magnitude(d, 1e-9, 1e-6);
    limits->stage_speed = magnitude(d, 0.5e-6, smaller(100e-6, rig->stage.max_speed));
    limits->lateral_speed = magnitude(d, 1e-8, 100e-6);
    limits->motor_force = rig->master.max_force;
    limits->motor_rate = magnitude(d, 100.0, 1e5);
    limits->motor_power = magnitude(d, 0.1, 100.0);
    limits->retract_distance = magnitude(d, 50e-9, 3e-6);
    limits->retract_speed = magnitude(d, 2e-6, rig->stage.max_speed);
    limits->follow_error = magnitude(d, 50e-9, 1e-6); /* and what a declared hysteresis needs besides */
    const double lost = 2.0 * rig->stage.hysteresis, integral = larger(5.0, p->settings.gains.stage_integral);
    limits->follow_error += lost / (1.0 - lost) * limits->stage_speed / integral;
    limits->follow_time = magnitude(d, 5e-3, 0.5);
    limits->gauge_bias = 10.0; /* a hand may press while it is tared */
    limits->gauge_drift = 1e3;
}

static inline void draw_settings(plot *p, dice *d)
{
    const nt_rig *rig = &p->setup.rig;
    nt_gains *gains = &p->settings.gains;
    const int gauge = rig->master.gauge;
    p->settings.control.choice = gauge ? NT_CONTROL_DEFAULT : NT_CONTROL_IMPEDANCE;
    gains->rate = p->rate;
    gains->delay = floor(between(d, 0.0, 4.0));
    gains->force_gain = gauge ? between(d, 0.0, 10.0) : 0.0;
    gains->force_filter = magnitude(d, 20.0, 1000.0);
    gains->velocity_feedforward = between(d, 0.0, 0.7);
    gains->stage_damping = between(d, 0.4, 1.2);
    gains->stage_integral = chance(d, 0.15) ? 0.0 : magnitude(d, 5.0, 200.0);
    gains->alpha_f_approach = magnitude(d, 0.5, 2.0);
    gains->alpha_f_retract = magnitude(d, 0.5, 2.0);
    gains->ramp_time = magnitude(d, 1e-3, 0.3);
    gains->height_gain = magnitude(d, 10.0, 1000.0);
    gains->height_stiffness = magnitude(d, 100.0, 10e3);
    gains->approach_speed = magnitude(d, 50e-9, 50e-6);
    gains->curve_length = magnitude(d, 10e-9, 2e-6);
    draw_limits(p, d);
    gains->set_point = between(d, 0.05, 0.95) * p->settings.limits.force;
    draw_scales(p, d);
}

/* Calibration that is off by up to 3 sigma, both together: what the session is opened with. Drifts up to those
 * declared. */
static inline void draw_errors(plot *p, dice *d)
{
    const double angle = between(d, 0.0, 6.2832), off = 2.999 * sqrt(throw_dice(d));
    const double k = 1.0 + off * cos(angle) * p->believed.probe.spring_constant_sigma;
    const double S = 1.0 + off * sin(angle) * p->believed.probe.sensitivity_sigma;
    p->setup.rig.probe.spring_constant *= k;
    p->setup.settings.limits.force *= k;
    p->setup.settings.gains.set_point *= k;
    p->setup.settings.gains.alpha_f /= k;
    const nt_fault gain = {NT_FAULT_GAIN, NT_CHANNEL_DEFLECTION, 0.0, HUGE_VAL, S};
    const nt_fault zero = {NT_FAULT_DRIFT, NT_CHANNEL_DEFLECTION, 0.0, HUGE_VAL,
                           between(d, -1.0, 1.0) * p->believed.probe.drift};
    const nt_fault frame = {NT_FAULT_DRIFT, NT_CHANNEL_STAGE, 0.0, HUGE_VAL,
                            between(d, -1.0, 1.0) * p->believed.stage.drift};
    (void)!nt_faults_add(&p->faults, &gain);
    (void)!nt_faults_add(&p->faults, &zero);
    (void)!nt_faults_add(&p->faults, &frame);
}

#endif
