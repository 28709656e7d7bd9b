/* SPDX-License-Identifier: BSD-3-Clause
 * Beside Hertz, published limits, and the work integrated here from the forces alone. */
#include <stdio.h>
#include <stdlib.h>

#include "assertions.h"
#include "internal/plasticity.h"
#include "larger.h"
#include "nanotouch/advanced/plasticity.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/material.h"

static const nt_indentation gold = {20e-9, 77e9, 0.35e9};

static nt_indentation_state moved(nt_indentation_state state, double depth)
{
    assert_int_equal(nt_indentation_advance(&gold, &state, depth), NT_OK);
    return state;
}

/* Johnson 1985: F_Y = pi^3 R^2 (1.6 Y)^3/(6 E*^2), the indentation (pi 1.6 Y/(2 E*))^2 R. */
static void is_hertz_until_it_yields(void **unused)
{
    (void)unused;
    const double load = pow(NT_PI, 3.0) * gold.radius * gold.radius * pow(1.6 * 0.35e9, 3.0) / (6.0 * 77e9 * 77e9);
    assert_within(nt_indentation_yield_load(&gold), load, 1e-14 * load);
    const double depth = pow(NT_PI * 1.6 * 0.35e9 / (2.0 * 77e9), 2.0) * gold.radius;
    for (int i = 1; i < 20; ++i) {
        const nt_indentation_state there = moved((nt_indentation_state){0}, depth * i / 20.0);
        const double hertz = 4.0 / 3.0 * 77e9 * sqrt(gold.radius) * pow(depth * i / 20.0, 1.5);
        assert_within(there.force, hertz, 4e-15 * hertz);
        assert_true(there.dissipated == 0.0 && there.dent_radius == 0.0);
        assert_within(there.stored, 0.4 * hertz * depth * i / 20.0, 4e-15 * there.stored);
        const nt_indentation_state back = moved(there, 0.0);
        assert_true(back.force == 0.0 && back.stored == 0.0);
    }
    assert_within(moved((nt_indentation_state){0}, depth).force, load, 1e-14 * load);
    const double radius = nt_indentation_radius_at_depth(&gold, depth);
    assert_within(nt_indentation_first(&gold, radius).mean_pressure, 1.6 / 1.5 * 0.35e9, 1e-6 * 0.35e9);
}

/* Mean pressure of 3 Y at the load pi a^2 3 Y, from there on; a jump of the pressure nowhere. */
static void ends_in_full_plasticity(void **unused)
{
    (void)unused;
    const double unit = 0.35e9 / 77e9 * gold.radius, from = 0.8 * NT_PI * exp(2.9) * unit;
    assert_within(nt_indentation_first(&gold, from).mean_pressure, 3.0 * 0.35e9, 1e-14 * 1e9);
    const double load = NT_PI * from * from * 3.0 * 0.35e9;
    assert_within(nt_indentation_plastic_load(&gold), load, 1e-14 * load);
    assert_within(nt_indentation_radius_at_load(&gold, 2.0 * load), sqrt(2.0) * from, 1e-14 * from);
    for (int i = 0; i < 2; ++i) {
        const double edge = i ? from : 0.8 * NT_PI * unit;
        const nt_first_loading below = nt_indentation_first(&gold, edge * (1.0 - 1e-12));
        const nt_first_loading above = nt_indentation_first(&gold, edge * (1.0 + 1e-12));
        assert_within(above.force, below.force, 1e-11 * below.force);
        assert_within(above.indentation, below.indentation, 1e-11 * below.indentation);
        assert_within(above.residual_depth, below.residual_depth, 2e-11 * below.indentation);
        assert_within(above.dissipated, below.dissipated, 1e-11 * below.force * below.indentation);
    }
}

