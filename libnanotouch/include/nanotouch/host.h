/* SPDX-License-Identifier: BSD-3-Clause
 * What a live session offers to a person: samples, sliders, a hand, tasks with a score, a lesson, undo, and all words
 * about them, once for every view (docs/host.md). A view sends what is asked and draws what is told; it knows no name
 * of a task, a preset or a slider. The host opens no file and no session: who opens one gives it here.
 *
 * One host per session at a time, one thread. What is told is JSON; NT_HOST_VERSION changes when a
 * key changes its meaning or goes; new keys may come. */
#ifndef NANOTOUCH_HOST_H
#define NANOTOUCH_HOST_H

#include "nanotouch/frames.h"
#include "nanotouch/session.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NT_HOST_VERSION 1
enum {
    NT_HOST_SLIDERS = 8,     /* of one sample at most */
    NT_HOST_STOPS = 201,     /* of a slider, from its low to its high end */
    NT_HOST_LINE = 1024,     /* characters that hold every line */
    NT_HOST_MESSAGE = 131072 /* that hold every message */
};

typedef enum nt_host_kind { NT_HOST_SCENE, NT_HOST_RIG, NT_HOST_SETTINGS } nt_host_kind;
typedef enum nt_host_pushed { NT_HOST_NOTHING, NT_HOST_PARTICLES, NT_HOST_ROD } nt_host_pushed;

/* --- lists --- */

/* A sample with its tip and lever. */
typedef struct nt_host_preset {
    const char *name, *title;
    const char *scene; /* whose scene and rig it has; that of another preset, or its own name */
    const char *hint;  /* what to try */
    const char *felt;  /* what the hand feels, of a scene that the library has no words for; else "" */
    double accuracy;   /* what its forces are planned for: where a slider leads to what is less well known, less [-] */
    nt_host_pushed pushed; /* what a task may lay there */
} nt_host_preset;
/* All of them; *count (NULL allowed) how many. Static. */
NT_API const nt_host_preset *nt_host_presets(int *count);

/* A field that a person may change. */
typedef struct nt_host_slider {
    nt_host_kind kind;
    const nt_field *field;
    const char *title;
    double low, high; /* its ends [unit of the field] */
    int logarithmic;  /* 1: over two decades and more */
} nt_host_slider;
/* Every field that has a slider somewhere: its name and kind; NULL beyond the last one. */
NT_API const char *nt_host_slider_field(int number, nt_host_kind *kind);
/* Those that mean something in this world, with their ends; how many. */
NT_API int nt_host_sliders(const nt_scene *scene, const nt_rig *rig, const nt_settings *settings,
                           nt_host_slider rows[NT_HOST_SLIDERS]);
/* The value at a place 0 .. 1, rounded to three digits. */
NT_API double nt_host_slider_at(const nt_host_slider *slider, double place);
/* And back: where a value lies, 0 .. 1. */
NT_API double nt_host_slider_place(const nt_host_slider *slider, double value);
/* What holds of a session, for a line about its state. */
typedef struct nt_host_bounds {
    double bound;  /* of the plan [-] */
    double margin; /* infinite: no loop closes [-] */
    double force;  /* on the sample, never above [N] */
    double hand;   /* at the hand, never above; 0: nothing pushes it [N] */
} nt_host_bounds;
/* What touches, how accurate that is, how far from the limit, what is promised: in a line. Returns text. */
NT_API const char *nt_host_facts(const nt_frame *frame, const nt_host_bounds *bounds, char *text, size_t size);
/* A value in words, with its unit, as it is shown: "40 %", "8.00 N/m". Returns text. */
NT_API const char *nt_host_quantity(const nt_field *field, double value, char *text, size_t size);

/* A task, or a page of the lesson, as a menu shows it. */
typedef struct nt_host_task {
    const char *name, *title;
    const char *preset;    /* the sample that it is meant for */
    const char *asked;     /* unit of the number that the person types at its end; "": none */
    const char *follows;   /* the task that comes after it; "": none */
    nt_host_pushed pushed; /* what its sample must have */
    int is_page;           /* 1: of the lesson */
} nt_host_task;
/* By its number from 0 on; NULL beyond the last one. */
NT_API const nt_host_task *nt_host_tasks(int number);

/* --- the hand: a point that the tip follows through a spring --- */

/* What a hand needs to know of a session. */
typedef struct nt_proxy_facts {
    double alpha_p, alpha_f;    /* scales [m/m], [N/N] */
    double coupling, lever;     /* springs between hand and tip, the first one at the hand [N/m] */
    double travel, resolution;  /* of the master [m] */
    int axes;                   /* of the master */
    double clearance, pull_off; /* [m], [N] */
    double load, limit;         /* the max planned load, the force limit [N] */
    double indentation, sunk;   /* at that load; at NT_PROXY_LOAD of the limit, NaN of a sample that relaxes [m] */
    double start_height, held;  /* of tip and master at the start [m] */
    double x, y, width, height; /* where it starts, on a surface of this size; width 0: none [m] */
} nt_proxy_facts;
/* At most so much of the force limit is pressed with [-]. */
#define NT_PROXY_LOAD 0.8
typedef struct nt_proxy {
    nt_proxy_facts facts;
    double low[NT_AXES], high[NT_AXES]; /* of place [m] */
    double place[NT_AXES];              /* in the master's own lengths [m] */
    double height, zero;                /* of the proxy in the tip's frame, now and where the master reads 0 [m] */
    double stiffness;                   /* between proxy and tip [N/m] */
    double step;                        /* of the wheel [m] */
    double limit, press, reach;         /* [N], [N], of the proxy below the surface [m] */
    double aimed_at;                    /* time of the last move [s] */
    int presses;                        /* 1: it presses with a steady force */
    int aims;                           /* 1: place is another one than the session knows; the caller clears it */
} nt_proxy;
/* How long the master takes to a new place [s]. */
#define NT_PROXY_GLIDE 0.03

