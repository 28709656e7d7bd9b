/* SPDX-License-Identifier: BSD-3-Clause
 * Anything in the shared memory of a running session: its calls end, an observer gets whole frames and a text that
 * ends, and only what a client has posted is taken. */
#include "input.h"
#include "internal/observer.h"
#include "nanotouch/advanced/observer.h"
#include "nanotouch/frames.h"
#include "session/frames_memory.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { FRAMES = 16 };
static char text[NT_DESCRIPTION_SIZE];

/* Some bytes anywhere in a block. */
static void scribble(fuzz_input *in, void *block, size_t size)
{
    uint32_t place;
    uint8_t count, bytes[16] = {0};
    fuzz_take(in, &place, sizeof place);
    fuzz_take(in, &count, sizeof count);
    const size_t n = count % sizeof bytes + 1;
    fuzz_take(in, bytes, n);
    memcpy((char *)block + place % (size - n), bytes, n);
}

static void observe(nt_observer *observer)
{
    nt_frame frames[FRAMES], newest;
    uint32_t changes;
    const long count = nt_observer_read(observer, frames, FRAMES);
    REQUIRE(count >= 0 && count <= FRAMES);
    (void)nt_observer_newest(observer, &newest);
    (void)nt_observer_missed(observer);
    REQUIRE(nt_observer_silence(observer) >= 0.0 || !nt_observer_is_alive(observer));
    const nt_status status = nt_observer_description(observer, text, &changes);
    REQUIRE(status == NT_E_CAPACITY || memchr(text, '\0', sizeof text));
}

static void serve(nt_frames *frames)
{
    nt_request request;
    for (int i = 0; i < 3 && nt_frames_take(frames, &request); ++i) {
        const nt_answer answer = {.id = request.id, .status = NT_OK};
        nt_frames_answer(frames, &answer);
    }
}

static void post(fuzz_input *in, nt_client *client)
{
    nt_request request;
    nt_answer answer;
    fuzz_take(in, &request, sizeof request);
    const nt_status leased = nt_client_lease(client), posted = nt_client_post(client, &request);
    REQUIRE(posted != NT_OK || leased == NT_OK || request.kind == NT_REQUEST_STOP);
    if (posted == NT_OK)
        (void)nt_client_poll(client, request.id, &answer);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size};
    nt_frames *frames = NULL;
    nt_client *client = NULL;
    nt_observer *observer = NULL;
    REQUIRE(nt_frames_create(&frames, NULL) == NT_OK);
    REQUIRE(nt_client_of(&client, frames) == NT_OK && nt_observer_of(&observer, frames) == NT_OK);
    while (in.size > 0) {
        uint8_t what;
        nt_frame frame = {.size = sizeof frame, .version = NT_FRAME_VERSION};
        char words[64] = {0};
        fuzz_take(&in, &what, sizeof what);
        switch (what % 7) {
        case 0:
            scribble(&in, frames->commands, sizeof *frames->commands);
            break;
        case 1:
            scribble(&in, frames->block, sizeof *frames->block);
            break;
        case 2:
            post(&in, client);
            break;
        case 3:
            fuzz_take(&in, words, sizeof words - 1);
            REQUIRE(nt_frames_describe(frames, words) == NT_OK);
            break;
        case 4:
            for (int i = 0; i < what; ++i)
                nt_frames_publish(frames, &frame);
            break;
        default:
            serve(frames);
            observe(observer);
        }
    }
    serve(frames);
    observe(observer);
    nt_observer_close(observer);
    nt_client_close(client);
    nt_frames_close(frames);
    return 0;
}
