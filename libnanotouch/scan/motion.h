/* SPDX-License-Identifier: BSD-3-Clause
 * Private: a point in the plane of swing and depth as a motion: what would drive it, and at which height of the base.
 */
#ifndef NANOTOUCH_SCAN_MOTION_H
#define NANOTOUCH_SCAN_MOTION_H

#include "orbit.h"

#define SHORT 0.02e-9 /* longest step along the curve in the depth, near the surface [m] */
#define FAR 0.1       /* over the depth */
#define WIDE 0.02     /* in the swing, over A0 */
#define SAME 0.2      /* phases of one motion by more and by fewer harmonics, or at the next place [rad] */

typedef struct motion {
    orbit o;
    double drive[2]; /* what would drive it, in the frame of its first harmonic [m] */
    double strength; /* |drive|^2/D^2 - 1 [-] */
    double height;   /* of the base [m] */
    double amplitude, phase;
} motion;

/* Derivatives by swing and depth. */
typedef struct slopes {
    double strength[2], height[2], aim[2], taken[2]; /* taken: of drive[1] */
} slopes;

/* 0 where no orbit has this swing and depth. m->o.evaluations are counted on. */
int nt_motion_find(const nt_balance *b, const nt_balance_state *at, motion *m);
int nt_motion_slopes(const nt_balance *b, const motion *m, nt_balance_aim aim, slopes *s);
/* Whether the bounds of a motion keep the balance's accuracy. */
int nt_motion_keeps(const nt_balance *b, const nt_balance_value *value);

#endif
