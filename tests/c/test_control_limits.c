/* SPDX-License-Identifier: BSD-3-Clause
 * Rigs at the ends of what is allowed: dead times beyond all use, nothing to touch, no motor, a coupling that is
 * unstable by itself, laws and samples that fail at the last moment. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "control/margins.h"
#include "control/preflight.h"
#include "control/sampled.h"
#include "control/sideways.h"
#include "core/rig.h"
#include "internal/margins.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/control.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

/* --- margins --- */

/* A master that is read once a second at 20 kHz, or a converter that takes a second: no loop closes. */
static void beyond_ten_thousand_periods_no_gain_is_left(void **unused)
{
    (void)unused;
    nt_rig rig = nt_rig_defaults();
    rig.master.axes = 3.0;
    rig.probe.lateral_stiffness = 50.0;
    nt_settings settings = nt_settings_defaults(&rig);
    settings.gains.rate = 20e3;
    const nt_sideways_contact contact = {.stick = 10.0};
    const nt_rig usual = rig;
    for (int slow = 0; slow < 2; slow++) {
        nt_margins margins;
        rig = usual;
        *(slow ? &rig.master.rate : &rig.converters.dac_latency) = 1.0;
        const nt_verdict verdict = nt_margins_judge(&rig, &settings, 1e3, NT_MODE_TOUCH, &margins);
        assert_true(verdict.margin == 0.0 && margins.exact_limit == 0.0 && margins.force_gain_limit == 0.0);
        assert_string_equal(verdict.rule, "exact contact");
        const nt_sideways_margins sideways = nt_margins_sideways(&rig, &settings, 1e3, &contact, &margins);
        assert_true(sideways.margin < 0.1 && sideways.exact_limit == 0.0);
    }
}

/* Over a surface that only attracts no stiffness is to be felt along z: what is left is x and y by themselves. */
static void without_a_contact_the_axes_do_not_couple(void **unused)
{
    (void)unused;
    nt_rig rig = nt_rig_defaults();
    rig.master.axes = 3.0;
    rig.probe.lateral_stiffness = 50.0;
    const nt_settings settings = nt_settings_defaults(&rig);
    const nt_sideways_contact contact = {.stick = 10.0, .slope = 0.5};
    nt_margins along_z;
    (void)nt_margins_judge(&rig, &settings, 0.0, NT_MODE_TOUCH, &along_z);
    const nt_sideways_margins found = nt_margins_sideways(&rig, &settings, 0.0, &contact, &along_z);
    assert_true(found.coupling == 0.0 && found.margin > 0.0);
    assert_true(fabs(found.coupled_margin / found.margin - 1.0) < 1e-12);
}

static void without_a_motor_the_stage_is_judged_alone(void **unused)
{
    (void)unused;
    nt_rig rig = nt_rig_defaults();
    rig.master.motor = 0;
    nt_settings settings = nt_settings_defaults(&rig);
    for (int i = 0; i < 3; i++) {
        nt_margins margins;
        settings.gains.stage_integral = 20.0 * i;
        const nt_verdict verdict = nt_margins_judge(&rig, &settings, 1e3, NT_MODE_TOUCH, &margins);
        assert_string_equal(verdict.rule, i ? "stage integral" : "none: no loop is closed");
        assert_true(i == 0 || verdict.margin == margins.integral_limit / (20.0 * i));
    }
}

/* Mass and damping of the virtual tool in a light hand: drag over more than a period is unstable in air. */
static void a_coupling_that_drags_too_hard_leaves_no_stiffness(void **unused)
{
    (void)unused;
    nt_rig rig = nt_rig_defaults();
    rig.master.mass = 0.02;
    rig.master.damping = 0.05;
    nt_settings settings = nt_settings_defaults(&rig);
    settings.gains.rate = 1200.0;
    settings.gains.delay = 2.0;
    settings.gains.coupling_stiffness = 6e4;
    double limit[2];
    for (int hard = 0; hard < 2; hard++) {
        settings.gains.coupling_damping = hard ? 80.0 : 1.0;
        const nt_sampled_loop loop = nt_sampled_loop_of(&rig, &settings, &settings.gains);
        limit[hard] = nt_sampled_limits_of(&loop, 0.0, 10.0).loop_stiffness;
    }
    assert_true(limit[0] > 0.0 && limit[1] == 0.0);
}

