/* SPDX-License-Identifier: BSD-3-Clause
 * What stands beside a rig of real drivers fails (rows 18, 27, 28 and 32 of the list in docs/evidence/safety.md):
 * nobody takes the records any more, viewers are killed or hang, the program of the hand is killed. Single, and with
 * the bus failing in the same moment. A busy machine is late and holds; no time is judged. */
#define _DEFAULT_SOURCE
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "internal/observer.h"
#include "nanotouch/advanced/observer.h"
#include "nanotouch/mailbox.h"
#include "rig_session.h"
#include "session/frames.h"

enum { VIEWERS = 6, PATIENCE = 60000, RING = 64 }; /* looks, 1 ms apart; records */

#define TIMEOUT 1.0 /* of the hand's program [s] */

static nt_converter_half half;
static nt_spi spi;
static nt_session *session;
static nt_observer *eye;
static char name[NT_NAME_SIZE];

static void nap(void)
{
    const struct timespec one = {.tv_nsec = 1000000};
    (void)nanosleep(&one, NULL);
}

/* --- programs --- */

static pid_t begin_program(void (*program)(void))
{
    const pid_t parent = getpid(), child = fork();
    assert_true(child >= 0);
    if (child > 0)
        return child;
    while (getppid() == parent)
        program();
    _exit(0);
}

static void end_program(pid_t program)
{
    assert_int_equal(kill(program, SIGKILL), 0);
    assert_int_equal(waitpid(program, NULL, 0), program);
}

static void view(void)
{
    static nt_observer *own;
    nt_frame frame;
    if (!own)
        (void)nt_observer_attach(&own, name);
    if (own)
        (void)nt_observer_read(own, &frame, 1);
}

/* A hand at rest. */
static void hold_the_hand(void)
{
    static const nt_channel_row rows[] = {{"position", "m", 0, NT_Z, -0.1, 0.1, 0.0, 0.0, 0.0, (double)NAN}};
    static nt_mailbox *mailbox;
    nt_mailbox_device device = nt_mailbox_device_defaults(NT_HALF_MASTER);
    device.period = 2e-3;
    device.timeout = TIMEOUT;
    device.rows = 1;
    device.channels = rows;
    if (!mailbox && nt_mailbox_open(&mailbox, name, &device, NULL) != NT_OK)
        _exit(1);
    const nt_reading reading = {.time = nt_mailbox_now(mailbox), .valid = 1u << NT_Z};
    if (nt_mailbox_publish(mailbox, &reading) != NT_OK)
        _exit(2);
    nap();
}

/* --- a session --- */

static void begin(nt_mailbox_half *hand)
{
    open_slave(&half, &spi);
    nt_session_setup setup = setup_on(&half);
    setup.ring_capacity = RING;
    if (hand)
        setup.master = (nt_hal_choice){nt_mailbox_backend(NT_HALF_MASTER), hand};
    session = open_session(&setup);
    assert_int_equal(nt_session_publish(session, name), NT_OK);
    assert_int_equal(nt_observer_of(&eye, nt_session_frames(session)), NT_OK);
    assert_int_equal(nt_session_start(session, NT_PACE_HARD, 0), NT_OK);
}

/* So many ticks more; it is not latched. */
static void goes_on(uint64_t ticks)
{
    const uint64_t until = nt_session_progress(session).ticks + ticks;
    nt_frame frame;
    for (int i = 0; i < PATIENCE && nt_session_progress(session).ticks < until; ++i)
        nap();
    assert_true(nt_session_progress(session).ticks >= until);
    assert_true(nt_observer_newest(eye, &frame));
    assert_int_not_equal(frame.state, NT_LATCHED);
    assert_true(isfinite(frame.deflection));
}

static nt_frame latches(void)
{
    nt_frame frame = nt_frame_unknown();
    for (int i = 0; i < PATIENCE && frame.state != NT_LATCHED; ++i) {
        nap();
        (void)nt_observer_newest(eye, &frame);
    }
    assert_int_equal(frame.state, NT_LATCHED);
    return frame;
}

/* The button still works; then the tip is lifted. */
static void stops_and_lifts(void)
{
    atomic_store(&is_pressed, 1);
    (void)latches();
    assert_int_equal(nt_session_halt(session), NT_OK);
    const double stood = simulated_travel(&bus);
    nt_observer_close(eye);
    nt_session_close(session);
    assert_true(simulated_travel(&bus) < stood - 1e-8);
    nt_spi_close(&spi);
}

static void nobody_takes_the_records(void **state)
{
    (void)state;
    begin(NULL);
    goes_on(3 * RING);
    const nt_progress found = nt_session_progress(session);
    assert_true(found.dropped > 0 && found.dropped + 2 * RING >= found.ticks); /* counted; the first ones are kept */
    assert_true(half.counts.failed == 0);
    stops_and_lifts();
}

static void viewers_are_killed_or_hang(void **state)
{
    (void)state;
    pid_t viewers[VIEWERS];
    for (int i = 0; i < VIEWERS; ++i) /* before the session has a thread */
        viewers[i] = begin_program(view);
    begin(NULL);
    goes_on(50);
    for (int i = 0; i < VIEWERS; ++i) {
        assert_int_equal(kill(viewers[i], i % 2 ? SIGKILL : SIGSTOP), 0);
        goes_on(10);
    }
    assert_true(half.counts.failed == 0);
    stops_and_lifts();
    for (int i = 0; i < VIEWERS; ++i) {
        (void)kill(viewers[i], SIGKILL);
        assert_int_equal(waitpid(viewers[i], NULL, 0), viewers[i]);
    }
}

static void hand_is_killed(int bus_fails)
{
    const pid_t program = begin_program(hold_the_hand);
    nt_mailbox_half hand;
    assert_int_equal(nt_mailbox_half_init(&hand, name), NT_OK);
    for (int i = 0; i < 500; ++i) /* until it serves */
        nap();
    begin(&hand);
    goes_on(50);
    end_program(program);
    atomic_store(&is_refusing, bus_fails);
    const nt_frame frame = latches();
    assert_true((frame.reasons & NT_REASON_DEVICE) || bus_fails);
    atomic_store(&is_refusing, 0);
    stops_and_lifts();
    nt_mailbox *left = NULL; /* what a killed program leaves until its name is taken again */
    const nt_mailbox_device device = nt_mailbox_device_defaults(NT_HALF_MASTER);
    assert_int_equal(nt_mailbox_open(&left, name, &device, NULL), NT_OK);
    nt_mailbox_close(left);
}

static void a_hand_that_is_killed(void **state)
{
    (void)state;
    hand_is_killed(0);
}

static void a_hand_that_is_killed_while_the_bus_fails(void **state)
{
    (void)state;
    hand_is_killed(1);
}

int main(void)
{
    (void)snprintf(name, sizeof name, "test-peers-%ld", (long)getpid());
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nobody_takes_the_records),
        cmocka_unit_test(viewers_are_killed_or_hang),
        cmocka_unit_test(a_hand_that_is_killed),
        cmocka_unit_test(a_hand_that_is_killed_while_the_bus_fails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
