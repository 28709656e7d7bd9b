/* SPDX-License-Identifier: BSD-3-Clause
 * One table per description: the name, unit, valid range and meaning of each of its numbers. Checks, bindings, TOML
 * keys and the generated documentation all read the same table, so that they cannot disagree. */
#ifndef NANOTOUCH_FIELD_H
#define NANOTOUCH_FIELD_H

#include <stddef.h>

#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One field of a description; all fields in a table are doubles. */
typedef struct nt_field {
    const char *name;        /* dotted, "probe.spring_constant"; static storage */
    const char *unit;        /* SI, "" if none; "no|yes": a choice, of which the field holds the number 0, 1, .. */
    double minimum, maximum; /* valid range, both ends included [unit] */
    unsigned offset;         /* of the double inside the description [byte] */
    const char *doc;         /* what it is, in a few words, with the paper's symbol */
} nt_field;

/* One row of the table of a struct `type`; the field is named by its path in it. */
#define NT_FIELD(type, path, unit, minimum, maximum, doc)                                                              \
    {#path, unit, minimum, maximum, (unsigned)offsetof(type, path), doc}

/* Checks the fields of *object in the order of the table. NT_OK; NT_E_NOT_FINITE (NaN or infinite) or NT_E_RANGE with
 * the first offending field in *problem (NULL allowed); NT_E_ARGUMENT if fields or object is NULL. Thread-safe. */
NT_API nt_status nt_field_check(const nt_field *fields, int count, const void *object, nt_problem *problem);

/* Reads and writes one field of an object; no range check. */
NT_API double nt_field_get(const nt_field *field, const void *object);
/* Writes a value in the field's SI unit, of a choice its number. It is not checked: that is for the object's own check.
 */
NT_API void nt_field_set(const nt_field *field, void *object, double value);

#ifdef __cplusplus
}
#endif
#endif
