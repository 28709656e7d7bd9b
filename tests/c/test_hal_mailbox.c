/* SPDX-License-Identifier: BSD-3-Clause
 * Both ends of a mailbox: conformance, refusals, silence, half-written and unsound values. No time of the machine
 * counts. */
#define _DEFAULT_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "conformance.h"
#include "hal/mailbox_memory.h"
#include "mailbox_program.h"

static mailbox_program program;
static char name[NT_MAILBOX_NAME];

static int64_t host_now(const nt_host *host)
{
    (void)host;
    return mailbox_time();
}
static const nt_host host = {sizeof host, NT_HAL_API_VERSION, host_now, NULL, NULL};

/* A period on the test's clock, and the program's next turn. */
static void pass(const nt_host *of, double period)
{
    (void)of;
    (void)pthread_mutex_lock(&program.lock);
    (void)atomic_fetch_add(&mailbox_clock, (int64_t)(1e9 * period));
    mailbox_turn(&program, 0);
    (void)pthread_mutex_unlock(&program.lock);
}

static nt_mailbox_half half_of(const char *of)
{
    nt_mailbox_half half;
    assert_int_equal(nt_mailbox_half_init(&half, of), NT_OK);
    half.clock = mailbox_time;
    return half;
}

static void silence(void *device, int on)
{
    (void)device;
    mailbox_set(&program, &program.is_silent, on);
}
static void lose(void *device)
{
    (void)device;
    mailbox_set(&program, &program.is_dead, 1);
}
/* After the program's next turn: its thread may be late by more than a close waits for. */
static double left_at(void *device)
{
    (void)device;
    (void)pthread_mutex_lock(&program.lock);
    mailbox_turn(&program, 0);
    const double z = program.half == NT_HALF_MASTER ? program.force : program.z;
    (void)pthread_mutex_unlock(&program.lock);
    return z;
}

static void both_halves_conform(void **state)
{
    (void)state;
    for (int half = NT_HALF_MASTER; half <= NT_HALF_SLAVE; ++half) {
        assert_int_equal(mailbox_start(&program, (nt_half)half, mailbox_name(name, "conform")), NT_OK);
        mailbox_set(&program, &program.is_led, 1);
        nt_mailbox_half mailbox = half_of(name);
        const conformance c = {.half = (nt_half)half,
                               .choice = {nt_mailbox_backend((nt_half)half), &mailbox},
                               .host = &host,
                               .configuration = {sizeof c.configuration, 0, 1e-3, 1e-6, ""},
                               .periods = 50,
                               .pass = pass,
                               .silence = silence,
                               .lose = lose,
                               .left_at = left_at,
                               .slack = 1e-15};
        const char *rule = conform(half == NT_HALF_MASTER ? "master behind a mailbox" : "slave behind a mailbox", &c);
        mailbox_end(&program);
        if (rule)
            fail_msg("half %d: %s", half, rule);
    }
}

/* --- who may open what --- */

static void refused(nt_mailbox_device device, nt_status expected)
{
    nt_mailbox *mailbox = NULL;
    nt_problem problem = {0};
    assert_int_equal(nt_mailbox_open(&mailbox, mailbox_name(name, "refused"), &device, &problem), expected);
    assert_non_null(problem.field);
    assert_null(mailbox);
}

