/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what scan.h does not promise. */
#ifndef NANOTOUCH_SCAN_SCAN_PRIVATE_H
#define NANOTOUCH_SCAN_SCAN_PRIVATE_H

#include "nanotouch/advanced/scan.h"

/* Where the tip stands over the sample at this share of a half line's way: raster, hysteresis (Rayleigh's parabola, no
 * offset at the ends), drift. */
NT_REALTIME nt_pose nt_scanner_at(const nt_scanner *scanner, long line, double share, int back, double time);

#endif
