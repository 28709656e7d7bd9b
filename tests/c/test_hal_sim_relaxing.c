/* SPDX-License-Identifier: BSD-3-Clause
 * A simulated tip on a sample that relaxes: pressed, held and drawn back under a lever, against Ting's law; what it
 * remembers, what a copy and another plan make of it, and where the work goes. */
#include <stdlib.h>
#include <string.h>

#include "assertions.h"
#include "hal/sim/sim.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/advanced/sim.h"
#include "nanotouch/rheology.h"

enum { TICKS = 6001 };
#define T 1e-4
static nt_plan gel, deeper, elastic;
static nt_scene scene;
static nt_rig rig;
static double times[TICKS], positions[TICKS], forces[TICKS];

static int make_plans(void **state)
{
    (void)state;
    scene = nt_scene_defaults();
    scene.tip.shape = NT_SHAPE_PARABOLOID;
    scene.tip.radius = 2.5e-6;
    scene.tip.half_angle = 0.0;
    scene.sample.poisson_ratio = 0.5;
    scene.sample.youngs_modulus = 2e3;
    scene.medium.kind = NT_MEDIUM_LIQUID;
    scene.medium.relative_humidity = 0.0;
    scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
    scene.range.maximum_load = 3e-9;
    rig = nt_rig_defaults();
    rig.probe.spring_constant = 0.06;
    rig.stage.axes = 3.0;
    rig.stage.hysteresis = rig.stage.creep = 0.0;
    const nt_demand demand = {.relative_accuracy = 0.02};
    nt_plan_inputs inputs = {.scene = &scene, .probe = &rig.probe, .demand = &demand, .period = T};
    if (nt_plan_make(&elastic, &inputs, NULL) != NT_OK)
        return 1;
    scene.rheology = (nt_rheology){.kind = NT_RHEOLOGY_PRONY,
                                   .arm_count = 2,
                                   .equilibrium_modulus = 2e3,
                                   .arm_moduli = {2e3, 1e3},
                                   .relaxation_times = {5e-3, 0.1},
                                   .modulus = 1e3,
                                   .reference_time = 1.0};
    if (nt_plan_make(&gel, &inputs, NULL) != NT_OK)
        return 1;
    scene.range.maximum_load = 5e-9;
    return nt_plan_make(&deeper, &inputs, NULL) != NT_OK;
}

static nt_sim_slave slave_of(const nt_plan *plan)
{
    const nt_sim_setup setup = {.plan = plan, .rig = &rig, .period = T, .clearance = 20e-9, .seed = 3};
    nt_sim_slave slave;
    assert_int_equal(nt_sim_slave_init(&slave, &setup), NT_OK);
    return slave;
}

static void go(nt_sim_slave *slave, double x, double travel)
{
    const nt_action action = {.size = sizeof action, .target = {x, 0.0, travel}};
    assert_int_equal(nt_sim_slave_write(slave, &action), NT_OK);
}

/* Down in 0.1 s, held for 0.3 s, back in 0.2 s. */
static double travel_at(int i)
{
    return 250e-9 * smaller(i / 1000.0, i > 4000 ? (6000 - i) / 2000.0 * 1.0 : 1.0);
}

/* The stage has its own dynamics: where the base really was is what Ting's law is asked for. */
static void follows_ting(void **unused)
{
    (void)unused;
    nt_sim_slave slave = slave_of(&gel);
    const nt_viscoelastic contact = {.shape = gel.shape,
                                     .rheology = scene.rheology,
                                     .poisson_ratio = 0.5,
                                     .spring_constant = rig.probe.spring_constant / cos(rig.probe.tilt)};
    double most = gel.scale, peak = 0.0, held = 0.0;
    static double found[TICKS];
    for (int i = 0; i < TICKS; i++) {
        go(&slave, 0.0, travel_at(i));
        times[i] = T * (i + 1);
        positions[i] = slave.stage.position - 20e-9;
        found[i] = slave.truth.tip_force[NT_Z];
        peak = larger(peak, found[i]);
        held = i == 3999 ? found[i] : held;
    }
    double *workspace = malloc(sizeof(double) * (size_t)nt_viscoelastic_workspace(&contact, TICKS, 0));
    const nt_viscoelastic_path path = {times, positions, 0.0, TICKS, workspace};
    assert_int_equal(nt_viscoelastic_run(&contact, &path, &(nt_viscoelastic_result){.forces = forces}, NULL), NT_OK);
    for (int i = 0; i < TICKS; i++) {
        most = larger(most, forces[i]);
        assert_within(found[i], forces[i], gel.bound.force_error * most);
    }
    free(workspace);
    assert_true(peak > 0.2e-9 && held < 0.95 * peak); /* it is felt to relax */
    assert_true(found[TICKS - 1] == 0.0);
}

