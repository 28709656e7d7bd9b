/* SPDX-License-Identifier: BSD-3-Clause
 * x and y of a period by their sums, what is sent to motor and stage, what may be asked of a running touch: round
 * numbers, each limit at its border. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "control/sideways.h"
#include "nanotouch/touch.h"

#define PERIOD 0.125

static nt_touch plain(void)
{
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    nt_touch touch;
    assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
    touch.period = PERIOD;
    touch.settings.gains.rate = 1.0 / PERIOD;
    touch.settings.limits.lateral_speed = 40.0; /* 5 in a period */
    touch.rig.probe.lateral_stiffness = 3.0;
    touch.speed_filter = 0.5;
    touch.feels_sideways = 1;
    touch.motor_step = 1e9;
    touch.settings.limits.motor_force = 1e9;
    touch.settings.limits.motor_power = 1e9;
    touch.passivity_sideways = (nt_passivity){.dead_zone = 1e9,
                                              .period = PERIOD,
                                              .speed_filter = 1.0,
                                              .speed_limit = 1e9,
                                              .speed_floor = 0.1,
                                              .damping = 2.0,
                                              .credit = 2.0};
    return touch;
}

static nt_touch_state begun(const nt_touch *touch)
{
    nt_touch_state state = nt_touch_start(touch, 0.0, 1.0, 2.0);
    state.signals.scaling = state.rescale.now = state.rescale.wanted = (nt_scaling){0.5, 4.0};
    state.engaged = 1.0;
    state.fade.left = 1.0;
    return state;
}

static void the_hand_leads_while_coupled(void **unused)
{
    (void)unused;
    const nt_touch touch = plain();
    nt_touch_state state = begun(&touch);
    nt_sample sample = {.flags = 0u};
    sample.master_position[NT_X] = 3.0;
    sample.master_position[NT_Y] = -1.0;
    nt_sideways_follow_hand(&touch, &state, &sample); /* seen for the first time */
    assert_true(state.sideways[NT_X] == 0.0 && state.hand_at[NT_X] == 3.0 && state.hand_speed[NT_Y] == 0.0);
    sample.master_position[NT_X] = 5.0;
    sample.master_position[NT_Y] = 0.0;
    nt_sideways_follow_hand(&touch, &state, &sample);
    assert_true(state.sideways[NT_X] == 2.0 && state.sideways[NT_Y] == 1.0);
    assert_true(state.hand_speed[NT_X] == 8.0 && state.hand_speed[NT_Y] == 4.0); /* half of 2/T, of 1/T */
    nt_sideways_follow_hand(&touch, &state, &sample);
    assert_true(state.hand_speed[NT_X] == 4.0 && state.sideways[NT_X] == 2.0);
    sample.master_position[NT_X] = 6.0;
    state.clutch_open = 1;
    nt_sideways_follow_hand(&touch, &state, &sample);
    state.clutch_open = 0;
    state.engaged = 0.0;
    sample.master_position[NT_X] = 7.0;
    nt_sideways_follow_hand(&touch, &state, &sample);
    assert_true(state.sideways[NT_X] == 2.0 && state.hand_at[NT_X] == 7.0);
    sample.master_position[NT_X] = NAN;
    nt_sideways_follow_hand(&touch, &state, &sample);
    assert_true(isnan(state.hand_at[NT_X]) && isfinite(state.hand_speed[NT_X]));
}

static void the_tip_follows_no_faster_than_it_may(void **unused)
{
    (void)unused;
    nt_touch touch = plain();
    touch.leads_sideways = 1;
    nt_touch_state state = begun(&touch);
    state.sideways[NT_X] = 6.0; /* 3 and 4 of the stage: 5, just the limit */
    state.sideways[NT_Y] = 8.0;
    nt_sideways_move(&touch, &state);
    const double *stage = state.command.stage_position;
    assert_true(stage[NT_X] == 4.0 && stage[NT_Y] == 6.0 && state.target_x == 4.0 && state.target_y == 6.0);
    assert_true(state.sideways[NT_X] == 0.0 && state.supervisor.reasons == 0u);
    state.sideways[NT_X] = 12.0; /* half of it is owed */
    state.sideways[NT_Y] = -16.0;
    nt_sideways_move(&touch, &state);
    assert_true(stage[NT_X] == 7.0 && stage[NT_Y] == 2.0 && state.sideways[NT_X] == 6.0 &&
                state.sideways[NT_Y] == -8.0);
    touch.borders[NT_X][1] = 9.0;
    touch.borders[NT_Y][0] = 1.0;
    nt_sideways_move(&touch, &state);
    assert_true(stage[NT_X] == 9.0 && stage[NT_Y] == 1.0 && state.supervisor.reasons == NT_REASON_COMMAND_LIMITED);
}