/* --- the host --- */

typedef struct nt_session_host nt_session_host;
/* Bytes of a host, which its caller keeps; 8-byte aligned. */
NT_API size_t nt_host_size(void);
/* A host without a session, in this memory. */
NT_API nt_session_host *nt_host_init(void *memory);

/* What is touched. */
typedef struct nt_host_subject {
    const char *name, *title, *hint; /* name: of a preset, or "" */
    const char *source;              /* where it runs, in words: "simulated in this page" */
    const char *said;                /* what is said of its files, in a sentence; "": nothing */
    double width, height;            /* of the surface [m] */
    nt_host_pushed pushed;
} nt_host_subject;
/* Another sample: history, dents and task end. The texts are copied. */
NT_API void nt_host_lay(nt_session_host *host, const nt_host_subject *subject);
/* The session as it is now: the first one of a sample, or one that was opened anew because of nt_host_reopens. NT_OK,
 * or why its law cannot be drawn. Borrowed until the next call, or nt_host_close. */
NT_API nt_status nt_host_open(nt_session_host *host, nt_session *session);
/* The session is gone. */
NT_API void nt_host_close(nt_session_host *host);

/* What a session is composed for. */
typedef struct nt_host_ground {
    double width, height, relief; /* of the surface [m] */
    double clearance;             /* of the sample as it was laid; 0: chosen [m] */
    int keeps;                    /* 1: with the settings that the person has changed */
} nt_host_ground;
/* Fills in settings, master, mode, start and clearance of a setup that has its scene, rig and demand. As nt_plan_make;
 * NT_E_RANGE for a relief above 1 mm. */
NT_API nt_status nt_host_compose(nt_session_host *host, nt_session_setup *setup, const nt_host_ground *ground,
                                 nt_problem *problem);

/* Frames that have come since, each once. */
NT_API void nt_host_see(nt_session_host *host, const nt_frame *frames, long count);
/* What a sample keeps now (nt_session_dents, or the session's events). */
NT_API void nt_host_see_dents(nt_session_host *host, const nt_dent *dents, int count);
/* The hand goes on by itself for a time [s]; some hundred times a second. */
NT_API void nt_host_follow(nt_session_host *host, double elapsed);

/* What is asked, and its argument: docs/host.md. */
typedef struct nt_host_asked {
    const char *what; /* "wheel" */
    const char *text; /* a field, or the name of a task; "": none */
    double value[3];  /* [by what] */
} nt_host_asked;
/* Does it. NT_E_UNSUPPORTED: the host does not know it, and the caller may. What is refused is told in words. */
NT_API nt_status nt_host_ask(nt_session_host *host, const nt_host_asked *asked);
/* The preset that a task waits for; NULL: none. The task begins once that is laid and its session open. */
NT_API const char *nt_host_wants(const nt_session_host *host);
/* Of one field. */
typedef struct nt_host_change {
    nt_host_kind kind;
    const char *field;
    double before, after; /* [unit of the field] */
} nt_host_change;
/* A change that another session is needed for: it is opened by the caller, with this field changed, and given by
 * nt_host_open; or the change is refused. NULL: none. */
NT_API const nt_host_change *nt_host_reopens(const nt_session_host *host);
/* Why that, or anything, could not be done: told as what is refused. */
NT_API void nt_host_refuse(nt_session_host *host, const char *why);
/* What a caller looks at between messages. */
typedef struct nt_host_state {
    const nt_proxy *hand;
    const nt_frame *frame; /* the newest; NULL: none was seen yet */
    int acts;              /* 1: the hand moves by itself now */
    int undo;              /* what can be taken back: so many changes, or else dents, or else pushes */
    const char *task;      /* that runs; "": none */
    int is_done;           /* 1: and has ended */
    nt_host_bounds bounds;
    double energies[4]; /* of the last touch: work of the hand = what the spring has stored + what the law
                           has taken + heat [J] */
} nt_host_state;
/* Of this moment. */
NT_API nt_host_state nt_host_state_of(const nt_session_host *host);

/* The next message in JSON; its length, 0: there is none. `size` NT_HOST_MESSAGE holds every one. */
NT_API long nt_host_tell(nt_session_host *host, char *text, size_t size);
/* What a task has measured, as lines of a CSV file: its next part from *at on, which begins at 0; 0: the end. */
NT_API long nt_host_result(const nt_session_host *host, long *at, char *text, size_t size);

/* Lets time pass [s] in a session that does not run by itself: steps it, and calls nt_host_see and nt_host_follow. */
typedef struct nt_host_clock {
    nt_status (*advance)(void *context, double duration);
    void *context;
} nt_host_clock;
/* The ideal operator of the task that runs solves it, as a person would: by wheel, moves and choices, from what is
 * seen. NT_E_NO_SOLUTION after ten minutes of the session. */
NT_API nt_status nt_host_solve(nt_session_host *host, const nt_host_clock *clock);

#ifdef __cplusplus
}
#endif
#endif
