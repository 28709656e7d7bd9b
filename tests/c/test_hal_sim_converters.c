/* SPDX-License-Identifier: BSD-3-Clause
 * What stands between the simulated plant and the loop: parts of a period, latencies, rates, bits, a gauge or none; and
 * the two models of the probe behind the same contract. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/rig.h"
#include "hal/sim/sim.h"
#include "larger.h"
#include "nanotouch/advanced/sim.h"

#define T 1e-4
#define BOLTZMANN 1.380649e-23
static nt_plan plan;

static int make_plan(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    const nt_plan_inputs inputs = {.scene = &scene};
    return nt_plan_make(&plan, &inputs, NULL) != NT_OK;
}

/* Without noise and steps. */
static nt_rig ideal_rig(void)
{
    nt_rig rig = nt_rig_defaults();
    rig.probe.noise = rig.probe.resolution = rig.probe.temperature = 0.0;
    rig.stage.resolution = rig.stage.command_resolution = 0.0;
    rig.stage.max_speed = 1.0;
    rig.master.resolution = rig.master.gauge_noise = rig.master.gauge_resolution = 0.0;
    return rig;
}

static nt_sim sim_of(const nt_rig *rig, double period, double delay)
{
    const nt_sim_setup setup = {
        .plan = &plan, .rig = rig, .period = period, .clearance = 500e-9, .seed = 5, .delay = delay};
    nt_sim sim;
    assert_int_equal(nt_sim_init(&sim, &setup), NT_OK);
    return sim;
}

/* 1.3 periods of delay are 13 tenths: master and stage are the same at every tick, friction and hand included. */
static void a_part_of_a_period_is_exact(void **state)
{
    (void)state;
    nt_rig rig = ideal_rig();
    rig.master.friction = 0.2;
    rig.hand = (nt_hand){.mass = 0.02, .damping = 1.0, .stiffness = 500.0};
    nt_sim coarse = sim_of(&rig, T, 1.3), fine = sim_of(&rig, T / 10.0, 13.0);
    for (int i = 0; i < 2000; i++) {
        const nt_command command = {.motor_force[NT_Z] = 2.0 * sin(0.05 * i),
                                    .stage_position[NT_Z] = 50e-9 * sin(0.03 * i)};
        assert_int_equal(nt_sim_write(&coarse, &command), NT_OK);
        for (int part = 0; part < 10; part++)
            assert_int_equal(nt_sim_write(&fine, &command), NT_OK);
        assert_true(fabs(coarse.master.arm[NT_Z].position - fine.master.arm[NT_Z].position) < 1e-14);
        assert_true(fabs(coarse.slave.stage.position - fine.slave.stage.position) < 1e-18);
    }
}

/* Half of a latency that the converters add to the delay is the same as a delay. */
static void the_output_latency_is_a_delay(void **state)
{
    (void)state;
    nt_rig rig = ideal_rig(), late = rig;
    late.converters.dac_latency = 0.7 * T;
    nt_sim a = sim_of(&rig, T, 1.7), b = sim_of(&late, T, 1.0);
    for (int i = 0; i < 500; i++) {
        const nt_command command = {.motor_force[NT_Z] = sin(0.1 * i)};
        assert_int_equal(nt_sim_write(&a, &command), NT_OK);
        assert_int_equal(nt_sim_write(&b, &command), NT_OK);
        assert_true(fabs(a.master.arm[NT_Z].position - b.master.arm[NT_Z].position) < 1e-16);
    }
}

/* A sample that is 2.25 periods old shows a speed that does not change where it was 2.25 periods ago. */
static void the_input_latency_shows_the_past(void **state)
{
    (void)state;
    nt_rig rig = ideal_rig();
    rig.converters.adc_latency = 2.25 * T;
    nt_sim sim = sim_of(&rig, T, 0.0);
    const nt_command push = {.motor_force[NT_Z] = 1.0};
    for (int i = 0; i < 500; i++) {
        nt_sample sample;
        assert_int_equal(nt_sim_read(&sim, &sample), NT_OK);
        assert_true(fabs(sample.age - 2.25 * T) < 1e-18);
        if (i > 300) /* 30 time constants: b v = f */
            assert_true(fabs(sample.master_position[NT_Z] - (sim.master.arm[NT_Z].position - 2.25 * T * 1.0 / 100.0)) <
                        1e-14);
        assert_int_equal(nt_sim_write(&sim, &push), NT_OK);
    }
}

/* 3 kHz beneath a loop of 10 kHz: three conversions in ten periods, held between them, ageing. */
static void a_slow_converter_repeats_itself(void **state)
{
    (void)state;
    nt_rig rig = ideal_rig();
    rig.converters.adc_rate = 3e3;
    nt_sim sim = sim_of(&rig, T, 0.0);
    const nt_command push = {.motor_force[NT_Z] = 1.0};
    double last = NAN;
    int fresh = 0;
    for (int i = 0; i < 1000; i++) {
        nt_sample sample;
        assert_int_equal(nt_sim_read(&sim, &sample), NT_OK);
        assert_int_equal(sample.tick, i);
        fresh += sample.age == 0.0;
        assert_true(sample.age == 0.0 ? sample.master_position[NT_Z] != last : sample.master_position[NT_Z] == last);
        assert_true(sample.age < 3.5 * T);
        last = sample.master_position[NT_Z];
        assert_int_equal(nt_sim_write(&sim, &push), NT_OK);
    }
    assert_true(fresh >= 300 && fresh <= 301);
}

