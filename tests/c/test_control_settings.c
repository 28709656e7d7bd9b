/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/rig.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

static void defaults_are_valid_and_inside_the_rig(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    for (double stiffness = 0.01; stiffness < 1000.0; stiffness *= 10.0) {
        rig.probe.spring_constant = stiffness;
        const nt_settings settings = nt_settings_defaults(&rig);
        nt_touch touch;
        assert_int_equal(nt_settings_check(&settings, NULL), NT_OK);
        assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
        assert_true(settings.limits.force < stiffness * nt_probe_deflection_range(&rig.probe));
    }
    rig = nt_rig_defaults();
    const nt_gains gains = nt_settings_defaults(&rig).gains;
    assert_true(gains.rate == 10e3 && gains.force_gain == 2.0);
}

static void every_field_is_refused_by_name(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    int count = 0;
    const nt_field *fields = nt_settings_fields(&count);
    assert_int_equal((size_t)count * sizeof(double),
                     sizeof(nt_gains) + sizeof(nt_limits) + sizeof(nt_tap)); /* no number is without a check */
    for (int i = 0; i < count; i++) {
        const nt_field *field = &fields[i];
        const double outside[] = {nextafter(field->minimum, -HUGE_VAL), nextafter(field->maximum, HUGE_VAL), NAN,
                                  HUGE_VAL};
        for (int j = 0; j < 4; j++) {
            nt_settings settings = nt_settings_defaults(&rig);
            nt_problem problem = {0};
            nt_field_set(field, &settings, outside[j]);
            const int is_choice = field->size != sizeof(double);
            assert_int_equal(nt_settings_check(&settings, &problem), j < 2 || is_choice ? NT_E_RANGE : NT_E_NOT_FINITE);
            assert_string_equal(problem.field, field->name);
        }
    }
}

static void they_keep_to_a_load(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    settings.gains.set_point = 0.3e-6;
    const nt_settings before = settings;
    nt_settings_keep_to(&settings, INFINITY);
    assert_memory_equal(&settings, &before, sizeof settings);
    nt_settings_keep_to(&settings, 0.4e-6);
    assert_true(settings.limits.force == 0.4e-6 && settings.gains.set_point == 0.2e-6);
    nt_settings_keep_to(&settings, 0.5e-6); /* never raises */
    assert_true(settings.limits.force == 0.4e-6 && settings.gains.set_point == 0.2e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_valid_and_inside_the_rig),
        cmocka_unit_test(every_field_is_refused_by_name),
        cmocka_unit_test(they_keep_to_a_load),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
