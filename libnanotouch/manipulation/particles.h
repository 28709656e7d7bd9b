/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what the public header does not have. */
#ifndef NANOTOUCH_MANIPULATION_PARTICLES_PRIVATE_H
#define NANOTOUCH_MANIPULATION_PARTICLES_PRIVATE_H

#include "nanotouch/advanced/manipulation.h"

/* NT_OK, or what nt_particle_check refuses of particle or between, or a lever outside 0 .. 1e9 N/m. */
nt_status nt_particles_check(const nt_particles_setup *setup, nt_problem *problem);
/* Its place in nt_particles_state.pairs; i < j. */
NT_REALTIME int nt_particle_pair_of(int i, int j);
/* Does the tip touch it, or anything of it? */
NT_REALTIME int nt_particles_touches(const nt_particles_state *state);

#endif
