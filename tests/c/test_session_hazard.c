/* SPDX-License-Identifier: BSD-3-Clause
 * What a jump makes of a lever: the peak that is promised, against the dynamic probe of the simulation, whose scheme
 * shares nothing with the potential that is asked here. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/margins.h"
#include "larger.h"
#include "loop_fixture.h"
#include "session/hazard.h"
#include "session/state.h" /* the truth between two ticks */

static loop l;

static nt_session_setup lever(double spring_constant, double resonance, double limit)
{
    nt_session_setup setup = nt_session_defaults();
    setup.rig.probe.spring_constant = spring_constant;
    setup.rig.probe.resonance = resonance;
    setup.rig.probe.spring_constant_sigma = setup.rig.probe.sensitivity_sigma = 0.0;
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.settings.limits.force = limit;
    setup.settings.limits.stage_speed = 1e-6;
    setup.settings.limits.lateral_speed = 1e-8;
    setup.settings.gains.set_point = 0.5 * limit;
    setup.settings.gains.alpha_p = 4e-6;
    setup.clearance = 4e-9;
    setup.probe_model = NT_PROBE_DYNAMIC;
    return setup;
}

static void a_lever_arrives_with_the_energy_of_its_jump(void **state)
{
    (void)state;
    static const double levers[][3] = {{0.1, 30e3, 2e-9}, {0.3, 40e3, 5e-9}};
    for (int i = 0; i < 2; i++) {
        const nt_session_setup setup = lever(levers[i][0], levers[i][1], levers[i][2]);
        assert_int_equal(loop_open(&l, &setup), NT_OK);
        const nt_guarantee g = promise(&l, 0.0);
        loop_push(&l, 1.0, 0.02);
        double peak = 0.0;
        for (int tick = 0; tick < 800; tick++) {
            assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
            peak = larger(peak, l.sim.slave.truth.peak_force);
        }
        print_message(
            "k_c %g N/m: %.1f nN at the peak, %.1f nN promised, snap-in %.1f nN beside a pull-off of %.1f nN\n",
            levers[i][0], 1e9 * peak, 1e9 * g.force, 1e9 * g.snap_in, 1e9 * l.plan.pull_off_force);
        assert_true(peak < g.force && peak > 0.75 * g.force);
    }
}

/* Nothing that pulls: no jump, but thermal motion and the closing speed. */
static void without_attraction_there_is_none(void **state)
{
    (void)state;
    nt_session_setup setup = lever(1.0, 70e3, 50e-9);
    setup.scene.medium.relative_humidity = 0.0;
    setup.scene.adhesion.work_of_adhesion = setup.scene.adhesion.hamaker_constant = 0.0;
    assert_int_equal(loop_open(&l, &setup), NT_OK);
    const nt_hazard dry = nt_hazard_of(&l.plan, &l.touch.rig, &l.touch.settings, 0.0, HUGE_VAL);
    /* 18 k_B T of a spring: sqrt(36 k_B T k), and the speed of 7 um/s on the mass k_c/w0^2 */
    const double stiffness = l.plan.maximum_stiffness, mass = 1.0 / pow(2.0 * 3.14159265 * 70e3, 2.0);
    const double most = sqrt(stiffness * (36.0 * 1.38e-23 * 295.0 + mass * 7e-6 * 7e-6));
    print_message("nothing pulls: %.2f nN of at most %.2f nN\n", 1e9 * dry.snap_in, 1.5e9 * most);
    assert_true(dry.snap_in > 0.0 && dry.snap_in < 1.5 * most);
}

/* A lever that rings longer after a pull-off comes back with more of it. */
static void a_pull_off_counts_where_it_rings_on(void **state)
{
    (void)state;
    double before = 0.0;
    for (double quality = 1e2; quality < 1e6; quality *= 10.0) {
        nt_session_setup setup = lever(0.1, 30e3, 2e-9);
        setup.rig.probe.quality = quality;
        assert_int_equal(loop_open(&l, &setup), NT_OK);
        const nt_hazard found = nt_hazard_of(&l.plan, &l.touch.rig, &l.touch.settings, 0.0, HUGE_VAL);
        assert_true(found.snap_in >= before && isfinite(found.snap_in));
        before = found.snap_in;
    }
    /* at most all that the pull-off has left, F^2/(2 k_c), and by w/w0 more in the stiffer contact */
    const double all = l.plan.pull_off_force * l.plan.pull_off_force / 0.2, stiff = 10.0 * l.plan.maximum_stiffness;
    assert_true(before > 5e-7 && before < sqrt(2.0 * all * sqrt(stiff / 0.1) * stiff));
}