static void a_path_in_a_straight_line(void **unused)
{
    (void)unused;
    nt_touch touch = plain();
    nt_touch_state state = begun(&touch);
    const double *stage = state.command.stage_position;
    assert_int_equal(nt_touch_aim(&touch, &state, 7.0, 10.0, 0.1), NT_OK); /* 10 at 40 a second take 0.25 s */
    assert_true(state.target_time == 0.25 && state.target_x == 7.0 && state.target_y == 10.0);
    nt_sideways_move(&touch, &state);
    assert_true(stage[NT_X] == 4.0 && stage[NT_Y] == 6.0 && state.target_time == 0.125);
    nt_sideways_move(&touch, &state);
    assert_true(stage[NT_X] == 7.0 && stage[NT_Y] == 10.0 && state.target_time == 0.0);
    nt_sideways_move(&touch, &state);
    assert_true(stage[NT_X] == 7.0 && state.target_time == 0.0);
    nt_touch_aim(&touch, &state, 7.0, 20.0, 1.0);
    assert_true(state.target_time == 1.0);
    touch.settings.limits.lateral_speed = 4.0; /* lowered on the way: 0.5 in a period instead of 1.25 */
    nt_sideways_move(&touch, &state);
    assert_true(stage[NT_Y] == 10.5);
    assert_int_equal(nt_touch_aim(&touch, &state, NAN, 0.0, 1.0), NT_E_NOT_FINITE);
    assert_int_equal(nt_touch_aim(&touch, &state, 0.0, NAN, 1.0), NT_E_NOT_FINITE);
    assert_int_equal(nt_touch_aim(&touch, &state, 0.0, 0.0, NAN), NT_E_NOT_FINITE);
    assert_int_equal(nt_touch_aim(&touch, &state, 0.0, 0.0, -1e-300), NT_E_RANGE);
    assert_int_equal(nt_touch_aim(&touch, &state, stage[NT_X], stage[NT_Y], 0.0), NT_OK);
    assert_true(state.target_time == 0.0);
}

