/* SPDX-License-Identifier: BSD-3-Clause
 * What a session at wall pace owes, waits for and counts as late, by its sums: the clock is read, never assumed. */
#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "hal/clock.h"
#include "larger.h"
#include "session/state.h"

static nt_session session;
static nt_composition now;

static nt_session *clean(double period)
{
    memset(&session, 0, sizeof session);
    memset(&now, 0, sizeof now);
    session.now = &now;
    now.touch.period = period;
    now.touch.supervisor.master_period = period;
    return &session;
}

/* A half that answers as it is told. */
typedef struct half {
    nt_reading next;
    nt_status status;
    int reads;
} half;

static nt_status read_half(void *context, nt_reading *reading)
{
    half *of = context;
    ++of->reads;
    *reading = of->next;
    return of->status;
}

static const nt_backend backend = {.read = read_half};

static void the_most_that_it_owes(void **unused)
{
    (void)unused;
    nt_session *s = clean(1e-4);
    assert_true(nt_wall_longest_lag(s) == 0.05); /* nothing real, nothing with a clock of its own */
    s->master.capabilities.period = 8e-3;
    assert_true(nt_wall_longest_lag(s) == 2e-3); /* a quarter of it */
    s->slave.capabilities.period = 4e-3;
    assert_true(nt_wall_longest_lag(s) == 1e-3);
    s->slave.capabilities.period = 1e-5;
    assert_true(nt_wall_longest_lag(s) == 2e-4); /* two periods of the loop at least */
    s->simulates[NT_HALF_SLAVE] = 1;
    assert_true(nt_wall_longest_lag(s) == 2e-3);
    s->master.capabilities.period = 0.0;
    assert_true(nt_wall_longest_lag(s) == 0.05);
    s->master.capabilities.can = NT_IS_REAL; /* measures in every period */
    assert_true(nt_wall_longest_lag(s) == 2e-4);
    s->master.capabilities.period = 8e-3;
    assert_true(nt_wall_longest_lag(s) == 2e-3);
}

static void what_is_due(void **unused)
{
    (void)unused;
    const double speeds[] = {0.5, 2.0};
    for (int i = 0; i < 2; ++i) {
        const double speed = speeds[i], before = 0.125;
        for (int late = 0; late < 2; ++late) {
            nt_wall_clock clock = {
                .last = nt_clock_now() - 300000000, .lag = late ? 0.05 : 10.0, .due = before, .lost = 0.25};
            const int64_t last = clock.last;
            const double slower = nt_wall_look(&clock, speed), passed = 1e-9 * (double)(clock.last - last);
            assert_true(passed >= 0.3 && clock.passed == passed);
            const double due = before + speed * passed, lost = late ? due - speed * 0.05 : 0.0;
            assert_true(fabs(clock.due - (due - lost)) < 1e-12);
            const double share = 1.0 - exp(-passed / 1.0), rate = 0.25 + share * (lost / (speed * passed) - 0.25);
            assert_true(fabs(clock.lost - rate) < 1e-12 && fabs(slower * (1.0 - rate) - 1.0) < 1e-12);
        }
    }
    nt_wall_clock clock = {.last = nt_clock_now() + 1000000000, .lag = 1.0, .lost = 0.5}; /* no time has passed */
    assert_true(nt_wall_look(&clock, 1.0) == 2.0 && clock.lost == 0.5);
    clock.lost = 1.0;
    clock.last = nt_clock_now() + 1000000000;
    assert_true(fabs(nt_wall_look(&clock, 1.0) - 1e9) < 1.0);
}

