/* SPDX-License-Identifier: BSD-3-Clause
 * The plant: how probe, stage, master, hand and sensors of the simulated rig move and measure. Linear parts are
 * discretised exactly (zero-order hold), so that no result depends on an integrator. States are caller-owned, fixed in
 * size and may be copied. Every step function is real-time safe. */
#ifndef NANOTOUCH_DYNAMICS_H
#define NANOTOUCH_DYNAMICS_H

#include "nanotouch/random.h"
#include "nanotouch/rig.h"
#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- probe: quasi-static cantilever (Eq. 2-3 at rest): k_c zeta = F(z_t), z_t = z_b + zeta cos(alpha) --- */

/* The force on the tip at height z_t, as a function that may be called at trial heights. */
typedef struct nt_force_field {
    nt_law_value (*eval)(void *context, double z_t); /* pure: the force if the tip stood at z_t */
    void (*advance)(void *context, double z_t);      /* commits history when the tip has moved to z_t; may be NULL */
    void *context;
    double length; /* the shortest distance over which F changes shape [m] */
} nt_force_field;

typedef struct nt_cantilever_state {
    double deflection; /* zeta [m] */
    double tip_height; /* z_t [m] */
} nt_cantilever_state;
NT_API nt_cantilever_state nt_cantilever_at(double base_height);
/* Moves the base to base_height [m] and lets the tip settle: downhill from where it is to the next stable equilibrium,
 * through jump-in and snap-off. At most about 400 evaluations, usually 2 to 4. NT_OK; NT_E_ARGUMENT (spring constant or
 * field length not positive, state untouched); NT_E_NO_CONVERGENCE, or NT_E_NOT_FINITE where the field is, with the
 * state left at the last place the tip passed. Residual in info: the force out of balance, over K length. */
NT_API NT_REALTIME nt_status nt_cantilever_settle(nt_cantilever_state *state, const nt_probe *probe,
                                                  const nt_force_field *field, double base_height, nt_solve_info *info);

/* --- stage: x_s'' /wn^2 + x_s'/(wn Q) + x_s = u - f/k_stage (Eq. 13 repaired, E15), u the command and f the tip force,
 *     + pushing the stage back --- */
typedef struct nt_stage_state {
    double position; /* x_s [m] */
    double speed;    /* [m/s] */
} nt_stage_state;
typedef struct nt_stage_model {
    double phi[2][2], gamma[2]; /* exact zero-order-hold transition over one period */
    nt_stage stage;
} nt_stage_model;
NT_API nt_status nt_stage_model_init(nt_stage_model *model, const nt_stage *stage, double period);
NT_API NT_REALTIME void nt_stage_step(const nt_stage_model *model, nt_stage_state *state, double command, double force);

/* --- master: m x'' + b x' = f (Eq. 12), f = motor + operator force, between hard end stops --- */
typedef struct nt_master_state {
    double position; /* x_m [m] */
    double speed;    /* [m/s] */
} nt_master_state;
typedef struct nt_master_model {
    double phi[2][2], gamma[2];
    nt_master master;
} nt_master_model;
NT_API nt_status nt_master_model_init(nt_master_model *model, const nt_master *master, double period);
NT_API NT_REALTIME void nt_master_step(const nt_master_model *model, nt_master_state *state, double force);

/* --- hand: goes straight to a target over a time, then stays; a script is a sequence of targets --- */
typedef struct nt_hand_target {
    double force;    /* operator force, + towards the sample [N] */
    double x, y;     /* lateral position [m] */
    double duration; /* time to get there [s], >= 0 */
} nt_hand_target;
typedef struct nt_hand_state {
    nt_hand_target from, to;
    double elapsed; /* since `to` was set [s] */
} nt_hand_state;
NT_API void nt_hand_aim(nt_hand_state *hand, const nt_hand_target *target);
/* Where the hand is now (duration unused). */
NT_API NT_REALTIME nt_hand_target nt_hand_now(const nt_hand_state *hand);
NT_API NT_REALTIME void nt_hand_step(nt_hand_state *hand, double period);

/* --- sensor: gain 1, white noise, range, steps --- */
typedef struct nt_sensor {
    double noise;      /* standard deviation, in the unit of the value */
    double resolution; /* step, 0 for none */
    double range;      /* saturates at +- this */
} nt_sensor;
/* Noise, then steps, then saturation. NaN in, NaN out. random may be NULL where noise is 0. */
NT_API NT_REALTIME double nt_sensor_read(const nt_sensor *sensor, double value, nt_random *random);

#ifdef __cplusplus
}
#endif
#endif
