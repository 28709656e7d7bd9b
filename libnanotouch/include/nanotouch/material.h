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

/* What a material is known by. NaN: no value that could be vouched for. */
typedef struct nt_material_entry {
    const char *name;        /* "silicon" */
    const char *symbol;      /* "Si", "PMMA" */
    nt_material elastic;     /* at room temperature; of crystals, across the face that is usually touched */
    double surface_energy;   /* gamma of the clean surface [J/m^2]; in air and water it is often far less */
    double hamaker_constant; /* H of the material against itself across vacuum [J], not retarded */
    double yield_strength;   /* Y, of one-dimensional compression [Pa] */
} nt_material_entry;

/* The material of that name or symbol, exactly as written; NULL if there is none. The table with its sources, and how
 * far they differ, is core/materials.c. Thread-safe. */
NT_API const nt_material_entry *nt_material_find(const char *name);
/* The materials by number, 0 .. ; NULL beyond the last. */
NT_API const nt_material_entry *nt_material_at(int index);

/* H [J] of materials 1 and 2 across 3 (0 for vacuum) from each one's own:
 * (sqrt(H_1) - sqrt(H_3)) (sqrt(H_2) - sqrt(H_3)); < 0: repulsion. An estimate: it fails across water, where the static
 * part counts (Israelachvili 2011, ch. 13). */
NT_API double nt_hamaker_combine(double hamaker_1, double hamaker_2, double hamaker_3);
/* w = 2 sqrt(gamma_1 gamma_2) [J/m^2], for dispersion forces (Girifalco, Good 1957; Fowkes 1964). */
NT_API double nt_work_of_adhesion(double surface_energy_1, double surface_energy_2);

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
