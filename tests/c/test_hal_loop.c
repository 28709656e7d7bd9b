/* SPDX-License-Identifier: BSD-3-Clause
 * The loop on a clock that the test moves: this program's own clock_gettime and clock_nanosleep come before those of
 * the C library. No machine is too busy for it. */
#define _GNU_SOURCE
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <errno.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include "larger.h"
#include "nanotouch/hal.h"

#define MS 1000000       /* [ns] */
#define BEGIN 1999999000 /* just below a full second, for carries [ns] */
#define OF_THE_PROGRAM __attribute__((visibility("default")))

/* A clock that stands still unless somebody sleeps or stalls. */
static struct {
    int on, broken;           /* off: the machine's own; broken: fails */
    int64_t now;              /* [ns] */
    const int64_t *oversleep; /* of each sleep in turn [ns] */
    int oversleeps, sleeps;
    int signals; /* that interrupt each sleep before it ends */
} fake;

OF_THE_PROGRAM int clock_gettime(clockid_t id, struct timespec *time)
{
    if (!fake.on || id != CLOCK_MONOTONIC)
        return (int)syscall(SYS_clock_gettime, id, time);
    *time = (struct timespec){fake.now / 1000000000, fake.now % 1000000000};
    return fake.broken ? -1 : 0;
}

OF_THE_PROGRAM int clock_nanosleep(clockid_t id, int flags, const struct timespec *until, struct timespec *left)
{
    static int interrupted;
    const int64_t deadline = until->tv_sec * 1000000000LL + until->tv_nsec;
    if (!fake.on)
        return syscall(SYS_clock_nanosleep, id, flags, until, left) == 0 ? 0 : errno;
    assert_true(id == CLOCK_MONOTONIC && flags == TIMER_ABSTIME && until->tv_nsec < 1000000000);
    if (interrupted < fake.signals && deadline > fake.now) {
        interrupted++;
        fake.now += (deadline - fake.now) / 2;
        return EINTR;
    }
    interrupted = 0;
    fake.now = deadline > fake.now ? deadline : fake.now;
    fake.now += fake.sleeps < fake.oversleeps ? fake.oversleep[fake.sleeps] : 0;
    fake.sleeps++;
    return 0;
}

static void set_clock(const int64_t *oversleep, int count)
{
    fake.on = 1;
    fake.broken = fake.signals = fake.sleeps = 0;
    fake.now = BEGIN;
    fake.oversleep = oversleep;
    fake.oversleeps = count;
}

static int reset_clock(void **state)
{
    (void)state;
    fake.on = 0;
    return 0;
}

enum { MOST = 1000 };

typedef struct witness {
    uint64_t count, stop_at;
    uint64_t ticks[MOST];
    double lateness[MOST]; /* what the steps were told [s] */
    int64_t stall;         /* that the first step takes [ns] */
} witness;

static int step(void *context, uint64_t tick, double lateness)
{
    witness *w = context;
    fake.now += w->count == 0 ? w->stall : 0;
    w->ticks[w->count] = tick;
    w->lateness[w->count++] = lateness;
    return tick >= w->stop_at;
}

/* A step a period, none of them early: 200 periods take 199 ms. */
static void a_calm_machine_has_every_step(void **state)
{
    (void)state;
    static witness w = {.stop_at = UINT64_MAX};
    nt_loop_statistics found;
    set_clock(NULL, 0);
    assert_int_equal(nt_loop_run(1e-3, 200, step, &w, &found), NT_OK);
    assert_true(fake.now == BEGIN + 199LL * MS);
    assert_true(w.count == 200 && found.ticks == 200 && found.missed == 0 && found.late == 0);
    assert_true(found.worst_delay == 0.0 && found.mean_delay == 0.0);
    for (uint64_t i = 0; i < 200; i++)
        assert_true(w.ticks[i] == i && w.lateness[i] == 0.0);
}

/* Late wake-ups do not add up; above a fifth of the period they are counted as late. */
static void lateness_is_told_and_counted(void **state)
{
    (void)state;
    static const int64_t late[] = {0, MS / 10, MS / 2, 0, MS * 199 / 1000, MS * 201 / 1000};
    static witness w = {.stop_at = UINT64_MAX};
    nt_loop_statistics found;
    set_clock(late, 6);
    assert_int_equal(nt_loop_run(1e-3, 10, step, &w, &found), NT_OK);
    assert_true(fake.now == BEGIN + 9LL * MS);
    assert_true(w.count == 10 && found.ticks == 10 && found.missed == 0 && found.late == 2);
    double mean = 0.0;
    for (uint64_t i = 0; i < 10; i++) {
        const double expected = i < 6 ? 1e-9 * (double)late[i] : 0.0;
        assert_true(w.ticks[i] == i && fabs(w.lateness[i] - expected) < 1e-15);
        mean += expected / 10.0;
    }
    assert_true(fabs(found.worst_delay - 0.5e-3) < 1e-15 && fabs(found.mean_delay - mean) < 1e-15);
}

