/* SPDX-License-Identifier: BSD-3-Clause
 * What is promised to the hand that holds the master, to be read before arming: whatever happens, the motor's force
 * never rises above its value before, it is gone soon, and it gives the hand little energy meanwhile. */
#ifndef NANOTOUCH_MOTOR_BOUND_H
#define NANOTOUCH_MOTOR_BOUND_H

#include "nanotouch/settings.h"

#ifdef __cplusplus
extern "C" {
#endif

/* After any event that uncouples hand and tip a force F falls in a line to 0 within
 *     min(50 ms, 2 W/(|F| v)), W = 1 mJ,
 * or what limits.motor_rate allows, the longer. v is master.max_speed v_h with what a handle of m = 0.1 kg (the
 * master's mass, if that is less) gains that is let go meanwhile: (v_h + sqrt(v_h^2 + 2 W/m))/2, so that F gives W. */
typedef struct nt_motor_bound {
    double force;        /* on the hand at most, all axes together, before an event and after it [N] */
    double speed;        /* v [m/s] */
    double fade_product; /* 2 W/v: |F| times the time in which F fades, where neither end of that is met [N s] */
    double fade_time;    /* of that largest force [s] */
    double delay;        /* after which a command acts, the force stays so long [s] */
    double energy;       /* that the motor gives the hand after an event, at most [J] */
} nt_motor_bound;

/* Of a rig and its settings; both have been checked. */
NT_API nt_motor_bound nt_motor_bound_compute(const nt_rig *rig, const nt_settings *settings);

#ifdef __cplusplus
}
#endif
#endif
