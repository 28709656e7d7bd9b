/* SPDX-License-Identifier: BSD-3-Clause
 * The writer's end of frames and commands. */
#include "nanotouch/frames.h"

#include <math.h>
#include <stdlib.h>

#include "hal/clock.h"
#include "session/frames.h"
#include "session/frames_memory.h"

_Static_assert(sizeof(nt_frame) == 184 && sizeof(nt_frame_slot) == 192, "three cache lines");
_Static_assert((int)NT_NAME_SIZE == (int)NT_GIVEN_NAME_SIZE, "what shared memory allows");
_Static_assert(sizeof(nt_request) == 48 && sizeof(nt_answer) == 24, "as documented");

nt_frame nt_frame_unknown(void)
{
    const double none = (double)NAN;
    const nt_frame frame = {.size = sizeof frame,
                            .version = NT_FRAME_VERSION,
                            .time = none,
                            .tip_position = {none, none, none},
                            .tip_force = {none, none, none},
                            .base_height = none,
                            .deflection = none,
                            .master_position = {none, none, none},
                            .motor_force = {none, none, none},
                            .gap = none,
                            .contact_radius = none,
                            .cohesive_radius = none,
                            .neck_radius = none};
    return frame;
}

nt_status nt_frames_create(nt_frames **frames, const char *name)
{
    if (!frames)
        return NT_E_ARGUMENT;
    nt_frames *made = calloc(1, sizeof *made);
    if (!made)
        return NT_E_NO_MEMORY;
    nt_status status = nt_shared_create(&made->frames_memory, "frames", name, sizeof(nt_frames_block));
    if (status == NT_OK) /* the name is ours */
        status = nt_shared_create(&made->commands_memory, "commands", name, sizeof(nt_commands_block));
    if (status != NT_OK) {
        nt_shared_close(&made->frames_memory);
        free(made);
        return status;
    }
    made->block = made->frames_memory.memory;
    made->commands = made->commands_memory.memory;
    const uint64_t token = (uint64_t)nt_clock_now() ^ (uint64_t)(uintptr_t)made << 16;
    atomic_store(&made->block->token, token);
    atomic_store(&made->commands->token, token);
    atomic_store(&made->block->layout, NT_FRAMES_LAYOUT);
    nt_frames_beat(made);
    atomic_store(&made->block->magic, NT_FRAMES_MAGIC);
    *frames = made;
    return NT_OK;
}

void nt_frames_close(nt_frames *frames)
{
    if (!frames)
        return;
    if (nt_frames_are_own(frames))
        atomic_store(&frames->block->beat, 0);
    nt_shared_close(&frames->commands_memory);
    nt_shared_close(&frames->frames_memory);
    free(frames);
}

int nt_frames_are_own(const nt_frames *frames)
{
    return frames->frames_memory.file < 0 || nt_shared_is_own(&frames->frames_memory);
}

void nt_frames_publish(nt_frames *frames, const nt_frame *frame)
{
    const uint64_t number = ++frames->published;
    nt_frame_slot *slot = &frames->block->slots[number % NT_FRAME_SLOTS];
    nt_slot_write(&slot->stamp, slot->words, number, frame, NT_WORDS(nt_frame));
    atomic_store_explicit(&frames->block->published, number, memory_order_release);
}

void nt_frames_beat(nt_frames *frames)
{
    atomic_store_explicit(&frames->block->beat, (uint64_t)nt_clock_now(), memory_order_relaxed);
}

nt_status nt_frames_describe(nt_frames *frames, const char *text)
{
    if (!text)
        return NT_E_ARGUMENT;
    const size_t length = strlen(text);
    if (length >= NT_DESCRIPTION_SIZE)
        return NT_E_CAPACITY;
    char *padded = calloc(1, NT_DESCRIPTION_SIZE);
    if (!padded)
        return NT_E_NO_MEMORY;
    memcpy(padded, text, length);
    const uint64_t changes = nt_word_of(&frames->block->changes) + 1;
    nt_description_slot *slot = &frames->block->descriptions[changes % 2];
    nt_slot_write(&slot->stamp, slot->words, changes, padded, NT_DESCRIPTION_SIZE / sizeof(uint64_t));
    atomic_store_explicit(&frames->block->changes, changes, memory_order_release);
    free(padded);
    return NT_OK;
}

uint32_t nt_frames_changes(const nt_frames *frames)
{
    return (uint32_t)nt_word_of(&frames->block->changes);
}
