/* SPDX-License-Identifier: BSD-3-Clause
 * Two balls as a ball on a flat, and the numbers that choose the theory of their adhesion: see geometry.h. */
#include <math.h>

#include "core/same_bits.h"
#include "nanotouch/advanced/geometry.h"

double nt_effective_radius(double radius, double other_radius)
{
    return radius / (1.0 + radius / other_radius);
}

nt_contact nt_contact_between(nt_ball tip, nt_ball sample, double work_of_adhesion, double cohesive_stress)
{
    return (nt_contact){
        .radius = nt_effective_radius(tip.radius, sample.radius),
        .effective_modulus = nt_effective_modulus(tip.material, sample.material),
        .work_of_adhesion = work_of_adhesion,
        .cohesive_stress = cohesive_stress,
    };
}

double nt_cohesive_stress_of_range(double work_of_adhesion, double range)
{
    return work_of_adhesion / range;
}

double nt_cohesive_stress_laplace(double surface_tension, double meniscus_radius)
{
    return surface_tension / meniscus_radius;
}

double nt_tabor_mu(const nt_contact *contact, double equilibrium_distance)
{
    const double strain = contact->work_of_adhesion / contact->effective_modulus / equilibrium_distance;
    const double root = cube_root(strain);
    return root * root * cube_root(contact->radius / equilibrium_distance);
}
