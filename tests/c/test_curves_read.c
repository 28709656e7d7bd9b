/* SPDX-License-Identifier: BSD-3-Clause
 * Curves with a known answer through the caller's own memory: what is read, what is refused, what is left untouched. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "assertions.h"
#include "curves/robust.h"
#include "internal/curves.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/curves.h"

enum { POINTS = 600, GUARD = 8 };

static const double stiffness = 0.8, contact = 100e-9, noise = 10e-12, pull_off = 5e-9, tilt = 2e-4;
static double z_[2][POINTS], force_[2][POINTS];
static const nt_curve_choice automatic = {NT_CURVE_AUTO, 0.0, 0.0};

/* A stiff contact with a snap-in of 1 nN: the tip follows the base. */
static nt_curve stiff_curve(void)
{
    nt_random random = nt_random_seed(3);
    for (int branch = 0; branch < 2; branch++)
        for (int i = 0; i < POINTS; i++) {
            const double t = (double)i / (POINTS - 1), z = 700e-9 * (branch ? t : 1.0 - t);
            const double line = stiffness * (contact - z), lowest = branch ? -pull_off : -1e-9;
            z_[branch][i] = z;
            force_[branch][i] = (line > lowest ? line : 0.0) + tilt * z + noise * nt_random_normal(&random);
        }
    return (nt_curve){{z_[0], force_[0], POINTS}, {z_[1], force_[1], POINTS}, stiffness, 0.0, 0.0};
}

static void a_stiff_contact_is_read(void **state)
{
    (void)state;
    const nt_curve curve = stiff_curve();
    const long size = nt_curve_work_size(2 * POINTS);
    double *work = malloc((size_t)(size + GUARD) * sizeof *work);
    assert_non_null(work);
    for (long i = size; i < size + GUARD; i++)
        work[i] = 4711.0;
    nt_curve_reading reading;
    assert_int_equal(nt_curve_read(&curve, &automatic, work, &reading, NULL), NT_OK);
    for (long i = size; i < size + GUARD; i++)
        assert_true(work[i] == 4711.0); /* nothing beyond what was asked for */
    assert_within(reading.contact_point.value, contact, 0.1e-9);
    assert_true(reading.contact_point.sigma > 0.0 && reading.contact_point.sigma < 0.5e-9);
    assert_within(reading.retract.dip.value, pull_off, 1.2e-9 * stiffness + 4.0 * noise); /* within one step of z */
    assert_within(reading.approach.baseline.slope, tilt, 2e-5);
    assert_within(reading.retract.contact_slope.value, stiffness - tilt, 4e-3);
    assert_true(reading.retract.torn >= 0 && reading.retract.dips);
    assert_true(reading.retract.z[reading.retract.torn] - contact <= pull_off / stiffness);
    assert_true(isnan(reading.contact_points[NT_CURVE_GRADIENT])); /* it snapped in */
    for (long i = 1; i < reading.approach.count; i++)
        assert_true(reading.approach.z[i] > reading.approach.z[i - 1]);
    free(work);
}

/* A tether of 1 nN that tears after 80 % of the free travel, over drag of 20 pN: two branches 40 pN apart. */
static nt_curve tethered_curve(double free_travel_part)
{
    nt_random random = nt_random_seed(5);
    const double drag = 20e-12, free = 700e-9 - contact;
    for (int branch = 0; branch < 2; branch++)
        for (int i = 0; i < POINTS; i++) {
            const double t = (double)i / (POINTS - 1), z = 700e-9 * (branch ? t : 1.0 - t), above = z - contact;
            const int held = branch && above > 0.0 && above < free_travel_part * free;
            const double spring = stiffness * above, pull = !held ? 0.0 : spring < 1e-9 ? spring : 1e-9;
            z_[branch][i] = z;
            force_[branch][i] = (above < 0.0 ? -0.05 * above : 0.0) - pull + (branch ? -drag : drag) + tilt * z +
                                noise * nt_random_normal(&random);
        }
    return (nt_curve){{z_[0], force_[0], POINTS}, {z_[1], force_[1], POINTS}, stiffness, 0.0, 60e-12};
}

