/* SPDX-License-Identifier: BSD-3-Clause
 * Private: what lies in a mailbox. The program owns the block; readings are written by it, requests by the session.
 * Each has two slots, written in turn, so that a writer that dies within leaves the other one whole. */
#ifndef NANOTOUCH_HAL_MAILBOX_MEMORY_H
#define NANOTOUCH_HAL_MAILBOX_MEMORY_H

#include "core/slot.h"
#include "hal/shared_memory.h"
#include "nanotouch/mailbox.h"

#define NT_MAILBOX_MAGIC 0x31584f424d544e54u /* "TNTMBOX1"; 0 until all is there */
#define NT_MAILBOX_LAYOUT ((uint64_t)NT_HAL_API_VERSION << 32 | sizeof(nt_mailbox_block))
#define NT_MAILBOX_ATTEMPTS 3 /* at a slot that is being written */

typedef struct nt_mailbox_row {
    char name[NT_MAILBOX_CHANNEL_NAME], unit[8];
    nt_channel_row row; /* its pointers mean nothing to another process */
} nt_mailbox_row;

typedef struct nt_mailbox_description {
    uint32_t half, can;
    int32_t axes, rows;
    double period, timeout; /* [s] */
    nt_mailbox_row row[NT_MAILBOX_CHANNELS];
} nt_mailbox_description;

typedef struct nt_mailbox_block {
    nt_word magic;
    nt_word layout;                     /* size and version, for other versions of the library */
    nt_mailbox_description description; /* written before the magic */
    _Alignas(NT_LINE) nt_word beat;     /* the program's last sign of life [ns]; 0: closed */
    nt_word published;                  /* number of the newest reading; 0: none */
    nt_word answered;                   /* number of the request that the program has seen last */
    _Alignas(NT_LINE) nt_word readings_at[2];
    nt_word readings[2][NT_WORDS(nt_reading)];
    _Alignas(NT_LINE) nt_word asked; /* number of the newest request; 0: none */
    nt_word requests_at[2];
    nt_word requests[2][NT_WORDS(nt_mailbox_request)];
} nt_mailbox_block;

/* A new value into the slot whose turn it is. NT_REALTIME */
static inline void nt_mailbox_put(nt_word *newest, nt_word *stamps, nt_word *words, const void *source, size_t count)
{
    const uint64_t number = nt_word_of(newest) + 1;
    const size_t slot = number & 1u;
    nt_slot_write(&stamps[slot], words + slot * count, number, source, count);
    atomic_store_explicit(newest, number, memory_order_release);
}

/* The newest value and its number; 0, and nothing is copied that counts, if there is none or it was written meanwhile.
 */
static inline uint64_t nt_mailbox_take(const nt_word *newest, const nt_word *stamps, const nt_word *words, void *target,
                                       size_t count)
{
    for (int i = 0; i < NT_MAILBOX_ATTEMPTS; ++i) {
        const uint64_t number = atomic_load_explicit(newest, memory_order_acquire);
        const size_t slot = number & 1u;
        if (number == 0 || nt_slot_read(&stamps[slot], words + slot * count, target, count) == number)
            return number;
    }
    return 0;
}

/* Can a device of these abilities have measured this? Both sides ask: the other one may have gone mad. */
int nt_mailbox_is_sound(const nt_reading *reading, uint32_t can, int axes);

#endif
