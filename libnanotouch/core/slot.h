/* SPDX-License-Identifier: BSD-3-Clause
 * Private: a slot of shared memory, written by one and read by others, none of whom waits (H. Boehm, "Can seqlocks get
 * along with programming language memory models?", MSPC 2012). It is a stamp and the words of what it holds. The writer
 * sets the stamp to 0, stores the words, and sets it to a new value; a reader that finds the same stamp before and
 * after has read no torn words. */
#ifndef NANOTOUCH_CORE_SLOT_H
#define NANOTOUCH_CORE_SLOT_H

#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef _Atomic uint64_t nt_word;

#define NT_WORDS(type) (sizeof(type) / sizeof(uint64_t))
enum { NT_LINE = 64 /* of the cache [byte] */ };

static inline uint64_t nt_word_of(const nt_word *word)
{
    return atomic_load_explicit(word, memory_order_relaxed);
}

/* Stores `count` words under a new stamp. NT_REALTIME */
static inline void nt_slot_write(nt_word *stamp, nt_word *words, uint64_t value, const void *source, size_t count)
{
    const unsigned char *bytes = source;
    atomic_store_explicit(stamp, 0, memory_order_relaxed);
    atomic_thread_fence(memory_order_release); /* who sees a new word sees the 0 */
    for (size_t i = 0; i < count; ++i) {
        uint64_t word;
        memcpy(&word, bytes + i * sizeof word, sizeof word);
        atomic_store_explicit(&words[i], word, memory_order_relaxed);
    }
    atomic_store_explicit(stamp, value, memory_order_release);
}

/* Copies `count` words; returns their stamp, or 0 if they were written meanwhile: what was copied may be torn. */
static inline uint64_t nt_slot_read(const nt_word *stamp, const nt_word *words, void *target, size_t count)
{
    unsigned char *bytes = target;
    const uint64_t before = atomic_load_explicit(stamp, memory_order_acquire);
    for (size_t i = 0; i < count; ++i) {
        const uint64_t word = nt_word_of(&words[i]);
        memcpy(bytes + i * sizeof word, &word, sizeof word);
    }
    atomic_thread_fence(memory_order_acquire); /* who saw a new word sees the 0 */
    return nt_word_of(stamp) == before ? before : 0;
}

#endif