/* The deadline is a period after the last one; lateness is by how much later the next tick begins. */
static void a_leader_is_followed(void **unused)
{
    (void)unused;
    nt_session *s = clean(2e-3);
    half leads = {.next = {.sequence = 1, .valid = (1u << NT_READS) - 1u}};
    nt_hal leader = {.backend = &backend, .context = &leads};
    s->leader = &leader;
    const int64_t begun = nt_clock_now();
    assert_int_equal(nt_session_follow_leader(s), NT_OK); /* the first one is never late */
    assert_true(s->deadline >= begun && s->deadline <= nt_clock_now() && s->lateness == 0.0 && s->waits == 0);
    s->deadline = begun - 50000000; /* due 48 ms ago */
    leads.next.sequence = 2;
    nt_session_follow_leader(s);
    assert_true(s->deadline >= begun && fabs(s->lateness - 1e-9 * (double)(s->deadline - (begun - 48000000))) < 1e-15);
    leads.next.sequence = 3;
    leads.next.lateness = 5.0; /* as it says of itself, where that is more */
    nt_session_follow_leader(s);
    assert_true(s->lateness == 5.0);
    leads.next.lateness = 0.0;
    for (int lost = 0; lost < 2; ++lost) { /* nothing new, or gone: no longer than a period */
        leads.next.sequence += (uint64_t)lost;
        leads.next.flags = lost ? NT_SAMPLE_DEVICE_LOST : 0u;
        const int64_t last = s->deadline = nt_clock_now();
        nt_session_follow_leader(s);
        assert_true(s->deadline >= last + 2000000 && nt_clock_now() >= s->deadline);
        assert_true(s->lateness == 1e-9 * (double)(s->deadline - last - 2000000));
    }
    leads.status = NT_E_DEVICE;
    assert_int_equal(nt_session_follow_leader(s), NT_OK);
}

/* Only where a half has a clock of its own, or the machine's is kept, and none leads. */
static void a_period_is_waited_for(void **unused)
{
    (void)unused;
    nt_session *s = clean(1e-3);
    s->deadline = 7;
    nt_session_keep_time(s);
    assert_true(s->deadline == 7);
    s->clock = nt_clock_now;
    const int64_t begun = s->deadline = nt_clock_now();
    nt_session_keep_time(s);
    assert_true(s->deadline >= begun + 1000000 && nt_clock_now() >= s->deadline);
    s->clock = NULL;
    s->master.capabilities.period = 1.0;
    const int64_t last = s->deadline = nt_clock_now();
    nt_session_keep_time(s);
    assert_true(s->deadline >= last + 1000000);
    s->deadline = 7; /* long ago: from now on */
    nt_session_keep_time(s);
    assert_true(s->deadline >= last + 1000000);
    nt_hal leader = {.backend = &backend};
    s->leader = &leader;
    s->deadline = 7;
    nt_session_keep_time(s);
    assert_true(s->deadline == 7);
}

static void how_often_it_wakes_up(void **unused)
{
    (void)unused;
    nt_session *s = clean(1e-4);
    assert_int_equal(nt_wall_wake(s), 1000000);
    s->master.capabilities.period = 3.2e-3; /* lags by 0.8 ms: half of it */
    assert_int_equal(nt_wall_wake(s), 400000);
}

