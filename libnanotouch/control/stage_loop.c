/* SPDX-License-Identifier: BSD-3-Clause
 * The stage follows a reference: feed-forward through a notch that replaces the lightly damped resonance (Eq. 13: 450
 * Hz, Q = 20) by a well damped one, plus integral action on the read-out. The paper's PD (Eq. 17) cannot track: its
 * static gain is K_p/(1 + K_p), and stability at 3 ms holds K_p below 0.5. */
#include "internal/control.h"
#include "nanotouch/advanced/control.h"

nt_sum nt_stage_loop_step(const nt_stage_loop *loop, nt_stage_loop_state *state, nt_sum reference, double measured)
{
    state->correction += loop->integral * (reference - measured);
    const nt_sum in = reference + state->correction;
    const nt_sum out = loop->b[0] * in + state->w[0]; /* transposed direct form II */
    state->w[0] = loop->b[1] * in - loop->a[1] * out + state->w[1];
    state->w[1] = loop->b[2] * in - loop->a[2] * out;
    return out;
}
