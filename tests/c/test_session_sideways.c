/* SPDX-License-Identifier: BSD-3-Clause
 * A hand of three axes on a tip that rubs: what it feels, where the loop turns unstable, what is promised. */
#include <stdlib.h>

#include "control/margins.h"
#include "scene/interaction.h"
#include "sideways_draws.h"

/* Stuck: motor and hand balance, alpha_f times the force on the tip. Sliding: what the hand pushes with beyond that
 * goes into the master's damping. Both from the balance of forces alone. */
static void the_hand_feels_what_holds_the_tip(void **state)
{
    (void)state;
    static loop l;
    const nt_session_setup setup = rubbing(300e6, 0.3);
    const double alpha_f = setup.settings.gains.alpha_f, b = setup.rig.master.damping;
    assert_int_equal(loop_open(&l, &setup), NT_OK);
    push(&l, 0.0, 0.0, 0.1, 0.2);
    run(&l, 5.0); /* 30 time constants b/kappa */
    const double limit = limit_of(&l);
    assert_true(limit > 5e-9);
    push(&l, 0.3 * alpha_f * limit, -0.4 * alpha_f * limit, 0.1, 0.2);
    run(&l, 4.0);
    assert_within(l.sim.slave.truth.tip_force[NT_X], -0.3 * limit, 1e-6 * limit);
    assert_within(l.sim.slave.truth.tip_force[NT_Y], 0.4 * limit, 1e-6 * limit);
    assert_within(l.command.motor_force[NT_X], -0.3 * alpha_f * limit, 1e-6 * alpha_f * limit);
    push(&l, 0.9 * alpha_f * limit, -1.2 * alpha_f * limit, 0.1, 0.0);
    run(&l, 0.3);
    const double speed = 0.5 * alpha_f * limit / b;                         /* 1.5 of the limit, less the limit */
    assert_within(l.sim.master.arm[NT_X].speed, 0.6 * speed, 1e-3 * speed); /* the load goes on settling by 1e-4 */
    assert_within(l.sim.master.arm[NT_Y].speed, -0.8 * speed, 1e-3 * speed);
}

/* A kick of a hundredth: does the answer die away? */
static int dies_away(const loop *pressed, double factor)
{
    static loop l;
    l = *pressed;
    l.sim.slave.plan = &l.plan;
    l.touch.rig.probe.lateral_stiffness *= factor; /* alpha_f of x and y alone */
    push(&l, 1e-4, 0.0, 0.1, 0.0);
    double swing[2] = {0.0, 0.0};
    for (int part = 0; part < 3; ++part) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (double t = 0.0; t < (part == 1 ? 0.6 : 0.1); t += l.touch.period) {
            run(&l, 0.5 * l.touch.period);
            low = smaller(low, l.sim.slave.truth.tip_force[NT_X]);
            high = larger(high, l.sim.slave.truth.tip_force[NT_X]);
        }
        if (part != 1)
            swing[part / 2] = high - low;
    }
    return swing[1] < swing[0] && swing[1] * l.touch.settings.gains.alpha_f < 0.01 && l.command.state == NT_RUN;
}