/* What depth and load say of a contact radius, of all sizes of it, is that radius. */
static void finds_the_radius_again(void **unused)
{
    (void)unused;
    for (double x = 1e-3; x < 1e4; x *= 1.1) {
        const double a = x * 0.35e9 / 77e9 * gold.radius;
        const nt_first_loading there = nt_indentation_first(&gold, a);
        assert_within(nt_indentation_radius_at_depth(&gold, there.indentation), a, 4e-15 * a);
        assert_within(nt_indentation_radius_at_load(&gold, there.force), a, 4e-15 * a);
    }
}

/* Unloading: Hertz with R' from where it was left to delta_r, and back the same way; a^2/(2 rho) deep, 1/rho = 1/R -
 * 1/R' (Johnson 1985, Sec. 6.4). */
static void unloads_from_a_dent(void **unused)
{
    (void)unused;
    const nt_indentation_state full = moved((nt_indentation_state){0}, 1e-9);
    const nt_first_loading dent = nt_indentation_first(&gold, full.dent_radius);
    const double a = full.contact_radius, rho = 1.0 / (1.0 / gold.radius - 1.0 / dent.effective_radius);
    assert_true(full.dent_radius == a && dent.effective_radius > gold.radius && dent.residual_depth > 0.0);
    assert_within(dent.residual_depth, a * a / (2.0 * rho), 1e-13 * 1e-9);
    assert_within(dent.indentation, 1e-9, 1e-14 * 1e-9);
    for (int i = 0; i <= 10; ++i) {
        const double depth = dent.residual_depth + (1e-9 - dent.residual_depth) * i / 10.0;
        const nt_indentation_state there = moved(moved(full, -1e-9), depth);
        const double pressed = depth - dent.residual_depth;
        const double hertz = 4.0 / 3.0 * gold.effective_modulus * sqrt(dent.effective_radius) * pow(pressed, 1.5);
        assert_within(there.force, hertz, 1e-13 * full.force);
        assert_true(there.dissipated == full.dissipated && there.dent_radius == full.dent_radius);
    }
    assert_within(moved(moved(full, 0.0), 1e-9).force, full.force, 1e-13 * full.force);
    assert_true(moved(full, dent.residual_depth).force == 0.0 && moved(full, 0.5 * dent.residual_depth).force == 0.0);
}

static void refuses_what_is_no_step(void **unused)
{
    (void)unused;
    nt_indentation_state state = moved((nt_indentation_state){0}, 1e-9);
    const double heat = state.dissipated;
    assert_int_equal(nt_indentation_advance(&gold, &state, NAN), NT_E_NOT_FINITE);
    assert_int_equal(nt_indentation_advance(&gold, &state, 10e-9), NT_E_RANGE);
    assert_true(state.dissipated == heat && state.indentation == 1e-9);
    nt_indentation_state made_up[] = {
        {.dent_radius = NAN}, {.dissipated = NAN}, {.dent_radius = -1e-9}, {.dent_radius = 11e-9}};
    for (int i = 0; i < 4; ++i)
        assert_int_equal(nt_indentation_advance(&gold, &made_up[i], 1e-9), i < 2 ? NT_E_NOT_FINITE : NT_E_RANGE);
    nt_problem problem;
    assert_int_equal(nt_indentation_check(&(nt_indentation){20e-9, 77e9, -1.0}, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "yield_strength");
    const nt_indentation good = nt_indentation_defaults();
    assert_int_equal(nt_indentation_check(&good, NULL), NT_OK);
    assert_true(isnan(nt_indentation_first(&gold, NAN).force) && isnan(nt_indentation_radius_at_depth(&gold, NAN)));
    const double depths[] = {0.5e-9, 1e-9, 10e-9};
    nt_indentation_state states[3] = {{0}}, from = {0};
    assert_int_equal(nt_indentation_run_n(&gold, &from, depths, states, 3), NT_E_RANGE);
    assert_true(states[1].force == state.force && states[2].force == 0.0);
}

static double between(nt_random *random, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(random));
}

