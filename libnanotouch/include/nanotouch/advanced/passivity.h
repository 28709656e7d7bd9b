/* SPDX-License-Identifier: BSD-3-Clause
 * Master, controller and stage between hand and tip must swallow what the master's damping is due, at least in part;
 * when they do not, the force gain backs off first, and when there is none left the motor adds damping. */
#ifndef NANOTOUCH_PASSIVITY_H
#define NANOTOUCH_PASSIVITY_H

#include <stdint.h>

#include "nanotouch/settings.h"
#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What does not change while it runs. */
typedef struct nt_passivity {
    double dead_zone;    /* what quantised positions may seem to release at full force [J] */
    double due;          /* b_m T times the share of the damping that must show [N s^2/m] */
    double force_gain;   /* K_f, which divides the damping that the operator feels [-] */
    double damping;      /* b_m [N s/m] */
    double credit;       /* b_m where no gauge sees the hand, which then also gives what the damping takes [N s/m] */
    double speed_filter; /* of the low-pass of the master's speed, per period [-] */
    double speed_floor;  /* what one step of the master seems to be [m/s] */
    double speed_limit;  /* the master cannot be so fast, a reading is wrong [m/s] */
    double period;       /* T [s] */
} nt_passivity;
/* One side, at the operator's scale. */
typedef struct nt_port {
    double force;    /* [N] */
    double position; /* [m] */
} nt_port;
typedef struct nt_passivity_state {
    nt_sum energy;  /* swallowed beyond what was due since the last event, at most NT_PASSIVITY_STORE dead zones [J] */
    double gain;    /* factor on K_f, 1 .. 0 [-] */
    double damping; /* share of the master's damping that the motor shall add, 0 .. 1 [-] */
    double speed;   /* of the master, filtered [m/s] */
    nt_port last_hand, last_tip;
    uint32_t trips;
} nt_passivity_state;
#define NT_PASSIVITY_STORE 10.0
/* What the observer needs of a rig and its gains; both have been checked. */
NT_API nt_passivity nt_passivity_make(const nt_rig *rig, const nt_gains *gains);
/* hand: (f_m, x_m), in; where there is no gauge (-tau_m, x_m), of the motor force that has been held since the last
 * step; tip: (alpha_f f_s, x_s/alpha_p), out. Returns the gain factor. */
NT_API NT_REALTIME double nt_passivity_step(const nt_passivity *passivity, nt_passivity_state *state,
                                            const nt_port *hand, const nt_port *tip);
/* What the motor shall add: -damping b v, 0 where steps of the sensor cannot be told from motion [N]. */
NT_API NT_REALTIME double nt_passivity_damping_force(const nt_passivity *passivity, const nt_passivity_state *state);
/* Neither gain to take away nor damping to add is left. */
NT_API NT_REALTIME int nt_passivity_is_exhausted(const nt_passivity_state *state);

#ifdef __cplusplus
}
#endif
#endif
