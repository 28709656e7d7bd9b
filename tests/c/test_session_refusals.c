/* SPDX-License-Identifier: BSD-3-Clause
 * What a session refuses: calls from within itself or from another process, arguments that are not there, requests of
 * clients with numbers that mean nothing, setups that contradict themselves. It goes on after each. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include <sys/wait.h>
#include <unistd.h>

#include "internal/observer.h"
#include "internal/session.h"
#include "nanotouch/advanced/observer.h"
#include "session_fixture.h"

enum { TICKS = 64 };
static nt_record records[TICKS];
static nt_event events[TICKS];

static nt_session_setup plain_setup(void)
{
    nt_session_setup setup = nt_session_defaults();
    setup.preflight = 0;
    setup.ring_capacity = TICKS;
    return setup;
}

static void what_is_not_there(void **state)
{
    (void)state;
    const nt_session_setup setup = plain_setup();
    nt_session *session = open_session(&setup), *none = NULL;
    nt_snapshot *snapshot = NULL;
    nt_session_particles particles;
    nt_client *client = NULL;
    nt_observer *observer = NULL;
    const nt_fault fault = {.kind = NT_FAULT_NAN, .channel = NT_CHANNEL_DEFLECTION};
    const nt_input input = {.x = (double)NAN, .y = (double)NAN};
    assert_int_equal(nt_session_open(NULL, &setup, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_open(&none, NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_aim(NULL, &input, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_aim(session, NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_snapshot(NULL, &snapshot), NT_E_ARGUMENT);
    assert_int_equal(nt_session_snapshot(session, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_restore(session, NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_restore(NULL, NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_inject(NULL, &fault), NT_E_ARGUMENT);
    assert_int_equal(nt_session_inject(session, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_read_particles(NULL, &particles), NT_E_ARGUMENT);
    assert_int_equal(nt_session_read_particles(session, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_read_particles(session, &particles), NT_E_UNSUPPORTED);
    assert_int_equal(nt_session_publish(NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_start(NULL, NT_PACE_FREE, 1), NT_E_ARGUMENT);
    assert_int_equal(nt_session_start(session, (nt_pace)9, 1), NT_E_ARGUMENT);
    assert_int_equal(nt_client_of(NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_client_of(&client, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_client_attach(NULL, "a"), NT_E_ARGUMENT);
    assert_int_equal(nt_client_attach(&client, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_observer_of(NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_observer_of(&observer, NULL), NT_E_ARGUMENT);
    run(session, records, 10);
    assert_int_equal(nt_session_advance(session, 5), NT_OK);
    assert_int_equal(nt_session_read(NULL, records, 5) + nt_session_read(session, NULL, 5), 0);
    assert_int_equal(nt_session_read(session, records, 0) + nt_session_read(session, records, -1), 0);
    assert_int_equal(nt_session_read_events(NULL, events, 5) + nt_session_read_events(session, NULL, 5), 0);
    assert_int_equal(nt_session_read_events(session, events, 0), 0);
    assert_int_equal(nt_session_read(session, records, TICKS), 5);
    assert_null(nt_session_dents(session));
    assert_false(nt_session_is_dynamic(session));
    nt_session_close(session);
    nt_session_close(NULL);
}

/* Over a flat the stage's own range is what borders where the tip is sent; a request of another thread, too. */
static void places_that_no_stage_reaches(void **state)
{
    (void)state;
    const nt_session_setup setup = plain_setup();
    nt_session *session = open_session(&setup);
    static const double far[][2] = {{1e9, 0.0}, {0.0, -1e9}, {0.1001, 0.0}, {0.0, (double)NAN}};
    for (int i = 0; i < 4; i++) {
        const nt_input input = {.x = far[i][0], .y = far[i][1]};
        nt_problem problem = {0};
        assert_int_equal(nt_session_aim(session, &input, &problem), i == 3 ? NT_E_NOT_FINITE : NT_E_RANGE);
        assert_string_equal(problem.field, i == 0 || i == 2 ? "input.x" : "input.y");
        assert_string_equal(problem.unit, "m");
        assert_true(problem.minimum == -0.1 && problem.maximum == 0.1);
    }
    const nt_input within = {.x = 0.0999, .y = -0.1};
    assert_int_equal(nt_session_aim(session, &within, NULL), NT_OK);
    nt_session_close(session);
}

/* A law of one's own that calls its session back, which it must not. */
typedef struct caller {
    nt_session *session;
    int calls, refused;
} caller;