static void wrong_devices(void **state)
{
    (void)state;
    nt_mailbox_device device = mailbox_device(NT_HALF_MASTER);
    device.half = (nt_half)2;
    refused(device, NT_E_RANGE);
    device = mailbox_device(NT_HALF_MASTER);
    device.can |= NT_LEADS_CLOCK;
    refused(device, NT_E_RANGE);
    device = mailbox_device(NT_HALF_MASTER);
    device.rows = NT_MAILBOX_CHANNELS + 1;
    refused(device, NT_E_RANGE);
    device = mailbox_device(NT_HALF_MASTER);
    device.timeout = 2.0 * device.period;
    refused(device, NT_E_RANGE);
    device.timeout = (double)NAN;
    refused(device, NT_E_NOT_FINITE);
    device = mailbox_device(NT_HALF_MASTER);
    device.axes = 4;
    refused(device, NT_E_RANGE);
    device = mailbox_device(NT_HALF_MASTER);
    const nt_channel_row row = {"the name of a channel that is too long", "m", 0, NT_Z, 0, 1, 0, 0, 0, (double)NAN};
    device.channels = &row;
    device.rows = 1;
    refused(device, NT_E_RANGE);
    nt_mailbox *mailbox = NULL;
    nt_problem problem = {0};
    device = mailbox_device(NT_HALF_MASTER);
    assert_int_equal(nt_mailbox_open(&mailbox, "a/b", &device, &problem), NT_E_RANGE);
    assert_non_null(problem.field);
    assert_int_equal(nt_mailbox_open(&mailbox, NULL, &device, NULL), NT_E_ARGUMENT);
    nt_mailbox_half half;
    assert_int_equal(nt_mailbox_half_init(&half, ""), NT_E_RANGE);
    nt_mailbox_close(NULL);
}

static nt_status open_hal(nt_hal *on, nt_half half, nt_mailbox_half *through)
{
    const nt_hal_choice choice = {nt_mailbox_backend(half), through};
    return nt_hal_open(on, half, &choice, &host, NULL);
}

static void one_program_and_one_session(void **state)
{
    (void)state;
    nt_hal hal, second;
    nt_mailbox *other = NULL;
    nt_mailbox_half mine = half_of(mailbox_name(name, "one")), theirs = half_of(name);
    const nt_mailbox_device device = mailbox_device(NT_HALF_MASTER);
    assert_int_equal(open_hal(&hal, NT_HALF_MASTER, &mine), NT_E_DEVICE); /* no program */
    assert_int_equal(mailbox_start(&program, NT_HALF_MASTER, name), NT_OK);
    assert_int_equal(nt_mailbox_open(&other, name, &device, NULL), NT_E_STATE); /* one program at a time */
    assert_int_equal(open_hal(&hal, NT_HALF_SLAVE, &mine), NT_E_UNSUPPORTED);   /* the other half */
    assert_int_equal(open_hal(&hal, NT_HALF_MASTER, &mine), NT_OK);
    assert_int_equal(open_hal(&second, NT_HALF_MASTER, &theirs), NT_E_STATE); /* one session at a time */
    nt_hal_close(&hal);
    assert_int_equal(open_hal(&second, NT_HALF_MASTER, &theirs), NT_OK);
    nt_hal_close(&second);
    mailbox_end(&program);
    assert_int_equal(open_hal(&hal, NT_HALF_MASTER, &mine), NT_E_DEVICE); /* it has closed */
}

/* --- silence, to the nanosecond --- */

/* The session's end, which the tests below hold. */
static nt_hal hal;
static nt_mailbox_half mailbox;
static nt_shared view;

static void start_by_hand(nt_half half)
{
    assert_int_equal(mailbox_start(&program, half, mailbox_name(name, "hand")), NT_OK);
    mailbox = half_of(name);
    assert_int_equal(open_hal(&hal, half, &mailbox), NT_OK);
    const nt_configuration configuration = {sizeof configuration, 0, 1e-3, 1e-6, ""};
    assert_int_equal(nt_hal_configure(&hal, &configuration, NULL), NT_OK);
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
    mailbox_set(&program, &program.is_dead, 1); /* from now on the test alone turns it */
}

static void turn(int64_t later)
{
    (void)pthread_mutex_lock(&program.lock);
    (void)atomic_fetch_add(&mailbox_clock, later);
    program.is_dead = 0;
    mailbox_turn(&program, 0);
    program.is_dead = 1;
    (void)pthread_mutex_unlock(&program.lock);
}

static nt_mailbox_block *attach(void)
{
    assert_int_equal(nt_shared_attach(&view, "mailbox", name, sizeof(nt_mailbox_block), 1), NT_OK);
    return view.memory;
}

static void end_by_hand(void)
{
    if (view.memory)
        nt_shared_close(&view);
    mailbox_set(&program, &program.is_dead, 0);
    nt_hal_close(&hal);
    mailbox_end(&program);
}