static void tethers_are_found_to_their_end(void **state)
{
    (void)state;
    static double work[40 * POINTS];
    nt_curve_reading reading;
    nt_curve curve = tethered_curve(0.8);
    assert_int_equal(nt_curve_read(&curve, &automatic, work, &reading, NULL), NT_OK);
    assert_int_equal(reading.ruptures, 1);
    assert_within(reading.rupture[0].z, contact + 0.8 * 600e-9, 3e-9);
    assert_within(reading.rupture[0].force, 1e-9, 15e-12);
    assert_within(reading.rupture[0].step, 1e-9, 30e-12);
    assert_int_equal(reading.support, NT_CURVE_SHARED);
    assert_within(reading.offset, 40e-12, 4.0 * reading.offset_sigma);
    assert_within(reading.retract.dip.value, 1e-9, 15e-12);
    assert_true(reading.pull_off_least <= 1.01e-9 && reading.pull_off_most >= 1.03e-9); /* the offset is left open */
    curve = tethered_curve(2.0);
    assert_int_equal(nt_curve_read(&curve, &automatic, work, &reading, NULL), NT_OK);
    assert_int_equal(reading.support, NT_CURVE_BOUND);
    assert_true(reading.pull_off_least <= 1e-9 && reading.pull_off_most >= 1e-9);
    assert_within(reading.pull_off_most - reading.pull_off_least, 60e-12, 1e-15);
    curve.most_drag = 0.0; /* unknown: all of it may be drag */
    assert_int_equal(nt_curve_read(&curve, &automatic, work, &reading, NULL), NT_OK);
    assert_true(reading.pull_off_least < 0.1e-9 && reading.pull_off_most > 0.95e-9);
    assert_true(reading.retract.dip.sigma > 0.2e-9);
}

