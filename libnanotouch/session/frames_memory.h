/* SPDX-License-Identifier: BSD-3-Clause
 * Private: what lies in the shared memory of a session. Two blocks: "frames", which only the session can write, and
 * "commands", which clients write, too.
 */
#ifndef NANOTOUCH_SESSION_FRAMES_MEMORY_H
#define NANOTOUCH_SESSION_FRAMES_MEMORY_H

#include "core/slot.h"
#include "hal/shared_memory.h"
#include "nanotouch/frames.h"

typedef struct nt_frame_slot {
    nt_word stamp; /* number of the frame, 1 first */
    nt_word words[NT_WORDS(nt_frame)];
} nt_frame_slot;

typedef struct nt_answer_slot {
    nt_word stamp; /* number of the answer, 1 first */
    nt_word words[NT_WORDS(nt_answer)];
} nt_answer_slot;

/* Two, written in turn, so that a writer that dies within leaves the other one whole. */
typedef struct nt_description_slot {
    nt_word stamp; /* the change counter */
    nt_word words[NT_DESCRIPTION_SIZE / sizeof(uint64_t)];
} nt_description_slot;

#define NT_FRAMES_MAGIC 0x314d4152464e544eu /* "NTNFRAM1"; 0 until all is there */
typedef struct nt_frames_block {
    nt_word magic;
    nt_word token;                       /* the same in both blocks of a session */
    nt_word layout;                      /* sizes and versions, for other versions of the library */
    _Alignas(NT_LINE) nt_word published; /* number of the newest frame; 0: none */
    _Alignas(NT_LINE) nt_word beat;      /* monotonic time of the last sign of life [ns]; 0: closed */
    nt_word changes;
    _Alignas(NT_LINE) nt_answer_slot answers[NT_REQUESTS + 1]; /* the last one: to a stop */
    _Alignas(NT_LINE) nt_description_slot descriptions[2];
    _Alignas(NT_LINE) nt_frame_slot slots[NT_FRAME_SLOTS];
} nt_frames_block;

#define NT_FRAMES_LAYOUT ((uint64_t)NT_FRAME_VERSION << 32 | sizeof(nt_frame))

/* The lease is one word: its epoch (23 bits), which counts the holders, and until when it holds (41 bits) [ms] of the
 * monotonic clock. A request's id tells who posted it: epoch and number within it (40 bits), 1 first. That of a stop
 * has the highest bit. */
#define NT_STOP_BIT ((uint64_t)1 << 63)
enum { NT_DEADLINE_BITS = 41, NT_TICKET_BITS = 40 };

typedef struct nt_request_slot {
    nt_word id; /* 0 while it is written */
    nt_word words[NT_WORDS(nt_request)];
    nt_word check; /* nt_request_check of the words */
} nt_request_slot;

typedef struct nt_commands_block {
    nt_word token;
    _Alignas(NT_LINE) nt_word lease; /* epoch and deadline */
    nt_word stops;                   /* how many were asked for */
    _Alignas(NT_LINE) nt_request_slot slots[NT_REQUESTS];
} nt_commands_block;

/* The writer's own state: nothing of it is read back from shared memory. */
struct nt_frames {
    nt_frames_block *block;
    nt_commands_block *commands;
    uint64_t published;
    uint64_t answered;
    uint64_t epoch, ticket;       /* of the lease; of the request taken last */
    uint64_t stops;               /* taken */
    uint64_t asking[NT_REQUESTS]; /* the newest request of each slot */
    nt_shared frames_memory, commands_memory;
};

/* FNV-1a by words: a request mixed from two is not one. */
static inline uint64_t nt_request_check(const nt_request *request)
{
    uint64_t words[NT_WORDS(nt_request)], hash = 0xcbf29ce484222325u;
    memcpy(words, request, sizeof words);
    for (size_t i = 0; i < NT_WORDS(nt_request); ++i)
        hash = (hash ^ words[i]) * 0x100000001b3u;
    return hash ^ hash >> 32;
}

/* Is this the process that made them, or are they private to each? */
int nt_frames_are_own(const nt_frames *frames);
/* Maps the frames of that name for reading. Status as of nt_observer_attach. */
nt_status nt_frames_attach(nt_shared *shared, const nt_frames_block **block, const char *name);
/* Seconds since the last sign of life; infinite if closed. */
double nt_frames_silence(const nt_frames_block *block);

#endif
