/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what rig.h does not promise. */
#ifndef NANOTOUCH_CORE_RIG_PRIVATE_H
#define NANOTOUCH_CORE_RIG_PRIVATE_H

#include "nanotouch/rig.h"

/* Effective mass of the cantilever's end, 0.24 m_c = k_c/(2 pi f_0)^2 [kg]. */
double nt_probe_effective_mass(const nt_probe *probe);
/* Largest deflection the probe can report, range x sensitivity [m]. */
double nt_probe_deflection_range(const nt_probe *probe);
/* Standard deviation of the force read-out: k_c S noise/6 [N]. */
double nt_probe_force_noise(const nt_probe *probe);

#endif
