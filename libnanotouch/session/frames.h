/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what frames.h does not promise. */
#ifndef NANOTOUCH_SESSION_FRAMES_PRIVATE_H
#define NANOTOUCH_SESSION_FRAMES_PRIVATE_H

#include "nanotouch/frames.h"

/* Size and version set, numbers NaN, counters and bits 0. */
NT_REALTIME nt_frame nt_frame_unknown(void);
/* How often the description was set; for nt_frame.changes. */
NT_REALTIME uint32_t nt_frames_changes(const nt_frames *frames);

#endif
