/* SPDX-License-Identifier: BSD-3-Clause
 * Which tier of tapping a demand needs, and lines of an image by it. */
#include "internal/steady.h"

#include <math.h>
#include <stddef.h>

#include "motion.h"
#include "scan/balance.h"
#include "scan/scan.h"

#define ACCURACY_MIN 1e-6
#define ACCURACY_MAX 0.5
enum { SECANTS = 8 };

static nt_steady_value of_balance(const nt_balance_value *met)
{
    return (nt_steady_value){.tier = met->harmonics == 1 ? NT_STEADY_FLOW : NT_STEADY_BALANCE,
                             .harmonics = met->harmonics,
                             .base_height = met->base_height,
                             .amplitude = met->amplitude,
                             .phase = met->phase,
                             .mean = met->mean,
                             .peak_force = met->peak_force,
                             .lowest_gap = met->lowest_gap,
                             .contact_time = met->contact_time,
                             .tip_loss = met->tip_loss,
                             .amplitude_bound = met->amplitude_bound,
                             .force_bound = met->force_bound,
                             .evaluations = met->evaluations};
}

static nt_steady_value of_time(const nt_tapping_value *now, const nt_tapping_state *state, double base_height)
{
    return (nt_steady_value){.tier = NT_STEADY_TIME,
                             .base_height = base_height,
                             .amplitude = now->amplitude,
                             .phase = now->phase,
                             .mean = now->mean,
                             .peak_force = now->peak_force,
                             .lowest_gap = now->lowest_gap,
                             .contact_time = now->contact_time,
                             .tip_loss = now->tip_loss,
                             .state = *state,
                             .evaluations = now->evaluations};
}

static double off(const nt_balance_target *target, const nt_steady_value *value)
{
    return target->aim == NT_AIM_HEIGHT      ? value->base_height - target->value
           : target->aim == NT_AIM_AMPLITUDE ? value->amplitude - target->value
                                             : value->phase - target->value;
}

/* By the time domain from a state at a height; for other targets the height by secants. The answer to a height is taken
 * as one to one at first, as on a hard sample. */
static nt_status in_time(const nt_steady *steady, const nt_balance_target *target, nt_tapping_state *state,
                         nt_steady_value *value)
{
    const double A0 = steady->lever->free_amplitude, unit = target->aim == NT_AIM_AMPLITUDE ? 1.0 : 1.0 / A0;
    double height = target->aim == NT_AIM_HEIGHT ? target->value : value->base_height, slope = unit;
    long evaluations = value->evaluations;
    for (int i = 0; i < SECANTS; i++) {
        const nt_tapping_over over = {steady->plan, steady->place, height};
        nt_tapping_value now;
        nt_solve_info info = {0, 0.0};
        const nt_status status = nt_tapping_settle(steady->lever, state, &over, &now, &info);
        if (status != NT_OK)
            return status;
        const double before = off(target, value), at = value->base_height;
        evaluations += now.evaluations * info.iterations;
        *value = of_time(&now, state, height);
        value->evaluations = evaluations;
        const double rest = off(target, value);
        if (target->aim == NT_AIM_HEIGHT || fabs(rest) < 0.1 * steady->accuracy * unit * A0)
            return NT_OK;
        if (i > 0 && height != at && rest != before)
            slope = (rest - before) / (height - at);
        height -= rest / slope;
    }
    return NT_E_NO_CONVERGENCE;
}

/* As nt_steady_find; *state is that of harmonic balance, where value->tier is not NT_STEADY_TIME. */
static nt_status find(const nt_steady *steady, const nt_balance_curve *curve, const nt_balance_target *target,
                      nt_balance_state *state, nt_steady_value *value)
{
    const nt_balance balance = {steady->lever, steady->plan, steady->place, NT_HARMONICS_MAX, steady->accuracy};
    nt_balance_value met;
    nt_steady_value found = {0};
    found.state = nt_tapping_free(steady->lever);
    const nt_status status = nt_balance_find(&balance, curve, target, state, &met);
    if (status == NT_OK) {
        found = of_balance(&met);
        found.state = nt_balance_moment(&balance, state, &met);
        if (nt_motion_keeps(&balance, &met)) {
            *value = found;
            return NT_OK;
        }
    } else if (target->aim != NT_AIM_HEIGHT) {
        return status;
    }
    nt_tapping_state begun = found.state;
    const nt_status timed = in_time(steady, target, &begun, &found);
    if (timed == NT_OK)
        *value = found;
    return timed;
}

