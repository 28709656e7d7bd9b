/* SPDX-License-Identifier: BSD-3-Clause
 * Private. What has a component for each of the three axes. */
#ifndef NANOTOUCH_CORE_AXES_H
#define NANOTOUCH_CORE_AXES_H

#include <string.h>

#include "nanotouch/types.h"

static inline void copy_axes(double to[NT_AXES], const double from[NT_AXES])
{
    memcpy(to, from, NT_AXES * sizeof *to);
}

#endif
