/* SPDX-License-Identifier: BSD-3-Clause
 * Requests to a session that runs: applied between two ticks, kept as events, and what was measured and asked is all
 * that a replay needs. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "internal/session.h"
#include "session_fixture.h"

enum { MOST = 65536, EVENTS = 64, STANDS = 100 };
static nt_record records[MOST], others[MOST];
static nt_event events[EVENTS];

static nt_session *open_pressing(void)
{
    nt_session_setup setup = nt_session_defaults();
    setup.clearance = 20e-9;
    setup.ring_capacity = MOST;
    nt_session *session = open_session(&setup);
    push(session, 1.0, 0.1);
    return session;
}

static nt_event event_of(nt_event_kind kind, double first)
{
    return (nt_event){.kind = (uint32_t)kind, .value = {first}};
}

static void expect_event(const nt_event *found, const nt_event *asked, uint64_t tick)
{
    assert_int_equal(found->tick, tick);
    assert_int_equal(found->kind, asked->kind);
    assert_memory_equal(found->value, asked->value, sizeof asked->value);
}

static void requests_are_kept_as_events(void **state)
{
    (void)state;
    nt_session *session = open_pressing();
    const nt_gains *gains = &nt_session_touch(session)->settings.gains;
    const nt_scaling finer = {0.8 * gains->alpha_p, gains->alpha_f};
    const nt_input path = {.x = 1e-6, .y = 2e-6, .duration = 0.5};
    run(session, records, 100);
    assert_int_equal(nt_session_aim(session, &path, NULL), NT_OK);
    assert_int_equal(nt_session_read_events(session, events, EVENTS), 0); /* it waits for its tick */
    run(session, records, 50);
    nt_session_clutch(session, 1);
    assert_int_equal(nt_session_set_mode(session, NT_MODE_APPROACH, NULL), NT_OK);
    run(session, records, 1);
    assert_int_equal(nt_session_rescale(session, &finer, NULL), NT_OK);
    assert_int_equal(nt_session_arm(session, 1), NT_OK);
    assert_int_equal(nt_session_read_events(session, events, EVENTS), 5);
    nt_event expected[] = {event_of(NT_EVENT_AIM, 1e-6), event_of(NT_EVENT_CLUTCH, 1.0),
                           event_of(NT_EVENT_MODE, NT_MODE_APPROACH), event_of(NT_EVENT_RESCALE, finer.alpha_p),
                           event_of(NT_EVENT_ARM, 1.0)};
    expected[0].value[1] = 2e-6, expected[0].value[2] = 0.5;
    expected[3].value[1] = finer.alpha_f;
    const uint64_t ticks[] = {100, 150, 150, 151, 151};
    for (int i = 0; i < 5; i++)
        expect_event(&events[i], &expected[i], ticks[i]);
    nt_session_close(session);
}

