/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what terrain.h does not promise. */
#ifndef NANOTOUCH_SESSION_TERRAIN_PRIVATE_H
#define NANOTOUCH_SESSION_TERRAIN_PRIVATE_H

#include "nanotouch/advanced/terrain.h"

/* Read-only views, valid until close; NULL where there is none. */
const nt_surface *nt_terrain_surface(const nt_terrain *terrain); /* dilated; NULL: a flat at z = 0 */
/* The radius of each of its places; NULL where none is asked for. */
const nt_radius_map *nt_terrain_radii(const nt_terrain *terrain);

#endif
