/* SPDX-License-Identifier: BSD-3-Clause
 * Private to session/: what a session holds, and who may touch it. */
#ifndef NANOTOUCH_SESSION_STATE_H
#define NANOTOUCH_SESSION_STATE_H

#include <stdatomic.h>

#include "core/ring.h"
#include "hal/clock.h"
#include "internal/margins.h"
#include "nanotouch/session.h"
#include "session/origin.h"

/* All that does not change between two ticks. A change makes another one, outside the loop, and swaps the pointer. */
typedef struct nt_composition {
    nt_session_setup setup; /* its pointers are not used after open, but surface and radii */
    nt_touch touch;
    nt_terrain *terrain; /* shared with the composition before where only settings differ */
    nt_terrain *ground;  /* the first one, which owns the surface of all that follow */
    nt_reach reach;
    nt_sideways_contact grip;
    nt_pushed pushed; /* what may lie there */
    nt_margins margins;
    nt_sideways_margins sideways;
    nt_verdict tap; /* infinite outside mode tapping */
    nt_guarantee guarantee;
} nt_composition;

/* Field of a client's NT_EVENT_AIM that holds the master of a simulated hand; the records hold what it did, so no event
 * is kept. */
enum { NT_AIM_HAND = 1 };

/* A request on its way into the loop; `next` is the composition that goes with it, or NULL. */
typedef struct nt_call {
    uint64_t id; /* of a client's request; 0: of a caller that waits */
    nt_event event;
    nt_composition *next;
    nt_status refused; /* a client's request that could not be prepared */
} nt_call;

typedef struct nt_runner nt_runner; /* pace.c */

struct nt_session {
    /* the loop's; of whoever advances */
    nt_composition *now;
    nt_touch_state touch_state;
    nt_tare tare;
    nt_hal master, slave;
    int64_t time;           /* of this tick on the halves' clock [ns] */
    int64_t (*clock)(void); /* hard pace: of the machine; else NULL, and ticks times period count */
    double lateness;        /* of this tick, hard pace [s] */
    nt_hal *leader;         /* the half that leads the clock; NULL: none does */
    int waits;              /* it is waited for: on a clock of the machine its host's time goes on meanwhile */
    int comes_back;         /* the next tick is the first one after a pause */
    uint64_t flights;       /* ticks of the preflight */
    int may_drop;           /* hard pace: a full ring is counted, the loop goes on */
    nt_sim sim;             /* halves that are simulated */
    int simulates[2];       /* by nt_half */
    nt_host host;
    double master_start, master_travel; /* [m] */
    double master_axes;                 /* these three: for inputs of any thread */
    double borders[2][2];               /* of where the tip can be led, x and y [m] */
    int keeps_to_path;                  /* 1: they lie around a declared path */
    int64_t deadline;                   /* of this tick, where a half has a clock of its own [ns] */
    nt_frames *frames;
    nt_frame *stepped; /* nt_session_step wants this tick's; else NULL */
    /* between threads */
    atomic_uint stop; /* emergency stop: STOP_HELD, STOP_UNSEEN (run.c) */
    atomic_ullong dropped;
    nt_mailbox mailbox;
    nt_input mailbox_memory[3];
    nt_mailbox shown; /* particles, for who asks */
    nt_session_particles shown_memory[3];
    nt_session_particles newest; /* of who asks */
    nt_ring ring, events, calls, clients;
    nt_record *records; /* NULL: nothing is recorded */
    nt_record unkept;   /* the last one that had no place in the ring */
    nt_event *event_memory;
    nt_call *call_memory;
    nt_request *client_memory;
    _Atomic(nt_composition *) retired; /* out of the loop's hands, to be freed by who made the next */
    atomic_flag asking;                /* one thread prepares and asks at a time ... */
    atomic_uintptr_t asker, ticker;    /* ... this one; and the one that runs ticks; 0: none (nt_session_thread) */
    atomic_int call_status;            /* of the caller that waits: CALL_WAITING until it has been done */
    nt_runner *runner;                 /* NULL: no thread */
    nt_wall_pace wall;                 /* with a real master, once it was started */
    struct nt_history *history;        /* NULL: none is kept */
    nt_origin origin;
    uint64_t kept_events; /* since it was opened */
    int64_t opened;       /* with its address: which session it is [ns] */
};

