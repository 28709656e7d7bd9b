/* SPDX-License-Identifier: BSD-3-Clause
 * The readers' end of the frames: no write to shared memory, every loop bounded. */
#include "internal/observer.h"
#include "nanotouch/advanced/observer.h"

#include <math.h>
#include <stdlib.h>

#include "hal/clock.h"
#include "session/frames_memory.h"

enum { TRIES = 8 }; /* each one fails only if the writer went round the whole ring within it */

struct nt_observer {
    nt_shared memory; /* none where the frames are those of this process */
    const nt_frames_block *block;
    uint64_t seen; /* number of the frame that was read last */
    uint64_t missed;
};

nt_status nt_frames_attach(nt_shared *shared, const nt_frames_block **block, const char *name)
{
    if (!name)
        return NT_E_ARGUMENT;
    nt_status status = nt_shared_attach(shared, "frames", name, sizeof(nt_frames_block), 0);
    if (status != NT_OK)
        return status;
    const nt_frames_block *found = shared->memory;
    if (atomic_load_explicit(&found->magic, memory_order_acquire) != NT_FRAMES_MAGIC)
        status = NT_E_DEVICE; /* not yet complete */
    else if (nt_word_of(&found->layout) != NT_FRAMES_LAYOUT)
        status = NT_E_UNSUPPORTED;
    if (status == NT_OK)
        *block = found;
    else
        nt_shared_close(shared);
    return status;
}

double nt_frames_silence(const nt_frames_block *block)
{
    const uint64_t beat = nt_word_of(&block->beat), now = (uint64_t)nt_clock_now();
    if (beat == 0)
        return (double)INFINITY;
    return now > beat ? 1e-9 * (double)(now - beat) : 0.0;
}

static uint64_t newest_of(const nt_frames_block *block)
{
    return atomic_load_explicit(&block->published, memory_order_acquire);
}

/* Takes over memory; it is closed if there is no room for the observer. */
static nt_status make_observer(nt_observer **observer, nt_shared memory, const nt_frames_block *block)
{
    nt_observer *made = calloc(1, sizeof *made);
    if (!made) {
        nt_shared_close(&memory);
        return NT_E_NO_MEMORY;
    }
    made->memory = memory;
    made->block = block;
    made->seen = newest_of(block);
    *observer = made;
    return NT_OK;
}

nt_status nt_observer_attach(nt_observer **observer, const char *name)
{
    if (!observer)
        return NT_E_ARGUMENT;
    nt_shared memory;
    const nt_frames_block *block;
    const nt_status status = nt_frames_attach(&memory, &block, name);
    return status == NT_OK ? make_observer(observer, memory, block) : status;
}

nt_status nt_observer_of(nt_observer **observer, const nt_frames *frames)
{
    if (!observer || !frames)
        return NT_E_ARGUMENT;
    return make_observer(observer, (nt_shared){.file = -1}, frames->block);
}

void nt_observer_close(nt_observer *observer)
{
    if (!observer)
        return;
    nt_shared_close(&observer->memory);
    free(observer);
}

/* 1 if the frame of that number was still there. */
static int copy_frame(const nt_frames_block *block, uint64_t number, nt_frame *frame)
{
    const nt_frame_slot *slot = &block->slots[number % NT_FRAME_SLOTS];
    return nt_slot_read(&slot->stamp, slot->words, frame, NT_WORDS(nt_frame)) == number;
}

int nt_observer_newest(const nt_observer *observer, nt_frame *frame)
{
    nt_frame copy;
    for (int i = 0; i < TRIES; ++i) {
        const uint64_t newest = newest_of(observer->block);
        if (newest == 0)
            return 0;
        if (copy_frame(observer->block, newest, &copy)) {
            *frame = copy;
            return 1;
        }
    }
    return 0;
}

/* Half a ring behind the newest frame: there is time to read it. */
static void skip(nt_observer *observer)
{
    const uint64_t start = newest_of(observer->block) - NT_FRAME_SLOTS / 2;
    observer->missed += start - observer->seen;
    observer->seen = start;
}

long nt_observer_read(nt_observer *observer, nt_frame *frames, long count)
{
    long got = 0;
    for (int tries = 0; got < count && observer->seen < newest_of(observer->block) && tries < TRIES;) {
        if (copy_frame(observer->block, observer->seen + 1, &frames[got])) {
            ++observer->seen;
            ++got;
        } else { /* overwritten: the newest one is nearly a ring ahead */
            skip(observer);
            ++tries;
        }
    }
    return got;
}

uint64_t nt_observer_missed(const nt_observer *observer)
{
    return observer->missed;
}

double nt_observer_silence(const nt_observer *observer)
{
    return nt_frames_silence(observer->block);
}

int nt_observer_is_alive(const nt_observer *observer)
{
    return nt_frames_silence(observer->block) < NT_FRAMES_SILENCE;
}

nt_status nt_observer_description(const nt_observer *observer, char *text, uint32_t *changes)
{
    const nt_frames_block *block = observer->block;
    for (int i = 0; i < TRIES; ++i) {
        const uint64_t newest = atomic_load_explicit(&block->changes, memory_order_acquire);
        const nt_description_slot *slot = &block->descriptions[newest % 2];
        if (nt_slot_read(&slot->stamp, slot->words, text, NT_DESCRIPTION_SIZE / sizeof(uint64_t)) != newest)
            continue;
        text[NT_DESCRIPTION_SIZE - 1] = '\0';
        if (changes)
            *changes = (uint32_t)newest;
        return NT_OK;
    }
    return NT_E_CAPACITY;
}
