/* SPDX-License-Identifier: BSD-3-Clause
 * Private: what a sensor gives its converter, white noise and then steps, before any range. */
#ifndef NANOTOUCH_DYNAMICS_SENSOR_H
#define NANOTOUCH_DYNAMICS_SENSOR_H

#include <math.h>

#include "internal/random.h"
#include "nanotouch/dynamics.h"

static inline double nt_sensor_sense(const nt_sensor *sensor, double value, nt_noise *noise)
{
    double reading = value;
    if (sensor->noise > 0.0)
        reading += sensor->noise * nt_noise_normal(noise);
    if (sensor->resolution > 0.0)
        reading = sensor->resolution * nearbyint(reading / sensor->resolution);
    return reading;
}

#endif
