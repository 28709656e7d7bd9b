/* SPDX-License-Identifier: BSD-3-Clause
 * The force scale of a first touch: 0.3 N for the pull-off, at most Eq. 19, and what stability and calm leave of it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/advanced/control.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

#define STIFFNESS 665.0 /* silicon on silicon under 0.4 uN [N/m] */

static void the_pull_off_is_clearly_felt(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    const double found = nt_margins_felt_alpha_f(&rig, &settings, 18e-9, 0.4e-6, STIFFNESS);
    assert_true(found * 18e-9 > NT_CLEARLY_FELT && found * 18e-9 < 1.1 * NT_CLEARLY_FELT);
}

/* 10 N at the hand from pull-off to load; never below what the settings have. */
static void equation_19_is_kept(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    settings.limits.force = 1e-6;
    const double full = nt_margins_felt_alpha_f(&rig, &settings, 1e-9, 0.999e-6, 1e-3);
    assert_true(fabs(full / 10e6 - 1.0) < 1e-9);
    assert_true(nt_margins_felt_alpha_f(&rig, &settings, 1e-6, 1e-6, STIFFNESS) == settings.gains.alpha_f);
    nt_rig weak = rig; /* as far as gauge and motor both reach */
    weak.master.max_force = 4.0;
    assert_true(fabs(nt_margins_felt_alpha_f(&weak, &settings, 1e-9, 0.999e-6, 1e-3) / 8e6 - 1.0) < 1e-9);
    weak.master.gauge = 0;
    weak.master.max_force = 6.0;
    settings.gains.force_gain = 0.0;
    assert_true(fabs(nt_margins_felt_alpha_f(&weak, &settings, 1e-9, 0.999e-6, 1e-3) / 12e6 - 1.0) < 1e-9);
}

/* A coarse master ripples, a late link is near its limit: as much as leaves neither, and 3 % more does not. */
static void it_is_as_much_as_is_stable_and_calm(void **state)
{
    (void)state;
    for (int late = 0; late < 2; late++) {
        nt_rig rig = nt_rig_defaults();
        nt_settings settings = nt_settings_defaults(&rig);
        if (late)
            settings.gains.delay = 50.0;
        else
            rig.master.resolution = 0.2e-3;
        const double plain = settings.gains.alpha_f;
        const double highest = NT_CLEARLY_FELT / (0.93 * 18e-9);
        settings.gains.alpha_f = nt_margins_felt_alpha_f(&rig, &settings, 18e-9, 0.4e-6, STIFFNESS);
        assert_true(settings.gains.alpha_f > plain && settings.gains.alpha_f < 1.6e7);
        const double halvings = 256.0 * log(settings.gains.alpha_f / plain) / log(highest / plain);
        assert_true(fabs(halvings - round(halvings)) < 1e-6);
        for (int more = 0; more < 2; more++) {
            nt_margins margins;
            const nt_verdict verdict = nt_margins_judge(&rig, &settings, STIFFNESS, NT_MODE_TOUCH, &margins);
            const nt_calm calm = nt_margins_calm(&rig, &settings, STIFFNESS);
            assert_int_equal(verdict.margin >= 3.0 && calm.margin >= 1.0, !more);
            settings.gains.alpha_f *= pow(highest / plain, 1.0 / 256.0) * (1.0 + 1e-9); /* eight times halved */
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_pull_off_is_clearly_felt),
        cmocka_unit_test(equation_19_is_kept),
        cmocka_unit_test(it_is_as_much_as_is_stable_and_calm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
