/* SPDX-License-Identifier: BSD-3-Clause
 * The emergency stop from another thread than the one that advances. Its worth is with the thread sanitizer: cmake
 * --preset tsan. */
#define _POSIX_C_SOURCE 200809L
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>

#include "nanotouch/nanotouch.h"

enum { ROUNDS = 8, BEFORE = 500, MOST = 8192 };
static nt_record records[MOST];

typedef struct advancing {
    nt_session *session;
    atomic_int ended;
    nt_status status;
} advancing;

static void *advance(void *context)
{
    advancing *a = context;
    while (!atomic_load(&a->ended) && a->status == NT_OK) {
        a->status = nt_session_advance(a->session, 1000);
        if (a->status == NT_E_CAPACITY) { /* until the other thread has read */
            a->status = NT_OK;
            sched_yield();
        }
    }
    return NULL;
}

/* Reads until that many ticks have been recorded, and all that there is; returns how many there are now. */
static long read_on(nt_session *session, long known, long needed)
{
    long got = nt_session_read(session, records + known, MOST - known);
    while (known + got < needed) {
        sched_yield();
        got += nt_session_read(session, records + known + got, MOST - known - got);
    }
    return known + got;
}

/* A tick that was under way may have looked at the button just before it was pressed; the one after it may not. */
static void one_press(void)
{
    nt_session_setup setup = nt_session_defaults();
    setup.ring_capacity = 2048;
    advancing a = {.status = NT_OK};
    pthread_t thread;
    assert_int_equal(nt_session_open(&a.session, &setup, NULL), NT_OK);
    assert_int_equal(pthread_create(&thread, NULL, advance, &a), 0);
    const long before = read_on(a.session, 0, BEFORE);
    nt_session_emergency_stop(a.session, 1);
    const long after = read_on(a.session, before, before);
    const long all = read_on(a.session, after, after + 2);
    atomic_store(&a.ended, 1);
    pthread_join(thread, NULL);
    assert_int_equal(a.status, NT_OK);
    long first = 0;
    while (first < all && records[first].state != NT_LATCHED)
        first++;
    assert_true(first >= before && first <= after + 1);
    for (long k = 0; k < all; k++) {
        assert_int_equal(records[k].tick, k);
        assert_int_equal(records[k].flags, k < first ? 0 : NT_SAMPLE_EMERGENCY_STOP);
        assert_int_equal(records[k].state, k < first ? NT_RUN : NT_LATCHED);
    }
    nt_session_close(a.session);
}

static void a_press_while_another_thread_advances_shows_within_a_tick(void **state)
{
    (void)state;
    for (int round = 0; round < ROUNDS; round++)
        one_press();
}

static void a_press_is_not_lost_to_a_quick_release(void **state)
{
    (void)state;
    const nt_session_setup setup = nt_session_defaults();
    nt_session *session = NULL;
    assert_int_equal(nt_session_open(&session, &setup, NULL), NT_OK);
    nt_session_emergency_stop(session, 1);
    nt_session_emergency_stop(session, 0);
    assert_int_equal(nt_session_advance(session, 3), NT_OK);
    assert_int_equal(nt_session_read(session, records, MOST), 3);
    for (int k = 0; k < 3; k++) {
        assert_int_equal(records[k].flags, k == 0 ? NT_SAMPLE_EMERGENCY_STOP : 0); /* it is up again */
        assert_int_equal(records[k].state, NT_LATCHED);
    }
    nt_session_close(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_press_while_another_thread_advances_shows_within_a_tick),
        cmocka_unit_test(a_press_is_not_lost_to_a_quick_release),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
