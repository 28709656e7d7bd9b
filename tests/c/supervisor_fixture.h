/* SPDX-License-Identifier: BSD-3-Clause
 * A supervisor that is given one tick at a time. */
#ifndef SUPERVISOR_FIXTURE_H
#define SUPERVISOR_FIXTURE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/control.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

static nt_touch touch;

static int make_touch(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    return nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL) != NT_OK;
}

/* What the supervisor is given in one tick. */
typedef struct input {
    nt_sample sample;
    double reference;
    int unstable;
    nt_supervisor_state history; /* runs that have lasted */
} input;

static input healthy(nt_state state)
{
    return (input){.sample = {.deflection[NT_Z] = 1e-9, .stage_position[NT_Z] = 1e-6},
                   .reference = 1e-6,
                   .history = {.state = state, .deflection = {.value = NAN}, .surface = 1e-6, .expected = 1e-6}};
}

static nt_state step(input *in)
{
    const nt_situation situation = {.reference = in->reference, .unstable = in->unstable};
    return nt_supervisor_step(&touch.supervisor, &in->history, &in->sample, &situation);
}

#endif
