/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assertions.h"
#include "internal/geometry.h"
#include "nanotouch/advanced/geometry.h"

/* Eight terms: the ninth, 4.4e-6 (delta/R)^8 of a and 1/6 of that of F, is the first that is left out. */
static void series_is_the_sphere(void **state)
{
    (void)state;
    const double R = 3e-6, E = 2e3;
    const nt_shape sphere = {.kind = NT_SHAPE_SPHERE, .radius = R};
    for (double x = 1e-9; x < 3.0; x *= 1.07) {
        const double d = x * R, h = 1e-3 * d;
        const nt_law_value value = nt_sphere_series_eval(R, E, d), exact = nt_shape_eval(&sphere, E, d);
        const double left = x <= 1.0 ? 5e-6 * pow(x, 8.0) : 0.0;
        assert_within(value.a, exact.a, (left + 1e-14) * exact.a);
        assert_within(value.k, exact.k, (left + 1e-14) * exact.k);
        assert_within(value.F, exact.F, (left / 6.0 + 1e-14) * exact.F);
        assert_within(value.U, exact.U, (left / 6.0 + 1e-14) * exact.U);
        if (x >= 0.99 && x <= 1.01)
            continue; /* across the end of the series */
        const nt_law_value before = nt_sphere_series_eval(R, E, d - h), after = nt_sphere_series_eval(R, E, d + h);
        assert_within((after.U - before.U) / (2.0 * h), value.F, 1e-6 * value.F); /* (h/d)^2 5/8 */
        assert_within((after.F - before.F) / (2.0 * h), value.k, 1e-6 * value.k);
    }
    assert_true(nt_sphere_series_eval(R, E, -1e-9).F == 0.0 && isnan(nt_sphere_series_eval(R, E, NAN).F));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(series_is_the_sphere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
