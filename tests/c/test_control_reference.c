/* SPDX-License-Identifier: BSD-3-Clause
 * Margins and calm of random rigs against loop_oracle.py, which builds the whole loop as one matrix. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../reference/loop_table.h"
#include "../reference/sideways_table.h"
#include "control/margins.h"
#include "internal/control.h"
#include "internal/margins.h"
#include "larger.h"
#include "nanotouch/control.h"
#include "nanotouch/margins.h"

enum { CASES = sizeof loop_cases / sizeof loop_cases[0], STIFFNESS = sizeof loop_cases[0].in / sizeof(double) - 1 };

static void compare(const char *kind, const char *name, double found, double expected, double tolerance)
{
    if (isnan(expected))
        return; /* nothing to ask */
    if (isinf(expected) ? isinf(found) : fabs(found / expected - 1.0) < tolerance)
        return;
    if (expected == 0.0 && found == 0.0)
        return;
    fail_msg("%s of %s: %.12g, expected %.12g", name, kind, found, expected);
}

#define COMPARE(row, found, name, tolerance) compare((row)->kind, #name, (found).name, (row)->name, tolerance)

static void margins_are_those_of_the_whole_matrix(void **state)
{
    (void)state;
    for (int i = 0; i < CASES; ++i) {
        const loop_case *row = &loop_cases[i];
        nt_rig rig = nt_rig_defaults();
        nt_settings settings = nt_settings_defaults(&rig);
        set_loop(row->in, &rig, &settings);
        nt_margins found;
        (void)nt_margins_judge(&rig, &settings, row->in[STIFFNESS], NT_MODE_TOUCH, &found);
        COMPARE(row, found, loop_stiffness, 1e-12);
        COMPARE(row, found, loop_delay, 1e-9); /* the notch's delay is a small difference of large numbers */
        COMPARE(row, found, stability_limit, 1e-9);
        COMPARE(row, found, margin, 1e-9);
        COMPARE(row, found, pad_limit, 1e-9);
        COMPARE(row, found, mass_limit, 1e-12);
        COMPARE(row, found, quantisation_step, 1e-12);
        COMPARE(row, found, force_noise, 1e-12);
        COMPARE(row, found, height_margin, 1e-9);
        COMPARE(row, found, exact_limit, 1e-6); /* a radius of 1 + 1e-10 was looked for */
        COMPARE(row, found, exact_frequency, 1e-6);
        COMPARE(row, found, force_gain_limit, 1e-6);
        COMPARE(row, found, integral_limit, 1e-6);
        COMPARE(row, found, coupling_margin, 1e-6);
    }
}

/* The stage's own limit asks no master: without damping it is the same, and the others are none. */
static void a_master_without_damping(void **state)
{
    (void)state;
    for (int i = 0; i < CASES; ++i) {
        const loop_case *row = &loop_cases[i];
        nt_rig rig = nt_rig_defaults();
        nt_settings settings = nt_settings_defaults(&rig);
        set_loop(row->in, &rig, &settings);
        rig.master.damping = rig.hand.damping = 0.0;
        const nt_margins found = nt_margins_compute(&rig, &settings.gains, row->in[STIFFNESS]);
        assert_true(found.exact_limit == 0.0 && found.force_gain_limit == 0.0 && isnan(found.exact_frequency));
        if (settings.control.choice != NT_CONTROL_PAPER)
            COMPARE(row, found, integral_limit, 1e-6);
    }
}

