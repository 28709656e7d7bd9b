/* SPDX-License-Identifier: BSD-3-Clause
 * Timing on a shared machine without real-time scheduling: only what must hold on any machine is asserted. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <signal.h>
#include <sys/time.h>
#include <time.h>

#include "larger.h"
#include "nanotouch/hal.h"

typedef struct witness {
    uint64_t count, last, stop_at;
    double stall; /* that the first step takes [s] */
    int rising;
    double latest, earliest; /* what the steps were told [s] */
} witness;

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static int step(void *context, uint64_t tick, double lateness)
{
    witness *w = context;
    w->latest = larger(w->latest, lateness);
    w->earliest = smaller(w->earliest, lateness);
    if (w->count && tick <= w->last)
        w->rising = 0;
    w->last = tick;
    for (const double end = now() + w->stall; w->count == 0 && now() < end;) {
    }
    w->count++;
    return tick >= w->stop_at;
}

static witness witness_of(void)
{
    return (witness){.stop_at = UINT64_MAX, .rising = 1};
}

/* Each period has a step or is counted as lost; none comes early: 200 periods take 199 ms at least. */
static void every_period_is_accounted_for(void **state)
{
    (void)state;
    witness w = witness_of();
    nt_loop_statistics found;
    const double begin = now();
    assert_int_equal(nt_loop_run(1e-3, 200, step, &w, &found), NT_OK);
    assert_true(now() - begin >= 0.199);
    assert_true(w.rising && w.count >= found.ticks - 1);
    assert_true(found.ticks + found.missed >= 200 && w.count + found.missed >= 200);
    assert_true(w.earliest >= 0.0 && fabs(w.latest - found.worst_delay) < 1e-12);
    assert_true(found.mean_delay >= 0.0 && found.mean_delay <= found.worst_delay);
    assert_true(found.late >= (found.worst_delay > 0.2e-3) && found.late <= found.ticks);
}

/* A step that takes 20 periods costs 19 or more of them; they are skipped, and the number of the period keeps the time.
 */
static void lost_periods_are_skipped_not_caught_up(void **state)
{
    (void)state;
    witness w = witness_of();
    nt_loop_statistics found;
    w.stall = 20e-3;
    assert_int_equal(nt_loop_run(1e-3, 100, step, &w, &found), NT_OK);
    assert_true(w.rising && w.count >= 1);
    assert_true(found.missed >= 19);
    assert_true(w.count + found.missed <= 101);
    assert_true(found.worst_delay >= 19e-3 && found.late >= 1);
}

static void the_step_ends_the_loop(void **state)
{
    (void)state;
    witness w = witness_of();
    w.stop_at = 5;
    assert_int_equal(nt_loop_run(1e-3, 1000, step, &w, NULL), NT_OK);
    assert_true(w.last >= 5 && w.last < 1000 && w.count <= w.last + 1);
}

static void ignore(int number)
{
    (void)number;
}

/* A timer signal every 1.3 ms interrupts the sleep of 5 ms; no step comes early. */
static void signals_do_not_wake_it(void **state)
{
    (void)state;
    const struct itimerval tick = {{0, 1300}, {0, 1300}}, off = {{0, 0}, {0, 0}};
    struct sigaction action = {0}, before;
    witness w = witness_of();
    action.sa_handler = ignore;
    sigaction(SIGALRM, &action, &before);
    setitimer(ITIMER_REAL, &tick, NULL);
    const double begin = now();
    const nt_status status = nt_loop_run(5e-3, 11, step, &w, NULL);
    const double took = now() - begin;
    setitimer(ITIMER_REAL, &off, NULL);
    sigaction(SIGALRM, &before, NULL);
    assert_int_equal(status, NT_OK);
    assert_true(w.last == 10 ? took >= 50e-3 : took >= 45e-3);
}

static void arguments_are_checked(void **state)
{
    (void)state;
    witness w = witness_of();
    nt_loop_statistics found = {.ticks = 77};
    assert_int_equal(nt_loop_run(1e-3, 1, NULL, &w, &found), NT_E_ARGUMENT);
    assert_int_equal(nt_loop_run(NAN, 1, step, &w, &found), NT_E_NOT_FINITE);
    assert_int_equal(nt_loop_run(HUGE_VAL, 1, step, &w, &found), NT_E_NOT_FINITE);
    assert_int_equal(nt_loop_run(0.0, 1, step, &w, &found), NT_E_RANGE);
    assert_int_equal(nt_loop_run(-1e-3, 1, step, &w, &found), NT_E_RANGE);
    assert_int_equal(nt_loop_run(1.0, 1, step, &w, &found), NT_E_RANGE);
    assert_true(w.count == 0 && found.ticks == 77);
    assert_int_equal(nt_loop_run(1e-3, 0, step, &w, &found), NT_OK);
    assert_true(w.count == 0 && found.ticks == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_period_is_accounted_for), cmocka_unit_test(lost_periods_are_skipped_not_caught_up),
        cmocka_unit_test(the_step_ends_the_loop),        cmocka_unit_test(signals_do_not_wake_it),
        cmocka_unit_test(arguments_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
