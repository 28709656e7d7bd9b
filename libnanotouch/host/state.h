/* SPDX-License-Identifier: BSD-3-Clause
 * Private to host/: what a host remembers, and what its parts ask of each other. */
#ifndef NANOTOUCH_HOST_STATE_H
#define NANOTOUCH_HOST_STATE_H

#include "host/task.h"
#include "host/text.h"
#include "nanotouch/host.h"
#include "nanotouch/plan.h"
#include "nanotouch/rheology.h"

enum { NT_HOST_HISTORY = 64, NT_HOST_KEPT = 16, NT_HOST_NAME = 64, NT_HOST_MOVES = 64 };

/* Messages that wait to be told, in the order in which they are. */
enum {
    NT_DUE_REFUSED = 1,
    NT_DUE_NOTE = 2,
    NT_DUE_SLIDERS = 4,
    NT_DUE_WORLD = 8,
    NT_DUE_DENTS = 16,
    NT_DUE_PARTICLES = 32,
    NT_DUE_TASK = 64,
    NT_DUE_EVENT = 128,
    NT_DUE_GUIDE = 256,
    NT_DUE_RECOVERY = 512
};

/* A particle that was pushed: where it lay before. */
typedef struct nt_host_move {
    double time; /* [s] */
    int push;    /* moves of one push have one number */
    int number;
    double pose[3]; /* x, y [m], angle [rad] */
} nt_host_move;

typedef struct nt_host_left {
    nt_dent dents[NT_DENTS];
    int count;
    int began[NT_DENTS]; /* how many dents there were before each touch */
    int touches;
    double touched_at; /* [s] */
    nt_session_particles laid;
    double rested[NT_PARTICLES][3];
    nt_host_move moves[NT_HOST_MOVES];
    int move_count;
} nt_host_left;

/* What has happened to the contact lately. */
typedef struct nt_host_event {
    int touches, waits; /* 1: a snap is told once it is known how hard it pulled */
    double since, told; /* [s] */
    double pull;        /* the deepest of this contact [N] */
    double force;       /* of the event that is told next [N] */
    const char *kind;
} nt_host_event;

/* What a person is told to do next: down, up once it touches, and then what the sample is for. */
typedef struct nt_host_guide {
    int device; /* that the hand is moved with: a row of lines.c */
    int touched, touches, tasked;
} nt_host_guide;

/* Sums of the last touch. */
typedef struct nt_host_energy {
    double hand, tip, heat, began, now; /* [J] */
    double stretch, quiet_since;        /* of the last tick [m], [s] */
    double spent_before, spent;         /* heat of particles until this touch, and in it [J] */
    double place[NT_AXES], force[NT_AXES];
    double shift; /* of the zero since the hand has let go [m] */
    int has_last, is_free, is_stopped;
} nt_host_energy;

/* A surface that relaxes, along the gaps that were seen. */
typedef struct nt_host_recovery {
    nt_viscoelastic_bed bed;
    nt_viscoelastic_state state;
    double x[NT_LOOP_SPRINGS], edge; /* distances of the springs from the axis, and of the outermost edge [m] */
    double time, told, depth;        /* of the newest step [s], [s], [m] */
    int follows, has_last, is_seen;  /* 1: the sample relaxes; time and depth hold; a view draws a dent */
} nt_host_recovery;
enum { NT_RECOVERY_ROWS = 41 };

struct nt_session_host {
    nt_session *session;
    char name[NT_HOST_NAME], title[2 * NT_HOST_NAME], hint[4 * NT_HOST_NAME], source[2 * NT_HOST_NAME],
        said[NT_HOST_LINE];
    double width, height; /* of the surface [m] */
    nt_host_pushed pushed;
    nt_scene meant;      /* as the sample was laid */
    int is_laid;         /* 1: meant holds */
    nt_plan plan, spare; /* over a flat: of the scene as it is, and of what is asked about it */
    nt_proxy hand;
    nt_frame frame; /* the newest */
    int has_frame;
    nt_host_change done[NT_HOST_HISTORY], undone[NT_HOST_HISTORY], kept[NT_HOST_KEPT], reopening;
    int done_count, undone_count, kept_count;
    int reopens;                                   /* 1: a change, 2: undo, 3: redo */
    char wants[NT_HOST_NAME], waits[NT_HOST_NAME]; /* a preset, and the task that begins on it */
    double seed;                                   /* of that task */
    unsigned due;
    char why[NT_HOST_LINE], note[NT_HOST_LINE];
    const char *field; /* that was refused */
    nt_host_slider sliders[NT_HOST_SLIDERS];
    int slider_count;
    nt_host_left left;
    nt_host_energy energy;
    nt_host_bounds bounds;
    nt_host_event event;
    nt_host_guide guide;
    nt_host_recovery recovery;
    nt_trainer trainer;
};