static void what_holds_the_tip_is_felt(void **unused)
{
    (void)unused;
    nt_touch touch = plain();
    nt_touch_state state = begun(&touch);
    nt_sample sample = {.flags = 0u};
    sample.deflection[NT_X] = 2.0;
    sample.deflection[NT_Y] = -1.0;
    state.signals.slave_force = 5.0;
    touch.settings.gains.projection_x = 0.5;
    touch.settings.gains.projection_y = -2.0;
    nt_sideways_read(&touch, &state, &sample);
    assert_true(state.lateral_force[NT_X] == 6.0 && state.lateral_force[NT_Y] == -3.0);
    assert_true(state.projected_force == 5.0 + 3.0 + 6.0);
    touch.rig.probe.lateral_stiffness = 0.0;
    sample.deflection[NT_X] = NAN;
    nt_sideways_read(&touch, &state, &sample);
    assert_true(state.projected_force == 5.0 && state.lateral_force[NT_X] == 6.0);
    state.passivity_sideways[NT_X].gain = 0.5;
    state.engaged = 0.25;
    state.hand_at[NT_X] = state.hand_at[NT_Y] = 0.0;
    nt_sideways_drive(&touch, &state);
    assert_true(state.command.motor_force[NT_X] == 0.5 * 0.25 * 4.0 * 6.0);
    assert_true(state.command.motor_force[NT_Y] == 0.25 * 4.0 * -3.0);
    state.passivity_sideways[NT_Y].damping = 0.5;
    state.passivity_sideways[NT_Y].speed = 3.0;
    nt_sideways_drive(&touch, &state);
    assert_true(state.command.motor_force[NT_Y] == -3.0 - 0.5 * 2.0 * 3.0);
    state.mode = NT_MODE_TOPOGRAPHY; /* no law along x and y: damping is left */
    nt_sideways_drive(&touch, &state);
    assert_true(state.command.motor_force[NT_X] == 0.0 && state.command.motor_force[NT_Y] == -3.0);
    state.fade.left = 0.5; /* and nothing but what is left of the force after an event */
    state.fade.from[NT_X] = 3.0;
    state.command.motor_force[NT_X] = 2.0;
    nt_sideways_drive(&touch, &state);
    assert_true(state.command.motor_force[NT_X] == 1.5);
    state.hand_speed[NT_X] = 0.01; /* braked by half of the master's damping, of a hand that is seen */
    nt_sideways_drive(&touch, &state);
    const double braked = 1.5 - 0.5 * touch.rig.master.damping * 0.01;
    assert_true(fabs(state.command.motor_force[NT_X] - braked) < 1e-15);
    nt_sideways_drive(&touch, &state);
    assert_true(fabs(state.command.motor_force[NT_X] - braked) < 1e-15); /* and what is gone does not come back */
    state.hand_at[NT_X] = NAN;
    state.command.motor_force[NT_X] = 2.0;
    nt_sideways_drive(&touch, &state);
    assert_true(state.command.motor_force[NT_X] == 1.5);
    touch.feels_sideways = 0;
    state.fade.left = 0.25;
    nt_sideways_drive(&touch, &state);
    assert_true(state.command.motor_force[NT_X] == 1.5);
}

/* In: the force that was held, as many ticks ago as it takes; out: what is felt, at the operator's scale. */
static void energy_sideways(void **unused)
{
    (void)unused;
    nt_touch touch = plain();
    touch.delay = 2u;
    nt_touch_state state = begun(&touch);
    state.ticks = 10u;
    state.sent[7][NT_X] = 3.0; /* 10 - 1 - 2 */
    state.lateral_force[NT_X] = 2.0;
    state.engaged = 0.5;
    nt_sample sample = {.flags = 0u};
    sample.stage_position[NT_X] = 4.0;
    sample.master_position[NT_X] = 1.0;
    nt_sideways_watch(&touch, &state, &sample, 1); /* where it is: nothing is counted yet */
    nt_passivity_state *x = &state.passivity_sideways[NT_X];
    assert_true(x->energy == 0.0 && x->last_hand.force == -3.0 && x->last_hand.position == 1.0);
    assert_true(x->last_tip.force == -4.0 && x->last_tip.position == 0.0 && state.stage_at[NT_X] == 4.0);
    sample.stage_position[NT_X] = 5.0;
    sample.master_position[NT_X] = 1.5;
    nt_sideways_watch(&touch, &state, &sample, 1);
    /* (f + b v) dx of the hand, v = 4; less f dx of the tip, which went 2 at the operator's scale */
    assert_true(fabs(x->energy - ((-3.0 + 2.0 * 4.0) * 0.5 - -4.0 * 2.0)) < 1e-12 && x->last_tip.position == 2.0);
    const double energy = x->energy;
    nt_sideways_watch(&touch, &state, &sample, 0);
    assert_true(x->energy == energy);
    state.passivity_sideways[NT_X].gain = 0.25;
    state.passivity_sideways[NT_Y].gain = 0.5;
    state.passivity_sideways[NT_Y].damping = 0.75;
    nt_sideways_watch(&touch, &state, &sample, 0);
    assert_true(state.passivity_sideways[NT_Y].gain == 0.25 && state.passivity_sideways[NT_X].damping == 0.75);
}

