/* SPDX-License-Identifier: BSD-3-Clause
 * The path of a sliding contact, for the Python package. */
#ifndef NANOTOUCH_INTERNAL_INTERACTION_H
#define NANOTOUCH_INTERNAL_INTERACTION_H

#include "nanotouch/interaction.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The same with friction: advance, slide, then evaluate, with the friction force in Fx and Fy. */
NT_API void nt_interaction_slide_n(const nt_plan *plan, nt_interaction_state *state, nt_slide *slide,
                                   const nt_interaction_arrays *arrays);

#ifdef __cplusplus
}
#endif
#endif
