/* SPDX-License-Identifier: BSD-3-Clause
 * The baseline of a retraction, judged beside that of its approach; private to curves/. */
#ifndef NANOTOUCH_CURVES_JOINT_H
#define NANOTOUCH_CURVES_JOINT_H

#include "curves/bend.h"
#include "curves/ruptures.h"

/* Puts a better baseline in the place of the retraction's own one where there is one, and says how wide that leaves the
 * interval of the pull-off. room: what is left of the caller's work, with the force outside contact. */
void nt_curve_join(const nt_curve *curve, const nt_curve_bend_doubts *doubts, nt_curve_outside *out, double *room,
                   nt_curve_reading *reading);

#endif
