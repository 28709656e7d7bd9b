/* SPDX-License-Identifier: BSD-3-Clause
 * A backend of one's own: a master that is a table of functions, in a session with the simulated slave. A haptic device
 * puts its driver into read and write. */
#include <math.h>
#include <stdio.h>

#include "nanotouch/hal_backend.h"
#include "nanotouch/session.h"

typedef struct device {
    const nt_host *host;
    uint64_t ticks;
    double pushed; /* the largest force that the motor was asked for [N] */
} device;

static nt_status open_device(void *context, const nt_host *host, nt_problem *problem)
{
    (void)problem;
    ((device *)context)->host = host;
    return NT_OK;
}

static nt_status describe(void *context, nt_capabilities *capabilities)
{
    (void)context;
    capabilities->can = NT_CAN_PUSH;
    capabilities->axes = 1;
    return NT_OK;
}

/* This hand follows a script; what is not measured stays NaN. */
static nt_status read_position(void *context, nt_reading *reading)
{
    device *one = context;
    reading->sequence = ++one->ticks;
    reading->time = one->host->now(one->host);
    reading->position[NT_Z] = 1e-3 * sin(1e-4 * (double)one->ticks);
    reading->valid = 1u << NT_Z;
    return NT_OK;
}

static nt_status write_force(void *context, const nt_action *action)
{
    device *one = context;
    one->pushed = fmax(one->pushed, fabs(action->target[NT_Z]));
    return NT_OK;
}

int main(void)
{
    const nt_backend backend = {.size = sizeof backend,
                                .version = NT_HAL_API_VERSION,
                                .name = "scripted",
                                .half = NT_HALF_MASTER,
                                .open = open_device,
                                .describe = describe,
                                .read = read_position,
                                .write = write_force};
    device one = {0};
    nt_session_setup setup = nt_session_defaults();
    setup.rig.master.gauge = 0; /* it does not measure the operator's force */
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.master = (nt_hal_choice){&backend, &one};
    nt_session *session = NULL;
    nt_problem problem = {0};
    nt_status status = nt_session_open(&session, &setup, &problem);
    if (status == NT_OK)
        status = nt_session_advance(session, 20000);
    if (status != NT_OK) {
        char text[200];
        fprintf(stderr, "%s: %s\n", nt_status_message(status), nt_problem_print(&problem, text, sizeof text));
    } else {
        printf("%llu readings, the motor pushed with up to %.3f N\n", (unsigned long long)one.ticks, one.pushed);
    }
    nt_session_close(session);
    return status == NT_OK ? 0 : 1;
}
