/* SPDX-License-Identifier: BSD-3-Clause
 * A sample that deforms against numbers of solvers that were written apart and against limits in closed form. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assertions.h"
#include "scene/deformation/deform.h"

typedef struct law {
    double pressure, length;
} law;

static nt_pressure exponential(const void *context, double gap)
{
    const law *l = context;
    const double p = l->pressure * exp(-gap / l->length);
    return (nt_pressure){p * l->length, p, -p / l->length};
}

static nt_pressure brush(const void *context, double gap)
{
    const law *l = context;
    const double x = gap / l->length, p = l->pressure;
    if (!(x < 1.0))
        return (nt_pressure){0.0, 0.0, 0.0};
    return (nt_pressure){p * l->length * 4.0 / 35.0 * (7.0 * pow(x, -1.25) + 5.0 * pow(x, 1.75) - 12.0),
                         p * (pow(x, -2.25) - pow(x, 0.75)),
                         -p / l->length * (2.25 * pow(x, -3.25) + 0.75 * pow(x, -0.25))};
}

static nt_pressure van_der_waals(const void *context, double gap)
{
    const double W = -((const law *)context)->pressure / (12.0 * NT_PI * gap * gap);
    return (nt_pressure){W, 2.0 * W / gap, -6.0 * W / (gap * gap)};
}

static nt_deform_table table;

static double within(double found, double expected)
{
    return fabs(found / expected - 1.0);
}

/* -ln M, F/(E* l sqrt(2 R l)) of p0 exp(-g/l), M = p0/E* sqrt(2 R/l) exp(-h/l). */
static void an_exponential_has_one_group(void **state)
{
    (void)state;
    static const double curve[][2] = {{4, .05626615}, {2, .3679509}, {0, 1.676247}, {-4, 9.202063}, {-10, 30.1042}};
    const double R = 3e-6, E = 2e3;
    const law l = {80e3, 5e-9};
    const double log_scale = log(l.pressure / E * sqrt(2.0 * R / l.length));
    const nt_deform_sample sample = {
        .radius = R, .modulus = E, .law = exponential, .context = &l, .length = l.length, .pole = -1e-6};
    const nt_deform_range range = {
        .farthest = l.length * (9.0 + log_scale), .nearest = -1e-3, .load = 1.2e-9, .tolerance = 1e-4, .scale = 1e-14};
    assert_int_equal(nt_deform_table_make(&table, &sample, &range), NT_OK);
    for (int i = 0; i < 5; ++i) {
        const nt_law_value value = nt_deform_table_eval(&table, l.length * (curve[i][0] + log_scale));
        assert_true(within(value.F, E * l.length * sqrt(2.0 * R * l.length) * curve[i][1]) < 2e-4);
    }
}

/* The cell of the preset: gap at a load, half-space and layer of 5 um. */
static void a_brush_on_a_cell(void **state)
{
    (void)state;
    static const double curve[2][3][2] = {{{1e-11, 356.020e-9}, {0.3e-9, -27.953e-9}, {1e-9, -342.895e-9}},
                                          {{1e-11, 356.856e-9}, {0.3e-9, -3.231e-9}, {1e-9, -261.520e-9}}};
    const law l = {1.380649e-23 * 310.15 / (80e-9 * 80e-9 * 80e-9), 0.5e-6};
    for (int layered = 0; layered < 2; ++layered) {
        const nt_deform_sample sample = {.radius = 2.5e-6,
                                         .modulus = 1e3 / 0.75,
                                         .thickness = layered ? 5e-6 : 0.0,
                                         .poisson_ratio = 0.5,
                                         .share = 1.0,
                                         .law = brush,
                                         .context = &l,
                                         .length = 5e-9,
                                         .ends = {l.length},
                                         .end_count = 1};
        const nt_deform_range range = {
            .farthest = 0.99 * l.length, .nearest = -1e-3, .load = 2e-9, .tolerance = 1e-4, .scale = 1e-12};
        assert_int_equal(nt_deform_table_make(&table, &sample, &range), NT_OK);
        for (int i = 0; i < 3; ++i) {
            const nt_law_value value = nt_deform_table_eval(&table, curve[layered][i][1]);
            const double off = (value.F - curve[layered][i][0]) / value.k; /* as a gap [m] */
            assert_true(fabs(off) < 0.1e-9);
        }
    }
}

