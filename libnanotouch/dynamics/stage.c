/* SPDX-License-Identifier: BSD-3-Clause
 * Piezoelectric z stage, Eq. 13 with its unit error repaired (erratum E15: the tip force enters as f/k_stage):
 *     x'' / wn^2 + x' / (wn Q) + x = u - f / k_stage.
 * Linear: slew limit, travel and steps belong to whoever drives it. */
#include "nanotouch/dynamics.h"

#include <stddef.h>

#include "../core/lti.h"

#define TWO_PI 6.28318530717958647692

nt_status nt_stage_model_init(nt_stage_model *model, const nt_stage *stage, double period)
{
    nt_rig rig = nt_rig_defaults();
    rig.stage = *stage;
    nt_status status = nt_rig_check(&rig, NULL);
    if (status != NT_OK)
        return status;

    /* States (x, x'/wn): one size, so that the exponential loses nothing. */
    const double wn = TWO_PI * stage->resonance;
    const nt_lti continuous = {.order = 2, .a = {{0.0, wn}, {-wn, -wn / stage->quality}}, .b = {0.0, wn}};
    nt_lti discrete;
    status = nt_lti_discretise(&continuous, period, &discrete);
    if (status != NT_OK)
        return status;
    *model = (nt_stage_model){
        .phi = {{discrete.a[0][0], discrete.a[0][1] / wn}, {discrete.a[1][0] * wn, discrete.a[1][1]}},
        .gamma = {discrete.b[0], discrete.b[1] * wn},
        .stage = *stage,
    };
    return NT_OK;
}

void nt_stage_step(const nt_stage_model *model, nt_stage_state *state, double command, double force)
{
    /* phi00 = 1 - gamma0 and phi10 = -gamma1 (static gain 1), written so that rest at u is rest to the last bit. */
    const double ahead = command - force / model->stage.stiffness - state->position;
    const double speed = state->speed;
    state->position += model->gamma[0] * ahead + model->phi[0][1] * speed;
    state->speed = model->gamma[1] * ahead + model->phi[1][1] * speed;
}
