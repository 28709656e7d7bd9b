/* SPDX-License-Identifier: BSD-3-Clause */
#include "core/ring.h"

#include <string.h>

#define FRESH 4u

nt_status nt_ring_init(nt_ring *ring, void *memory, size_t element, size_t capacity)
{
    if (!memory || !element || !capacity || (capacity & (capacity - 1)))
        return NT_E_ARGUMENT;
    ring->memory = memory;
    ring->element = element;
    ring->capacity = capacity;
    atomic_init(&ring->head, 0);
    atomic_init(&ring->tail, 0);
    return NT_OK;
}

size_t nt_ring_count(const nt_ring *ring)
{
    /* tail first: it cannot overtake a head that is read later */
    const size_t tail = atomic_load_explicit(&ring->tail, memory_order_acquire);
    return atomic_load_explicit(&ring->head, memory_order_acquire) - tail;
}

nt_status nt_ring_push(nt_ring *ring, const void *element)
{
    void *next = nt_ring_next(ring);
    if (!next)
        return NT_E_CAPACITY;
    memcpy(next, element, ring->element);
    nt_ring_add(ring);
    return NT_OK;
}

size_t nt_ring_pop(nt_ring *ring, void *elements, size_t count)
{
    const size_t tail = atomic_load_explicit(&ring->tail, memory_order_relaxed);
    const size_t there = atomic_load_explicit(&ring->head, memory_order_acquire) - tail;
    const size_t taken = there < count ? there : count;
    unsigned char *out = elements;
    for (size_t i = 0; i < taken; ++i)
        memcpy(out + i * ring->element, ring->memory + ((tail + i) & (ring->capacity - 1)) * ring->element,
               ring->element);
    atomic_store_explicit(&ring->tail, tail + taken, memory_order_release);
    return taken;
}

void nt_mailbox_init(nt_mailbox *mailbox, void *memory, size_t element)
{
    mailbox->memory = memory;
    mailbox->element = element;
    mailbox->write = 0;
    mailbox->read = 1;
    atomic_init(&mailbox->middle, 2u);
}

void nt_mailbox_post(nt_mailbox *mailbox, const void *message)
{
    memcpy(mailbox->memory + mailbox->write * mailbox->element, message, mailbox->element);
    mailbox->write = atomic_exchange_explicit(&mailbox->middle, mailbox->write | FRESH, memory_order_acq_rel) & 3u;
}

int nt_mailbox_take(nt_mailbox *mailbox, void *message)
{
    if (!(atomic_load_explicit(&mailbox->middle, memory_order_relaxed) & FRESH))
        return 0;
    mailbox->read = atomic_exchange_explicit(&mailbox->middle, mailbox->read, memory_order_acq_rel) & 3u;
    memcpy(message, mailbox->memory + mailbox->read * mailbox->element, mailbox->element);
    return 1;
}
