/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "maugis_fixture.h"
#include "nanotouch/advanced/maugis_bank.h"

static nt_bank_value eval_radius(const nt_maugis_bank *bank, double lambda, double radius, double d)
{
    const nt_contact contact = {radius, 0.75, 1.0 / NT_PI, 0.5 * lambda}; /* units of 1 at R = 1 */
    nt_bank_value value;
    assert_int_equal(nt_maugis_bank_eval_radius(bank, &contact, d, NT_BRANCH_STABLE, &value), NT_OK);
    return value;
}

/* Without panels the exact solver answers; its slope over the radius by differences, h^2 and 1e-14/h; its fold. */
static void a_bank_of_zeros_is_exact(void **state)
{
    (void)state;
    const nt_maugis_bank none = {.panels = NULL};
    const double h = 1e-5;
    assert_true(nt_maugis_bank_error(&none, 0.01, 100.0).force == 0.0);
    for (double lambda = 0.02; lambda < 90.0; lambda *= 1.7) {
        const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.5 * lambda};
        const nt_maugis maugis = reduced(lambda);
        assert_within(nt_maugis_bank_grip_indentation(&none, &contact), maugis.folds.grip_indentation, 1e-14);
        for (double step = 0.1; step < 20.0; step *= 1.4) {
            const double d = maugis.folds.grip_indentation + step;
            const nt_bank_value value = eval_radius(&none, lambda, 1.0, d);
            const nt_law_value direct = eval(&maugis, d, NT_BRANCH_STABLE);
            const double change =
                eval_radius(&none, lambda, 1.0 + h, d).law.U - eval_radius(&none, lambda, 1.0 - h, d).law.U;
            assert_within(value.law.F, direct.F, 1e-12 * (fabs(direct.F) + 1.0));
            assert_within(value.law.U, direct.U, 1e-12 * (fabs(direct.U) + 1.0));
            assert_within(value.dU_dR, change / (2.0 * h), 1e-8 * (fabs(direct.U) + 1.0));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bank_of_zeros_is_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
