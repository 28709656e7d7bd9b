/* SPDX-License-Identifier: BSD-3-Clause
 * A touch on a microcontroller: a DAC and an ADC by nanotouch::core, the touch step and the plan's force in single
 * precision (tools/single.py), no operating system. What does not change is in plan.h. */
#ifndef APPS_MCU_TOUCH_H
#define APPS_MCU_TOUCH_H

#include "nanotouch/advanced/control.h"
#include "nanotouch/advanced/converters.h"
#include "nanotouch/hal.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

/* What the board gives: its SPI, its clock, and the end of a period. */
typedef struct board {
    nt_exchange exchange;
    void *bus;
    nt_host host;
    int has_no_lever;            /* it is computed above the plan's sample: to train a hand, or to rehearse */
    void (*wait)(void *context); /* until the next period begins; a timer's interrupt on a real board */
    void *context;
} board;

/* What came of it. */
typedef struct outcome {
    nt_status status;
    uint32_t state; /* nt_state at the end */
    long ticks;
    double force;         /* at the end [N] */
    double weakest;       /* the strongest pull on the way, negative [N] */
    double travel;        /* of the stage, at the end [m] */
    double largest;       /* force on the way [N] */
    uint64_t command_sum; /* over all commands: the same on each machine whose arithmetic is the same */
} outcome;

/* Comes down until the set-point is felt, holds it, and lifts: `ticks` periods of 0.1 ms. */
outcome touch_run(const board *at, long ticks);

#endif
