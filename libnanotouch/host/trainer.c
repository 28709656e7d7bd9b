/* SPDX-License-Identifier: BSD-3-Clause
 * A task beside a session: it sees each frame, keeps a trace, and ends with a result. */
#include <math.h>
#include <string.h>

#include "host/lesson.h"
#include "host/state.h"

static const double SLICE = 0.01;   /* of the trace [s] */
static const double REPORTED = 0.2; /* how it stands is told so often [s] */

nt_status nt_trainer_begin(nt_session_host *host, const nt_task *task, double seed)
{
    nt_trainer *trainer = &host->trainer;
    memset(trainer, 0, sizeof *trainer);
    trainer->task = task;
    trainer->random = nt_random_seed((uint64_t)seed);
    trainer->began = (double)NAN;
    trainer->since = INFINITY;
    trainer->slice = SLICE;
    trainer->predicted = -1;
    const nt_status status = task->begin ? task->begin(host) : NT_OK;
    if (status != NT_OK)
        nt_trainer_end(host);
    host->due |= NT_DUE_TASK;
    return status;
}

void nt_trainer_end(nt_session_host *host)
{
    if (!host->trainer.task)
        return;
    const int shows = host->trainer.place_count;
    host->trainer.task = NULL;
    host->trainer.place_count = host->trainer.goal_count = host->trainer.event_count = 0;
    host->due |= NT_DUE_TASK | (shows ? NT_DUE_PARTICLES : 0u);
}

int nt_trainer_locks(const nt_session_host *host)
{
    return host->trainer.task && host->trainer.task->page && host->trainer.predicted < 0;
}

/* --- the trace: least and largest force of each slice; where it is full, slices become twice as long --- */

static void join(nt_trace_row *to, const nt_trace_row *from)
{
    const nt_trace_row before = *to;
    *to = *from;
    to->time = before.time;
    to->low = fmin(before.low, from->low);
    to->high = fmax(before.high, from->high);
}

static void halve(nt_trainer *trainer)
{
    trainer->slice *= 2.0;
    int count = 0;
    for (int i = 0; i < trainer->trace_count; ++i) {
        nt_trace_row row = trainer->trace[i];
        row.time = floor(row.time / trainer->slice + 1e-6) * trainer->slice;
        if (count && trainer->trace[count - 1].time == row.time)
            join(&trainer->trace[count - 1], &row);
        else
            trainer->trace[count++] = row;
    }
    trainer->trace_count = count;
}

static void keep(nt_trainer *trainer, const nt_frame *frame)
{
    if (trainer->trace_count == NT_TRACE)
        halve(trainer);
    const double force = frame->tip_force[NT_Z];
    const nt_trace_row row = {floor(frame->time / trainer->slice + 1e-6) * trainer->slice,
                              frame->tip_position[NT_X],
                              frame->tip_position[NT_Y],
                              frame->gap,
                              force,
                              force,
                              nt_frame_touches(frame)};
    nt_trace_row *last = trainer->trace_count ? &trainer->trace[trainer->trace_count - 1] : NULL;
    if (last && last->time == row.time)
        join(last, &row);
    else
        trainer->trace[trainer->trace_count++] = row;
}

void nt_trainer_see(nt_session_host *host, const nt_frame *frame)
{
    nt_trainer *trainer = &host->trainer;
    if (!trainer->task || !isfinite(frame->tip_force[NT_Z]))
        return;
    if (!trainer->is_done) {
        if (!isfinite(trainer->began))
            trainer->began = frame->time;
        keep(trainer, frame);
        if (trainer->task->judge)
            trainer->task->judge(host, frame);
        trainer->touches = nt_frame_touches(frame);
    }
    if (!(fabs(frame->time - trainer->reported) < REPORTED)) {
        trainer->reported = frame->time;
        host->due |= NT_DUE_TASK;
    }
}

/* --- the result --- */

void nt_trainer_measure(nt_session_host *host, const char *name, const char *unit, double value)
{
    nt_trainer *trainer = &host->trainer;
    if (trainer->measure_count < NT_MEASURES)
        trainer->measures[trainer->measure_count++] = (nt_measure){name, unit, value};
}

void nt_trainer_finish(nt_session_host *host, int passed, double score, const char *pattern, const nt_figure *figures)
{
    nt_trainer *trainer = &host->trainer;
    nt_text said = nt_text_in(trainer->said, sizeof trainer->said);
    nt_text_fill(&said, pattern, figures);
    trainer->is_done = 1;
    trainer->passed = passed;
    trainer->score = fmin(fmax(score, 0.0), 100.0);
    const int count = trainer->trace_count;
    nt_trainer_measure(host, "duration", "s", count ? trainer->trace[count - 1].time - trainer->trace[0].time : 0.0);
    host->due |= NT_DUE_TASK;
}

nt_status nt_trainer_early(nt_session_host *host, const char *why, const nt_figure *figures)
{
    char pattern[NT_HOST_LINE];
    nt_text text = nt_text_in(pattern, sizeof pattern);
    nt_text_add(&text, "not yet: ");
    nt_text_add(&text, why);
    return nt_host_refuse_filled(host, pattern, figures);
}

