/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TESTS_FAILURE_OF_H
#define TESTS_FAILURE_OF_H

#include "nanotouch/advanced/sim.h"
#include "nanotouch/margins.h"

/* Which failure of the guarantee a fault is; NT_FAILURES: none, the first number holds. */
static inline nt_failure failure_of(nt_fault_kind kind, nt_channel channel)
{
    if (kind == NT_FAULT_JUMP || kind == NT_FAULT_LIMIT)
        return NT_FAILURE_SLIP;
    if (channel == NT_CHANNEL_STAGE)
        return NT_FAILURE_STAGE;
    const int lies = kind == NT_FAULT_GAIN || kind == NT_FAULT_DRIFT || kind == NT_FAULT_NOISE || kind == NT_FAULT_SLIP;
    if (channel == NT_CHANNEL_DEFLECTION && (lies || kind == NT_FAULT_STUCK))
        return lies ? NT_FAILURE_READ_OUT : NT_FAILURE_SENSOR;
    if (channel == NT_CHANNEL_STAGE_POSITION && (lies || kind == NT_FAULT_STUCK))
        return NT_FAILURE_STAGE;
    return NT_FAILURES;
}

#endif
