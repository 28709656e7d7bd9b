/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what the public header does not have. */
#ifndef NANOTOUCH_MANIPULATION_PUSHED_PRIVATE_H
#define NANOTOUCH_MANIPULATION_PUSHED_PRIVATE_H

#include "nanotouch/advanced/manipulation.h"

/* Does the tip touch any of them, or anything of it? */
NT_REALTIME int nt_pushed_touches(const nt_pushed *pushed, const nt_pushed_state *state);

#endif
