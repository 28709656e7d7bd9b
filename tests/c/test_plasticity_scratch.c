/* SPDX-License-Identifier: BSD-3-Clause
 * Beside the published forms for a sphere: width sqrt(8 P/(pi H)), ploughing 4a/(3 pi R) of the load (Bowden and Tabor
 * 1950, small contacts); areas are summed here. */
#include "assertions.h"
#include "internal/plasticity.h"
#include "nanotouch/advanced/plasticity.h"
#include "nanotouch/material.h"

static const nt_scratching plain = {50e-9, 1e9, 80e6, 0.0, 1.0};
static const nt_scratching layered = {50e-9, 0.2e9, 80e6, 1.5e-9, 5e9};

static nt_groove under(const nt_scratching *scratching, double load)
{
    nt_groove groove;
    assert_int_equal(nt_scratch(scratching, load, &groove, NULL), NT_OK);
    return groove;
}

static void ploughs_as_published(void **unused)
{
    (void)unused;
    for (double load = 1e-12; load < 500e-9; load *= 3.0) {
        const nt_groove groove = under(&plain, load);
        assert_within(groove.width, sqrt(8.0 * load / (NT_PI * 1e9)), 1e-14 * groove.width);
        const double a = 0.5 * groove.width;
        assert_within(groove.ploughing, load * 4.0 * a / (3.0 * NT_PI * 50e-9), 1e-14 * groove.ploughing);
        assert_within(groove.shearing, 80e6 * NT_PI * a * a / 2.0, 1e-14 * groove.shearing);
        assert_within(groove.depth, a * a / 100e-9, 1e-14 * groove.depth);
        assert_true(!groove.is_cut_through && groove.layer_load == 0.0);
    }
}

/* Hardness at a depth below the surface, and the work of strips: half of the contact, and the front. */
static void summed(const nt_scratching *s, double depth, double *load, double *front)
{
    enum { STRIPS = 200000 };
    *load = *front = 0.0;
    for (int i = 0; i < STRIPS; ++i) {
        const double h = depth * (i + 0.5) / STRIPS, below = h > s->layer_thickness;         /* below the surface */
        const double hardness = below ? s->substrate_hardness : s->hardness, up = depth - h; /* above the apex */
        *load += hardness * NT_PI * s->radius * depth / STRIPS; /* half a ring of the paraboloid has d(pi r^2/2) */
        *front += hardness * 2.0 * sqrt(2.0 * s->radius * up) * depth / STRIPS;
    }
}

static void cuts_through_a_layer(void **unused)
{
    (void)unused;
    const double through = NT_PI * 50e-9 * 0.2e9 * 1.5e-9;
    assert_true(!under(&layered, 0.999 * through).is_cut_through && under(&layered, 1.001 * through).is_cut_through);
    assert_within(under(&layered, through).layer_load, through, 1e-14 * through);
    for (int i = 1; i < 8; ++i) {
        const nt_groove groove = under(&layered, 0.5 * i * through);
        double load, front;
        summed(&layered, groove.depth, &load, &front);
        assert_within(load, 0.5 * i * through, 1e-4 * load); /* the strip on the border of the layer */
        assert_within(groove.ploughing, front, 1e-4 * front);
    }
}

static void refuses_what_is_no_load(void **unused)
{
    (void)unused;
    nt_groove groove;
    nt_problem problem;
    assert_int_equal(nt_scratch(&plain, NAN, &groove, &problem), NT_E_NOT_FINITE);
    assert_int_equal(nt_scratch(&plain, -1e-9, &groove, &problem), NT_E_RANGE);
    assert_int_equal(nt_scratch(&plain, 1e-3, &groove, &problem), NT_E_RANGE);
    assert_int_equal(nt_scratch(&plain, problem.maximum * (1.0 - 1e-12), &groove, &problem), NT_OK);
    assert_within(0.5 * groove.width, 25e-9, 1e-9 * 25e-9);
    assert_int_equal(nt_scratch(&layered, 1e-3, &groove, &problem), NT_E_RANGE);
    assert_int_equal(nt_scratch(&layered, problem.maximum * (1.0 - 1e-12), &groove, &problem), NT_OK);
    assert_within(0.5 * groove.width, 25e-9, 1e-9 * 25e-9);
    const nt_scratching defaults = nt_scratching_defaults();
    assert_int_equal(nt_scratching_check(&defaults, &problem), NT_OK);
    assert_int_equal(nt_scratching_check(&(nt_scratching){.radius = 1e-9}, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "hardness");
}

/* Archard's law; a cap of the flat radius has the volume again. */
static void wears(void **unused)
{
    (void)unused;
    assert_within(nt_worn_volume(1e-4, 10e-9, 1e-3, 1e10), 1e-25, 1e-39);
    const double flat = nt_worn_flat(20e-9, 1e-25), height = flat * flat / (2.0 * 20e-9);
    assert_within(NT_PI * flat * flat * height / 2.0, 1e-25, 1e-39);
    assert_true(isnan(nt_worn_flat(NAN, 1.0)) && isnan(nt_worn_volume(NAN, 1.0, 1.0, 1.0)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ploughs_as_published),
        cmocka_unit_test(cuts_through_a_layer),
        cmocka_unit_test(refuses_what_is_no_load),
        cmocka_unit_test(wears),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
