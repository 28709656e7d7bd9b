/* SPDX-License-Identifier: BSD-3-Clause
 * While nothing runs: where a hand that is not simulated goes moves no stage and is kept as an event, and what clients
 * ask is done. */
#define _POSIX_C_SOURCE 200809L

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "internal/session.h"
#include "larger.h"
#include "nanotouch/frames.h"
#include "session_fixture.h"

enum { MOST = 65536, EVENTS = 64 };
static nt_record records[MOST];
static nt_event events[EVENTS];

static void doze(void)
{
    const struct timespec time = {.tv_nsec = 5000000};
    (void)nanosleep(&time, NULL);
}

/* A position device that is moved by the test, in micrometres. */
typedef struct mouse {
    const nt_host *host;
    atomic_int at;
} mouse;

static nt_status open_mouse(void *context, const nt_host *host, nt_problem *problem)
{
    mouse *m = context;
    (void)problem;
    m->host = host;
    return NT_OK;
}

static nt_status describe_mouse(void *context, nt_capabilities *capabilities)
{
    (void)context;
    capabilities->can = 0;
    return NT_OK;
}

/* It takes its time, as devices do: at free pace a test that the system leaves waiting must not find the ring full. */
static nt_status read_mouse(void *context, nt_reading *reading)
{
    const struct timespec time = {.tv_nsec = 20000};
    (void)nanosleep(&time, NULL);
    mouse *m = context;
    ++reading->sequence;
    reading->time = m->host->now(m->host);
    reading->position[NT_Z] = 1e-6 * atomic_load(&m->at);
    reading->valid = 1u << (NT_READS_POSITION + NT_Z);
    return NT_OK;
}

static nt_status write_mouse(void *context, const nt_action *action)
{
    (void)context;
    (void)action;
    return NT_OK;
}

static const nt_backend mouse_backend = {.size = sizeof(nt_backend),
                                         .version = NT_HAL_API_VERSION,
                                         .name = "mouse",
                                         .half = NT_HALF_MASTER,
                                         .open = open_mouse,
                                         .describe = describe_mouse,
                                         .read = read_mouse,
                                         .write = write_mouse};

static nt_session *open_moved_by(mouse *m)
{
    nt_session_setup setup = nt_session_defaults();
    setup.rig.master.gauge = setup.rig.master.motor = 0;
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.master = (nt_hal_choice){&mouse_backend, m};
    return open_session(&setup);
}

static void stand(nt_session *session)
{
    assert_int_equal(nt_session_pause(session, 1), NT_OK);
    while (!nt_session_progress(session).stands)
        doze();
}

static void go_on(nt_session *session, uint64_t ticks)
{
    const uint64_t until = nt_session_progress(session).ticks + ticks;
    assert_int_equal(nt_session_pause(session, 0), NT_OK);
    while (nt_session_progress(session).ticks < until && nt_session_progress(session).runs)
        doze();
}

/* Records and events alone give the same commands: index is what a replay does with the event. */
static void expect_replay(nt_session *session, long count, long asked)
{
    const nt_touch *touch = nt_session_touch(session);
    nt_touch_state at = nt_touch_start(touch, nt_session_master_start(session), 0.0, 0.0);
    long next = 0;
    for (long k = 0; k < count; k++) {
        for (; next < asked && events[next].tick == records[k].tick; ++next) {
            assert_int_equal(events[next].kind, NT_EVENT_INDEX);
            assert_true(events[next].value[0] == records[k].master_position[NT_Z]);
            nt_touch_index(&at, events[next].value[0]);
        }
        const nt_sample sample = sample_of(&records[k]);
        nt_command command;
        nt_touch_step(touch, &at, &sample, &command);
        assert_memory_equal(command.stage_position, records[k].stage_command, sizeof command.stage_position);
        assert_int_equal(command.state, records[k].state);
        assert_int_equal(command.reasons, records[k].reasons);
    }
    assert_int_equal(next, asked);
}

/* 2 mm each time, which is 40 nm of the stage or more: after opening, in two pauses, between two runs. */
static void a_hand_that_moves_while_nothing_runs_moves_no_stage(void **state)
{
    (void)state;
    for (int pace = NT_PACE_FREE; pace <= NT_PACE_WALL; pace++) {
        mouse m = {.at = 0};
        nt_session *session = open_moved_by(&m);
        atomic_store(&m.at, 2000);
        for (int run = 0; run < 2; run++) {
            assert_int_equal(nt_session_start(session, (nt_pace)pace, run == 0 ? 0 : 1000), NT_OK);
            for (int pause = 0; pause < 2 && run == 0; pause++) {
                go_on(session, 500);
                stand(session);
                atomic_fetch_sub(&m.at, 3000);
            }
            if (run == 0)
                go_on(session, 500);
            while (run == 1 && nt_session_progress(session).runs)
                doze();
            assert_int_equal(nt_session_halt(session), NT_OK);
            atomic_fetch_add(&m.at, 2000);
        }
        const long count = nt_session_read(session, records, MOST);
        assert_true(count == (long)nt_session_progress(session).ticks && count < MOST);
        double most = 0.0;
        for (long k = 0; k < count; k++)
            most = larger(most, fabs(records[k].stage_command[NT_Z]));
        assert_true(2e-3 * nt_session_touch(session)->settings.gains.alpha_p > 30e-9);
        assert_true(most < 1e-9);
        const long asked = nt_session_read_events(session, events, EVENTS);
        assert_int_equal(asked, 4);
        expect_replay(session, count, asked);
        nt_session_close(session);
    }
}

/* One that moves between two calls of advance has not been let go of: the stage follows. */
static void between_two_steps_the_stage_follows(void **state)
{
    (void)state;
    mouse m = {.at = 0};
    nt_session *session = open_moved_by(&m);
    run(session, records, 100);
    atomic_store(&m.at, 2000);
    run(session, records + 100, 5000);
    assert_true(records[5099].stage_command[NT_Z] > 10e-9);
    assert_int_equal(nt_session_read_events(session, events, EVENTS), 1); /* that of the first tick */
    expect_replay(session, 5100, 1);
    nt_session_close(session);
}

/* No tick runs, and the answer comes all the same. */
static void clients_are_answered_in_a_pause(void **state)
{
    (void)state;
    const nt_session_setup setup = nt_session_defaults();
    nt_session *session = open_session(&setup);
    nt_client *client = NULL;
    assert_int_equal(nt_session_publish(session, NULL), NT_OK);
    assert_int_equal(nt_client_of(&client, nt_session_frames(session)), NT_OK);
    assert_int_equal(nt_session_start(session, NT_PACE_WALL, 0), NT_OK);
    go_on(session, 100);
    stand(session);
    const uint64_t before = nt_session_progress(session).ticks;
    nt_request request = {.kind = NT_EVENT_CLUTCH, .value = {1.0}};
    nt_answer answer = {.pending = 1};
    assert_int_equal(nt_client_lease(client), NT_OK);
    assert_int_equal(nt_client_post(client, &request), NT_OK);
    for (int i = 0; i < 2000 && answer.pending; i++) {
        doze();
        assert_int_equal(nt_client_poll(client, request.id, &answer), NT_OK);
    }
    assert_true(answer.pending == 0 && answer.status == NT_OK && answer.tick == before);
    assert_int_equal(nt_session_progress(session).ticks, before);
    assert_int_equal(nt_session_halt(session), NT_OK);
    nt_client_close(client);
    nt_session_close(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hand_that_moves_while_nothing_runs_moves_no_stage),
        cmocka_unit_test(between_two_steps_the_stage_follows),
        cmocka_unit_test(clients_are_answered_in_a_pause),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
