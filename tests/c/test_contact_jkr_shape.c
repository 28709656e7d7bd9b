/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assertions.h"
#include "internal/contact.h"
#include "internal/geometry.h"
#include "larger.h"
#include "nanotouch/advanced/geometry.h"

static const nt_jkr_shape cone = {{NT_SHAPE_CONE, 0, 0.0, 0.6, 0.0}, 1e6, 0.05};
static const nt_jkr_shape punch = {{NT_SHAPE_PUNCH, 0, 50e-9, 0.0, 0.0}, 1e6, 0.05};

static nt_law_value at(const nt_jkr_shape *contact, double indentation, nt_branch branch)
{
    nt_law_value value;
    assert_int_equal(nt_jkr_shape_eval(contact, indentation, branch, &value), NT_OK);
    return value;
}

/* At the edge the energy release rate is w: K_I^2/(2 E*) = (F_0(a) - F)^2/(8 pi E* a^3), F_0 the load of the law
 * without adhesion at the same a (Maugis and Barquins 1978). Independent of the form that is implemented. */
static void releases_w_at_the_edge(void **state)
{
    (void)state;
    const double fold = nt_jkr_shape_pull_off_indentation(&cone), E = cone.effective_modulus;
    for (int unstable = 0; unstable < 2; unstable++)
        for (double d = 0.999 * fold; d < (unstable ? 0.0 : 1e3 * -fold); d += 0.07 * (-fold + fabs(d))) {
            const nt_law_value value = at(&cone, d, unstable ? NT_BRANCH_UNSTABLE : NT_BRANCH_STABLE);
            const double without = 0.5 * NT_PI * E * value.a * value.a / tan(0.6), gap = without - value.F;
            assert_within(gap * gap / (8.0 * NT_PI * E * pow(value.a, 3.0)), 0.05, 1e-12);
            const double lowered = 0.5 * NT_PI * value.a / tan(0.6) - sqrt(2.0 * NT_PI * 0.05 * value.a / E);
            assert_within(lowered, d, 1e-13 * (fabs(d) - fold));
        }
}

/* Published: F = -54 w^2 tan^3(psi)/(pi E*) (Maugis and Barquins 1983), sqrt(8 pi E* w a^3) (Kendall 1971). The cone's
 * is also the lowest force that a scan of the stable branch meets. */
static void pull_off_forces_are_the_published_ones(void **state)
{
    (void)state;
    const double expected = 54.0 * 0.05 * 0.05 * pow(tan(0.6), 3.0) / (NT_PI * 1e6);
    assert_within(nt_jkr_shape_pull_off_force(&cone), expected, 1e-14 * expected);
    double lowest = 0.0;
    const double fold = nt_jkr_shape_pull_off_indentation(&cone);
    assert_within(fold, -0.05 * tan(0.6) / 1e6, 1e-14 * -fold);
    for (double d = fold; d < -20.0 * fold; d -= 1e-3 * fold)
        lowest = smaller(lowest, at(&cone, d, NT_BRANCH_STABLE).F);
    assert_within(lowest, -expected, 1e-6 * expected);
    const double kendall = sqrt(8.0 * NT_PI * 1e6 * 0.05 * pow(50e-9, 3.0));
    assert_within(nt_jkr_shape_pull_off_force(&punch), kendall, 1e-14 * kendall);
    const double last = nt_jkr_shape_pull_off_indentation(&punch);
    assert_within(at(&punch, last, NT_BRANCH_STABLE).F, -kendall, 1e-14 * kendall);
    assert_true(at(&punch, last * (1.0 + 1e-12), NT_BRANCH_STABLE).F == 0.0);
}

/* Central differences on both branches of the cone, away from the fold, and on the punch: h^2 and rounding/h. */
static void force_and_stiffness_are_derivatives(void **state)
{
    (void)state;
    const double fold = nt_jkr_shape_pull_off_indentation(&cone), h = -1e-5 * fold;
    const double scale = nt_jkr_shape_pull_off_force(&cone);
    for (int unstable = 0; unstable < 2; unstable++)
        for (double d = 0.99 * fold; d < (unstable ? 0.01 * fold : -30.0 * fold); d -= 0.03 * fold) {
            const nt_branch branch = unstable ? NT_BRANCH_UNSTABLE : NT_BRANCH_STABLE;
            const nt_law_value value = at(&cone, d, branch), up = at(&cone, d + h, branch),
                               down = at(&cone, d - h, branch);
            assert_within((up.U - down.U) / (2.0 * h), value.F, 1e-7 * (scale + fabs(value.F)));
            assert_within((up.F - down.F) / (2.0 * h), value.k, 1e-6 * fabs(value.k) + 1e-6 * scale / -fold);
        }
    const nt_law_value up = at(&punch, 1.1e-9, NT_BRANCH_STABLE), down = at(&punch, 0.9e-9, NT_BRANCH_STABLE);
    const nt_law_value value = at(&punch, 1e-9, NT_BRANCH_STABLE);
    assert_within((up.U - down.U) / 0.2e-9, value.F, 1e-12 * value.F);
    assert_within(value.k, value.F / 1e-9, 1e-14 * value.k);
}

