/* SPDX-License-Identifier: BSD-3-Clause
 * Private: single-producer single-consumer ring and latest-value mailbox over the caller's memory, on C11 atomics. The
 * real-time side never waits. */
#ifndef NANOTOUCH_CORE_RING_H
#define NANOTOUCH_CORE_RING_H

#include <stdatomic.h>
#include <stddef.h>

#include "nanotouch/status.h"

/* First in, first out; a full ring refuses, it never overwrites. */
typedef struct nt_ring {
    unsigned char *memory;
    size_t element;     /* [byte] */
    size_t capacity;    /* elements, a power of two */
    atomic_size_t head; /* next to write; producer's */
    atomic_size_t tail; /* next to read; consumer's */
} nt_ring;

/* memory: capacity * element bytes. NT_E_ARGUMENT unless the capacity is a power of two. */
nt_status nt_ring_init(nt_ring *ring, void *memory, size_t element, size_t capacity);
size_t nt_ring_count(const nt_ring *ring);
/* NT_E_CAPACITY when full. */
nt_status nt_ring_push(nt_ring *ring, const void *element);
/* The same in two steps, for what is written in place: where the next element goes, NULL when full; and there it is. */
static inline void *nt_ring_next(nt_ring *ring)
{
    const size_t head = atomic_load_explicit(&ring->head, memory_order_relaxed);
    const size_t count = head - atomic_load_explicit(&ring->tail, memory_order_acquire);
    return count < ring->capacity ? ring->memory + (head & (ring->capacity - 1)) * ring->element : NULL;
}
static inline void nt_ring_add(nt_ring *ring)
{
    const size_t head = atomic_load_explicit(&ring->head, memory_order_relaxed);
    atomic_store_explicit(&ring->head, head + 1, memory_order_release);
}
/* Moves up to `count` elements out; returns how many. */
size_t nt_ring_pop(nt_ring *ring, void *elements, size_t count);

/* Only the newest message counts. Three slots, one atomic exchange on either side. */
typedef struct nt_mailbox {
    unsigned char *memory;
    size_t element;
    atomic_uint middle;   /* slot between the two sides, and whether it is fresh */
    unsigned write, read; /* slots owned by either side */
} nt_mailbox;

/* memory: 3 * element bytes. */
void nt_mailbox_init(nt_mailbox *mailbox, void *memory, size_t element);
void nt_mailbox_post(nt_mailbox *mailbox, const void *message);
/* 1 and the newest message if one has come since the last call, else 0. */
int nt_mailbox_take(nt_mailbox *mailbox, void *message);

#endif
