/* SPDX-License-Identifier: BSD-3-Clause
 * A sensor with its converter: white noise, then steps, then saturation, so that no reading exceeds the range. */
#include "dynamics/sensor.h"
#include "dynamics/dynamics.h"

double nt_sensor_read(const nt_sensor *sensor, double value, nt_noise *noise)
{
    const double reading = nt_sensor_sense(sensor, value, noise);
    if (reading > sensor->range)
        return sensor->range;
    if (reading < -sensor->range)
        return -sensor->range;
    return reading;
}
