/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "hal/hal.h"
#include "hal/sim/sim.h"
#include "larger.h"
#include "nanotouch/advanced/sim.h"

#define T 1e-4
enum { N = 16 };
#define SAMPLE_BYTES (offsetof(nt_sample, flags) + sizeof(uint32_t)) /* without the padding behind */
static nt_plan plan;
static nt_rig rig;
static double coefficients[N * N];
static nt_surface surface;

static int make_plan(void **state)
{
    (void)state;
    static double heights[N * N];
    const nt_scene scene = nt_scene_defaults();
    const nt_plan_inputs inputs = {.scene = &scene};
    for (int i = 0; i < N * N; i++)
        heights[i] = 5e-9 * sin(0.8 * (i % N)) + 1e-9 * (i / N);
    const nt_height_map map = {heights, N, N, 20e-9, 20e-9};
    rig = nt_rig_defaults();
    return nt_surface_init(&surface, &map, coefficients) != NT_OK || nt_plan_make(&plan, &inputs, NULL) != NT_OK;
}

static nt_sim_setup setup_of(uint64_t seed, int delay)
{
    return (nt_sim_setup){.plan = &plan, .rig = &rig, .period = T, .clearance = 50e-9, .seed = seed, .delay = delay};
}

static nt_sim sim_of(const nt_sim_setup *setup)
{
    nt_sim sim;
    assert_int_equal(nt_sim_init(&sim, setup), NT_OK);
    return sim;
}

/* A command that moves everything, different at each tick: in contact from tick 600 on, out again at 1700. */
static nt_command script(uint64_t tick)
{
    const double t = (double)tick;
    return (nt_command){.motor_force[NT_Z] = sin(0.01 * t),
                        .stage_position[NT_Z] = 60e-9 * sin(0.00157 * t),
                        .stage_position[NT_X] = 1e-9 * t,
                        .stage_position[NT_Y] = 2e-9 * t};
}

static void a_copy_replays_to_the_last_bit(void **state)
{
    (void)state;
    const nt_sim_setup setup = setup_of(7, 2);
    nt_sim sim = sim_of(&setup);
    const nt_hand_target push = {.force = {[NT_Z] = 1.0}, .duration = 0.1};
    nt_sim_aim_hand(&sim.master, &push);
    nt_sim copy = sim;
    int touched = 0;
    for (uint64_t i = 0; i < 4000; i++) {
        nt_sample a, b;
        const nt_command command = script(i);
        if (i == 800) /* a snapshot in contact goes on as the original does */
            copy = sim;
        assert_int_equal(nt_sim_read(&sim, &a), NT_OK);
        assert_int_equal(nt_sim_read(&copy, &b), NT_OK);
        assert_memory_equal(&a, &b, SAMPLE_BYTES);
        assert_memory_equal(&sim.slave.truth, &copy.slave.truth, sizeof sim.slave.truth);
        assert_int_equal(nt_sim_write(&sim, &command), NT_OK);
        assert_int_equal(nt_sim_write(&copy, &command), NT_OK);
        touched |= sim.slave.truth.contact_radius > 0.0;
    }
    assert_true(touched);
}

static void seeds_make_the_noise_and_nothing_else(void **state)
{
    (void)state;
    const nt_sim_setup one = setup_of(1, 0), two = setup_of(2, 0);
    nt_sim a = sim_of(&one), b = sim_of(&two);
    double square = 0.0;
    int differ = 0;
    enum { COUNT = 20000 };
    for (int i = 0; i < COUNT; i++) {
        nt_sample x, y;
        const nt_command rest = {0};
        nt_sim_read(&a, &x);
        nt_sim_read(&b, &y);
        differ += x.deflection[NT_Z] != y.deflection[NT_Z];
        square += x.deflection[NT_Z] * x.deflection[NT_Z];
        nt_sim_write(&a, &rest);
        nt_sim_write(&b, &rest);
        assert_memory_equal(&a.slave.truth, &b.slave.truth, sizeof a.slave.truth);
    }
    assert_true(differ > COUNT * 0.9);
    /* sigma = S 50 mV/6 and the converter's steps; 20 000 samples: 0.5 % */
    const double sigma = rig.probe.sensitivity * rig.probe.noise / 6.0,
                 step = rig.probe.sensitivity * rig.probe.resolution;
    assert_true(fabs(sqrt(square / COUNT) / hypot(sigma, step / sqrt(12.0)) - 1.0) < 0.02);
}

