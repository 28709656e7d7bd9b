/* SPDX-License-Identifier: BSD-3-Clause
 * What a lever or stage that rings after the turn adds to the pull-off; private to curves/. */
#ifndef NANOTOUCH_CURVES_RINGING_H
#define NANOTOUCH_CURVES_RINGING_H

#include "nanotouch/curves.h"

/* Leaves open by how much ringing made the retraction's lowest point too deep, or not deep enough. */
void nt_curve_doubt_ringing(nt_curve_reading *reading);

#endif