static void a_program_that_is_silent_is_lost_after_its_timeout(void **state)
{
    (void)state;
    start_by_hand(NT_HALF_MASTER);
    turn(1000000);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    const nt_reading last = hal.reading;
    assert_int_equal(last.time, mailbox_time());
    (void)atomic_fetch_add(&mailbox_clock, 10000000); /* the timeout: not longer than it */
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    assert_false(hal.reading.flags & NT_SAMPLE_DEVICE_LOST);
    assert_int_equal(hal.reading.sequence, last.sequence); /* old is never new */
    assert_int_equal(hal.reading.time, last.time);
    (void)atomic_fetch_add(&mailbox_clock, 1);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    assert_true(hal.reading.flags & NT_SAMPLE_DEVICE_LOST);
    assert_int_equal(hal.reading.valid, 0);
    turn(1000); /* it was stopped, and goes on */
    nt_reading fresh = last;
    assert_int_equal(hal.backend->read(hal.context, &fresh), NT_OK);
    assert_int_equal(fresh.sequence, last.sequence + 1);
    assert_int_equal(fresh.time, mailbox_time());
    end_by_hand();
}

static void a_device_that_is_silent_is_not_a_program_that_is(void **state)
{
    (void)state;
    start_by_hand(NT_HALF_MASTER);
    turn(1000000);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    const nt_reading last = hal.reading;
    program.is_silent = 1;
    for (int i = 0; i < 100; ++i) { /* ten timeouts */
        turn(1000000);
        assert_int_equal(nt_hal_read(&hal), NT_OK);
        assert_false(hal.reading.flags & NT_SAMPLE_DEVICE_LOST);
        assert_int_equal(hal.reading.time, last.time); /* it grows old: the supervisor holds */
    }
    end_by_hand();
}

static void a_session_that_is_silent_leaves_the_device_safe(void **state)
{
    (void)state;
    for (int half = NT_HALF_MASTER; half <= NT_HALF_SLAVE; ++half) {
        start_by_hand((nt_half)half);
        const double asked = half == NT_HALF_MASTER ? 1.5 : 2e-6;
        const nt_action action = {.size = sizeof action, .target = {[NT_Z] = asked}};
        assert_int_equal(nt_hal_write(&hal, &action), NT_OK);
        turn(10000000);
        assert_true(left_at(NULL) == asked);
        turn(1);
        assert_true(fabs(left_at(NULL) - (half == NT_HALF_MASTER ? 0.0 : asked - 1e-6)) < 1e-15);
        turn(1000000); /* lifted once */
        assert_true(fabs(left_at(NULL) - (half == NT_HALF_MASTER ? 0.0 : asked - 1e-6)) < 1e-15);
        end_by_hand();
    }
}

static void targets_stay_within_their_channel(void **state)
{
    (void)state;
    start_by_hand(NT_HALF_MASTER);
    const nt_action action = {.size = sizeof action, .target = {[NT_Z] = -7.0}};
    assert_int_equal(nt_hal_write(&hal, &action), NT_OK);
    turn(1000);
    assert_true(left_at(NULL) == -3.0);
    assert_int_equal(mailbox.counts.clipped, 1);
    end_by_hand();
}

/* --- what a program may write, and what one that has gone mad writes --- */

