/* SPDX-License-Identifier: BSD-3-Clause
 * Volumes are summed here over the pixels that have changed; that of a paraboloid is pi a^2 d/2, of its trench 4/3 a d
 * per length. */
#include <stdio.h>
#include <string.h>

#include "assertions.h"
#include "larger.h"
#include "nanotouch/advanced/plasticity.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/material.h"

enum { NX = 160, NY = 140 };

static double heights[NX * NY], before[NX * NY];
static const nt_height_map map = {heights, NX, NY, 1e-9, 1.25e-9};
static const nt_displacement shares = {0.6, 0.1, 1.0};

static void rough(uint64_t seed)
{
    nt_random random = nt_random_seed(seed);
    for (int i = 0; i < NX * NY; ++i)
        heights[i] = before[i] = 0.2e-9 * nt_random_normal(&random);
}

/* Sum of the heights that are above and below what was there [m^3]. */
static void changed(double *up, double *down)
{
    *up = *down = 0.0;
    for (int i = 0; i < NX * NY; ++i) {
        const double change = (heights[i] - before[i]) * map.dx * map.dy;
        *(change > 0.0 ? up : down) += change;
    }
}

static nt_edit pressed(const nt_imprint *old, const nt_imprint *new)
{
    nt_edit edit;
    nt_problem problem = {0};
    assert_int_equal(nt_imprint_edit(heights, &map, &(nt_imprint_change){old, new, &shares}, &edit, &problem), NT_OK);
    return edit;
}

/* removed = piled up + densified + debris, in the pixels; removed is the volume of the imprint within 1 %. */
static void closes_the_balance(void **unused)
{
    (void)unused;
    nt_random random = nt_random_seed(3);
    double worst = 0.0;
    for (int i = 0; i < 400; ++i) {
        rough(1);
        const double radius = map.dy * (6.0 + 9.0 * nt_random_uniform(&random));
        const int is_dent = i % 2;
        nt_imprint imprint = {{60e-9, 80e-9}, {60e-9, 80e-9}, radius, 2e-9 * nt_random_uniform(&random)};
        for (int k = 0; k < 2; ++k) {
            imprint.start[k] += 10e-9 * nt_random_uniform(&random);
            imprint.end[k] = is_dent ? imprint.start[k] : imprint.end[k] + 40e-9 * nt_random_uniform(&random);
        }
        const nt_edit edit = pressed(NULL, &imprint);
        double up, down;
        changed(&up, &down);
        assert_within(-down, edit.removed, 1e-12 * edit.removed);
        assert_within(up, 0.6 * edit.removed, 1e-12 * edit.removed);
        assert_within(edit.piled_up + edit.densified + edit.debris, edit.removed, 1e-15 * edit.removed);
        worst = larger(worst, fabs(edit.removed / nt_imprint_volume(&imprint) - 1.0));
    }
    printf("volume in the pixels beside that of the imprint, from 6 pixels of radius on: within %.2g\n", worst);
    assert_true(worst < 0.01);
}

/* Pixels that lie in line with a groove err by the most: 1/(4 n^2) of a long one at n pixels, 0.7 % at 6. */
static void holds_grooves_along_a_row(void **unused)
{
    (void)unused;
    for (int offset = 0; offset < 8; ++offset)
        for (int i = 0; i < 40; ++i) {
            rough(6);
            const double y = 70e-9 + 1.25e-9 * offset / 8.0, radius = 1.25e-9 * (NT_IMPRINT_PIXELS + 0.05 * i);
            const nt_imprint groove = {{20e-9, y}, {135e-9, y}, radius, 1e-9};
            const double volume = nt_imprint_volume(&groove);
            assert_within(pressed(NULL, &groove).removed, volume, 0.007 * volume);
        }
}

