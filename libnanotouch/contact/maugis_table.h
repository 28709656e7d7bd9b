/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what the public header does not have. */
#ifndef NANOTOUCH_CONTACT_MAUGIS_TABLE_PRIVATE_H
#define NANOTOUCH_CONTACT_MAUGIS_TABLE_PRIVATE_H

#include "nanotouch/advanced/maugis.h"

/* As nt_maugis_eval, in a tier. */
nt_status nt_maugis_table_eval(const nt_maugis_table *table, nt_tier tier, double indentation, nt_branch branch,
                               nt_law_value *value);
/* The same polished; away from the folds at rounding level. */
double nt_maugis_table_polish(const nt_maugis_table *table, double indentation);

#endif
