/* SPDX-License-Identifier: BSD-3-Clause
 * curves/bend.c: a bow and a squeeze film do not move the contact point, and a plain approach is left alone. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/curves.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/curves.h"

enum { POINTS = 1600 };

static const double noise = 10e-12, free_travel = 2.2e-6, depth = 6e-7; /* N, m, m */

static struct {
    double z[POINTS], force[POINTS], work[16 * POINTS + 4096];
} made;

static struct {
    double z[POINTS], force[POINTS], work[32 * POINTS + 4096];
} back;

/* Contact at z = 0: 30 N/m^1.5 without a lever that bends; bow [N] at the far end, film [N] at the contact. */
static nt_curve_reading read(double bow, double film)
{
    static nt_curve_reading reading;
    nt_random random = nt_random_seed(7);
    for (int i = 0; i < POINTS; i++) {
        const double z = free_travel - (free_travel + depth) * i / (POINTS - 1), above = larger(z, 0.0);
        made.z[i] = z;
        made.force[i] = 30.0 * pow(larger(-z, 0.0), 1.5) + bow * (z / free_travel) * (z / free_travel) +
                        film / (1.0 + above / 150e-9) + noise * nt_random_normal(&random);
    }
    const nt_curve curve = {.approach = {made.z, made.force, POINTS}, .spring_constant = 1.0};
    const nt_curve_choice choice = {NT_CURVE_AUTO, 0.0, 0.0};
    assert_true(nt_curve_work_size(POINTS) <= (long)(sizeof made.work / sizeof *made.work));
    assert_int_equal(nt_curve_read(&curve, &choice, made.work, &reading, NULL), NT_OK);
    return reading;
}

/* The same with a retraction, which a tether of that force [N] holds over six tenths of the free travel. */
static nt_curve_reading read_both(double bow, double film, double tether)
{
    static nt_curve_reading reading;
    nt_random random = nt_random_seed(7);
    for (int i = 0; i < POINTS; i++) {
        const double z = free_travel - (free_travel + depth) * i / (POINTS - 1), above = larger(z, 0.0);
        const double even = 30.0 * pow(larger(-z, 0.0), 1.5) + bow * (z / free_travel) * (z / free_travel);
        const double odd = film / (1.0 + above / 150e-9), held = z > 0.0 && z < 0.6 * free_travel ? tether : 0.0;
        made.z[i] = back.z[POINTS - 1 - i] = z;
        made.force[i] = even + odd + noise * nt_random_normal(&random);
        back.force[POINTS - 1 - i] = even - odd - held + noise * nt_random_normal(&random);
    }
    const nt_curve curve = {
        .approach = {made.z, made.force, POINTS}, .retract = {back.z, back.force, POINTS}, .spring_constant = 1.0};
    const nt_curve_choice choice = {NT_CURVE_AUTO, 0.0, 0.0};
    assert_true(nt_curve_work_size(2L * POINTS) <= (long)(sizeof back.work / sizeof *back.work));
    assert_int_equal(nt_curve_read(&curve, &choice, back.work, &reading, NULL), NT_OK);
    return reading;
}

/* The force in front of contact, 50 to 300 nm away: 145 points; 5 standard deviations of their mean are 4 pN. */
static double left_in_front(const nt_curve_reading *reading)
{
    double sum = 0.0;
    long count = 0;
    for (long i = 0; i < reading->approach.count; i++)
        if (reading->approach.z[i] > 50e-9 && reading->approach.z[i] < 300e-9) {
            sum += reading->approach.force[i];
            count++;
        }
    return sum / (double)count;
}

static void a_plain_approach_is_left_alone(void **state)
{
    (void)state;
    const nt_curve_reading reading = read(0.0, 0.0);
    assert_true(reading.approach.baseline.bend.film == 0.0);
    assert_true(reading.approach.baseline.bend.bow == 0.0);
    assert_true(fabs(left_in_front(&reading)) < 4e-12);
}

/* Its own uncertainty, an extrapolated parabola's, is twice that of the mean. */
static void a_bow_is_taken_off(void **state)
{
    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        const nt_curve_reading reading = read(sign * 120e-12, 0.0);
        assert_true(reading.approach.baseline.bend.bow * sign > 0.0);
        assert_true(fabs(left_in_front(&reading)) < 8e-12);
    }
}

static void a_film_is_taken_off(void **state)
{
    (void)state;
    const nt_curve_reading reading = read(0.0, 80e-12);
    const nt_curve_bend *bend = &reading.approach.baseline.bend;
    assert_true(bend->film > 0.0);
    assert_true(fabs(left_in_front(&reading)) < 8e-12);
    /* of its shape only what is seen from the visible force on: half of the 80 pN to twice */
    const double there = bend->film / (bend->nearest - bend->pole);
    assert_true(there > 40e-12 && there < 160e-12);
}

/* It is even. Over a line the tether of 300 pN was 372 and 299 pN; the points' noise counts in the sigma of 14 pN. */
static void a_bow_is_taken_off_the_retraction_too(void **state)
{
    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        const nt_curve_reading reading = read_both(sign * 120e-12, 0.0, 300e-12);
        const nt_curve_baseline *there = &reading.retract.baseline;
        assert_true(there->bend.bow * sign > 0.0);
        assert_true(fabs(reading.retract.dip.value - 300e-12) < 15e-12);
        assert_true(reading.pull_off_least > 280e-12 && reading.pull_off_most < 320e-12);
        for (long i = 0; i < reading.retract.count; i += 100) /* what was taken off is the baseline that is told */
            assert_true(fabs(back.force[i] - nt_curve_baseline_at(there, back.z[i]) - reading.retract.force[i]) <
                        1e-18);
        assert_true(fabs(left_in_front(&reading)) < 8e-12);
    }
}

/* A film holds the lever as adhesion does, and repels as much on the approach. Beside the bow it was a pull-off. */
static void a_film_and_a_bow_are_no_adhesion(void **state)
{
    (void)state;
    for (double film = 60e-12; film < 85e-12; film += 20e-12) {
        const nt_curve_reading reading = read_both(-150e-12, film, 0.0);
        assert_true(reading.pull_off_least < 1.96 * reading.pull_off_sigma);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plain_approach_is_left_alone),
        cmocka_unit_test(a_bow_is_taken_off),
        cmocka_unit_test(a_film_is_taken_off),
        cmocka_unit_test(a_bow_is_taken_off_the_retraction_too),
        cmocka_unit_test(a_film_and_a_bow_are_no_adhesion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
