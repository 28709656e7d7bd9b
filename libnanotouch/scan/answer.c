/* SPDX-License-Identifier: BSD-3-Clause
 * The motions at the set point over a flat, and the slopes of the slow flow there: how a tap answers to the z loop.
 *
 * Of tapping.h with g = -fc, a motion that repeats has D sin(phi) = r A/Q + fs and D cos(phi) = g + (1 - r^2) A. On the
 * way down the first gap where the attraction is enough has the attractive motion, that where the repulsion is, the
 * other. */
#include "answer.h"

#include <math.h>
#include <stddef.h>

#include "core/same_bits.h"
#include "scan/flow.h"

#define OUTSIDE 20e-9 /* gap where the way begins [m] */
#define FINE 0.02e-9  /* step of the way near the surface [m] */
#define ASIDE 1e-3    /* of the finite differences, over A */
enum { STEPS = 4000 };

/* A of q where the loss is this much [m]. */
static double swing_of(const nt_tapping *t, const nt_zloop *loop, double loss)
{
    if (loop->mode == NT_ZLOOP_TAPPING)
        return loop->set_amplitude * t->free_amplitude;
    return (t->strength * sin(loop->set_phase) - loss) * t->quality / t->ratio;
}

/* Slopes at a motion, whose D cos(phi) has this sign. */
static nt_tap_answer slopes_at(const nt_tapping *t, const nt_plan *plan, const nt_flow_average *at, double swing,
                               double sign)
{
    const nt_tapping_over flat = {plan, NULL, 0.0};
    const double wider = ASIDE * swing, sine = t->ratio * swing / t->quality + at->sine;
    const nt_flow_average wide = nt_flow_average_at(t, &flat, at->attached, swing + wider, at->low);
    const nt_flow_average high = nt_flow_average_at(t, &flat, at->attached, swing, at->low + FINE);
    const double force = -(high.cosine - at->cosine) / FINE, loss = (high.sine - at->sine) / FINE;
    return (nt_tap_answer){.amplitude = swing,
                           .sine = sine,
                           .cosine = sign * sqrt(t->strength * t->strength - sine * sine),
                           .force_height = force,
                           .force_swing = -(wide.cosine - at->cosine) / wider - t->cosine * force,
                           .loss_height = loss,
                           .loss_swing = (wide.sine - at->sine) / wider - t->cosine * loss};
}

int nt_tap_can_be_held(const nt_tapping *lever, nt_zloop_mode mode, const nt_tap_answer *at)
{
    const double r = lever->ratio, x = r / lever->quality + at->loss_swing, k = at->force_swing + 1.0 - r * r;
    const int stays = x * at->sine + at->cosine * k > 0.0 && x * at->amplitude + at->sine > 0.0;
    if (mode == NT_ZLOOP_PHASE)
        return stays && at->loss_height * k - x * at->force_height > 0.0;
    return stays && -at->loss_height * at->sine - at->cosine * at->force_height > 0.0;
}

void nt_tap_answers(const nt_tapping *t, const nt_plan *plan, const nt_zloop *zloop,
                    nt_tap_answer answer[NT_TAP_ANSWERS])
{
    const nt_tapping_over flat = {plan, NULL, 0.0};
    const double aside = 1.0 - t->ratio * t->ratio;
    nt_flow_average now = {.low = OUTSIDE + t->free_amplitude};
    double A = swing_of(t, zloop, 0.0);
    for (int i = 0; i < NT_TAP_ANSWERS; i++)
        answer[i] = (nt_tap_answer){.amplitude = 0.0};
    for (int i = 0; i < STEPS && now.low > -t->cosine * A; i++) {
        now = nt_flow_average_at(t, &flat, now.attached, A, now.low - fmax(FINE, 0.02 * now.low));
        const double sine = t->ratio * A / t->quality + now.sine, cosine = -now.cosine + aside * A;
        const int side = cosine > 0.0 ? NT_TAP_REPELLED : NT_TAP_ATTRACTED;
        if (sine < t->strength && hypotenuse(sine, cosine) >= t->strength && answer[side].amplitude == 0.0 &&
            (side == NT_TAP_REPELLED || zloop->mode == NT_ZLOOP_TAPPING)) {
            const nt_tap_answer found = slopes_at(t, plan, &now, A, copysign(1.0, cosine));
            if (nt_tap_can_be_held(t, zloop->mode, &found))
                answer[side] = found;
        }
        A = swing_of(t, zloop, now.sine);
        if (!(A > 0.0) || answer[NT_TAP_REPELLED].amplitude > 0.0)
            return;
    }
}