/* A light hand, slowly sampled: what it feels is within 3 dB of the contact at every frequency that there is. */
static void what_is_felt_rightly_at_all_frequencies_has_their_end_as_bandwidth(void **unused)
{
    (void)unused;
    nt_rig rig = nt_rig_defaults();
    rig.master.mass = 0.053;
    rig.master.damping = 0.0126;
    rig.probe.spring_constant = 2.81;
    rig.stage.resonance = 350e3;
    nt_settings settings = nt_settings_defaults(&rig);
    settings.gains = nt_settings_defaults(&rig).gains;
    settings.gains.rate = 1640.0;
    settings.gains.alpha_p = 0.21364;
    settings.gains.alpha_f = 3.12e6;
    settings.gains.delay = settings.gains.force_gain = 0.0;
    const double found = nt_margins_bandwidth(&rig, &settings.gains, 1e3);
    assert_true(found == 820.0);
    const double k_r = settings.gains.alpha_f * settings.gains.alpha_p * 2.81 / (1.0 + 2.81 / 1e3);
    for (double f = 1.0; f <= 820.0; f += 9.0) {
        const nt_loop_response at = nt_margins_response(&rig, &settings.gains, 1e3, f);
        const double ratio = hypot(at.impedance[0], at.impedance[1]) * 2.0 * 3.14159265358979323846 * f / k_r;
        assert_true(ratio > 0.7071 && ratio < 1.4143);
    }
}

static void what_cannot_be_sampled_is_no_number(void **unused)
{
    (void)unused;
    const nt_sampled part = nt_sampled_make(1.0, (double)NAN, 0.0, 1e-4, 0.5e-4);
    for (int i = 0; i < 4; i++)
        assert_true(isnan(part.step[i / 2][i % 2]));
}

/* --- laws of one's own --- */

typedef struct changing {
    int calls, after;     /* from this call on it answers otherwise */
    double motor, travel; /* by so much [N], [m] */
} changing;

static nt_effort changes(void *context, const nt_gains *gains, const nt_signals *s)
{
    changing *law = context;
    (void)gains;
    const int now = ++law->calls > law->after;
    return (nt_effort){-s->scaling.alpha_f * s->felt_force + now * law->motor, s->target + now * law->travel};
}

/* Whenever it changes its mind while it is tried, the last moment too: it amounts to no known law. */
static void a_law_that_changes_has_no_margin(void **unused)
{
    (void)unused;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig), amounts;
    changing law = {.after = 1 << 20};
    settings.control = (nt_control){NT_CONTROL_OWN, changes, &law};
    assert_int_equal(nt_margins_own_law(&rig, &settings, 1e3, &amounts), NT_OK);
    const int all = law.calls;
    for (int which = 0; which < 2; which++)
        for (int after = 1; after < all; after++) {
            law = (changing){.after = after, .motor = which ? 0.0 : 1.0, .travel = which ? 1e-6 : 0.0};
            const nt_status found = nt_margins_own_law(&rig, &settings, 1e3, &amounts);
            /* between two of the six forces at which it is tried nobody can see an offset */
            assert_true(found == NT_E_UNSUPPORTED || law.calls == all);
            assert_true(found == NT_E_UNSUPPORTED || after % (all / 6) == 0);
        }
}

static nt_effort nowhere(void *context, const nt_gains *gains, const nt_signals *s)
{
    (void)gains;
    return (nt_effort){0.0, *(const int *)context ? (double)NAN : s->target};
}