/* A command written in tick k acts from tick k + delay on: the sample of tick k + delay + 1 is the first to show it. */
static void delay_is_exact(void **state)
{
    (void)state;
    nt_rig exact = rig;
    exact.master.resolution = exact.stage.resolution = exact.stage.command_resolution = 0.0;
    for (int delay = 0; delay <= NT_SIM_DELAY_MAX; delay += delay < 14 ? 1 : 16) { /* the last one is the largest */
        nt_sim_setup setup = setup_of(1, delay);
        setup.rig = &exact;
        nt_sim sim = sim_of(&setup);
        const uint64_t sent = 40;
        uint64_t master_moved = 0, stage_moved = 0, x_moved = 0;
        for (uint64_t i = 0; i < sent + (uint64_t)delay + 20; i++) {
            nt_sample sample;
            nt_sim_read(&sim, &sample);
            assert_int_equal(sample.tick, i);
            if (!master_moved && sample.master_position[NT_Z] != 0.0)
                master_moved = i;
            if (!stage_moved && sample.stage_position[NT_Z] > 1e-13) /* not the pull of the surface */
                stage_moved = i;
            if (!x_moved && sample.stage_position[NT_X] != 0.0)
                x_moved = i;
            const nt_command impulse = {.motor_force[NT_Z] = 1.0,
                                        .stage_position[NT_Z] = 5e-9,
                                        .stage_position[NT_X] = 1e-9},
                             rest = {0};
            nt_sim_write(&sim, i == sent ? &impulse : &rest);
        }
        assert_int_equal(master_moved, sent + (uint64_t)delay + 1);
        assert_int_equal(stage_moved, sent + (uint64_t)delay + 1);
        assert_int_equal(x_moved, sent + (uint64_t)delay + 1);
    }
}

static int is_multiple(double value, double step)
{
    return fabs(value / step - round(value / step)) < 1e-6;
}

/* The gauge shows the hand's force in steps of 0.02 N up to 5 N; the master moves by m v' + b v = f: 50 mm/s at 5 N. */
static void hand_gauge_and_master(void **state)
{
    (void)state;
    nt_sim_setup setup = setup_of(3, 0);
    setup.master_position = -9e-3;
    nt_sim sim = sim_of(&setup);
    const nt_hand_target push = {.force = {[NT_Z] = 4.0}, .duration = 0.2},
                         hard = {.force = {[NT_Z] = 8.0}, .duration = 0.0};
    const nt_command rest = {0};
    nt_sample sample;
    nt_sim_aim_hand(&sim.master, &push);
    for (int i = 0; i < 2500; i++) {
        nt_sim_read(&sim, &sample);
        const double force = 4.0 * smaller(1.0, i * T / 0.2);
        assert_true(is_multiple(sample.operator_force[NT_Z], 0.02) &&
                    fabs(sample.operator_force[NT_Z] - force) < 0.01 + 6 * 0.0034);
        assert_true(is_multiple(sample.master_position[NT_Z], 4e-5));
        assert_true(fabs(sample.master_position[NT_Z] - sim.master.arm[NT_Z].position) <= 2.01e-5);
        assert_true(is_multiple(sample.deflection[NT_Z], rig.probe.sensitivity * rig.probe.resolution));
        assert_true(is_multiple(sample.stage_position[NT_Z], 1e-9));
        nt_sim_write(&sim, &rest);
    }
    assert_true(fabs(sim.master.arm[NT_Z].speed / (4.0 / 100.0) - 1.0) < 1e-6);
    nt_sim_aim_hand(&sim.master, &hard);
    nt_sim_read(&sim, &sample);
    assert_true(sample.operator_force[NT_Z] == 5.0); /* clipped */
    for (int i = 0; i < 5000; i++)
        nt_sim_write(&sim, &rest);
    assert_true(sim.master.arm[NT_Z].position == 0.5 * rig.master.travel &&
                sim.master.arm[NT_Z].speed == 0.0); /* end stop */
}

/* The motor pushes with its own force, no more; the driver keeps the stage's speed and travel. */
static void actuators_have_their_limits(void **state)
{
    (void)state;
    nt_rig small = rig;
    small.stage.travel = 1e-6;
    nt_sim_setup setup = setup_of(3, 0);
    setup.rig = &small;
    nt_sim sim = sim_of(&setup);
    const nt_command wild = {.motor_force[NT_Z] = -1e6, .stage_position[NT_Z] = -1.0};
    double fastest = 0.0;
    for (int i = 0; i < 1000; i++) {
        const double before = sim.slave.stage_drive;
        assert_int_equal(nt_sim_write(&sim, &wild), NT_OK);
        fastest = larger(fastest, before - sim.slave.stage_drive);
        assert_true(sim.master.arm[NT_Z].speed >= -5.0 / 100.0 * (1.0 + 1e-12));
    }
    assert_true(fabs(fastest - small.stage.max_speed * T) < 1e-18);
    assert_true(sim.slave.stage_drive == -0.5e-6);
}

