/* SPDX-License-Identifier: BSD-3-Clause
 * What is refused before arming and while running, and by which name. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/margins.h"
#include "nanotouch/nanotouch.h"
#include "session/hazard.h"

static char untouched;

static nt_session *open_session(const nt_session_setup *setup)
{
    nt_session *session = NULL;
    nt_problem problem = {0};
    if (nt_session_open(&session, setup, &problem) != NT_OK)
        fail_msg("%s", problem.field ? problem.field : "?");
    return session;
}

static void expect_refusal(const nt_session_setup *setup, nt_status status, const char *field)
{
    nt_session *session = (nt_session *)(void *)&untouched;
    nt_problem problem = {0};
    assert_int_equal(nt_session_open(&session, setup, &problem), status);
    assert_string_equal(problem.field ? problem.field : "", field);
    assert_ptr_equal(session, &untouched);
    assert_int_equal(nt_session_open(&session, setup, NULL), status);
}

/* What was opened as a curve, which no gain makes unstable, is judged again before the hand takes part. */
static void modes_and_scales_are_judged_while_running(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    setup.mode = NT_MODE_CURVE;
    setup.settings.gains.force_gain = 300.0;
    nt_session *session = open_session(&setup);
    assert_int_equal(nt_session_set_mode(session, NT_MODE_TOUCH, NULL), NT_E_RANGE);
    assert_int_equal(nt_session_set_mode(session, NT_MODE_APPROACH, NULL), NT_OK);
    assert_int_equal(nt_session_set_mode(session, (nt_mode)9, NULL), NT_E_ARGUMENT);
    nt_session_close(session);
    setup.settings.gains.force_gain = 2.0;
    session = open_session(&setup);
    const nt_scaling steep = {100.0 * setup.settings.gains.alpha_p, setup.settings.gains.alpha_f};
    assert_int_equal(nt_session_set_mode(session, NT_MODE_TOUCH, NULL), NT_OK);
    assert_int_equal(nt_session_rescale(session, &steep, NULL), NT_E_RANGE); /* by the mode that it is in now */
    assert_int_equal(nt_session_set_mode(session, NT_MODE_CURVE, NULL), NT_OK);
    assert_int_equal(nt_session_rescale(session, &steep, NULL), NT_OK);
    assert_int_equal(nt_session_set_mode(session, NT_MODE_TOUCH, NULL), NT_E_RANGE); /* by the scales that it has now */
    nt_session_close(session);
}

static double own_gain = 2.0;

/* The paper's motor law with a gain that the settings do not know. */
static nt_effort own_law(void *calls, const nt_gains *gains, const nt_signals *signals)
{
    (void)gains;
    ++*(int *)calls;
    const double reflected = signals->scaling.alpha_f * signals->felt_force;
    return (nt_effort){-reflected - own_gain * (reflected - signals->smooth_force), signals->target};
}

/* A law of one's own is armed by its own margins; overridden, it is not even called. */
static void an_own_law_is_judged_by_what_it_does(void **state)
{
    (void)state;
    int calls = 0;
    nt_session_setup setup = nt_session_defaults();
    setup.settings.control = (nt_control){NT_CONTROL_OWN, own_law, &calls};
    own_gain = 2.0;
    nt_session *session = open_session(&setup);
    const nt_margins found = nt_session_margins(session);
    nt_session_close(session);
    setup.settings.control = (nt_control){.choice = NT_CONTROL_DEFAULT};
    session = open_session(&setup);
    assert_true(fabs(found.exact_limit / nt_session_margins(session).exact_limit - 1.0) < 1e-7);
    nt_session_close(session);
    setup.settings.control = (nt_control){NT_CONTROL_OWN, own_law, &calls};
    own_gain = 300.0; /* and the settings still say 2 */
    expect_refusal(&setup, NT_E_RANGE, "stability margin (R5 noise)");
    setup.minimum_margin = 0.0;
    calls = 0;
    session = open_session(&setup);
    assert_int_equal(calls, 0);
    assert_true(isnan(nt_session_margins(session).exact_limit));
    nt_session_close(session);
    own_gain = NAN;
    setup.minimum_margin = 1.5;
    expect_refusal(&setup, NT_E_NOT_FINITE, "stability margin (own law, of no kind that can be judged)");
}

static void setups_without_a_margin_are_refused(void **state)
{
    (void)state;
    const nt_session_setup good = nt_session_defaults();
    nt_session_setup bad = good;
    bad.settings.gains.force_gain =
        300.0; /* kappa = 149 kN/m, R1: 121; three sigma of its noise are 0.6 of the motor */
    expect_refusal(&bad, NT_E_RANGE, "stability margin (R5 noise)");
    bad.rig.probe.noise = bad.rig.master.gauge_noise = bad.rig.master.gauge_resolution = 0.0;
    bad.rig.stage.command_resolution = bad.rig.master.resolution = 0.0; /* leaves the loop itself */
    expect_refusal(&bad, NT_E_RANGE, "stability margin (R1 contact)");
    bad.minimum_margin = 0.5; /* overridden explicitly */
    nt_session *session = open_session(&bad);
    assert_true(nt_session_margins(session).margin < 1.0);
    nt_session_close(session);
}

