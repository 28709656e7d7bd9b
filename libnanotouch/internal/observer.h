/* SPDX-License-Identifier: BSD-3-Clause
 * An observer within the session's own process. */
#ifndef NANOTOUCH_INTERNAL_OBSERVER_H
#define NANOTOUCH_INTERNAL_OBSERVER_H

#include "nanotouch/advanced/observer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The same within the writer's process, also for private memory; to be closed before the frames. */
NT_API nt_status nt_observer_of(nt_observer **observer, const nt_frames *frames);

#ifdef __cplusplus
}
#endif
#endif
