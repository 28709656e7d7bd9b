/* SPDX-License-Identifier: BSD-3-Clause
 * Beside Langevin's equation, integrated here (Heun) in reduced units: phi = 2 pi x/a, forces in pi E0/a, times in
 * gamma a^2/(2 pi^2 E0), heat t = 2 kT/E0. */
#include <stdlib.h>

#include "assertions.h"
#include "internal/corrugation.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/friction.h"

typedef struct motion {
    double eta, heat, speed; /* reduced */
} motion;
typedef struct measured {
    double mean, sigma, largest;
} measured;

static nt_corrugation corrugation_of(const motion *m)
{
    nt_corrugation c = {.energy = 1e-19, .period = 0.4e-9, .damping = 2e-6};
    c.stiffness = 2.0 * NT_PI * NT_PI * c.energy / (m->eta * c.period * c.period);
    c.temperature = 0.5 * m->heat * c.energy / NT_BOLTZMANN;
    return c;
}

/* In pi E0/a. */
static double law(const motion *m)
{
    const nt_corrugation c = corrugation_of(m);
    const double largest = nt_corrugation_largest_force(&c);
    double force = NAN;
    assert_int_equal(nt_corrugation_mean_force(&c, m->speed * largest / c.damping, &force, NULL), NT_OK);
    return force / largest;
}

/* Periods after the first three; sigma from their scatter. A step of 0.05 is off by below 0.1 % (0.02 the same). */
static measured langevin(const motion *m, int periods)
{
    const long steps = (long)(2.0 * NT_PI / m->speed / 0.05) + 1;
    const double h = 2.0 * NT_PI / m->speed / (double)steps, noise = sqrt(2.0 * m->heat * h);
    nt_random random = nt_random_seed(1);
    double phi = 0.0, theta = 0.0, sum = 0.0, squares = 0.0, largest = 0.0;
    for (int period = -3; period < periods; ++period) {
        double mean = 0.0;
        for (long i = 0; i < steps; ++i) {
            const double kick = m->heat > 0.0 ? noise * nt_random_normal(&random) : 0.0;
            const double pull = (theta - phi) / m->eta, rate = pull - sin(phi), there = phi + h * rate + kick;
            theta += h * m->speed;
            phi += 0.5 * h * (rate + (theta - there) / m->eta - sin(there)) + kick;
            mean += 0.5 * (pull + (theta - phi) / m->eta) / (double)steps;
            largest = larger(largest, pull);
        }
        sum += period < 0 ? 0.0 : mean;
        squares += period < 0 ? 0.0 : mean * mean;
    }
    const double mean = sum / periods, scatter = squares / periods - mean * mean;
    return (measured){mean, scatter > 0.0 ? sqrt(scatter / periods) : 0.0, largest};
}

/* 1e-3: Heun's step. */
static void follows_the_equation_without_heat(void **unused)
{
    (void)unused;
    static const motion motions[] = {{0.5, 0.0, 0.1},  {1.0, 0.0, 0.01}, {1.5, 0.0, 0.001}, {5.0, 0.0, 0.001},
                                     {5.0, 0.0, 0.01}, {5.0, 0.0, 0.1},  {5.0, 0.0, 1.0},   {19.0, 0.0, 0.01}};
    for (unsigned i = 0; i < sizeof motions / sizeof motions[0]; ++i) {
        const double expected = langevin(&motions[i], 2).mean;
        assert_within(law(&motions[i]), expected, 1e-3 * expected);
    }
}

/* As many periods as 6 million steps have; NANOTOUCH_LANGEVIN_STEPS=300e6 is the heavy run. */
static void is_langevin_within_two_percent(void **unused)
{
    (void)unused;
    static const motion motions[] = {{3.0, 0.15, 5e-3},   {3.0, 0.05, 1e-3}, {5.0, 0.15, 1e-3},  {5.0, 0.06, 1e-3},
                                     {5.0, 0.02, 2.5e-4}, {8.0, 0.1, 3e-3},  {20.0, 0.15, 5e-3}, {20.0, 0.03, 5e-4}};
    const char *more = getenv("NANOTOUCH_LANGEVIN_STEPS");
    const double steps = more ? atof(more) : 6e6;
    for (unsigned i = 0; i < sizeof motions / sizeof motions[0]; ++i) {
        const measured found = langevin(&motions[i], (int)(steps * motions[i].speed * 0.05 / (2.0 * NT_PI)) + 2);
        const double force = law(&motions[i]);
        print_message("eta %g, 2 kT/E0 %g, speed %g: %.5f, Langevin %.5f +- %.5f\n", motions[i].eta, motions[i].heat,
                      motions[i].speed, force, found.mean, found.sigma);
        assert_within(force, found.mean, 0.02 * found.mean + 3.0 * found.sigma);
    }
}

