/* SPDX-License-Identifier: BSD-3-Clause
 * Changes of the world by a person, and their history. */
#include <math.h>
#include <string.h>

#include "host/state.h"

static int is_scale(const char *field)
{
    return strcmp(field, "gains.alpha_p") == 0 || strcmp(field, "gains.alpha_f") == 0;
}

/* Lever and tip are the instrument itself: another one is mounted, and the touch begins above the surface. */
static int is_mounted(nt_host_kind kind, const char *field)
{
    return kind == NT_HOST_RIG || strcmp(field, "tip.radius") == 0 || strcmp(field, "tip.half_angle") == 0;
}

/* Settings that stay with the sample; scales are made for the instrument. */
static void keep(nt_session_host *host, nt_host_kind kind, const char *field, double value)
{
    if (kind != NT_HOST_SETTINGS || is_scale(field))
        return;
    int i = 0;
    while (i < host->kept_count && strcmp(host->kept[i].field, field) != 0)
        ++i;
    if (i == NT_HOST_KEPT)
        return;
    host->kept[i] = (nt_host_change){kind, field, value, value};
    host->kept_count += i == host->kept_count;
}

/* In the session as it is open. */
static nt_status set_open(nt_session_host *host, nt_host_kind kind, const char *field, double value,
                          nt_problem *problem)
{
    const nt_gains *gains = &nt_session_setup_of(host->session)->settings.gains;
    nt_scaling scaling = {gains->alpha_p, gains->alpha_f};
    nt_status status;
    if (is_scale(field)) {
        *(field[12] == 'p' ? &scaling.alpha_p : &scaling.alpha_f) = value;
        status = nt_session_rescale(host->session, &scaling, problem);
    } else {
        status = nt_session_change(host->session, kind == NT_HOST_SCENE ? NT_EVENT_SCENE : NT_EVENT_SETTING, field,
                                   value, problem);
    }
    if (status != NT_OK)
        return status;
    keep(host, kind, field, value);
    return nt_host_learn(host);
}

nt_status nt_host_set(nt_session_host *host, const char *field, double value)
{
    nt_host_kind kind;
    nt_problem problem = {0};
    const nt_field *row = nt_host_field(field, &kind);
    const nt_status status = set_open(host, kind, row->name, value, &problem);
    return status == NT_OK ? status : nt_host_refuse_change(host, field, value, &problem, status);
}

static void push(nt_host_change *stack, int *count, nt_host_change one)
{
    if (*count == NT_HOST_HISTORY)
        memmove(stack, stack + 1, sizeof *stack * (size_t)(--*count));
    stack[(*count)++] = one;
}

/* Does a change, or leaves it to who opens sessions; `reopens` says which list it comes from. */
static nt_status go(nt_session_host *host, nt_host_change one, int reopens)
{
    nt_problem problem = {0};
    if (is_mounted(one.kind, one.field)) {
        if (host->trainer.task)
            return nt_host_refuse_filled(host, "another tip or lever: not while a task runs", NULL);
        host->reopening = one;
        host->reopens = reopens;
        return NT_OK;
    }
    const nt_status status = set_open(host, one.kind, one.field, one.after, &problem);
    return status == NT_OK ? status : nt_host_refuse_change(host, one.field, one.after, &problem, status);
}

static void note_done(nt_session_host *host, nt_host_change one, int reopens)
{
    if (reopens == 1) {
        push(host->done, &host->done_count, one);
        host->undone_count = 0;
    } else if (reopens == 2) {
        --host->done_count;
        push(host->undone, &host->undone_count, (nt_host_change){one.kind, one.field, one.after, one.before});
    } else {
        --host->undone_count;
        push(host->done, &host->done_count, one);
    }
}

void nt_host_settle(nt_session_host *host)
{
    if (host->reopens)
        note_done(host, host->reopening, host->reopens);
    host->reopens = 0;
}

const nt_host_change *nt_host_reopens(const nt_session_host *host)
{
    return host->reopens ? &host->reopening : NULL;
}

static nt_status go_and_note(nt_session_host *host, nt_host_change one, int reopens)
{
    const nt_status status = go(host, one, reopens);
    if (status == NT_OK && !host->reopens)
        note_done(host, one, reopens);
    return status;
}

nt_status nt_host_ask_change(nt_session_host *host, const char *field, double value)
{
    nt_host_kind kind;
    const nt_field *row = nt_host_field(field, &kind);
    if (!row || !isfinite(value))
        return nt_host_refuse_filled(host, "{field} = {value}: no such number",
                                     (const nt_figure[]){{"field", 0.0, NULL, field}, {"value", value, "#", 0}, {0}});
    const double before = nt_field_get(row, nt_host_described(host, kind));
    if (before == value)
        return NT_OK;
    if (!(value >= row->minimum && value <= row->maximum)) {
        const nt_problem problem = {row->name, row->unit, value, row->minimum, row->maximum, 0, 0, {0}};
        return nt_host_refuse_change(host, field, value, &problem, NT_E_RANGE);
    }
    return go_and_note(host, (nt_host_change){kind, row->name, before, value}, 1);
}

int nt_host_undoable(const nt_session_host *host)
{
    return host->done_count ? host->done_count : host->left.count ? host->left.count : host->left.move_count;
}

nt_status nt_host_undo(nt_session_host *host)
{
    if (!host->done_count)
        return nt_left_undo(host);
    const nt_host_change last = host->done[host->done_count - 1];
    return go_and_note(host, (nt_host_change){last.kind, last.field, last.after, last.before}, 2);
}

nt_status nt_host_redo(nt_session_host *host)
{
    return host->undone_count ? go_and_note(host, host->undone[host->undone_count - 1], 3) : NT_OK;
}
