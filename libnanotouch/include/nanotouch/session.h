/* SPDX-License-Identifier: BSD-3-Clause
 * A whole touch: scene, plan, two halves of a rig, touch step and ring, composed once, for C and for Python. By default
 * both halves are simulated: it runs as fast as the machine allows and gives the same record for the same seed. A half
 * of one's own takes the place of either (hal_backend.h). */
#ifndef NANOTOUCH_SESSION_H
#define NANOTOUCH_SESSION_H

#include "nanotouch/advanced/control.h"
#include "nanotouch/advanced/sim.h"
#include "nanotouch/advanced/terrain.h"
#include "nanotouch/frames.h"
#include "nanotouch/margins.h"
#include "nanotouch/plan.h"
#include "nanotouch/touch.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct nt_session nt_session;

/* What a session is made of; everything is copied but surface, radii and properties, which are borrowed until
 * nt_session_close, and the backends' contexts. */
typedef struct nt_session_setup {
    nt_scene scene; /* its tip is the one that touches */
    nt_rig rig;
    nt_demand demand;
    nt_settings settings;
    nt_mode mode;
    nt_height_map map;               /* heights, read by nt_session_open only; map.heights NULL: none */
    int dilated;                     /* of the map; 0: heights of the body, 1: of the apex of this tip at first touch */
    const nt_surface *surface;       /* dilated by this tip; NULL: flat at z = 0, or the map */
    const nt_radius_map *radii;      /* of `surface`; NULL: its curvature is not felt */
    const nt_properties *properties; /* on the grid of `surface` or `map`; NULL: the scene's everywhere */
    double x, y;                     /* where it starts [m] */
    const double *path; /* path_count points [m] that a master of one axis keeps around; NULL: it may go anywhere */
    long path_count;
    double clearance; /* L, height of the tip above the surface at the start; more than drifts in the preflight [m] */
    double rise; /* how far the master shall be able to draw back from a rising surface [m]; NaN: what is reached */
    uint64_t seed;
    long ring_capacity;    /* records held between two reads, rounded up to a power of two; 0: nothing is recorded */
    double minimum_margin; /* refuse to open below this stability margin; 0: never, and a law of one's own is not tried
                              [-] */
    int preflight;         /* 1: a real stage goes to the start, tare, sign test (nt_preflight); 0: it jumps there */
    nt_probe_model probe_model;
    double substep;                /* of the dynamic cantilever, 0: 0.25 [rad] */
    const nt_particles *particles; /* that can be laid on a flat at z = 0, and are pushed by this tip; simulated, with a
                                      quasi-static cantilever; copied, NULL: none */
    const nt_rod *rod;             /* the same of a rod, instead of particles; its lever is the rig's; NULL: none */
    const nt_faults *faults;       /* of the simulated halves from their switching on, before preflight; NULL: none */
    nt_hal_choice master;          /* backend NULL: simulated */
    nt_hal_choice slave;
    const char *master_option, *slave_option;     /* for the backends' configure; NULL: "" */
    void (*say)(void *context, const char *text); /* takes the lines of backends for the user; NULL: nobody does */
    void *say_context;
} nt_session_setup;

/* The paper's scene and rig, touch mode on a flat, 0.1 um above it, 65 536 records, margin 1.5, with preflight. The
 * force limit is the scene's largest load. For another scene or rig: nt_settings_defaults, nt_settings_keep_to. */
NT_API nt_session_setup nt_session_defaults(void);

/* What the operator does next: a simulated hand and the tip go there on a straight line, then stay. */
typedef struct nt_input {
    double operator_force[NT_AXES];  /* f_m of a hand that pushes [N] */
    double master_position[NT_AXES]; /* of a hand that holds the master where it will [m] */
    int holds;                       /* 1: the hand holds by position, 0: it pushes */
    double x, y;     /* where the path goes [m]; NaN: the tip stays where it is sent, or follows a master of 3 axes */
    double duration; /* [s], >= 0 */
} nt_input;