/* Below eta = 1 friction goes with the speed, above it stays (Prandtl). */
static void sets_in_at_one(void **unused)
{
    (void)unused;
    const motion slides = {0.9, 0.0, 3e-5}, slower = {0.9, 0.0, 3e-6}, sticks = {1.3, 0.0, 1e-6};
    const nt_corrugation c = corrugation_of(&slides);
    assert_within(nt_corrugation_onset(&c), 0.9, 1e-15 * 4);
    assert_within(law(&slides) / law(&slower), 10.0, 0.05); /* the next order: speed over (1 - eta)^3 */
    assert_true(law(&slides) < 1e-3 && law(&sticks) > 1e-2);
}

/* The spring's largest force, slowly: pi E0/a, and the drag of a tip as quick as the support, 1e-4. */
static void pulls_up_to_pi_energy_over_period(void **unused)
{
    (void)unused;
    const motion m = {5.0, 0.0, 1e-4};
    const nt_corrugation c = corrugation_of(&m);
    assert_within(nt_corrugation_largest_force(&c), NT_PI * 1e-19 / 0.4e-9, 1e-15 * 1e-9);
    assert_within(langevin(&m, 1).largest, 1.0, 2e-4);
}

/* The passage of a fold (Sang, Dube, Grant 2001): F - F_0 ~ v^(2/3), so 8 times the speed gives 4 times as much. The
 * next order is v ln v: some per cent at these speeds. */
static void rises_with_two_thirds_of_the_speed(void **unused)
{
    (void)unused;
    const double rest = law(&(motion){5.0, 0.0, 1e-9});
    const double slow = law(&(motion){5.0, 0.0, 1e-6}) - rest, quick = law(&(motion){5.0, 0.0, 8e-6}) - rest;
    assert_within(quick / slow, 4.0, 0.1);
}

/* With heat F = F_c - (c ln(w/v))^(2/3): (F_c - F)^1.5 is straight over ln v. Three speeds, 1e-6 .. 1e-3; the middle
 * one within 2 %. */
static void falls_with_the_logarithm_of_the_speed(void **unused)
{
    (void)unused;
    const double critical = law(&(motion){5.0, 0.0, 1e-9});
    double bent[3];
    for (int i = 0; i < 3; ++i)
        bent[i] = pow(critical - law(&(motion){5.0, 0.05, 1e-6 * pow(10.0, 1.5 * i)}), 1.5);
    assert_within(bent[1], 0.5 * (bent[0] + bent[2]), 0.02 * bent[1]);
    assert_true(bent[0] > bent[1] && bent[1] > bent[2]);
}

static void refuses_what_it_does_not_know(void **unused)
{
    (void)unused;
    double force = -7.0;
    nt_corrugation c = nt_corrugation_defaults();
    assert_int_equal(nt_corrugation_check(&c, NULL), NT_OK);
    assert_int_equal(nt_corrugation_mean_force(&c, 0.0, &force, NULL), NT_E_RANGE);
    assert_int_equal(nt_corrugation_mean_force(&c, NAN, &force, NULL), NT_E_NOT_FINITE);
    assert_int_equal(nt_corrugation_mean_force(&c, 1.0, &force, NULL), NT_E_RANGE); /* viscous drag alone */
    c.temperature = 298.0;
    assert_int_equal(nt_corrugation_mean_force(&c, 1e-5, &force, NULL), NT_E_RANGE); /* too quick for heat */
    nt_problem problem;
    assert_int_equal(nt_corrugation_mean_force(&c, 1e-5, &force, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "speed");
    assert_true(problem.value == 1e-5 && problem.maximum < 1e-5);
    c.stiffness = 10.0; /* eta = 0.5 */
    assert_int_equal(nt_corrugation_mean_force(&c, 1e-9, &force, NULL), NT_E_RANGE);
    c.energy = -1.0;
    assert_int_equal(nt_corrugation_check(&c, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "energy");
    assert_int_equal(nt_corrugation_mean_force(&c, 1e-9, &force, NULL), NT_E_RANGE);
    assert_true(force == -7.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(follows_the_equation_without_heat),
        cmocka_unit_test(is_langevin_within_two_percent),
        cmocka_unit_test(sets_in_at_one),
        cmocka_unit_test(pulls_up_to_pi_energy_over_period),
        cmocka_unit_test(rises_with_two_thirds_of_the_speed),
        cmocka_unit_test(falls_with_the_logarithm_of_the_speed),
        cmocka_unit_test(refuses_what_it_does_not_know),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
