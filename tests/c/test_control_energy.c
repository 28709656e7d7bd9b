/* SPDX-License-Identifier: BSD-3-Clause
 * What of a period counts as energy, by its sums, and what is not seen of it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "control/modes.h"
#include "control/observe.h"
#include "plain_touch.h"

/* Energy in and out of a period: the tip's at the operator's scale, or behind a coupling what goes into its spring. */
static void energy_of_a_period(void **unused)
{
    (void)unused;
    for (int i = 0; i < 8; ++i) {
        nt_touch touch = plain(NT_MODE_TOUCH);
        touch.settings.gains.coupling_stiffness = i & 1 ? 0.5 : 0.0;
        touch.rig.master.gauge = !(i & 2);
        touch.rig.master.motor = !(i & 4);
        touch.passivity.credit = i & 2 ? 3.0 : 0.0;
        touch.delay = 2u;
        nt_touch_state state = begun(&touch);
        state.passivity.gain = 0.5;
        state.ticks = 10u;
        state.sent[7][NT_Z] = 5.0; /* 10 - 1 - 2 */
        state.signals.felt_force = 7.0;
        nt_sample sample = read_of(2.0, 3.0, 5.0, 1.5);
        nt_observe(&touch, &state, &sample);
        const double from = state.passivity.energy;
        sample = read_of(6.0, 4.0, 8.0, 2.5);
        state.sent[7][NT_Z] = 5.5;
        nt_observe(&touch, &state, &sample);
        const double in = i & 2 ? (-5.5 + 3.0 * 32.0) * 4.0 : 0.5 * (3.0 + 4.0) * 4.0;
        const double before = i & 1 ? 28.0 : 4.0 * 3.0, after = i & 1 ? 28.0 : 4.0 * 5.0, way = i & 1 ? 4.0 : 3.0 / 0.5;
        assert_true(state.signals.gain_factor == (i & 4 ? 1.0 : 0.5));
        assert_true(state.passivity.energy - from == (i & 4 ? 0.0 : in - 0.5 * (before + after) * way));
    }
}

/* After a gap of any channel nothing is counted, nor with a gauge at its end; the next period begins there. */
static void what_is_not_counted(void **unused)
{
    (void)unused;
    for (int i = 0; i < 5; ++i) {
        nt_touch touch = plain(NT_MODE_TOUCH);
        nt_touch_state state = begun(&touch);
        nt_sample sample = read_of(2.0, 3.0, 5.0, 1.5);
        nt_observe(&touch, &state, &sample);
        const double before = state.passivity.energy;
        uint32_t *const gaps[] = {&state.gaps.position, &state.gaps.force, &state.gaps.slave};
        if (i < 3)
            *gaps[i] = 1u;
        if (i == 3)
            state.supervisor.reasons = NT_REASON_OPERATOR_CLIPPED;
        sample = read_of(6.0, 4.0, 8.0, 2.5);
        nt_observe(&touch, &state, &sample);
        assert_true((state.passivity.energy == before) == (i < 4));
        assert_true(state.passivity.last_hand.position == 6.0 && state.passivity.last_hand.force == 4.0);
        assert_true(state.passivity.last_tip.force == 20.0);
    }
}

/* x and y of a hand that cannot be seen are no number, and no step. */
static void a_hand_that_is_not_seen_sideways(void **unused)
{
    (void)unused;
    nt_touch touch = plain(NT_MODE_TOUCH);
    touch.leads_sideways = 1;
    nt_touch_state state = begun(&touch);
    nt_sample sample = read_of(0.0, 0.0, 0.0, 0.0);
    sample.master_position[NT_X] = 3.0;
    state.supervisor.seen = NT_SEES_SIDEWAYS;
    nt_observe(&touch, &state, &sample);
    assert_true(state.hand_at[NT_X] == 3.0 && state.hand_at[NT_Y] == 0.0);
    state.supervisor.seen = NT_SEES_MASTER;
    nt_observe(&touch, &state, &sample);
    assert_true(isnan(state.hand_at[NT_X]) && isnan(state.hand_at[NT_Y]));
    state.supervisor.seen = NT_SEES_ALL;
    nt_observe(&touch, &state, &sample);
    assert_true(state.hand_at[NT_X] == 3.0);
}

/* A mode is left when the force of the old one is gone. */
static void a_mode_that_is_left(void **unused)
{
    (void)unused;
    nt_touch touch = plain(NT_MODE_TOUCH);
    nt_touch_state state = begun(&touch);
    state.wanted_mode = NT_MODE_TOPOGRAPHY;
    state.phase = NT_PHASE_DONE;
    state.command.motor_force[NT_Z] = 2.0;
    state.fade = (nt_fade){.left = 0.75, .step = 0.5, .from = {0.0, 0.0, 2.0}};
    assert_true(nt_mode_run(&touch, &state) == 0.5 && state.mode == NT_MODE_TOUCH && state.phase == NT_PHASE_DONE);
    assert_true(nt_mode_run(&touch, &state) == 0.0);
    assert_true(state.mode == NT_MODE_TOPOGRAPHY && state.phase == NT_PHASE_DOWN);
}

/* Sideways, too, only where a loop closes through the hand. */
static void energy_sideways_of_a_period(void **unused)
{
    (void)unused;
    for (int i = 0; i < 4; ++i) {
        nt_touch touch = plain(NT_MODE_TOUCH);
        touch.feels_sideways = touch.leads_sideways = 1;
        touch.rig.master.motor = !(i & 1);
        touch.passivity_sideways.credit = 1.0;
        nt_touch_state state = begun(&touch);
        nt_sample sample = read_of(0.0, 0.0, 0.0, 0.0);
        nt_observe(&touch, &state, &sample);
        state.gaps.force = i & 2 ? 1u : 0u;
        sample.master_position[NT_X] = 2.0;
        sample.stage_position[NT_X] = 1.0;
        nt_observe(&touch, &state, &sample);
        assert_true((state.passivity_sideways[NT_X].energy != 0.0) == (i == 0));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_of_a_period),  cmocka_unit_test(energy_sideways_of_a_period),
        cmocka_unit_test(what_is_not_counted), cmocka_unit_test(a_hand_that_is_not_seen_sideways),
        cmocka_unit_test(a_mode_that_is_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
