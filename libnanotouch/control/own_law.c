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
#include "nanotouch/control.h"

#define LARGEST_FEEDFORWARD 0.8 /* these three as in the table of gains */
#define LEAST_ALPHA_F 1e-3      /* of a law that reflects nothing */
#define RAW_FILTER 1e6          /* a low-pass that does nothing [Hz] */
#define STEP 1e-6               /* of a signal, relative to its range */
#define BEND 1e-4               /* by which slopes to both sides may differ, relative */

/* Where slopes are taken, as shares of the largest force: either sign, about 0, and up to the limit. */
static const double shares[] = {-1.0, -0.25, -0.01, 0.01, 0.25, 1.0};
enum { POINTS = (int)(sizeof shares / sizeof *shares) };

/* The signals that are moved: the rules know the first six, the other four must not be heard. */
enum { FELT, SLAVE, RAW, SMOOTH, SPEED, TARGET, MASTER, MASTER_SPEED, STAGE, STAGE_SPEED, SIGNALS };

typedef struct own_trial {
    const nt_settings *settings;
    nt_signals at;   /* at rest, but for the signal that is moved */
    nt_effort there; /* the answer at rest */
    nt_effort least; /* a motor force that counts [N], a travel of the stage that counts [m] */
    int gauge;       /* of the master: without one no f_m is asked about */
} own_trial;

static nt_effort ask(const own_trial *trial)
{
    const nt_control *control = &trial->settings->control;
    return control->law(control->context, &trial->settings->gains, &trial->at);
}

/* The largest force at which the loop can be pressed and read [N]. */
static double largest_force(const nt_rig *rig, const nt_settings *settings)
{
    const double reach =
        rig->master.gauge ? fmin(rig->master.gauge_range, rig->master.max_force) : rig->master.max_force;
    return fmin(settings->limits.force, reach / settings->gains.alpha_f);
}

static own_trial trial_at(const nt_rig *rig, const nt_settings *settings, double slave_force)
{
    const nt_gains *gains = &settings->gains;
    const double alpha_f = gains->alpha_f * fmax(1.0, fmax(gains->alpha_f_approach, gains->alpha_f_retract));
    const int gauge = rig->master.gauge;
    const double felt = gauge ? alpha_f * slave_force : 0.0;
    own_trial made = {.settings = settings,
                      .at = {.period = 1.0 / gains->rate,
                             .operator_force = felt,
                             .smooth_force = felt,
                             .slave_force = slave_force,
                             .felt_force = slave_force,
                             .scaling = {gains->alpha_p, alpha_f},
                             .master_damping = rig->master.damping,
                             .gain_factor = 1.0},
                      .least = {STEP * rig->master.max_force, STEP * rig->master.travel * gains->alpha_p},
                      .gauge = gauge};
    made.there = ask(&made);
    return made;
}

/* The law's answer to a signal that moves by `step` to either side; NaN where the two differ. */
static nt_effort slope(own_trial *trial, double *signal, double step)
{
    const double kept = *signal;
    const nt_effort there = trial->there, least = trial->least;
    *signal = kept + step;
    const nt_effort above = ask(trial);
    *signal = kept - step;
    const nt_effort below = ask(trial);
    *signal = kept;
    const nt_effort up = {above.motor_force - there.motor_force, above.stage - there.stage};
    const nt_effort down = {there.motor_force - below.motor_force, there.stage - below.stage};
    const int straight = fabs(up.motor_force - down.motor_force) <= BEND * (least.motor_force + fabs(up.motor_force)) &&
                         fabs(up.stage - down.stage) <= BEND * (least.stage + fabs(up.stage));
    return straight
               ? (nt_effort){0.5 * (up.motor_force + down.motor_force) / step, 0.5 * (up.stage + down.stage) / step}
               : (nt_effort){(double)NAN, (double)NAN};
}

/* The motor force's slopes by the signals. The stage must go to its target and hear nothing else. */
static nt_status slopes_of(own_trial *trial, double slopes[SIGNALS])
{
    nt_signals *s = &trial->at;
    const double force = trial->least.motor_force, way = trial->least.stage, near = STEP * fabs(s->slave_force);
    const double travel = way / s->scaling.alpha_p, rate = 1.0 / s->period;
    const struct {
        double *signal, step;
    } moves[SIGNALS] = {[FELT] = {&s->felt_force, near},
                        [SLAVE] = {&s->slave_force, near},
                        [RAW] = {&s->operator_force, force},
                        [SMOOTH] = {&s->smooth_force, force},
                        [SPEED] = {&s->smooth_speed, force / s->master_damping},
                        [TARGET] = {&s->target, way},
                        [MASTER] = {&s->master_position, travel},
                        [MASTER_SPEED] = {&s->master_speed, travel * rate},
                        [STAGE] = {&s->stage_position, way},
                        [STAGE_SPEED] = {&s->stage_speed, way * rate}};
    for (int i = 0; i < SIGNALS; ++i) {
        slopes[i] = 0.0;
        if ((i == RAW || i == SMOOTH) && !trial->gauge)
            continue;
        const nt_effort found = slope(trial, moves[i].signal, moves[i].step);
        const double stage = (found.stage - (i == TARGET)) * moves[i].step;
        if (!(fabs(stage) <= BEND * way) || /* NaN is not */
            (i >= TARGET && !(fabs(found.motor_force * moves[i].step) <= BEND * force)))
            return NT_E_UNSUPPORTED;
        slopes[i] = found.motor_force;
    }
    return NT_OK;
}

/* Is the answer a number, and the same once more? Else the law has memory. */
static int is_settled(const own_trial *trial)
{
    const nt_effort there = trial->there, again = ask(trial);
    return isfinite(there.motor_force) && isfinite(there.stage) && again.motor_force == there.motor_force &&
           again.stage == there.stage;
}

/* The gains at one force. */
static nt_status amounts_at(const nt_rig *rig, const nt_settings *settings, double slave_force, nt_settings *amounts)
{
    own_trial made = trial_at(rig, settings, slave_force);
    double slopes[SIGNALS];
    if (slopes_of(&made, slopes) != NT_OK || !is_settled(&made))
        return NT_E_UNSUPPORTED;
    const double reflected = -slopes[FELT] - slopes[SLAVE]; /* A: of f_s as it is felt or as it is */
    const double raw = slopes[RAW], smooth = slopes[SMOOTH], share = slopes[SPEED] / rig->master.damping;
    const double K_f = fmax(0.0, fmax(raw, smooth)), alpha_f = reflected / (1.0 + K_f);
    const int is_coupled = settings->gains.coupling_stiffness > 0.0; /* its rule takes the session's alpha_f */
    if (!(reflected >= 0.0 && share >= -BEND && share <= LARGEST_FEEDFORWARD + BEND) || fmin(raw, smooth) < -BEND ||
        fmin(raw, smooth) > BEND || (is_coupled && fabs(alpha_f - made.at.scaling.alpha_f) > BEND * alpha_f))
        return NT_E_UNSUPPORTED;
    nt_gains gains = settings->gains;
    gains.force_gain = K_f;
    gains.force_filter = raw > smooth ? RAW_FILTER : gains.force_filter;
    gains.velocity_feedforward = fmin(fmax(0.0, share), LARGEST_FEEDFORWARD); /* rounded */
    gains.alpha_f = fmax(alpha_f, LEAST_ALPHA_F);
    gains.alpha_f_approach = gains.alpha_f_retract = 1.0; /* the largest region has been tried */
    *amounts = *settings;
    amounts->gains = gains;
    amounts->control = (nt_control){.choice = NT_CONTROL_DEFAULT};
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
