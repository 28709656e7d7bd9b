/* SPDX-License-Identifier: BSD-3-Clause
 * Frames that show when they have been torn, and names that no other run of the tests has. */
#ifndef NANOTOUCH_TEST_FRAMES_FIXTURE_H
#define NANOTOUCH_TEST_FRAMES_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include <unistd.h>

#include "nanotouch/advanced/observer.h"
#include "nanotouch/frames.h"

enum { FRAME_WORDS = sizeof(nt_frame) / sizeof(uint64_t) };

/* A name of this process; number tells several apart. */
static inline const char *session_name(char *name, int number)
{
    snprintf(name, NT_NAME_SIZE, "test-%ld-%d", (long)getpid(), number);
    return name;
}

/* Every word of it is a function of the tick; the tick itself is where it belongs. */
static inline nt_frame frame_of(uint64_t tick)
{
    uint64_t words[FRAME_WORDS];
    nt_frame frame;
    for (uint64_t i = 0; i < FRAME_WORDS; ++i)
        words[i] = (tick + i) * 0x9e3779b97f4a7c15u;
    memcpy(&frame, words, sizeof frame);
    frame.sequence = tick;
    return frame;
}

static inline int is_whole(const nt_frame *frame)
{
    const nt_frame expected = frame_of(frame->sequence);
    return memcmp(frame, &expected, sizeof expected) == 0;
}

static inline void publish(nt_frames *frames, uint64_t first, uint64_t end)
{
    for (uint64_t tick = first; tick < end; ++tick) {
        const nt_frame frame = frame_of(tick);
        nt_frames_publish(frames, &frame);
    }
}

#endif
