/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what surface.h does not promise. */
#ifndef NANOTOUCH_SURFACE_SURFACE_PRIVATE_H
#define NANOTOUCH_SURFACE_SURFACE_PRIVATE_H

#include "nanotouch/surface.h"

/* Height of the tip's surface above its apex at a distance r >= 0 from its axis [m]. */
double nt_tip_shape_height(const nt_tip_shape *tip, double r);

#endif
