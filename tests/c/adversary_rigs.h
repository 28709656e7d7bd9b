/* SPDX-License-Identifier: BSD-3-Clause
 * Rigs that a search attacks: what a user may well have, beside the default one. */
#ifndef TESTS_ADVERSARY_RIGS_H
#define TESTS_ADVERSARY_RIGS_H

#include "adversary_dice.h"

typedef struct known_rig {
    const char *name;
    void (*tune)(plot *p);
} known_rig;

static inline void tune_default(plot *p)
{
    p->settings = p->setup.settings;
}

/* Contact mode on a polymer. */
static inline void tune_soft(plot *p)
{
    p->setup.rig.probe.spring_constant = 0.3;
    p->setup.rig.probe.resonance = 40e3;
    p->setup.scene.sample.youngs_modulus = 2e9;
    p->settings = nt_settings_defaults(&p->setup.rig);
    p->settings.limits.force = 50e-9;
    p->settings.limits.stage_speed = 2e-6;
    p->settings.limits.indentation = 30e-9;
    p->settings.gains.set_point = 10e-9;
    p->settings.gains.alpha_f = 4e7;
}

/* A stiff lever on a stage with a servo of its own. */
static inline void tune_stiff(plot *p)
{
    p->setup.rig.probe.spring_constant = 40.0;
    p->setup.rig.probe.resonance = 300e3;
    p->setup.rig.stage = nt_stage_closed_loop();
    p->setup.rig.stage.resonance = 1500.0;
    p->settings = nt_settings_defaults(&p->setup.rig);
    p->settings.limits.stage_speed = 50e-6;
}

/* An open-loop piezo without an integral: hysteresis and creep stay. */
static inline void tune_open(plot *p)
{
    p->setup.rig.stage = nt_stage_open_loop();
    p->setup.rig.stage.travel = 10e-6;
    p->settings = nt_settings_defaults(&p->setup.rig);
    p->settings.gains.stage_integral = 0.0;
}

static const known_rig known_rigs[] = {
    {"default", tune_default}, {"soft", tune_soft}, {"stiff", tune_stiff}, {"open-loop", tune_open}};
enum { KNOWN_RIGS = (int)(sizeof known_rigs / sizeof known_rigs[0]) };

#endif
