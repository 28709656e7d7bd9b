/* SPDX-License-Identifier: BSD-3-Clause */
#include "nanotouch/version.h"

const char *nt_version(void)
{
    return NT_VERSION;
}
