/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "dynamics/dynamics.h"
#include "internal/random.h"
#include "larger.h"
#include "nanotouch/dynamics.h"

static const nt_hand still; /* a pure force */

static void goes_straight_and_stays(void **state)
{
    (void)state;
    nt_hand_state hand = {0};
    nt_hand_aim(&hand, &(nt_hand_target){
                           .force = {1e-6, -3e-6, 2.0}, .position = {-1e-3, 0.0, 4e-3}, .holds = 1, .duration = 1.0});
    for (int k = 0; k <= 8; k++) { /* steps of 1/4 s, exact in binary: the middle is the middle */
        const double part = k < 4 ? k / 4.0 : 1.0;
        const nt_hand_target now = nt_hand_now(&hand);
        assert_true(fabs(now.force[NT_Z] - 2.0 * part) < 1e-15);
        assert_true(fabs(now.force[NT_X] - 1e-6 * part) < 1e-21 && fabs(now.force[NT_Y] + 3e-6 * part) < 1e-21);
        assert_true(fabs(now.position[NT_X] + 1e-3 * part) < 1e-18 && fabs(now.position[NT_Z] - 4e-3 * part) < 1e-18);
        assert_int_equal(now.holds, 1);
        nt_hand_step(&hand, &still, 0.0, 0.25, NULL);
    }
    const nt_hand_target now = nt_hand_now(&hand);
    assert_true(now.force[NT_Z] == 2.0 && now.force[NT_X] == 1e-6 && now.force[NT_Y] == -3e-6);
    assert_true(now.position[NT_X] == -1e-3 && now.position[NT_Z] == 4e-3); /* exactly there in the end */
}

static void new_aim_starts_where_the_hand_is(void **state)
{
    (void)state;
    nt_hand_state hand = {0};
    nt_hand_aim(&hand, &(nt_hand_target){.force = {[NT_Z] = 4.0}, .duration = 1.0});
    nt_hand_step(&hand, &still, 0.0, 0.5, NULL);
    nt_hand_aim(&hand, &(nt_hand_target){.force = {[NT_Z] = -2.0}, .duration = 2.0});
    assert_true(fabs(nt_hand_now(&hand).force[NT_Z] - 2.0) < 1e-15);
    nt_hand_step(&hand, &still, 0.0, 1.0, NULL);
    assert_true(fabs(nt_hand_now(&hand).force[NT_Z]) < 1e-15);
}

static void no_duration_is_at_once(void **state)
{
    (void)state;
    nt_hand_state hand = {0};
    nt_hand_aim(&hand, &(nt_hand_target){.force = {[NT_Z] = 1.5}});
    assert_true(nt_hand_now(&hand).force[NT_Z] == 1.5);
}

/* After its time constant 1 - 1/e of the way to the master is relaxed, in whatever steps. */
static void rest_position_follows(void **state)
{
    (void)state;
    const nt_hand hand = {.relaxation = 0.5};
    for (int steps = 1; steps < 2000; steps *= 10) {
        nt_hand_state now = {.rest = 1e-3};
        for (int k = 0; k < steps; k++)
            nt_hand_step(&now, &hand, 3e-3, 0.5 / steps, NULL);
        assert_true(fabs(now.rest - (3e-3 - 2e-3 * exp(-1.0))) < 1e-15);
    }
}

/* Uniform within its range, at its rate, from a seed. */
static void adversary_may_do_anything(void **state)
{
    (void)state;
    const nt_hand hand = {.random_force = 5.0, .random_rate = 30.0};
    nt_noise noise = nt_noise_of(1, 0);
    nt_hand_state now = {0};
    int changes = 0;
    double squares = 0.0, largest = 0.0;
    for (int k = 0; k < 1000000; k++) {
        const double last = now.random_force;
        nt_hand_step(&now, &hand, 0.0, 1e-4, &noise);
        changes += now.random_force != last;
        squares += now.random_force * now.random_force;
        largest = larger(largest, fabs(now.random_force));
    }
    assert_true(abs(changes - 3000) < 5 * 55);                    /* 5 sigma of a Poisson count */
    assert_true(fabs(squares / 1e6 / (25.0 / 3.0) - 1.0) < 0.15); /* of 3000 draws: sigma 1.6 % of sqrt */
    assert_true(largest < 5.0 && largest > 4.9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(goes_straight_and_stays),   cmocka_unit_test(new_aim_starts_where_the_hand_is),
        cmocka_unit_test(no_duration_is_at_once),    cmocka_unit_test(rest_position_follows),
        cmocka_unit_test(adversary_may_do_anything),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
