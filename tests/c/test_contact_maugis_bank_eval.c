/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "contact/maugis_bank.h"
#include "internal/maugis.h"
#include "larger.h"
#include "maugis_fixture.h"
#include "nanotouch/advanced/maugis.h"

enum { PANELS = 60, CELLS = 2000 };
static nt_maugis_panel panels[PANELS];
static nt_maugis_bank_cell cells[CELLS];

static nt_law_value at(const nt_maugis_bank *bank, double lambda, double d)
{
    nt_law_value value;
    assert_int_equal(nt_maugis_bank_eval(bank, lambda, d, NT_BRANCH_STABLE, &value), NT_OK);
    return value;
}

/* From the largest indentation, 100, to 110 the exact law takes over from a bank so coarse that it shows: still one
 * potential, F = dU/dd and k = dF/dd by differences of the fourth order. */
static void one_potential_where_the_exact_law_takes_over(void **state)
{
    (void)state;
    nt_maugis_bank_options options = nt_maugis_bank_defaults();
    options.panels_per_octave = options.cells_per_octave = 1;
    const nt_maugis_bank_memory memory = {panels, cells, PANELS, CELLS};
    nt_maugis_bank bank;
    assert_int_equal(nt_maugis_bank_init(&bank, &options, &memory), NT_OK);
    double worst = 0.0;
    for (double lambda = 0.05; lambda < 50.0; lambda *= 3.1)
        for (double d = 100.5; d < 109.6; d += 0.37) {
            const double h = 0.05;
            const nt_law_value a = at(&bank, lambda, d - 2.0 * h), b = at(&bank, lambda, d - h);
            const nt_law_value y = at(&bank, lambda, d + h), z = at(&bank, lambda, d + 2.0 * h);
            const nt_law_value here = at(&bank, lambda, d);
            const double F = (a.U - 8.0 * b.U + 8.0 * y.U - z.U) / (12.0 * h);
            const double k = (a.F - 8.0 * b.F + 8.0 * y.F - z.F) / (12.0 * h);
            worst = larger(worst, larger(fabs(F / here.F - 1.0), fabs(k / here.k - 1.0)));
        }
    assert_true(worst < 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(one_potential_where_the_exact_law_takes_over)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
