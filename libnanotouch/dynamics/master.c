/* SPDX-License-Identifier: BSD-3-Clause
 * Haptic master, Eq. 12: m x'' + b x' = f with f = tau_m + f_m, between hard end stops. A stop takes all of the
 * momentum (inelastic): the arm stands there until it is driven back. */
#include "nanotouch/dynamics.h"

#include <stddef.h>

#include "../core/lti.h"

nt_status nt_master_model_init(nt_master_model *model, const nt_master *master, double period)
{
    nt_rig rig = nt_rig_defaults();
    rig.master = *master;
    nt_status status = nt_rig_check(&rig, NULL);
    if (status != NT_OK)
        return status;
    if (period <= 0.0)
        return NT_E_RANGE;

    /* States (x, x' T), input f T^2/m, time in periods: one size, so that the exponential loses nothing. */
    const nt_lti continuous = {
        .order = 2, .a = {{0.0, 1.0}, {0.0, -master->damping * period / master->mass}}, .b = {0.0, 1.0}};
    nt_lti discrete;
    status = nt_lti_discretise(&continuous, 1.0, &discrete);
    if (status != NT_OK)
        return status;
    *model = (nt_master_model){
        .phi = {{1.0, discrete.a[0][1] * period}, {0.0, discrete.a[1][1]}},
        .gamma = {discrete.b[0] * period * period / master->mass, discrete.b[1] * period / master->mass},
        .master = *master,
    };
    return NT_OK;
}

void nt_master_step(const nt_master_model *model, nt_master_state *state, double force)
{
    const double stop = model->master.travel / 2.0;
    state->position += model->phi[0][1] * state->speed + model->gamma[0] * force;
    state->speed = model->phi[1][1] * state->speed + model->gamma[1] * force;
    if (state->position > stop || state->position < -stop) {
        state->position = state->position > 0.0 ? stop : -stop;
        state->speed = 0.0;
    }
}
