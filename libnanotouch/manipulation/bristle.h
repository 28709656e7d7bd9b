/* SPDX-License-Identifier: BSD-3-Clause
 * Private. A spring that gives way at a limit, in one step: the stretch e = pull/k + way, beyond e = L/k it gives. */
#ifndef NANOTOUCH_MANIPULATION_BRISTLE_H
#define NANOTOUCH_MANIPULATION_BRISTLE_H

#include "nanotouch/advanced/manipulation.h"

/* What the step costs, as a function of the stretch: k e^2/2 up to the limit, beyond it what is stored and what becomes
 * heat, L e - L^2/2k. Its gradient is the pull. */
double bristle_cost(const nt_bristle *bristle, double limit, const double stretch[3], double pull[3]);
/* Its second derivative inside the plane or line of `projector`: symmetric, never negative. */
void bristle_tangent(const nt_bristle *bristle, double limit, const double stretch[3], double projector[3][3],
                     double tangent[3][3]);
/* To another stiffness and limit, nothing moves: growing keeps the pull, shrinking the stretch (as in friction.h).
 * Returns the heat [J], >= 0. */
double bristle_change(nt_bristle *bristle, double stiffness, double limit);
/* After the step. Returns the heat [J], >= 0. */
double bristle_end(nt_bristle *bristle, double limit, const double stretch[3]);
/* In the spring [J]. */
double bristle_stored(const nt_bristle *bristle);

#endif
