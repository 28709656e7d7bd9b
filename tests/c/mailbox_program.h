/* SPDX-License-Identifier: BSD-3-Clause
 * A program behind a mailbox, within a test: a master that gives its position and takes a force, or a slave that goes
 * where it is told and lifts when nobody drives it any more. Its clock and that of the session's end are the test's. */
#ifndef TESTS_MAILBOX_PROGRAM_H
#define TESTS_MAILBOX_PROGRAM_H

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "nanotouch/mailbox.h"

static _Atomic int64_t mailbox_clock = 1000000000; /* [ns] */

static inline int64_t mailbox_time(void)
{
    return atomic_load(&mailbox_clock);
}

/* Names of one process do not meet those of another. */
static inline const char *mailbox_name(char name[NT_MAILBOX_NAME], const char *what)
{
    (void)snprintf(name, NT_MAILBOX_NAME, "test-%s-%ld", what, (long)getpid());
    return name;
}

static const nt_channel_row mailbox_rows[2][3] = {
    {{"position", "m", 0, NT_Z, -0.1, 0.1, 0.0, 0.0, 0.0, (double)NAN},
     {"motor force", "N", 1, NT_Z, -3.0, 3.0, 0.0, 0.0, 0.0, 0.0}},
    {{"position", "m", 0, NT_Z, -1e-5, 1e-5, 0.0, 0.0, 0.0, (double)NAN},
     {"deflection", "m", 0, NT_Z, -1e-6, 1e-6, 0.0, 0.0, 0.0, (double)NAN},
     {"travel", "m", 1, NT_Z, -1e-5, 1e-5, 0.0, 0.0, 0.0, (double)NAN}}};

static inline nt_mailbox_device mailbox_device(nt_half half)
{
    nt_mailbox_device device = nt_mailbox_device_defaults(half);
    device.can = half == NT_HALF_MASTER ? NT_CAN_PUSH : NT_CAN_FEEL;
    device.channels = mailbox_rows[half];
    device.rows = half == NT_HALF_MASTER ? 2 : 3;
    device.timeout = 0.01;
    device.clock = mailbox_time;
    return device;
}

typedef struct mailbox_program {
    nt_mailbox *mailbox;
    nt_half half;
    double z, force; /* of a slave's stage [m]; of a master's motor [N] */
    double lift;     /* that a slave owes [m] */
    int is_armed;
    int is_silent, is_dead, ends; /* its device says nothing; it does nothing at all; its thread ends */
    int is_led;                   /* while it is armed its thread measures nothing: the test's periods do */
    pthread_mutex_t lock;
    pthread_t thread;
} mailbox_program;

/* One turn of the loop of every such program; with the lock held. */
static inline void mailbox_turn(mailbox_program *p, int is_thread)
{
    nt_mailbox_request request;
    if (p->is_dead)
        return;
    nt_mailbox_ask(p->mailbox, &request);
    if (is_thread && p->is_led && p->is_armed && request.is_armed)
        return;
    if (p->half == NT_HALF_MASTER)
        p->force = request.target[NT_Z];
    else if (request.is_armed && !isnan(request.target[NT_Z]))
        p->z = request.target[NT_Z];
    else if (p->is_armed && !request.is_armed)
        p->z -= p->lift;
    p->is_armed = request.is_armed;
    p->lift = request.lift;
    nt_reading reading = {.position = {[NT_Z] = p->half == NT_HALF_SLAVE ? p->z : 1e-3},
                          .time = nt_mailbox_now(p->mailbox),
                          .valid = 1u << NT_Z};
    if (p->half == NT_HALF_SLAVE)
        reading.valid |= 1u << (NT_READS_FELT + NT_Z);
    if (p->is_silent)
        nt_mailbox_beat(p->mailbox);
    else
        (void)nt_mailbox_publish(p->mailbox, &reading);
}

static inline void *mailbox_run(void *context)
{
    mailbox_program *p = context;
    const struct timespec nap = {.tv_nsec = 200000};
    for (int ends = 0; !ends; (void)nanosleep(&nap, NULL)) {
        (void)pthread_mutex_lock(&p->lock);
        mailbox_turn(p, 1);
        ends = p->ends;
        (void)pthread_mutex_unlock(&p->lock);
    }
    return NULL;
}

static inline nt_status mailbox_start(mailbox_program *p, nt_half half, const char *name)
{
    const nt_mailbox_device device = mailbox_device(half);
    *p = (mailbox_program){.half = half, .lock = PTHREAD_MUTEX_INITIALIZER};
    const nt_status status = nt_mailbox_open(&p->mailbox, name, &device, NULL);
    if (status == NT_OK && pthread_create(&p->thread, NULL, mailbox_run, p) != 0)
        return NT_E_DEVICE;
    return status;
}

static inline void mailbox_set(mailbox_program *p, int *what, int value)
{
    (void)pthread_mutex_lock(&p->lock);
    *what = value;
    (void)pthread_mutex_unlock(&p->lock);
}

static inline void mailbox_end(mailbox_program *p)
{
    mailbox_set(p, &p->ends, 1);
    (void)pthread_join(p->thread, NULL);
    nt_mailbox_close(p->mailbox);
}

#endif