/* The exact limit is that of the simulated loop; R1 is below it. */
static void the_exact_limit_is_that_of_the_simulation(void **state)
{
    (void)state;
    static const double cases[][3] = {{10e3, 1, 100.0}, {10e3, 0, 100.0}, {10e3, 3, 100.0}, {5e3, 1, 50.0},
                                      {2e3, 1, 100.0},  {1e3, 1, 100.0},  {1e3, 2, 20.0},   {50e3, 1, 100.0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        static loop l;
        nt_session_setup setup = rubbing(DRY, 0.0);
        setup.settings.gains.rate = cases[i][0];
        setup.settings.gains.delay = cases[i][1];
        setup.rig.master.damping = cases[i][2];
        setup.settings.gains.force_gain = 0.0;
        assert_int_equal(loop_open(&l, &setup), NT_OK);
        push(&l, 0.0, 0.0, 0.1, 0.2);
        run(&l, 1.5);
        double low = 1.0, high = 3e4;
        assert_true(dies_away(&l, low) && !dies_away(&l, high));
        while (high - low > 1e-3 * low) {
            const double middle = sqrt(low * high);
            *(dies_away(&l, middle) ? &low : &high) = middle;
        }
        const nt_friction_contact contact =
            nt_interaction_friction_contact(&l.plan, &l.sim.slave.interaction, NULL, l.sim.slave.truth.gap);
        const nt_sideways_contact grip = {.stick = nt_friction_stiffness(&l.plan.friction.law, contact.radius)};
        const double k = l.plan.maximum_stiffness;
        const nt_margins along_z = nt_margins_compute(&setup.rig, &setup.settings.gains, k);
        const nt_sideways_margins found = nt_margins_sideways(&setup.rig, &setup.settings, k, &grip, &along_z);
        const double simulated = low * found.loop_stiffness;
        print_message("%5.0f Hz, d = %.0f, b %3.0f: limit %.4g N/m in simulation, exact %.4g, R1 %.0f %% below\n",
                      cases[i][0], cases[i][1], cases[i][2], simulated, found.exact_limit,
                      100.0 * (1.0 - found.margin / low));
        assert_within(found.exact_limit, simulated, 0.01 * simulated); /* bisected to 0.1 %, told dying from growing */
        assert_true(found.margin < low && found.margin > 0.5 * low);
    }
}

/* Pressed, rubbed to and fro past slip, let go: does everything come to rest? */
static int comes_to_rest(const drawn *d, double alpha_f)
{
    static loop l;
    nt_session_setup setup = d->setup;
    setup.settings.gains.alpha_f = alpha_f;
    assert_int_equal(loop_open(&l, &setup), NT_OK);
    l.touch.supervisor.limits.force = HUGE_VAL; /* a landing may overshoot: it is judged by its end */
    const double press = alpha_f * d->load;
    push(&l, 0.0, 0.0, press, 0.2);
    run(&l, 0.6);
    const double rubs = 1.2 * alpha_f * (limit_of(&l) + d->slope * d->load);
    for (int way = 0; way < 4; ++way) {
        push(&l, rubs * (way % 2 ? -0.8 : 0.8), rubs * (way / 2 ? -0.6 : 0.6), press, 0.02);
        run(&l, 0.05);
    }
    push(&l, 0.0, 0.0, press, 0.02);
    run(&l, 1.5);
    double way[NT_AXES] = {0.0, 0.0, 0.0}, last[NT_AXES];
    const double *force = l.sim.slave.truth.tip_force;
    const double begin[NT_AXES] = {force[NT_X], force[NT_Y], force[NT_Z]};
    for (double t = 0.0; t < 0.2; t += l.touch.period) {
        memcpy(last, force, sizeof last);
        run(&l, 0.5 * l.touch.period);
        for (int i = 0; i < NT_AXES; ++i)
            way[i] += fabs(force[i] - last[i]);
    }
    for (int i = 0; i < NT_AXES; ++i) /* down a hill it may slide on, but not to and fro */
        if (!(way[i] - fabs(force[i] - begin[i]) < 0.05 * d->load))
            return 0;
    return l.command.state == NT_RUN;
}

/* NANOTOUCH_SIDEWAYS_SCENES of them, with how much more the simulation bears. */
static void at_the_bound_random_scenes_come_to_rest(void **state)
{
    (void)state;
    const char *asked = getenv("NANOTOUCH_SIDEWAYS_SCENES");
    const int scenes = asked ? atoi(asked) : 40;
    nt_random random = nt_random_seed(5);
    int coupled = 0, within[3] = {0, 0, 0};
    for (int i = 0; i < scenes; ++i) {
        static drawn d;
        double parts[3];
        draw(&d, &random);
        const double at = scale_at_the_limit(&d, parts);
        coupled += parts[2] < 0.9 * smaller(parts[0], parts[1]);
        assert_true(comes_to_rest(&d, 0.95 * at)); /* at the limit itself a swing takes its time */
        for (int k = 0; k < 3; ++k)
            within[k] += comes_to_rest(&d, at * (1 << (k + 1)));
    }
    print_message(
        "%d scenes at rest at 0.95 of the bound, %d of them bound by the coupling; %d, %d, %d at 2, 4, 8 times it\n",
        scenes, coupled, within[0], within[1], within[2]);
}

/* The largest lateral force over one way of the hand, landed gently and pushed sideways at once [N]. */
static double rubbed(loop *l, const drawn *d, nt_random *random, int *stopped)
{
    const double press = l->touch.settings.gains.alpha_f * d->load, most = 3.0 * press;
    assert_int_equal(nt_touch_arm(&l->state, 1), NT_OK);
    push(l, 0.0, 0.0, 0.7 * press, 0.3);
    run(l, 0.5);
    push(l, most * noise(random), most * noise(random), (0.7 + 0.3 * noise(random)) * press, 0.0);
    double worst = 0.0;
    for (double t = 0.0; t < 0.1; t += l->touch.period) {
        run(l, 0.5 * l->touch.period);
        const double *force = l->sim.slave.truth.tip_force;
        worst = larger(worst, hypot(force[NT_X], force[NT_Y]));
    }
    *stopped += (l->command.reasons & NT_REASON_LATERAL) != 0;
    push(l, 0.0, 0.0, -0.3 * press, 0.0);
    run(l, 0.2);
    return worst;
}

/* A hand that pushes anywhere, up to far past the lateral limit: the tip is lifted, and no force sideways was more than
 * what is promised. Rigs, friction and limits of the dice. */
static void no_lateral_force_is_more_than_promised(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(8);
    int stopped = 0, past = 0;
    double nearest = 0.0;
    for (int i = 0; i < 40; ++i) {
        static drawn d;
        static loop l;
        double parts[3];
        draw(&d, &random);
        d.setup.settings.gains.alpha_f = scale_at_the_limit(&d, parts) / 3.0;
        d.setup.settings.limits.stage_speed = 1e-6;
        d.setup.settings.limits.lateral_speed = between(&random, 1e-7, 1e-5);
        d.setup.settings.limits.lateral_force = between(&random, 0.02, 0.5) * d.load;
        assert_int_equal(loop_open(&l, &d.setup), NT_OK);
        const nt_guarantee promised = promise(&l, d.slope);
        for (int way = 0; way < 6; ++way) {
            const double worst = rubbed(&l, &d, &random, &stopped);
            assert_true(worst <= promised.lateral_force);
            nearest = larger(nearest, worst / promised.lateral_force);
            past += worst > d.setup.settings.limits.lateral_force;
        }
    }
    print_message("%d of 240 ways stopped, %d past the limit; at most %.2f of the promise\n", stopped, past, nearest);
    assert_true(stopped > 20 && past > 20 && nearest > 0.3);
}

/* At rest after a way in x the hand of one axis holds alpha_f (f_s + share F_x): by the balance of forces. */
static void a_hand_of_one_axis_feels_its_projection(void **state)
{
    (void)state;
    static loop l;
    nt_session_setup setup = rubbing(300e6, 0.3);
    setup.rig.master.axes = 1.0;
    for (int with = 0; with < 2; ++with) {
        setup.settings.gains.projection_x = -0.5 * with;
        assert_int_equal(loop_open(&l, &setup), NT_OK);
        push(&l, 0.0, 0.0, 0.1, 0.2);
        run(&l, 1.0);
        assert_int_equal(nt_touch_aim(&l.touch, &l.state, 20e-9, 0.0, 0.1), NT_OK);
        run(&l, 5.0);
        const double *force = l.sim.slave.truth.tip_force, alpha_f = setup.settings.gains.alpha_f;
        assert_true(force[NT_X] < -1e-8); /* it was rubbed towards + x */
        const double felt = force[NT_Z] + setup.settings.gains.projection_x * force[NT_X];
        assert_within(alpha_f * felt, 0.1, 1e-4); /* it settles with tau = b/kappa, 0.1 to 0.3 s */
        assert_true(l.command.motor_force[NT_X] == 0.0);
    }
    setup.rig.master.axes = 3.0;
    assert_int_equal(loop_open(&l, &setup), NT_E_RANGE);
    setup.rig.master.axes = 1.0;
    setup.rig.probe.lateral_stiffness = 0.0;
    assert_int_equal(loop_open(&l, &setup), NT_E_RANGE);
}

/* A stop takes the force from the hand within 50 ms, with no step beyond the motor's rate. */
static void a_stop_lets_the_hand_go(void **state)
{
    (void)state;
    static loop l;
    nt_session_setup setup = rubbing(300e6, 0.3);
    setup.settings.limits.motor_rate = 2000.0;
    assert_int_equal(loop_open(&l, &setup), NT_OK);
    push(&l, 0.0, 0.0, 0.1, 0.2);
    run(&l, 1.0);
    push(&l, 0.01, 0.0, 0.1, 0.2);
    run(&l, 1.0);
    assert_true(l.command.motor_force[NT_X] < -0.005);
    l.touch.supervisor.limits.lateral_force = 1e-9;
    double last = l.command.motor_force[NT_X];
    for (int i = 0; i < 600; ++i) {
        run(&l, 0.5 * l.touch.period);
        assert_true(l.command.state == NT_RETRACT && l.command.reasons & NT_REASON_LATERAL);
        assert_true(fabs(l.command.motor_force[NT_X] - last) <= 2000.0 * l.touch.period * (1.0 + 1e-12));
        last = l.command.motor_force[NT_X];
    }
    assert_true(last == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hand_feels_what_holds_the_tip),
        cmocka_unit_test(the_exact_limit_is_that_of_the_simulation),
        cmocka_unit_test(at_the_bound_random_scenes_come_to_rest),
        cmocka_unit_test(no_lateral_force_is_more_than_promised),
        cmocka_unit_test(a_hand_of_one_axis_feels_its_projection),
        cmocka_unit_test(a_stop_lets_the_hand_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
