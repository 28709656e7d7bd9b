/* SPDX-License-Identifier: BSD-3-Clause
 * What is told, as JSON (docs/host.md). */
#include <math.h>
#include <string.h>

#include "host/state.h"

static const char *const kinds[] = {"scene", "rig", "settings"};

/* {"section": {"key": value}}, choices by their words. */
static void add_described(nt_text *json, const nt_session_host *host, nt_host_kind kind)
{
    int count;
    const nt_field *fields = nt_host_fields(kind, &count);
    const char *open = "";
    size_t length = 0;
    nt_json_key(json, kinds[kind]);
    nt_json_open(json, "{");
    for (int i = 0; i < count; ++i) {
        const char *key = strchr(fields[i].name, '.') + 1, *words = fields[i].unit;
        const size_t now = (size_t)(key - fields[i].name);
        if (now != length || strncmp(open, fields[i].name, now) != 0) {
            if (length)
                nt_json_close(json, "}");
            char section[NT_HOST_NAME] = {0};
            memcpy(section, fields[i].name, now - 1);
            nt_json_key(json, section);
            nt_json_open(json, "{");
            open = fields[i].name;
            length = now;
        }
        const double value = nt_field_get(&fields[i], nt_host_described(host, kind));
        if (!strchr(words, '|')) {
            nt_json_number(json, key, value);
            continue;
        }
        for (int skip = (int)value; skip > 0 && strchr(words, '|'); --skip)
            words = strchr(words, '|') + 1;
        char word[NT_HOST_NAME] = {0};
        memcpy(word, words, strcspn(words, "|"));
        nt_json_text(json, key, word);
    }
    nt_json_close(json, "}}");
}

static void add_plan(nt_text *json, const nt_plan *plan)
{
    nt_json_number(json, "bound", plan->bound.force_error);
    nt_json_text(json, "law", plan->terms[0].words);
    nt_json_key(json, "warnings");
    nt_json_open(json, "[");
    for (int i = 0; i < plan->warning_count; ++i)
        nt_json_text(json, NULL, plan->warnings[i].text);
    nt_json_close(json, "]");
    nt_json_key(json, "terms");
    nt_json_open(json, "[");
    for (int i = 0; i < NT_PLAN_TERMS; ++i)
        if (plan->terms[i].force > 0.0) {
            nt_json_open(json, "{");
            nt_json_text(json, "title", plan->terms[i].title);
            nt_json_text(json, "words", plan->terms[i].words);
            nt_json_number(json, "force", plan->terms[i].force);
            nt_json_number(json, "error", plan->terms[i].bound);
            nt_json_close(json, "}");
        }
    nt_json_close(json, "]");
}

/* Values of the sliders as they are now. */
static void add_shown(nt_text *json, const nt_session_host *host)
{
    nt_json_key(json, "shown");
    nt_json_open(json, "{");
    for (int i = 0; i < host->slider_count; ++i) {
        char words[NT_HOST_NAME];
        const nt_host_slider *slider = &host->sliders[i];
        const double value = nt_field_get(slider->field, nt_host_described(host, slider->kind));
        nt_json_text(json, slider->field->name, nt_host_quantity(slider->field, value, words, sizeof words));
    }
    nt_json_close(json, "}");
}

static void add_pair(nt_text *json, const char *key, double first, double second)
{
    nt_json_key(json, key);
    nt_json_open(json, "[");
    nt_json_number(json, NULL, first);
    nt_json_number(json, NULL, second);
    nt_json_close(json, "]");
}

static void tell_world(nt_session_host *host, nt_text *json)
{
    const nt_session_setup *setup = nt_session_setup_of(host->session);
    const nt_plan *plan = nt_session_plan(host->session);
    char words[NT_HOST_LINE];
    nt_text felt = nt_text_in(words, sizeof words);
    nt_line_felt(host, &felt);
    nt_json_number(json, "version", NT_HOST_VERSION);
    nt_json_text(json, "preset", host->name);
    nt_json_text(json, "title", host->title);
    nt_json_text(json, "hint", host->hint);
    if (host->source[0])
        nt_json_text(json, "source", host->source);
    nt_json_text(json, "felt", words);
    for (int kind = NT_HOST_SCENE; kind <= NT_HOST_SETTINGS; ++kind)
        add_described(json, host, (nt_host_kind)kind);
    add_plan(json, plan);
    add_shown(json, host);
    nt_json_number(json, "stiffness", host->hand.stiffness);
    nt_json_number(json, "zero", host->hand.zero);
    nt_json_number(json, "margin", host->bounds.margin);
    nt_json_number(json, "force", host->bounds.force);
    nt_json_number(json, "hand", host->bounds.hand);
    nt_json_number(json, "pull_off", host->plan.pull_off_force);
    nt_json_number(json, "slow", nt_law_slow(&host->plan));
    nt_json_number(json, "undo", nt_host_undoable(host));
    nt_json_number(json, "redo", host->undone_count);
    nt_json_number(json, "clearance", setup->clearance);
    nt_json_number(json, "relative_accuracy", setup->demand.relative_accuracy);
    add_pair(json, "start", setup->x, setup->y);
    add_pair(json, "size", host->width, host->height);
}

