/* SPDX-License-Identifier: BSD-3-Clause
 * The version, in the one place that the build, the Python package and the library read. */
#ifndef NANOTOUCH_VERSION_H
#define NANOTOUCH_VERSION_H

#include "nanotouch/status.h"

#define NT_VERSION "0.2.0"

#ifdef __cplusplus
extern "C" {
#endif

/* NT_VERSION of the library that is running, which a program may compare with the header it was built with.
 * Static storage. Thread-safe, real-time safe. */
NT_API const char *nt_version(void);

#ifdef __cplusplus
}
#endif
#endif
