/* SPDX-License-Identifier: BSD-3-Clause
 * What curves show without a model: the work of adhesion of a curve whose answer is a closed form. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assertions.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/fit.h"

enum { POINTS = 600 };

static nt_fit_reading reading_of(const nt_curve *curve)
{
    nt_fit_recipe recipe = nt_fit_recipe_defaults(NT_FIT_HERTZ);
    nt_fit_outcome outcome;
    const nt_fit_curves all = {curve, 1, 1};
    recipe.approach = 0;
    assert_int_equal(nt_fit_batch(&recipe, &all, &outcome), NT_OK);
    return outcome.reading;
}

/* A stiff contact, F = k (z0 - z), that tears at -12 nN; steps of z that grow. The area of a triangle, less its corner
 * before the first point below the baseline, and half a step beyond the last. */
static void the_work_of_adhesion_is_an_area(void **state)
{
    (void)state;
    static double z[POINTS], force[POINTS];
    const double k = 0.8, z0 = 100e-9, deepest = 12e-9;
    for (int shift = 0; shift < 5; shift++) {
        nt_random random = nt_random_seed(7);
        double expected = 0.0;
        int first = -1, last = -1;
        for (int i = 0; i < POINTS; i++) {
            z[i] = 70e-9 + 0.1e-9 * shift + 0.2e-9 * i + 2.5e-12 * i * i;
            const double line = k * (z0 - z[i]);
            force[i] = (line > -deepest ? line : 0.0) + 1e-14 * nt_random_normal(&random);
            first = first < 0 && line < 0.0 ? i : first;
            last = line > -deepest ? i : last;
        }
        const double from = z[first] - z0, to = z[last] - z0, step = z[last + 1] - z[last];
        expected = 0.5 * k * (to * to - from * from) + 0.5 * k * to * step;
        const nt_curve curve = {.retract = {z, force, POINTS}, .spring_constant = k};
        const nt_fit_reading found = reading_of(&curve);
        assert_within(found.pull_off_force.value, k * to, 1e-12);
        assert_within(found.adhesion_work.value, expected, 1e-4 * expected);
        assert_true(found.adhesion_work.sigma > 0.0 && found.adhesion_work.sigma < 1e-3 * expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_work_of_adhesion_is_an_area),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
