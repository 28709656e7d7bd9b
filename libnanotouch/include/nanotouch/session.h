/* SPDX-License-Identifier: BSD-3-Clause
 * A whole touch: plan, simulated rig, touch step and ring, composed once, for C and for Python. Simulated time: it runs
 * as fast as the machine allows and gives the same record for the same seed. */
#ifndef NANOTOUCH_SESSION_H
#define NANOTOUCH_SESSION_H

#include "nanotouch/control.h"
#include "nanotouch/plan.h"
#include "nanotouch/sim.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct nt_session nt_session;

/* What a session is made of; everything is copied but surface, radii and bank. */
typedef struct nt_session_setup {
    nt_scene scene;
    nt_rig rig;
    nt_demand demand;
    nt_settings settings;
    nt_mode mode;
    const nt_surface *surface;  /* dilated by the tip; borrowed until nt_session_close; NULL: flat at z = 0 */
    const nt_radius_map *radii; /* of that surface, borrowed; NULL: its curvature is not felt */
    const nt_maugis_bank *bank; /* for the contact with the radius of each place, borrowed */
    double x, y;                /* where it starts [m] */
    double clearance;           /* L, height of the tip above the surface there [m] */
    double rise;                /* how far the surface rises above the start along the path [m], >= 0 */
    double slope;               /* of the surface where it is steepest along the path [-], >= 0 */
    uint64_t seed;
    long ring_capacity; /* records held between two reads; rounded up to a power of two */
    double
        minimum_margin; /* refuse to open below this stability margin; 0: never, and a law of one's own is not tried */
    int preflight;      /* 1: tare and sign test before the first tick (preflight.h) */
    nt_probe_model probe_model;
    double substep;          /* of the dynamic cantilever, 0: 0.25 [rad] */
    const nt_faults *faults; /* of the rig from its switching on, before preflight; copied; NULL: none */
} nt_session_setup;

/* The paper's scene and rig, touch mode on a flat, 0.1 um above it, 65 536 records, margin 1.5, with
 * preflight. */
NT_API nt_session_setup nt_session_defaults(void);

/* What the operator does next: hand force and tip position go there on a straight line, then stay. */
typedef struct nt_input {
    double operator_force; /* f_m, + towards the sample [N] */
    double x, y;           /* [m] */
    double duration;       /* [s], >= 0 */
} nt_input;

/* One tick as it is recorded: what was measured, what was commanded, and what was true. */
typedef struct nt_record {
    uint64_t tick;
    double time;            /* [s] */
    double x, y;            /* lateral position [m] */
    double master_position; /* x_m measured [m] */
    double operator_force;  /* f_m measured, tared [N] */
    double stage_position;  /* x_s measured, travel towards the sample [m] */
    double stage_command;   /* [m] */
    double deflection;      /* zeta measured, tared [m] */
    double slave_force;     /* f_s = k_c zeta [N] */
    double motor_force;     /* tau_m commanded [N] */
    double gap;             /* truth: h [m] */
    double tip_force;       /* truth: F [N] */
    double contact_radius;  /* truth: a [m] */
    double surface_height;  /* truth: z_s under the tip, dilated [m] */
    double age;             /* of the sample [s] */
    double lateness;        /* of the tick [s] */
    uint32_t flags;         /* NT_SAMPLE_* */
    uint32_t phase;         /* nt_phase, of an approach or a curve */
    uint32_t state;         /* nt_state */
    uint32_t reasons;       /* NT_REASON_* */
} nt_record;

/* Opens a session. NT_E_RANGE with nt_verdict.field if the loop would run closer to its stability limit than
 * minimum_margin, or with what preflight has found; NT_E_NOT_FINITE if the margin of a law of one's own is not known.
 * The session belongs to the caller: nt_session_close. */
NT_API nt_status nt_session_open(nt_session **session, const nt_session_setup *setup, nt_problem *problem);
/* Accepts NULL. */
NT_API void nt_session_close(nt_session *session);

/* Mailbox: the newest input counts from the next tick on. May be called from another thread than advance. */
NT_API NT_REALTIME nt_status nt_session_aim(nt_session *session, const nt_input *input);
/* Runs `ticks` periods. A device that fails (NT_E_DEVICE) is no error of this function: the state is LATCHED with
 * NT_REASON_DEVICE in the same tick. NT_E_CAPACITY, with nothing run, if the ring could not hold them: nothing is ever
 * dropped. */
NT_API NT_REALTIME nt_status nt_session_advance(nt_session *session, long ticks);
/* Moves up to `count` records out of the ring; returns how many. */
NT_API NT_REALTIME long nt_session_read(nt_session *session, nt_record *records, long count);
/* Back to RUN after a stop (nt_touch_arm). */
NT_API nt_status nt_session_arm(nt_session *session, int confirmed);
/* Requests to the touch step between two ticks (touch.h). A new scale with which the loop would run closer to its limit
 * than minimum_margin is refused with NT_E_RANGE, and so is a mode. */
NT_API nt_status nt_session_set_mode(nt_session *session, nt_mode mode);
NT_API nt_status nt_session_rescale(nt_session *session, const nt_scaling *scaling);
NT_API void nt_session_clutch(nt_session *session, int open);
/* Presses or releases the simulated emergency stop. Any thread may call it, a signal handler too, while another
 * advances; it never waits. Each press shows in the next sample, even if the release comes before it. */
NT_API NT_REALTIME void nt_session_emergency_stop(nt_session *session, int pressed);
/* Adds a fault of the simulated rig; its start counts from the session's first tick (faults.h). */
NT_API nt_status nt_session_inject(nt_session *session, const nt_fault *fault);
/* Is the cantilever computed as dynamic (1) or quasi-static (0)? */
NT_API int nt_session_is_dynamic(const nt_session *session);

/* Read-only views, valid until close. */
NT_API const nt_plan *nt_session_plan(const nt_session *session);
NT_API const nt_touch *nt_session_touch(const nt_session *session);
NT_API const nt_touch_state *nt_session_touch_state(const nt_session *session);
NT_API nt_margins nt_session_margins(const nt_session *session);
/* What holds whatever the operator does; to be read before the first tick. */
NT_API nt_guarantee nt_session_guarantee(const nt_session *session);
/* What preflight has taken off the sensors. */
NT_API nt_tare nt_session_tare(const nt_session *session);
/* Height of the cantilever base at x_s = 0 [m]: z_b = start_height - x_s. */
NT_API double nt_session_start_height(const nt_session *session);
/* x_m at the start [m]: the stage shall be at alpha_p (x_m - master_start). */
NT_API double nt_session_master_start(const nt_session *session);

#ifdef __cplusplus
}
#endif
#endif