static void in_contact_it_becomes_hertz(void **state)
{
    (void)state;
    const law l = {1e3, 1e-9};
    const double R = 1e-6, E = 1e6, d = 1e-7;
    const nt_deform_sample sample = {
        .radius = R, .modulus = E, .law = exponential, .context = &l, .length = l.length, .pole = -1e-6};
    const nt_deform_range range = {
        .farthest = 12e-9, .nearest = -1.5 * d, .load = 1.0, .tolerance = 1e-4, .scale = 1e-13};
    assert_int_equal(nt_deform_table_make(&table, &sample, &range), NT_OK);
    const nt_law_value deep = nt_deform_table_eval(&table, -d);
    assert_true(within(deep.F, 4.0 / 3.0 * E * sqrt(R) * pow(d, 1.5)) < 1e-3);
    assert_true(within(deep.k, 2.0 * E * sqrt(R * d)) < 1e-3);
    assert_true(within(deep.a, sqrt(R * d)) < 2e-2);
    /* nanotouch.reference.Deformation */
    assert_true(within(nt_deform_table_eval(&table, -1e-8).F, 1.33679086e-9) < 2e-4);
    assert_true(within(nt_deform_table_eval(&table, 2e-9).F, 8.4396402e-13) < 2e-4);
}

static void attraction_jumps_where_it_does(void **state)
{
    (void)state;
    const law l = {1e-19, 0.0};
    const double R = 1e-6, E = 1e6, jump = pow(0.5955 * l.pressure * sqrt(R) / E, 2.0 / 7.0);
    const nt_deform_sample sample = {
        .radius = R, .modulus = E, .law = van_der_waals, .context = &l, .length = 1e-7, .pole = 0.0};
    const nt_deform_range range = {
        .farthest = 400e-9, .nearest = -1e-3, .load = 1.0, .tolerance = 1e-3, .scale = 1e-13, .attracts = 1};
    assert_int_equal(nt_deform_table_make(&table, &sample, &range), NT_OK);
    assert_int_equal(table.jumps, 1);
    assert_true(within(table.touch, jump) < 2e-4);
    assert_true(within(nt_deform_table_eval(&table, table.touch).F, -1.7359 * l.pressure * R / (6.0 * jump * jump)) <
                2e-3);
}

/* One potential: F is the slope of U and k that of F, across cells, parts and both ends. */
static void force_is_the_slope_of_energy(void **state)
{
    (void)state;
    const law l = {1e4, 1e-9};
    const nt_deform_sample sample = {
        .radius = 1e-6, .modulus = 1e6, .law = exponential, .context = &l, .length = l.length, .pole = -1e-6};
    const nt_deform_range range = {.farthest = 15e-9, .nearest = -1e-8, .load = 1.0, .tolerance = 1e-3, .scale = 1e-13};
    assert_int_equal(nt_deform_table_make(&table, &sample, &range), NT_OK);
    for (double h = 14e-9; h > -2e-8; h -= 0.0713e-9) {
        const double step = 1e-13;
        const nt_law_value here = nt_deform_table_eval(&table, h), far = nt_deform_table_eval(&table, h + step),
                           near = nt_deform_table_eval(&table, h - step);
        assert_true(within(here.F, (near.U - far.U) / (2.0 * step)) < 1e-4);
        assert_true(within(here.k, (near.F - far.F) / (2.0 * step)) < 1e-3);
    }
}

/* A contact whose adhesion ends at c = sqrt(a^2 + e): Maugis (1992), eqs. 11 and 15, written down here. */
static double maugis_gap(const nt_deform_sample *sample, double a, double c)
{
    const double s = sqrt(c * c - a * a), R = sample->radius, pull = sample->stress / sample->modulus;
    const double depth = a * a / R - 2.0 * pull * s;
    return -depth + 0.5 * c * c / R + 2.0 / NT_PI * ((depth - 0.5 * c * c / R) * asin(a / c) + 0.5 * a * s / R) -
           4.0 / NT_PI * pull * (c - a);
}

static double maugis_force(const nt_deform_sample *sample, double a, double c)
{
    const double s = sqrt(c * c - a * a);
    return 4.0 / 3.0 * sample->modulus * a * a * a / sample->radius -
           2.0 * sample->stress * (a * s + c * c * acos(a / c));
}

#define RANGE (9.0 * 1.7320508075688772 / 16.0 * 0.165e-9) /* of w = 1 mJ/m^2 */

static nt_deform_solver solver;

