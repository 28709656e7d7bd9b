/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what rod.h does not promise. */
#ifndef NANOTOUCH_MANIPULATION_ROD_PRIVATE_H
#define NANOTOUCH_MANIPULATION_ROD_PRIVATE_H

#include "nanotouch/advanced/rod.h"

/* Does the tip touch it? */
NT_REALTIME int nt_rod_touches(const nt_rod_state *state);

#endif