/* One tick as it is recorded: what was measured, what was commanded, and what was true (NaN where nobody knows). */
typedef struct nt_record {
    uint64_t tick;
    double time;                     /* [s] */
    double master_position[NT_AXES]; /* x_m measured [m] */
    double operator_force[NT_AXES];  /* f_m measured, tared [N] */
    double stage_position[NT_AXES];  /* measured: x and y of the tip, and x_s; x and y of a stage of one axis are those
                                        of the start [m] */
    double stage_command[NT_AXES];   /* [m] */
    double deflection[NT_AXES];      /* measured, tared [m] */
    double amplitude;                /* measured, of a lever that taps; else NaN [m] */
    double lag;                      /* the same, of its deflection behind the drive [rad] */
    double slave_force;              /* f_s = k_c zeta [N] */
    double motor_force[NT_AXES];     /* tau_m commanded [N] */
    double gap;                      /* truth: h [m] */
    double tip_force[NT_AXES];       /* truth: F in the world frame, z away from the sample [N] */
    double contact_radius;           /* truth: a [m] */
    double surface_height;           /* truth: z_s under the tip, dilated [m] */
    double age;                      /* of the slave's measurement [s] */
    double master_age;               /* of the master's [s] */
    double lateness;                 /* of the tick [s] */
    uint32_t flags;                  /* NT_SAMPLE_* */
    uint32_t phase;                  /* nt_phase, of an approach or a curve */
    uint32_t state;                  /* nt_state */
    uint32_t reasons;                /* NT_REASON_* */
} nt_record;

/* What was asked of a session and done, with the tick from which it holds: with the records it is all that a replay
 * needs. */
typedef enum nt_event_kind {
    NT_EVENT_STOP = NT_REQUEST_STOP, /* value[0]: 1 pressed, 0 released; it shows in the records' flags */
    NT_EVENT_AIM,                    /* x, y [m], duration [s]; of field 1: x, y, x_m where a hand holds, duration */
    NT_EVENT_ARM,                    /* confirmed */
    NT_EVENT_MODE,                   /* nt_mode */
    NT_EVENT_RESCALE,                /* alpha_p, alpha_f */
    NT_EVENT_CLUTCH,                 /* open */
    NT_EVENT_SETTING,                /* field: of nt_settings_fields; its value */
    NT_EVENT_SCENE,                  /* field: of nt_scene_fields; its value */
    NT_EVENT_REWIND,                 /* the tick that it goes back to; how many of the session's events had been kept
                                        there: only they hold then. -1: it has gone on from another session's snapshot */
    NT_EVENT_INDEX,   /* nobody asks for it: where a hand that is not simulated was when ticks went on after
                         opening, a start or a pause; the stage did not follow it there. x_m [m] */
    NT_EVENT_DENT,    /* nobody asks for it: what a contact that has ended left in a sample that keeps dents, as two
                         events. Field 0: x, y of its start, x, y of its end [m]; field 1: radius, depth [m], load [N], the
                         number of the dent that it has grown from or -1; of the last one: it takes its place */
    NT_EVENT_UNDENT,  /* the last dent is taken back; no value */
    NT_EVENT_LAY,     /* a particle is laid at rest; field: its number; x, y [m] */
    NT_EVENT_LAY_ROD, /* the rod is laid at rest; x, y [m], angle [rad] */
    NT_EVENT_PUSHED,  /* nobody asks for it: the tip has let go, and a particle lies elsewhere; field: its number; x, y
                         before, x, y now [m] */
    NT_EVENT_TURNED,  /* follows that of a rod: its angle before and now [rad] */
    NT_EVENT_KINDS
} nt_event_kind;
typedef struct nt_event {
    uint64_t tick;
    uint32_t kind; /* nt_event_kind */
    uint32_t field;
    double value[4]; /* [SI, by kind] */
} nt_event;

/* Opens a session, its halves armed. On failure *problem names what is wrong: a field of the setup, nt_verdict.field if
 * the loop would run closer to its stability limit than minimum_margin, what preflight has found, or what a backend
 * says. NT_E_NOT_FINITE if the margin of a law of one's own is not known. The session belongs to the caller:
 * nt_session_close. */
NT_API nt_status nt_session_open(nt_session **session, const nt_session_setup *setup, nt_problem *problem);
/* Ends a run, disarms and closes both halves. Accepts NULL. */
NT_API void nt_session_close(nt_session *session);

/* --- in --- */

