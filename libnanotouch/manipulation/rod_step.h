/* SPDX-License-Identifier: BSD-3-Clause
 * Private. One step of a rod and its tip. */
#ifndef NANOTOUCH_MANIPULATION_ROD_STEP_H
#define NANOTOUCH_MANIPULATION_ROD_STEP_H

#include "nanotouch/advanced/manipulation.h"

/* Tip and rod. Distances are those of the rod's axis from the cone whose points are a tip radius below the tip's
 * surface; rho is their distance seen from above, h the height of the axis over that cone's apex. */
typedef struct rod_touch {
    double depth;     /* how deep they overlap, 0 apart [m] */
    double rho;       /* [m] */
    double slope[2];  /* of the distance, by rho and by h [-] */
    double bend[3];   /* its second derivatives, by rho twice, by rho and h, by h twice [1/m] */
    double normal[2]; /* from the tip to the axis, seen from above [-] */
    double along;     /* the place on the axis [m] */
} rod_touch;
rod_touch rod_touch_at(const nt_rod *rod, const double tip[3], const double pose[3]);

/* What a state has: no more pulls than the rod has pieces. */
void rod_copy(const nt_rod *rod, nt_rod_state *to, const nt_rod_state *from);
/* From one balance to the next, the base at its end [m]. Fails as nt_rod_advance, and changes nothing then. */
nt_status rod_take_step(const nt_rod *rod, nt_rod_state *state, const double base[3]);

#endif
