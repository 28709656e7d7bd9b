/* SPDX-License-Identifier: BSD-3-Clause
 * Parts of a terrain. */
#ifndef NANOTOUCH_INTERNAL_TERRAIN_H
#define NANOTOUCH_INTERNAL_TERRAIN_H

#include "nanotouch/advanced/terrain.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The bank that its plan evaluates contact with; NULL where none is of use. */
NT_API const nt_maugis_bank *nt_terrain_bank(const nt_terrain *terrain);
/* All of a terrain from a start; of a flat, which has no borders, the start alone. */
NT_API nt_area nt_terrain_whole(const nt_terrain *terrain, double x, double y);

#ifdef __cplusplus
}
#endif
#endif
