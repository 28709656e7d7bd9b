/* SPDX-License-Identifier: BSD-3-Clause
 * A real master on a simulated slave: wall pace. Lateness slows the clock and stops nothing; a master that falls silent
 * takes the force off the hand for as long, and the session goes on. What runs by the clock runs on a busy machine. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

#include <cmocka.h>

#include "internal/control.h"
#include "larger.h"
#include "nanotouch/hal_backend.h"
#include "session/state.h"
#include "session_fixture.h"

/* A handle that stands still, read anew every millisecond; its force as it was last told. */
typedef struct handle {
    const nt_host *host;
    double period;
    int is_modest; /* it pushes, and does not say that it is real */
    atomic_int is_silent;
    int64_t stall; /* it says nothing new for so long, once in each 20 ms of the machine's clock [ns] */
    int stalls;    /* readings in which it did */
    int64_t time;
    uint64_t sequence;
} handle;

static nt_status open_handle(void *context, const nt_host *host, nt_problem *problem)
{
    (void)problem;
    ((handle *)context)->host = host;
    return NT_OK;
}

static nt_status describe_handle(void *context, nt_capabilities *capabilities)
{
    capabilities->can = NT_CAN_PUSH | (((handle *)context)->is_modest ? 0u : (uint32_t)NT_IS_REAL);
    capabilities->axes = 1;
    capabilities->period = ((handle *)context)->period;
    return NT_OK;
}