static void calm_is_that_of_the_whole_matrix(void **state)
{
    (void)state;
    for (int i = 0; i < CASES; ++i) {
        const loop_case *row = &loop_cases[i];
        nt_rig rig = nt_rig_defaults();
        nt_settings settings = nt_settings_defaults(&rig);
        set_loop(row->in, &rig, &settings);
        const nt_calm found = nt_margins_calm(&rig, &settings, row->in[STIFFNESS]);
        for (int part = 0; part < NT_RIPPLE_SOURCES; ++part)
            compare(row->kind, "a part of the ripple", found.parts[part], row->calm.parts[part], 2e-2);
        compare(row->kind, "ripple", found.ripple, row->calm.ripple,
                2e-2); /* of an integral in steps of some per cent */
        compare(row->kind, "ringing", found.ringing, row->calm.ringing, 2e-2);
        compare(row->kind, "felt", found.felt, row->calm.felt, 1e-12);
        compare(row->kind, "slewing", found.slewing, row->calm.slewing, 1e-9);
        compare(row->kind, "margin", found.margin, row->calm.least, 2e-2);
    }
}

/* Of a master of three axes; the rule along z is that of the margins. */
static void sideways_margins_are_those_of_the_whole_matrix(void **state)
{
    (void)state;
    int exact_ones = 0;
    for (size_t i = 0; i < sizeof sideways_cases / sizeof sideways_cases[0]; ++i) {
        const sideways_case *row = &sideways_cases[i];
        nt_rig rig = nt_rig_defaults();
        nt_settings settings = nt_settings_defaults(&rig);
        set_loop(row->in, &rig, &settings);
        const double k = row->in[STIFFNESS], *in = &row->in[STIFFNESS + 1];
        const nt_sideways_contact contact = {in[0], in[1], in[2], in[3], in[4]};
        nt_margins along_z;
        (void)nt_margins_judge(&rig, &settings, k, NT_MODE_TOUCH, &along_z);
        const nt_sideways_margins found = nt_margins_sideways(&rig, &settings, k, &contact, &along_z);
        COMPARE(row, found, loop_stiffness, 1e-12);
        COMPARE(row, found, loop_delay, 1e-12);
        COMPARE(row, found, margin, 1e-12);
        COMPARE(row, found, exact_limit, 1e-6); /* a radius of 1 + 1e-10 was looked for */
        COMPARE(row, found, exact_frequency, 1e-6);
        COMPARE(row, found, coupling, 1e-9);
        COMPARE(row, found, coupled_margin, 1e-6);
        const nt_margins far = {.loop_stiffness = 1.0, .loop_delay = 1.0, .stability_limit = 1e300, .margin = 1e300};
        const nt_sideways_margins exact = nt_margins_sideways(&rig, &settings, k, &contact, &far); /* no rule along z */
        compare(row->kind, "all axes, exactly", exact.coupled_margin, smaller(row->margin, row->together), 1e-6);
        exact_ones += row->together < row->margin;
        settings.gains.projection_x = 0.3;
        settings.gains.projection_y = -0.4;
        compare(row->kind, "projected", nt_margins_projected(&rig, &settings, k, &contact), row->projected, 1e-12);
    }
    assert_true(exact_ones >= 4);
}

/* Friction, stick or slope that is next to nothing counts as none; on a flat without friction nothing ties the axes. */
static void what_is_next_to_nothing(void **state)
{
    (void)state;
    const sideways_case *row = &sideways_cases[0];
    nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    set_loop(row->in, &rig, &settings);
    const double k = row->in[STIFFNESS], *in = &row->in[STIFFNESS + 1];
    const nt_sideways_contact own = {in[0], in[1], in[2], in[3], in[4]};
    const nt_margins far = {.loop_stiffness = 1.0, .loop_delay = 1.0, .stability_limit = 1e300, .margin = 1e300};
    for (int i = 0; i < 8; ++i) {
        nt_sideways_contact some = {i & 1 ? own.stick : 0.0, i & 2 ? own.grip : 0.0, i & 4 ? own.slope : 0.0, 0.0, 0.0};
        const nt_sideways_margins none = nt_margins_sideways(&rig, &settings, k, &some, &far);
        some.stick = larger(some.stick, 1e-9);
        some.grip = larger(some.grip, 1e-9);
        some.slope = larger(some.slope, 1e-12);
        const nt_sideways_margins little = nt_margins_sideways(&rig, &settings, k, &some, &far);
        if (i & 6) {
            compare("a contact", "coupled_margin", little.coupled_margin, none.coupled_margin, 1e-6);
            continue;
        }
        assert_true(none.coupling == 0.0 && (i ? fabs(none.coupled_margin / none.margin - 1.0) < 1e-12 : 1));
    }
    settings.control =
        (nt_control){NT_CONTROL_OWN, nt_servo_default, NULL}; /* a law of one's own as what it amounts to */
    const nt_sideways_margins its = nt_margins_sideways(&rig, &settings, k, &own, &far);
    settings.gains.force_gain = 77.0; /* of the settings, which this law does not ask */
    settings.control.law = nt_servo_impedance;
    const nt_sideways_margins blind = nt_margins_sideways(&rig, &settings, k, &own, &far);
    settings.control = (nt_control){.choice = NT_CONTROL_IMPEDANCE};
    const nt_sideways_margins same = nt_margins_sideways(&rig, &settings, k, &own, &far);
    compare("own law", "coupled_margin", its.coupled_margin, smaller(row->margin, row->together), 1e-6);
    compare("own impedance", "coupled_margin", blind.coupled_margin, same.coupled_margin, 1e-6);
}