static void what_is_refused_leaves_no_event(void **state)
{
    (void)state;
    nt_session *session = open_pressing();
    const nt_scaling bad = {-1.0, 1.0};
    nt_problem problem = {0};
    run(session, records, 10);
    const nt_margins before = nt_session_margins(session);
    assert_int_equal(nt_session_set_mode(session, (nt_mode)9, &problem), NT_E_ARGUMENT);
    assert_string_equal(problem.field, "mode");
    assert_int_equal(nt_session_rescale(session, &bad, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "gains.alpha_p");
    assert_int_equal(nt_session_change(session, NT_EVENT_SETTING, "gains.force_gain", 300.0, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "stability margin (R5 noise)");
    assert_true(problem.value < 1.5 && problem.minimum == 1.5);
    assert_int_equal(nt_session_change(session, NT_EVENT_SETTING, "gains.force_gain", -1.0, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "gains.force_gain");
    assert_int_equal(nt_session_change(session, NT_EVENT_SCENE, "sample.youngs_modulus", NAN, &problem),
                     NT_E_NOT_FINITE);
    const char *const fixed[] = {"gains.rate", "gains.delay", "gains.alpha_p", "gains.alpha_f", "no such gain"};
    for (int i = 0; i < 5; i++)
        assert_int_equal(nt_session_change(session, NT_EVENT_SETTING, fixed[i], 1.0, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_change(session, NT_EVENT_MODE, "gains.force_gain", 1.0, NULL), NT_E_ARGUMENT);
    nt_session_emergency_stop(session, 1);
    run(session, records, 1);
    assert_int_equal(nt_session_arm(session, 0), NT_E_STATE); /* only a person at the rig */
    assert_int_equal(nt_session_read_events(session, events, EVENTS), 0);
    const nt_margins after = nt_session_margins(session);
    assert_memory_equal(&before, &after, sizeof before);
    nt_session_close(session);
}

/* The first ticks are those of a session in which nothing is changed; the rest those of one that is changed there by
 * hand: the old law until the swap, the new one from it on. */
static void expect_swap_at(uint64_t tick, long count, nt_event_kind kind, const char *field, double value)
{
    nt_session *session = open_pressing();
    run(session, others, (long)tick);
    assert_memory_equal(records, others, (size_t)tick * sizeof *records);
    assert_int_equal(nt_session_change(session, kind, field, value, NULL), NT_OK);
    run(session, others, count - (long)tick);
    assert_memory_equal(records + tick, others, (size_t)(count - (long)tick) * sizeof *records);
    nt_session_close(session);
}

static void await_ticks(const nt_session *session, uint64_t ticks)
{
    while (nt_session_progress(session).ticks < ticks && nt_session_progress(session).runs) {
    }
}

static void a_change_while_it_runs(void **state)
{
    (void)state;
    static const struct {
        nt_event_kind kind;
        const char *field;
        double value;
    } changes[] = {{NT_EVENT_SETTING, "gains.force_gain", 1.0}, {NT_EVENT_SCENE, "sample.youngs_modulus", 5e9}};
    for (int i = 0; i < 2; i++) {
        nt_session *session = open_pressing();
        const nt_margins before = nt_session_margins(session);
        const nt_guarantee promised = nt_session_guarantee(session);
        const double modulus = nt_session_plan(session)->contact.effective_modulus;
        assert_int_equal(nt_session_start(session, NT_PACE_FREE, 30000), NT_OK);
        await_ticks(session, 8000);
        assert_int_equal(nt_session_change(session, changes[i].kind, changes[i].field, changes[i].value, NULL), NT_OK);
        await_ticks(session, 30000);
        assert_int_equal(nt_session_halt(session), NT_OK);
        const long count = nt_session_read(session, records, MOST);
        assert_int_equal(count, 30000);
        assert_int_equal(nt_session_read_events(session, events, EVENTS), 1);
        assert_true(events[0].kind == changes[i].kind && events[0].value[0] == changes[i].value);
        const nt_margins after = nt_session_margins(session);
        assert_true(after.loop_stiffness < before.loop_stiffness); /* less gain, a softer contact */
        if (i == 1) {
            assert_true(nt_session_plan(session)->contact.effective_modulus < 0.9 * modulus);
            assert_true(nt_session_guarantee(session).indentation > promised.indentation);
            assert_true(nt_session_setup_of(session)->scene.sample.youngs_modulus == 5e9);
        } else {
            assert_true(nt_session_touch(session)->settings.gains.force_gain == 1.0);
        }
        nt_session_close(session);
        expect_swap_at(events[0].tick, count, changes[i].kind, changes[i].field, changes[i].value);
    }
}

/* A replay does not see the scene: what the touch step was made with, scales among it, is left alone. */
static void a_change_of_the_scene_is_none_of_the_touch_step(void **state)
{
    (void)state;
    nt_session *session = open_pressing();
    const nt_gains *gains = &nt_session_touch(session)->settings.gains;
    const nt_scaling finer = {0.5 * gains->alpha_p, gains->alpha_f};
    run(session, records, 100);
    assert_int_equal(nt_session_rescale(session, &finer, NULL), NT_OK);
    const nt_touch before = *nt_session_touch(session);
    assert_int_equal(nt_session_change(session, NT_EVENT_SCENE, "sample.youngs_modulus", 5e9, NULL), NT_OK);
    const nt_touch *after = nt_session_touch(session);
    assert_true(after->passivity.dead_zone == before.passivity.dead_zone);
    assert_true(after->settings.gains.alpha_p == before.settings.gains.alpha_p);
    assert_int_equal(nt_session_change(session, NT_EVENT_SETTING, "gains.force_gain", 1.0, NULL), NT_OK);
    assert_true(nt_session_touch(session)->passivity.dead_zone > 1.5 * before.passivity.dead_zone); /* now it is made */
    nt_session_close(session);
}

static int stands(void)
{
    for (int k = 1; k < STANDS; k++)
        if (records[k].gap != records[0].gap)
            return 0;
    return 1;
}

/* Nothing moves, and the tip sinks into what has become softer all the same. */
static void a_tip_that_stands_feels_a_change_of_the_scene(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    setup.rig.master.gauge = setup.rig.master.motor = 0;
    setup.rig.stage.quality = 0.5;
    setup.probe_model = NT_PROBE_QUASI_STATIC;
    setup.rig.probe.temperature = 0.0;
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.settings.gains.stage_integral = 0.0;
    setup.clearance = 20e-9;
    nt_session *session = open_session(&setup);
    const nt_input input = {
        .master_position = {[NT_Z] = nt_session_master_start(session) + 50e-9 / setup.settings.gains.alpha_p},
        .holds = 1,
        .x = (double)NAN,
        .y = (double)NAN};
    assert_int_equal(nt_session_aim(session, &input, NULL), NT_OK);
    run(session, records, 10000);
    nt_session_clutch(session, 1);
    run(session, records, 30000);
    do { /* to the last bit */
        run(session, records, STANDS);
        assert_true(records[0].tick < 200000);
    } while (!stands());
    const nt_record before = records[STANDS - 1];
    assert_true(before.contact_radius > 0.0 && before.tip_force[NT_Z] > 50e-9);
    assert_int_equal(nt_session_change(session, NT_EVENT_SCENE, "sample.youngs_modulus", 5e9, NULL), NT_OK);
    run(session, records, 100);
    assert_true(records[99].gap < 1.2 * before.gap && before.gap < 0.0); /* deeper */
    assert_true(records[99].contact_radius > 1.1 * before.contact_radius);
    assert_true(records[99].tip_force[NT_Z] < before.tip_force[NT_Z]); /* the cantilever is bent less */
    nt_session_close(session);
}

/* The surface that the map became outlives the plan that it was made for. */
static void a_scene_changes_over_a_map(void **state)
{
    (void)state;
    enum { N = 64 };
    static double heights[N * N];
    for (int i = 0; i < N * N; i++)
        heights[i] = 3e-9 * sin(0.3 * (i % N)) * cos(0.2 * (i / N));
    nt_session_setup setup = nt_session_defaults();
    setup.map = (nt_height_map){.heights = heights, .nx = N, .ny = N, .dx = 10e-9, .dy = 10e-9};
    setup.x = setup.y = 200e-9;
    setup.clearance = 10e-9;
    nt_session *session = open_session(&setup);
    push(session, 1.0, 0.1);
    run(session, records, 5000);
    const double height = records[4999].surface_height;
    const nt_reach reach = nt_session_reach(session);
    assert_int_equal(nt_session_change(session, NT_EVENT_SETTING, "tip.radius", 1e-8, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_change(session, NT_EVENT_SCENE, "tip.radius", 1e-8, NULL), NT_E_ARGUMENT);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(nt_session_change(session, NT_EVENT_SETTING, "gains.force_gain", 1.0 + 0.1 * i, NULL), NT_OK);
        const double modulus = (40.0 + i) * 1e9;
        assert_int_equal(nt_session_change(session, NT_EVENT_SCENE, "sample.youngs_modulus", modulus, NULL), NT_OK);
        run(session, records, 1000);
        assert_true(records[999].surface_height == height);
    }
    const nt_reach after = nt_session_reach(session);
    assert_memory_equal(&reach, &after, sizeof reach);
    nt_session_close(session);
}

/* A request is heard while the loop waits for a reader: the reader may be the one who asks. */
static void a_full_ring_keeps_no_request_waiting(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    setup.ring_capacity = 16;
    nt_session *session = open_session(&setup);
    assert_int_equal(nt_session_start(session, NT_PACE_FREE, 0), NT_OK);
    await_ticks(session, 16);
    assert_int_equal(nt_session_set_mode(session, NT_MODE_CURVE, NULL), NT_OK);
    assert_int_equal(nt_session_halt(session), NT_OK);
    assert_int_equal(nt_session_read_events(session, events, EVENTS), 1);
    assert_int_equal(events[0].tick, 16);
    nt_session_close(session);
}

static void expect_command(const nt_record *record, const nt_command *command, uint64_t tick)
{
    if (memcmp(record->motor_force, command->motor_force, sizeof command->motor_force) != 0 ||
        memcmp(record->stage_command, command->stage_position, sizeof command->stage_position) != 0 ||
        record->state != command->state || record->reasons != command->reasons)
        fail_msg("tick %d: state %u and %u, motor %g and %g", (int)tick, record->state, command->state,
                 record->motor_force[NT_Z], command->motor_force[NT_Z]);
}

static void replay_event(nt_touch *touch, nt_touch_state *state, const nt_event *event)
{
    const nt_scaling scaling = {event->value[0], event->value[1]};
    nt_settings settings = touch->settings;
    int count;
    const nt_field *fields = nt_settings_fields(&count);
    switch (event->kind) {
    case NT_EVENT_AIM:
        assert_int_equal(nt_touch_aim(touch, state, event->value[0], event->value[1], event->value[2]), NT_OK);
        break;
    case NT_EVENT_ARM:
        assert_int_equal(nt_touch_arm(state, event->value[0] != 0.0), NT_OK);
        break;
    case NT_EVENT_MODE:
        assert_int_equal(nt_touch_set_mode(state, (nt_mode)event->value[0]), NT_OK);
        break;
    case NT_EVENT_RESCALE:
        assert_int_equal(nt_touch_rescale(state, &scaling), NT_OK);
        break;
    case NT_EVENT_CLUTCH:
        nt_touch_clutch(state, event->value[0] != 0.0);
        break;
    case NT_EVENT_SETTING:
        nt_field_set(&fields[event->field], &settings, event->value[0]);
        assert_int_equal(nt_touch_make(touch, &touch->rig, &settings, touch->mode, NULL), NT_OK);
        break;
    default:
        assert_int_equal(event->kind, NT_EVENT_SCENE); /* the touch step does not see it */
    }
}

/* Asked in a hurry, while it runs, of everything that there is. */
static void ask_for_everything(nt_session *session)
{
    const nt_gains *gains = &nt_session_touch(session)->settings.gains;
    const nt_scaling finer = {0.9 * gains->alpha_p, gains->alpha_f};
    const nt_input path = {.operator_force = {[NT_Z] = 0.7}, .x = 0.3e-6, .y = -0.1e-6, .duration = 0.2};
    assert_int_equal(nt_session_rescale(session, &finer, NULL), NT_OK);
    assert_int_equal(nt_session_change(session, NT_EVENT_SETTING, "gains.force_gain", 1.5, NULL), NT_OK);
    assert_int_equal(nt_session_aim(session, &path, NULL), NT_OK);
    nt_session_clutch(session, 1);
    await_ticks(session, nt_session_progress(session).ticks + 500);
    nt_session_clutch(session, 0);
    assert_int_equal(nt_session_change(session, NT_EVENT_SCENE, "sample.youngs_modulus", 20e9, NULL), NT_OK);
    await_ticks(session, nt_session_progress(session).ticks + 500);
    nt_session_emergency_stop(session, 1);
    await_ticks(session, nt_session_progress(session).ticks + 500);
    nt_session_emergency_stop(session, 0);
    assert_int_equal(nt_session_arm(session, 1), NT_OK);
    assert_int_equal(nt_session_set_mode(session, NT_MODE_TOPOGRAPHY, NULL), NT_OK);
    assert_int_equal(nt_session_change(session, NT_EVENT_SETTING, "gains.set_point", 0.12e-6, NULL), NT_OK);
}

static void records_and_events_are_a_replay(void **state)
{
    (void)state;
    nt_session *session = open_pressing();
    nt_touch touch = *nt_session_touch(session);
    nt_touch_state at = nt_touch_start(&touch, nt_session_master_start(session), 0.0, 0.0);
    assert_int_equal(nt_session_start(session, NT_PACE_WALL, 0), NT_OK); /* it must still run when it is asked */
    await_ticks(session, 3000);
    ask_for_everything(session);
    await_ticks(session, nt_session_progress(session).ticks + 1000);
    assert_int_equal(nt_session_halt(session), NT_OK);
    const long count = nt_session_read(session, records, MOST);
    assert_true(count == (long)nt_session_progress(session).ticks);
    const long asked = nt_session_read_events(session, events, EVENTS);
    assert_int_equal(asked, 9);
    unsigned seen = 0;
    long next = 0;
    for (long k = 0; k < count; k++) {
        for (; next < asked && events[next].tick == records[k].tick; ++next)
            replay_event(&touch, &at, &events[next]);
        const nt_sample sample = sample_of(&records[k]);
        nt_command command;
        nt_touch_step(&touch, &at, &sample, &command);
        expect_command(&records[k], &command, (uint64_t)k);
        seen |= 1u << records[k].state;
    }
    assert_int_equal(next, asked);
    assert_int_equal(seen & (1u << NT_RUN | 1u << NT_LATCHED), 1u << NT_RUN | 1u << NT_LATCHED);
    nt_session_close(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(requests_are_kept_as_events),
        cmocka_unit_test(what_is_refused_leaves_no_event),
        cmocka_unit_test(a_change_while_it_runs),
        cmocka_unit_test(a_scene_changes_over_a_map),
        cmocka_unit_test(records_and_events_are_a_replay),
        cmocka_unit_test(a_full_ring_keeps_no_request_waiting),
        cmocka_unit_test(a_change_of_the_scene_is_none_of_the_touch_step),
        cmocka_unit_test(a_tip_that_stands_feels_a_change_of_the_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
