/* SPDX-License-Identifier: BSD-3-Clause
 * Control laws: from what is measured to the motor force and to where the stage shall be, once per period. Three are
 * here, and anybody's own may take their place under the same supervisor and limits. */
#ifndef NANOTOUCH_SERVO_H
#define NANOTOUCH_SERVO_H

#include "nanotouch/scaling.h"
#include "nanotouch/settings.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a law is given. All numbers are finite. */
typedef struct nt_signals {
    double period;          /* T [s] */
    double master_position; /* x_m [m] */
    double master_speed;    /* of x_m, by differences [m/s] */
    double smooth_speed;    /* the same behind a low-pass of 20 Hz: positions come in steps [m/s] */
    double operator_force;  /* f_m, 0 where there is no gauge [N] */
    double smooth_force;    /* the same behind gains.force_filter [N] */
    double slave_force;     /* f_s = k_c zeta [N] */
    double felt_force;      /* the same, or what a virtual coupling makes of it: to be reflected [N] */
    double stage_position;  /* x_s [m] */
    double stage_speed;     /* of x_s, by differences [m/s] */
    double target;          /* alpha_p x_m from where it was last indexed: x_s by Eq. 16 [m] */
    nt_scaling scaling;     /* in force now */
    double master_damping;  /* b_m [N s/m] */
    double gain_factor;     /* 1, less when the passivity observer has backed off: on K_f [-] */
} nt_signals;

/* What a law wants; limits come after it. */
typedef struct nt_effort {
    double motor_force; /* tau_m, + towards the sample [N] */
    double stage;       /* where the stage shall be [m] */
} nt_effort;

/* Must be real-time safe where the loop is. A number that is not finite stops the coupling (NT_REASON_LAW). */
typedef nt_effort (*nt_control_law)(void *context, const nt_gains *gains, const nt_signals *signals);

/* Eq. 17 with the low-pass on f_m and velocity feed-forward: tau = -alpha_f f_s - K_f (alpha_f f_s - f_m) + beta b v;
 * the stage goes to the target through notch and integral (stage_loop.h). At rest f_m = alpha_f f_s for any K_f. */
NT_API NT_REALTIME nt_effort nt_servo_default(void *unused, const nt_gains *gains, const nt_signals *signals);
/* Eq. 17 as printed: the raw f_m, and a stage that is driven by K_v (alpha_p x_m' - x_s') + K_p (alpha_p x_m - x_s)
 * alone, without notch and integral. For reproduction: see docs/control.md for what is wrong with it. */
NT_API NT_REALTIME nt_effort nt_servo_paper(void *unused, const nt_gains *gains, const nt_signals *signals);
/* For masters without a gauge: tau = -alpha_f f_s + beta b v. The hand feels f_m = alpha_f f_s + (1 - beta) b v. */
NT_API NT_REALTIME nt_effort nt_servo_impedance(void *unused, const nt_gains *gains, const nt_signals *signals);

/* The function of a choice. */
NT_API nt_control_law nt_control_law_of(const nt_control *control);

/* What stability rules and observer have to put into their formulas for a law (docs/control.md): K_f is 0 for the
 * impedance law, the damping of the master is what feed-forward leaves of it, the paper's law and samples too few for a
 * notch leave the stage's resonance bare, alpha_f is that of the region with the largest, and a virtual coupling
 * softens the contact, as it is felt. The margins of a loop are those of nt_margins_compute for this rig, these gains
 * and the contact's own stiffness. */
typedef struct nt_servo_equivalent {
    nt_rig rig;
    nt_gains gains;
    double contact_stiffness; /* [N/m] */
} nt_servo_equivalent;
/* For a contact of this stiffness [N/m], >= 0, by the law that the settings choose. */
NT_API nt_servo_equivalent nt_servo_equivalent_of(const nt_rig *rig, const nt_settings *settings,
                                                  double contact_stiffness);
/* By what K_p and K_v of the paper's law may be multiplied until the stage oscillates by itself; infinite for the other
 * laws. Some milliseconds. */
NT_API double nt_servo_stage_margin(const nt_rig *rig, const nt_settings *settings);

#ifdef __cplusplus
}
#endif
#endif