static void what_may_be_asked(void **unused)
{
    (void)unused;
    const nt_touch touch = plain();
    nt_touch_state state = begun(&touch);
    state.phase = NT_PHASE_DONE;
    assert_int_equal(nt_touch_set_mode(&state, (nt_mode)(NT_MODE_TAPPING + 1)), NT_E_ARGUMENT);
    assert_int_equal(nt_touch_set_mode(&state, NT_MODE_TAPPING), NT_OK);
    assert_true(state.wanted_mode == NT_MODE_TAPPING && state.phase == NT_PHASE_DONE);
    assert_int_equal(nt_touch_set_mode(&state, NT_MODE_TOUCH), NT_OK);
    assert_true(state.phase == NT_PHASE_DOWN); /* once more */
    const nt_scaling bad[] = {{0.0, 1.0}, {1.0, 0.0}, {-1.0, 1.0}, {1.0, -1.0}};
    for (int i = 0; i < 4; ++i)
        assert_int_equal(nt_touch_rescale(&state, &bad[i]), NT_E_RANGE);
    const nt_scaling unknown[] = {{NAN, 1.0}, {1.0, (double)INFINITY}};
    for (int i = 0; i < 2; ++i)
        assert_int_equal(nt_touch_rescale(&state, &unknown[i]), NT_E_NOT_FINITE);
    assert_true(state.rescale.wanted.alpha_f == 4.0);
    const nt_scaling small = {0.25, 0.5};
    assert_int_equal(nt_touch_rescale(&state, &small), NT_OK);
    assert_true(state.rescale.wanted.alpha_f == 0.5 && state.rescale.wanted.alpha_p == 0.25);
    state.offset = 1.0;
    state.signals.master_position = 8.0;
    state.hand_at[NT_X] = state.hand_at[NT_Y] = 3.0;
    nt_touch_index(&state, 6.0);
    assert_true(state.offset == 1.0 + 0.5 * 2.0 && state.signals.master_position == 6.0);
    assert_true(state.passivity.last_hand.position == 6.0 && isnan(state.hand_at[NT_X]) && isnan(state.hand_at[NT_Y]));
    state.retracted = 3.0;
    state.target_x = state.target_y = state.target_time = 9.0;
    state.phase = NT_PHASE_UP;
    for (int i = 0; i < 2; ++i)
        state.passivity_sideways[i] = (nt_passivity_state){.gain = 0.1, .damping = 0.2, .energy = -0.3};
    state.passivity = state.passivity_sideways[0];
    assert_int_equal(nt_touch_arm(&state, 0), NT_OK);
    assert_true(state.passivity.gain == 1.0 && state.passivity.damping == 0.0 && state.passivity.energy == 0.0);
    for (int i = 0; i < 2; ++i)
        assert_true(state.passivity_sideways[i].gain == 1.0 && state.passivity_sideways[i].damping == 0.0 &&
                    state.passivity_sideways[i].energy == 0.0);
    assert_true(state.retracted == 0.0 && state.phase == NT_PHASE_DOWN && state.target_time == 0.0);
    assert_true(state.target_x == 1.0 && state.target_y == 2.0);
}

/* Over a surface that may rise and fall the indentation is not followed; nothing of the stage is taken from a place
 * that is farther from where it was told than all of its travel. */