/* Mailbox: the newest input counts from the next tick on. From one thread at a time, which may be another than that
 * which runs. NT_E_NOT_FINITE, NT_E_RANGE with the field in *problem (NULL allowed); NT_E_UNSUPPORTED for a force or a
 * position where the hand is real; NT_E_CAPACITY where records are kept and 4096 events wait to be read. */
NT_API NT_REALTIME nt_status nt_session_aim(nt_session *session, const nt_input *input, nt_problem *problem);
/* Presses or releases the emergency stop. Any thread may call it, a signal handler too, while another advances; it
 * never waits. Each press shows in the next sample, even if the release comes before it. */
NT_API NT_REALTIME void nt_session_emergency_stop(nt_session *session, int pressed);

/* Requests. Each is prepared by the calling thread, applied between two ticks and kept as an event. While the session
 * runs in its thread (nt_session_start) the call returns when that has happened; else it is done at once. */

/* Back to RUN after a stop (nt_touch_arm). */
NT_API nt_status nt_session_arm(nt_session *session, int confirmed);
/* NT_E_RANGE with the rule and the margin in *problem (NULL allowed) where the loop would run closer to its limit than
 * minimum_margin. */
NT_API nt_status nt_session_set_mode(nt_session *session, nt_mode mode, nt_problem *problem);
/* The scales [m/m], [N/N] that the operator wants; reached without a bump. Refused as nt_session_set_mode. */
NT_API nt_status nt_session_rescale(nt_session *session, const nt_scaling *scaling, nt_problem *problem);
/* Lets go of the stage (1), to move the master alone, or couples both again from where they stand (0). */
NT_API nt_status nt_session_clutch(nt_session *session, int open);
/* Changes one field of nt_settings_fields (NT_EVENT_SETTING) or nt_scene_fields (NT_EVENT_SCENE), by its name. Plan,
 * bank, margins and guarantee are made anew outside the loop, which runs on meanwhile, and take the place of the old
 * ones at once. NT_E_ARGUMENT for a name that there is not, or that cannot change while open ("gains.rate",
 * "gains.delay", "gains.alpha_p", "gains.alpha_f": rescale; "tip.radius", "tip.half_angle" over a surface; what a
 * surface with properties gives at each place); else as nt_session_open. The cantilever's model stays. */
NT_API nt_status nt_session_change(nt_session *session, nt_event_kind kind, const char *field, double value,
                                   nt_problem *problem);
/* Takes the last dent of a sample that keeps them back, while the tip touches nothing. NT_E_STATE where there is none,
 * or the tip touches; NT_E_UNSUPPORTED where no such sample is simulated. */
NT_API nt_status nt_session_undent(nt_session *session);
/* Lays particle `number`, 0 .. how many lie there, at rest at (x, y) [m]; one that lies there already is taken away
 * from where it was. NT_E_UNSUPPORTED: the setup has no particles; NT_E_CAPACITY: more than NT_PARTICLES, or one left
 * out; NT_E_STATE: the tip or another one touches it, here or there; NT_E_NOT_FINITE. */
NT_API nt_status nt_session_lay(nt_session *session, int number, const double place[2]);
/* Lays the rod at rest at x, y [m] and an angle of its axis from x [rad]; it is taken away from where it was. Fails as
 * nt_session_lay: NT_E_UNSUPPORTED where the setup has no rod; NT_E_STATE where the tip touches it, here or there. */
NT_API nt_status nt_session_lay_rod(nt_session *session, const double pose[3]);
/* Adds a fault of the simulated halves; its start counts from the session's first tick (advanced/sim.h).
 * NT_E_UNSUPPORTED where none is simulated, NT_E_STATE while the session runs in its thread. */
NT_API nt_status nt_session_inject(nt_session *session, const nt_fault *fault);

/* --- run, as fast as it goes --- */

/* Runs `ticks` periods. A device that fails (NT_E_DEVICE) is no error of this function: the state is LATCHED with
 * NT_REASON_DEVICE in the same tick. NT_E_CAPACITY, with nothing run, if the ring could not hold them: nothing is ever
 * dropped. NT_E_STATE while the session runs in its thread; NT_E_UNSUPPORTED with a half that is real. */
NT_API NT_REALTIME nt_status nt_session_advance(nt_session *session, long ticks);
/* Aims (input may be NULL) and runs one period; the frame of that tick. */
NT_API NT_REALTIME nt_status nt_session_step(nt_session *session, const nt_input *input, nt_frame *frame);