nt_status nt_steady_find(const nt_steady *steady, const nt_balance_curve *curve, const nt_balance_target *target,
                         nt_steady_value *value)
{
    if (steady == NULL || steady->lever == NULL || steady->plan == NULL || curve == NULL || target == NULL ||
        value == NULL)
        return NT_E_ARGUMENT;
    if (!(steady->accuracy >= ACCURACY_MIN && steady->accuracy <= ACCURACY_MAX))
        return NT_E_RANGE;
    nt_balance_state state;
    return find(steady, curve, target, &state, value);
}

/* --- Lines of an image --- */

static void put(double *channel, long pixel, double value)
{
    if (channel != NULL)
        channel[pixel] = value;
}

/* A motion on the way along a line. */
typedef struct course {
    nt_balance balance;
    nt_balance_state state;
    nt_steady_value value;
    int is_known; /* 1: of the pixel before, by harmonic balance */
} course;

/* The motion at the next pixel: from that of the last one, or from above. */
static nt_status next(course *c, const nt_balance_target *target, nt_balance_curve *curve)
{
    if (c->is_known) {
        nt_balance near = c->balance;
        nt_balance_state state = c->state;
        nt_balance_value met;
        near.harmonics = c->value.harmonics;
        if (nt_balance_solve(&near, target, &state, &met) == NT_OK && met.gain > 0.0 && met.stable &&
            fabs(met.phase - c->value.phase) < SAME && nt_motion_keeps(&near, &met)) {
            c->state = state;
            c->value = of_balance(&met);
            return NT_OK;
        }
    }
    const nt_steady steady = {c->balance.lever, c->balance.plan, c->balance.place, c->balance.accuracy};
    nt_status status = nt_balance_trace(&c->balance, curve);
    if (status == NT_OK)
        status = find(&steady, curve, target, &c->state, &c->value);
    c->is_known = status == NT_OK && c->value.tier != NT_STEADY_TIME;
    return status;
}

nt_status nt_steady_line(const nt_scanner *scanner, double accuracy, long line, nt_scan_row *row, long *pixel)
{
    if (scanner == NULL || row == NULL || scanner->scan.zloop.mode == NT_ZLOOP_CONTACT)
        return NT_E_ARGUMENT;
    if (!(accuracy >= ACCURACY_MIN && accuracy <= ACCURACY_MAX))
        return NT_E_RANGE;
    const nt_zloop *loop = &scanner->scan.zloop;
    const nt_balance_target target =
        loop->mode == NT_ZLOOP_PHASE
            ? (nt_balance_target){NT_AIM_PHASE, loop->set_phase, 0}
            : (nt_balance_target){NT_AIM_AMPLITUDE, loop->set_amplitude * scanner->lever.free_amplitude, 0};
    const long pixels = (long)scanner->scan.raster.pixels;
    nt_balance_curve curve;
    course c = {.balance = {&scanner->lever, scanner->plan, NULL, NT_HARMONICS_MAX, accuracy}};
    for (long i = 0; i < pixels; i++) {
        const nt_pose at = nt_scanner_at(scanner, line, ((double)i + 0.5) / (double)pixels, 0, 0.0);
        nt_place place = nt_interaction_place(scanner->plan, at.x, at.y);
        place.surface.z += at.z;
        c.balance.place = &place;
        const nt_status status = next(&c, &target, &curve);
        if (status != NT_OK) {
            if (pixel != NULL)
                *pixel = i;
            return status;
        }
        put(row->height, i, c.value.base_height);
        put(row->error, i, 0.0);
        put(row->signal, i, target.aim == NT_AIM_AMPLITUDE ? target.value : c.value.amplitude);
        put(row->phase, i, c.value.phase);
        put(row->peak_force, i, c.value.peak_force);
        put(row->lateral, i, 0.0);
    }
    return NT_OK;
}