/* What the surfaces gain by touching: at delta = 0 the punch holds pi a^2 w, the cone what the jump to r = 2 gives. */
static void approach_jumps_into_contact(void **state)
{
    (void)state;
    assert_true(at(&cone, -1e-12, NT_BRANCH_APPROACH).a == 0.0 && at(&punch, -1e-15, NT_BRANCH_APPROACH).F == 0.0);
    assert_within(at(&punch, 0.0, NT_BRANCH_APPROACH).U, -NT_PI * 25e-16 * 0.05, 1e-30);
    const nt_law_value landed = at(&cone, 0.0, NT_BRANCH_APPROACH);
    const double a = 8.0 * 0.05 * pow(tan(0.6), 2.0) / (NT_PI * 1e6); /* a of delta_0(a) = s */
    assert_within(landed.a, a, 1e-14 * a);
    assert_true(landed.U < 0.0 && landed.F < 0.0 && landed.F > -nt_jkr_shape_pull_off_force(&cone));
    nt_law_value value;
    assert_int_equal(nt_jkr_shape_eval(&punch, -1e-12, NT_BRANCH_UNSTABLE, &value), NT_E_NO_SOLUTION);
    assert_int_equal(nt_jkr_shape_eval(&cone, 1e-12, NT_BRANCH_UNSTABLE, &value), NT_E_NO_SOLUTION);
}

static void inverse_returns(void **state)
{
    (void)state;
    const double P = nt_jkr_shape_pull_off_force(&cone), fold = nt_jkr_shape_pull_off_indentation(&cone);
    double d;
    for (double F = -0.999 * P; F < 1e6 * P; F += 0.1 * (P + fabs(F))) {
        assert_int_equal(nt_jkr_shape_indentation(&cone, F, NT_BRANCH_STABLE, &d), NT_OK);
        assert_within(at(&cone, d, NT_BRANCH_STABLE).F, F, 1e-13 * (P + fabs(F)));
        if (F < 0.0) { /* below the load fold r = 3: down to grips at r = 1 stable, then unstable */
            assert_int_equal(nt_jkr_shape_indentation(&cone, F, NT_BRANCH_UNSTABLE, &d), NT_OK);
            const nt_branch branch = F < -P / 9.0 ? NT_BRANCH_STABLE : NT_BRANCH_UNSTABLE;
            if (fabs(F + P / 9.0) > 0.01 * P)
                assert_within(at(&cone, d, branch).F, F, 1e-12 * P);
        }
    }
    assert_int_equal(nt_jkr_shape_indentation(&cone, -P, NT_BRANCH_STABLE, &d), NT_OK);
    assert_within(d, -3.0 * fold, 1e-14 * d);
    assert_int_equal(nt_jkr_shape_indentation(&cone, -1.001 * P, NT_BRANCH_STABLE, &d), NT_E_NO_SOLUTION);
    for (double F = -nt_jkr_shape_pull_off_force(&punch); F < 1e-6; F += 1e-8) {
        assert_int_equal(nt_jkr_shape_indentation(&punch, F, NT_BRANCH_STABLE, &d), NT_OK);
        assert_within(at(&punch, d, NT_BRANCH_STABLE).F, F, 1e-14 * fabs(F));
    }
}

/* Without adhesion, or far above it, the laws are Sneddon's; to 2 sqrt(delta_f/delta) in a (a = a_f r^2, r = 1 + sqrt).
 */
static void without_adhesion_it_is_sneddon(void **state)
{
    (void)state;
    for (double w = 1e-300; w < 1e-25; w *= 1e5) {
        nt_jkr_shape contact = cone;
        contact.work_of_adhesion = w < 1e-299 ? 0.0 : w;
        const nt_law_value value = at(&contact, 1e-9, NT_BRANCH_STABLE), sneddon = nt_cone_eval(1e6, 0.6, 1e-9);
        assert_within(value.F, sneddon.F, 1e-9 * sneddon.F);
        assert_within(value.U, sneddon.U, 1e-9 * sneddon.U);
    }
    nt_jkr_shape contact = punch;
    contact.work_of_adhesion = 0.0;
    assert_true(at(&contact, 1e-9, NT_BRANCH_STABLE).F == nt_punch_eval(1e6, 50e-9, 1e-9).F);
    assert_true(at(&contact, 0.0, NT_BRANCH_STABLE).k == 0.0);
}

