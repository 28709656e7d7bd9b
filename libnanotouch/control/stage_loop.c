/* SPDX-License-Identifier: BSD-3-Clause
 * The stage follows a reference: feed-forward through a notch that replaces the lightly damped resonance (Eq. 13: 450
 * Hz, Q = 20) by a well damped one, plus integral action on the read-out. The paper's PD (Eq. 17) cannot track: its
 * static gain is K_p/(1 + K_p), and stability at 3 ms holds K_p below 0.5. */
#include <math.h>

#include "nanotouch/control.h"
#include "nanotouch/material.h"

nt_stage_loop nt_stage_loop_make(const nt_stage *stage, const nt_gains *gains)
{
    /* N(s) = (s^2 + wn s/Q + wn^2)/(s^2 + 2 zeta wn s + wn^2); Tustin with s = wn/tan(wn T/2) (1 - z^-1)/(1 + z^-1), so
     * that the zeros fall on the resonance itself; a resonance above half the rate is left alone */
    nt_stage_loop loop = {.b = {1.0, 0.0, 0.0}, .a = {1.0, 0.0, 0.0}, .integral = gains->stage_integral / gains->rate};
    const double half_angle = NT_PI * stage->resonance / gains->rate;
    if (half_angle >= 0.5 * NT_PI)
        return loop;
    const double t = tan(half_angle);
    const double common = 1.0 + t * t;
    const double zero = t / stage->quality;
    const double pole = 2.0 * gains->stage_damping * t;
    const double scale = 1.0 / (common + pole);
    loop.b[0] = (common + zero) * scale;
    loop.b[1] = 2.0 * (t * t - 1.0) * scale;
    loop.b[2] = (common - zero) * scale;
    loop.a[1] = loop.b[1];
    loop.a[2] = (common - pole) * scale;
    return loop;
}

double nt_stage_loop_step(const nt_stage_loop *loop, nt_stage_loop_state *state, double reference, double measured)
{
    state->correction += loop->integral * (reference - measured);
    const double in = reference + state->correction;
    const double out = loop->b[0] * in + state->w[0]; /* transposed direct form II */
    state->w[0] = loop->b[1] * in - loop->a[1] * out + state->w[1];
    state->w[1] = loop->b[2] * in - loop->a[2] * out;
    return out;
}