static void contact_alone_is_maugis(void **state)
{
    (void)state;
    const law none = {0.0, 1e-9};
    const nt_deform_sample sample = {.radius = 1e-6,
                                     .modulus = 1e6,
                                     .law = exponential,
                                     .context = &none,
                                     .length = 1e-9,
                                     .stress = 6.2e6,
                                     .range = 1.6e-10};
    assert_int_equal(nt_deform_begin_contact(&solver, &sample, 120e-9), NT_OK);
    static const double radii[] = {120e-9, 90e-9, 300e-9};
    for (int i = 0; i < 3; ++i) {
        nt_deform_point point;
        assert_int_equal(nt_deform_go(&solver, NT_DEFORM_CONTACT, radii[i], &point), NT_OK);
        const double c = sqrt(radii[i] * radii[i] + solver.end);
        assert_true(within(maugis_gap(&sample, radii[i], c), sample.range) < 1e-5);
        assert_true(within(point.F, maugis_force(&sample, radii[i], c)) < 1e-6);
    }
}

/* With a double layer around it: F is the slope of the energy of all pressures. */
static void a_surrounded_contact_is_one_potential(void **state)
{
    (void)state;
    static const law around[] = {{1e5, 1e-8}, {1e6, 1e-9}, {-1e5, 5e-9}};
    static const double gap[] = {-1.52342569e-9, -3.24645423e-9, 0.0}; /* at a = 120 nm, by an own writing in Python */
    for (int i = 0; i < 3; ++i) {
        const nt_deform_sample sample = {.radius = 1e-6,
                                         .modulus = 1e6,
                                         .law = exponential,
                                         .context = &around[i],
                                         .length = around[i].length,
                                         .stress = 1e-3 / RANGE,
                                         .range = RANGE};
        nt_deform_point here, inner, outer;
        assert_int_equal(nt_deform_begin_contact(&solver, &sample, 120e-9), NT_OK);
        assert_int_equal(nt_deform_go(&solver, NT_DEFORM_CONTACT, 119.9e-9, &outer), NT_OK);
        const double U = nt_deform_energy_in_contact(&solver);
        assert_int_equal(nt_deform_go(&solver, NT_DEFORM_CONTACT, 120.1e-9, &inner), NT_OK);
        const double F = (nt_deform_energy_in_contact(&solver) - U) / (outer.h - inner.h);
        assert_int_equal(nt_deform_go(&solver, NT_DEFORM_CONTACT, 120e-9, &here), NT_OK);
        assert_true(within(here.F, F) < 1e-4);
        assert_true(fabs(here.k - (inner.F - outer.F) / (outer.h - inner.h)) < 1e-2 * fabs(here.k) + 1e-3);
        assert_true(gap[i] == 0.0 || fabs(here.h - gap[i]) < 2e-14);
    }
}

static void a_surrounded_contact_lets_go_at_its_fold(void **state)
{
    (void)state;
    const law l = {1e5, 1e-8};
    const nt_deform_sample sample = {.radius = 1e-6,
                                     .modulus = 1e6,
                                     .law = exponential,
                                     .context = &l,
                                     .length = l.length,
                                     .stress = 1e-3 / RANGE,
                                     .range = RANGE};
    const nt_deform_range range = {
        .nearest = -INFINITY, .load = 1e-8, .tolerance = 1e-3, .scale = 4e-9, .radius_scale = 1e-7};
    table.count = 0;
    assert_int_equal(nt_deform_table_hold(&table, &sample, &range, 150e-9), NT_OK);
    assert_true(table.holds && within(table.release, 2.60216e-9) < 1e-4);
    static const double radii[] = {80e-9, 130e-9, 230e-9};
    assert_int_equal(nt_deform_begin_contact(&solver, &sample, 120e-9), NT_OK);
    for (int i = 0; i < 3; ++i) {
        nt_deform_point point;
        assert_int_equal(nt_deform_go(&solver, NT_DEFORM_CONTACT, radii[i], &point), NT_OK);
        const nt_law_value value = nt_deform_table_held(&table, point.h);
        assert_true(fabs(value.F - point.F) < range.tolerance * range.scale);
        assert_true(fabs(value.a - radii[i]) < 2e-3 * radii[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_exponential_has_one_group),
        cmocka_unit_test(a_brush_on_a_cell),
        cmocka_unit_test(in_contact_it_becomes_hertz),
        cmocka_unit_test(attraction_jumps_where_it_does),
        cmocka_unit_test(force_is_the_slope_of_energy),
        cmocka_unit_test(contact_alone_is_maugis),
        cmocka_unit_test(a_surrounded_contact_is_one_potential),
        cmocka_unit_test(a_surrounded_contact_lets_go_at_its_fold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