static void fields_out_of_range_are_refused_by_name(void **state)
{
    (void)state;
    const nt_session_setup good = nt_session_defaults();
    nt_session_setup bad = good;
    bad.minimum_margin = NAN;
    expect_refusal(&bad, NT_E_NOT_FINITE, "minimum_margin");
    bad.minimum_margin = -1.0;
    expect_refusal(&bad, NT_E_RANGE, "minimum_margin");
    bad = good;
    bad.settings.gains.alpha_p = NAN;
    expect_refusal(&bad, NT_E_NOT_FINITE, "gains.alpha_p");
    bad = good;
    bad.rig.master.damping = -1.0;
    expect_refusal(&bad, NT_E_RANGE, "master.damping");
    bad = good;
    bad.scene.tip.radius = 20.0;
    expect_refusal(&bad, NT_E_RANGE, "tip.radius");
    bad = good;
    bad.demand.relative_accuracy = 2.0;
    expect_refusal(&bad, NT_E_RANGE, "demand.relative_accuracy");
    bad = good;
    bad.clearance = 0.0;
    expect_refusal(&bad, NT_E_RANGE, "clearance");
    bad = good;
    bad.rise = 1e-3;
    expect_refusal(&bad, NT_E_RANGE, "rise");
    bad = good;
    bad.x = HUGE_VAL;
    expect_refusal(&bad, NT_E_NOT_FINITE, "x");
    bad = good;
    bad.ring_capacity = 1; /* 0: nothing is recorded */
    expect_refusal(&bad, NT_E_RANGE, "ring_capacity");
    bad = good;
    bad.settings.gains.delay = NT_SIM_DELAY_MAX + 1.0;
    expect_refusal(&bad, NT_E_RANGE, "gains.delay");
    bad = good;
    bad.settings.limits.force = 1e-3;
    expect_refusal(&bad, NT_E_RANGE, "limits.force");
    assert_int_equal(nt_session_open(NULL, &good, NULL), NT_E_ARGUMENT);
    nt_session_close(NULL);
}

/* What the guarantee adds for an indentation that cannot be seen. */
static double unseen(const nt_session *session, const nt_session_setup *setup)
{
    const nt_plan *found = nt_session_plan(session);
    nt_hazard hazard = nt_hazard_of(found, &setup->rig, &setup->settings, 0.0, HUGE_VAL);
    hazard.deepest = HUGE_VAL; /* by travel alone */
    const nt_guarantee with = nt_guarantee_compute(&setup->rig, &setup->settings, &hazard);
    hazard.unseen = 0.0;
    return with.indentation - nt_guarantee_compute(&setup->rig, &setup->settings, &hazard).indentation;
}

/* Hertz has F = 4/3 E* sqrt(R) delta^1.5 at twice the threshold of free motion; with adhesion the force reaches it
 * there, and never falls below it deeper down. */
static void the_promise_adds_what_cannot_be_seen(void **state)
{
    (void)state;
    for (int sticky = 0; sticky < 2; sticky++)
        for (double E = 1e6; E < 1e12; E *= 30.0) {
            nt_session_setup setup = nt_session_defaults();
            setup.scene.sample.youngs_modulus = E;
            setup.minimum_margin = 0.0;
            setup.rig.probe.spring_constant_sigma = setup.rig.probe.sensitivity_sigma = 0.0;
            if (!sticky) {
                setup.scene.medium.relative_humidity = 0.0;
                setup.scene.adhesion.work_of_adhesion = setup.scene.adhesion.hamaker_constant = 0.0;
            }
            nt_session *session = open_session(&setup);
            const nt_plan *found = nt_session_plan(session);
            const double depth = unseen(session, &setup);
            const double force = 2.0 * nt_session_touch(session)->supervisor.free_force;
            const double c = 4.0 / 3.0 * found->contact.effective_modulus * sqrt(setup.scene.tip.radius);
            const nt_interaction_state attached = {.attached = 1};
            if (!sticky)
                assert_true(fabs(depth / pow(force / c, 2.0 / 3.0) - 1.0) < 1e-6);
            assert_true(fabs(nt_interaction_eval_gap(found, &attached, NULL, -depth).F / force - 1.0) < 1e-5);
            for (double deeper = 1.0001 * depth; deeper < 30.0 * depth; deeper *= 1.01)
                assert_true(nt_interaction_eval_gap(found, &attached, NULL, -deeper).F > force);
            nt_session_close(session);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(setups_without_a_margin_are_refused),
        cmocka_unit_test(fields_out_of_range_are_refused_by_name),
        cmocka_unit_test(modes_and_scales_are_judged_while_running),
        cmocka_unit_test(an_own_law_is_judged_by_what_it_does),
        cmocka_unit_test(the_promise_adds_what_cannot_be_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
