/* SPDX-License-Identifier: BSD-3-Clause
 * Words with figures, and JSON (text.h). */
#include "host/text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

nt_text nt_text_in(char *at, size_t size)
{
    at[0] = '\0';
    return (nt_text){at, size, 0};
}

static void add_part(nt_text *text, const char *part, size_t count)
{
    const size_t room = text->size - 1 - text->length, taken = count < room ? count : room;
    memcpy(text->at + text->length, part, taken);
    text->length += taken;
    text->at[text->length] = '\0';
}

void nt_text_add(nt_text *text, const char *part)
{
    add_part(text, part, strlen(part));
}

void nt_text_fixed(nt_text *text, double value, int decimals)
{
    char number[340];
    (void)snprintf(number, sizeof number, "%.*f", decimals, value);
    nt_text_add(text, number);
}

void nt_text_general(nt_text *text, double value, int digits)
{
    char number[48];
    (void)snprintf(number, sizeof number, "%.*g", digits, value);
    nt_text_add(text, number);
}

/* "^2" of a unit as it is written. */
static void add_unit(nt_text *text, const char *unit)
{
    for (; *unit; ++unit)
        if (unit[0] == '^' && (unit[1] == '2' || unit[1] == '3'))
            nt_text_add(text, *++unit == '2' ? "²" : "³");
        else
            add_part(text, unit, 1);
}

void nt_text_digits(nt_text *text, double value, const char *unit, int count)
{
    static const char *const prefixes[] = {"a", "f", "p", "n", "µ", "m", "", "k", "M", "G", "T"};
    if (!isfinite(value)) {
        nt_text_add(text, "-");
        return;
    }
    const double size = fabs(value);
    int power = size > 0.0 && unit[0] ? 3 * (int)floor(log10(size) / 3.0 + 1e-12) : 0;
    power = power < -18 ? -18 : power > 12 ? 12 : power;
    const double scaled = value * pow(10.0, -power);
    if (fabs(scaled) < 1e-3) {
        nt_text_add(text, unit[0] ? "0 " : "0");
        add_unit(text, unit);
        return;
    }
    int decimals = count - 1 - (int)floor(log10(fabs(scaled)));
    decimals = decimals < 0 ? 0 : decimals > count ? count : decimals;
    nt_text_fixed(text, scaled, decimals);
    if (unit[0]) {
        nt_text_add(text, " ");
        nt_text_add(text, prefixes[power / 3 + 6]);
        add_unit(text, unit);
    }
}

static void add_figure(nt_text *text, const nt_figure *figure)
{
    const char *how = figure->how;
    if (!how)
        nt_text_add(text, figure->text);
    else if (how[0] == '%')
        nt_text_fixed(text, 100.0 * figure->value, how[1] == '.');
    else if (how[0] == '#')
        nt_text_general(text, figure->value, how[1] == '2' ? 2 : 3);
    else if (how[0] == '2')
        nt_text_digits(text, figure->value, how + 2, 2);
    else
        nt_text_digits(text, figure->value, how, 3);
}

void nt_text_fill(nt_text *text, const char *pattern, const nt_figure *figures)
{
    while (*pattern) {
        const char *open = strchr(pattern, '{'), *close = open ? strchr(open, '}') : NULL;
        if (!close) {
            nt_text_add(text, pattern);
            return;
        }
        add_part(text, pattern, (size_t)(open - pattern));
        const size_t length = (size_t)(close - open - 1);
        for (const nt_figure *one = figures; one->key; ++one)
            if (strlen(one->key) == length && strncmp(one->key, open + 1, length) == 0)
                add_figure(text, one);
        pattern = close + 1;
    }
}

/* --- JSON --- */

static void separate(nt_text *text)
{
    const char last = text->length ? text->at[text->length - 1] : '{';
    if (last != '{' && last != '[' && last != ':')
        nt_text_add(text, ",");
}

static void add_string(nt_text *text, const char *value)
{
    nt_text_add(text, "\"");
    for (; *value; ++value) {
        if (*value == '"' || *value == '\\')
            nt_text_add(text, "\\");
        if (*value == '\n')
            nt_text_add(text, "\\n");
        else if ((unsigned char)*value >= ' ')
            add_part(text, value, 1);
    }
    nt_text_add(text, "\"");
}

void nt_json_key(nt_text *text, const char *key)
{
    separate(text);
    add_string(text, key);
    nt_text_add(text, ":");
}

void nt_json_open(nt_text *text, const char *bracket)
{
    separate(text);
    nt_text_add(text, bracket);
}

void nt_json_close(nt_text *text, const char *bracket)
{
    nt_text_add(text, bracket);
}

void nt_json_text(nt_text *text, const char *key, const char *value)
{
    if (key)
        nt_json_key(text, key);
    else
        separate(text);
    add_string(text, value);
}

void nt_json_number(nt_text *text, const char *key, double value)
{
    if (key)
        nt_json_key(text, key);
    else
        separate(text);
    if (!isfinite(value))
        nt_text_add(text, "null");
    else
        nt_text_general(text, value, 17);
}
