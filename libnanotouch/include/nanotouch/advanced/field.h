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

/* One field of a description: a double, or a choice, which is an enum or an int. */
typedef struct nt_field {
    const char *name;        /* dotted, "probe.spring_constant"; static storage */
    const char *unit;        /* SI, "" if none; of a choice its words, "no|yes", which are 0, 1, .. */
    double minimum, maximum; /* valid range, both ends included [unit] */
    unsigned offset;         /* of the number inside the description [byte] */
    unsigned size;           /* of it: a double's, or an enum's [byte] */
    const char *doc;         /* what it is, in a few words, with the paper's symbol */
} nt_field;

/* One row of the table of a struct `type`, under a name. */
#define NT_FIELD_NAMED(name, type, path, unit, minimum, maximum, doc)                                                  \
    {name, unit, minimum, maximum, (unsigned)offsetof(type, path), (unsigned)sizeof(((type *)0)->path), doc}
/* Named by its path. */
#define NT_FIELD(type, path, ...) NT_FIELD_NAMED(#path, type, path, __VA_ARGS__)

/* Reads and writes one field of an object; no range check. */
NT_API double nt_field_get(const nt_field *field, const void *object);
/* Writes a value in the field's SI unit, of a choice its number. It is not checked: that is for the object's own check,
 * which refuses what is no number of a choice. */
NT_API void nt_field_set(const nt_field *field, void *object, double value);

#ifdef __cplusplus
}
#endif
#endif
