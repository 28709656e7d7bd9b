/* SPDX-License-Identifier: BSD-3-Clause
 * What a scanner is worth before it scans. */
#ifndef NANOTOUCH_INTERNAL_SCAN_H
#define NANOTOUCH_INTERNAL_SCAN_H

#include "nanotouch/advanced/scan.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A z loop's stability. */
typedef struct nt_zloop_margins {
    double gain;  /* margin: K_I may grow by this factor, at least [-] */
    double phase; /* margin [rad] */
    double speed; /* where the open loop has gain 1 [rad/s] */
} nt_zloop_margins;

/* What a scan goes over. */
typedef struct nt_relief {
    double rise;   /* largest speed at which the surface comes up under the tip [m/s] */
    double height; /* range along a line [m] */
} nt_relief;

/* Open loop K_I/(i w) x stage x a tick of delay x lock-in x answer of the tap. Contact mode: at once. Tapping: smallest
 * margins of: at once, as a free lever, 1/(1 + i w 2 Q/w0), and as the slow flow about the set point over a flat; there
 * phase feedback runs ahead, by 1 + i w 2 Q/w0 on a hard sample. */
NT_API nt_zloop_margins nt_scanner_margins(const nt_scanner *scanner);
/* The largest K_I with a gain margin of 2 and a phase margin of 45 degrees [1/s]. */
NT_API double nt_scanner_gain(const nt_scanner *scanner);
/* The fastest scan over a slope that keeps the height within `error` [m]: K_I error/slope [m/s]. */
NT_API double nt_scanner_speed(const nt_scanner *scanner, double slope, double error);
/* After a step down by `height` [m] at a speed [m/s] the tip comes back to the surface after this way [m]: beyond the
 * surface the error is all of A0 - set point, or the set force over k_c, so z falls at K_I times that. */
NT_API double nt_scanner_parachute(const nt_scanner *scanner, double height, double speed);
/* Standard deviation of the heights of an image of a hard flat [m]: the noise of the reading goes round the closed
 * loop, and a pixel is the mean of its ticks. For a stage that is slower than half the ticks' rate. */
NT_API double nt_scanner_noise(const nt_scanner *scanner);
/* No tap over a place (NULL: a flat) is harder [N], from whatever motion to whatever other, by the slow flow
 * (overshoot.c). HUGE_VAL: where the tip may stay in the sample, as base and surface come together faster than
 * the amplitude can fall, or a tap is deeper than its amplitude. */
NT_API double nt_scanner_peak_bound(const nt_scanner *scanner, const nt_place *place, const nt_relief *relief);

#ifdef __cplusplus
}
#endif
#endif