static void extremes_stay_finite(void **state)
{
    (void)state;
    for (double E = 1e2; E <= 1e13; E *= 1e3)
        for (double w = 1e-9; w <= 10.0; w *= 1e2)
            for (double psi = 0.01; psi < 1.56; psi += 0.31) {
                const nt_jkr_shape contact = {{NT_SHAPE_CONE, 0, 0.0, psi, 0.0}, E, w};
                assert_int_equal(nt_jkr_shape_check(&contact, NULL), NT_OK);
                const double fold = nt_jkr_shape_pull_off_indentation(&contact);
                for (double d = 1e-15; d < 1.0; d *= 1e3) {
                    const nt_law_value up = at(&contact, d, NT_BRANCH_STABLE),
                                       down = at(&contact, -d, NT_BRANCH_STABLE);
                    assert_true(isfinite(up.U + up.F + up.k + up.a) && isfinite(down.U + down.F + down.k + down.a));
                    assert_true((down.a == 0.0) == (-d < fold));
                }
                assert_true(isfinite(at(&contact, fold, NT_BRANCH_STABLE).k) &&
                            at(&contact, fold, NT_BRANCH_STABLE).k < 0.0);
            }
}

static void paraboloid_is_jkr_and_others_are_refused(void **state)
{
    (void)state;
    const nt_contact contact = {20e-9, 1e9, 0.05, 0.0};
    const nt_jkr_shape paraboloid = {{NT_SHAPE_PARABOLOID, 0, 20e-9, 0.0, 0.0}, 1e9, 0.05};
    nt_law_value expected, value;
    assert_int_equal(nt_jkr_eval(&contact, 1e-9, NT_BRANCH_STABLE, &expected), NT_OK);
    assert_true(at(&paraboloid, 1e-9, NT_BRANCH_STABLE).F == expected.F);
    assert_true(nt_jkr_shape_pull_off_force(&paraboloid) == nt_jkr_pull_off_force(&contact));
    double d;
    assert_int_equal(nt_jkr_shape_indentation(&paraboloid, 0.0, NT_BRANCH_STABLE, &d), NT_OK);
    nt_jkr_shape other = {{NT_SHAPE_SPHERE, 0, 20e-9, 0.6, 0.0}, 1e9, 0.05};
    assert_int_equal(nt_jkr_shape_eval(&other, 1e-9, NT_BRANCH_STABLE, &value), NT_E_UNSUPPORTED);
    assert_int_equal(nt_jkr_shape_indentation(&other, 1e-9, NT_BRANCH_STABLE, &d), NT_E_UNSUPPORTED);
    nt_problem problem;
    assert_int_equal(nt_jkr_shape_check(&other, &problem), NT_E_UNSUPPORTED);
    other.shape = (nt_shape){NT_SHAPE_CONE, 4, 0.0, 0.6, 0.0};
    assert_int_equal(nt_jkr_shape_eval(&other, 1e-9, NT_BRANCH_STABLE, &value), NT_E_UNSUPPORTED);
    assert_true(isnan(nt_jkr_shape_pull_off_force(&other)) && isnan(nt_jkr_shape_pull_off_indentation(&other)));
    assert_int_equal(nt_jkr_shape_eval(&cone, NAN, NT_BRANCH_STABLE, &value), NT_E_NOT_FINITE);
    assert_int_equal(nt_jkr_shape_indentation(&cone, INFINITY, NT_BRANCH_STABLE, &d), NT_E_NOT_FINITE);
    assert_int_equal(nt_jkr_shape_eval(&cone, 0.0, (nt_branch)9, &value), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(releases_w_at_the_edge),
        cmocka_unit_test(pull_off_forces_are_the_published_ones),
        cmocka_unit_test(force_and_stiffness_are_derivatives),
        cmocka_unit_test(approach_jumps_into_contact),
        cmocka_unit_test(inverse_returns),
        cmocka_unit_test(without_adhesion_it_is_sneddon),
        cmocka_unit_test(extremes_stay_finite),
        cmocka_unit_test(paraboloid_is_jkr_and_others_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