/* From the forces alone: Gauss-Legendre, 8 points, on a piece of the path where the force is smooth. */
static double gauss(const nt_indentation *law, nt_indentation_state from, double low, double high)
{
    static const double node[4] = {0.18343464249564980, 0.52553240991632899, 0.79666647741362674, 0.96028985649753623};
    static const double weight[4] = {0.36268378337836198, 0.31370664587788729, 0.22238103445337447,
                                     0.10122853629037626};
    double sum = 0.0;
    for (int i = 0; i < 8; ++i) {
        nt_indentation_state there = from;
        const double t = i < 4 ? node[i] : -node[i - 4];
        assert_int_equal(nt_indentation_advance(law, &there, 0.5 * (low + high) + 0.5 * t * (high - low)), NT_OK);
        sum += weight[i % 4] * there.force;
    }
    return 0.5 * (high - low) * sum;
}

/* Pieces that shrink towards `begin`, from where the force grows with a power of 1.5. */
static double graded(const nt_indentation *law, nt_indentation_state from, double begin, double low, double high)
{
    double sum = 0.0;
    for (int i = 0; i < 60 && high > low; ++i) {
        const double middle = i < 59 ? larger(low, begin + 0.5 * (high - begin)) : low;
        sum += gauss(law, from, middle, high);
        high = middle;
    }
    return sum;
}

/* Work of one step up or down, cut where the force has its kinks. */
static double work_of(const nt_indentation *law, const nt_indentation_state *from, double to)
{
    const nt_first_loading dent = nt_indentation_first(law, from->dent_radius);
    const double onset = 0.8 * NT_PI * law->yield_strength / law->effective_modulus * law->radius;
    const double kinks[] = {dent.indentation, nt_indentation_first(law, onset).indentation,
                            nt_indentation_first(law, onset * exp(2.9)).indentation, HUGE_VAL};
    const double begin = dent.residual_depth, high = larger(from->indentation, to);
    double low = larger(begin, smaller(from->indentation, to)), sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        const double end = smaller(high, kinks[i]);
        if (end > low) {
            sum += graded(law, *from, begin, low, end);
            low = end;
        }
    }
    return to > from->indentation ? sum : -sum;
}

static void walk(nt_random *random, int steps, double *worst)
{
    const double radius = between(random, 1e-9, 1e-4), modulus = between(random, 1e3, 1e12);
    const nt_indentation law = {radius, modulus, larger(modulus * between(random, 1e-4, 0.3), 1.0)};
    const double most = nt_indentation_first(&law, 0.499 * radius).indentation;
    nt_indentation_state state = {0};
    double work = 0.0, turnover = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double share = between(random, 1e-4, 1.0);
        const double to = nt_random_uniform(random) < 0.2 ? -0.1 * most : most * share;
        const double step = work_of(&law, &state, to), heat = state.dissipated;
        assert_int_equal(nt_indentation_advance(&law, &state, to), NT_OK);
        assert_true(state.dissipated >= heat && state.force >= 0.0 && state.stored >= 0.0);
        work += step;
        turnover += fabs(step);
        if (turnover > 0.0)
            *worst = larger(*worst, fabs(state.stored + state.dissipated - work) / turnover);
    }
}

static void energy_is_kept_on_random_paths(void **unused)
{
    (void)unused;
    const char *asked = getenv("NANOTOUCH_INDENTATION_PATHS");
    const long paths = asked ? atol(asked) : 300;
    double worst = 0.0;
    nt_random random = nt_random_seed(7);
    for (long i = 0; i < paths; ++i)
        walk(&random, 20, &worst);
    printf("%ld paths of 20 steps: stored + dissipated beside the work within %.2g of the turnover\n", paths, worst);
    assert_true(worst < 1e-12); /* 60 pieces of Gauss' sums a step; the turnover is what rounding grows with */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_hertz_until_it_yields), cmocka_unit_test(ends_in_full_plasticity),
        cmocka_unit_test(finds_the_radius_again),   cmocka_unit_test(unloads_from_a_dent),
        cmocka_unit_test(refuses_what_is_no_step),  cmocka_unit_test(energy_is_kept_on_random_paths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