/* Ends and stops: a view draws a stop's words and asks for its value. */
static void tell_sliders(nt_session_host *host, nt_text *json)
{
    nt_json_key(json, "sliders");
    nt_json_open(json, "[");
    for (int i = 0; i < host->slider_count; ++i) {
        const nt_host_slider *slider = &host->sliders[i];
        nt_json_open(json, "{");
        nt_json_text(json, "what", kinds[slider->kind]);
        nt_json_text(json, "field", slider->field->name);
        nt_json_text(json, "title", slider->title);
        nt_json_text(json, "unit", slider->field->unit);
        nt_json_text(json, "doc", slider->field->doc);
        nt_json_key(json, "stops");
        nt_json_open(json, "[");
        for (int stop = 0; stop < NT_HOST_STOPS; ++stop) {
            char words[NT_HOST_NAME];
            const double value = nt_host_slider_at(slider, stop / (NT_HOST_STOPS - 1.0));
            nt_json_open(json, "[");
            nt_json_number(json, NULL, value);
            nt_json_text(json, NULL, nt_host_quantity(slider->field, value, words, sizeof words));
            nt_json_close(json, "]");
        }
        nt_json_close(json, "]}");
    }
    nt_json_close(json, "]");
}

static void tell_dents(nt_session_host *host, nt_text *json)
{
    nt_json_key(json, "dents");
    nt_json_open(json, "[");
    for (int i = 0; i < host->left.count; ++i) {
        const nt_dent *dent = &host->left.dents[i];
        const double row[] = {
            dent->imprint.start[0], dent->imprint.start[1], dent->imprint.end[0], dent->imprint.end[1],
            dent->imprint.radius,   dent->imprint.depth,    dent->load,           dent->before};
        nt_json_open(json, "[");
        for (size_t k = 0; k < sizeof row / sizeof *row; ++k)
            nt_json_number(json, NULL, row[k]);
        nt_json_close(json, "]");
    }
    nt_json_close(json, "]");
}

static void tell_refused(nt_session_host *host, nt_text *json)
{
    nt_json_text(json, "why", host->why);
    if (host->field)
        nt_json_text(json, "field", host->field);
}

static void tell_guide(nt_session_host *host, nt_text *json)
{
    char words[NT_HOST_LINE];
    nt_text text = nt_text_in(words, sizeof words);
    nt_line_guide(host, &text);
    nt_json_text(json, "text", words);
}

static void tell_note(nt_session_host *host, nt_text *json)
{
    nt_json_text(json, "text", host->note);
}

static const struct {
    unsigned due;
    const char *name;
    void (*tell)(nt_session_host *host, nt_text *json);
} messages[] = {{NT_DUE_SLIDERS, "sliders", tell_sliders},
                {NT_DUE_WORLD, "world", tell_world},
                {NT_DUE_DENTS, "dents", tell_dents},
                {NT_DUE_RECOVERY, "recovery", nt_recovery_tell},
                {NT_DUE_PARTICLES, "particles", nt_trainer_tell_particles},
                {NT_DUE_EVENT, "event", nt_event_tell},
                {NT_DUE_TASK, "task", nt_trainer_tell},
                {NT_DUE_GUIDE, "guide", tell_guide},
                {NT_DUE_NOTE, "note", tell_note},
                {NT_DUE_REFUSED, "refused", tell_refused}};

long nt_host_tell(nt_session_host *host, char *text, size_t size)
{
    for (size_t i = 0; i < sizeof messages / sizeof *messages; ++i)
        if (host->due & messages[i].due) {
            host->due &= ~messages[i].due;
            nt_text json = nt_text_in(text, size);
            nt_json_open(&json, "{");
            nt_json_text(&json, "tell", messages[i].name);
            messages[i].tell(host, &json);
            nt_json_close(&json, "}");
            return (long)json.length;
        }
    return 0;
}
