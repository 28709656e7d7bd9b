/* SPDX-License-Identifier: BSD-3-Clause
 * Requests to a running session from its own or another process, and their answers.
 *
 * Several clients may be attached. One at a time holds the lease and may post; a lease that is not renewed ends after
 * NT_LEASE_TERM, so that a dead client blocks nobody. Anyone may stop, without the lease.
 *
 * Clients write the shared memory, so the session trusts nothing in it: whatever they scribble, the writer's calls end
 * after a fixed number of instructions, and a request that does not bear out its check word is refused. This keeps
 * faults of clients away, not enemies: memory is open to the session's own user alone, who could as well kill it. */
#ifndef NANOTOUCH_COMMANDS_H
#define NANOTOUCH_COMMANDS_H

#include "nanotouch/frames.h"

#ifdef __cplusplus
extern "C" {
#endif

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
