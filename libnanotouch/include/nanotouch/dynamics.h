/* SPDX-License-Identifier: BSD-3-Clause
 * The plant: how probe, stage, master, hand and sensors of the simulated rig move and measure. Linear parts are
 * discretised exactly (zero-order hold), so that no result depends on an integrator. States are caller-owned, fixed in
 * size and may be copied. Every step function is real-time safe. */
#ifndef NANOTOUCH_DYNAMICS_H
#define NANOTOUCH_DYNAMICS_H

#include "nanotouch/advanced/random.h"
#include "nanotouch/rig.h"
#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Exact transition of m x'' + b x' + k x = f over one step with f held: x += xv v + xf (f - k x), v' = vv v + vf (f - k
 * x).
 */
typedef struct nt_oscillator {
    double xv, vv, xf, vf; /* [s], [-], [m/N], [m/(N s)] */
    double k;              /* k [N/m] */
} nt_oscillator;

/* --- probe: the force that it feels --- */

/* The force on the tip at a height, as a function that may be called at trial heights. */
typedef struct nt_force_field {
    nt_law_value (*eval)(void *context, double z_t); /* pure: the force if the tip stood at z_t */
    void (*advance)(void *context, double z_t);      /* commits history when the tip has moved to z_t; may be NULL */
    void *context;
    double length; /* the shortest distance over which F changes shape [m] */
} nt_force_field;

typedef struct nt_cantilever_state {
    double deflection;   /* zeta [m] */
    double tip_height;   /* z_t [m] */
    double speed;        /* zeta' [m/s]; 0 in the quasi-static model */
    uint64_t unresolved; /* sub-steps of the dynamic model that were coarser than its accuracy asks for */
} nt_cantilever_state;
/* At rest with its base at a height [m]. */
NT_API nt_cantilever_state nt_cantilever_at(double base_height);

/* --- probe: quasi-static cantilever (Eq. 2-3 at rest): k_c zeta = F(z_t), z_t = z_b + zeta cos(alpha) --- */

/* What the quasi-static model leaves out, while the tip does not jump. */
typedef struct nt_cantilever_lag {
    double force;    /* largest error of the force, by speed and acceleration of the base [N] */
    double settling; /* time constant of the ringing after a jump, 2 Q/w0 [s] */
    double thermal;  /* thermal motion as a force, sqrt(k_c k_B T), RMS [N] */
} nt_cantilever_lag;
/* For a base on this stage, at the stage's largest speed. Thread-safe. */
NT_API nt_cantilever_lag nt_cantilever_lag_of(const nt_probe *probe, const nt_stage *stage);

/* --- probe: dynamic cantilever (Eq. 2): m zeta'' + (m w0/Q) zeta' + k_c zeta = F(z_t) - 2 eta a z_t' + thermal force,
 *     m = 0.24 m_c; exact in its linear part, passive in the rest, at any stiffness, quality and step --- */

enum { NT_CANTILEVER_LEVELS = 20 }; /* a period is halved at most this often */

typedef struct nt_cantilever_substep {
    nt_oscillator oscillator;
    double length;   /* h [s] */
    double noise[3]; /* Cholesky factor of the thermal motion over h: zeta [m]; zeta' with zeta, zeta' alone [m/s] */
} nt_cantilever_substep;
typedef struct nt_cantilever_model {
    nt_probe probe;
    double period, cosine, rate; /* T [s]; cos(alpha); w0 [rad/s] */
    double substep;              /* largest w h of a sub-step, w the frequency of tip and contact there [rad] */
    int finest;                  /* the shortest sub-step is T/2^finest */
    nt_cantilever_substep steps[NT_CANTILEVER_LEVELS + 1];
} nt_cantilever_model;
/* substep in radians, > 0: 0.25 is usual; a larger one is coarser, and stable too. NT_E_RANGE, NT_E_NOT_FINITE. */
NT_API nt_status nt_cantilever_model_init(nt_cantilever_model *model, const nt_probe *probe, double period,
                                          double substep);
/* One period, in which the base moves to base_height on a straight line. noise may be NULL where the temperature is 0.
 * At most 2^finest sub-steps. NT_E_ARGUMENT (field length not positive), NT_E_NOT_FINITE where the field is, with the
 * state left where it was last finite. */
NT_API NT_REALTIME nt_status nt_cantilever_step(const nt_cantilever_model *model, nt_cantilever_state *state,
                                                const nt_force_field *field, double base_height, nt_noise *noise);

/* --- stage: x_s'' /wn^2 + x_s'/(wn Q) + x_s = P[u] - f/k_stage (Eq. 13 repaired, E15), u the command and f the tip
 *     force, + pushing the stage back; P the piezo's own play and creep, P[u] = u where it has none --- */

enum { NT_STAGE_PLAYS = 10, NT_STAGE_CREEPS = 4 };

typedef struct nt_stage_state {
    double position;               /* x_s [m] */
    double speed;                  /* [m/s] */
    double play[NT_STAGE_PLAYS];   /* where the play operators stand [m] */
    double creep[NT_STAGE_CREEPS]; /* how far each decade of creep has followed [m] */
    double shift;                  /* what changes of the hysteresis have left, so that none makes it jump [m] */
} nt_stage_state;
typedef struct nt_stage_model {
    nt_oscillator oscillator;           /* of x_s over one period, k = 1 */
    double period;                      /* [s] */
    double creep_rate[NT_STAGE_CREEPS]; /* share of the way that is crept per period [-] */
    nt_stage stage;
} nt_stage_model;
/* What pushes the stage back: f, which grows by k per metre of travel. */
typedef struct nt_stage_load {
    double force;     /* f where the stage is [N] */
    double stiffness; /* k >= 0 [N/m] */
} nt_stage_load;

/* --- hand: goes straight to a target over a time, then stays; a script is a sequence of targets. An impedance may hold
 *     the master besides, and an adversary may add any force (nt_hand in rig.h) --- */

typedef struct nt_hand_target {
    double force[NT_AXES];    /* operator force, the third + towards the sample [N] */
    double position[NT_AXES]; /* of a hand that holds the master where it will, whatever the motor does [m] */
    int holds;                /* 1: by position, 0: by force */
    double duration;          /* time to get there [s], >= 0 */
} nt_hand_target;
typedef struct nt_hand_state {
    nt_hand_target from, to;
    double elapsed;      /* since `to` was set [s] */
    double rest;         /* where the hand's spring is at rest [m] */
    double random_force; /* of the adversary, now [N] */
} nt_hand_state;

/* --- master, and the hand that holds it: (m + m_h) x'' + (b + b_h) x' + k_h (x - rest) + f_C sgn x' = f (Eq. 12), f =
 *     motor force + the hand's effort, held; between hard end stops. Exact, sticking and slipping too --- */

typedef struct nt_master_state {
    double position;     /* x_m [m] */
    double speed;        /* [m/s] */
    double acceleration; /* at the end of the last step [m/s^2] */
} nt_master_state;
typedef struct nt_master_model {
    nt_oscillator oscillator; /* over one period */
    double period;            /* [s] */
    nt_master master;
    nt_hand hand;
} nt_master_model;

/* --- sensor: gain 1, white noise, range, steps --- */
typedef struct nt_sensor {
    double noise;      /* standard deviation [unit of the value] */
    double resolution; /* step, 0 for none [unit of the value] */
    double range;      /* saturates at +- this [unit of the value] */
} nt_sensor;

#ifdef __cplusplus
}
#endif
#endif
