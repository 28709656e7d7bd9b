/* SPDX-License-Identifier: BSD-3-Clause
 * E(t) and J(t) of arms: a convolution that must give t, and Zener's solid in closed form. */
#include "assertions.h"
#include "nanotouch/rheology.h"

static nt_rheology series(double equilibrium)
{
    nt_rheology made = nt_rheology_defaults();
    made.kind = NT_RHEOLOGY_PRONY;
    made.arm_count = 3;
    made.equilibrium_modulus = equilibrium;
    for (int k = 0; k < 3; k++) {
        made.arm_moduli[k] = 300.0 * (k + 1);
        made.relaxation_times[k] = 0.02 * pow(12.0, k);
    }
    return made;
}

/* Int_0^t E(t - s) J(s) ds = t, by Simpson's rule in s. */
static void creep_is_the_inverse_of_relaxation(void **unused)
{
    (void)unused;
    for (int fluid = 0; fluid < 2; fluid++) {
        const nt_rheology of = series(fluid ? 0.0 : 250.0);
        const double t = 0.7;
        const int n = 4000;
        double sum = 0.0;
        for (int i = 0; i <= n; i++) {
            const double s = t * i / n, weight = i == 0 || i == n ? 1.0 : i % 2 ? 4.0 : 2.0;
            sum += weight * nt_rheology_relaxation(&of, t - s) * nt_rheology_creep(&of, s);
        }
        assert_within(sum * t / (3.0 * n), t, 1e-9 * t); /* h^4/180 of the fastest arm */
    }
}

static void zener_in_closed_form(void **unused)
{
    (void)unused;
    nt_rheology of = nt_rheology_defaults();
    of.kind = NT_RHEOLOGY_STANDARD_LINEAR_SOLID;
    of.equilibrium_modulus = 400.0;
    of.arm_moduli[0] = 1200.0;
    of.relaxation_times[0] = 0.3;
    for (double t = 0.0; t < 3.0; t += 0.5) {
        const double slower = 0.3 * 1600.0 / 400.0;
        assert_within(nt_rheology_creep(&of, t), 1.0 / 400.0 - (1.0 / 400.0 - 1.0 / 1600.0) * exp(-t / slower), 1e-16);
        assert_within(nt_rheology_relaxation(&of, t), 400.0 + 1200.0 * exp(-t / 0.3), 1e-12);
    }
}

/* Two arms of one relaxation time are one arm. */
static void equal_times_are_one_arm(void **unused)
{
    (void)unused;
    nt_rheology twice = series(100.0), once = series(100.0);
    twice.relaxation_times[1] = twice.relaxation_times[0];
    once.arm_count = 2;
    once.arm_moduli[0] += once.arm_moduli[1];
    once.arm_moduli[1] = once.arm_moduli[2];
    once.relaxation_times[1] = once.relaxation_times[2];
    assert_within(nt_rheology_creep(&twice, 0.4), nt_rheology_creep(&once, 0.4), 1e-17);
}

static void names_the_offending_arm(void **unused)
{
    (void)unused;
    nt_rheology of = series(100.0);
    nt_problem problem;
    of.relaxation_times[1] = 0.0;
    assert_int_equal(nt_rheology_check(&of, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "rheology.relaxation_times");
    of.relaxation_times[1] = (double)NAN;
    assert_int_equal(nt_rheology_check(&of, &problem), NT_E_NOT_FINITE);
    of.arm_count = 9;
    assert_int_equal(nt_rheology_check(&of, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "rheology.arm_count");
    assert_true(isnan(nt_rheology_relaxation(&of, -1.0)) && isnan(nt_rheology_creep(&of, (double)NAN)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(creep_is_the_inverse_of_relaxation),
        cmocka_unit_test(zener_in_closed_form),
        cmocka_unit_test(equal_times_are_one_arm),
        cmocka_unit_test(names_the_offending_arm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
