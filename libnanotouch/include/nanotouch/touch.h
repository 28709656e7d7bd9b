/* SPDX-License-Identifier: BSD-3-Clause
 * The touch step: numbers in, numbers out, once per period. It sees neither device nor clock nor scene and may be
 * called from any loop at a fixed rate. */
#ifndef NANOTOUCH_TOUCH_H
#define NANOTOUCH_TOUCH_H

#include "nanotouch/passivity.h"
#include "nanotouch/settings.h"
#include "nanotouch/stage_loop.h"
#include "nanotouch/supervisor.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All that does not change while it runs. Immutable after nt_touch_make. */
typedef struct nt_touch {
    nt_rig rig;
    nt_settings settings;
    nt_mode mode;
    double period; /* T [s] */
    nt_stage_loop stage_loop;
    double force_filter; /* of the low-pass, per period [-] */
    double speed_filter; /* of the master's speed estimate, per period [-] */
    nt_passivity passivity;
} nt_touch;
typedef struct nt_touch_state {
    nt_supervisor_state supervisor;
    nt_passivity_state passivity;
    nt_stage_loop_state stage_loop;
    double reference;                       /* where the stage shall be [m] */
    double offset;                          /* reference = alpha_p x_m + offset: re-indexed after every stop [m] */
    double engaged;                         /* 0 .. 1, fades the force in and out [-] */
    double filtered_force;                  /* f_m behind its low-pass [N] */
    double speed;                           /* estimate of the master's speed [m/s] */
    double last_position;                   /* x_m of the last valid sample [m] */
    double motor_force;                     /* last command [N] */
    double coupled_force;                   /* what is left of the last command given in RUN [N] */
    double retracted;                       /* lifted so far [m] */
    double target_x, target_y, target_time; /* lateral set-point [m], time left to get there [s] */
    nt_command command;                     /* last command */
    uint64_t ticks;
} nt_touch_state;

/* Checks rig and settings, and that no limit promises more than the rig can keep. */
NT_API nt_status nt_touch_make(nt_touch *touch, const nt_rig *rig, const nt_settings *settings, nt_mode mode,
                               nt_problem *problem);
/* A loop at rest at (x, y), the stage at 0, the master at x_m (both finite), armed. */
NT_API nt_touch_state nt_touch_start(const nt_touch *touch, double master_position, double x, double y);
/* One control period. */
NT_API NT_REALTIME void nt_touch_step(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample,
                                      nt_command *command);
/* Sends the tip to (x, y) on a straight line within `duration` >= 0 [s], no faster than the lateral limit. */
NT_API NT_REALTIME nt_status nt_touch_aim(const nt_touch *touch, nt_touch_state *state, double x, double y,
                                          double duration);
/* Back to RUN after RETRACT; after LATCHED only with confirmed = 1 (a person at the rig). The force fades in again, the
 * tip stays where it is until the next nt_touch_aim. NT_E_STATE if LATCHED and not confirmed. */
NT_API nt_status nt_touch_arm(nt_touch_state *state, int confirmed);

#ifdef __cplusplus
}
#endif
#endif
