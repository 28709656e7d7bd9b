/* SPDX-License-Identifier: BSD-3-Clause
 * Private to host/: words with figures, and JSON, into memory of the caller's. */
#ifndef NANOTOUCH_HOST_TEXT_H
#define NANOTOUCH_HOST_TEXT_H

#include <stddef.h>

typedef struct nt_text {
    char *at;
    size_t size, length; /* always ended by 0; what does not fit is cut */
} nt_text;
/* A figure for the {key} of a pattern. how: a unit, for three digits with it; "2 m": two of them; "%": a fraction in
 * whole percent, "%.1" with a decimal; "#": a plain number, "#2" of two digits; NULL: the text. */
typedef struct nt_figure {
    const char *key;
    double value;
    const char *how;
    const char *text;
} nt_figure;

nt_text nt_text_in(char *at, size_t size);
void nt_text_add(nt_text *text, const char *part);
void nt_text_fixed(nt_text *text, double value, int decimals);
void nt_text_general(nt_text *text, double value, int digits);
/* Three digits with the unit under a prefix, "-" where it is not known. */
void nt_text_digits(nt_text *text, double value, const char *unit, int count);
/* A pattern with its {keys} filled in; figures end with a key NULL. */
void nt_text_fill(nt_text *text, const char *pattern, const nt_figure *figures);

/* JSON. A comma comes by itself. Not finite: null. */
void nt_json_key(nt_text *text, const char *key);
void nt_json_open(nt_text *text, const char *bracket);
void nt_json_close(nt_text *text, const char *bracket);
void nt_json_text(nt_text *text, const char *key, const char *value);
void nt_json_number(nt_text *text, const char *key, double value); /* key NULL: of a list */

#endif
