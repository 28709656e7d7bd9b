/* SPDX-License-Identifier: BSD-3-Clause
 * A sensor with its converter: white noise, then steps, then saturation, so that no reading exceeds the range. */
#include "nanotouch/dynamics.h"

#include <math.h>

double nt_sensor_read(const nt_sensor *sensor, double value, nt_noise *noise)
{
    double reading = value;
    if (sensor->noise > 0.0)
        reading += sensor->noise * nt_noise_normal(noise);
    if (sensor->resolution > 0.0)
        reading = sensor->resolution * nearbyint(reading / sensor->resolution);
    if (reading > sensor->range)
        return sensor->range;
    if (reading < -sensor->range)
        return -sensor->range;
    return reading;
}
