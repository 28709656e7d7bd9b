/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what curves.h does not promise. */
#ifndef NANOTOUCH_CURVES_CURVES_PRIVATE_H
#define NANOTOUCH_CURVES_CURVES_PRIVATE_H

#include "nanotouch/curves.h"

/* Standard uncertainty of one force of a branch at z [N]. */
double nt_curve_branch_sigma(const nt_curve_branch *branch, double z);

#endif
