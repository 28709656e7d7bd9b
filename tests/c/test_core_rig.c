/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "core/rig.h"
#include "internal/rig.h"
#include "nanotouch/rig.h"

static void defaults_are_the_papers(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    assert_int_equal(nt_rig_check(&rig, NULL), NT_OK);
    /* Sec. IV-C: delta_max 0.33 um, forces within 2.6 uN, resolution 13 nN peak to peak. */
    assert_true(fabs(nt_probe_deflection_range(&rig.probe) - 0.33e-6) < 1e-15);
    assert_true(fabs(rig.probe.spring_constant * nt_probe_deflection_range(&rig.probe) - 2.64e-6) < 1e-14);
    assert_true(fabs(6.0 * nt_probe_force_noise(&rig.probe) - 13.2e-9) < 1e-16);
    assert_true(rig.stage.resonance == 450.0 && rig.stage.quality == 20.0);
    assert_true(rig.master.mass == 0.1 && rig.master.damping == 100.0);
    /* N_p <= 500 and N_f <= 500 steps of the master. */
    assert_true(fabs(rig.master.travel / rig.master.resolution - 500.0) < 1e-9);
    assert_true(fabs(2.0 * rig.master.gauge_range / rig.master.gauge_resolution - 500.0) < 1e-9);
}

/* Every number of the rig is in the table, once, so that none goes unchecked. */
static void table_covers_every_number(void **state)
{
    (void)state;
    int count = 0;
    const nt_field *fields = nt_rig_fields(&count);
    assert_int_equal((int)(sizeof(nt_rig) / sizeof(double)), count);
    int seen[sizeof(nt_rig) / sizeof(double)] = {0};
    for (int i = 0; i < count; i++) {
        assert_true(fields[i].offset % sizeof(double) == 0 && fields[i].offset < sizeof(nt_rig));
        assert_int_equal(seen[fields[i].offset / sizeof(double)]++, 0);
        assert_true(fields[i].minimum < fields[i].maximum);
        assert_true(strlen(fields[i].doc) > 0);
    }
}

static void each_field_is_refused_by_name(void **state)
{
    (void)state;
    int count = 0;
    const nt_field *fields = nt_rig_fields(&count);
    for (int i = 0; i < count; i++) {
        const double below = nextafter(fields[i].minimum, -HUGE_VAL), above = nextafter(fields[i].maximum, HUGE_VAL);
        const double bad[] = {below, above, (double)NAN};
        for (int k = 0; k < 3; k++) {
            nt_rig rig = nt_rig_defaults();
            nt_problem problem = {0};
            nt_field_set(&fields[i], &rig, bad[k]);
            const int is_choice = fields[i].size != sizeof(double);
            assert_int_equal(nt_rig_check(&rig, &problem), k < 2 || is_choice ? NT_E_RANGE : NT_E_NOT_FINITE);
            assert_string_equal(problem.field, fields[i].name);
        }
    }
    nt_rig rig = nt_rig_defaults();
    rig.probe.spring_constant = 0.0;
    assert_int_equal(nt_rig_check(&rig, NULL), NT_E_RANGE);
}

/* Bits over +-range, unless the part's own steps are coarser. */
static void converters_have_steps(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    nt_rig real = nt_rig_with_steps(&rig);
    assert_memory_equal(&real, &rig, sizeof rig);
    rig.converters.adc_bits = 12.0;
    rig.converters.dac_bits = 16.0;
    real = nt_rig_with_steps(&rig);
    assert_true(fabs(real.probe.resolution - 20.0 / 4096.0) < 1e-15);
    assert_true(fabs(real.stage.resolution - 100e-6 / 4096.0) < 1e-20);
    assert_true(fabs(real.stage.command_resolution - 100e-6 / 65536.0) < 1e-22);
    assert_true(real.master.resolution == rig.master.resolution); /* 0.04 mm, a bit is 5 um */
    assert_true(real.master.gauge_resolution == rig.master.gauge_resolution);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_the_papers),
        cmocka_unit_test(table_covers_every_number),
        cmocka_unit_test(each_field_is_refused_by_name),
        cmocka_unit_test(converters_have_steps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
