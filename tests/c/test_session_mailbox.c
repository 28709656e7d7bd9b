/* SPDX-License-Identifier: BSD-3-Clause
 * kill -9 of a device's program while a session runs. The session holds once the last reading is older than two of the
 * device's periods, and latches in the first tick after its timeout; nothing torn or stale is ever taken.
 *
 *     test_session_mailbox [KILLS]    10 by itself; make heavy asks for 1000
 *
 * From the kill on the clock is the test's, counted from the program's last sign of life: no load of the machine shifts
 * a tick. */
#define _DEFAULT_SOURCE

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "hal/mailbox_memory.h"
#include "session_fixture.h"

#define PERIOD 1e-3  /* of loop and device [s] */
#define TIMEOUT 0.02 /* of the program [s] */
#define STEP 1e-9    /* of the hand in a reading [m] */

static long kills = 10;

/* Each reading follows from its number, so that a torn one shows. As fast as it goes; ends with the test. */
static void publish_for_ever(const char *name, pid_t parent)
{
    static const nt_channel_row rows[] = {{"position", "m", 0, NT_Z, -0.1, 0.1, 0.0, 0.0, 0.0, (double)NAN}};
    nt_mailbox *mailbox = NULL;
    nt_mailbox_device device = nt_mailbox_device_defaults(NT_HALF_MASTER);
    device.period = PERIOD;
    device.timeout = TIMEOUT;
    device.rows = 1;
    device.channels = rows;
    if (nt_mailbox_open(&mailbox, name, &device, NULL) != NT_OK)
        _exit(1);
    for (uint64_t k = 1;; ++k) {
        const nt_reading reading = {.time = nt_mailbox_now(mailbox),
                                    .position = {[NT_Z] = STEP * (double)(k % 1000)},
                                    .valid = 1u << NT_Z,
                                    .buttons = (uint32_t)k};
        if (nt_mailbox_publish(mailbox, &reading) != NT_OK || getppid() != parent)
            _exit(2);
    }
}

/* --- the clock --- */

static const nt_mailbox_block *block; /* to look at it, also after the program */
static int64_t ticks_after;           /* the kill; -1: it lives */

/* The program's last sign of life, and since its death the ticks of the test. */
static int64_t follow(void)
{
    return (int64_t)nt_word_of(&block->beat) + (ticks_after < 0 ? 0 : ticks_after * (int64_t)(1e9 * PERIOD));
}

/* --- one life --- */

typedef struct life {
    pid_t program;
    nt_shared view;
    nt_mailbox_half half;
    nt_session *session;
} life;

static void begin(life *l, long number)
{
    char name[NT_MAILBOX_NAME];
    const struct timespec nap = {.tv_nsec = 200000};
    (void)snprintf(name, sizeof name, "test-kill-%ld-%ld", (long)getpid(), number);
    const pid_t parent = getpid();
    l->program = fork();
    if (l->program == 0)
        publish_for_ever(name, parent);
    assert_true(l->program > 0);
    while (nt_shared_attach(&l->view, "mailbox", name, sizeof(nt_mailbox_block), 0) != NT_OK)
        (void)nanosleep(&nap, NULL);
    block = l->view.memory;
    ticks_after = -1;
    while (nt_word_of(&block->published) == 0)
        (void)nanosleep(&nap, NULL);
    assert_int_equal(nt_mailbox_half_init(&l->half, name), NT_OK);
    l->half.clock = follow;
    nt_session_setup setup = nt_session_defaults();
    setup.preflight = 0;
    setup.rig.master.gauge = setup.rig.master.motor = 0;
    setup.rig.stage.resonance = 200.0; /* far from the rate of the loop */
    setup.rig.stage.quality = 1.0;
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.settings.gains.rate = 1.0 / PERIOD;
    setup.settings.gains.alpha_p = 1e-3;
    setup.master = (nt_hal_choice){nt_mailbox_backend(NT_HALF_MASTER), &l->half};
    l->session = open_session(&setup);
}

static void tick(life *l, nt_record *record)
{
    run(l->session, record, 1);
    const double z = record->master_position[NT_Z];
    if (record->state != NT_LATCHED) /* what was taken is whole */
        assert_true(z >= 0.0 && z == STEP * (double)llround(z / STEP));
}

/* As long as it lives: in each tick a new reading, and the session runs; unless the machine stopped the program between
 * its look at the clock and its next sign of life. */
static void live(life *l, long ticks)
{
    nt_record record;
    for (long i = 0; i < ticks; i += record.state == NT_RUN) {
        const uint64_t before = nt_word_of(&block->published);
        while (nt_word_of(&block->published) == before)
            continue;
        tick(l, &record);
        if (record.state != NT_RUN)
            assert_true(record.state == NT_HOLD && record.reasons == NT_REASON_MASTER_STALE);
    }
}

static void kill_program(life *l)
{
    assert_int_equal(kill(l->program, SIGKILL), 0);
    assert_int_equal(waitpid(l->program, NULL, 0), l->program);
}

/* In which tick after the kill it holds, and in which it latches. */
static void die(life *l, long *holds, long *latches)
{
    nt_record record;
    double first = (double)NAN;
    *holds = *latches = -1;
    for (ticks_after = 0; *latches < 0; ++ticks_after) {
        assert_true(ticks_after < 1000);
        tick(l, &record);
        const int is_lost = 1e-9 * (double)(ticks_after * (int64_t)(1e9 * PERIOD)) > TIMEOUT;
        assert_int_equal(record.state == NT_LATCHED, is_lost); /* in this tick, and not before */
        assert_int_equal((record.reasons & NT_REASON_DEVICE) != 0, is_lost);
        if (ticks_after == 0)
            first = record.master_position[NT_Z];
        else if (!is_lost) /* the last one that came, and nothing since */
            assert_true(record.master_position[NT_Z] == first);
        if (*holds < 0 && record.state == NT_HOLD) {
            *holds = ticks_after;
            assert_true(record.reasons & NT_REASON_MASTER_STALE);
        }
        if (is_lost)
            *latches = ticks_after;
    }
}

static void end(life *l)
{
    const nt_shared view = l->view;
    nt_session_close(l->session);
    l->view = view;
    (void)shm_unlink(view.name); /* what a killed program leaves until its name is taken again */
    nt_shared_close(&l->view);
}

static void killed_programs(void **state)
{
    (void)state;
    long earliest = 1000, latest = 0, latched = 0;
    uint64_t within = 0;
    for (long i = 0; i < kills; ++i) {
        life l;
        long holds, latches;
        begin(&l, i);
        live(&l, 3 + i % 8);
        kill_program(&l);
        within += nt_word_of(&block->readings_at[(nt_word_of(&block->published) + 1) & 1u]) == 0;
        die(&l, &holds, &latches);
        assert_true(holds >= 0 && holds < latches);
        earliest = holds < earliest ? holds : earliest;
        latest = holds > latest ? holds : latest;
        latched += latches == (long)(TIMEOUT / PERIOD) + 1;
        end(&l);
    }
    assert_int_equal(latched, kills);
    assert_true(latest <= 3);
    printf(
        "%ld kills, %llu within a write: HOLD after %ld .. %ld ticks, LATCHED after %ld, from the last sign of life\n",
        kills, (unsigned long long)within, earliest, latest, (long)(TIMEOUT / PERIOD) + 1);
}

int main(int count, char **arguments)
{
    kills = count > 1 ? strtol(arguments[1], NULL, 10) : kills;
    const struct CMUnitTest tests[] = {cmocka_unit_test(killed_programs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
