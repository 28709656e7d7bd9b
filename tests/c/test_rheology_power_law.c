/* SPDX-License-Identifier: BSD-3-Clause
 * A power law as a sum of exponentials: its error, its derivatives, and what it refuses. */
#include "assertions.h"
#include "internal/rheology.h"
#include "nanotouch/rheology.h"
#include "rheology/kernel.h"

static double sum_at(const nt_spectrum *of, double time)
{
    double sum = of->equilibrium_modulus;
    for (int k = 0; k < of->count; k++)
        sum += of->moduli[k] * exp(-of->rates[k] * time);
    return sum;
}

static nt_rheology law(double exponent)
{
    nt_rheology made = nt_rheology_defaults();
    made.exponent = exponent;
    made.reference_time = 0.3;
    return made;
}

/* Four decades of time, 1e-6: 26 arms at most, none below 0; the integral below the shortest time is kept. */
static void keeps_what_is_demanded(void **unused)
{
    (void)unused;
    const nt_time_range range = {1e-3, 10.0};
    for (double beta = 0.05; beta < 0.86; beta += 0.1) {
        const nt_rheology of = law(beta);
        nt_spectrum spectrum;
        assert_int_equal(nt_rheology_discretize(&of, &range, 1e-6, &spectrum), NT_OK);
        assert_true(spectrum.count <= 26 && spectrum.error <= 1e-6);
        double area = spectrum.equilibrium_modulus * 1e-3;
        for (int k = 0; k < spectrum.count; k++) {
            assert_true(spectrum.moduli[k] >= 0.0);
            area -= spectrum.moduli[k] / spectrum.rates[k] * expm1(-spectrum.rates[k] * 1e-3);
        }
        const double whole = nt_rheology_relaxation_integral(&of, 1e-3);
        assert_within(area, whole, 2e-6 * whole);
        for (double t = 1.1e-3; t < 10.0; t *= 1.7)
            assert_within(sum_at(&spectrum, t) / nt_rheology_relaxation(&of, t), 1.0, 1.3e-6);
    }
}

static void elastic_is_one_modulus(void **unused)
{
    (void)unused;
    const nt_rheology of = law(0.0);
    nt_spectrum spectrum;
    assert_int_equal(nt_rheology_discretize(&of, &(nt_time_range){1e-3, 1.0}, 1e-6, &spectrum), NT_OK);
    assert_within(spectrum.equilibrium_modulus, of.modulus, 1e-12 * of.modulus);
    assert_within(sum_at(&spectrum, 0.0), of.modulus, 1e-12 * of.modulus);
}

/* By the exponent, against dE/d(beta) = -E ln(t/t_0), at exponent 0, too; the rates stay where they are. */
static void derivatives_are_those_of_the_law(void **unused)
{
    (void)unused;
    for (int i = 0; i < 3; i++) {
        const nt_rheology of = law(0.3 * i);
        nt_spectrum spectrum;
        nt_spectrum_slope slope = {0};
        assert_int_equal(nt_rheology_discretize(&of, &(nt_time_range){1e-3, 10.0}, 1e-7, &spectrum), NT_OK);
        assert_int_equal(nt_rheology_parameter_count(&of), 2);
        nt_spectrum_derive(&of, &spectrum, 1, &slope);
        assert_int_equal(slope.arm, -1);
        for (double t = 2e-3; t < 10.0; t *= 3.0) {
            double sum = slope.equilibrium_modulus;
            for (int k = 0; k < spectrum.count; k++)
                sum += slope.moduli[k] * exp(-spectrum.rates[k] * t);
            const double E = nt_rheology_relaxation(&of, t);
            assert_within(sum, -E * log(t / 0.3), 5e-6 * E); /* the sum's error, times ln of rate and time */
        }
    }
}

static void refuses_what_it_cannot_keep(void **unused)
{
    (void)unused;
    const nt_rheology of = law(0.3);
    nt_spectrum spectrum;
    assert_int_equal(nt_rheology_discretize(&of, &(nt_time_range){1e-9, 1e4}, 1e-8, &spectrum), NT_E_CAPACITY);
    assert_true(spectrum.error > 1e-8 && spectrum.error < 0.01); /* what so many arms reach */
    assert_int_equal(nt_rheology_discretize(&of, &(nt_time_range){1.0, 0.5}, 1e-4, &spectrum), NT_E_RANGE);
    assert_int_equal(nt_rheology_discretize(&of, &(nt_time_range){0.0, 0.5}, 1e-4, &spectrum), NT_E_RANGE);
    assert_int_equal(nt_rheology_discretize(&of, &(nt_time_range){0.1, 0.5}, 1e-9, &spectrum), NT_E_RANGE);
    assert_int_equal(nt_rheology_discretize(&of, &(nt_time_range){0.1, 0.5}, (double)NAN, &spectrum), NT_E_NOT_FINITE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keeps_what_is_demanded),
        cmocka_unit_test(elastic_is_one_modulus),
        cmocka_unit_test(derivatives_are_those_of_the_law),
        cmocka_unit_test(refuses_what_it_cannot_keep),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
