/* SPDX-License-Identifier: BSD-3-Clause
 * Square grating like TGZ-03 (the paper's Fig. 18): ideal steps, so that the picture's pixels and the tip round them.
 */
#include "nanotouch/surface.h"

#include <math.h>

nt_grating nt_grating_defaults(void)
{
    return (nt_grating){.period = 3e-6, .height = 480e-9, .duty = 0.5, .offset = 0.75e-6};
}

double nt_grating_height(const nt_grating *grating, double x, double y)
{
    const double periods = (x - grating->offset) / grating->period;
    const double phase = periods - floor(periods);
    if (isnan(phase) || isnan(y))
        return phase + y;
    return phase < grating->duty ? grating->height : 0.0;
}
