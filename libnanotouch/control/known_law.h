/* SPDX-License-Identifier: BSD-3-Clause
 * The verdict on the laws whose gains are known, which that on a law of one's own rests on; private to control/. */
#ifndef NANOTOUCH_CONTROL_KNOWN_LAW_H
#define NANOTOUCH_CONTROL_KNOWN_LAW_H

#include "nanotouch/margins.h"

#define NT_VERDICT(margin, name) {margin, name, "stability margin (" name ")"}

/* As nt_margins_judge, for any law but one's own. */
nt_verdict nt_verdict_on_known(const nt_rig *rig, const nt_settings *settings, double contact_stiffness, nt_mode mode,
                               nt_margins *margins);

#endif
