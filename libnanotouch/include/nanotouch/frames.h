/* SPDX-License-Identifier: BSD-3-Clause
 * What a running session shows of itself: one frame per tick in a ring, and a description, in shared memory. Any number
 * of observers (observer.h), in any process, read them; the writer never waits and never learns of them.
 *
 * Each slot of the ring has a sequence word, which is 0 while the slot is written, and relaxed atomic words (H. Boehm,
 * "Can seqlocks get along with programming language memory models?", MSPC 2012). Linux and Windows; elsewhere
 * nt_frames_create gives NT_E_UNSUPPORTED. */
#ifndef NANOTOUCH_FRAMES_H
#define NANOTOUCH_FRAMES_H

#include <stdint.h>

#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NT_FRAME_VERSION 1u
#define NT_FRAME_SLOTS 4096u       /* frames that the ring keeps: 0.41 s at 10 kHz */
#define NT_NAME_SIZE 65u           /* [byte] of a session's name with its ending 0 */
#define NT_DESCRIPTION_SIZE 65536u /* [byte] of a description with its ending 0 */
#define NT_FRAMES_SILENCE 1.0      /* without a sign of life for so long a writer counts as dead [s] */

/* What an observer sees of one tick; NaN where it is not known. Axes and signs: docs/frames.md. 184 bytes. */
typedef struct nt_frame {
    uint32_t size, version;    /* sizeof(nt_frame), NT_FRAME_VERSION */
    uint64_t sequence;         /* number of the tick */
    double time;               /* [s] */
    double tip_position[3];    /* of the apex [m] */
    double tip_force[3];       /* on the tip [N] */
    double base_height;        /* z_b of the cantilever [m] */
    double deflection;         /* zeta [m] */
    double master_position[3]; /* [m] */
    double motor_force[3];     /* what the hand feels [N] */
    double gap;                /* h [m] */
    double contact_radius;     /* a [m] */
    double cohesive_radius;    /* c, where the adhesive zone ends; 0 where there is none, NaN where no law knows [m] */
    double neck_radius;        /* of the meniscus, c where it is the source of adhesion; else 0 [m] */
    uint32_t state;            /* nt_state */
    uint32_t reasons;          /* NT_REASON_* */
    uint32_t phase;            /* nt_phase */
    uint32_t changes;          /* change counter of the description that holds in this tick */
} nt_frame;

/* The writer's end. One thread publishes, beats, takes and answers requests; one at a time describes. */
typedef struct nt_frames nt_frames;

/* name: letters, digits, '.', '-' and '_', less than NT_NAME_SIZE bytes; then the frames lie in shared memory that
 * this user alone may open (mode 0600). NULL: in private memory, for observers in this process. What a dead writer left
 * under the name is removed. NT_E_STATE if a living writer, or another user, has the name; NT_E_RANGE for a bad name;
 * NT_E_NO_MEMORY; NT_E_DEVICE if the system refuses otherwise. The result belongs to the caller: nt_frames_close. */
NT_API nt_status nt_frames_create(nt_frames **frames, const char *name);
/* Removes the name; observers keep what they have and see that the writer is gone. Accepts NULL. */
NT_API void nt_frames_close(nt_frames *frames);

/* Shows one frame. It overwrites the oldest one. */
NT_API NT_REALTIME void nt_frames_publish(nt_frames *frames, const nt_frame *frame);
/* Sign of life: reads the monotonic clock. To be called several times per NT_FRAMES_SILENCE, also during a pause. */
NT_API void nt_frames_beat(nt_frames *frames);
/* Replaces the description, a text (JSON, TOML, ...), and counts the change. NT_E_CAPACITY, and the old one stays, if
 * it does not fit NT_DESCRIPTION_SIZE; NT_E_NO_MEMORY. From any one thread at a time. */
NT_API nt_status nt_frames_describe(nt_frames *frames, const char *text);

/* --- Requests to a running session from its own or another process, and their answers.
 *
 * Several clients may be attached. One at a time holds the lease and may post; a lease that is not renewed ends after
 * NT_LEASE_TERM, so that a dead client blocks nobody. Anyone may stop, without the lease.
 *
 * Clients write the shared memory, so the session trusts nothing in it: whatever they scribble, the writer's calls end
 * after a fixed number of instructions, and a request that does not bear out its check word is refused. This keeps
 * faults of clients away, not enemies: memory is open to the session's own user alone, who could as well kill it. ---
 */

#define NT_LEASE_TERM 1.0  /* [s] */
#define NT_REQUESTS 64u    /* that may wait for their answers at a time */
#define NT_REQUEST_STOP 0u /* the kind that needs no lease; all others are the session's (session.h) */

/* 48 bytes. */
typedef struct nt_request {
    uint64_t id; /* given by nt_client_post; unique within the session */
    uint32_t kind, field;
    double value[4]; /* [SI, by kind] */
} nt_request;

/* 24 bytes. */
typedef struct nt_answer {
    uint64_t id;      /* of the request */
    uint64_t tick;    /* in which it was applied or refused */
    int32_t status;   /* nt_status */
    uint32_t pending; /* 1: not yet applied; another answer will come */
} nt_answer;

/* --- the session's side: the thread that publishes --- */

/* 1 and the next request, else 0; a stop comes before all others, several stops may come as one. Kind, field and value
 * are whatever a client wrote: the caller checks them. Each request has to be answered. */
NT_API NT_REALTIME int nt_frames_take(nt_frames *frames, nt_request *request);
/* Answers a request; again, when it was pending. The answer to a request that nobody waits for any more is dropped. */
NT_API NT_REALTIME void nt_frames_answer(nt_frames *frames, const nt_answer *answer);

/* --- the client's side: one thread per client --- */

typedef struct nt_client nt_client;

/* As nt_observer_attach and nt_observer_of. */
NT_API nt_status nt_client_attach(nt_client **client, const char *name);
/* The same for frames of this process; as nt_observer_of. */
NT_API nt_status nt_client_of(nt_client **client, nt_frames *frames);
/* Gives the lease back. Accepts NULL. */
NT_API void nt_client_close(nt_client *client);

/* Takes or renews the lease, for NT_LEASE_TERM from now. NT_E_STATE while another client holds it. */
NT_API nt_status nt_client_lease(nt_client *client);
/* Gives the lease back, so that another client may take it; nothing where this client has none. */
NT_API void nt_client_release(nt_client *client);

/* Posts a request, writes its id and renews the lease. NT_E_STATE without the lease, NT_E_CAPACITY if NT_REQUESTS wait
 * for their answers. NT_REQUEST_STOP presses, whatever its values, and needs no lease: a client
 * cannot release it. NT_E_DEVICE if the session is closed. */
NT_API nt_status nt_client_post(nt_client *client, nt_request *request);
/* What became of a request of this client; pending until it is applied or refused. The last NT_REQUESTS answers are
 * kept, and that to the last stop. NT_E_STATE if none can come or it is not kept, NT_E_DEVICE if the session is dead.
 */
NT_API nt_status nt_client_poll(const nt_client *client, uint64_t id, nt_answer *answer);

#ifdef __cplusplus
}
#endif
#endif
