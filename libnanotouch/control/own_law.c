/* SPDX-License-Identifier: BSD-3-Clause
 * What a law of one's own amounts to, found by trying it: about a point at rest one signal after another is moved to
 * and fro, and the answers must be those of the default law with other gains,
 *
 *     tau = tau_0 - A f_s + K f_m + beta b v,   stage = target,   A = (1 + K) alpha_f',
 *
 * which is all that the stability rules know. Whatever has memory, a bend at that point, or an answer to anything else
 * is something they do not know. */
#include <math.h>
#include <stddef.h>

#include "control/known_law.h"
#include "nanotouch/servo.h"

#define LARGEST_FEEDFORWARD 0.8 /* these three as in the table of gains */
#define LEAST_ALPHA_F 1e-3      /* of a law that reflects nothing */
#define RAW_FILTER 1e6          /* a low-pass that does nothing [Hz] */
#define STEP 1e-6               /* of a signal, relative to its range */
#define BEND 1e-4               /* by which slopes to both sides may differ, relative */

/* Where slopes are taken, as shares of the largest force: either sign, about 0, and up to the limit. */
static const double shares[] = {-1.0, -0.25, -0.01, 0.01, 0.25, 1.0};
enum { POINTS = (int)(sizeof shares / sizeof *shares) };

typedef struct own_trial {
    const nt_settings *settings;
    nt_signals at;     /* at rest */
    nt_effort effort;  /* there */
    double force_unit; /* of a motor force that counts [N] */
    double way_unit;   /* of a travel of the stage that counts [m] */
} own_trial;

static nt_effort ask(const own_trial *trial, const nt_signals *signals)
{
    const nt_control *control = &trial->settings->control;
    return control->law(control->context, &trial->settings->gains, signals);
}

/* The largest force at which the loop can be pressed and read [N]. */
static double largest_force(const nt_rig *rig, const nt_settings *settings)
{
    const double reach =
        rig->master.gauge != 0.0 ? fmin(rig->master.gauge_range, rig->master.max_force) : rig->master.max_force;
    return fmin(settings->limits.force, reach / settings->gains.alpha_f);
}

static own_trial trial_at(const nt_rig *rig, const nt_settings *settings, double slave_force)
{
    const nt_gains *gains = &settings->gains;
    const double alpha_f = gains->alpha_f * fmax(1.0, fmax(gains->alpha_f_approach, gains->alpha_f_retract));
    const double felt = rig->master.gauge != 0.0 ? alpha_f * slave_force : 0.0;
    own_trial made = {.settings = settings,
                      .at = {.period = 1.0 / gains->rate,
                             .operator_force = felt,
                             .smooth_force = felt,
                             .slave_force = slave_force,
                             .felt_force = slave_force,
                             .scaling = {gains->alpha_p, alpha_f},
                             .master_damping = rig->master.damping,
                             .gain_factor = 1.0},
                      .force_unit = STEP * rig->master.max_force,
                      .way_unit = STEP * rig->master.travel * gains->alpha_p};
    made.effort = ask(&made, &made.at);
    return made;
}

/* The law's answer to a signal that moves by `step` to either side; NaN where the two differ. */
static nt_effort slope(const own_trial *trial, double *signal, const nt_signals *moved, double step)
{
    const double kept = *signal;
    *signal = kept + step;
    const nt_effort above = ask(trial, moved);
    *signal = kept - step;
    const nt_effort below = ask(trial, moved);
    *signal = kept;
    const nt_effort up = {above.motor_force - trial->effort.motor_force, above.stage - trial->effort.stage};
    const nt_effort down = {trial->effort.motor_force - below.motor_force, trial->effort.stage - below.stage};
    const int straight = fabs(up.motor_force - down.motor_force) <= BEND * (trial->force_unit + fabs(up.motor_force)) &&
                         fabs(up.stage - down.stage) <= BEND * (trial->way_unit + fabs(up.stage));
    return straight
               ? (nt_effort){0.5 * (up.motor_force + down.motor_force) / step, 0.5 * (up.stage + down.stage) / step}
               : (nt_effort){(double)NAN, (double)NAN};
}

/* dtau of a signal that the stage must not hear; NaN if it does. */
static double force_slope(const own_trial *trial, double *signal, const nt_signals *moved, double step)
{
    const nt_effort found = slope(trial, signal, moved, step);
    return fabs(found.stage * step) <= BEND * trial->way_unit ? found.motor_force : (double)NAN;
}

/* Does neither motor nor stage hear this signal? NaN is heard. */
static int is_unheard(const own_trial *trial, double *signal, const nt_signals *moved, double step)
{
    return fabs(force_slope(trial, signal, moved, step) * step) <= BEND * trial->force_unit;
}

