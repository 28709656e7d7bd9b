/* SPDX-License-Identifier: BSD-3-Clause
 * curves/ruptures.c: upward jumps are rows of the table, what falls at once out of contact hides none of them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "curves/ruptures.h"
#include "nanotouch/advanced/random.h"

enum { POINTS = 1200 };

static const double noise = 8e-12, length = 3e-6, load = 100e-12; /* N, m, N */
static double z_[POINTS], force_[POINTS], free_[POINTS], work_[6 * POINTS];

/* In contact up to 0.1 of the length and `more` points, then from `force` [N] down at once to -held [N], which tears at
 * 0.5. */
static nt_curve_reading made(double force, double held, int more, nt_curve_outside *out)
{
    const double end = 0.1 + (double)more / POINTS;
    nt_random random = nt_random_seed(3);
    for (int i = 0; i < POINTS; i++) {
        const double u = (double)i / (POINTS - 1), contact = force + (load - force) * (end - u) / end;
        z_[i] = u * length;
        free_[i] = noise * nt_random_normal(&random);
        force_[i] = (u < end ? contact : u < 0.5 ? -held : 0.0) + noise * nt_random_normal(&random);
    }
    nt_curve_reading reading = {.approach = {.z = z_, .force = free_, .count = POINTS, .visible = 5.0 * noise},
                                .retract = {.noise = noise}};
    reading.approach.baseline.z_mean = 0.5 * length;
    reading.approach.repulsive = POINTS / 10;
    *out = nt_curve_outside_contact(&(nt_curve_segment){z_, force_, POINTS}, work_, &reading);
    return reading;
}

static void a_plateau_tears(void **state)
{
    (void)state;
    nt_curve_outside out;
    const nt_curve_reading reading = made(0.0, 300e-12, 0, &out);
    assert_int_equal(reading.ruptures, 1);
    assert_true(fabs(reading.rupture[0].z - 0.5 * length) < 0.002 * length);
    assert_true(fabs(reading.rupture[0].force - 300e-12) < noise);
    assert_true(fabs(out.z[out.free] - 0.5 * length) < 0.01 * length);
    const nt_curve_measured line = nt_curve_line_at(&out, out.free + 20, out.count, 0.8 * length);
    assert_true(fabs(line.value) < 5.0 * line.sigma && line.sigma < noise);
}

/* 250 pN down within one point, from a slope below the baseline: the same step upwards was taken for a decoy too. */
static void a_fall_out_of_contact_hides_nothing(void **state)
{
    (void)state;
    nt_curve_outside out;
    for (int more = 0; more < 16; more++) { /* wherever it lies between the blocks that are looked at */
        const nt_curve_reading reading = made(-60e-12, 310e-12, more, &out);
        assert_int_equal(reading.ruptures, 1);
        assert_true(fabs(reading.rupture[0].force - 310e-12) < noise);
    }
}

static void nothing_tears_where_nothing_holds(void **state)
{
    (void)state;
    nt_curve_outside out;
    assert_int_equal(made(0.0, 0.0, 0, &out).ruptures, 0);
    assert_int_equal(out.free, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plateau_tears),
        cmocka_unit_test(a_fall_out_of_contact_hides_nothing),
        cmocka_unit_test(nothing_tears_where_nothing_holds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
