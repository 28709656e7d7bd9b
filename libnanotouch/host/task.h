/* SPDX-License-Identifier: BSD-3-Clause
 * Private to host/: a task is one row, with its texts, its score and its ideal operator. What it remembers is the
 * host's. */
#ifndef NANOTOUCH_HOST_TASK_H
#define NANOTOUCH_HOST_TASK_H

#include "host/text.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/host.h"

typedef struct nt_operator nt_operator;

typedef struct nt_task {
    nt_host_task about;
    const char *hides;   /* what a view does not show, as "law|contact": surface, law, contact, sliders */
    const char *choices; /* that can be made now, as "a|b"; "": none */
    const char *words;   /* what to do */
    const char *trials;  /* of its result, the columns of a trial; NULL: it has none */
    nt_status (*begin)(nt_session_host *host);                   /* NULL: nothing; what it refuses is in words */
    void (*judge)(nt_session_host *host, const nt_frame *frame); /* each frame; NULL: nothing */
    void (*take)(nt_session_host *host);                         /* what lies there has changed; NULL: nothing */
    void (*now)(nt_session_host *host, nt_text *text);           /* how it stands */
    void (*figures)(nt_session_host *host, nt_figure *figures);  /* of the words, at most 7; NULL: none */
    nt_status (*choose)(nt_session_host *host, int number);      /* NULL: it offers none */
    nt_status (*answer)(nt_session_host *host, double value);    /* NULL: it asks for no number */
    void (*solve)(nt_operator *op);
    const struct nt_page *page; /* of the lesson; else NULL */
} nt_task;
const nt_task *nt_task_named(const char *name); /* NULL: there is none */
enum { NT_TASK_FIGURES = 8 };

/* --- what tasks remember --- */

typedef struct nt_staircase {
    double log, least, most; /* of the ratio shown next, and its ends */
    double reversals[32];
    int count, needed, right_in_a_row, last_way, trials, at_the_floor;
} nt_staircase;
/* Two right answers in a row bring it nearer to 1, a wrong one takes it away: it settles where 70.7 % are right
 * (Levitt, J. Acoust. Soc. Am. 49 (1971) 467). */
#define NT_STAIRCASE_RIGHT 0.707
nt_staircase nt_staircase_begin(double start, double least, double most, int reversals);
void nt_staircase_take(nt_staircase *stairs, int right);
int nt_staircase_done(const nt_staircase *stairs);
double nt_staircase_ratio(const nt_staircase *stairs);
double nt_staircase_threshold(const nt_staircase *stairs);

typedef struct nt_trial {
    double ratio;
    char wanted, answer;
} nt_trial;
enum { NT_TRIALS = 256, NT_PULLS = 16, NT_TRACE = 4096, NT_MEASURES = 12, NT_TRACE_PARTS = 60, NT_EVENTS_TOLD = 8 };

typedef struct nt_measure {
    const char *name, *unit;
    double value; /* [unit] */
} nt_measure;

typedef struct nt_trace_row {
    double time, x, y, gap, low, high; /* [s], [m], [m], [m], [N], [N] */
    int touches;
} nt_trace_row;

typedef struct nt_trainer {
    const nt_task *task; /* NULL: none runs */
    nt_random random;
    double began, reported; /* [s] */
    int touches, is_done, passed;
    double score;
    char said[NT_HOST_LINE];
    nt_measure measures[NT_MEASURES];
    int measure_count;
    nt_trace_row trace[NT_TRACE];
    int trace_count;
    double slice; /* of the trace [s] */
    nt_trial trials[NT_TRIALS];
    int trial_count;
    /* of one task or another */
    double max_force, deepest, since, low, target; /* [N], [m], [s], [N], [by task] */
    double pulls[NT_PULLS];                        /* [N] */
    int pull_count;
    double good, all, squares, left, right; /* of a steady force */
    double modulus;                         /* [Pa] */
    char wanted, shown;                     /* of two samples: which one it is, which one lies there */
    nt_staircase stairs;
    unsigned char touched[NT_TRACE_PARTS];                  /* parts of the width */
    int predicted;                                          /* of a page; -1: not yet */
    double own;                                             /* value of what the page has changed */
    double goals[NT_PARTICLES][2], places[NT_PARTICLES][3]; /* [m] */
    int goal_count, place_count, lay_count, free_losses;
    long touches_before, losses_before, touches_now, losses; /* of what is pushed */
    double push, max_push;                                   /* [N] */
    const char *events[NT_EVENTS_TOLD];                      /* that are not told yet */
    int event_count;
} nt_trainer;

/* trainer.c */
nt_status nt_trainer_begin(nt_session_host *host, const nt_task *task, double seed);
void nt_trainer_end(nt_session_host *host);
void nt_trainer_see(nt_session_host *host, const nt_frame *frame);
int nt_trainer_locks(const nt_session_host *host); /* 1: nothing may be touched yet */
void nt_trainer_measure(nt_session_host *host, const char *name, const char *unit, double value);
void nt_trainer_finish(nt_session_host *host, int passed, double score, const char *pattern, const nt_figure *figures);
nt_status nt_trainer_early(nt_session_host *host, const char *why, const nt_figure *figures);

/* A task that compares two samples: what lays one, A or B, what deals the next pair, what ends the task. */
typedef struct nt_comparison {
    nt_status (*show)(nt_session_host *host, char letter);
    nt_status (*deal)(nt_session_host *host);
    void (*finish)(nt_session_host *host);
} nt_comparison;
/* Choices 0 and 1 lay A and B, 2 and 3 answer with them; answers end by the staircase. */
nt_status nt_trainer_compare(nt_session_host *host, const nt_comparison *task, int number);
const char *nt_trainer_choices(const nt_session_host *host);
void nt_trainer_tell(nt_session_host *host, nt_text *json);
void nt_trainer_tell_particles(nt_session_host *host, nt_text *json);

/* operator.c: hands and eyes */
struct nt_operator {
    nt_session_host *host;
    const nt_host_clock *clock;
    double time;      /* [s] */
    nt_status status; /* not NT_OK: it has given up, and nothing is done any more */
};
const nt_frame *nt_operator_wait(nt_operator *op, double duration);
const nt_frame *nt_operator_wheel(nt_operator *op, double steps);
const nt_frame *nt_operator_down_to(nt_operator *op, double force);
void nt_operator_up(nt_operator *op);
void nt_operator_hold(nt_operator *op, double force, double way);
void nt_operator_ask(nt_operator *op, const char *what, double x, double y, double z);
int nt_operator_goes_on(const nt_operator *op); /* neither solved nor given up */

extern const nt_task nt_task_find, nt_task_pull_off, nt_task_trace, nt_task_steady, nt_task_stiffer, nt_task_slower,
    nt_task_dent, nt_task_scratch, nt_task_push, nt_task_pattern, nt_task_wire, nt_task_lesson, nt_task_pages[5];

#endif
