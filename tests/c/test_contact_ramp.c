/* SPDX-License-Identifier: BSD-3-Clause
 * A law on a spring over a whole movement: each force by the equilibrium that defines it, the ends by the jumps, Hertz
 * in closed form. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/contact.h"
#include "internal/contact_equilibrium.h"
#include "larger.h"
#include "maugis_fixture.h"
#include "nanotouch/advanced/contact_equilibrium.h"

enum { POINTS = 300 };

static nt_contact_law law_of(nt_model model, double lambda)
{
    nt_contact_law law = {.model = model};
    const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.0};
    assert_int_equal(nt_maugis_init_lambda(&law.maugis, &contact, lambda), NT_OK);
    return law;
}

/* What the force is off by, from the law at the indentation that D and F imply. */
static double force_error(const nt_contact_law *law, double spring, double stage, double force)
{
    nt_law_value value;
    assert_int_equal(nt_contact_law_eval(law, stage - force / spring, NT_BRANCH_STABLE, &value), NT_OK);
    return fabs((value.F - force) / (1.0 + value.k / spring));
}

/* From the depth to where the branch ends and as far again: the error of all forces but those within 1e-4 of the way
 * to the end, over the largest force; 0 beyond the end. */
static double branch_error(const nt_contact_law *law, double spring, double depth, nt_branch branch)
{
    nt_jump jump;
    double stage[POINTS], force[POINTS], most = 0.0, error = 0.0;
    assert_int_equal(nt_contact_law_jump(law, spring, &jump), NT_OK);
    const double end = branch == NT_BRANCH_APPROACH ? -jump.jump_in_gap : -jump.pull_off_gap;
    for (int i = 0; i < POINTS; i++)
        stage[i] = depth - 2.0 * (depth - end) * i / (POINTS - 1);
    const nt_ramp ramp = {spring, branch, stage, force, POINTS};
    assert_int_equal(nt_contact_law_ramp(law, &ramp), NT_OK);
    for (int i = 0; i < POINTS; i++) {
        if (stage[i] <= end) {
            assert_true(force[i] == 0.0);
            continue;
        }
        assert_true(stage[i] - force[i] / spring >= jump.last.indentation - 1e-7 * (1.0 + 1.0 / spring));
        most = larger(most, fabs(force[i]));
        if (stage[i] - end > 1e-4 * (depth - end) || branch == NT_BRANCH_APPROACH)
            error = larger(error, force_error(law, spring, stage[i], force[i]));
    }
    return error / most;
}

static void every_force_is_an_equilibrium(void **state)
{
    (void)state;
    static const nt_model models[] = {NT_MAUGIS, NT_JKR, NT_DMT};
    double worst = 0.0;
    for (size_t m = 0; m < COUNT(models); m++)
        for (double lambda = 1e-3; lambda < 1e3; lambda *= models[m] == NT_MAUGIS ? 2.9 : 1e9)
            for (double spring = 1e-4; spring < 1e4; spring *= 4.3)
                for (double depth = 0.1; depth < 1e4; depth *= 19.0) {
                    const nt_contact_law law = law_of(models[m], lambda);
                    for (int back = 0; back < 2; back++) {
                        const double error =
                            branch_error(&law, spring, depth, back ? NT_BRANCH_STABLE : NT_BRANCH_APPROACH);
                        if (error > 1e-9)
                            print_message("%d lambda %g spring %g depth %g back %d: %g\n", models[m], lambda, spring,
                                          depth, back, error);
                        worst = larger(worst, error);
                    }
                }
    assert_true(worst < 1e-9);
}

/* D = delta + 4/3 E* sqrt(R) delta^1.5/k_c */
static void hertz_in_closed_form(void **state)
{
    (void)state;
    const nt_contact contact = {20e-9, 1e6, 0.0, 0.0};
    nt_contact_law law;
    assert_int_equal(nt_contact_law_init(&law, NT_HERTZ, &contact), NT_OK);
    double stage[POINTS], force[POINTS], expected[POINTS];
    for (int i = 0; i < POINTS; i++) {
        const double delta = 60e-9 * (i - 20) / POINTS;
        expected[i] = delta > 0.0 ? 4.0 / 3.0 * 1e6 * sqrt(20e-9) * delta * sqrt(delta) : 0.0;
        stage[i] = delta + expected[i] / 0.05;
    }
    const nt_ramp ramp = {0.05, NT_BRANCH_APPROACH, stage, force, POINTS};
    assert_int_equal(nt_contact_law_ramp(&law, &ramp), NT_OK);
    for (int i = 0; i < POINTS; i++)
        assert_within(force[i], expected[i], 1e-13 * expected[POINTS - 1]);
    const nt_ramp alone = {0.05, NT_BRANCH_STABLE, stage, force, 5}; /* nothing but free places */
    assert_int_equal(nt_contact_law_ramp(&law, &alone), NT_OK);
    assert_true(force[0] == 0.0 && force[4] == 0.0);
}

/* The order of the places does not matter. */
static void places_in_any_order(void **state)
{
    (void)state;
    const nt_contact_law law = law_of(NT_MAUGIS, 2.0);
    double stage[POINTS], shuffled[POINTS], force[POINTS], again[POINTS];
    for (int i = 0; i < POINTS; i++)
        stage[i] = -3.0 + 8.0 * i / POINTS;
    for (int i = 0; i < POINTS; i++)
        shuffled[i] = stage[7 * i % POINTS];
    const nt_ramp one = {0.7, NT_BRANCH_STABLE, stage, force, POINTS};
    const nt_ramp other = {0.7, NT_BRANCH_STABLE, shuffled, again, POINTS};
    assert_int_equal(nt_contact_law_ramp(&law, &one), NT_OK);
    assert_int_equal(nt_contact_law_ramp(&law, &other), NT_OK);
    for (int i = 0; i < POINTS; i++)
        assert_within(again[i], force[7 * i % POINTS], 1e-14);
}

static void refuses_what_is_no_movement(void **state)
{
    (void)state;
    const nt_contact_law law = law_of(NT_MAUGIS, 1.0);
    double stage[2] = {1.0, NAN}, force[2];
    assert_int_equal(nt_contact_law_ramp(&law, &(nt_ramp){1.0, NT_BRANCH_STABLE, stage, force, 2}), NT_E_NOT_FINITE);
    assert_int_equal(nt_contact_law_ramp(&law, &(nt_ramp){NAN, NT_BRANCH_STABLE, stage, force, 1}), NT_E_NOT_FINITE);
    assert_int_equal(nt_contact_law_ramp(&law, &(nt_ramp){0.0, NT_BRANCH_STABLE, stage, force, 1}), NT_E_RANGE);
    assert_int_equal(nt_contact_law_ramp(&law, &(nt_ramp){1.0, NT_BRANCH_UNSTABLE, stage, force, 1}), NT_E_ARGUMENT);
    assert_int_equal(nt_contact_law_ramp(&law, &(nt_ramp){1.0, NT_BRANCH_STABLE, stage, force, 0}), NT_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_force_is_an_equilibrium),
        cmocka_unit_test(hertz_in_closed_form),
        cmocka_unit_test(places_in_any_order),
        cmocka_unit_test(refuses_what_is_no_movement),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