enum { NT_CALL_WAITING = -1, NT_SESSION_EVENTS = 4096, NT_SESSION_CALLS = 64 };

/* --- setup.c --- */

/* All of it that can be judged before anything is made. */
nt_status nt_session_check_setup(const nt_session_setup *setup, nt_problem *problem);

/* Does this fault happen in a half that is simulated? */
int nt_session_has_fault(const nt_fault *fault, int simulates_master, int simulates_slave);

/* --- terrain.c --- */

/* One more who closes it; returns it. */
nt_terrain *nt_terrain_hold(nt_terrain *terrain);

/* --- composition.c --- */

/* Terrain, plan, touch step, margins, guarantee. before: of the session so far, whose terrain serves where only
 * settings differ; or NULL. */
/* halves.c: of a real slave the bound of the force has to be known, whatever was demanded. */
nt_status nt_session_check_bound(const nt_session *session, const nt_composition *composition, nt_problem *problem);
nt_status nt_compose(nt_composition **made, const nt_session_setup *setup, const nt_composition *before,
                     nt_problem *problem);
/* As before, in another mode and at other scales: what is judged and promised is that of the loop that runs then. */
nt_status nt_compose_standing(nt_composition **made, const nt_composition *before, nt_mode mode,
                              const nt_scaling *scaling, nt_problem *problem);
/* Frees it, and those of its terrains that the other does not use. */
void nt_composition_close(nt_composition *composition, const nt_composition *other);
/* Is this margin enough? A minimum of 0 asks for none. */
int nt_composition_allows(const nt_composition *composition, double margin);
/* Of these settings in a mode at the stiffest contact of the plan: margins, sideways and tap. */
nt_verdict nt_composition_judge(nt_composition *composition, const nt_settings *settings, nt_mode mode);

/* --- terrain_reach.c --- */

/* Do all points (x, y) lie on the surface? */
nt_status nt_terrain_check_path(const nt_terrain *terrain, const double *xy, long count, nt_problem *problem);

/* --- tap_loop.c --- */

/* Margin of the height servo on a lever that taps at its set point: nothing but the K_I from which on it rings over the
 * one of the settings. Some milliseconds. */
nt_verdict nt_session_judge_tap(const nt_rig *rig, const nt_settings *settings, const nt_plan *plan);

/* --- pushing.c --- */

/* What may lie there, of the setup or of the session so far; may this session have it? */
nt_status nt_composition_take_pushed(nt_composition *made, const nt_composition *before, nt_problem *problem);
int nt_composition_pushes(const nt_composition *composition);
/* What is stiffest of sample and of what lies there [N/m]. */
double nt_composition_stiffness(const nt_composition *composition);
/* The steepest slope, that of what lies there too [-]. */
double nt_composition_slope(const nt_composition *composition);
/* What they add to what the sample may do. */
void nt_composition_add_pushed(const nt_composition *composition, nt_hazard *hazard);
/* What they resist a push sideways with, under a load [N]; 0 where there are none. */
double nt_composition_resistance(const nt_composition *composition, double load);
void nt_session_show_particles(nt_session *session);
/* Those that the tip has left elsewhere in this period. */
nt_status nt_session_keep_pushed(nt_session *session);

/* --- halves.c --- */

/* Drive and lock-in amplifier of a simulated slave, as the settings say. */
nt_sim_lock_in nt_session_lock_in(const nt_tap *tap);
/* Opens, configures and arms both halves. */
nt_status nt_session_open_halves(nt_session *session, nt_problem *problem);
/* The shortest one of a half that measures by a clock of its own; infinite where there is none [s]. What is simulated
 * measures in session time. */
double nt_session_own_period(const nt_session *session);
/* Tare and sign test, on the rig's own time. */
nt_status nt_session_fly(nt_session *session, nt_problem *problem);
/* Of mode tapping: switches the drive on and compares the free amplitude with the settings. */
nt_status nt_session_find_amplitude(nt_session *session, nt_problem *problem);

/* --- run.c --- */

