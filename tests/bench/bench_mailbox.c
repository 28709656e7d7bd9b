/* SPDX-License-Identifier: BSD-3-Clause
 * Polls of a mailbox: one read and one write of the session's end, with a new reading each time or none. For
 * bench_mailbox.py, which counts their instructions.
 *
 *     bench_mailbox new|old POLLS */
#define _DEFAULT_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "nanotouch/mailbox.h"
#include "nanotouch/nanotouch.h"

static int64_t host_now(const nt_host *host)
{
    return nt_mailbox_now(host->context);
}

static int poll_mailbox(nt_mailbox *mailbox, nt_hal *hal, int is_new, long polls)
{
    const nt_action action = {.size = sizeof action};
    for (long i = 0; i < polls; ++i) {
        const nt_reading reading = {.time = nt_mailbox_now(mailbox), .valid = 1u << NT_Z};
        if (is_new)
            (void)nt_mailbox_publish(mailbox, &reading);
        else
            nt_mailbox_beat(mailbox);
        if (nt_hal_read(hal) != NT_OK || nt_hal_write(hal, &action) != NT_OK)
            return 1;
    }
    return !(hal->reading.valid >> NT_Z & 1u);
}

int main(int argc, char **argv)
{
    const long polls = argc == 3 ? atol(argv[2]) : 0;
    if (polls < 1) {
        (void)fprintf(stderr, "bench_mailbox new|old POLLS\n");
        return 2;
    }
    char name[NT_MAILBOX_NAME];
    (void)snprintf(name, sizeof name, "bench-%ld", (long)getpid());
    nt_mailbox *mailbox = NULL;
    nt_mailbox_device device = nt_mailbox_device_defaults(NT_HALF_MASTER);
    device.can = NT_CAN_PUSH;
    device.timeout = 1.0;
    nt_mailbox_half half;
    nt_hal hal;
    const nt_hal_choice choice = {nt_mailbox_backend(NT_HALF_MASTER), &half};
    nt_status status = nt_mailbox_open(&mailbox, name, &device, NULL);
    const nt_host host = {sizeof host, NT_HAL_API_VERSION, host_now, NULL, mailbox};
    if (status == NT_OK)
        status = nt_mailbox_half_init(&half, name);
    if (status == NT_OK)
        status = nt_hal_open(&hal, NT_HALF_MASTER, &choice, &host, NULL);
    const nt_reading first = {.time = 1, .valid = 1u << NT_Z};
    int failed = status != NT_OK || nt_mailbox_publish(mailbox, &first) != NT_OK ||
                 poll_mailbox(mailbox, &hal, strcmp(argv[1], "new") == 0, polls);
    if (status == NT_OK)
        nt_hal_close(&hal);
    nt_mailbox_close(mailbox);
    return failed;
}
