/* SPDX-License-Identifier: BSD-3-Clause
 * The steps of a rig's sensors and stage. */
#ifndef NANOTOUCH_INTERNAL_RIG_H
#define NANOTOUCH_INTERNAL_RIG_H

#include "nanotouch/rig.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The same rig with the steps that it really has: of every sensor, and of the stage's command, its own or that of a
 * converter's bits over its range, the coarser. */
NT_API nt_rig nt_rig_with_steps(const nt_rig *rig);

#ifdef __cplusplus
}
#endif
#endif