/* --- run, in a thread of its own (Linux, macOS, Windows; NT_E_UNSUPPORTED elsewhere) --- */

typedef enum nt_pace {
    NT_PACE_FREE, /* as fast as it goes; where the ring is full it waits for a reader */
    NT_PACE_WALL, /* at the pace of a clock: wakes each millisecond, or as often as a real master needs, and runs the
                     ticks that are due. It slows down where it cannot keep up, and never skips; for a slave that is
                     simulated */
    NT_PACE_HARD  /* each tick at its deadline; lateness reaches the supervisor; a full ring is counted */
} nt_pace;
/* The pace that its devices ask for: hard where a real slave can hurt a sample; wall where a real master alone is
 * driven; else free. */
NT_API nt_pace nt_session_pace(const nt_session *session);

/* At wall pace a motor force waits for the next wake-up, and for the machine to be in time with it. */
typedef struct nt_wall_pace {
    double hold;       /* between two wake-ups [s] */
    double latency;    /* of nine wake-ups in ten no more, as measured when it was last started; 0 before that [s] */
    nt_verdict margin; /* of the loop with both, as then judged; infinite before that */
} nt_wall_pace;
/* Of one with a real master on a simulated slave; all 0 of others, and the margin infinite. */
NT_API nt_wall_pace nt_session_wall_pace(const nt_session *session);

/* What a run has been so far. */
typedef struct nt_progress {
    uint64_t ticks;     /* run in all */
    uint64_t dropped;   /* records that a full ring has lost; hard pace only */
    double slowdown;    /* wall pace: time on the clock over time in the session, lately; 1 where it keeps up [-] */
    double worst_delay; /* wall and hard pace: of a wake-up [s] */
    int runs;           /* 1: in its thread */
    int paused;         /* 1: asked for */
    int stands;         /* 1: paused, no tick runs any more, and no granted step is left */
    nt_status status;   /* why it has ended by itself, NT_OK otherwise */
} nt_progress;

/* Starts the thread; `ticks` 0: until nt_session_halt. NT_E_STATE if it runs already; NT_E_UNSUPPORTED for a real half
 * in a pace that it does not allow, or a Python one in hard pace; NT_E_RANGE for a real master at wall pace whose
 * margin is too small (nt_session_wall_pace); NT_E_NO_MEMORY; NT_E_CAPACITY as nt_session_aim. */
NT_API nt_status nt_session_start(nt_session *session, nt_pace pace, uint64_t ticks);
/* Ends the thread between two ticks and waits for it. What it ended by itself with, NT_OK otherwise. */
NT_API nt_status nt_session_halt(nt_session *session);
/* Free and wall pace; from any thread. Speed: session time over time on the clock, 1e-3 .. 1e3; below 1 is slow motion.
 */
NT_API nt_status nt_session_pause(nt_session *session, int paused);
/* Of a paused one: so many more ticks, at full speed; up to 1e9 may wait. A pause, or its end, takes back what waits.
 */
NT_API nt_status nt_session_step_on(nt_session *session, long ticks);
/* Seconds of the session in one of the clock, 1e-3 .. 1e3, while it runs; NT_E_RANGE outside, and for one that a half
 * leads. */
NT_API nt_status nt_session_set_speed(nt_session *session, double speed, nt_problem *problem);
/* Of a session whose halves are simulated, while it runs: back by a duration [s], to the nearest quarter of a second
 * before that, half a minute at most. NT_E_NO_SOLUTION if that is too long ago or before a change; NT_E_UNSUPPORTED
 * with a half that is not simulated. Kept as NT_EVENT_REWIND. */
NT_API nt_status nt_session_rewind(nt_session *session, double duration, nt_problem *problem);
/* What the run has been so far; from any thread. */
NT_API nt_progress nt_session_progress(const nt_session *session);

/* --- out --- */

/* Moves up to `count` records, or events, out of their ring; returns how many. One reader each. */
NT_API NT_REALTIME long nt_session_read(nt_session *session, nt_record *records, long count);
/* The same of events: what was asked of the session, in the order of its ticks. */
NT_API NT_REALTIME long nt_session_read_events(nt_session *session, nt_event *events, long count);
/* From now on each tick is published as a frame, in shared memory under this name or, with NULL, in private memory.
 * Clients of these frames may post requests: the kinds of nt_event_kind. As nt_frames_create; not while it runs. */
