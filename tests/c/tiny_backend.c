/* SPDX-License-Identifier: BSD-3-Clause
 * A backend as a shared object, as small as one can be; the variants are wrong in one thing each. */
#include "nanotouch/hal_backend.h"

static nt_status read_position(void *context, nt_reading *reading)
{
    const nt_host *const *host = context;
    reading->sequence += 1;
    reading->time = (*host)->now(*host);
    reading->position[NT_Z] = 1e-3;
    reading->valid = 1u << NT_Z;
    return NT_OK;
}

static nt_status write_nothing(void *context, const nt_action *action)
{
    (void)context, (void)action;
    return NT_OK;
}

static nt_status keep_host(void *context, const nt_host *host, nt_problem *problem)
{
    (void)problem;
    *(const nt_host **)context = host;
    host->say(host, "tiny is open");
    return NT_OK;
}

static nt_status describe(void *context, nt_capabilities *capabilities)
{
    (void)context;
    capabilities->can = 0;
    capabilities->axes = 1;
    return NT_OK;
}

#ifndef TINY_VERSION
#define TINY_VERSION NT_HAL_API_VERSION
#endif
#ifndef TINY_ENTRY
#define TINY_ENTRY nanotouch_backend
#endif

NT_API const nt_backend *TINY_ENTRY(void);
NT_API const nt_backend *TINY_ENTRY(void)
{
    static const nt_host *host;
    static const nt_backend backend = {.size = sizeof backend,
                                       .version = TINY_VERSION,
                                       .name = "tiny",
                                       .half = NT_HALF_MASTER,
                                       .open = keep_host,
                                       .describe = describe,
                                       .read = read_position,
#ifndef TINY_READS_ONLY
                                       .write = write_nothing,
#endif
                                       .context = &host};
#ifdef TINY_HAS_NO_TABLE
    return 0;
#else
    (void)write_nothing;
    return &backend;
#endif
}