/* sliders.c */
const nt_field *nt_host_fields(nt_host_kind kind, int *count);
const nt_field *nt_host_field(const char *name, nt_host_kind *kind); /* NULL: there is none */
const char *nt_host_slider_title(const char *field);                 /* NULL: it has no slider */

/* host.c */
const void *nt_host_described(const nt_session_host *host, nt_host_kind kind); /* scene, rig or settings as they are */
nt_status nt_host_learn(nt_session_host *host);                                /* anew, after a change */
void nt_host_aim(nt_session_host *host);                                       /* sends where the hand is */
nt_status nt_host_ask_task(nt_session_host *host, const nt_host_asked *asked);
int nt_frame_touches(const nt_frame *frame);

/* changes.c */
nt_status nt_host_set(nt_session_host *host, const char *field, double value); /* no entry of the history */
nt_status nt_host_ask_change(nt_session_host *host, const char *field, double value);
nt_status nt_host_undo(nt_session_host *host);
nt_status nt_host_redo(nt_session_host *host);
int nt_host_undoable(const nt_session_host *host);
void nt_host_settle(nt_session_host *host); /* another session is there: what waited for it is done */

/* refusals.c */
nt_status nt_host_refuse_filled(nt_session_host *host, const char *pattern, const nt_figure *figures);
nt_status nt_host_refuse_change(nt_session_host *host, const char *field, double value, const nt_problem *problem,
                                nt_status status);

/* left.c */
void nt_left_forget(nt_session_host *host);
void nt_left_see(nt_session_host *host, const nt_frame *frame);
void nt_left_look(nt_session_host *host); /* at particles */
nt_status nt_left_undo(nt_session_host *host);
nt_status nt_left_lay(nt_session_host *host, const double (*poses)[3], int count);

/* event.c: what snaps and tears */
void nt_event_see(nt_session_host *host, const nt_frame *frame);
void nt_event_tell(nt_session_host *host, nt_text *json);

/* recovery.c: the surface of a sample that relaxes */
void nt_recovery_learn(nt_session_host *host); /* anew where the kernel has changed */
void nt_recovery_forget(nt_session_host *host);
void nt_recovery_see(nt_session_host *host, const nt_frame *frame);
double nt_recovery_depth(const nt_session_host *host, double r); /* of the surface below the undeformed one [m] */
void nt_recovery_tell(nt_session_host *host, nt_text *json);

/* energy.c: where the work of the hand goes in the last touch */
void nt_energy_begin(nt_session_host *host);
void nt_energy_let_go(nt_session_host *host);
void nt_energy_see(nt_session_host *host, const nt_frame *frame);
void nt_energies(const nt_session_host *host, double found[4]);

/* law.c: what the law of the scene as it is, or with one field changed, says */
const nt_plan *nt_law_with(nt_session_host *host, const char *field, double value); /* NULL: there is none */
double nt_law_depth(const nt_plan *plan, double load);                              /* indentation [m] */
double nt_law_stiffness(const nt_plan *plan, double load);                          /* dF/d(indentation) [N/m] */
double nt_law_slow(const nt_plan *plan);                    /* force of the longest touch over that at once [-] */
double nt_law_resting_radius(const nt_plan *plan);          /* of the contact without load [m] */
double nt_law_jump_gap(const nt_plan *plan, double spring); /* 0: none [m] */

/* lines.c: state in words */
void nt_line_felt(const nt_session_host *host, nt_text *text);
void nt_line_guide(const nt_session_host *host, nt_text *text);
void nt_guide_follow(nt_session_host *host);                      /* told again where it has changed */
nt_status nt_guide_by(nt_session_host *host, const char *device); /* what the hand is moved with */

#endif