static int is_multiple(double value, double step)
{
    return fabs(value / step - round(value / step)) < 1e-6;
}

/* 8 bits over +-10 V are 78 mV: 2.6 nm; over the stage's travel 0.4 um. */
static void bits_are_steps(void **state)
{
    (void)state;
    nt_rig rig = ideal_rig();
    rig.converters.adc_bits = rig.converters.dac_bits = 8.0;
    rig.probe.noise = 0.05;
    nt_sim sim = sim_of(&rig, T, 0.0);
    for (int i = 0; i < 200; i++) {
        const nt_command command = {.stage_position[NT_Z] = -1e-7 * i, .motor_force[NT_Z] = 0.03 * i};
        nt_sample sample;
        assert_int_equal(nt_sim_read(&sim, &sample), NT_OK);
        assert_true(is_multiple(sample.deflection[NT_Z], 0.033e-6 * 20.0 / 256.0));
        assert_true(is_multiple(sample.stage_position[NT_Z], rig.stage.travel / 256.0));
        assert_true(is_multiple(sample.master_position[NT_Z], rig.master.travel / 256.0));
        assert_int_equal(nt_sim_write(&sim, &command), NT_OK);
    }
    for (int i = 0; i < 5000; i++) {
        const nt_command command = {.stage_position[NT_Z] = -1.1e-6, .motor_force[NT_Z] = 0.03};
        assert_int_equal(nt_sim_write(&sim, &command), NT_OK);
    }
    assert_true(fabs(sim.slave.stage.position + 3.0 * rig.stage.travel / 256.0) < 1e-12); /* 1.17 um is nearest */
    assert_true(fabs(sim.master.arm[NT_Z].speed - 10.0 / 256.0 / 100.0) < 1e-6 || sim.master.arm[NT_Z].speed == 0.0);
}

static void without_a_gauge_nothing_is_said(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    rig.master.gauge = 0;
    nt_sim sim = sim_of(&rig, T, 0.0);
    nt_sample sample;
    assert_int_equal(nt_sim_read(&sim, &sample), NT_OK);
    assert_true(isnan(sample.operator_force[NT_Z]) && sample.flags == 0 && isfinite(sample.deflection[NT_Z]));
}

/* In air the dynamic probe moves by k_B T/k_c, sampled at any rate. 20 000 samples are known to 1 %, 5 sigma are 5 %.
 */
static void the_probe_trembles_in_air(void **state)
{
    (void)state;
    nt_rig rig = ideal_rig();
    rig.probe.spring_constant = 0.1;
    rig.probe.temperature = 300.0;
    rig.probe.quality = 5.0;
    const nt_sim_setup setup = {
        .plan = &plan, .rig = &rig, .period = T, .clearance = 500e-9, .seed = 5, .probe_model = NT_PROBE_DYNAMIC};
    static nt_sim sim;
    assert_int_equal(nt_sim_init(&sim, &setup), NT_OK);
    double squares = 0.0;
    for (int i = 0; i < 20000; i++) {
        const nt_command rest = {0};
        nt_sample sample;
        assert_int_equal(nt_sim_read(&sim, &sample), NT_OK);
        squares += sample.deflection[NT_Z] * sample.deflection[NT_Z];
        assert_int_equal(nt_sim_write(&sim, &rest), NT_OK);
    }
    assert_true(fabs(squares / 20000.0 * 0.1 / (BOLTZMANN * 300.0) - 1.0) < 0.05);
}

/* The same approach, press and retraction by both models, damped: the forces agree within the lag that is promised, but
 * for the ticks of the two jumps. */
static void both_models_tell_the_same(void **state)
{
    (void)state;
    nt_rig rig = ideal_rig();
    rig.probe.quality = 3.0;
    rig.stage.quality = 0.5;
    rig.stage.max_speed = 1e-6;
    const double bound = nt_cantilever_lag_of(&rig.probe, &rig.stage).force;
    nt_sim_setup setup = {.plan = &plan, .rig = &rig, .period = T, .clearance = 20e-9, .substep = 1.0};
    static nt_sim still, moving;
    setup.probe_model = NT_PROBE_QUASI_STATIC;
    assert_int_equal(nt_sim_init(&still, &setup), NT_OK);
    setup.probe_model = NT_PROBE_DYNAMIC;
    assert_int_equal(nt_sim_init(&moving, &setup), NT_OK);
    assert_true(!still.slave.dynamic && moving.slave.dynamic);
    int apart = 0;
    double deepest = 0.0;
    for (int i = 0; i <= 2000; i++) {
        const nt_command command = {.stage_position[NT_Z] = 30e-9 * (1.0 - fabs(i / 1000.0 - 1.0))};
        assert_int_equal(nt_sim_write(&still, &command), NT_OK);
        assert_int_equal(nt_sim_write(&moving, &command), NT_OK);
        const double error =
            rig.probe.spring_constant * fabs(still.slave.cantilever.deflection - moving.slave.cantilever.deflection);
        apart += error > bound;
        deepest = larger(deepest, still.slave.truth.tip_force[NT_Z]);
    }
    print_message("bound %.2g N, passed in %d of 2000 ticks\n", bound, apart);
    assert_true(deepest > 50e-9 && apart <= 10);
}

