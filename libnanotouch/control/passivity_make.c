/* SPDX-License-Identifier: BSD-3-Clause
 * What the passivity observer needs of a rig and its gains. */
#include <math.h>

#include "core/clamp.h"
#include "internal/control.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/material.h"

#define DUE_SHARE 0.2         /* of the damping; at the margin of 1.5 at which a loop may be armed a third is left */
#define SPEED_BANDWIDTH 200.0 /* of the speed in b v^2 [Hz] */
#define WRONG_SPEED 10.0      /* times what hand and motor can hold against the damping */
#define LEAST_STEP 1e-3       /* sensors without steps still have noise: this share of the travel */

nt_passivity nt_passivity_make(const nt_rig *rig, const nt_gains *gains)
{
    const double T = 1.0 / gains->rate;
    const double master_step = fmax(rig->master.resolution, LEAST_STEP * rig->master.travel);
    const double stage_step = rig->stage.resolution / gains->alpha_p;
    const double filter = -expm1(-2.0 * NT_PI * SPEED_BANDWIDTH * T);
    return (nt_passivity){.dead_zone = rig->master.gauge_range * fmax(master_step, stage_step),
                          .due = DUE_SHARE * rig->master.damping * T,
                          .force_gain = gains->force_gain,
                          .damping = rig->master.damping,
                          .credit = rig->master.gauge ? 0.0 : rig->master.damping,
                          .speed_filter = filter,
                          .speed_floor = master_step * filter / T,
                          .speed_limit =
                              WRONG_SPEED * (rig->master.max_force + rig->master.gauge_range) / rig->master.damping,
                          .period = T};
}
