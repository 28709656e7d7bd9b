/* SPDX-License-Identifier: BSD-3-Clause
 * What tests of particles compare with. */
#ifndef PARTICLE_FIXTURE_H
#define PARTICLE_FIXTURE_H

#include <math.h>

#include "nanotouch/advanced/manipulation.h"
#include "nanotouch/types.h"

/* Johnson, Kendall and Roberts (Johnson 1985, Eq. 5.47): the radius of contact of a sphere [m]. */
static inline double jkr_radius(const nt_particle_contact *contact, double R, double load)
{
    const double K = 4.0 / 3.0 * contact->effective_modulus, w = 3.0 * NT_PI * contact->work_of_adhesion * R;
    return cbrt(R / K * (load + w + sqrt(2.0 * w * load + w * w)));
}

#endif
