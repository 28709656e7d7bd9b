/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assertions.h"
#include "larger.h"
#include "nanotouch/material.h"

/* The paper's silicon pair, E = 135 GPa, nu = 0.35 twice: E* = 135/(2 (1 - 0.35^2)) = 76.92 GPa. */
static void effective_modulus_of_the_papers_pair(void **state)
{
    (void)state;
    const nt_material silicon = {135e9, 0.35};
    assert_within(nt_effective_modulus(silicon, silicon), 76.923e9, 0.001e9);
}

static void effective_modulus_limits(void **state)
{
    (void)state;
    const nt_material rubber = {0.6e6, 0.5}, steel = {200e9, 0.3}, rigid = {INFINITY, 0.3};
    assert_true(nt_effective_modulus(rubber, steel) == nt_effective_modulus(steel, rubber));
    assert_within(nt_effective_modulus(rigid, rubber), 0.8e6, 1e-9); /* E/(1 - nu^2) of the softer one */
    assert_true(nt_effective_modulus(rubber, steel) < 0.8e6);
    assert_true(isnan(nt_effective_modulus((nt_material){NAN, 0.3}, steel)));
    assert_true(isnan(nt_effective_modulus(steel, (nt_material){1e9, NAN})));
}

/* The 9-3 wall: p(z) = (8 w/(3 z0)) ((z0/z)^3 - (z0/z)^9) is largest at z = 3^(1/6) z0; searched here on a grid. */
static void cohesive_stress_is_the_peak_of_the_wall(void **state)
{
    (void)state;
    const double w = 0.144, z0 = 0.2e-9;
    double peak = 0.0;
    for (double z = z0; z < 3.0 * z0; z += 1e-4 * z0)
        peak = larger(peak, 8.0 * w / (3.0 * z0) * (pow(z0 / z, 3.0) - pow(z0 / z, 9.0)));
    assert_within(nt_cohesive_stress_atomic(w, z0), peak, 1e-7 * peak);
    assert_within(nt_cohesive_stress_atomic(w, z0) * z0 / w, 1.03, 0.005); /* erratum E9: 1.03 w/a0 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(effective_modulus_of_the_papers_pair),
        cmocka_unit_test(effective_modulus_limits),
        cmocka_unit_test(cohesive_stress_is_the_peak_of_the_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