/* A tip that comes down again before the dent is gone meets less; at another place all of it. */
static void a_dent_is_where_it_was_made(void **unused)
{
    (void)unused;
    double again[2];
    for (int elsewhere = 0; elsewhere < 2; elsewhere++) {
        nt_sim_slave slave = slave_of(&gel);
        for (int i = 0; i < 1000; i++)
            go(&slave, 0.0, 200e-9);
        for (int i = 0; i < 80; i++)
            go(&slave, 0.0, 0.0);
        assert_true(slave.truth.tip_force[NT_Z] == 0.0 && slave.relaxing.state.touched > 0);
        for (int i = 0; i < 20; i++)
            go(&slave, elsewhere ? 5e-6 : 0.0, 0.0);
        for (int i = 0; i < 40; i++)
            go(&slave, elsewhere ? 5e-6 : 0.0, 100e-9);
        again[elsewhere] = slave.truth.tip_force[NT_Z];
    }
    assert_true(again[0] < 0.8 * again[1]);
}

/* What the base gives is no less than what lever and sample hold: over a random drive, at each tick. */
static void no_drive_gives_energy(void **unused)
{
    (void)unused;
    nt_random random = nt_random_seed(7);
    nt_sim_slave slave = slave_of(&gel);
    const double spring = rig.probe.spring_constant / cos(rig.probe.tilt);
    double target = 0.0, before = slave.stage.position, held = 0.0;
    for (int i = 0; i < 4000; i++) {
        if (i % 20 == 0)
            target = 220e-9 * nt_random_uniform(&random);
        go(&slave, 0.0, target);
        const double force = slave.truth.tip_force[NT_Z], work = force * (slave.stage.position - before);
        const double now = slave.truth.energy + 0.5 * force * force / spring;
        assert_true(work - (now - held) >= -1e-6 * larger(now, held)); /* Newton's last step */
        before = slave.stage.position;
        held = now;
    }
}

static void a_copy_goes_on_with_the_same_bits(void **unused)
{
    (void)unused;
    static nt_sim_slave slave, copy;
    slave = slave_of(&gel);
    for (int i = 0; i < 1500; i++)
        go(&slave, 0.0, travel_at(i));
    copy = slave;
    for (int i = 1500; i < 6000; i++) {
        go(&slave, 0.0, travel_at(i));
        go(&copy, 0.0, travel_at(i));
        assert_memory_equal(&slave.truth, &copy.truth, sizeof slave.truth);
    }
}

/* While it is pressed: more depth changes nothing that is felt; a sample that begins to relax has relaxed. */
static void another_plan_makes_no_jump(void **unused)
{
    (void)unused;
    nt_sim_slave slave = slave_of(&gel);
    for (int i = 0; i < 1200; i++)
        go(&slave, 0.0, travel_at(i));
    const double before = slave.truth.tip_force[NT_Z];
    nt_sim_change_plan(&slave, &deeper);
    go(&slave, 0.0, travel_at(1200));
    assert_within(slave.truth.tip_force[NT_Z], before, 0.01 * before);
    nt_sim_slave other = slave_of(&elastic);
    for (int i = 0; i < 1200; i++)
        go(&other, 0.0, travel_at(i));
    const double at_rest = other.truth.tip_force[NT_Z];
    nt_sim_change_plan(&other, &gel);
    for (int i = 0; i < 20; i++)
        go(&other, 0.0, travel_at(1200));
    assert_within(other.truth.tip_force[NT_Z], at_rest, 0.01 * at_rest); /* E_inf is its modulus */
    nt_sim_change_plan(&other, &elastic);
    go(&other, 0.0, 0.0);
    for (int i = 0; i < 60; i++)
        go(&other, 0.0, 0.0);
    assert_true(other.truth.tip_force[NT_Z] == 0.0);
}

/* Deeper than the springs are: no reading. A dynamic lever, a lever that taps, a loop of another period: refused. */
static void refuses(void **unused)
{
    (void)unused;
    nt_sim_slave slave = slave_of(&gel);
    nt_status status = NT_OK;
    for (int i = 0; i < 20000 && status == NT_OK; i++) {
        const nt_action action = {.size = sizeof action, .target = {0.0, 0.0, smaller(1e-9 * i, 4.9e-6)}};
        status = nt_sim_slave_write(&slave, &action);
    }
    assert_int_equal(status, NT_E_DEVICE);
    nt_sim_setup setup = {.plan = &gel, .rig = &rig, .period = T, .clearance = 20e-9, .probe_model = NT_PROBE_DYNAMIC};
    assert_int_equal(nt_sim_slave_init(&slave, &setup), NT_E_UNSUPPORTED);
    setup.probe_model = NT_PROBE_AUTO;
    setup.period = 2e-4;
    assert_int_equal(nt_sim_slave_init(&slave, &setup), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(follows_ting),
        cmocka_unit_test(a_dent_is_where_it_was_made),
        cmocka_unit_test(no_drive_gives_energy),
        cmocka_unit_test(a_copy_goes_on_with_the_same_bits),
        cmocka_unit_test(another_plan_makes_no_jump),
        cmocka_unit_test(refuses),
    };
    return cmocka_run_group_tests(tests, make_plans, NULL);
}
