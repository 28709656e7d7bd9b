/* SPDX-License-Identifier: BSD-3-Clause
 * A session that others watch and ask: what it records does not depend on who watches, and what they ask is prepared,
 * applied and answered. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "internal/observer.h"
#include "internal/session.h"
#include "nanotouch/advanced/observer.h"
#include "session_fixture.h"

enum { TICKS = 20000, OBSERVERS = 3 };
static nt_record alone[TICKS], watched[TICKS];

static nt_session *open_pushed(void)
{
    nt_session_setup setup = nt_session_defaults();
    setup.clearance = 20e-9;
    nt_session *session = open_session(&setup);
    const nt_input input = {.operator_force = {[NT_Z] = 1.0}, .duration = 0.5};
    assert_int_equal(nt_session_aim(session, &input, NULL), NT_OK);
    return session;
}

/* One observer reads everything, one now and then, one is closed on the way. */
static void watching_changes_nothing(void **state)
{
    (void)state;
    nt_session *session = open_pushed();
    run(session, alone, TICKS);
    nt_session_close(session);
    session = open_pushed();
    assert_int_equal(nt_session_publish(session, NULL), NT_OK);
    assert_int_equal(nt_session_publish(session, NULL), NT_E_STATE); /* once */
    nt_observer *observers[OBSERVERS];
    for (int i = 0; i < OBSERVERS; i++)
        assert_int_equal(nt_observer_of(&observers[i], nt_session_frames(session)), NT_OK);
    static nt_frame frames[1000];
    long read = 0;
    for (int block = 0; block < TICKS / 1000; block++) {
        run(session, &watched[1000 * block], 1000);
        const long got = nt_observer_read(observers[0], frames, 1000);
        assert_int_equal(got, 1000);
        for (long i = 0; i < got; i++) {
            const nt_record *record = &watched[read + i];
            assert_int_equal(frames[i].sequence, record->tick);
            assert_true(frames[i].deflection == record->deflection[NT_Z] && frames[i].gap == record->gap &&
                        frames[i].state == record->state && frames[i].tip_force[NT_Z] == record->tip_force[NT_Z]);
        }
        read += got;
        if (block == 5)
            nt_observer_close(observers[2]);
        if (block % 7 == 0)
            assert_int_equal(nt_observer_newest(observers[1], frames), 1);
    }
    assert_memory_equal(alone, watched, sizeof alone);
    nt_observer_close(observers[0]);
    nt_observer_close(observers[1]);
    nt_session_close(session);
}

static nt_answer outcome(nt_session *session, nt_client *client, nt_request request)
{
    nt_answer answer = {.pending = 1};
    assert_int_equal(nt_client_lease(client), NT_OK);
    assert_int_equal(nt_client_post(client, &request), NT_OK);
    const uint64_t latest = nt_session_progress(session).ticks + 200000; /* twenty seconds of the session */
    while (answer.pending && nt_session_progress(session).ticks < latest) {
        if (!nt_session_progress(session).runs)
            run(session, watched, 2);
        assert_int_equal(nt_client_poll(client, request.id, &answer), NT_OK);
    }
    assert_int_equal(answer.pending, 0);
    return answer;
}

static uint32_t number_of(const nt_field *(*fields_of)(int *count), const char *name)
{
    int count;
    const nt_field *fields = fields_of(&count);
    uint32_t number = 0;
    while (strcmp(fields[number].name, name) != 0)
        ++number;
    return number;
}

