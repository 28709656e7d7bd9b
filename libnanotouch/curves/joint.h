/* SPDX-License-Identifier: BSD-3-Clause
 * The baseline of a retraction, judged beside that of its approach; private to curves/. */
#ifndef NANOTOUCH_CURVES_JOINT_H
#define NANOTOUCH_CURVES_JOINT_H

#include "nanotouch/curves.h"

/* Finds ruptures and the free tail of a retraction that was read over its own far half, and puts a better baseline in
 * its place where there is one. room: what is left of the caller's work. */
void nt_curve_join(const nt_curve *curve, double *room, nt_curve_reading *reading);

#endif
