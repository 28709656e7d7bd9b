/* SPDX-License-Identifier: BSD-3-Clause
 * What bends the free approach towards the sample; private to curves/. */
#ifndef NANOTOUCH_CURVES_BEND_H
#define NANOTOUCH_CURVES_BEND_H

#include "nanotouch/curves.h"

/* Takes a bow of the baseline, and the repulsion of a squeeze film, off an approach that was read, where its free part
 * shows them: its baseline has them from then on. kept: where its arrays lie; room: 6
 * doubles for each point. */
void nt_curve_unbend(const nt_curve_segment *segment, double *kept, double *room, nt_curve_branch *approach);
/* At z, x from the middle of the baseline [N]. */
double nt_curve_bend_at(const nt_curve_bend *bend, double z, double x);

#endif