/* A reading is fresh for two periods of the master: ticks that begin within them. */
static void ticks_that_a_reading_is_fresh_for(void **unused)
{
    (void)unused;
    nt_session *s = clean(1e-3);
    half master = {.next = {.sequence = 1, .time = 0, .valid = (1u << NT_READS) - 1u}};
    s->master = (nt_hal){.backend = &backend, .context = &master, .capabilities = {.can = NT_IS_REAL}};
    now.touch.supervisor.master_period = 4e-3;
    nt_wall_clock clock = {.passed = 1e-3};
    s->time = 1000000; /* the next tick is at 2 ms: 6 ms are left, 7 ticks begin within */
    assert_int_equal(nt_wall_ticks(s, &clock, 100), 7);
    assert_int_equal(master.reads, 1); /* a newer one might do */
    assert_int_equal(nt_wall_ticks(s, &clock, 7), 7);
    assert_int_equal(nt_wall_ticks(s, &clock, 3), 3);
    assert_int_equal(master.reads, 1);
    s->time = 7000000; /* at 8 ms: it is just fresh */
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 1);
    s->time = 7000001;
    clock.waited = 0.0;
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 0); /* it is waited for */
    assert_true(clock.waited == 1e-3);
    clock.passed = 5e-3; /* a thread that stood counts for 2 ms */
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 0);
    assert_true(fabs(clock.waited - 3e-3) < 1e-18);
    clock.waited = NT_WALL_PATIENCE - 2e-3;
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 0);
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 5); /* no longer than this */
    clock.waited = 0.0;
    clock.lost = 0.5;
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 0);
    clock.lost = 0.51; /* one that is late so often is not */
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 5);
    clock.lost = clock.waited = 0.0;
    atomic_store(&s->stop, 1u);
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 5);
    atomic_store(&s->stop, 0u);
    const uint32_t bad[] = {NT_SAMPLE_DEVICE_LOST, NT_SAMPLE_INVALID};
    for (int i = 0; i < 2; ++i) {
        clock.waited = 0.0;
        master.next.flags = bad[i];
        assert_int_equal(nt_wall_ticks(s, &clock, 5), 5);
    }
    master.next.flags = 0u;
    clock.waited = 0.0;
    assert_int_equal(nt_wall_ticks(s, &clock, 0), 0);
    assert_true(clock.waited == 0.0); /* nothing was due */
    master.next.time = 6000000;       /* a new one: all is well again */
    clock.waited = 5e-3;
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 5);
    assert_true(clock.waited == 0.0);
}

static void who_is_waited_for(void **unused)
{
    (void)unused;
    nt_session *s = clean(1e-3);
    half master = {.next = {.sequence = 1, .time = -1000000000, .valid = (1u << NT_READS) - 1u}};
    nt_wall_clock clock = {.passed = 1e-3};
    s->master = (nt_hal){.backend = &backend, .context = &master};
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 5); /* no motor: nobody is driven */
    s->master.capabilities.can = NT_CAN_PUSH;
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 0);
    s->simulates[NT_HALF_MASTER] = 1;
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 5);
    s->master.capabilities.can = NT_IS_REAL;
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 0);
    s->slave.capabilities.can = NT_IS_REAL; /* hard pace: never slowed down */
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 5);
    s->slave.capabilities.can = 0u;
    s->leader = &s->master;
    assert_int_equal(nt_wall_ticks(s, &clock, 5), 5);
    s->leader = NULL;
    s->clock = nt_clock_now; /* on the machine's clock hardly any time passes in a batch */
    master.next.time = nt_clock_now() + 1000000000;
    clock.waited = 0.0;
    assert_int_equal(nt_wall_ticks(s, &clock, LONG_MAX - 1), LONG_MAX - 1);
}

static void paces_that_devices_may_run_at(void **unused)
{
    (void)unused;
    nt_session *s = clean(1e-3);
    for (int i = 0; i < 8; ++i) {
        s->master.capabilities.can = (i & 1 ? NT_IS_REAL : 0u) | (i & 4 ? NT_IS_SLOW : 0u);
        s->slave.capabilities.can = i & 2 ? NT_IS_REAL : 0u;
        const nt_pace least = i & 2 ? NT_PACE_HARD : i & 1 ? NT_PACE_WALL : NT_PACE_FREE;
        assert_int_equal(nt_session_pace(s), least);
        const nt_pace paces[] = {NT_PACE_FREE, NT_PACE_WALL, NT_PACE_HARD};
        for (int k = 0; k < 3; ++k) {
            const int may = paces[k] >= least && !(paces[k] == NT_PACE_HARD && i & 4);
            assert_int_equal(nt_session_check_pace(s, paces[k]), may ? NT_OK : NT_E_UNSUPPORTED);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_most_that_it_owes), cmocka_unit_test(what_is_due),
        cmocka_unit_test(a_leader_is_followed),  cmocka_unit_test(a_period_is_waited_for),
        cmocka_unit_test(how_often_it_wakes_up), cmocka_unit_test(ticks_that_a_reading_is_fresh_for),
        cmocka_unit_test(who_is_waited_for),     cmocka_unit_test(paces_that_devices_may_run_at),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
