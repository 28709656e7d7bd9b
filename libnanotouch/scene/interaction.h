/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what interaction.h does not promise. */
#ifndef NANOTOUCH_SCENE_INTERACTION_PRIVATE_H
#define NANOTOUCH_SCENE_INTERACTION_PRIVATE_H

#include "nanotouch/interaction.h"

/* The contact that friction knows at a place (NULL: a flat) and a gap [m]: radius and load inside; 0 without contact.
 * Of a sample that deforms without adhesion the load is Hertz' of that radius. */
NT_REALTIME nt_friction_contact nt_interaction_friction_contact(const nt_plan *plan, const nt_interaction_state *state,
                                                                const nt_place *place, double gap);
/* The same at a place of the surface (NULL: a flat), for callers that have it. pose->z is then the gap [m]. */
NT_REALTIME void nt_interaction_slide_gap(const nt_plan *plan, const nt_interaction_state *state, nt_slide *slide,
                                          const nt_place *place, const nt_pose *pose);

#endif