/* It gives a force, but does not say where the stage shall go. */
static void a_law_that_sends_the_stage_nowhere_holds_then_retracts(void **unused)
{
    (void)unused;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    int fails = 0;
    settings.control = (nt_control){NT_CONTROL_OWN, nowhere, &fails};
    nt_touch touch;
    assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
    nt_touch_state state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
    nt_command command = {0};
    static const nt_state expected[] = {NT_RUN, NT_RUN, NT_HOLD, NT_RETRACT, NT_RETRACT};
    for (int i = 0; i < 5; i++) {
        const nt_sample sample = {.tick = (uint64_t)i};
        fails = i >= 2;
        nt_touch_step(&touch, &state, &sample, &command);
        assert_int_equal(command.state, expected[i]);
        assert_true(isfinite(command.stage_position[NT_Z]) && isfinite(command.motor_force[NT_Z]));
    }
    assert_true(command.reasons & NT_REASON_LAW);
}

/* --- samples --- */

/* The deflection leaves its range in the very last sample of the tare. */
static void a_tare_is_judged_to_its_last_sample(void **unused)
{
    (void)unused;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    const nt_preflight preflight = nt_preflight_make(&rig, &settings);
    const uint32_t last = 2u * preflight.ticks - 1u;
    nt_preflight_state state = {.verdict = NT_PREFLIGHT_RUNNING};
    nt_command command = {0};
    for (uint32_t i = 0; i <= last; i++) {
        assert_int_equal(state.verdict, NT_PREFLIGHT_RUNNING);
        const nt_sample sample = {.deflection[NT_Z] =
                                      i == last ? nt_probe_deflection_range(&rig.probe) : 1e-10 * (i % 2u)};
        nt_preflight_step(&preflight, &state, &sample, &command);
    }
    assert_true(state.verdict != NT_PREFLIGHT_RUNNING && state.verdict != NT_PREFLIGHT_PASSED);
}

/* A hand that is not seen, over a stage that is: no energy is counted for what nobody knows. */
static void an_unseen_hand_takes_no_part_in_the_energy(void **unused)
{
    (void)unused;
    nt_rig rig = nt_rig_defaults();
    rig.master.axes = 3.0;
    rig.probe.lateral_stiffness = 50.0;
    const nt_settings settings = nt_settings_defaults(&rig);
    nt_touch touch;
    assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
    nt_touch_state state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
    nt_sample sample = {.tick = 0};
    nt_sideways_watch(&touch, &state, &sample, 1);
    for (int unseen = 1; unseen >= 0; unseen--) {
        const double before = state.passivity_sideways[NT_Y].energy;
        sample.stage_position[NT_X] = sample.stage_position[NT_Y] += 1e-8;
        state.lateral_force[NT_X] = state.lateral_force[NT_Y] = 1e-8;
        state.engaged = 1.0;
        sample.master_position[NT_X] = sample.master_position[NT_Y] = unseen ? (double)NAN : 0.0;
        nt_sideways_watch(&touch, &state, &sample, 1);
        assert_true(!unseen || state.passivity_sideways[NT_Y].energy == before);
    }
    assert_true(isfinite(state.passivity_sideways[NT_X].energy));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(beyond_ten_thousand_periods_no_gain_is_left),
        cmocka_unit_test(without_a_contact_the_axes_do_not_couple),
        cmocka_unit_test(without_a_motor_the_stage_is_judged_alone),
        cmocka_unit_test(a_coupling_that_drags_too_hard_leaves_no_stiffness),
        cmocka_unit_test(what_is_felt_rightly_at_all_frequencies_has_their_end_as_bandwidth),
        cmocka_unit_test(what_cannot_be_sampled_is_no_number),
        cmocka_unit_test(a_law_that_changes_has_no_margin),
        cmocka_unit_test(a_law_that_sends_the_stage_nowhere_holds_then_retracts),
        cmocka_unit_test(a_tare_is_judged_to_its_last_sample),
        cmocka_unit_test(an_unseen_hand_takes_no_part_in_the_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