static nt_effort calls_back(void *context, const nt_gains *gains, const nt_signals *s)
{
    caller *law = context;
    (void)gains;
    if (law->session) {
        nt_snapshot *snapshot = NULL;
        ++law->calls;
        law->refused += nt_session_advance(law->session, 1) == NT_E_STATE &&
                        nt_session_snapshot(law->session, &snapshot) == NT_E_STATE &&
                        nt_session_publish(law->session, NULL) == NT_E_STATE &&
                        nt_session_start(law->session, NT_PACE_FREE, 1) == NT_E_STATE &&
                        nt_session_arm(law->session, 1) == NT_E_STATE && nt_session_runs_here(law->session);
        nt_session_close(law->session); /* nothing happens */
    }
    return (nt_effort){-s->scaling.alpha_f * s->felt_force, s->target};
}

static void a_law_cannot_run_its_own_session(void **state)
{
    (void)state;
    nt_session_setup setup = plain_setup();
    caller law = {0};
    setup.settings.control = (nt_control){NT_CONTROL_OWN, calls_back, &law};
    nt_session *session = open_session(&setup);
    assert_false(nt_session_runs_here(session));
    law.session = session;
    run(session, records, 20);
    assert_true(law.calls > 0 && law.refused == law.calls);
    law.session = NULL;
    nt_session_close(session);
}

/* A copy by fork shows another process's frames: it neither runs nor starts them. */
static void a_forked_copy_does_not_publish(void **state)
{
    (void)state;
    char name[NT_NAME_SIZE];
    const nt_session_setup setup = plain_setup();
    nt_session *session = open_session(&setup);
    snprintf(name, sizeof name, "test-refusals-%ld", (long)getpid());
    assert_int_equal(nt_session_publish(session, name), NT_OK);
    assert_int_equal(nt_session_publish(session, NULL), NT_E_STATE);
    const pid_t child = fork();
    if (child == 0)
        _exit(nt_session_advance(session, 1) == NT_E_STATE && nt_session_start(session, NT_PACE_FREE, 1) == NT_E_STATE
                  ? 0
                  : 1);
    int how = -1;
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_int_equal(how, 0);
    run(session, records, 5);
    nt_session_close(session);
}

static nt_status asked(nt_session *session, nt_client *client, nt_request request)
{
    nt_answer answer;
    assert_int_equal(nt_client_lease(client), NT_OK);
    assert_int_equal(nt_client_post(client, &request), NT_OK);
    run(session, records, 3);
    assert_int_equal(nt_client_poll(client, request.id, &answer), NT_OK);
    assert_int_equal(answer.pending, 0);
    return (nt_status)answer.status;
}

/* Numbers in a request are whatever a client has written. */
static void requests_with_numbers_that_mean_nothing(void **state)
{
    (void)state;
    const nt_session_setup setup = plain_setup();
    nt_session *session = open_session(&setup);
    nt_client *client = NULL;
    assert_int_equal(nt_session_publish(session, NULL), NT_OK);
    assert_int_equal(nt_client_of(&client, nt_session_frames(session)), NT_OK);
    static const struct {
        uint32_t kind;
        double value[4];
        nt_status status;
    } rows[] = {{NT_EVENT_ARM, {0.5}, NT_E_RANGE},
                {NT_EVENT_ARM, {(double)NAN}, NT_E_NOT_FINITE},
                {NT_EVENT_CLUTCH, {2.0}, NT_E_RANGE},
                {NT_EVENT_CLUTCH, {0.0}, NT_OK},
                {NT_EVENT_ARM, {1.0}, NT_OK},
                {NT_EVENT_MODE, {0.5}, NT_E_ARGUMENT},
                {NT_EVENT_MODE, {-1.0}, NT_E_ARGUMENT},
                {NT_EVENT_MODE, {99.0}, NT_E_ARGUMENT},
                {NT_EVENT_MODE, {NT_MODE_APPROACH}, NT_OK},
                {NT_EVENT_REWIND, {-1.0}, NT_E_UNSUPPORTED},
                {NT_EVENT_REWIND, {(double)NAN}, NT_E_UNSUPPORTED},
                {NT_EVENT_UNDENT, {0.0}, NT_E_UNSUPPORTED},
                {NT_EVENT_LAY, {0.0}, NT_E_UNSUPPORTED},
                {NT_EVENT_LAY_ROD, {0.0}, NT_E_UNSUPPORTED},
                {NT_EVENT_DENT, {0.0}, NT_E_ARGUMENT},
                {NT_EVENT_KINDS, {0.0}, NT_E_ARGUMENT},
                {NT_EVENT_AIM, {(double)NAN, 0.0, 1.0}, NT_E_NOT_FINITE},
                {NT_EVENT_AIM, {0.0, 0.0, -1.0}, NT_E_RANGE},
                {NT_EVENT_AIM, {0.0, 0.0, HUGE_VAL}, NT_E_NOT_FINITE},
                {NT_EVENT_AIM, {1e-7, 0.0, 1.0}, NT_OK}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        nt_request request = {.kind = rows[i].kind};
        memcpy(request.value, rows[i].value, sizeof request.value);
        const nt_status found = asked(session, client, request);
        if (found != rows[i].status)
            fail_msg("request %zu: %s", i, nt_status_message(found));
    }
    nt_client_close(client);
    nt_session_close(session);
}