/* A mass on a spring over the plan's law, without damping, by velocity Verlet: let go with `freed` of stretch where the
 * tip just touches, it rings, while its base comes down at `speed` until it presses with `force`. The largest force
 * that the sample bears [N]. */
static double ringing_peak(const nt_probe *probe, double freed, double force, double speed)
{
    const nt_interaction_state never = {0};
    const double K = probe->spring_constant, rate = 2.0 * 3.14159265 * probe->resonance, dt = 2e-9;
    const double mass = K / (rate * rate);
    double z = 1e-9, v = 0.0, base = z + freed, peak = 0.0; /* clear of attraction, but for what is promised */
    for (double law = 0.0; base > -force / K; base -= speed * dt) {
        v += 0.5 * dt / mass * (law - K * (z - base));
        z += dt * v;
        law = nt_interaction_eval_gap(&l.plan, &never, NULL, z).F;
        v += 0.5 * dt / mass * (law - K * (z - base));
        peak = larger(peak, law);
    }
    return peak;
}

/* Pressed while it rings, a free lever strikes ever faster and harder: e/w stays. */
static void a_lever_that_is_let_go_strikes_harder_as_it_is_pressed(void **state)
{
    (void)state;
    nt_session_setup setup = lever(0.1, 30e3, 2e-9);
    setup.rig.probe.quality = 1e5; /* nothing dies away */
    setup.scene.medium.relative_humidity = setup.scene.adhesion.hamaker_constant = 0.0;
    setup.scene.adhesion.work_of_adhesion = 2e-3;
    setup.probe_model = NT_PROBE_QUASI_STATIC;
    assert_int_equal(loop_open(&l, &setup), NT_OK);
    const nt_hazard found = nt_hazard_of(&l.plan, &l.touch.rig, &l.touch.settings, 0.0, HUGE_VAL);
    const double promised = setup.settings.limits.force + found.snap_in;
    const double freed = l.plan.pull_off_force / setup.rig.probe.spring_constant;
    const double strike = ringing_peak(&setup.rig.probe, freed, 0.0, 1e-4);
    const double pressed = ringing_peak(&setup.rig.probe, freed, setup.settings.limits.force, 1e-4);
    print_message("let go by %.0f nm: %.1f nN at a strike, %.1f nN as it is pressed with %.0f nN, %.1f nN promised\n",
                  1e9 * freed, 1e9 * strike, 1e9 * pressed, 1e9 * setup.settings.limits.force, 1e9 * promised);
    assert_true(pressed > 1.3 * strike); /* the case is one */
    assert_true(pressed < promised && pressed > 0.5 * promised);
}

/* A frame that drifts as fast as declared, after a stop: until help is needed the tip is never pressed beyond a touch,
 * and soon after it is, by k_eff times the drift in a second. */
static void a_stop_needs_help_when_it_says(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    setup.rig.stage.travel = 2e-6;
    setup.rig.stage.drift = 50e-9;
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.settings.gains.rate = 2e3;
    setup.settings.limits.retract_distance = 0.2e-6;
    setup.clearance = 20e-9;
    assert_int_equal(loop_open(&l, &setup), NT_OK);
    const nt_guarantee g = promise(&l, 0.0);
    loop_push(&l, 1.0, 0.1);
    for (int tick = 0; tick < 1000; tick++)
        assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
    const double now = (double)l.sim.slave.link.tick * l.touch.period;
    const nt_fault stop = {NT_FAULT_EMERGENCY_STOP, NT_CHANNEL_RIG, now, HUGE_VAL, 0.0};
    const nt_fault drift = {NT_FAULT_DRIFT, NT_CHANNEL_STAGE, now, HUGE_VAL, setup.rig.stage.drift};
    assert_int_equal(nt_sim_inject(&l.sim, &stop), NT_OK);
    assert_int_equal(nt_sim_inject(&l.sim, &drift), NT_OK);
    const double touch = 4.0 * l.plan.pull_off_force;
    double time = 0.0, earlier = 0.0;
    while (time < 3.0 * g.help_time && !(l.sim.slave.truth.tip_force[NT_Z] > touch && time > 0.5)) {
        assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
        time += l.touch.period;
    }
    earlier = l.sim.slave.truth.tip_force[NT_Z];
    for (int tick = 0; tick < 2000; tick++)
        assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
    const double rate = l.sim.slave.truth.tip_force[NT_Z] - earlier;
    print_message("help is needed after %.1f s, %.1f s promised; then %.0f nN more each second, %.0f nN/s promised\n",
                  time, g.help_time, 1e9 * rate, 1e9 * g.frame_drift);
    assert_true(time > g.help_time && time < 2.0 * g.help_time);
    assert_true(rate < g.frame_drift && rate > 0.5 * g.frame_drift);
}