/* A master of one axis feels more of its force along z only where it projects, on a contact. */
static void what_is_projected(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    const nt_sideways_contact contact = {.stick = 1.0, .grip = 0.25, .slope = 0.5};
    assert_true(nt_margins_projected(&rig, &settings, 4.0, &contact) == 1.0);
    settings.gains.projection_y = 0.5;
    const double k_eff = 4.0 * 8.0 / 12.0, by_z = k_eff * 0.5 + 0.25 * k_eff / 4.0;
    compare("a", "projection", nt_margins_projected(&rig, &settings, 4.0, &contact), 1.0 + 0.5 * by_z / k_eff, 1e-12);
    assert_true(nt_margins_projected(&rig, &settings, 0.0, &contact) == 1.0);
    compare("a soft", "projection", nt_margins_projected(&rig, &settings, 0.1, &contact), 1.0 + 0.5 * (0.5 + 2.5),
            1e-12);
}

/* The least of three, each by its name; a master without damping has no exact limit, and a rule alone. */
static void verdicts_sideways(void **state)
{
    (void)state;
    const char *const names[] = {"R1 sideways", "exact sideways", "all axes"};
    for (int i = 0; i < 3; ++i) {
        nt_sideways_margins m = {.loop_stiffness = 2.0, .margin = 5.0, .exact_limit = 10.0, .coupled_margin = 5.0};
        *(i == 0 ? &m.margin : i == 1 ? &m.exact_limit : &m.coupled_margin) *= 0.5;
        const nt_verdict found = nt_verdict_sideways(&m);
        assert_true(found.margin == 2.5);
        assert_string_equal(found.rule, names[i]);
    }
    nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    const nt_sideways_contact contact = {.stick = 1.0, .grip = 0.25, .slope = 0.5};
    nt_margins along_z;
    rig.master.damping = 0.25;
    (void)nt_margins_judge(&rig, &settings, 0.2, NT_MODE_TOUCH, &along_z);
    nt_sideways_margins found = nt_margins_sideways(&rig, &settings, 0.2, &contact, &along_z);
    assert_true(found.exact_limit > 0.0 && found.exact_frequency > 0.0);
    rig.master.damping = 0.0;
    found = nt_margins_sideways(&rig, &settings, 0.2, &contact, &along_z);
    assert_true(found.exact_limit == 0.0 && found.margin == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sideways_margins_are_those_of_the_whole_matrix),
        cmocka_unit_test(what_is_next_to_nothing),
        cmocka_unit_test(what_is_projected),
        cmocka_unit_test(verdicts_sideways),
        cmocka_unit_test(margins_are_those_of_the_whole_matrix),
        cmocka_unit_test(a_master_without_damping),
        cmocka_unit_test(calm_is_that_of_the_whole_matrix),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