NT_API nt_status nt_session_publish(nt_session *session, const char *name);
/* The frames that it publishes; NULL before nt_session_publish. */
NT_API nt_frames *nt_session_frames(nt_session *session); /* NULL: none */

/* --- state of a session whose halves are simulated --- */

typedef struct nt_snapshot nt_snapshot;
/* All that a session will need to go on from here: NT_E_UNSUPPORTED with a half that is not simulated, NT_E_STATE while
 * it runs, NT_E_NO_MEMORY. The snapshot belongs to the caller: nt_snapshot_close. */
NT_API nt_status nt_session_snapshot(const nt_session *session, nt_snapshot **snapshot);
/* Back to where it was taken, mode and scales with it, of this session or of one that was opened with the same setup: a
 * copy. NT_E_STATE while it runs, and where the setups differ; what was changed since must be changed back first. What
 * differs is in *problem (NULL allowed): of the snapshot, and as it is here. Kept as NT_EVENT_REWIND. */
NT_API nt_status nt_session_restore(nt_session *session, const nt_snapshot *snapshot, nt_problem *problem);
/* Accepts NULL. */
NT_API void nt_snapshot_close(nt_snapshot *snapshot);

/* What a simulated sample keeps of its touches (scene: sample.dents), the oldest first; NULL where none is simulated.
 * Valid until the next tick. */
NT_API const nt_dents *nt_session_dents(const nt_session *session);
/* Particles after the newest tick that has been run; a rod is one, with a length. */
typedef struct nt_session_particles {
    int count;
    double radius; /* R of each [m] */
    double length; /* L of a rod; 0 of spheres [m] */
    uint64_t tick;
    double position[NT_PARTICLES][NT_AXES]; /* of the centre [m] */
    double angle[NT_PARTICLES];             /* of a rod's axis from x; 0 of spheres [rad] */
    double force[NT_PARTICLES][NT_AXES];    /* on the tip [N] */
    uint32_t touches[NT_PARTICLES];         /* how often the tip has touched it ... */
    uint32_t losses[NT_PARTICLES];          /* ... and lost it */
    double stored, dissipated;              /* in their contacts; heat so far [J] */
} nt_session_particles;
/* From the thread that makes requests, also while the session runs. NT_E_UNSUPPORTED: the setup has none. */
NT_API nt_status nt_session_read_particles(nt_session *session, nt_session_particles *particles);
/* Is the cantilever computed as dynamic (1) or quasi-static (0)? 0 where the slave is not simulated. */
NT_API int nt_session_is_dynamic(const nt_session *session);
/* What a half can do. */
NT_API const nt_capabilities *nt_session_capabilities(const nt_session *session, nt_half half);

/* Read-only views: valid until the next change or close, from the thread that makes requests. */
NT_API const nt_session_setup *nt_session_setup_of(const nt_session *session); /* as it runs now */
/* The plan of the forces that it computes. */
NT_API const nt_plan *nt_session_plan(const nt_session *session);
/* The touch step: law, observer, supervisor and limits as they run. */
NT_API const nt_touch *nt_session_touch(const nt_session *session);
/* The margins in this mode and at these scales; 1 is the limit. */
NT_API nt_margins nt_session_margins(const nt_session *session);
/* Those in x and y, and of all axes together; infinite where no motor pushes back sideways. */
NT_API nt_sideways_margins nt_session_sideways(const nt_session *session);
/* That of a lever which taps, by the slow flow at the set point over a flat; infinite in other modes. */
NT_API nt_verdict nt_session_tap(const nt_session *session);
/* What of the surface the tip can be led over: where the stage stands, around a declared path, or all of it. */
NT_API nt_reach nt_session_reach(const nt_session *session);
/* What holds whatever the operator does; to be read before the first tick. */
NT_API nt_guarantee nt_session_guarantee(const nt_session *session);
/* The same of the hand; at wall pace a force is held longer (nt_session_wall_pace), and that counts. */
NT_API nt_motor_bound nt_session_motor_bound(const nt_session *session);
/* What preflight has taken off the sensors. */
NT_API nt_tare nt_session_tare(const nt_session *session);

#ifdef __cplusplus
}
#endif
#endif