nt_status nt_trainer_compare(nt_session_host *host, const nt_comparison *task, int number)
{
    nt_trainer *trainer = &host->trainer;
    if (trainer->touches)
        return nt_trainer_early(host, "lift the tip first", NULL);
    if (number < 2)
        return task->show(host, (char)('A' + number));
    const char answer = (char)('A' + number - 2);
    trainer->trials[trainer->trial_count++] = (nt_trial){nt_staircase_ratio(&trainer->stairs), trainer->wanted, answer};
    nt_staircase_take(&trainer->stairs, answer == trainer->wanted);
    if (!nt_staircase_done(&trainer->stairs) && trainer->trial_count < NT_TRIALS)
        return task->deal(host);
    task->finish(host);
    return NT_OK;
}

/* --- told --- */

const char *nt_trainer_choices(const nt_session_host *host)
{
    const nt_trainer *trainer = &host->trainer;
    if (trainer->is_done)
        return trainer->task->about.follows[0] ? "next page" : "";
    return trainer->task->page && trainer->predicted >= 0 ? "" : trainer->task->choices;
}

static void add_list(nt_text *json, const char *key, const char *words)
{
    nt_json_key(json, key);
    nt_json_open(json, "[");
    while (*words) {
        char word[NT_HOST_LINE] = {0};
        const size_t length = strcspn(words, "|");
        memcpy(word, words, length < sizeof word ? length : sizeof word - 1);
        nt_json_text(json, NULL, word);
        words += length + (words[length] == '|');
    }
    nt_json_close(json, "]");
}

static void add_words(nt_text *json, nt_session_host *host)
{
    const nt_task *task = host->trainer.task;
    nt_figure figures[NT_TASK_FIGURES] = {{0}};
    char words[NT_HOST_LINE], now[NT_HOST_LINE];
    if (task->figures)
        task->figures(host, figures);
    nt_text text = nt_text_in(words, sizeof words);
    nt_text_fill(&text, task->page && host->trainer.predicted >= 0 ? task->page->action : task->words, figures);
    nt_json_text(json, "words", words);
    text = nt_text_in(now, sizeof now);
    if (task->now)
        task->now(host, &text);
    nt_json_text(json, "now", now);
}

void nt_trainer_tell(nt_session_host *host, nt_text *json)
{
    const nt_trainer *trainer = &host->trainer;
    const nt_task *task = trainer->task;
    nt_json_text(json, "name", task ? task->about.name : "");
    if (!task)
        return;
    nt_json_text(json, "title", task->about.title);
    add_list(json, "choices", nt_trainer_choices(host));
    add_list(json, "hides", trainer->is_done ? "" : task->hides);
    nt_json_text(json, "asked", trainer->is_done ? "" : task->about.asked);
    if (!trainer->is_done) {
        add_words(json, host);
        return;
    }
    nt_json_text(json, "words", "");
    nt_json_text(json, "now", trainer->said);
    nt_json_key(json, "passed");
    nt_text_add(json, trainer->passed ? "true" : "false");
    nt_json_number(json, "score", trainer->score);
    nt_json_key(json, "scored");
    nt_text_add(json, task->page ? "false" : "true");
}

/* --- the file of the result --- */

static void add_head(nt_text *text, const nt_trainer *trainer)
{
    nt_text_fill(text, "# task: {name}\n# passed: {passed}\n# score: ",
                 (const nt_figure[]){{"name", 0.0, NULL, trainer->task->about.name},
                                     {"passed", 0.0, NULL, trainer->passed ? "True" : "False"},
                                     {0}});
    nt_text_fixed(text, trainer->score, 1);
    nt_text_add(text, "\n# said: ");
    nt_text_add(text, trainer->said);
    for (int i = 0; i < trainer->measure_count; ++i) {
        const nt_measure *of = &trainer->measures[i];
        nt_text_fill(text, of->unit[0] ? "\n# {name} [{unit}]: " : "\n# {name}: ",
                     (const nt_figure[]){{"name", 0.0, NULL, of->name}, {"unit", 0.0, NULL, of->unit}, {0}});
        nt_text_general(text, of->value, 17);
    }
    nt_text_add(text, "\n");
    nt_text_add(text, trainer->trial_count ? trainer->task->trials
                                           : "time [s],x [m],y [m],gap [m],least force [N],largest force [N],contact");
    nt_text_add(text, "\n");
}

static void add_trace(nt_text *text, const nt_trace_row *row)
{
    const double values[] = {row->time, row->x, row->y, row->gap, row->low, row->high, row->touches};
    for (size_t i = 0; i < sizeof values / sizeof *values; ++i) {
        nt_text_general(text, values[i], 17);
        nt_text_add(text, i + 1 < sizeof values / sizeof *values ? "," : "\n");
    }
}

static void add_trial(nt_text *text, const nt_trial *trial, long number)
{
    nt_text_general(text, (double)number, 9);
    nt_text_add(text, ",");
    nt_text_general(text, trial->ratio, 17);
    const char letters[] = {',',  trial->wanted, ',', trial->answer, ',', trial->wanted == trial->answer ? '1' : '0',
                            '\n', '\0'};
    nt_text_add(text, letters);
}

long nt_host_result(const nt_session_host *host, long *at, char *text, size_t size)
{
    const nt_trainer *trainer = &host->trainer;
    const long rows = trainer->trial_count ? trainer->trial_count : trainer->trace_count;
    nt_text lines = nt_text_in(text, size);
    if (!trainer->task || !trainer->is_done)
        return 0;
    if (*at == 0)
        add_head(&lines, trainer);
    for (; *at < rows && lines.length + NT_HOST_LINE < size; ++*at)
        if (trainer->trial_count)
            add_trial(&lines, &trainer->trials[*at], *at + 1);
        else
            add_trace(&lines, &trainer->trace[*at]);
    return (long)lines.length;
}
