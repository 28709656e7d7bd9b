/* SPDX-License-Identifier: BSD-3-Clause
 * A program that publishes as fast as it goes, in another process: no reading is torn, none comes twice as new. */
#define _DEFAULT_SOURCE
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "nanotouch/hal.h"
#include "nanotouch/mailbox.h"

static int64_t host_now(const nt_host *host)
{
    struct timespec now;
    (void)host;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}
static const nt_host host = {sizeof host, NT_HAL_API_VERSION, host_now, NULL, NULL};

#define STEP 1e-9

/* Every number of a reading follows from one: a torn one shows. Ends with the test. */
static void publish_for_ever(pid_t parent)
{
    char name[NT_MAILBOX_NAME];
    (void)snprintf(name, sizeof name, "test-race-%ld", (long)getpid());
    nt_mailbox *mailbox = NULL;
    nt_mailbox_device device = nt_mailbox_device_defaults(NT_HALF_MASTER);
    device.axes = NT_AXES;
    device.can = NT_CAN_FEEL;
    if (nt_mailbox_open(&mailbox, name, &device, NULL) != NT_OK)
        _exit(1);
    for (uint64_t k = 1;; ++k) {
        const double z = STEP * (double)k;
        const nt_reading reading = {.time = nt_mailbox_now(mailbox),
                                    .position = {z, 2.0 * z, 3.0 * z},
                                    .felt = {4.0 * z, 5.0 * z, 6.0 * z},
                                    .valid = (1u << NT_READS_AMPLITUDE) - 1u, /* it does not tap */
                                    .buttons = (uint32_t)k};
        if (nt_mailbox_publish(mailbox, &reading) != NT_OK || getppid() != parent)
            _exit(2);
    }
}

static int is_whole(const nt_reading *r)
{
    const double z = STEP * (double)r->sequence; /* the mailbox has numbered as the program has */
    int whole = r->buttons == (uint32_t)r->sequence;
    for (int i = 0; i < NT_AXES; ++i)
        whole &= r->position[i] == (i + 1) * z && r->felt[i] == (i + 4) * z;
    return whole;
}

static void a_racing_writer_tears_nothing(void **state)
{
    (void)state;
    const struct timespec nap = {.tv_nsec = 1000000};
    const pid_t parent = getpid(), child = fork();
    if (child == 0)
        publish_for_ever(parent);
    char name[NT_MAILBOX_NAME];
    (void)snprintf(name, sizeof name, "test-race-%ld", (long)child);
    nt_mailbox_half mailbox;
    assert_int_equal(nt_mailbox_half_init(&mailbox, name), NT_OK);
    nt_hal hal;
    const nt_hal_choice choice = {nt_mailbox_backend(NT_HALF_MASTER), &mailbox};
    while (nt_hal_open(&hal, NT_HALF_MASTER, &choice, &host, NULL) != NT_OK) {
        assert_int_equal(waitpid(child, NULL, WNOHANG), 0); /* it publishes */
        (void)nanosleep(&nap, NULL);
    }
    const nt_configuration configuration = {sizeof configuration, 0, 1e-3, 1e-6, ""};
    assert_int_equal(nt_hal_configure(&hal, &configuration, NULL), NT_OK);
    uint64_t sequence = 0;
    while (mailbox.counts.readings < 20000) { /* however slow the machine is */
        nt_reading reading = {.size = sizeof reading};
        if (hal.backend->read(hal.context, &reading) != NT_OK || reading.sequence == 0)
            continue;
        assert_true(is_whole(&reading));
        assert_true(reading.sequence >= sequence);
        sequence = reading.sequence;
    }
    assert_int_equal(kill(child, SIGKILL), 0);
    assert_int_equal(waitpid(child, NULL, 0), child);
    assert_int_equal(mailbox.counts.unsound, 0);
    nt_hal_close(&hal);
    char full[NT_MAILBOX_NAME + 32];
    (void)snprintf(full, sizeof full, "/nanotouch.mailbox.%s", name);
    (void)shm_unlink(full); /* what a killed program leaves until its name is taken again */
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_racing_writer_tears_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
