/* SPDX-License-Identifier: BSD-3-Clause
 * Parts of the touch step, of which it holds constants and states, and what is promised and tried before arming. */
#ifndef NANOTOUCH_ADVANCED_CONTROL_H
#define NANOTOUCH_ADVANCED_CONTROL_H

#include <stdint.h>

#include "nanotouch/settings.h"
#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- The stage follows a reference: notch on the resonance, integral action on the read-out. --- */

typedef struct nt_stage_loop {
    nt_sum b[3], a[3]; /* biquad in z^-1, a[0] = 1: zeros on the sampled poles of the stage */
    nt_sum integral;   /* integral gain per period [-] */
} nt_stage_loop;
typedef struct nt_stage_loop_state {
    nt_sum w[2];       /* filter memory [m] */
    nt_sum correction; /* integral of the error [m] */
} nt_stage_loop_state;

/* --- Master, controller and stage between hand and tip must swallow what the master's damping is due, at least in
 * part; when they do not, the force gain backs off first, and when there is none left the motor adds damping. --- */

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

/* --- What is promised to the hand that holds the master, to be read before arming: whatever happens, the motor's force
 * never rises above its value before, it is gone soon, and it gives the hand little energy meanwhile. --- */

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

/* --- What is done before arming: zero the gauges (tare), and see that the stage moves as it is told (sign test). Steps
 * like the touch step: a sample in, a command out, once per period; the probe clear of the surface, nobody touching the
 * master. --- */

/* What the sensors say where nothing is. */
typedef struct nt_tare {
    double deflection;     /* [m] */
    double operator_force; /* [N] */
} nt_tare;

typedef enum nt_preflight_verdict {
    NT_PREFLIGHT_RUNNING,
    NT_PREFLIGHT_PASSED,
    NT_PREFLIGHT_BAD_SAMPLE,       /* not a number, a device gone, a stop pressed */
    NT_PREFLIGHT_DEFLECTION_BIAS,  /* above limits.deflection_bias */
    NT_PREFLIGHT_DEFLECTION_DRIFT, /* above limits.deflection_drift */
    NT_PREFLIGHT_GAUGE_BIAS,
    NT_PREFLIGHT_GAUGE_DRIFT,
    NT_PREFLIGHT_STAGE /* it does not move, or the wrong way */
} nt_preflight_verdict;

typedef struct nt_preflight {
    nt_rig rig;
    nt_limits limits;
    double period;   /* T [s] */
    uint32_t ticks;  /* of each of the two halves of the tare */
    uint32_t move;   /* ticks that a move of the stage takes, and as many to settle */
    double distance; /* the stage draws back by this [m] */
} nt_preflight;
typedef struct nt_preflight_state {
    nt_preflight_verdict verdict;
    uint32_t tick;
    nt_tare sums[2];     /* of the halves */
    nt_tare tare;        /* found; valid from PASSED on */
    double rest, lifted; /* sums of the read-out before the move and after it [m] */
    double measure;      /* what the verdict is about [unit of its limit] */
} nt_preflight_state;
/* One period. The command leaves motor and lateral position alone. */
NT_API NT_REALTIME nt_preflight_verdict nt_preflight_step(const nt_preflight *preflight, nt_preflight_state *state,
                                                          const nt_sample *sample, nt_command *command);

#ifdef __cplusplus
}
#endif
#endif
