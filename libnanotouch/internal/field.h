/* SPDX-License-Identifier: BSD-3-Clause
 * The check behind every table of fields. */
#ifndef NANOTOUCH_INTERNAL_FIELD_H
#define NANOTOUCH_INTERNAL_FIELD_H

#include "nanotouch/advanced/field.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Checks the fields of *object in the order of the table. NT_OK; NT_E_NOT_FINITE (NaN or infinite) or NT_E_RANGE with
 * the first offending field in *problem (NULL allowed); NT_E_ARGUMENT if fields or object is NULL. Thread-safe. */
NT_API nt_status nt_field_check(const nt_field *fields, int count, const void *object, nt_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
