/* SPDX-License-Identifier: BSD-3-Clause
 * The elastic law of a rigid tip over E*, g(delta), with its slope and curvature; private to rheology/. */
#ifndef NANOTOUCH_RHEOLOGY_PROFILE_H
#define NANOTOUCH_RHEOLOGY_PROFILE_H

#include "contact/bonded_layer.h"
#include "nanotouch/advanced/geometry.h"

typedef struct nt_profile {
    nt_shape_kind kind;
    int terms;                /* of c beyond the first; 0: half-space */
    double scale;             /* of a paraboloid 4/3 sqrt(R), of a cone 2 tan(psi)/pi, of a punch 2 a; of a sphere R */
    double c[NT_LAYER_C + 1]; /* powers of the layer: of sqrt(delta) for a paraboloid, of delta for a cone */
    double deepest;           /* where the law ends [m] */
} nt_profile;

typedef struct nt_profile_value {
    double g, slope, curvature; /* [m^2], [m], [-]; slope is 2 a on a half-space */
} nt_profile_value;

nt_profile nt_profile_make(const nt_shape *shape, double thickness);
/* At an indentation above 0; all 0 at 0 and below but that of a punch, which is straight through 0. */
nt_profile_value nt_profile_at(const nt_profile *profile, double indentation);

#endif