static void check_answers(nt_session *session, nt_client *client)
{
    const uint32_t gain = number_of(nt_settings_fields, "gains.force_gain");
    const uint32_t modulus = number_of(nt_scene_fields, "sample.youngs_modulus");
    const nt_request mode = {.kind = NT_EVENT_MODE, .value = {NT_MODE_APPROACH}};
    assert_int_equal(outcome(session, client, mode).status, NT_OK);
    const nt_request bad_mode = {.kind = NT_EVENT_MODE, .value = {17.0}};
    assert_int_equal(outcome(session, client, bad_mode).status, NT_E_ARGUMENT);
    const nt_request stiffer = {.kind = NT_EVENT_SETTING, .field = gain, .value = {3.0}};
    assert_int_equal(outcome(session, client, stiffer).status, NT_OK);
    const nt_request wild = {.kind = NT_EVENT_SETTING, .field = gain, .value = {1e5}};
    assert_int_equal(outcome(session, client, wild).status, NT_E_RANGE); /* below the margin */
    const nt_request softer = {.kind = NT_EVENT_SCENE, .field = modulus, .value = {5e10}};
    assert_int_equal(outcome(session, client, softer).status, NT_OK);
    const nt_request nowhere = {.kind = NT_EVENT_SCENE, .field = 4000, .value = {1.0}};
    assert_int_equal(outcome(session, client, nowhere).status, NT_E_ARGUMENT);
    const nt_request unknown = {.kind = 99};
    assert_int_equal(outcome(session, client, unknown).status, NT_E_ARGUMENT);
    const nt_request stop = {.kind = NT_REQUEST_STOP};
    assert_int_equal(outcome(session, client, stop).status, NT_OK);
}

static void check_outcome(nt_session *session)
{
    const nt_session_setup *now = nt_session_setup_of(session);
    assert_true(now->settings.gains.force_gain == 3.0 && now->scene.sample.youngs_modulus == 5e10);
    nt_event events[16];
    const long count = nt_session_read_events(session, events, 16);
    assert_int_equal(count, 3); /* mode, gain, modulus: what was refused is no event */
    run(session, watched, 2);
    assert_int_equal(watched[1].state, NT_LATCHED);
    assert_int_equal(nt_session_arm(session, 1), NT_OK); /* a client's stop is no button that stays pressed */
    run(session, watched, TICKS);
    assert_int_equal(watched[TICKS - 1].state, NT_RUN);
}

static void clients_are_answered(void **state)
{
    (void)state;
    for (int threaded = 0; threaded < 2; threaded++) {
        nt_session_setup setup = nt_session_defaults();
        setup.ring_capacity = 1L << 22;
        nt_session *session = open_session(&setup);
        assert_int_equal(nt_session_publish(session, NULL), NT_OK);
        nt_client *client = NULL;
        assert_int_equal(nt_client_of(&client, nt_session_frames(session)), NT_OK);
        if (threaded)
            assert_int_equal(nt_session_start(session, NT_PACE_WALL, 0), NT_OK);
        check_answers(session, client);
        assert_int_equal(nt_session_halt(session), NT_OK);
        while (nt_session_read(session, watched, TICKS) > 0)
            continue;
        check_outcome(session);
        nt_client_close(client);
        nt_session_close(session);
    }
}

/* It goes there, and no event is kept: the records hold what the hand did. */
static void a_client_leads_the_hand(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    nt_session *session = open_session(&setup);
    nt_client *client = NULL;
    nt_event event;
    assert_int_equal(nt_session_publish(session, NULL), NT_OK);
    assert_int_equal(nt_client_of(&client, nt_session_frames(session)), NT_OK);
    const double from = nt_session_master_start(session), to = from + 2e-3;
    nt_request hand = {.kind = NT_EVENT_AIM, .field = 1, .value = {0.0, 0.0, to, 0.01}};
    assert_int_equal(outcome(session, client, hand).status, NT_OK);
    run(session, watched, 200);
    const double resolution = setup.rig.master.resolution;
    assert_true(fabs(watched[199].master_position[NT_Z] - to) <= resolution);
    hand.value[0] = 1e-3; /* of a master of one axis */
    assert_int_equal(outcome(session, client, hand).status, NT_E_RANGE);
    hand.value[0] = 0.0, hand.value[2] = setup.rig.master.travel; /* half of it lies on either side */
    assert_int_equal(outcome(session, client, hand).status, NT_E_RANGE);
    hand.value[2] = to, hand.value[3] = -1.0;
    assert_int_equal(outcome(session, client, hand).status, NT_E_RANGE);
    assert_int_equal(nt_session_read_events(session, &event, 1), 0);
    nt_client_close(client);
    nt_session_close(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(watching_changes_nothing),
        cmocka_unit_test(clients_are_answered),
        cmocka_unit_test(a_client_leads_the_hand),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