static void speeds_and_times_that_cannot_be(void **state)
{
    (void)state;
    const nt_session_setup setup = plain_setup();
    nt_session *session = open_session(&setup);
    const double none[] = {(double)NAN, -1.0, HUGE_VAL};
    nt_problem problem;
    for (int i = 0; i < 3; i++) {
        assert_true(nt_session_rewind(session, none[i], &problem) != NT_OK);
        assert_string_equal(problem.field, "rewind");
        const nt_input input = {.x = (double)NAN, .y = (double)NAN, .duration = none[i]};
        assert_true(nt_session_aim(session, &input, &problem) != NT_OK);
    }
    const nt_input half = {.x = 0.0, .y = (double)NAN, .duration = 0.1}, path = {.x = 1e-7, .y = 0.0, .duration = 0.1};
    assert_int_equal(nt_session_aim(session, &half, &problem), NT_E_NOT_FINITE);
    assert_int_equal(nt_session_aim(session, &path, &problem), NT_OK);
    const nt_fault before = {.kind = NT_FAULT_NAN, .channel = NT_CHANNEL_DEFLECTION, .start = -1.0};
    assert_int_equal(nt_session_inject(session, &before), NT_E_RANGE);
    run(session, records, 5);
    nt_session_close(session);
}

static void expect_refused(const nt_session_setup *setup, const char *field)
{
    nt_session *session = NULL;
    nt_problem problem = {0};
    assert_true(nt_session_open(&session, setup, &problem) != NT_OK);
    assert_null(session);
    assert_string_equal(problem.field, field);
}

static void setups_that_contradict_themselves(void **state)
{
    (void)state;
    int mine = 0;
    nt_session_setup setup = plain_setup();
    setup.master.context = &mine;
    expect_refused(&setup, "master.context or master_option without a backend");
    setup = plain_setup();
    setup.slave.context = &mine;
    expect_refused(&setup, "slave.context or slave_option without a backend");
    setup = plain_setup();
    setup.master_option = "COM3";
    expect_refused(&setup, "master.context or master_option without a backend");
    setup = plain_setup();
    setup.slave_option = "COM3";
    expect_refused(&setup, "slave.context or slave_option without a backend");
    const double steps[] = {-0.1, 2e9, (double)NAN, HUGE_VAL};
    for (int i = 0; i < 4; i++) {
        setup = plain_setup();
        setup.substep = steps[i];
        expect_refused(&setup, "substep");
    }
    setup = plain_setup();
    setup.substep = 0.2;
    setup.probe_model = NT_PROBE_QUASI_STATIC;
    expect_refused(&setup, "substep where no cantilever is simulated as dynamic");
    setup = plain_setup();
    setup.map.ny = 4; /* a size, and no heights */
    nt_session *session = NULL;
    assert_true(nt_session_open(&session, &setup, NULL) != NT_OK);
    setup.map.ny = 0;
    setup.map.nx = 4;
    assert_true(nt_session_open(&session, &setup, NULL) != NT_OK);
    assert_null(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_not_there),
        cmocka_unit_test(places_that_no_stage_reaches),
        cmocka_unit_test(a_law_cannot_run_its_own_session),
        cmocka_unit_test(a_forked_copy_does_not_publish),
        cmocka_unit_test(requests_with_numbers_that_mean_nothing),
        cmocka_unit_test(speeds_and_times_that_cannot_be),
        cmocka_unit_test(setups_that_contradict_themselves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