/* Height at the middle, at the rim and beyond; pixels outside the extent keep their bits. */
static void has_the_shape_of_the_tip(void **unused)
{
    (void)unused;
    rough(2);
    const nt_imprint dent = {{80e-9, 75e-9}, {80e-9, 75e-9}, 20e-9, 1.5e-9};
    const nt_edit edit = pressed(NULL, &dent);
    for (int i = 0; i < NX; ++i) {
        const double r = fabs((double)i * 1e-9 - 80e-9), change = heights[60 * NX + i] - before[60 * NX + i];
        if (r < 20e-9)
            assert_within(change, -1.5e-9 * (1.0 - r * r / 400e-18), 1e-15 * 1e-9 + 1e-24);
        else
            assert_true(r < 40e-9 ? change >= 0.0 : change == 0.0);
    }
    for (int j = 0; j < NY; ++j)
        for (int i = 0; i < NX; ++i)
            if (i < edit.first_x || i >= edit.first_x + edit.count_x || j < edit.first_y ||
                j >= edit.first_y + edit.count_y)
                assert_true(heights[j * NX + i] == before[j * NX + i]);
    assert_true(edit.count_x == 81 && edit.count_y == 65);
}

/* A dent that grows is, to rounding, the one that was made at once. */
static void grows(void **unused)
{
    (void)unused;
    const nt_imprint small = {{80e-9, 75e-9}, {80e-9, 75e-9}, 10e-9, 1e-9};
    const nt_imprint large = {{80e-9, 75e-9}, {80e-9, 75e-9}, 20e-9, 3e-9};
    static double once[NX * NY];
    rough(4);
    const nt_edit whole = pressed(NULL, &large);
    memcpy(once, heights, sizeof once);
    rough(4);
    const nt_edit first = pressed(NULL, &small), rest = pressed(&small, &large);
    for (int i = 0; i < NX * NY; ++i)
        assert_within(heights[i], once[i], 4e-24); /* roundings of heights of nanometres */
    assert_within(first.removed + rest.removed, whole.removed, 1e-14 * whole.removed);
}

static void refused(nt_imprint imprint, nt_displacement how, const char *word, nt_status expected)
{
    nt_edit edit;
    nt_problem problem = {0};
    rough(5);
    assert_int_equal(nt_imprint_edit(heights, &map, &(nt_imprint_change){NULL, &imprint, &how}, &edit, &problem),
                     expected);
    if (expected == NT_E_RANGE)
        assert_non_null(strstr(problem.field, word));
    assert_memory_equal(heights, before, sizeof heights);
}

static void refuses_what_does_not_fit(void **unused)
{
    (void)unused;
    const nt_imprint good = {{80e-9, 75e-9}, {80e-9, 75e-9}, 10e-9, 1e-9};
    nt_imprint bad = good;
    bad.radius = 7e-9; /* 5.6 of the larger pixels */
    refused(bad, shares, "6 pixels", NT_E_RANGE);
    bad = good;
    bad.depth = -1e-9;
    refused(bad, shares, "depth", NT_E_RANGE);
    bad = good;
    bad.end[0] = 150e-9;
    refused(bad, shares, "ridge) x", NT_E_RANGE);
    bad = good;
    bad.start[1] = 5e-9;
    refused(bad, shares, "ridge) y", NT_E_RANGE);
    bad = good;
    bad.start[1] = NAN;
    refused(bad, shares, "", NT_E_NOT_FINITE);
    refused(good, (nt_displacement){0.8, 0.3, 1.0}, "debris", NT_E_RANGE);
    refused(good, (nt_displacement){0.8, 0.1, 0.15}, "ridge_width", NT_E_RANGE);
    nt_edit edit;
    assert_int_equal(nt_imprint_edit(heights, &map, &(nt_imprint_change){NULL, NULL, &shares}, &edit, NULL),
                     NT_E_ARGUMENT);
    assert_int_equal(nt_imprint_edit(heights, &map, &(nt_imprint_change){NULL, &good, &shares}, NULL, NULL),
                     NT_E_ARGUMENT);
    const nt_displacement defaults = nt_displacement_defaults();
    assert_int_equal(nt_displacement_check(&defaults, NULL), NT_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closes_the_balance),        cmocka_unit_test(holds_grooves_along_a_row),
        cmocka_unit_test(has_the_shape_of_the_tip),  cmocka_unit_test(grows),
        cmocka_unit_test(refuses_what_does_not_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
