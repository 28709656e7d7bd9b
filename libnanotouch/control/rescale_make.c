/* SPDX-License-Identifier: BSD-3-Clause
 * What scales may change by on a rig. */
#include <math.h>

#include "core/clamp.h"
#include "core/same_bits.h"
#include "internal/control.h"
#include "nanotouch/control.h"

#define TANK 0.05      /* share of the gauge's range over the master's travel that the tank can hold */
#define FREE_SIGMA 6.0 /* of the force noise: below it is free air */
#define FREE_STEPS                                                                                                     \
    1.001                 /* of the converter: a reading of one step must not lie on the edge, where rounding decides  \
                           */
#define INCOME_SHARE 0.5  /* of the damping; the rest is left to holds and delays (passivity.c) */
#define FASTEST_SHARE 0.5 /* of a scale, in one period */

nt_rescale nt_rescale_make(const nt_rig *rig, const nt_settings *settings)
{
    const nt_servo_equivalent equivalent = nt_servo_equivalent_of(rig, settings, INFINITY);
    const double T = 1.0 / settings->gains.rate;
    const nt_probe *probe = &equivalent.rig.probe;
    const double noise = probe->spring_constant * probe->sensitivity *
                         hypotenuse(FREE_SIGMA * probe->noise / 6.0, FREE_STEPS * probe->resolution);
    return (nt_rescale){.share = lesser(FASTEST_SHARE, T / greater(settings->gains.ramp_time, T)),
                        .threshold = noise,
                        .spring_constant = rig->probe.spring_constant,
                        .income =
                            INCOME_SHARE * equivalent.rig.master.damping * T / (1.0 + equivalent.gains.force_gain),
                        .capacity = TANK * rig->master.gauge_range * rig->master.travel,
                        .factors = {settings->gains.alpha_f_approach, 1.0, settings->gains.alpha_f_retract}};
}
