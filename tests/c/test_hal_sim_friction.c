/* SPDX-License-Identifier: BSD-3-Clause
 * A simulated tip that rubs: its force sideways, the lever that shows it, and where the work goes. */
#include <string.h>

#include "assertions.h"
#include "hal/sim/sim.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/advanced/sim.h"
#include "scene/interaction.h"

#define T 1e-4
static nt_plan rough, smooth;
static nt_rig rig;

static int make_plans(void **state)
{
    (void)state;
    nt_scene scene = nt_scene_defaults();
    rig = nt_rig_defaults();
    rig.stage.axes = 3.0;
    rig.probe.lateral_stiffness = 50.0;
    nt_plan_inputs inputs = {.scene = &scene, .probe = &rig.probe};
    if (nt_plan_make(&smooth, &inputs, NULL) != NT_OK)
        return 1;
    scene.friction = (nt_scene_friction){200e6, 0.2, 0.005};
    return nt_plan_make(&rough, &inputs, NULL) != NT_OK;
}

static nt_sim_slave slave_of(const nt_plan *plan, nt_probe_model model)
{
    const nt_sim_setup setup = {
        .plan = plan, .rig = &rig, .period = T, .clearance = 5e-9, .seed = 3, .probe_model = model};
    nt_sim_slave slave;
    assert_int_equal(nt_sim_slave_init(&slave, &setup), NT_OK);
    return slave;
}

static void go(nt_sim_slave *slave, double x, double y, double travel)
{
    const nt_action action = {.size = sizeof action, .target = {x, y, travel}};
    assert_int_equal(nt_sim_slave_write(slave, &action), NT_OK);
}

/* Pressed, rubbed there and back by 10 nm: half the loop's width is the limit of friction, which the lever shows. */
static void the_lever_shows_the_loop(void **state)
{
    (void)state;
    nt_sim_slave slave = slave_of(&rough, NT_PROBE_QUASI_STATIC);
    for (int i = 0; i < 3000; i++)
        go(&slave, 0.0, 0.0, smaller(1e-11 * i, 12e-9));
    double loop[2];
    for (int back = 0; back < 2; back++) {
        for (int i = 1; i <= 1000; i++)
            go(&slave, 1e-11 * (back ? 1000 - i : i), 0.0, 12e-9);
        nt_reading reading = {0};
        assert_int_equal(nt_sim_slave_read(&slave, &reading), NT_OK);
        loop[back] = reading.felt[NT_X] * rig.probe.lateral_stiffness;
        assert_within(loop[back], slave.truth.tip_force[NT_X], 1e-15 * fabs(loop[back]) * 4);
        assert_true(reading.felt[NT_Y] == 0.0);
    }
    const nt_friction_contact contact =
        nt_interaction_friction_contact(&rough, &slave.interaction, NULL, slave.truth.gap);
    const double limit = 200e6 * NT_PI * contact.radius * contact.radius + 0.2 * contact.compressive_load;
    assert_true(limit > 1e-9);
    assert_within(0.5 * (loop[1] - loop[0]), limit, 1e-3 * limit); /* what the stage still rings */
}

/* Random ways through and out of contact: stored and dissipated are the work, integrated here by the trapezoidal rule,
 * 1 % of the turnover; heat never falls; what is vertical has the bits of a scene without friction. */
static void rubbing_only_takes(nt_probe_model model)
{
    nt_sim_slave slave = slave_of(&rough, model), bare = slave_of(&smooth, model);
    nt_random random = nt_random_seed(11);
    double work = 0.0, turnover = 0.0, x = 0.0, y = 0.0, heat = 0.0, dx = 0.0, dy = 0.0;
    int touched = 0;
    for (int i = 0; i < 8000; i++) {
        if (i % 200 == 0) {
            dx = 2e-12 * (nt_random_uniform(&random) - 0.5);
            dy = 2e-12 * (nt_random_uniform(&random) - 0.5);
        }
        const double before[2] = {slave.truth.tip_force[NT_X], slave.truth.tip_force[NT_Y]};
        x += dx;
        y += dy;
        go(&slave, x, y, 5e-9 + 10e-9 * sin(0.004 * i));
        go(&bare, x, y, 5e-9 + 10e-9 * sin(0.004 * i));
        const double step =
            -0.5 * ((before[0] + slave.truth.tip_force[NT_X]) * dx + (before[1] + slave.truth.tip_force[NT_Y]) * dy);
        work += step;
        turnover += fabs(step);
        assert_true(slave.truth.friction_heat >= heat);
        heat = slave.truth.friction_heat;
        assert_true(slave.truth.gap == bare.truth.gap && slave.truth.tip_force[NT_Z] == bare.truth.tip_force[NT_Z]);
        assert_true(slave.truth.energy == bare.truth.energy);
        touched += slave.truth.contact_radius > 0.0 && i > 0;
    }
    assert_true(touched > 800 && touched < 7200);
    assert_true(bare.truth.friction_heat == 0.0 && bare.truth.tip_force[NT_X] == 0.0);
    assert_within(slave.truth.friction_stored + heat, work, 0.01 * turnover);
}

static void rubbing_only_takes_at_rest(void **state)
{
    (void)state;
    rubbing_only_takes(NT_PROBE_QUASI_STATIC);
}

static void rubbing_only_takes_in_motion(void **state)
{
    (void)state;
    rubbing_only_takes(NT_PROBE_DYNAMIC);
}

/* A copy of the half goes on with the same bits. */
static void a_snapshot_goes_on_alike(void **state)
{
    (void)state;
    nt_sim_slave slave = slave_of(&rough, NT_PROBE_QUASI_STATIC);
    for (int i = 0; i < 2000; i++)
        go(&slave, 2e-12 * i, 0.0, 12e-9);
    nt_sim_slave copy = slave;
    for (int i = 0; i < 2000; i++) {
        go(&slave, 0.0, 2e-12 * i, 12e-9);
        go(&copy, 0.0, 2e-12 * i, 12e-9);
        assert_memory_equal(&slave.truth, &copy.truth, sizeof slave.truth);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_lever_shows_the_loop),
        cmocka_unit_test(rubbing_only_takes_at_rest),
        cmocka_unit_test(rubbing_only_takes_in_motion),
        cmocka_unit_test(a_snapshot_goes_on_alike),
    };
    return cmocka_run_group_tests(tests, make_plans, NULL);
}