/* The truth at its worst while a session runs for so long, over what it promises; promised: that, if not NULL. */
static double share_reached(const nt_session_setup *setup, const nt_input *input, double seconds,
                            nt_guarantee *promised)
{
    nt_session *session = NULL;
    assert_int_equal(nt_session_open(&session, setup, NULL), NT_OK);
    *promised = nt_session_guarantee(session);
    assert_int_equal(nt_session_aim(session, input, NULL), NT_OK);
    double worst = 0.0;
    for (double time = 0.0; time < seconds; time += nt_session_touch(session)->period) {
        assert_int_equal(nt_session_advance(session, 1), NT_OK);
        worst = larger(worst, session->sim.slave.truth.peak_force);
    }
    nt_session_close(session);
    return worst / promised->force;
}

/* A sharp cone in a gel, under a stiff lever: at the limit of 0.3 nN contact has a twentieth of the stiffness that it
 * has where the stage turns. */
static void contact_that_stiffens_beyond_the_limit_is_promised(void **state)
{
    (void)state;
    nt_session_setup setup = lever(50.0, 300e3, 0.3e-9);
    setup.scene.tip.shape = NT_SHAPE_CONE;
    setup.scene.tip.half_angle = 1.2;
    setup.scene.sample.youngs_modulus = 1e6;
    setup.scene.medium.kind = NT_MEDIUM_LIQUID;
    setup.scene.adhesion.work_of_adhesion = setup.scene.adhesion.hamaker_constant = 0.0;
    setup.rig.probe.sensitivity = 5e-9;
    setup.rig.probe.noise = 1e-4;
    setup.rig.probe.resolution = 1e-5;
    setup.rig.stage.max_speed = 2e-3;
    setup.rig.stage.resolution = setup.rig.stage.command_resolution = 0.0;
    setup.rig.master.motor = setup.rig.master.gauge = 0;
    setup.rig.master.resolution = 0.0;
    setup.settings.control.choice = NT_CONTROL_IMPEDANCE;
    setup.settings.gains.force_gain = 0.0;
    setup.settings.gains.stage_integral = 5.0;
    setup.settings.gains.alpha_p = 1e-3;
    setup.settings.limits.stage_speed = setup.settings.limits.retract_speed = 1e-3;
    setup.settings.limits.indentation = 1e-4;
    setup.clearance = 100e-9;
    setup.probe_model = NT_PROBE_QUASI_STATIC;
    const nt_input plunge = {.holds = 1, .master_position[NT_Z] = 9e-3};
    nt_guarantee promised;
    const double share = share_reached(&setup, &plunge, 0.1, &promised);
    print_message("a cone in a gel: %.3f of the %.1f nN that are promised, the limit is 0.3 nN\n", share,
                  1e9 * promised.force);
    assert_true(share < 1.0 && share * promised.force > 100e-9); /* 100 nN by the stiffness at the limit */
}

/* 60 nm above the surface a force of long range pulls with 0.5 nN: the tare takes it off, and nobody reads it. */
static void what_the_tare_takes_off_is_promised(void **state)
{
    (void)state;
    nt_session_setup setup = lever(0.5, 60e3, 0.5e-9);
    setup.scene.medium.kind = NT_MEDIUM_LIQUID;
    setup.scene.medium.yukawa_energy = -0.02;
    setup.scene.medium.yukawa_length = 50e-9;
    setup.scene.tip.radius = 50e-9;
    setup.rig.probe.noise = 1e-3;
    setup.settings.limits.stage_speed = 1e-7;
    setup.settings.gains.alpha_f = 1e8;
    setup.clearance = 60e-9;
    setup.probe_model = NT_PROBE_QUASI_STATIC;
    const nt_input rest = {0};
    nt_guarantee promised;
    const double pulled = share_reached(&setup, &rest, 0.01, &promised) * promised.force;
    print_message("the tare takes off %.3f nN of %.3f nN\n", 1e9 * pulled, 1e9 * promised.tare);
    assert_true(pulled > 0.5e-9 && pulled < promised.tare && promised.tare < 1.1 * pulled);
    setup.preflight = 0;
    (void)share_reached(&setup, &rest, 0.001, &promised);
    assert_true(promised.tare == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lever_arrives_with_the_energy_of_its_jump),
        cmocka_unit_test(without_attraction_there_is_none),
        cmocka_unit_test(a_pull_off_counts_where_it_rings_on),
        cmocka_unit_test(a_lever_that_is_let_go_strikes_harder_as_it_is_pressed),
        cmocka_unit_test(a_stop_needs_help_when_it_says),
        cmocka_unit_test(contact_that_stiffens_beyond_the_limit_is_promised),
        cmocka_unit_test(what_the_tare_takes_off_is_promised),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
