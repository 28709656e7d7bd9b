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

/* Eq. 21 in SI (erratum E17): L = 0.1 um and delta_max = 0.3 um over 2 cm; 10 N over 2.64 uN (10 V, 0.033 um/V, 8 N/m)
 * and 0.6 uN of attraction; the paper prints 3.2 uN and so 3.1e6. */
static void heuristic_rule_gives_the_papers_numbers(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_scaling scaling = nt_scaling_heuristic(&rig, 0.4e-6, 0.6e-6);
    assert_true(fabs(scaling.alpha_p / 2.0e-5 - 1.0) < 1e-12);
    assert_true(fabs(scaling.alpha_f / (10.0 / 3.24e-6) - 1.0) < 1e-12);
    assert_true(fabs(scaling.alpha_f / 3.1e6 - 1.0) < 0.01);
}

/* The whole of one range is the whole of the other: nothing of either is wasted or cut off. */
static void ranges_map_onto_each_other(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    rig.probe.spring_constant = 30.0;
    rig.master.travel = 0.1;
    rig.master.gauge_range = 20.0;
    const nt_scaling scaling = nt_scaling_heuristic(&rig, 3e-6, 1e-7);
    assert_true(fabs(scaling.alpha_p * rig.master.travel - 3e-6) < 1e-18);
    const double span = 30.0 * nt_probe_deflection_range(&rig.probe) + 1e-7;
    assert_true(fabs(scaling.alpha_f * span - 40.0) < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heuristic_rule_gives_the_papers_numbers),
        cmocka_unit_test(ranges_map_onto_each_other),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
