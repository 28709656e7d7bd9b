/* SPDX-License-Identifier: BSD-3-Clause
 * The parts of the touch step: control laws, supervisor, change of scales, stage loop, passivity observer. */
#ifndef NANOTOUCH_INTERNAL_CONTROL_H
#define NANOTOUCH_INTERNAL_CONTROL_H

#include "nanotouch/touch.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What scales may change by on this rig, from its damping and rate; both have been checked. */
NT_API nt_rescale nt_rescale_make(const nt_rig *rig, const nt_settings *settings);
/* At these scales, free of contact, with an empty tank. */
NT_API nt_rescale_state nt_rescale_start(const nt_rescale *rescale, const nt_scaling *scaling);
/* One period: the tip's force [N], the stage [m], the master's speed [m/s]. Moves `now` towards `wanted` and region. */
NT_API NT_REALTIME void nt_rescale_step(const nt_rescale *rescale, nt_rescale_state *state, double slave_force,
                                        double stage_position, double master_speed);
/* Eq. 17 with the low-pass on f_m and velocity feed-forward: tau = -alpha_f f_s - K_f (alpha_f f_s - f_m) + beta b v;
 * the stage goes to the target through notch and integral. At rest f_m = alpha_f f_s for any K_f. */
NT_API NT_REALTIME nt_effort nt_servo_default(void *unused, const nt_gains *gains, const nt_signals *signals);
/* Eq. 17 as printed: the raw f_m, and a stage that is driven by K_v (alpha_p x_m' - x_s') + K_p (alpha_p x_m - x_s)
 * alone, without notch and integral. For reproduction: see docs/control.md for what is wrong with it. */
NT_API NT_REALTIME nt_effort nt_servo_paper(void *unused, const nt_gains *gains, const nt_signals *signals);
/* For masters without a gauge: tau = -alpha_f f_s + beta b v. The hand feels f_m = alpha_f f_s + (1 - beta) b v. */
NT_API NT_REALTIME nt_effort nt_servo_impedance(void *unused, const nt_gains *gains, const nt_signals *signals);
/* The function of a choice. */
NT_API nt_control_law nt_control_law_of(const nt_control *control);
/* Thresholds of a rig and its settings; both have been checked. */
NT_API nt_supervisor nt_supervisor_make(const nt_rig *rig, const nt_settings *settings);
/* The same of mode tapping: the amplitude is judged, too. */
NT_API nt_amplitude_limits nt_supervisor_amplitude(const nt_rig *rig, const nt_settings *settings);
/* In RUN, nothing seen yet. */
NT_API nt_supervisor_state nt_supervisor_start(void);
/* One tick. Returns the new state, never less severe than RETRACT or LATCHED once reached (nt_supervisor_arm). */
NT_API NT_REALTIME nt_state nt_supervisor_step(const nt_supervisor *supervisor, nt_supervisor_state *state,
                                               const nt_sample *sample, const nt_situation *situation);
/* The law gave no number in this tick: HOLD, the second time in a row RETRACT. */
NT_API NT_REALTIME nt_state nt_supervisor_fail_law(nt_supervisor_state *state);
/* Back to RUN after RETRACT; after LATCHED only with confirmed = 1 (a person at the rig), else NT_E_STATE. */
NT_API nt_status nt_supervisor_arm(nt_supervisor_state *state, int confirmed);
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
/* Whether samples are many enough to see the resonance: two in its period; else the notch is off. */
NT_API int nt_stage_loop_notches(const nt_stage *stage, const nt_gains *gains);
/* Notch and gain for a stage and gains that have been checked. */
NT_API nt_stage_loop nt_stage_loop_make(const nt_stage *stage, const nt_gains *gains);
/* One period: reference and read-out [m] in, the command to the stage [m] out. */
NT_API NT_REALTIME nt_sum nt_stage_loop_step(const nt_stage_loop *loop, nt_stage_loop_state *state, nt_sum reference,
                                             double measured);
/* Time constants of the lever's amplitude, Q/(pi f_0), and of the lock-in amplifier together [s]. */
NT_API double nt_tap_lag(const nt_rig *rig, const nt_tap *tap);
/* Of a rig and its settings; both have been checked. */
NT_API nt_motor_bound nt_motor_bound_compute(const nt_rig *rig, const nt_settings *settings);

#ifdef __cplusplus
}
#endif
#endif