static void bad_curves_are_refused(void **state)
{
    (void)state;
    static double work[40 * POINTS];
    nt_curve_reading reading;
    nt_problem problem;
    nt_curve curve = stiff_curve();
    assert_true(nt_curve_work_size(2 * POINTS) <= 40 * POINTS);
    force_[0][5] = NAN;
    assert_int_equal(nt_curve_read(&curve, &automatic, work, &reading, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "force");
    force_[0][5] = 2.0;
    assert_int_equal(nt_curve_read(&curve, &automatic, work, &reading, &problem), NT_E_RANGE);
    curve.approach.count = NT_CURVE_FEWEST - 1; /* as if there were none */
    assert_int_equal(nt_curve_read(&curve, &automatic, work, &reading, &problem), NT_OK);
    assert_int_equal(reading.approach.count, 0);
    curve.retract.count = 3;
    assert_int_equal(nt_curve_read(&curve, &automatic, work, &reading, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "points of a branch");
    curve = stiff_curve();
    const nt_curve_choice narrow = {NT_CURVE_BETWEEN, 500e-9, 510e-9}, none = {(nt_curve_baseline_kind)17, 0.0, 0.0};
    assert_int_equal(nt_curve_read(&curve, &narrow, work, &reading, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "baseline (points between its ends)");
    assert_int_equal(nt_curve_read(&curve, &none, work, &reading, &problem), NT_E_ARGUMENT);
    for (int i = 0; i < POINTS; i++)
        z_[1][i] = 1e-7;
    assert_int_equal(nt_curve_read(&curve, &automatic, work, &reading, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "z (travel)");
}

static int by_value(const void *a, const void *b)
{
    const double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

static void medians_and_orders(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(1);
    for (int count = 1; count < 60; count++) {
        double values[60], sorted[60];
        nt_curve_point points[60], scratch[60];
        for (int i = 0; i < count; i++) {
            values[i] = sorted[i] = floor(8.0 * nt_random_normal(&random)); /* many are the same */
            points[i] = (nt_curve_point){values[i], i};
        }
        qsort(sorted, (size_t)count, sizeof *sorted, by_value);
        nt_curve_sort(points, count, scratch);
        for (int i = 0; i < count; i++)
            assert_true(points[i].z == sorted[i]);
        for (int i = 1; i < count; i++)
            assert_true(points[i].z > points[i - 1].z || points[i].force > points[i - 1].force); /* stable */
        const double middle = 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]);
        assert_true(nt_curve_median(values, count) == middle);
    }
}

/* Whatever was expected, and however wrong. */
static void medians_of_many(void **state)
{
    (void)state;
    enum { MANY = 700 };
    const double expected[] = {0.0, 0.67, 0.3, 5.0, 1e9};
    nt_random random = nt_random_seed(2);
    for (int count = 250; count <= MANY; count += 45)
        for (int i = 0; i < 5; i++) {
            double values[MANY], again[MANY], sorted[MANY];
            for (int k = 0; k < count; k++)
                values[k] = again[k] = sorted[k] =
                    i < 4 ? fabs(nt_random_normal(&random)) : floor(nt_random_normal(&random));
            qsort(sorted, (size_t)count, sizeof *sorted, by_value);
            const double middle = 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]);
            assert_true(nt_curve_median_near(values, count, expected[i], 0.25) == middle);
            assert_true(nt_curve_median(again, count) == middle);
        }
}

/* Ends, places and sums beside plain loops, for every length of the last block. */
static void passes_over_all(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(3);
    for (long count = 1; count < 100; count++) {
        double values[100], sum = 0.0, squares = 0.0;
        long lowest = 0, highest = 0, last = -1;
        for (long i = 0; i < count; i++)
            values[i] = floor(5.0 * nt_random_normal(&random));
        for (long i = 0; i < count; i++) {
            lowest = values[i] < values[lowest] ? i : lowest;
            highest = values[i] > values[highest] ? i : highest;
            last = values[i] > 7.0 ? i : last;
            sum += values[i];
            squares += values[i] * values[i];
        }
        assert_int_equal(nt_curve_place_of_lowest(values, count), lowest);
        assert_int_equal(nt_curve_place_of_highest(values, count), highest);
        assert_true(nt_curve_lowest(values, count) == values[lowest]);
        assert_true(nt_curve_highest(values, count) == values[highest]);
        assert_int_equal(nt_curve_last_above(values, count, 7.0), last);
        assert_true(nt_curve_sum(values, count) == sum); /* whole numbers: exact in any order */
        assert_true(nt_curve_square_sum(values, count) == squares);
        assert_true(nt_curve_all_within(values, count, 40.0));
        values[count / 2] = count % 2 ? (double)NAN : -41.0;
        assert_false(nt_curve_all_within(values, count, 40.0));
    }
}

static void linear_systems(void **state)
{
    (void)state;
    double a[9] = {4.0, 0.0, 0.0, 2.0, 5.0, 0.0, 1.0, 3.0, 6.0}, b[3] = {11.0, 21.0, 25.0}; /* lower half */
    assert_int_equal(nt_curve_solve(a, b, 3), 1);
    assert_within(b[0], 1.0, 1e-12);
    assert_within(b[1], 2.0, 1e-12);
    assert_within(b[2], 3.0, 1e-12);
    double singular[4] = {1.0, 0.0, 2.0, 4.0}, right[2] = {1.0, 2.0};
    assert_int_equal(nt_curve_solve(singular, right, 2), 0);
}

enum { PLAIN = 120 };
static double plain_z[PLAIN], plain_force[PLAIN], plain_work[1 << 14];

static nt_curve_branch read_plain(void)
{
    nt_curve_branch found;
    const nt_curve_segment segment = {plain_z, plain_force, PLAIN};
    const nt_curve_choice line = {.kind = NT_CURVE_LINE};
    assert_true((size_t)nt_curve_work_size(PLAIN) <= sizeof plain_work / sizeof *plain_work);
    assert_int_equal(nt_curve_read_branch(&segment, &line, plain_work, &found, NULL), NT_OK);
    return found;
}

/* Forces too small to divide by: found by random input, and read without an end once. */
static void a_curve_of_denormal_forces_is_read(void **state)
{
    (void)state;
    for (int i = 0; i < PLAIN; i++) {
        plain_z[i] = 1e-8 * i;
        plain_force[i] = 1e-320 * (i * 7 % 5 - 2);
    }
    const nt_curve_branch found = read_plain();
    assert_true(isfinite(found.baseline.force) && isfinite(found.baseline.slope));
    assert_true(fabs(found.baseline.force) <= 2e-320);
}

/* The load rises while the base stands: a slope would be infinite, and is not known. */
static void a_base_that_stands_in_contact_shows_no_slope(void **state)
{
    (void)state;
    for (int stands = 0; stands < 2; stands++) {
        for (int i = 0; i < PLAIN; i++) {
            const double push = i < 100 ? 0.0 : i - 99.0;
            plain_z[i] = 1e-6 - 1e-8 * (stands && i >= 99 ? 99.0 : i);
            plain_force[i] = 1e-11 * (i * 7 % 5 - 2) + 5e-9 * push;
        }
        const nt_curve_measured slope = read_plain().contact_slope;
        if (stands)
            assert_true(isnan(slope.value) && isnan(slope.sigma));
        else
            assert_true(fabs(slope.value / 0.5 - 1.0) < 0.01);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stiff_contact_is_read),
        cmocka_unit_test(tethers_are_found_to_their_end),
        cmocka_unit_test(bad_curves_are_refused),
        cmocka_unit_test(medians_and_orders),
        cmocka_unit_test(medians_of_many),
        cmocka_unit_test(passes_over_all),
        cmocka_unit_test(linear_systems),
        cmocka_unit_test(a_curve_of_denormal_forces_is_read),
        cmocka_unit_test(a_base_that_stands_in_contact_shows_no_slope),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