static int64_t machine_now(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static nt_status read_handle(void *context, nt_reading *reading)
{
    handle *h = context;
    const int64_t now = h->host->now(h->host);
    const int stalls = machine_now() % 20000000 < h->stall, is_silent = stalls || atomic_load(&h->is_silent);
    h->stalls += stalls;
    if (h->sequence == 0 || (!is_silent && now - h->time >= llround(1e9 * h->period))) {
        h->time = now;
        ++h->sequence;
    }
    *reading = (nt_reading){.size = sizeof *reading, .time = h->time, .sequence = h->sequence};
    for (int i = 0; i < NT_AXES; ++i)
        reading->position[i] = reading->felt[i] = (double)NAN;
    reading->position[NT_Z] = 0.0;
    reading->valid = 1u << NT_Z;
    return NT_OK;
}

static nt_status write_handle(void *context, const nt_action *action)
{
    (void)context;
    (void)action;
    return NT_OK;
}

static const nt_backend backend = {.size = sizeof backend,
                                   .version = NT_HAL_API_VERSION,
                                   .name = "handle",
                                   .half = NT_HALF_MASTER,
                                   .open = open_handle,
                                   .describe = describe_handle,
                                   .read = read_handle,
                                   .write = write_handle};

static nt_session_setup setup_on(handle *h)
{
    nt_session_setup setup = nt_session_defaults();
    setup.rig.master.gauge = 0;
    setup.rig.master.rate = h->period > 0.0 ? 1.0 / h->period : 0.0;
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.master = (nt_hal_choice){&backend, h};
    setup.minimum_margin = 0.0; /* of a machine that is busy with other tests */
    setup.preflight = 0;
    return setup;
}

static void pause_for(double seconds)
{
    const struct timespec nap = {.tv_sec = (time_t)seconds, .tv_nsec = (long)(1e9 * (seconds - floor(seconds)))};
    (void)nanosleep(&nap, NULL);
}

static void each_device_has_its_pace(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    nt_session *session = open_session(&setup);
    assert_int_equal(nt_session_pace(session), NT_PACE_FREE);
    assert_true(nt_session_wall_pace(session).hold == 0.0 && isinf(nt_session_wall_pace(session).margin.margin));
    nt_session_close(session);
    handle h = {.period = 1e-3};
    setup = setup_on(&h);
    session = open_session(&setup);
    assert_int_equal(nt_session_pace(session), NT_PACE_WALL);
    assert_int_equal(nt_session_start(session, NT_PACE_FREE, 1), NT_E_UNSUPPORTED);
    nt_session_close(session);
}

/* What is counted: the loop is that of a master that measures less often by hold and latency. */
static void margin_counts_hold_and_latency(int is_modest)
{
    handle h = {.period = 1e-3, .is_modest = is_modest};
    nt_session_setup setup = setup_on(&h);
    nt_session *session = open_session(&setup);
    assert_int_equal(nt_session_start(session, NT_PACE_WALL, 1), NT_OK);
    assert_int_equal(nt_session_halt(session), NT_OK);
    const nt_wall_pace wall = nt_session_wall_pace(session);
    assert_true(wall.hold > 0.0 && wall.hold <= 1e-3 && wall.latency > 0.0);
    const double stiffest = nt_session_plan(session)->maximum_stiffness;
    nt_rig rig = nt_session_touch(session)->rig;
    nt_margins margins;
    const double without = nt_margins_judge(&rig, &setup.settings, stiffest, NT_MODE_TOUCH, &margins).margin;
    rig.master.rate = 1.0 / (1e-3 + wall.hold + wall.latency);
    const double with = nt_margins_judge(&rig, &setup.settings, stiffest, NT_MODE_TOUCH, &margins).margin;
    print_message("hold %.3f ms, latency %.3f ms: margin %.3g, %.3g without\n", 1e3 * wall.hold, 1e3 * wall.latency,
                  wall.margin.margin, without);
    assert_true(fabs(wall.margin.margin - with) < 1e-9 * with && with < without);
    /* the force is held for so long, and that is in what is promised to the hand */
    const double delay = nt_motor_bound_compute(&setup.rig, &setup.settings).delay + wall.hold + wall.latency;
    assert_true(fabs(nt_session_motor_bound(session).delay - delay - NT_WALL_PATIENCE) < 1e-12);
    nt_session_close(session);
    setup.minimum_margin = 0.999 * without; /* it opens, but not for this pace */
    session = open_session(&setup);
    assert_int_equal(nt_session_start(session, NT_PACE_WALL, 1), NT_E_RANGE);
    assert_int_equal(nt_session_start(session, NT_PACE_HARD, 1), NT_OK);
    assert_int_equal(nt_session_halt(session), NT_OK);
    nt_session_close(session);
}
static void a_margin_counts_hold_and_latency(void **state)
{
    (void)state;
    margin_counts_hold_and_latency(0);
    margin_counts_hold_and_latency(1); /* as a device in Python or on the mailbox */
}

/* A master of 1 kHz that stalls for five of its periods in every twenty: not one tick holds, the clock waits. */
static void a_late_reading_is_waited_for(void **state)
{
    (void)state;
    handle h = {.period = 1e-3, .is_modest = 1, .stall = 5000000};
    nt_session_setup setup = setup_on(&h);
    nt_session *session = open_session(&setup);
    assert_int_equal(nt_session_start(session, NT_PACE_WALL, 0), NT_OK);
    long ticks = 0;
    nt_record r;
    while (ticks < 1000) {
        pause_for(0.01);
        for (; nt_session_read(session, &r, 1) == 1; ++ticks)
            assert_int_equal(r.state, NT_RUN);
    }
    assert_true(nt_session_progress(session).slowdown > 1.0);
    assert_int_equal(nt_session_halt(session), NT_OK);
    assert_true(h.stalls > 2);
    nt_session_close(session);
}

/* Silent for a while in the middle of it. */
static void silence_takes_the_force_and_gives_it_back(void **state)
{
    (void)state;
    handle h = {.period = 5e-3};
    nt_session_setup setup = setup_on(&h);
    nt_session *session = open_session(&setup);
    assert_int_equal(nt_session_start(session, NT_PACE_WALL, 0), NT_OK);
    long held = 0, ran = 0, ran_after = 0;
    uint64_t last = 0;
    nt_record r;
    for (int part = 0; part < 3; ++part) {
        atomic_store(&h.is_silent, part == 1);
        pause_for(0.15);
        while (nt_session_read(session, &r, 1) == 1) {
            last = r.tick;
            assert_true(r.lateness == 0.0 && r.state <= NT_HOLD);
            assert_true(r.state == NT_RUN || r.reasons & NT_REASON_MASTER_STALE);
            held += part == 1 && r.state == NT_HOLD;
            ran += part == 0 && r.state == NT_RUN;
            ran_after += part == 2 && r.state == NT_RUN;
        }
    }
    assert_int_equal(nt_session_halt(session), NT_OK);
    print_message("%ld ticks ran, %ld held, %ld ran again, of %lu\n", ran, held, ran_after, (unsigned long)last);
    assert_true(ran > 0 && held > 0 && ran_after > 0);
    nt_session_close(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_device_has_its_pace),
        cmocka_unit_test(a_margin_counts_hold_and_latency),
        cmocka_unit_test(a_late_reading_is_waited_for),
        cmocka_unit_test(silence_takes_the_force_and_gives_it_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
