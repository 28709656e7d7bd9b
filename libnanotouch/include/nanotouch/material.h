/* SPDX-License-Identifier: BSD-3-Clause
 * Elastic materials and the few constants of nature the laws need. */
#ifndef NANOTOUCH_MATERIAL_H
#define NANOTOUCH_MATERIAL_H

#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NT_PI 3.14159265358979323846
#define NT_VACUUM_PERMITTIVITY 8.8541878128e-12 /* [F/m] */
#define NT_GAS_CONSTANT 8.31446261815324        /* [J/(mol K)] */
#define NT_BOLTZMANN 1.380649e-23               /* [J/K] */
#define NT_AVOGADRO 6.02214076e23               /* [1/mol] */
#define NT_ELEMENTARY_CHARGE 1.602176634e-19    /* [C] */

/* An isotropic elastic material. */
typedef struct nt_material {
    double youngs_modulus; /* E [Pa], > 0 */
    double poisson_ratio;  /* nu [-], -1 < nu <= 0.5 */
} nt_material;

/* E* of two bodies in contact: 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2 (the paper's K of Eq. 4 is 4/3 E*).
 * Returns E* [Pa]; NaN in, NaN out. Thread-safe, real-time safe. */
NT_API double nt_effective_modulus(nt_material tip, nt_material sample);

/* Range h0 of the Dugdale stress for atomic adhesion: w/sigma0 with sigma0 = 16 w/(9 sqrt(3) z0), the largest
 * attractive stress of the Lennard-Jones 9-3 wall (paper, Eq. 11: sigma0 = 1.03 w/a0; erratum E9).
 * work_of_adhesion w [J/m^2], equilibrium_distance z0 [m]. Returns sigma0 [Pa]. */
NT_API double nt_cohesive_stress_atomic(double work_of_adhesion, double equilibrium_distance);

#ifdef __cplusplus
}
#endif
#endif
