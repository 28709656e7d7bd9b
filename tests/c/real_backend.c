/* SPDX-License-Identifier: BSD-3-Clause
 * A half that calls itself real, as a shared object: a hand that goes down, or a stage over a spring. REAL_MASTER says
 * which. All that it does counts in its own readings, so that a busy machine changes nothing. */
#include <math.h>
#include <stdio.h>

#include "nanotouch/hal_backend.h"

#define SPEED 1e-6    /* of the hand, in a reading [m] */
#define SURFACE 50e-9 /* travel at which the stage meets the spring [m] */
enum { SILENT_FROM = 270, SILENT_UNTIL = 280 };

typedef struct half {
    const nt_host *host;
    uint64_t calls, writes;
    double position, lift;
    uint32_t state; /* as it was told last */
} half;

static nt_status open_half(void *context, const nt_host *host, nt_problem *problem)
{
    (void)problem;
    *(half *)context = (half){.host = host};
    return NT_OK;
}

static nt_status configure_half(void *context, const nt_configuration *configuration, nt_problem *problem)
{
    (void)problem;
    ((half *)context)->lift = configuration->lift;
    return NT_OK;
}

static nt_status write_half(void *context, const nt_action *action)
{
    half *h = context;
    ++h->writes;
    h->state = action->state;
#ifndef REAL_MASTER
    h->position = action->target[NT_Z];
#endif
    return NT_OK;
}

static nt_status describe_half(void *context, nt_capabilities *capabilities)
{
    (void)context;
#ifdef REAL_MASTER
    capabilities->can = NT_IS_REAL;
#else
    capabilities->can = NT_IS_REAL | NT_CAN_FEEL;
#endif
    capabilities->axes = 1;
    return NT_OK;
}

/* The hand goes on as long as it is not stopped, and is silent for a while; the spring of the stage is as stiff as the
 * lever, which is never quite still. */
static nt_status read_half(void *context, nt_reading *reading)
{
    half *h = context;
    ++h->calls;
    const uint32_t size = reading->size;
#ifdef REAL_MASTER
    if (h->calls >= SILENT_FROM && h->calls < SILENT_UNTIL)
        return NT_OK;
    h->position += h->state < 2u ? SPEED : 0.0;
    const double felt = NAN;
    const uint32_t valid = 1u << NT_Z;
#else
    const double felt = (h->position > SURFACE ? 0.5 * (h->position - SURFACE) : 0.0) + 1e-12 * (double)(h->calls % 5u);
    const uint32_t valid = 1u << NT_Z | 1u << (NT_READS_FELT + NT_Z);
#endif
    *reading = (nt_reading){.size = size,
                            .sequence = h->calls,
                            .time = h->host->now(h->host),
                            .position = {NAN, NAN, h->position},
                            .felt = {NAN, NAN, felt},
                            .valid = valid};
    return NT_OK;
}

static void disarm_half(void *context)
{
    half *h = context;
    char text[64];
    h->position -= h->lift;
    (void)snprintf(text, sizeof text, "left after %lu writes", (unsigned long)h->writes);
    h->host->say(h->host, text);
}

NT_API const nt_backend *nanotouch_backend(void);
NT_API const nt_backend *nanotouch_backend(void)
{
    static half state;
    static const nt_backend backend = {.size = sizeof backend,
                                       .version = NT_HAL_API_VERSION,
#ifdef REAL_MASTER
                                       .name = "real master",
                                       .half = NT_HALF_MASTER,
#else
                                       .name = "real slave",
                                       .half = NT_HALF_SLAVE,
#endif
                                       .open = open_half,
                                       .describe = describe_half,
                                       .configure = configure_half,
                                       .read = read_half,
                                       .write = write_half,
                                       .disarm = disarm_half,
                                       .context = &state};
    return &backend;
}
