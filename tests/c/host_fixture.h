/* SPDX-License-Identifier: BSD-3-Clause
 * A host whose clock goes on only where a test lets it. */
#ifndef TESTS_HOST_FIXTURE_H
#define TESTS_HOST_FIXTURE_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "nanotouch/hal.h"

static int64_t clock_now;

static int64_t now(const nt_host *host)
{
    (void)host;
    return clock_now;
}

static void pass(const nt_host *host, double period)
{
    (void)host;
    clock_now += llround(1e9 * period);
}

static const nt_host host = {sizeof host, NT_HAL_API_VERSION, now, NULL, NULL};

#endif
