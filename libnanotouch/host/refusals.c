/* SPDX-License-Identifier: BSD-3-Clause
 * Why something was refused, in words; of a slider, how far it may go. */
#include <math.h>
#include <string.h>

#include "host/state.h"

enum { HALVINGS = 20 };
static const double SURE = 0.999; /* of what was found is said, so that asking for it works */

nt_status nt_host_refuse_filled(nt_session_host *host, const char *pattern, const nt_figure *figures)
{
    static const nt_figure none[] = {{0}};
    nt_text text = nt_text_in(host->why, sizeof host->why);
    nt_text_fill(&text, pattern, figures ? figures : none);
    host->field = NULL;
    host->due |= NT_DUE_REFUSED;
    return NT_E_STATE;
}

/* Of the loop with this value in its settings. */
static double margin_with(const nt_session_host *host, const nt_field *field, double value)
{
    const nt_session_setup *setup = nt_session_setup_of(host->session);
    nt_settings settings = setup->settings;
    nt_margins margins;
    nt_field_set(field, &settings, value);
    const double stiffness = nt_session_plan(host->session)->maximum_stiffness;
    return nt_margins_judge(&setup->rig, &settings, stiffness, setup->mode, &margins).margin;
}

/* The value nearest to a bad one, from a good one on, that keeps the margin; NaN where not even the good one does. */
static double furthest(const nt_session_host *host, const nt_field *field, double good, double bad)
{
    const double least = nt_session_setup_of(host->session)->minimum_margin;
    if (!(good > 0.0 && bad > 0.0 && margin_with(host, field, good) >= least))
        return (double)NAN;
    const double sure = bad > good ? SURE : 2.0 - SURE;
    for (int i = 0; i < HALVINGS; ++i) {
        const double middle = sqrt(good * bad);
        if (margin_with(host, field, middle) >= least)
            good = middle;
        else
            bad = middle;
    }
    return good * sure;
}

static const char *number_in(char *text, size_t size, double value, int digits)
{
    nt_text words = nt_text_in(text, size);
    nt_text_general(&words, value, digits);
    return text;
}

/* Beyond the margin: "stability margin (R1 contact)". */
static void say_unstable(const nt_session_host *host, nt_text *text, const nt_field *field, double asked, double before,
                         const nt_problem *problem)
{
    char limit[NT_HOST_NAME];
    const char *rule = strchr(problem->field, '(');
    char kind[NT_HOST_NAME];
    nt_text named = nt_text_in(kind, sizeof kind);
    nt_text_add(&named, rule ? rule + 1 : problem->field);
    kind[strcspn(kind, ")")] = '\0';
    nt_text_fill(
        text, "the loop would not be stable enough (margin {margin} of {rule}; at least {least} is kept).",
        (const nt_figure[]){
            {"margin", problem->value, "#", 0}, {"rule", 0.0, NULL, kind}, {"least", problem->minimum, "#", 0}, {0}});
    const double possible = furthest(host, field, before, asked);
    if (isfinite(possible))
        nt_text_fill(
            text, " Possible is up to {limit}.",
            (const nt_figure[]){{"limit", 0.0, NULL, nt_host_quantity(field, possible, limit, sizeof limit)}, {0}});
}

