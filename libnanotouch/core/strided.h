/* SPDX-License-Identifier: BSD-3-Clause
 * Laws over arrays: one value into the outputs that are wanted; private to the library. */
#ifndef NANOTOUCH_CORE_STRIDED_H
#define NANOTOUCH_CORE_STRIDED_H

#include "nanotouch/types.h"

static inline void nt_strided_store(const nt_strided *arrays, long i, nt_law_value value)
{
    const long j = i * arrays->out_stride;
    if (arrays->U)
        arrays->U[j] = value.U;
    if (arrays->F)
        arrays->F[j] = value.F;
    if (arrays->k)
        arrays->k[j] = value.k;
    if (arrays->a)
        arrays->a[j] = value.a;
}

#endif
