/* SPDX-License-Identifier: BSD-3-Clause
 * The linear loop as its samples see it, at one point z = exp(j theta) of the unit circle; exact under the holds.
 * Private to control/. */
#ifndef NANOTOUCH_CONTROL_SAMPLED_H
#define NANOTOUCH_CONTROL_SAMPLED_H

#include "core/complex_number.h"
#include "core/lti.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/settings.h"

/* M x'' + B x' + K x = u behind a hold and a dead time. States (x, v T), so that the entries are of like size. */
typedef struct nt_sampled {
    double mass, damping, stiffness; /* [kg], [N s/m], [N/m] */
    double period;                   /* T [s] */
    double step[2][2];               /* Phi - 1 */
    double early[2], late[2];        /* what the command of the period before, and of this one, adds */
    int whole;                       /* periods of dead time; the fraction is in early and late */
} nt_sampled;
/* All but the stiffness above 0. NaN all over where nt_lti_discretise refuses. */
nt_sampled nt_sampled_make(double mass, double damping, double stiffness, double period, double dead_time);

/* x, v and u to det(z - Phi) over it: the numerators apart from their common denominator. */
typedef struct nt_sampled_value {
    double complex position;     /* [m/N] times determinant */
    double complex speed;        /* [m/(N s)] times determinant */
    double complex acceleration; /* just before the sample [1/kg] times determinant */
    double complex determinant;
} nt_sampled_value;
nt_sampled_value nt_sampled_at(const nt_sampled *part, double theta);
/* Where its poles lie on the circle, nearest, between 0 and pi. */
double nt_sampled_angle(const nt_sampled *part);

/* The virtual tool (modes.c, couple): its spring and damper over a period. Rigid where all are 0. */
typedef struct nt_sampled_tool {
    double give; /* 1/K of its spring [m/N] */
    double kept; /* a of the stretch that its damper holds over a period [-] */
    double drag; /* K a: what a tool in air resists a step of the master [N/m] */
} nt_sampled_tool;

/* A handle that was let go [kg]. */
#define NT_RELEASED_HANDLE 0.1

/* All parts of the loop. */
typedef struct nt_sampled_loop {
    nt_sampled master; /* with the hand on it */
    nt_sampled stage;
    nt_stage_loop stage_loop;
    int notched;
    nt_hand hand;
    double hand_dead_time; /* of the motor's hop, with what a slow master holds [s] */
    nt_sampled_tool tool;
    double force_filter; /* c of the low-pass of f_m, per period [-] */
    int printed;         /* the stage is driven by Eq. 17 as printed, K_p and K_v, without notch and integral */
    double proportional; /* K_p [-] */
    double derivative;   /* K_v [s] */
} nt_sampled_loop;
nt_sampled_loop nt_sampled_loop_make(const nt_rig *rig, const nt_gains *gains);
/* The same of the law that the settings name; rig and gains are those of nt_servo_equivalent_of. */
nt_sampled_loop nt_sampled_loop_of(const nt_rig *rig, const nt_settings *settings, const nt_gains *gains);
/* The same in another hand. */
nt_sampled_loop nt_sampled_loop_held(const nt_sampled_loop *loop, const nt_hand *hand);
/* How long a master that is slower than the loop holds its reading, and its motor a force, beyond a period [s]. */
double nt_sampled_master_hold(const nt_rig *rig, const nt_gains *gains);
/* Dead time of one hop: computing, conversion [s]. */
double nt_sampled_dead_time(const nt_rig *rig, const nt_gains *gains);

/* The characteristic function is, g the stage loop's integral gain per period (1 where it is driven as printed),
 *
 *     (P + g Q) ((M - K_f F) U + (1 + K_f) V X) + k_r N c ((M - K_f F)/K + (1 + K_f) X),
 *
 * k_r = alpha_f alpha_p k_eff, with common factors taken out so that nothing has a pole. Of a rigid tool U = c = 1 and
 * V = 1/K = 0. */
typedef struct nt_sampled_terms {
    double complex stage;    /* P: (z - 1), as there is an integral */
    double complex tracking; /* Q: from the stage's integral over the stage back to it */
    double complex reach;    /* N: (P + g Q) times the stage over its reference */
    double complex master;   /* M */
    double complex way;      /* X: M times x_m over the motor's force */
    double complex finger;   /* F: from the motor over the hand on the gauge and the low-pass back to the motor */
    double complex keeps;    /* U: 1 - a/z */
    double complex drags;    /* V: K a (1 - 1/z) */
} nt_sampled_terms;
nt_sampled_terms nt_sampled_terms_at(const nt_sampled_loop *loop, double theta);
/* The function over its factors: servo * air + k_r * touch. */
double complex nt_sampled_servo(const nt_sampled_loop *loop, const nt_sampled_terms *terms);
double complex nt_sampled_air(const nt_sampled_terms *terms, double force_gain);
double complex nt_sampled_touch(const nt_sampled_loop *loop, const nt_sampled_terms *terms, double force_gain);
/* P, of f_m. */
double complex nt_sampled_low_pass(const nt_sampled_loop *loop, double theta);
/* x_s over its reference, dead time included. */
double complex nt_sampled_stage(const nt_sampled_loop *loop, double theta);

/* Between the parts of the loop, each closed in itself; factors on x_s at the operator's scale. */
typedef struct nt_sampled_flow {
    double complex stage;    /* from its reference [-] */
    double complex command;  /* from an error of its command, past the notch [-] */
    double complex reading;  /* from an error of its read-out [-] */
    double complex master;   /* from the motor's force to x_m, hand on it, gauge closed through K_f [m/N] */
    double complex low_pass; /* of f_m [-] */
    double complex tool;     /* from the master to the tool where nothing pulls it [-] */
} nt_sampled_flow;
nt_sampled_flow nt_sampled_flow_at(const nt_sampled_loop *loop, double force_gain, double theta);
/* The next angle on a walk along the circle, no farther than a share of this one, closer near a bare resonance. */
double nt_sampled_next(const nt_sampled_loop *loop, double theta, double share);
/* Far below the slowest corner of all parts: where a walk begins. */
double nt_sampled_first(const nt_sampled_loop *loop);
/* A dead time beyond this takes as many steps along the circle, and no gain is left to speak of [periods]. */
enum { NT_SAMPLED_LONGEST = 10000 };

/* Where the loop turns unstable; INFINITY where it never does, 0 where it is unstable anyhow. */
typedef struct nt_sampled_limits {
    double loop_stiffness; /* (1 + K_f) k_r, K_f given [N/m] */
    double angle;          /* at which it oscillates there, w T [rad] */
    double
        tool_stiffness; /* k_r at which the tool and the stage oscillate by themselves, the master held still [N/m] */
    double force_gain;  /* K_f, in air or with alpha_f alpha_p k_eff given, whichever comes first [-] */
    double stage_gain;  /* g of the stage's own loop, whatever the master does [-] */
} nt_sampled_limits;
/* reflected_stiffness: alpha_f alpha_p k_eff [N/m]. */
nt_sampled_limits nt_sampled_limits_of(const nt_sampled_loop *loop, double force_gain, double reflected_stiffness);

/* A master of three axes over a lever that shows what holds the tip; one without motors is told, too. */
static inline int nt_sideways_is_felt(const nt_rig *rig)
{
    return rig->master.axes > 1.0 && rig->stage.axes > 1.0 && rig->probe.lateral_stiffness > 0.0;
}

#endif