/* What the problem says, without the name of the field that the sentence begins with. */
static void say_problem(nt_text *text, const char *field, const nt_problem *problem, nt_status status)
{
    char said[NT_PROBLEM_TEXT], value[NT_HOST_NAME], low[48], high[48];
    const int is_range = problem->field && problem->code == NT_PROBLEM_RANGE;
    if (problem->code == NT_PROBLEM_ACCURACY || (is_range && strcmp(problem->field, "demand.relative_accuracy") == 0)) {
        nt_text_fill(text, "known only within {best} % there, and this session keeps {kept} %",
                     (const nt_figure[]){{"best", 0.0, NULL, number_in(low, sizeof low, 100.0 * problem->minimum, 2)},
                                         {"kept", 0.0, NULL, number_in(high, sizeof high, 100.0 * problem->value, 2)},
                                         {0}});
    } else if (problem->code == NT_PROBLEM_DEFORMS) {
        nt_text_fill(text, "so soft that {cause} moves it before contact; no law within the demand",
                     (const nt_figure[]){{"cause", 0.0, NULL, problem->cause ? problem->cause : "a law"}, {0}});
    } else if (problem->field && strcmp(problem->field, field) != 0) {
        nt_text_fill(text,
                     "that does not go with {field} = {value} {unit}, which would have to be within {low} .. {high} "
                     "{unit}",
                     (const nt_figure[]){{"field", 0.0, NULL, problem->field},
                                         {"value", 0.0, NULL, number_in(value, sizeof value, problem->value, 6)},
                                         {"low", 0.0, NULL, number_in(low, sizeof low, problem->minimum, 6)},
                                         {"high", 0.0, NULL, number_in(high, sizeof high, problem->maximum, 6)},
                                         {"unit", 0.0, NULL, problem->unit ? problem->unit : ""},
                                         {0}});
        const char *why = strchr(nt_problem_print(problem, said, sizeof said), '(');
        if (why && problem->code != NT_PROBLEM_RANGE) {
            said[strcspn(said, ")")] = '\0';
            nt_text_add(text, " ");
            nt_text_add(text, why);
            nt_text_add(text, ")");
        }
    } else if (problem->field || problem->code != NT_PROBLEM_RANGE) {
        nt_text_add(text, nt_problem_print(problem, said, sizeof said));
    } else {
        nt_text_add(text, nt_status_message(status));
    }
}

/* "humidity 30 %: " */
static nt_text begin(nt_session_host *host, const nt_field *row, double value)
{
    char asked[NT_HOST_NAME], name[NT_HOST_NAME];
    nt_text text = nt_text_in(name, sizeof name);
    const char *title = nt_host_slider_title(row->name);
    nt_text_add(&text, title ? title : strchr(row->name, '.') + 1);
    for (char *at = name; *at; ++at)
        if (*at == '_')
            *at = ' ';
    text = nt_text_in(host->why, sizeof host->why);
    nt_text_fill(&text, "{name} {asked}: ",
                 (const nt_figure[]){{"name", 0.0, NULL, name},
                                     {"asked", 0.0, NULL, nt_host_quantity(row, value, asked, sizeof asked)},
                                     {0}});
    return text;
}

static void end(nt_session_host *host, const nt_field *row, nt_text *text, double before)
{
    char stays[NT_HOST_NAME];
    nt_text_fill(text, text->at[text->length - 1] == '.' ? " It stays at {stays}." : ". It stays at {stays}.",
                 (const nt_figure[]){{"stays", 0.0, NULL, nt_host_quantity(row, before, stays, sizeof stays)}, {0}});
    host->field = row->name;
    host->reopens = 0;
    host->due |= NT_DUE_REFUSED;
}

nt_status nt_host_refuse_change(nt_session_host *host, const char *field, double value, const nt_problem *problem,
                                nt_status status)
{
    nt_host_kind kind = NT_HOST_SCENE;
    const nt_field *row = nt_host_field(field, &kind);
    const double before = nt_field_get(row, nt_host_described(host, kind));
    nt_text text = begin(host, row, value);
    if (problem->field && strstr(problem->field, "margin"))
        say_unstable(host, &text, row, value, before, problem);
    else
        say_problem(&text, field, problem, status);
    end(host, row, &text, before);
    return status;
}

void nt_host_refuse(nt_session_host *host, const char *why)
{
    host->wants[0] = '\0';
    if (host->due & NT_DUE_REFUSED) /* it is in words already */
        return;
    if (host->reopens) {
        nt_host_kind kind = NT_HOST_SCENE;
        const nt_field *row = nt_host_field(host->reopening.field, &kind);
        nt_text text = begin(host, row, host->reopening.after);
        nt_text_add(&text, why);
        end(host, row, &text, nt_field_get(row, nt_host_described(host, kind)));
        return;
    }
    nt_text text = nt_text_in(host->why, sizeof host->why);
    nt_text_add(&text, why);
    host->field = NULL;
    host->due |= NT_DUE_REFUSED;
}
