/* SPDX-License-Identifier: BSD-3-Clause
 * Private: the guarantee over a surface whose relief is known. */
#ifndef NANOTOUCH_CONTROL_BOUND_H
#define NANOTOUCH_CONTROL_BOUND_H

#include "internal/margins.h"
#include "nanotouch/margins.h"

/* As nt_guarantee_compute, where the surface rises by no more than this, wherever the tip is led; infinite where that
 * is not known [m]. */
nt_guarantee nt_guarantee_within(const nt_rig *rig, const nt_settings *settings, const nt_hazard *hazard,
                                 double relief);

#endif
