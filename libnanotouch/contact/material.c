/* SPDX-License-Identifier: BSD-3-Clause
 * Elastic and cohesive constants of a pair of materials: see material.h. */
#include "nanotouch/material.h"

#include <math.h>

double nt_effective_modulus(nt_material tip, nt_material sample)
{
    const double tip_compliance = (1.0 - tip.poisson_ratio * tip.poisson_ratio) / tip.youngs_modulus;
    const double sample_compliance = (1.0 - sample.poisson_ratio * sample.poisson_ratio) / sample.youngs_modulus;
    return 1.0 / (tip_compliance + sample_compliance);
}

double nt_cohesive_stress_atomic(double work_of_adhesion, double equilibrium_distance)
{
    return 16.0 / (9.0 * sqrt(3.0)) * work_of_adhesion / equilibrium_distance;
}