static void a_command_that_is_not_a_number_is_refused(void **state)
{
    (void)state;
    const nt_sim_setup setup = setup_of(3, 1);
    nt_sim sim = sim_of(&setup);
    const nt_sim before = sim;
    const nt_command bad[] = {{.motor_force[NT_Z] = NAN},
                              {.stage_position[NT_Z] = HUGE_VAL},
                              {.stage_position[NT_X] = NAN},
                              {.stage_position[NT_Y] = -HUGE_VAL}};
    for (int i = 0; i < 4; i++)
        assert_int_equal(nt_sim_write(&sim, &bad[i]), NT_E_NOT_FINITE);
    assert_memory_equal(&sim, &before, sizeof sim);
}

/* Pressed into contact by a soft stage (k_stage = 1000 N/m, damped): at rest tip, probe and stage are in balance:
 * F = k_c zeta, and the stage is pushed back by F/k_stage. */
static void the_surface_pushes_back(void **state)
{
    (void)state;
    nt_rig soft = rig;
    soft.stage.stiffness = 1000.0;
    soft.stage.quality = 0.7;
    soft.stage.command_resolution = 0.0;
    nt_sim_setup setup = setup_of(3, 0);
    setup.rig = &soft;
    nt_sim sim = sim_of(&setup);
    const nt_command press = {.stage_position[NT_Z] = 150e-9};
    for (int i = 0; i < 5000; i++) {
        assert_int_equal(nt_sim_write(&sim, &press), NT_OK);
        /* at every tick: the probe is in balance (to 1e-7 of the range of adhesion, 1.1 nm, times k_c) */
        assert_true(fabs(soft.probe.spring_constant * sim.slave.cantilever.deflection -
                         sim.slave.truth.tip_force[NT_Z]) < 1e-15);
        const double base = sim.slave.start_height - sim.slave.stage.position;
        assert_true(fabs(sim.slave.truth.tip_height - base - sim.slave.cantilever.deflection) < 1e-20);
        assert_true(sim.slave.truth.gap == sim.slave.truth.tip_height - sim.slave.truth.surface_height);
    }
    assert_true(sim.slave.truth.tip_force[NT_Z] > 0.5e-6 && sim.slave.truth.contact_radius > 1e-9);
    assert_true(fabs(150e-9 - sim.slave.stage.position - sim.slave.truth.tip_force[NT_Z] / 1000.0) < 1e-15);
    const double spring =
        150e-9 - 50e-9 - sim.slave.truth.tip_force[NT_Z] / 1000.0; /* base below the surface by this */
    assert_true(fabs(sim.slave.cantilever.deflection - spring - sim.slave.truth.gap) < 1e-15);
}

/* Through jump-in and pull-off and back: the surface has taken energy from the probe, the more the slower. */
static void a_cycle_of_touch_dissipates(void **state)
{
    (void)state;
    nt_rig ideal = rig;
    ideal.stage.resonance = 1e5; /* quick and damped: the stage is where it is told to be */
    ideal.stage.quality = 0.5;
    ideal.stage.command_resolution = 0.0;
    nt_sim_setup setup = setup_of(3, 0);
    setup.rig = &ideal;
    setup.clearance = 20e-9;
    nt_sim sim = sim_of(&setup);
    double work = 0.0, strongest_pull = 0.0;
    for (int i = 0; i <= 40000; i++) {
        const nt_command command = {.stage_position[NT_Z] = 25e-9 * (1.0 - fabs(i / 20000.0 - 1.0))};
        const double base = sim.slave.stage.position, force = sim.slave.truth.tip_force[NT_Z];
        assert_int_equal(nt_sim_write(&sim, &command), NT_OK);
        work += 0.5 * (force + sim.slave.truth.tip_force[NT_Z]) *
                (sim.slave.stage.position - base); /* done by the stage on the probe */
        strongest_pull = larger(strongest_pull, -sim.slave.truth.tip_force[NT_Z]);
    }
    assert_true(fabs(strongest_pull / plan.pull_off_force - 1.0) <
                0.02); /* a spring of 8 N/m is nearly a dead weight */
    assert_true(sim.slave.truth.contact_radius == 0.0 && sim.slave.interaction.attached == 0);
    /* snap-off alone gives away the spring's energy, F^2/(2 k_c) */
    assert_true(work > 0.5 * plan.pull_off_force * plan.pull_off_force / (2.0 * rig.probe.spring_constant));
}