static void places_of_the_stage(void **unused)
{
    (void)unused;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    nt_touch touch;
    assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
    const double d = rig.stage.travel;
    const struct {
        double told[2], read[2];
        uint32_t reasons;
    } cases[] = {{{0.7 * d, 0.7 * d}, {0.7 * d, 0.7 * d}, 0u},
                 {{0.0, 0.0}, {d, 0.0}, 0u},
                 {{0.0, 0.0}, {0.0, -d}, 0u},
                 {{0.0, 0.0}, {0.8 * d, 0.61 * d}, NT_REASON_INVALID},
                 {{0.0, 0.5 * d}, {0.0, -0.51 * d}, NT_REASON_INVALID},
                 {{0.5 * d, 0.0}, {-0.51 * d, 0.0}, NT_REASON_INVALID}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        nt_touch_state state = nt_touch_start(&touch, 0.0, cases[i].told[0], cases[i].told[1]);
        const nt_sample sample = {.stage_position = {cases[i].read[0], cases[i].read[1], 0.0}};
        nt_command command;
        nt_touch_step(&touch, &state, &sample, &command);
        assert_int_equal(command.reasons & NT_REASON_INVALID, cases[i].reasons);
    }
    for (int i = 0; i < 5; ++i) { /* owed along x or y, or on the way to somewhere else */
        nt_touch_state state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
        state.supervisor.surface = 0.0;
        state.supervisor.expected = state.reference = 10e-9;
        state.sideways[NT_X] = i == 1 ? 1e-3 : 0.0;
        state.sideways[NT_Y] = i == 2 ? 1e-3 : 0.0;
        state.target_x = i == 3 ? 1e-9 : 0.0;
        state.target_y = i == 4 ? 1e-9 : 0.0;
        nt_sample sample = {.stage_position = {0.0, 0.0, 10e-9}};
        sample.deflection[NT_Z] = 50.0 * touch.supervisor.free_force / rig.probe.spring_constant * 0.1;
        nt_command command;
        nt_touch_step(&touch, &state, &sample, &command);
        const double travel = 10e-9 - sample.deflection[NT_Z];
        assert_true(fabs(state.supervisor.indentation - (i ? 0.0 : travel)) < 1e-20);
    }
}

static nt_effort every_other(void *context, const nt_gains *gains, const nt_signals *signals)
{
    int *calls = context;
    (void)gains;
    return (nt_effort){++*calls % 2 ? (double)NAN : 0.0, signals->target};
}

/* A law that gives no number holds; only twice in a row does it retract. */
static void a_law_without_a_number_now_and_then(void **unused)
{
    (void)unused;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    int calls = 0;
    settings.control = (nt_control){NT_CONTROL_OWN, every_other, &calls};
    nt_touch touch;
    assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
    nt_touch_state state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
    for (int k = 0; k < 8; ++k) {
        const nt_sample sample = {.flags = 0u};
        nt_command command;
        nt_touch_step(&touch, &state, &sample, &command);
        assert_int_equal(command.state, k % 2 ? NT_RUN : NT_HOLD);
    }
}

/* What was sent is remembered by its tick; an observer that has nothing left to take holds a touch, and no other mode.
 */
static void what_a_period_leaves(void **unused)
{
    (void)unused;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    const nt_mode modes[] = {NT_MODE_TOUCH, NT_MODE_TOPOGRAPHY};
    for (int i = 0; i < 2; ++i) {
        nt_touch touch;
        assert_int_equal(nt_touch_make(&touch, &rig, &settings, modes[i], NULL), NT_OK);
        nt_touch_state state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
        state.ticks = NT_TOUCH_SENT + 3u;
        state.command.motor_force[NT_X] = 1.0;
        state.command.motor_force[NT_Y] = 2.0;
        state.passivity.gain = 0.01;
        state.passivity.damping = 1.0;
        const nt_sample sample = {.flags = 0u};
        nt_command command;
        nt_touch_step(&touch, &state, &sample, &command);
        assert_true(state.sent[3][NT_X] == 1.0 && state.sent[3][NT_Y] == 2.0);
        assert_true(state.sent[3][NT_Z] == command.motor_force[NT_Z]);
        assert_int_equal(command.reasons & NT_REASON_UNSTABLE, i ? 0u : NT_REASON_UNSTABLE);
        assert_int_equal(command.reasons & NT_REASON_BACKED_OFF, NT_REASON_BACKED_OFF);
        assert_true(state.since == (i ? 0u : NT_TOUCH_SENT + 3u) && state.ticks == NT_TOUCH_SENT + 4u);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hand_leads_while_coupled),
        cmocka_unit_test(the_tip_follows_no_faster_than_it_may),
        cmocka_unit_test(a_path_in_a_straight_line),
        cmocka_unit_test(what_holds_the_tip_is_felt),
        cmocka_unit_test(energy_sideways),
        cmocka_unit_test(what_may_be_asked),
        cmocka_unit_test(places_of_the_stage),
        cmocka_unit_test(what_a_period_leaves),
        cmocka_unit_test(a_law_without_a_number_now_and_then),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
