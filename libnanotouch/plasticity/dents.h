/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what the public header does not have. */
#ifndef NANOTOUCH_PLASTICITY_DENTS_PRIVATE_H
#define NANOTOUCH_PLASTICITY_DENTS_PRIVATE_H

#include "nanotouch/advanced/plasticity.h"

/* How far the dents lower the apex of a tip at (x, y) before it touches, >= 0 [m]: 0 beside them, the residual depth in
 * the middle of one. The tip rests on the rim, or in the bottom of the paraboloid. */
NT_REALTIME double nt_dents_lowered(const nt_indentation *indentation, const nt_dents *dents, double x, double y);
/* Force against sliding in a groove: mean pressure times section, of the share that is ploughed [N]. */
NT_REALTIME double nt_dents_ploughing(const nt_indentation *indentation, const nt_dents *dents);
/* Takes the last dent of the list back; 0 if there is none, or the tip touches. */
NT_REALTIME int nt_dents_undo(nt_dents *dents);

#endif
