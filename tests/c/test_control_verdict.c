/* SPDX-License-Identifier: BSD-3-Clause
 * Which margin a session is judged by, in every mode and under every kind of law. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "larger.h"
#include "nanotouch/margins.h"

static const double stiffness = 1e3;

static nt_verdict judged(nt_control_choice choice, nt_mode mode, nt_margins *margins)
{
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    settings.control.choice = choice;
    return nt_margins_judge(&rig, &settings, stiffness, mode, margins);
}

/* In touch the smallest counts: none of those that the margins hold is below it, and the one it names is it. */
static void the_smallest_counts_in_touch(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    const double force_gains[] = {0.5, 2.0, 10.0, 100.0};
    for (int i = 0; i < 4; i++) {
        nt_margins margins;
        settings.gains.force_gain = force_gains[i];
        const nt_verdict verdict = nt_margins_judge(&rig, &settings, stiffness, NT_MODE_TOUCH, &margins);
        const double others[] = {
            margins.margin, margins.exact_limit / margins.loop_stiffness, margins.force_gain_limit / force_gains[i],
            rig.master.max_force / margins.quantisation_step, rig.master.max_force / (3.0 * margins.force_noise)};
        double least = INFINITY;
        for (int k = 0; k < 5; k++)
            least = smaller(least, others[k]);
        assert_true(verdict.margin > 0.0 && verdict.margin == least);
    }
}

static void other_modes_know_the_height_servo_or_nothing(void **state)
{
    (void)state;
    const nt_control_choice choices[] = {NT_CONTROL_DEFAULT, NT_CONTROL_PAPER, NT_CONTROL_IMPEDANCE};
    for (int i = 0; i < 3; i++) {
        nt_margins margins;
        const nt_verdict height = judged(choices[i], NT_MODE_TOPOGRAPHY, &margins);
        assert_true(height.margin == margins.height_margin && height.margin > 0.0);
        assert_string_equal(height.rule, "height servo");
        assert_true(judged(choices[i], NT_MODE_CURVE, &margins).margin == (double)INFINITY);
    }
}

/* One's own, where there is none to be tried: not a number in touch, the height servo is as ever. */
static void a_law_that_cannot_be_tried_has_no_margin(void **state)
{
    (void)state;
    nt_margins margins, known;
    judged(NT_CONTROL_DEFAULT, NT_MODE_TOPOGRAPHY, &known);
    const nt_verdict touch = judged(NT_CONTROL_OWN, NT_MODE_TOUCH, &margins);
    assert_true(isnan(touch.margin) && isnan(margins.margin) && isnan(margins.loop_stiffness));
    assert_string_equal(touch.field, "stability margin (own law, of no kind that can be judged)");
    assert_true(judged(NT_CONTROL_OWN, NT_MODE_TOPOGRAPHY, &margins).margin == known.height_margin);
    assert_true(isnan(margins.exact_limit) && margins.height_margin == known.height_margin);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_smallest_counts_in_touch),
        cmocka_unit_test(other_modes_know_the_height_servo_or_nothing),
        cmocka_unit_test(a_law_that_cannot_be_tried_has_no_margin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
