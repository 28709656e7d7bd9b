/* SPDX-License-Identifier: BSD-3-Clause
 * Any requests of a client of a session, between its ticks: each is answered, every command stays finite and below its
 * limit, and the session goes on. */
#include "input.h"
#include "nanotouch/nanotouch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { TICKS = 32, ALL = 16 };
static nt_record records[TICKS];
static nt_event events[TICKS];

static nt_session *opened(void)
{
    nt_session_setup setup = nt_session_defaults();
    nt_session *session = NULL;
    setup.clearance = 20e-9;
    setup.preflight = 0;
    setup.ring_capacity = TICKS;
    REQUIRE(nt_session_open(&session, &setup, NULL) == NT_OK);
    REQUIRE(nt_session_publish(session, NULL) == NT_OK);
    return session;
}

/* Of the kinds that there are, and some that there are not; lengths, scales, anything. */
static nt_request request_of(fuzz_input *in)
{
    uint8_t kind, field;
    fuzz_take(in, &kind, sizeof kind);
    fuzz_take(in, &field, sizeof field);
    nt_request made = {.kind = kind % (NT_EVENT_KINDS + 2), .field = field & 0x80 ? field * 0x01010101u : field};
    int count = 0;
    const nt_field *fields = made.kind == NT_EVENT_SCENE ? nt_scene_fields(&count) : nt_settings_fields(&count);
    const nt_field *known = field < count ? &fields[field] : NULL;
    const int changes = made.kind == NT_EVENT_SETTING || made.kind == NT_EVENT_SCENE;
    for (int i = 0; i < 4; ++i)
        made.value[i] = known && changes ? fuzz_double(in, known->minimum, known->maximum)
                        : kind & 0x80    ? fuzz_double(in, 0.0, 10.0)
                                         : fuzz_double(in, -1e-5, 1e-5);
    return made;
}

static void run(nt_session *session, long ticks)
{
    const double before = nt_session_touch(session)->settings.limits.motor_force * (1.0 + 1e-12);
    REQUIRE(nt_session_advance(session, ticks) == NT_OK);
    const long count = nt_session_read(session, records, TICKS);
    REQUIRE(count == ticks);
    const double after = nt_session_touch(session)->settings.limits.motor_force * (1.0 + 1e-12);
    for (long i = 0; i < count; ++i)
        for (int axis = 0; axis < NT_AXES; ++axis) {
            const double force = fabs(records[i].motor_force[axis]);
            REQUIRE((force <= before || force <= after) && isfinite(records[i].stage_command[axis]));
        }
    while (nt_session_read_events(session, events, TICKS) > 0) {
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size};
    nt_session *session = opened();
    nt_client *client = NULL;
    REQUIRE(nt_client_of(&client, nt_session_frames(session)) == NT_OK);
    for (int i = 0; i < ALL && in.size > 0; ++i) {
        nt_request request = request_of(&in);
        nt_answer answer;
        REQUIRE(nt_client_lease(client) == NT_OK);
        REQUIRE(nt_client_post(client, &request) == NT_OK);
        run(session, 2 + data[0] % 8); /* it is taken, prepared, and applied */
        REQUIRE(nt_client_poll(client, request.id, &answer) == NT_OK);
        REQUIRE(!answer.pending && nt_status_message((nt_status)answer.status)[0] != '\0');
    }
    nt_client_close(client);
    nt_session_close(session);
    return 0;
}