/* What is left of the energy of a tip that is kicked, over its rest, while adhesion holds it under tension; after 50
 * us. */
static double energy_left_in_tension(double viscosity)
{
    nt_rig rig = ideal_rig();
    rig.probe.quality = 1e6;
    rig.probe.contact_viscosity = viscosity;
    rig.stage.stiffness = 1e12;
    rig.stage.quality = 0.5;
    const nt_sim_setup setup = {
        .plan = &plan, .rig = &rig, .period = 1e-6, .clearance = 5e-9, .probe_model = NT_PROBE_QUASI_STATIC};
    static nt_sim sim;
    assert_int_equal(nt_sim_init(&sim, &setup), NT_OK);
    for (int i = 0; i < 40000; i++) { /* touch, and draw back until it pulls by half of what it can */
        const nt_command command = {.stage_position[NT_Z] = i < 20000 ? 7e-9 : 4e-9};
        assert_int_equal(nt_sim_write(&sim, &command), NT_OK);
    }
    const double rest =
        0.5 * rig.probe.spring_constant * sim.slave.cantilever.deflection * sim.slave.cantilever.deflection;
    const double floor = rest + sim.slave.truth.energy, mass = nt_probe_effective_mass(&rig.probe);
    assert_true(sim.slave.truth.tip_force[NT_Z] < -0.2 * plan.pull_off_force && sim.slave.truth.contact_radius > 0.0);
    assert_int_equal(nt_cantilever_model_init(&sim.slave.cantilever_model, &rig.probe, 1e-6, 0.25), NT_OK);
    sim.slave.dynamic = 1;
    sim.slave.cantilever.speed = 1e-5;
    const double kick = 0.5 * mass * 1e-10;
    double before = kick;
    for (int i = 0; i < 50; i++) {
        const nt_command stay = {.stage_position[NT_Z] = 4e-9};
        assert_int_equal(nt_sim_write(&sim, &stay), NT_OK);
        const nt_cantilever_state *now = &sim.slave.cantilever;
        const double energy = 0.5 * mass * now->speed * now->speed +
                              0.5 * rig.probe.spring_constant * now->deflection * now->deflection +
                              sim.slave.truth.energy - floor;
        assert_true(energy < before + 1e-3 * kick); /* the table's U and F agree to 1e-6 of them; kick is 1e-3 of U */
        before = energy;
    }
    return before / kick;
}

/* 2 eta a takes energy under tension, too, and without it none is lost. */
static void contact_damping_works_in_tension(void **state)
{
    (void)state;
    const double free = energy_left_in_tension(0.0), thin = energy_left_in_tension(10.0);
    const double thick = energy_left_in_tension(200.0);
    print_message("energy left: %.4f without, %.4f and %.4f with viscosity\n", free, thin, thick);
    assert_true(fabs(free - 1.0) < 1e-3);
    assert_true(thin < 0.96 && fabs(log(thick) / log(thin) / 20.0 - 1.0) < 0.1); /* e^(-2 eta a t/m) */
}

/* The paper's rig in air is quasi-static; in vacuum, or with a slow lever, it is not. */
static void the_model_is_chosen_by_its_error(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    assert_false(nt_sim_needs_dynamics(&plan, &rig, T));
    rig.probe.quality = 1e4; /* rings for 32 ms */
    assert_true(nt_sim_needs_dynamics(&plan, &rig, T));
    assert_false(nt_sim_needs_dynamics(&plan, &rig, 0.1)); /* but is at rest when it is looked at */
    rig = nt_rig_defaults();
    rig.probe.resonance = 500.0;
    rig.probe.quality = 1.0;
    assert_true(nt_sim_needs_dynamics(&plan, &rig, T)); /* lags by 0.5 uN at the stage's full speed */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_part_of_a_period_is_exact),
        cmocka_unit_test(the_output_latency_is_a_delay),
        cmocka_unit_test(the_input_latency_shows_the_past),
        cmocka_unit_test(a_slow_converter_repeats_itself),
        cmocka_unit_test(bits_are_steps),
        cmocka_unit_test(without_a_gauge_nothing_is_said),
        cmocka_unit_test(the_probe_trembles_in_air),
        cmocka_unit_test(both_models_tell_the_same),
        cmocka_unit_test(contact_damping_works_in_tension),
        cmocka_unit_test(the_model_is_chosen_by_its_error),
    };
    return cmocka_run_group_tests(tests, make_plan, NULL);
}
