/* SPDX-License-Identifier: BSD-3-Clause
 * A haptic device as a program of its own: copy this file, and put your device into hand_position and hand_push.
 *
 *     cc -std=c11 -O2 -o device device.c -lnanotouch -lm
 *     ./device NAME       then, elsewhere: nanotouch.Session(master=nanotouch.hal.Mailbox(NAME), ...) */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <time.h>

#include "nanotouch/mailbox.h"

#define PERIOD 1e-3   /* between two readings [s] */
#define TRAVEL 0.02   /* z runs over half of it to either side [m] */
#define STRONGEST 3.0 /* force of the motor [N] */

static volatile sig_atomic_t ends;

static void end(int number)
{
    (void)number;
    ends = 1;
}

/* z [m], + towards the sample. This hand follows a script. */
static double hand_position(double seconds)
{
    return -8e-3 + 3.4e-3 * (1.0 - cos(2.0 * 3.14159265358979 * seconds / 4.0));
}

/* The force of the motor [N], + towards the sample. Nobody feels this one. */
static void hand_push(double force)
{
    (void)force;
}

static nt_status open_mailbox(nt_mailbox **mailbox, const char *name, nt_problem *problem)
{
    static const nt_channel_row rows[] = {
        {"position", "m", 0, NT_Z, -0.5 * TRAVEL, 0.5 * TRAVEL, 0.0, 0.0, 0.0, (double)NAN},
        {"motor force", "N", 1, NT_Z, -STRONGEST, STRONGEST, 0.0, 0.0, 0.0, 0.0},
    };
    nt_mailbox_device device = nt_mailbox_device_defaults(NT_HALF_MASTER);
    device.can = NT_CAN_PUSH;
    device.period = PERIOD;
    device.rows = 2;
    device.channels = rows;
    return nt_mailbox_open(mailbox, name, &device, problem);
}

int main(int count, char **arguments)
{
    const struct timespec nap = {.tv_nsec = (long)(0.5e9 * PERIOD)}; /* twice as often as it promises */
    nt_mailbox *mailbox = NULL;
    nt_problem problem = {0};
    const nt_status status = open_mailbox(&mailbox, count > 1 ? arguments[1] : "device", &problem);
    if (status != NT_OK) {
        fprintf(stderr, "%s: %s\n", nt_status_message(status), problem.field ? problem.field : "");
        return 1;
    }
    (void)signal(SIGINT, end);
    (void)signal(SIGTERM, end);
    const int64_t start = nt_mailbox_now(mailbox);
    while (!ends) {
        nt_mailbox_request request;
        nt_mailbox_ask(mailbox, &request);
        hand_push(request.target[NT_Z]); /* 0 N unless a session drives */
        const int64_t now = nt_mailbox_now(mailbox);
        const nt_reading reading = {
            .time = now, .position = {[NT_Z] = hand_position(1e-9 * (double)(now - start))}, .valid = 1u << NT_Z};
        (void)nt_mailbox_publish(mailbox, &reading);
        (void)nanosleep(&nap, NULL);
    }
    hand_push(0.0);
    nt_mailbox_close(mailbox);
    return 0;
}
