/* SPDX-License-Identifier: BSD-3-Clause
 * A half of a rig that writes down what it is asked, and does what its fields say. */
#ifndef TESTS_DEVICE_FIXTURE_H
#define TESTS_DEVICE_FIXTURE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "nanotouch/hal.h"

enum { ALL = (1u << NT_READS) - 1u };

typedef struct device {
    char calls[32]; /* a letter for each: o d c a r w D C */
    nt_status opens, describes, configures, arms, reads, writes;
    nt_capabilities says;
    int describes_itself;
    nt_reading next; /* what is read; its sequence 0: nothing new */
    nt_action told;
    nt_configuration told_first;
    uint32_t size; /* of the reading that it was handed */
} device;

static inline nt_status note(device *d, char call, nt_status status)
{
    const size_t length = strlen(d->calls);
    if (length + 1 < sizeof d->calls) /* the first ones count */
        d->calls[length] = call;
    return status;
}

static inline nt_status open_device(void *context, const nt_host *host, nt_problem *problem)
{
    device *d = context;
    (void)host;
    if (d->opens != NT_OK && problem)
        *problem = (nt_problem){.field = "no such line"};
    return note(d, 'o', d->opens);
}

static inline nt_status describe_device(void *context, nt_capabilities *capabilities)
{
    device *d = context;
    const uint32_t size = capabilities->size; /* the host's to set */
    if (d->describes_itself)
        *capabilities = d->says;
    capabilities->size = size;
    return note(d, 'd', d->describes);
}

static inline nt_status configure_device(void *context, const nt_configuration *configuration, nt_problem *problem)
{
    device *d = context;
    (void)problem;
    d->told_first = *configuration;
    return note(d, 'c', d->configures);
}

static inline nt_status arm_device(void *context)
{
    device *d = context;
    return note(d, 'a', d->arms);
}

static inline nt_status read_device(void *context, nt_reading *reading)
{
    device *d = context;
    d->size = reading->size;
    if (d->next.sequence != 0)
        *reading = d->next;
    return note(d, 'r', d->reads);
}

static inline nt_status write_device(void *context, const nt_action *action)
{
    device *d = context;
    d->told = *action;
    return note(d, 'w', d->writes);
}

static inline void disarm_device(void *context)
{
    (void)note(context, 'D', NT_OK);
}

static inline void close_device(void *context)
{
    (void)note(context, 'C', NT_OK);
}

static inline nt_backend backend_of(nt_half half)
{
    return (nt_backend){.size = sizeof(nt_backend),
                        .version = NT_HAL_API_VERSION,
                        .name = "device",
                        .half = half,
                        .open = open_device,
                        .describe = describe_device,
                        .configure = configure_device,
                        .arm = arm_device,
                        .read = read_device,
                        .write = write_device,
                        .disarm = disarm_device,
                        .close = close_device};
}

static inline nt_reading reading_of(uint64_t sequence)
{
    const double at = (double)sequence;
    return (nt_reading){.size = sizeof(nt_reading),
                        .sequence = sequence,
                        .time = 1000 * (int64_t)sequence,
                        .position = {at, 2.0 * at, 3.0 * at},
                        .felt = {4.0 * at, 5.0 * at, 6.0 * at},
                        .amplitude = 7.0 * at,
                        .lag = 8.0 * at,
                        .valid = ALL};
}

static inline nt_status open_half(nt_hal *hal, const nt_backend *backend, device *d)
{
    const nt_hal_choice choice = {backend, d};
    return nt_hal_open(hal, backend->half, &choice, NULL, NULL);
}

#endif
