/* SPDX-License-Identifier: BSD-3-Clause
 * A tip that rubs under a hand of three axes: rigs, friction and hills, given or of the dice. */
#ifndef TESTS_SIDEWAYS_DRAWS_H
#define TESTS_SIDEWAYS_DRAWS_H

#include <math.h>
#include <string.h>

#include "assertions.h"
#include "control/margins.h"
#include "hal/sim/sim.h"
#include "internal/hazard.h"
#include "larger.h"
#include "loop_fixture.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/margins.h"
#include "nanotouch/plan.h"
#include "scene/interaction.h"

#define LEVER 50.0 /* k_l [N/m] */
#define DRY 1e12   /* a shear strength under which nothing slips [Pa] */

/* No noise, no steps, strong actuators: what is left are contact, delays and holds. */
static inline nt_session_setup rubbing(double shear_strength, double coefficient)
{
    nt_session_setup setup = nt_session_defaults();
    nt_rig *rig = &setup.rig;
    rig->probe.noise = rig->probe.resolution = rig->stage.resolution = rig->stage.command_resolution = 0.0;
    rig->master.resolution = rig->master.gauge_noise = rig->master.gauge_resolution = rig->probe.temperature = 0.0;
    rig->master.max_force = 1000.0;
    rig->master.axes = 3.0;
    rig->probe.lateral_stiffness = LEVER;
    setup.scene.medium.relative_humidity = 0.0;
    setup.scene.adhesion.work_of_adhesion = setup.scene.adhesion.hamaker_constant = 0.0;
    setup.scene.friction = (nt_scene_friction){shear_strength, coefficient, 0.005};
    setup.clearance = 5e-9;
    setup.settings = nt_settings_defaults(rig);
    setup.settings.gains.alpha_f = 1e6;
    setup.settings.limits.motor_rate = 1e9;
    setup.settings.limits.motor_power = 1e6;
    setup.settings.limits.motor_force = 1000.0;
    setup.settings.limits.lateral_speed = 1.0;
    setup.settings.limits.lateral_force = 1e-3;
    setup.probe_model = NT_PROBE_QUASI_STATIC;
    return setup;
}

static inline void push(loop *l, double x, double y, double z, double duration)
{
    const nt_hand_target target = {.force = {x, y, z}, .duration = duration};
    nt_sim_aim_hand(&l->sim.master, &target);
}

static inline void tie_hands(const nt_passivity *of, nt_passivity_state *state)
{
    state->energy = NT_PASSIVITY_STORE * of->dead_zone;
    state->gain = 1.0;
}

/* Runs a while. free: bits of what may take gain away, the observer along z and that of x and y. */
enum { FREE_Z = 1, FREE_SIDEWAYS = 2 };
static inline void run_with(loop *l, double time, int free)
{
    nt_passivity_state *sideways = l->state.passivity_sideways;
    for (double t = 0.0; t < time; t += l->touch.period) {
        if (!(free & FREE_Z))
            tie_hands(&l->touch.passivity, &l->state.passivity);
        for (int i = 0; i < 2 && !(free & FREE_SIDEWAYS); ++i)
            tie_hands(&l->touch.passivity_sideways, &sideways[i]);
        assert_int_equal(loop_tick(l, NULL, NULL), NT_OK);
    }
}

/* With the observer's hands tied. */
static inline void run(loop *l, double time)
{
    run_with(l, time, 0);
}

static inline double limit_of(const loop *l)
{
    const nt_friction_contact contact =
        nt_interaction_friction_contact(&l->plan, &l->sim.slave.interaction, NULL, l->sim.slave.truth.gap);
    return nt_friction_limit(&l->plan.friction.law, &contact);
}

enum { N = 48 };

/* A scene of the dice: rig, law, friction, adhesion or none, hills of up to 30 degrees. */
typedef struct drawn {
    nt_session_setup setup;
    nt_surface surface;
    double coefficients[N * N];
    double slope, load;
} drawn;

static inline double between(nt_random *random, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(random));
}

static inline void draw_hills(drawn *d, nt_random *random)
{
    static double heights[N * N];
    const double wave = 0.2 + 0.2 * nt_random_uniform(random), size = 0.5 * nt_random_uniform(random) / wave;
    for (int i = 0; i < N * N; ++i)
        heights[i] = 20e-9 * size * sin(wave * (i % N)) * cos(0.7 * wave * (i / N));
    const nt_height_map map = {heights, N, N, 20e-9, 20e-9};
    assert_int_equal(nt_surface_init(&d->surface, &map, d->coefficients), NT_OK);
    d->setup.surface = &d->surface;
    d->setup.x = 20e-9 * (10.0 + 25.0 * nt_random_uniform(random));
    d->setup.y = 20e-9 * (10.0 + 25.0 * nt_random_uniform(random));
    d->slope = size * wave * hypot(1.0, 0.7);
}

static inline void draw(drawn *d, nt_random *random)
{
    memset(d, 0, sizeof *d);
    d->setup = rubbing(between(random, 10e6, 1e9), 0.6 * nt_random_uniform(random));
    nt_session_setup *setup = &d->setup;
    nt_gains *gains = &setup->settings.gains;
    gains->rate = floor(between(random, 1e3, 2e4));
    gains->delay = floor(3.0 * nt_random_uniform(random));
    gains->force_gain = nt_random_uniform(random) < 0.5 ? 0.0 : between(random, 0.5, 8.0);
    setup->rig.master.mass = between(random, 0.03, 0.3);
    setup->rig.master.damping = between(random, 20.0, 200.0);
    setup->rig.probe.lateral_stiffness = between(random, 5.0, 300.0);
    setup->scene.adhesion.work_of_adhesion = nt_random_uniform(random) < 0.5 ? 0.0 : 0.02;
    setup->settings.limits.stage_speed = setup->rig.stage.max_speed = 1.0;
    d->load = between(random, 20e-9, 200e-9);
    setup->settings.limits.force = 1.5 * d->load;
    setup->settings.limits.indentation = 1e-6;
    setup->settings.gains.set_point = d->load;
    draw_hills(d, random);
}

/* The scale at which the least margin is 1; *parts: those of z, of x and y, of all together. */
static inline double scale_at_the_limit(const drawn *d, double parts[3])
{
    static loop l;
    assert_int_equal(loop_open(&l, &d->setup), NT_OK);
    const nt_sideways_contact grip = nt_grip_of(&l.plan, d->slope, d->setup.settings.limits.force);
    nt_margins along_z;
    parts[0] =
        nt_margins_judge(&d->setup.rig, &d->setup.settings, l.plan.maximum_stiffness, NT_MODE_TOUCH, &along_z).margin;
    const nt_sideways_margins found =
        nt_margins_sideways(&d->setup.rig, &d->setup.settings, l.plan.maximum_stiffness, &grip, &along_z);
    parts[1] = smaller(found.margin, found.exact_limit / found.loop_stiffness);
    parts[2] = found.coupled_margin;
    return d->setup.settings.gains.alpha_f * smaller(parts[0], smaller(parts[1], parts[2]));
}

static inline double noise(nt_random *random)
{
    return 2.0 * nt_random_uniform(random) - 1.0;
}

#endif