static void unsound_readings_are_refused_on_both_sides(void **state)
{
    (void)state;
    start_by_hand(NT_HALF_MASTER);
    nt_mailbox_block *block = attach();
    const int64_t now = mailbox_time();
    const nt_reading unsound[] = {
        {.position = {[NT_Z] = (double)NAN}, .time = now, .valid = 1u << NT_Z},
        {.position = {[NT_Z] = (double)INFINITY}, .time = now, .valid = 1u << NT_Z},
        {.time = now, .valid = 1u << NT_X},                   /* an axis that it has not */
        {.time = now, .valid = 1u << (NT_READS_FELT + NT_Z)}, /* it has no gauge */
        {.time = now, .valid = 1u << NT_READS},
        {.time = now, .flags = 1u << 30},
        {.time = now, .valid = 1u << NT_Z, .flags = NT_SAMPLE_DEVICE_LOST},
        {.time = now + 1, .valid = 1u << NT_Z}, /* the future would be fresh for ever */
    };
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    const nt_reading last = hal.reading;
    for (size_t i = 0; i < sizeof unsound / sizeof *unsound; ++i) {
        const uint64_t published = block->published;
        assert_int_equal(nt_mailbox_publish(program.mailbox, &unsound[i]), NT_E_RANGE);
        assert_int_equal(block->published, published);
        nt_mailbox_put(&block->published, block->readings_at, block->readings[0], &unsound[i], NT_WORDS(nt_reading));
        assert_int_equal(nt_hal_read(&hal), NT_OK);
        assert_memory_equal(&hal.reading, &last, sizeof last);
        assert_int_equal(mailbox.counts.unsound, i + 1);
    }
    turn(1000); /* and the next good one counts */
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    assert_true(hal.reading.sequence > last.sequence && hal.reading.valid == 1u << NT_Z);
    atomic_store(&block->beat, (uint64_t)mailbox_time() + 1u); /* a beat that has not been yet is none */
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    assert_true(hal.reading.flags & NT_SAMPLE_DEVICE_LOST);
    end_by_hand();
}

/* The writer stands in the middle: its slot has no stamp, or already that of another lap. */
static void half_written_readings_are_never_taken(void **state)
{
    (void)state;
    start_by_hand(NT_HALF_MASTER);
    nt_mailbox_block *block = attach();
    turn(1000000);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    const nt_reading last = hal.reading;
    const uint64_t next = last.sequence + 1;
    for (size_t words = 0; words <= NT_WORDS(nt_reading); ++words) { /* killed after so many words */
        atomic_store(&block->readings_at[next & 1u], 0);
        for (size_t i = 0; i < words; ++i)
            atomic_store(&block->readings[next & 1u][i], 0x5555555555555555u);
        assert_int_equal(nt_hal_read(&hal), NT_OK);
        assert_memory_equal(&hal.reading, &last, sizeof last);
    }
    atomic_store(&block->published, next); /* and here it lies: the slot is not whole */
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    assert_memory_equal(&hal.reading, &last, sizeof last);
    assert_int_equal(mailbox.counts.torn, 1);
    end_by_hand();
}

/* One of another user stands under the name. Only root can try: it may open what is anybody's. */
static void a_program_of_another_user_is_not_obeyed(void **state)
{
    (void)state;
    if (geteuid() != 0)
        skip();
    assert_int_equal(mailbox_start(&program, NT_HALF_SLAVE, mailbox_name(name, "foreign")), NT_OK);
    char path[128];
    (void)snprintf(path, sizeof path, "/dev/shm/nanotouch.mailbox.%s", name);
    assert_int_equal(chown(path, 65534, 65534), 0);
    mailbox = half_of(name);
    const nt_hal_choice choice = {nt_mailbox_backend(NT_HALF_SLAVE), &mailbox};
    nt_problem problem = {0};
    assert_int_equal(nt_hal_open(&hal, NT_HALF_SLAVE, &choice, &host, &problem), NT_E_STATE);
    assert_string_equal(problem.field, "programs of this user that serve this mailbox (another user's does)");
    assert_int_equal(chown(path, 0, 0), 0);
    mailbox_end(&program);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_program_of_another_user_is_not_obeyed),
        cmocka_unit_test(both_halves_conform),
        cmocka_unit_test(wrong_devices),
        cmocka_unit_test(one_program_and_one_session),
        cmocka_unit_test(a_program_that_is_silent_is_lost_after_its_timeout),
        cmocka_unit_test(a_device_that_is_silent_is_not_a_program_that_is),
        cmocka_unit_test(a_session_that_is_silent_leaves_the_device_safe),
        cmocka_unit_test(targets_stay_within_their_channel),
        cmocka_unit_test(unsound_readings_are_refused_on_both_sides),
        cmocka_unit_test(half_written_readings_are_never_taken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
