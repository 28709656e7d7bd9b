/* SPDX-License-Identifier: BSD-3-Clause
 * Tables of fields. */
#ifndef NANOTOUCH_INTERNAL_CORRUGATION_H
#define NANOTOUCH_INTERNAL_CORRUGATION_H

#include "nanotouch/advanced/corrugation.h"

#ifdef __cplusplus
extern "C" {
#endif

/* E0 = 0.4 eV, a = 0.5 nm, k = 1 N/m, gamma = 1e-6 N s/m, T = 0 (NaCl(001) in its range). */
NT_API nt_corrugation nt_corrugation_defaults(void);
/* The table of its fields, with units and ranges; *count (NULL allowed) its length. */
NT_API const nt_field *nt_corrugation_fields(int *count);

#ifdef __cplusplus
}
#endif
#endif
