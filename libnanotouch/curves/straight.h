/* SPDX-License-Identifier: BSD-3-Clause
 * Whether the free part of a branch is the line that its baseline takes it for; private to curves/. */
#ifndef NANOTOUCH_CURVES_STRAIGHT_H
#define NANOTOUCH_CURVES_STRAIGHT_H

#include "nanotouch/curves.h"

/* Of the approach, over its last baseline. Where its free part is surely no line - a bow, a step, contact - its level
 * and tilt are as uncertain as what the line leaves. Where it bends as contact does, nothing of it is free: the free
 * level lies between the outer ends of both branches, and the pull-off with it. */
void nt_curve_doubt_straightness(nt_curve_reading *reading);

#endif