/* Around ticks: they are this thread's. What a half then asks of its own session is refused. */
void nt_session_enter(nt_session *session);
void nt_session_leave(nt_session *session);
/* One period. */
nt_status nt_session_tick(nt_session *session);
/* Reads both halves as one sample, at the time of this tick. */
nt_status nt_session_sample(nt_session *session, uint64_t tick, nt_sample *sample);
nt_status nt_session_write(nt_session *session, uint64_t tick, const nt_command *command);

/* --- changes.c, inputs.c: outside the loop --- */

/* Is this request all right? Composes what a change needs, into call->next. */
nt_status nt_session_prepare(const nt_session *session, nt_call *call, nt_problem *problem);
/* May the tip be sent there? */
nt_status nt_session_check_place(const nt_session *session, double x, double y, double duration, nt_problem *problem);

/* --- requests.c --- */

/* Hands a prepared call to the loop and waits for it, or does it where nothing runs; takes call->next. */
nt_status nt_session_ask(nt_session *session, const nt_call *call);
/* The loop: what has been asked since the last tick is done now. */
void nt_session_take_calls(nt_session *session);
nt_status nt_session_keep_event(nt_session *session, const nt_event *event);
int nt_session_events_are_full(const nt_session *session);
/* The loop: hands a client's request on. And the thread that prepares: does it. */
void nt_session_take_clients(nt_session *session);
void nt_session_tap_stop(nt_session *session); /* pressed and let go: LATCHED, until somebody arms */
void nt_session_serve_clients(nt_session *session);

/* --- history.c --- */

typedef struct nt_history nt_history;
/* Memory for it; nothing where a half is not simulated. */
nt_status nt_history_make(nt_session *session);
/* Keeps this moment, if it is one to be kept. */
void nt_history_keep(nt_session *session);
/* Goes back to the newest moment that is not after a tick, when *events events had been kept. NT_E_NO_SOLUTION if none
 * is left. */
nt_status nt_history_back(nt_session *session, uint64_t tick, double *events);

/* --- frame.c --- */

nt_frame nt_session_frame(const nt_session *session, const nt_record *record);

/* --- clock.c --- */

/* With a half that measures by a clock of its own, before it runs: waits for the next period. */
void nt_session_keep_time(nt_session *session);
/* Wall pace: time that a session owes its person, and how much slower than it should it goes. */
typedef struct nt_wall_clock {
    int64_t last;  /* when it was looked at [ns] */
    double lag;    /* the most that it may owe [s] */
    double due;    /* session time that has to be run yet [s] */
    double lost;   /* share of time that could not be run, lately [-] */
    double passed; /* between the last two looks [s] */
    double waited; /* for a reading of the master that is late [s] */
} nt_wall_clock;
double nt_wall_longest_lag(const nt_session *session);
/* More is due; how many times slower than `speed` the session goes. */
double nt_wall_look(nt_wall_clock *clock, double speed);
/* Reads the half that leads the clock. One that says nothing new, or is gone, is waited for no longer than a period. */
nt_status nt_session_follow_leader(nt_session *session);
/* The calling thread; never 0. */
uintptr_t nt_session_thread(void);
/* One thread prepares and asks at a time. */
void nt_session_lock(nt_session *session);
void nt_session_unlock(nt_session *session);

/* --- wall_pace.c --- */

/* May its devices run at this pace? */
nt_status nt_session_check_pace(const nt_session *session, nt_pace pace);
/* Between two wake-ups [ns]. */
int64_t nt_wall_wake(const nt_session *session);
/* How many of these ticks that are due may be run: as many as the master's last reading is fresh for. A late one is
 * waited for, at most for this long [s]: that slows the clock down, and stops nothing. */
#define NT_WALL_PATIENCE 0.01
long nt_wall_ticks(nt_session *session, nt_wall_clock *clock, long due);
/* Before it starts at wall pace: measures how late this machine wakes up, and judges the loop with that. NT_E_RANGE
 * where the margin is too small. Some ten milliseconds. */
nt_status nt_wall_judge(nt_session *session);

/* --- pace.c --- */

/* Waits until the loop's thread has done what was asked; NT_E_STATE when it has ended instead. */
nt_status nt_session_await(nt_session *session);
int nt_session_is_running(const nt_session *session);

#endif