static void the_surface_under_the_tip_is_the_maps(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    const nt_plan_inputs inputs = {.scene = &scene, .surface = &surface};
    static nt_plan bumpy;
    assert_int_equal(nt_plan_make(&bumpy, &inputs, NULL), NT_OK);
    nt_sim_setup setup = setup_of(3, 0);
    setup.plan = &bumpy;
    setup.x = 100e-9;
    setup.y = 60e-9;
    nt_sim sim = sim_of(&setup);
    assert_true(sim.slave.start_height == nt_surface_height(&surface, 100e-9, 60e-9).z + 50e-9);
    for (int i = 0; i < 1000; i++) {
        const nt_command command = {.stage_position[NT_X] = (100.0 + 0.1 * i) * 1e-9,
                                    .stage_position[NT_Y] = (60.0 + 0.05 * i) * 1e-9};
        assert_int_equal(nt_sim_write(&sim, &command), NT_OK);
        assert_true(sim.slave.truth.surface_height ==
                    nt_surface_height(&surface, command.stage_position[NT_X], command.stage_position[NT_Y]).z);
        assert_true(sim.slave.x == command.stage_position[NT_X] && sim.slave.y == command.stage_position[NT_Y]);
    }
}

static void setups_are_checked(void **state)
{
    (void)state;
    const nt_sim_setup good = setup_of(1, 0);
    nt_sim sim;
    nt_sim_setup bad = good;
    bad.plan = NULL;
    assert_int_equal(nt_sim_init(&sim, &bad), NT_E_ARGUMENT);
    bad = good;
    bad.rig = NULL;
    assert_int_equal(nt_sim_init(&sim, &bad), NT_E_ARGUMENT);
    bad = good;
    bad.delay = NT_SIM_DELAY_MAX + 0.1;
    assert_int_equal(nt_sim_init(&sim, &bad), NT_E_RANGE);
    bad = good;
    bad.delay = -0.1;
    assert_int_equal(nt_sim_init(&sim, &bad), NT_E_RANGE);
    bad = good;
    bad.x = NAN;
    assert_int_equal(nt_sim_init(&sim, &bad), NT_E_NOT_FINITE);
    bad = good;
    bad.clearance = 0.5e-9;
    assert_int_equal(nt_sim_init(&sim, &bad), NT_E_RANGE);
    bad = good;
    bad.master_position = 0.011;
    assert_int_equal(nt_sim_init(&sim, &bad), NT_E_RANGE);
    bad = good;
    bad.period = 0.0;
    assert_int_not_equal(nt_sim_init(&sim, &bad), NT_OK);
}

static void the_backends_are_the_simulator(void **state)
{
    (void)state;
    const nt_sim_setup setup = setup_of(4, 0);
    nt_sim a = sim_of(&setup), b = a;
    const nt_hal_choice hand = {nt_sim_master_backend(), &a.master}, probe = {nt_sim_slave_backend(), &a.slave};
    nt_hal master, slave;
    assert_int_equal(nt_hal_open(&master, NT_HALF_MASTER, &hand, NULL, NULL), NT_OK);
    assert_int_equal(nt_hal_open(&slave, NT_HALF_SLAVE, &probe, NULL, NULL), NT_OK);
    for (uint64_t i = 0; i < 100; i++) {
        const nt_command command = script(i);
        nt_sample y;
        nt_sample x;
        assert_int_equal(nt_hal_sample(&master, &slave, i, llround((double)i * setup.period * 1e9), &x), NT_OK);
        assert_int_equal(nt_sim_read(&b, &y), NT_OK);
        assert_memory_equal(&x, &y, SAMPLE_BYTES);
        nt_action action = {.size = sizeof action, .tick = i};
        assert_int_equal(nt_hal_command(&master, &slave, &command, &action), NT_OK);
        assert_int_equal(nt_sim_write(&b, &command), NT_OK);
    }
    nt_hal_close(&master);
    nt_hal_close(&slave);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_copy_replays_to_the_last_bit),
        cmocka_unit_test(seeds_make_the_noise_and_nothing_else),
        cmocka_unit_test(delay_is_exact),
        cmocka_unit_test(hand_gauge_and_master),
        cmocka_unit_test(actuators_have_their_limits),
        cmocka_unit_test(a_command_that_is_not_a_number_is_refused),
        cmocka_unit_test(the_surface_pushes_back),
        cmocka_unit_test(a_cycle_of_touch_dissipates),
        cmocka_unit_test(the_surface_under_the_tip_is_the_maps),
        cmocka_unit_test(setups_are_checked),
        cmocka_unit_test(the_backends_are_the_simulator),
    };
    return cmocka_run_group_tests(tests, make_plan, NULL);
}
