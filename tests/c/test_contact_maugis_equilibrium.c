/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale at a load, a radius, a parameter: each must be the same state that its indentation gives; partial
 * derivatives against differences. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "contact/contact_equilibrium.h"
#include "internal/contact.h"
#include "internal/contact_equilibrium.h"
#include "maugis_fixture.h"
#include "nanotouch/advanced/contact_equilibrium.h"

static nt_maugis prepared(double lambda)
{
    const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.0};
    nt_maugis maugis;
    assert_int_equal(nt_maugis_init_lambda(&maugis, &contact, lambda), NT_OK);
    return maugis;
}

/* Off the displacement fold: two solvers, each to rounding, times what a rounding of d does. */
static void assert_same_state(const nt_maugis *maugis, const nt_contact_state *state, nt_branch branch)
{
    const nt_law_value value = eval(maugis, state->indentation, branch);
    const double rounding = 1e-14 * (fabs(state->value.F) + 2.0 + fabs(value.k * state->indentation));
    assert_within(state->value.F, value.F, rounding);
    assert_within(state->value.U, value.U, rounding * (1.0 + fabs(state->indentation)) + 1e-14 * fabs(value.U));
    assert_within(state->value.a, value.a, 1e-9 * (1.0 + value.a));
    assert_within(state->value.k, value.k, 1e-7 * (1.0 + fabs(value.k)));
}

static void at_a_load(void **state)
{
    (void)state;
    for (double lambda = 1e-3; lambda < 1e4; lambda *= 2.7) {
        const nt_maugis maugis = prepared(lambda);
        nt_contact_state at;
        for (double step = 1e-3; step < 1e4; step *= 3.0) {
            const double P = maugis.folds.pull_off_load + step;
            double d;
            assert_int_equal(nt_maugis_at_load(&maugis, P, NT_BRANCH_STABLE, &at), NT_OK);
            assert_int_equal(nt_maugis_indentation(&maugis, P, NT_BRANCH_STABLE, &d, NULL), NT_OK);
            assert_true(at.indentation == d);
            assert_within(at.value.F, P, 1e-14 * (2.0 + fabs(P)));
            assert_same_state(&maugis, &at, NT_BRANCH_STABLE);
        }
        for (double part = 0.01; part < 1.0; part += 0.07) {
            const double P = maugis.folds.pull_off_load * part;
            assert_int_equal(nt_maugis_at_load(&maugis, P, NT_BRANCH_UNSTABLE, &at), NT_OK);
            assert_within(at.value.F, P, 1e-14);
            const int held = P < maugis.folds.grip_load; /* below the load fold, and grips still hold it */
            assert_same_state(&maugis, &at, held ? NT_BRANCH_STABLE : NT_BRANCH_UNSTABLE);
        }
        assert_int_equal(nt_maugis_at_load(&maugis, maugis.folds.pull_off_load * 1.001, NT_BRANCH_STABLE, &at),
                         NT_E_NO_SOLUTION);
    }
}

static void at_a_radius(void **state)
{
    (void)state;
    for (double lambda = 1e-9; lambda < 1e10; lambda *= 9.1) {
        const nt_maugis maugis = prepared(lambda);
        nt_contact_state at;
        for (double a = 1e-6; a < 1e6; a *= 3.3) {
            assert_int_equal(nt_maugis_at_radius(&maugis, a, &at), NT_OK);
            assert_within(at.value.a, a, 2e-15 * a);
        }
        assert_int_equal(nt_maugis_at_radius(&maugis, 0.0, &at), NT_OK);
        assert_true(at.value.a == 0.0);
        assert_within(at.value.F, maugis.folds.touch_load, 1e-15 * fabs(at.value.F));
        assert_int_equal(nt_maugis_at_radius(&maugis, maugis.folds.zero_load_radius, &at), NT_OK);
        assert_within(at.value.F, 0.0, 2e-14);
        assert_int_equal(nt_maugis_at_radius(&maugis, -1.0, &at), NT_E_RANGE);
        assert_int_equal(nt_maugis_at_radius(&maugis, NAN, &at), NT_E_NOT_FINITE);
    }
}

static void at_a_parameter(void **state)
{
    (void)state;
    const nt_maugis maugis = prepared(2.0);
    for (double y = 0.0; y < 50.0; y += 0.37) {
        nt_maugis_point point;
        nt_contact_state at;
        assert_int_equal(nt_maugis_at(2.0, y, &point), NT_OK);
        assert_int_equal(nt_maugis_at_parameter(&maugis, y, &at), NT_OK);
        assert_true(at.indentation == point.d && at.value.F == point.P && at.value.U == point.U &&
                    at.value.a == point.a);
    }
    nt_contact_state at;
    assert_int_equal(nt_maugis_at_parameter(&maugis, -1.0, &at), NT_E_RANGE);
    assert_int_equal(nt_maugis_at_parameter(&maugis, INFINITY, &at), NT_E_NOT_FINITE);
}

static void no_work_of_adhesion_is_hertz(void **state)
{
    (void)state;
    nt_contact contact = nt_contact_defaults();
    contact.work_of_adhesion = 0.0;
    nt_maugis maugis;
    nt_contact_state at;
    assert_int_equal(nt_maugis_init(&maugis, &contact), NT_OK);
    assert_int_equal(nt_maugis_at_load(&maugis, 1e-9, NT_BRANCH_STABLE, &at), NT_OK);
    assert_true(at.indentation == nt_hertz_indentation(&contact, 1e-9));
    assert_within(at.value.F, 1e-9, 1e-23);
    assert_int_equal(nt_maugis_at_radius(&maugis, 1e-9, &at), NT_OK);
    assert_within(at.value.a, 1e-9, 1e-24);
    assert_int_equal(nt_maugis_at_parameter(&maugis, 1.0, &at), NT_E_RANGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(at_a_load),
        cmocka_unit_test(at_a_radius),
        cmocka_unit_test(at_a_parameter),
        cmocka_unit_test(no_work_of_adhesion_is_hertz),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
