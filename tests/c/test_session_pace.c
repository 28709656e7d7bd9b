/* SPDX-License-Identifier: BSD-3-Clause
 * A session in its thread, at each pace. What is counted is ticks and their order; a busy machine may take as long as
 * it likes. */
#define _POSIX_C_SOURCE 200809L

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

#include <cmocka.h>

#include "larger.h"
#include "session/state.h"
#include "session_fixture.h"

enum { MOST = 20000 };
static nt_record records[MOST], others[MOST];

static void doze(void)
{
    const struct timespec time = {.tv_nsec = 1000000};
    (void)nanosleep(&time, NULL);
}

static double seconds(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static nt_progress await_end(const nt_session *session)
{
    nt_progress now = nt_session_progress(session);
    while (now.runs) {
        doze();
        now = nt_session_progress(session);
    }
    return now;
}

static uint64_t await_ticks(const nt_session *session, uint64_t ticks)
{
    while (nt_session_progress(session).ticks < ticks && nt_session_progress(session).runs)
        doze();
    return nt_session_progress(session).ticks;
}

static nt_session *open_pressing(long ring)
{
    nt_session_setup setup = nt_session_defaults();
    setup.ring_capacity = ring;
    nt_session *session = open_session(&setup);
    push(session, 1.0, 0.2);
    return session;
}

/* The thread gives what nt_session_advance gives, bit for bit, through a ring of 64 and a reader that dawdles. */
static void free_pace_waits_for_its_reader(void **state)
{
    (void)state;
    nt_session *alone = open_pressing(MOST), *session = open_pressing(64);
    run(alone, others, MOST);
    nt_session_close(alone);
    assert_int_equal(nt_session_start(session, NT_PACE_FREE, MOST), NT_OK);
    long got = 0;
    for (int round = 0; got < MOST; round++) {
        got += nt_session_read(session, records + got, 1 + round % 64);
        if (round % 100 == 0)
            doze();
    }
    const nt_progress end = await_end(session);
    assert_true(end.ticks == MOST && end.dropped == 0 && end.status == NT_OK);
    assert_int_equal(nt_session_halt(session), NT_OK);
    assert_memory_equal(records, others, sizeof records);
    nt_session_close(session);
}

/* Without a ring nothing waits. */
static void free_pace_without_a_record_runs_through(void **state)
{
    (void)state;
    nt_session *session = open_pressing(0);
    assert_int_equal(nt_session_start(session, NT_PACE_FREE, MOST), NT_OK);
    assert_int_equal(await_end(session).ticks, MOST);
    assert_int_equal(nt_session_halt(session), NT_OK);
    assert_int_equal(nt_session_read(session, records, MOST), 0);
    nt_session_close(session);
}

static void who_calls_what_while_it_runs(void **state)
{
    (void)state;
    nt_session *session = open_pressing(1024);
    nt_snapshot *snapshot = NULL;
    assert_int_equal(nt_session_halt(session), NT_OK); /* nothing runs */
    assert_int_equal(nt_session_pause(session, 1), NT_E_STATE);
    assert_int_equal(nt_session_start(session, (nt_pace)7, 0), NT_E_ARGUMENT);
    assert_int_equal(nt_session_start(session, NT_PACE_FREE, 0), NT_OK);
    assert_int_equal(nt_session_start(session, NT_PACE_FREE, 0), NT_E_STATE);
    assert_int_equal(nt_session_advance(session, 1), NT_E_STATE);
    assert_int_equal(nt_session_snapshot(session, &snapshot), NT_E_STATE);
    assert_int_equal(nt_session_publish(session, NULL), NT_E_STATE);
    const nt_fault fault = {.kind = NT_FAULT_DEVICE_LOST, .channel = NT_CHANNEL_RIG, .duration = 1.0};
    assert_int_equal(nt_session_inject(session, &fault), NT_E_STATE);
    assert_int_equal(nt_session_halt(session), NT_OK);
    assert_int_equal(nt_session_progress(session).runs, 0);
    nt_session_read(session, records, MOST);
    assert_int_equal(nt_session_advance(session, 1), NT_OK);             /* it goes on by hand ... */
    assert_int_equal(nt_session_start(session, NT_PACE_FREE, 5), NT_OK); /* ... and in a thread again */
    const uint64_t before = await_end(session).ticks;
    assert_int_equal(nt_session_halt(session), NT_OK);
    assert_int_equal(nt_session_progress(session).ticks, before);
    nt_session_close(session); /* or close ends it */
    session = open_pressing(1024);
    assert_int_equal(nt_session_start(session, NT_PACE_WALL, 0), NT_OK);
    nt_session_close(session);
}

static void a_pause_stops_and_steps_on(void **state)
{
    (void)state;
    for (int pace = NT_PACE_FREE; pace <= NT_PACE_WALL; pace++) {
        nt_session *session = open_pressing(0);
        assert_int_equal(nt_session_start(session, (nt_pace)pace, 0), NT_OK);
        assert_int_equal(nt_session_step_on(session, 3), NT_E_STATE); /* it is not paused */
        assert_true(await_ticks(session, 100) >= 100);
        assert_int_equal(nt_session_pause(session, 1), NT_OK);
        while (!nt_session_progress(session).stands) /* the batch that runs ends first */
            doze();
        const uint64_t now = nt_session_progress(session).ticks;
        assert_true(nt_session_progress(session).paused);
        assert_int_equal(nt_session_step_on(session, -1), NT_E_RANGE);
        assert_int_equal(nt_session_step_on(session, 7), NT_OK);
        assert_int_equal(nt_session_step_on(session, 4), NT_OK);
        assert_true(await_ticks(session, now + 11) == now + 11);
        for (int i = 0; i < 20; i++)
            doze();
        assert_int_equal(nt_session_progress(session).ticks, now + 11);                /* and no more */
        assert_int_equal(nt_session_set_mode(session, NT_MODE_APPROACH, NULL), NT_OK); /* requests are heard */
        assert_int_equal(nt_session_progress(session).ticks, now + 11);
        assert_int_equal(nt_session_pause(session, 0), NT_OK);
        assert_true(await_ticks(session, now + 200) >= now + 200);
        assert_int_equal(nt_session_halt(session), NT_OK);
        nt_session_close(session);
    }
}

/* Never ahead of the clock; every tick in its order. */
static void wall_pace_follows_the_clock(void **state)
{
    (void)state;
    nt_session *session = open_pressing(MOST);
    const double T = nt_session_touch(session)->period, begin = seconds();
    assert_int_equal(nt_session_start(session, NT_PACE_WALL, 500), NT_OK);
    for (nt_progress now = {.runs = 1}; now.runs;) {
        now = nt_session_progress(session);
        assert_true((double)now.ticks * T <= seconds() - begin);
        assert_true(now.slowdown >= 1.0);
    }
    assert_int_equal(nt_session_halt(session), NT_OK);
    assert_int_equal(nt_session_read(session, records, MOST), 500);
    for (int k = 0; k < 500; k++)
        assert_true(records[k].tick == (uint64_t)k && records[k].lateness == 0.0);
    assert_true(seconds() - begin >= 500 * T);
    nt_session_close(session);
}

/* What was due before the change counts in full, what comes after it a hundredth. */
/* A position device that has a new reading each 8 ms of the machine's time. Now and then the loop is kept from running
 * for longer than two of them, as a busy machine does. */
typedef struct pointer {
    const nt_host *host;
    nt_reading newest;
    long reads;
} pointer;
#define POINTER_PERIOD 0.008 /* [s] */

static nt_status open_pointer(void *context, const nt_host *host, nt_problem *problem)
{
    (void)problem;
    ((pointer *)context)->host = host;
    return NT_OK;
}

static nt_status describe_pointer(void *context, nt_capabilities *capabilities)
{
    (void)context;
    capabilities->can = NT_IS_EVENT_DRIVEN;
    capabilities->period = POINTER_PERIOD;
    return NT_OK;
}

static nt_status read_pointer(void *context, nt_reading *reading)
{
    pointer *p = context;
    if (++p->reads % 1000 == 0)
        for (int i = 0; i < 20; i++)
            doze();
    const uint64_t sequence = (uint64_t)(seconds() / POINTER_PERIOD);
    if (sequence != p->newest.sequence)
        p->newest = (nt_reading){.size = sizeof p->newest,
                                 .sequence = sequence,
                                 .time = p->host->now(p->host),
                                 .felt = {NAN, NAN, NAN},
                                 .valid = 1u << (NT_READS_POSITION + NT_Z)};
    *reading = p->newest;
    return NT_OK;
}

static nt_status write_pointer(void *context, const nt_action *action)
{
    (void)context, (void)action;
    return NT_OK;
}

/* It slows down instead. */
static void catching_up_makes_no_device_stale(void **state)
{
    (void)state;
    static const nt_backend backend = {.size = sizeof backend,
                                       .version = NT_HAL_API_VERSION,
                                       .name = "pointer",
                                       .half = NT_HALF_MASTER,
                                       .open = open_pointer,
                                       .describe = describe_pointer,
                                       .read = read_pointer,
                                       .write = write_pointer};
    pointer device = {.host = NULL};
    nt_session_setup setup = nt_session_defaults();
    setup.rig.master.motor = setup.rig.master.gauge = 0;
    setup.rig.master.rate = 1.0 / POINTER_PERIOD;
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.master = (nt_hal_choice){&backend, &device};
    nt_session *session = open_session(&setup);
    enum { TICKS = 5000 };
    assert_int_equal(nt_session_start(session, NT_PACE_WALL, TICKS), NT_OK);
    const nt_progress end = await_end(session);
    assert_int_equal(nt_session_halt(session), NT_OK);
    assert_int_equal(nt_session_read(session, records, TICKS), TICKS);
    for (int i = 0; i < TICKS; i++) {
        assert_true(records[i].master_age <= 1.5 * POINTER_PERIOD + 2e-4);
        assert_int_equal(records[i].state, NT_RUN);
    }
    assert_true(end.slowdown > 1.05);
    nt_session_close(session);
}

static void slow_motion_is_slow(void **state)
{
    (void)state;
    nt_session *session = open_pressing(0);
    const double T = nt_session_touch(session)->period, begin = seconds();
    nt_problem problem = {0};
    assert_int_equal(nt_session_set_speed(session, 1.0, NULL), NT_E_STATE); /* nothing runs */
    assert_int_equal(nt_session_start(session, NT_PACE_WALL, 0), NT_OK);
    assert_int_equal(nt_session_set_speed(session, 0.0, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "speed");
    assert_int_equal(nt_session_set_speed(session, (double)NAN, NULL), NT_E_NOT_FINITE);
    assert_int_equal(nt_session_set_speed(session, 0.01, NULL), NT_OK);
    const double until = seconds() - begin;
    const uint64_t enough = nt_session_progress(session).ticks + 20;
    while (nt_session_progress(session).ticks < enough) {
        const double run = (double)nt_session_progress(session).ticks * T;
        assert_true(run <= until + 0.01 * (seconds() - begin));
        doze();
    }
    assert_int_equal(nt_session_halt(session), NT_OK);
    nt_session_close(session);
}

/* A full ring loses the newest records, counts them, and the loop goes on; lateness is the machine's. */
static void hard_pace_counts_what_a_full_ring_drops(void **state)
{
    (void)state;
    nt_session *session = open_pressing(64);
    assert_int_equal(nt_session_start(session, NT_PACE_HARD, 300), NT_OK);
    assert_int_equal(nt_session_pause(session, 1), NT_E_STATE);
    assert_int_equal(nt_session_step_on(session, 1), NT_E_STATE);
    assert_int_equal(nt_session_set_speed(session, 1.0, NULL), NT_E_STATE);
    const nt_progress end = await_end(session);
    assert_true(end.ticks == 300 && end.dropped == 236 && end.status == NT_OK);
    assert_int_equal(nt_session_halt(session), NT_OK);
    assert_int_equal(nt_session_read(session, records, MOST), 64);
    double latest = 0.0;
    for (int k = 0; k < 64; k++) {
        assert_true(records[k].tick == (uint64_t)k && records[k].lateness >= 0.0);
        latest = larger(latest, records[k].lateness);
    }
    assert_true(latest > 0.0 && end.worst_delay >= latest);
    run(session, records, 10); /* by hand there is no lateness, and time goes in ticks again */
    for (int k = 0; k < 10; k++)
        assert_true(records[k].lateness == 0.0 && records[k].age == 0.0 && records[k].master_age == 0.0);
    assert_int_equal(nt_session_progress(session).dropped, 236);
    nt_session_close(session);
}

/* A model that gives no numbers any more ends the thread, which says why. */
static nt_status break_down(void *context, nt_reading *reading)
{
    *reading = (nt_reading){.size = sizeof *reading, .sequence = 1, .valid = (1u << NT_READS) - 1u};
    return ++*(int *)context > 50 ? NT_E_NO_CONVERGENCE : NT_OK;
}

static nt_status take_anything(void *context, const nt_action *action)
{
    (void)context, (void)action;
    return NT_OK;
}

static void a_thread_that_fails_says_why(void **state)
{
    (void)state;
    const nt_backend broken = {.size = sizeof broken,
                               .version = NT_HAL_API_VERSION,
                               .name = "broken",
                               .half = NT_HALF_MASTER,
                               .read = break_down,
                               .write = take_anything};
    for (int pace = NT_PACE_FREE; pace <= NT_PACE_HARD; pace++) {
        int reads = 0;
        nt_session_setup setup = nt_session_defaults();
        setup.preflight = 0;
        setup.master = (nt_hal_choice){&broken, &reads};
        nt_session *session = open_session(&setup);
        session->master.is_model = 1; /* a device that fails would be lost, and latched */
        assert_int_equal(nt_session_start(session, (nt_pace)pace, 0), NT_OK);
        const nt_progress end = await_end(session);
        assert_int_equal(end.status, NT_E_NO_CONVERGENCE);
        assert_int_equal(nt_session_set_mode(session, NT_MODE_CURVE, NULL), NT_OK); /* nobody waits for ever */
        assert_int_equal(nt_session_halt(session), NT_E_NO_CONVERGENCE);
        nt_session_close(session);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_pace_waits_for_its_reader),
        cmocka_unit_test(free_pace_without_a_record_runs_through),
        cmocka_unit_test(who_calls_what_while_it_runs),
        cmocka_unit_test(a_pause_stops_and_steps_on),
        cmocka_unit_test(wall_pace_follows_the_clock),
        cmocka_unit_test(catching_up_makes_no_device_stale),
        cmocka_unit_test(slow_motion_is_slow),
        cmocka_unit_test(hard_pace_counts_what_a_full_ring_drops),
        cmocka_unit_test(a_thread_that_fails_says_why),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
