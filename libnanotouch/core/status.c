/* SPDX-License-Identifier: BSD-3-Clause
 * Messages of the statuses, and problems in words: see status.h. */
#include "nanotouch/status.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *nt_status_message(nt_status status)
{
    switch (status) {
#define NT_STATUS_CASE(code, message)                                                                                  \
    case code:                                                                                                         \
        return message;
        NT_STATUS_LIST(NT_STATUS_CASE)
#undef NT_STATUS_CASE
    }
    return "unknown status";
}

/* A limit that is still valid once %g has rounded it to six digits; `up` is 1 for a minimum, -1 for a maximum. */
static double inside(double limit, double up)
{
    const double digits = limit / pow(10.0, floor(log10(fabs(limit))) - 5.0); /* the sixth is that of the units */
    const double lost = up * (digits - rint(digits));                         /* NaN for 0 and infinity */
    return lost > 1e-9 ? limit + up * 5.1e-6 * fabs(limit) : limit; /* less is the rounding of this division */
}

static const char *const problem_words[] = {
#define NT_PROBLEM_WORDS(name, words) words,
    NT_PROBLEM_LIST(NT_PROBLEM_WORDS)
#undef NT_PROBLEM_WORDS
};

/* What is written so far. */
typedef struct writing {
    char *text;
    unsigned size, length;
} writing;

static void add(writing *w, const char *part)
{
    while (*part != '\0' && w->length + 1 < w->size)
        w->text[w->length++] = *part++;
    w->text[w->length] = '\0';
}

static void add_number(writing *w, double value, const char *unit)
{
    char number[32];
    (void)snprintf(number, sizeof number, "%g", value);
    add(w, number);
    add(w, unit[0] == '\0' ? "" : " ");
    add(w, unit);
}

static void add_words(writing *w, const nt_problem *problem)
{
    for (const char *words = problem_words[problem->code]; *words != '\0'; ++words)
        if (words[0] == '{' && words[1] == '}') {
            add(w, problem->cause ? problem->cause : "a law");
            ++words;
        } else {
            add(w, (const char[]){*words, '\0'});
        }
}

/* "field (words) = value unit" */
static void add_value(writing *w, const nt_problem *problem, const char *unit)
{
    add(w, problem->field == NULL ? "?" : problem->field);
    if (problem_words[problem->code][0] != '\0') {
        add(w, " (");
        add_words(w, problem);
        add(w, ")");
    }
    add(w, " = ");
    add_number(w, problem->value, unit);
}

/* The names of a choice are no unit. */
static void add_range(writing *w, const nt_problem *problem, const char *unit, int is_choice)
{
    if (isinf(problem->minimum) && problem->minimum > 0.0) {
        add(w, ": none is known to be valid");
        return;
    }
    add(w, ": valid is ");
    add_number(w, is_choice ? problem->minimum : inside(problem->minimum, 1.0), "");
    add(w, " .. ");
    add_number(w, is_choice ? problem->maximum : inside(problem->maximum, -1.0), is_choice ? "" : unit);
    add(w, is_choice ? " (" : "");
    add(w, is_choice ? unit : "");
    add(w, is_choice ? ")" : "");
}

const char *nt_problem_print(const nt_problem *problem, char *text, unsigned size)
{
    if (problem == NULL || text == NULL || size == 0)
        return text;
    const char *unit = problem->unit == NULL ? "" : problem->unit;
    const int is_choice = strchr(unit, '|') != NULL;
    writing w = {text, size, 0};
    text[0] = '\0';
    if (problem->field == NULL && problem_words[problem->code][0] != '\0') {
        add_words(&w, problem);
    } else {
        add_value(&w, problem, is_choice ? "" : unit);
        add_range(&w, problem, unit, is_choice);
    }
    if (problem->remedy.field) {
        add(&w, "; ");
        add(&w, problem->remedy.field);
        add(&w, " = ");
        add_number(&w, problem->remedy.value, problem->remedy.unit);
        add(&w, " works");
    }
    return text;
}