/* A step that takes 20.5 periods costs 20 of them; they are skipped, and the number of the period keeps the time. */
static void lost_periods_are_skipped_not_caught_up(void **state)
{
    (void)state;
    static witness w = {.stop_at = UINT64_MAX, .stall = 41 * MS / 2};
    nt_loop_statistics found;
    set_clock(NULL, 0);
    assert_int_equal(nt_loop_run(1e-3, 100, step, &w, &found), NT_OK);
    assert_true(w.count == 81 && found.ticks == 81 && found.missed == 19 && found.late == 1);
    assert_true(w.ticks[1] == 20 && w.ticks[2] == 21 && w.ticks[80] == 99);
    assert_true(fabs(w.lateness[1] - 19.5e-3) < 1e-15 && w.lateness[2] == 0.0);
    assert_true(fabs(found.worst_delay - 19.5e-3) < 1e-12 && fake.now == BEGIN + 99LL * MS);
}

/* Asleep beyond the last period: all of the rest is lost, and there is no step. */
static void the_rest_can_be_lost(void **state)
{
    (void)state;
    static const int64_t late[] = {0, 0, 1000LL * MS};
    static witness w = {.stop_at = UINT64_MAX};
    nt_loop_statistics found;
    set_clock(late, 3);
    assert_int_equal(nt_loop_run(1e-3, 100, step, &w, &found), NT_OK);
    assert_true(w.count == 2 && found.ticks == 3 && found.missed == 1000);
}

static void the_step_ends_the_loop(void **state)
{
    (void)state;
    static witness w = {.stop_at = 5};
    set_clock(NULL, 0);
    assert_int_equal(nt_loop_run(1e-3, 1000, step, &w, NULL), NT_OK);
    assert_true(w.count == 6 && w.ticks[5] == 5 && fake.now == BEGIN + 5LL * MS);
}

/* Three signals interrupt each sleep of 5 ms; no step comes early. */
static void signals_do_not_wake_it(void **state)
{
    (void)state;
    static witness w = {.stop_at = UINT64_MAX};
    set_clock(NULL, 0);
    fake.signals = 3;
    assert_int_equal(nt_loop_run(5e-3, 11, step, &w, NULL), NT_OK);
    assert_true(w.count == 11 && fake.now == BEGIN + 50LL * MS);
    for (uint64_t i = 0; i < w.count; i++)
        assert_true(w.lateness[i] == 0.0);
}

static void a_broken_clock_is_a_broken_device(void **state)
{
    (void)state;
    static witness w = {.stop_at = UINT64_MAX};
    set_clock(NULL, 0);
    fake.broken = 1;
    assert_int_equal(nt_loop_run(1e-3, 10, step, &w, NULL), NT_E_DEVICE);
    assert_true(w.count == 0);
}

/* On the machine's own clock: however busy it is, no step comes early, and every period is a step or lost. */
static void the_real_clock_is_never_early(void **state)
{
    (void)state;
    static witness w = {.stop_at = UINT64_MAX};
    nt_loop_statistics found;
    struct timespec begin, end;
    fake.on = 0;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    assert_int_equal(nt_loop_run(1e-3, 50, step, &w, &found), NT_OK);
    clock_gettime(CLOCK_MONOTONIC, &end);
    assert_true((double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec) >= 49e-3 - 1e-9);
    assert_true(found.ticks + found.missed >= 50 && w.count + found.missed >= 50);
    double earliest = 0.0;
    for (uint64_t i = 0; i < w.count; i++) {
        assert_true(i == 0 || w.ticks[i] > w.ticks[i - 1]);
        earliest = smaller(earliest, w.lateness[i]);
    }
    assert_true(earliest == 0.0 && found.mean_delay >= 0.0 && found.mean_delay <= found.worst_delay);
}

static void arguments_are_checked(void **state)
{
    (void)state;
    static witness w = {.stop_at = UINT64_MAX};
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
        cmocka_unit_test_teardown(a_calm_machine_has_every_step, reset_clock),
        cmocka_unit_test_teardown(lateness_is_told_and_counted, reset_clock),
        cmocka_unit_test_teardown(lost_periods_are_skipped_not_caught_up, reset_clock),
        cmocka_unit_test_teardown(the_rest_can_be_lost, reset_clock),
        cmocka_unit_test_teardown(the_step_ends_the_loop, reset_clock),
        cmocka_unit_test_teardown(signals_do_not_wake_it, reset_clock),
        cmocka_unit_test_teardown(a_broken_clock_is_a_broken_device, reset_clock),
        cmocka_unit_test(the_real_clock_is_never_early),
        cmocka_unit_test(arguments_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
