/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/dynamics.h"

static void goes_straight_and_stays(void **state)
{
    (void)state;
    nt_hand_state hand = {0};
    nt_hand_aim(&hand, &(nt_hand_target){.force = 2.0, .x = 1e-6, .y = -3e-6, .duration = 1.0});
    for (int k = 0; k <= 8; k++) { /* steps of 1/4 s, exact in binary: the middle is the middle */
        const double part = k < 4 ? k / 4.0 : 1.0;
        const nt_hand_target now = nt_hand_now(&hand);
        assert_true(fabs(now.force - 2.0 * part) < 1e-15);
        assert_true(fabs(now.x - 1e-6 * part) < 1e-21 && fabs(now.y + 3e-6 * part) < 1e-21);
        nt_hand_step(&hand, 0.25);
    }
    const nt_hand_target now = nt_hand_now(&hand);
    assert_true(now.force == 2.0 && now.x == 1e-6 && now.y == -3e-6); /* exactly there in the end */
}

static void new_aim_starts_where_the_hand_is(void **state)
{
    (void)state;
    nt_hand_state hand = {0};
    nt_hand_aim(&hand, &(nt_hand_target){.force = 4.0, .duration = 1.0});
    nt_hand_step(&hand, 0.5);
    nt_hand_aim(&hand, &(nt_hand_target){.force = -2.0, .duration = 2.0});
    assert_true(fabs(nt_hand_now(&hand).force - 2.0) < 1e-15);
    nt_hand_step(&hand, 1.0);
    assert_true(fabs(nt_hand_now(&hand).force) < 1e-15);
}

static void no_duration_is_at_once(void **state)
{
    (void)state;
    nt_hand_state hand = {0};
    nt_hand_aim(&hand, &(nt_hand_target){.force = 1.5});
    assert_true(nt_hand_now(&hand).force == 1.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(goes_straight_and_stays),
        cmocka_unit_test(new_aim_starts_where_the_hand_is),
        cmocka_unit_test(no_duration_is_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
