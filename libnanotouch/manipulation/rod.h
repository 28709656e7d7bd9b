/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what the public header does not have. */
#ifndef NANOTOUCH_MANIPULATION_ROD_PRIVATE_H
#define NANOTOUCH_MANIPULATION_ROD_PRIVATE_H

#include "nanotouch/advanced/manipulation.h"

/* Does the tip touch it? */
NT_REALTIME int nt_rod_touches(const nt_rod_state *state);

#endif
