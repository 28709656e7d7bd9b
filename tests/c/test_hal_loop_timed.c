/* SPDX-License-Identifier: BSD-3-Clause
 * What the timed loop counts: no time of this machine is judged, only that each phase is called and counted once. */
#define _POSIX_C_SOURCE 200809L
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "nanotouch/advanced/hal_linux.h"
#include "nanotouch/advanced/timing.h"

typedef struct calls {
    int reads, computes, writes, stop_at;
    long wait; /* in compute [ns] */
} calls;

static int read_it(void *context, uint64_t tick, double lateness)
{
    calls *c = context;
    assert_true(lateness >= 0.0 && tick >= (uint64_t)c->reads);
    return ++c->reads == c->stop_at;
}

static int compute_it(void *context)
{
    calls *c = context;
    ++c->computes;
    if (c->wait > 0)
        (void)nanosleep(&(struct timespec){0, c->wait}, NULL);
    return 0;
}

static int write_it(void *context)
{
    ++((calls *)context)->writes;
    return 0;
}

static nt_timing timing;

static void every_phase_is_counted_once(void **state)
{
    (void)state;
    calls c = {0};
    const nt_loop_phases phases = {read_it, compute_it, write_it, &c};
    memset(&timing, 0, sizeof timing);
    assert_int_equal(nt_loop_run_timed(1e-3, 200, &phases, &timing), NT_OK);
    assert_true(timing.ticks + timing.missed >= 200); /* more if it was late beyond the last period */
    assert_true(timing.ticks <= 200 && timing.ticks > 0);
    assert_true(c.reads == (int)timing.ticks && c.computes == c.reads && c.writes == c.reads);
    for (int i = 0; i < NT_LOOP_PHASES; ++i)
        assert_int_equal(timing.phases[i].total, timing.ticks);
    print_message("wake-up p50 %.1f us, p99 %.1f us, longest %.1f us\n",
                  1e-3 * (double)nt_histogram_quantile(&timing.phases[NT_LOOP_WAKE], 0.5),
                  1e-3 * (double)nt_histogram_quantile(&timing.phases[NT_LOOP_WAKE], 0.99),
                  1e-3 * (double)timing.phases[NT_LOOP_WAKE].most);
}

/* Work that takes longer than a period is an overrun each time, never "slack". */
static void an_overrun_is_one(void **state)
{
    (void)state;
    calls c = {.wait = 1500000};
    const nt_loop_phases phases = {read_it, compute_it, NULL, &c};
    memset(&timing, 0, sizeof timing);
    assert_int_equal(nt_loop_run_timed(1e-3, 40, &phases, &timing), NT_OK);
    assert_int_equal(timing.overrun, timing.ticks);
    assert_int_equal(timing.phases[NT_LOOP_SLACK].most, 0);
    assert_true(timing.missed >= 10); /* a third of the periods is lost at the least */
    assert_true(nt_histogram_quantile(&timing.phases[NT_LOOP_COMPUTE], 0.0) >= 1500000);
}

static void it_can_be_ended(void **state)
{
    (void)state;
    calls c = {.stop_at = 3};
    const nt_loop_phases phases = {read_it, compute_it, write_it, &c};
    memset(&timing, 0, sizeof timing);
    assert_int_equal(nt_loop_run_timed(1e-3, 1000, &phases, &timing), NT_OK);
    assert_true(c.reads == 3 && c.computes == 2 && c.writes == 2);
    assert_int_equal(nt_loop_run_timed(1e-3, 1, NULL, &timing), NT_E_ARGUMENT);
    assert_int_equal(nt_loop_run_timed(0.0, 1, &phases, &timing), NT_E_RANGE);
}

/* --- what the kernel grants --- */

static void what_is_refused_is_said(void **state)
{
    (void)state;
    nt_realtime rt;
    nt_realtime_wish wish = nt_realtime_wish_defaults();
    assert_int_equal(nt_realtime_begin(&rt, &wish), NT_OK);
    int lines = 0;
    for (const char *at = rt.refused; (at = strchr(at, '\n')) != NULL; ++at)
        ++lines;
    int refusals = 0;
    for (unsigned bit = 1; bit <= NT_REALTIME_AWAKE; bit <<= 1)
        refusals += (rt.wished & ~rt.granted & bit) != 0;
    print_message("granted %#x of %#x\n%s", rt.granted, rt.wished, rt.refused);
    assert_int_equal(lines, refusals);
    nt_realtime_end(&rt);
    nt_realtime_end(NULL);
    wish = (nt_realtime_wish){.priority = 100, .processor = -1};
    assert_int_equal(nt_realtime_begin(&rt, &wish), NT_E_RANGE);
    wish = (nt_realtime_wish){.processor = 1 << 20};
    assert_int_equal(nt_realtime_begin(&rt, &wish), NT_E_RANGE);
    wish = (nt_realtime_wish){.processor = 1000}; /* that no machine of ours has */
    assert_int_equal(nt_realtime_begin(&rt, &wish), NT_OK);
    assert_int_equal(rt.granted, 0);
    assert_non_null(strstr(rt.refused, "the processor was refused: "));
    wish = (nt_realtime_wish){.processor = -1};
    assert_int_equal(nt_realtime_begin(&rt, &wish), NT_OK);
    assert_true(rt.wished == 0 && rt.refused[0] == 0);
}

/* As a user without rights: priority is refused, with what would help; in a process of its own. */
static void a_plain_user_is_refused_in_words(void **state)
{
    (void)state;
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        nt_realtime rt;
        const nt_realtime_wish wish = nt_realtime_wish_defaults();
        if (geteuid() == 0 && setuid(65534) != 0)
            _exit(77);
        if (nt_realtime_begin(&rt, &wish) != NT_OK)
            _exit(1);
        const int is_refused = !(rt.granted & NT_REALTIME_PRIORITY);
        _exit(is_refused && !strstr(rt.refused, "SCHED_FIFO) was refused: ") ? 2 : is_refused ? 0 : 78);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    if (WEXITSTATUS(status) >= 77)
        skip(); /* this user may, or may not become another */
    assert_int_equal(WEXITSTATUS(status), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_phase_is_counted_once),
        cmocka_unit_test(an_overrun_is_one),
        cmocka_unit_test(it_can_be_ended),
        cmocka_unit_test(what_is_refused_is_said),
        cmocka_unit_test(a_plain_user_is_refused_in_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
