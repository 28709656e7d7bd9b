/* SPDX-License-Identifier: BSD-3-Clause
 * Anything that a view may ask of a live session, in any order: its hand stays finite, and each message is whole JSON.
 */
#include "input.h"
#include "nanotouch/host.h"
#include "nanotouch/nanotouch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { ALL = 24, WORD = 40 };
static char message[NT_HOST_MESSAGE];
static const char *const asked[] = {"move", "wheel",  "press",  "retract", "change", "undo", "redo",  "task",
                                    "say",  "choose", "device", "report",  "resume", "rest", "learn", "release"};

/* Brackets in pairs, strings that end, no naked control characters, no number that JSON does not know. */
static int is_json(const char *text, long length)
{
    char open[64];
    int depth = 0, quoted = 0;
    for (long i = 0; i < length; ++i) {
        const char c = text[i];
        if ((unsigned char)c < 0x20)
            return 0;
        if (quoted) {
            i += c == '\\';
            quoted = c != '"';
        } else if (c == '"') {
            quoted = 1;
        } else if (c == '{' || c == '[') {
            if (depth == sizeof open)
                return 0;
            open[depth++] = c;
        } else if (c == '}' || c == ']') {
            if (depth == 0 || open[--depth] != (c == '}' ? '{' : '['))
                return 0;
        } else if ((c == 'n' && strncmp(text + i, "null", 4) != 0 && text[i - 1] != 'a') || c == 'i') {
            return 0; /* nan, inf */
        }
    }
    return length >= 2 && depth == 0 && !quoted && text[0] == '{';
}

static void listen(nt_session_host *host)
{
    for (long length; (length = nt_host_tell(host, message, sizeof message)) > 0;) {
        REQUIRE(length < NT_HOST_MESSAGE && (size_t)length == strlen(message));
        REQUIRE(is_json(message, length));
    }
    long at = 0;
    for (int i = 0; i < 8 && nt_host_result(host, &at, message, sizeof message) > 0; ++i) {
    }
    const nt_host_state state = nt_host_state_of(host);
    for (int i = 0; i < NT_AXES; ++i)
        REQUIRE(isfinite(state.hand->place[i]));
    REQUIRE(isfinite(state.hand->height));
}

/* A field, the name of a task, or letters. */
static const char *text_of(fuzz_input *in, char word[WORD])
{
    uint8_t which;
    int count;
    fuzz_take(in, &which, sizeof which);
    if (which & 0x80) {
        fuzz_take(in, word, which % (WORD - 1));
        return word;
    }
    if (which & 0x40)
        return nt_host_tasks(which & 0x1f) ? nt_host_tasks(which & 0x1f)->name : "";
    if (which & 0x20)
        return nt_host_slider_field(which & 0x1f, NULL) ? nt_host_slider_field(which & 0x1f, NULL) : "wheel";
    const nt_field *fields = nt_scene_fields(&count);
    return fields[which % count].name;
}

static void ask(fuzz_input *in, nt_session_host *host, nt_session *session)
{
    uint8_t what;
    char word[WORD] = {0}, other[WORD] = {0};
    fuzz_take(in, &what, sizeof what);
    nt_host_asked request = {asked[what % 16], text_of(in, word), {0}};
    if (what > 0xf0)
        request.what = text_of(in, other);
    for (int i = 0; i < 3; ++i)
        request.value[i] = what & 0x40 ? fuzz_double(in, 0.0, 20.0) : fuzz_double(in, -1e-6, 1e-6);
    (void)nt_host_ask(host, &request);
    if (nt_host_reopens(host) && what & 0x20)
        nt_host_refuse(host, "not here");
    else if (nt_host_reopens(host) || nt_host_wants(host))
        (void)nt_host_open(host, session);
}

static void pass(fuzz_input *in, nt_session_host *host, nt_session *session)
{
    uint8_t ticks;
    nt_frame frame;
    fuzz_take(in, &ticks, sizeof ticks);
    REQUIRE(nt_session_advance(session, ticks) == NT_OK);
    REQUIRE(nt_session_step(session, NULL, &frame) == NT_OK);
    if (ticks & 1) /* a frame that another program has written */
        frame.tip_position[NT_Z] = fuzz_double(in, -1e-6, 1e-6);
    if (ticks & 2)
        frame.time = fuzz_double(in, 0.0, 100.0);
    nt_host_see(host, &frame, 1);
    nt_host_follow(host, ticks & 4 ? fuzz_double(in, 0.0, 1.0) : 0.01);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size};
    static double memory[1 << 16];
    REQUIRE(nt_host_size() <= sizeof memory);
    nt_session_host *host = nt_host_init(memory);
    nt_session *session = NULL;
    nt_session_setup setup = nt_session_defaults();
    const nt_host_ground ground = {1e-6, 1e-6, 0.0, 0.0, 0};
    const nt_host_subject subject = {"silicon_in_air", "Silicon \"in\" air", "\\", "here", "", 1e-6, 1e-6,
                                     NT_HOST_NOTHING};
    REQUIRE(nt_host_compose(host, &setup, &ground, NULL) == NT_OK);
    setup.preflight = 0;
    setup.ring_capacity = 0;
    nt_host_lay(host, &subject);
    REQUIRE(nt_session_open(&session, &setup, NULL) == NT_OK && nt_host_open(host, session) == NT_OK);
    for (int i = 0; i < ALL && in.size > 0; ++i) {
        ask(&in, host, session);
        pass(&in, host, session);
        listen(host);
    }
    nt_host_close(host);
    nt_session_close(session);
    return 0;
}
