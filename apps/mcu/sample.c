/* SPDX-License-Identifier: BSD-3-Clause
 * k_c zeta = F(base + zeta): the residual F - k_c zeta falls by k_c + k where contact has the stiffness k. Where it
 * pulls (k < 0) the step is that of the spring alone; where the spring is softer than that, the lever jumps. */
#include "sample.h"

float lever_read(lever *state, const ntf_force_table *force, const ntf_probe *probe, float base)
{
    const ntf_force_here here = ntf_force_table_eval(force, &state->attached, base + state->deflection);
    const float stiffness = here.stiffness > 0.0f ? here.stiffness : 0.0f;
    state->deflection +=
        (here.force - probe->spring_constant * state->deflection) / (probe->spring_constant + stiffness);
    state->noise = state->noise * 1664525u + 1013904223u; /* from -1/2 to 1/2, evenly */
    const float noise = (float)(state->noise >> 8) * 0x1p-24f - 0.5f;
    return state->deflection + noise * probe->noise * probe->sensitivity;
}
