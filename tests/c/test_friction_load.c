/* SPDX-License-Identifier: BSD-3-Clause
 * Beside the sum of the pressures over rings of the contact (Maugis 1992; Johnson, Kendall, Roberts 1971). */
#include "assertions.h"
#include "internal/contact.h"
#include "nanotouch/friction.h"

static const nt_contact soft = {20e-9, 1e9, 0.05, 50e6};

/* The positive part of p(r), midpoint rule over s = sqrt(1 - r^2/a^2): 2 pi a^2 times the sum of s p ds. q = 0: JKR. */
static double ring_sum(double a, double hertz, double pull, double q)
{
    enum { RINGS = 200000 };
    double sum = 0.0;
    for (int i = 0; i < RINGS; ++i) {
        const double s = (i + 0.5) / RINGS;
        const double rim =
            q > 0.0 ? 2.0 * soft.cohesive_stress / NT_PI * atan(q / s) : pull / (2.0 * NT_PI * a * a) / s;
        const double pressure = 1.5 * hertz / (NT_PI * a * a) * s - rim;
        sum += pressure > 0.0 ? s * pressure : 0.0;
    }
    return 2.0 * NT_PI * a * a * sum / RINGS;
}

static double hertz_load(double a)
{
    return 4.0 / 3.0 * soft.effective_modulus * a * a * a / soft.radius;
}

/* The midpoint rule is exact to (1/RINGS)^2 but at the kink, where it loses as little: 1e-9. */
static void jkr_is_the_sum_of_its_rings(void **unused)
{
    (void)unused;
    for (double delta = nt_jkr_pull_off_indentation(&soft) * 0.999; delta < 3e-9; delta += 0.1e-9) {
        nt_law_value law;
        assert_int_equal(nt_jkr_eval(&soft, delta, NT_BRANCH_STABLE, &law), NT_OK);
        const double hertz = hertz_load(law.a), load = nt_compressive_load(NT_JKR, &soft, law);
        assert_within(load, ring_sum(law.a, hertz, hertz - law.F, 0.0), 1e-9 * hertz);
        assert_true(load >= 0.0 && load >= law.F);
    }
}

/* y of the branch is 1/q; nt_maugis_at gives it beside a and P, so that q is not the one found here. */
static void maugis_is_the_sum_of_its_rings(void **unused)
{
    (void)unused;
    nt_maugis maugis;
    assert_int_equal(nt_maugis_init(&maugis, &soft), NT_OK);
    for (double y = 0.05; y < 50.0; y *= 1.7) {
        nt_maugis_point point;
        assert_int_equal(nt_maugis_at(maugis.lambda, y, &point), NT_OK);
        const nt_law_value law = {.F = point.P * maugis.load_scale, .a = point.a * maugis.radius_scale};
        const double hertz = hertz_load(law.a);
        const double load = nt_compressive_load(NT_MAUGIS, &soft, law);
        assert_within(load, ring_sum(law.a, hertz, hertz - law.F, 1.0 / y), 1e-8 * hertz);
    }
}

/* Stiff and barely adhesive it is DMT's, Hertz' load of the same radius; soft and strongly adhesive JKR's. */
static void maugis_has_both_limits(void **unused)
{
    (void)unused;
    const nt_law_value law = {.F = 2e-9, .a = 3e-9};
    nt_contact contact = soft;
    contact.cohesive_stress = 1e3;
    assert_within(nt_compressive_load(NT_MAUGIS, &contact, law), hertz_load(3e-9), 1e-3 * hertz_load(3e-9));
    assert_within(nt_compressive_load(NT_DMT, &contact, law), hertz_load(3e-9), 1e-15 * hertz_load(3e-9));
    contact.cohesive_stress = 1e14;
    const double jkr = nt_compressive_load(NT_JKR, &contact, (nt_law_value){.F = -1e-9, .a = 3e-9});
    const nt_law_value pulled = {.F = -1e-9, .a = 3e-9};
    assert_within(nt_compressive_load(NT_MAUGIS, &contact, pulled), jkr, 1e-5 * jkr);
}

static void nothing_presses_without_a_contact(void **unused)
{
    (void)unused;
    const nt_law_value apart = {.F = -1e-9};
    assert_true(nt_compressive_load(NT_MAUGIS, &soft, apart) == 0.0);
    assert_true(isnan(nt_compressive_load(NT_JKR, &soft, (nt_law_value){.F = NAN, .a = 1e-9})));
    /* a neck that is pulled all over */
    assert_true(nt_compressive_load(NT_JKR, &soft, (nt_law_value){.F = -20e-9, .a = 1e-10}) == 0.0);
}

/* Where the middle of a neck just still presses, rounding must not make the load negative: no step takes that. The
 * zone of a radius below 1.57 nm can balance Hertz' p0 there: (2 sigma0/pi) arctan(q) = p0. */
static void rounding_makes_no_load_negative(void **unused)
{
    (void)unused;
    for (double share = 1e-17; share < 1e-3; share *= 1.1)
        for (double a = 1e-10; a < 1.5e-9; a *= 1.07) {
            const double hertz = hertz_load(a);
            const nt_law_value jkr = {.F = hertz * (1.0 - 3.0 * (1.0 - share)), .a = a};
            assert_true(nt_compressive_load(NT_JKR, &soft, jkr) >= 0.0);
            const double q = (1.0 - share) * tan(0.75 * hertz / (a * a * soft.cohesive_stress));
            const double pull = 2.0 * soft.cohesive_stress * a * a * ((1.0 + q * q) * atan(q) + q);
            assert_true(nt_compressive_load(NT_MAUGIS, &soft, (nt_law_value){.F = hertz - pull, .a = a}) >= 0.0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jkr_is_the_sum_of_its_rings),     cmocka_unit_test(maugis_is_the_sum_of_its_rings),
        cmocka_unit_test(maugis_has_both_limits),          cmocka_unit_test(nothing_presses_without_a_contact),
        cmocka_unit_test(rounding_makes_no_load_negative),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
