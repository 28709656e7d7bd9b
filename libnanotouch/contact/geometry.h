/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what geometry.h does not promise. */
#ifndef NANOTOUCH_CONTACT_GEOMETRY_PRIVATE_H
#define NANOTOUCH_CONTACT_GEOMETRY_PRIVATE_H

#include "nanotouch/advanced/geometry.h"

/* Distance of Maugis-Dugdale to the Lennard-Jones sphere: largest |dF|/max(|F|, F_pull-off) for loads from -0.9 to 10
 * pull-off forces, indentation counted from load 0 [-]; interpolated, mu 0.05 .. 5, NaN outside. */
double nt_maugis_model_error(double lambda);

#endif
