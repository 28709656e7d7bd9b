/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what margins.h does not promise. */
#ifndef NANOTOUCH_CONTROL_MARGINS_PRIVATE_H
#define NANOTOUCH_CONTROL_MARGINS_PRIVATE_H

#include "nanotouch/margins.h"

/* loop_delay alone, a thousand times cheaper [s]. */
double nt_margins_loop_delay(const nt_rig *rig, const nt_gains *gains);
/* along_z: the margins of the same settings and stiffness k [N/m] (nt_margins_judge). */
nt_sideways_margins nt_margins_sideways(const nt_rig *rig, const nt_settings *settings, double contact_stiffness,
                                        const nt_sideways_contact *contact, const nt_margins *along_z);

#endif