static int goes_to_target(const own_trial *trial, nt_signals *moved)
{
    const nt_effort found = slope(trial, &moved->target, moved, trial->way_unit);
    return fabs(found.stage - 1.0) <= BEND && fabs(found.motor_force * trial->way_unit) <= BEND * trial->force_unit;
}

/* Of everything but forces, smooth speed and target. */
static int is_deaf(const own_trial *trial, nt_signals *moved)
{
    const double way = trial->way_unit, travel = way / trial->at.scaling.alpha_p, rate = 1.0 / trial->at.period;
    return is_unheard(trial, &moved->master_position, moved, travel) &&
           is_unheard(trial, &moved->master_speed, moved, travel * rate) &&
           is_unheard(trial, &moved->stage_position, moved, way) &&
           is_unheard(trial, &moved->stage_speed, moved, way * rate);
}

/* A: of f_s as it is felt or as it is. */
static double reflection(const own_trial *trial, nt_signals *moved)
{
    const double step = STEP * fabs(trial->at.slave_force);
    return -force_slope(trial, &moved->felt_force, moved, step) - force_slope(trial, &moved->slave_force, moved, step);
}

static int is_between(double value, double least, double most)
{
    return value >= least && value <= most; /* NaN is not */
}

/* The gains at one force. */
static nt_status amounts_at(const nt_rig *rig, const nt_settings *settings, double slave_force, nt_settings *amounts)
{
    const own_trial made = trial_at(rig, settings, slave_force);
    const double b = rig->master.damping, force = made.force_unit;
    nt_signals moved = made.at;
    if (!isfinite(made.effort.motor_force) || !isfinite(made.effort.stage) || !is_deaf(&made, &moved) ||
        !goes_to_target(&made, &moved))
        return NT_E_UNSUPPORTED;
    const double reflected = reflection(&made, &moved);
    const double raw = rig->master.gauge != 0.0 ? force_slope(&made, &moved.operator_force, &moved, force) : 0.0;
    const double smooth = rig->master.gauge != 0.0 ? force_slope(&made, &moved.smooth_force, &moved, force) : 0.0;
    const double share = force_slope(&made, &moved.smooth_speed, &moved, force / b) / b;
    const nt_effort again = ask(&made, &made.at); /* the same once more, or it has memory */
    const int forgets = again.motor_force == made.effort.motor_force && again.stage == made.effort.stage;
    const double K_f = fmax(0.0, fmax(raw, smooth)), alpha_f = reflected / (1.0 + K_f);
    const int coupled = settings->gains.coupling_stiffness > 0.0; /* its rule takes the session's alpha_f */
    if (coupled && !(fabs(alpha_f - made.at.scaling.alpha_f) <= BEND * alpha_f))
        return NT_E_UNSUPPORTED;
    if (!forgets || !is_between(reflected, 0.0, INFINITY) || !is_between(share, -BEND, LARGEST_FEEDFORWARD + BEND) ||
        !is_between(raw, -BEND, INFINITY) || !is_between(smooth, -BEND, INFINITY) || fmin(raw, smooth) > BEND)
        return NT_E_UNSUPPORTED;
    nt_gains gains = settings->gains;
    gains.force_gain = K_f;
    gains.force_filter = raw > smooth ? RAW_FILTER : gains.force_filter;
    gains.velocity_feedforward = fmin(fmax(0.0, share), LARGEST_FEEDFORWARD); /* rounded */
    gains.alpha_f = fmax(alpha_f, LEAST_ALPHA_F);
    gains.alpha_f_approach = gains.alpha_f_retract = 1.0; /* the largest region has been tried */
    *amounts = (nt_settings){.gains = gains, .limits = settings->limits, .control = {.choice = NT_CONTROL_DEFAULT}};
    return NT_OK;
}

nt_status nt_margins_own_law(const nt_rig *rig, const nt_settings *settings, double contact_stiffness,
                             nt_settings *amounts)
{
    if (settings->control.choice != NT_CONTROL_OWN)
        return NT_E_ARGUMENT;
    if (settings->control.law == NULL)
        return NT_E_UNSUPPORTED;
    const double largest = largest_force(rig, settings);
    nt_settings worst = *settings;
    double least = INFINITY;
    for (int i = 0; i < POINTS; ++i) {
        nt_settings found;
        nt_margins margins;
        const nt_status status = amounts_at(rig, settings, shares[i] * largest, &found);
        if (status != NT_OK)
            return status;
        const double margin = nt_verdict_on_known(rig, &found, contact_stiffness, NT_MODE_TOUCH, &margins).margin;
        if (i == 0 || !(margin >= least)) {
            least = margin;
            worst = found;
        }
    }
    *amounts = worst;
    return NT_OK;
}
