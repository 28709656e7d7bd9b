/* SPDX-License-Identifier: BSD-3-Clause
 * The frame of a tick is its record, in the world's axes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/observer.h"
#include "session_fixture.h"

static void expect_frame(const nt_frame *frame, const nt_record *record, const nt_session *session)
{
    const double base = nt_session_start_height(session) - record->stage_position[NT_Z];
    assert_true(frame->sequence == record->tick && frame->time == record->time);
    assert_true(frame->base_height == base && frame->deflection == record->deflection[NT_Z]);
    assert_true(frame->tip_position[0] == record->stage_position[NT_X]);
    assert_true(frame->tip_position[1] == record->stage_position[NT_Y]);
    const double tilt = nt_session_touch(session)->rig.probe.tilt;
    assert_true(frame->tip_position[2] == base + record->deflection[NT_Z] * cos(tilt));
    for (int i = 0; i < NT_AXES; i++) {
        assert_true(frame->tip_force[i] == record->tip_force[i]);
        assert_true(i == NT_Z ? frame->master_position[i] == record->master_position[i]
                              : isnan(frame->master_position[i])); /* it has one axis */
        assert_true(frame->motor_force[i] == record->motor_force[i]);
    }
    assert_true(frame->gap == record->gap && frame->contact_radius == record->contact_radius);
    assert_true(isnan(frame->cohesive_radius) && isnan(frame->neck_radius));
    assert_true(frame->state == record->state && frame->reasons == record->reasons && frame->phase == record->phase);
}

/* As nt_session_step returns it, and as an observer sees it, in contact. */
static void a_frame_is_the_record(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    setup.clearance = 10e-9;
    nt_session *session = open_session(&setup);
    assert_int_equal(nt_session_publish(session, NULL), NT_OK);
    nt_observer *observer = NULL;
    assert_int_equal(nt_observer_of(&observer, nt_session_frames(session)), NT_OK);
    const nt_input input = {.operator_force = {[NT_Z] = 1.0}, .x = 1e-7, .y = 2e-7, .duration = 0.1};
    int touched = 0;
    for (int i = 0; i < 3000; i++) {
        nt_frame stepped, seen;
        nt_record record;
        assert_int_equal(nt_session_step(session, i == 0 ? &input : NULL, &stepped), NT_OK);
        assert_int_equal(nt_session_read(session, &record, 1), 1);
        expect_frame(&stepped, &record, session);
        assert_int_equal(nt_observer_read(observer, &seen, 1), 1);
        assert_memory_equal(&seen, &stepped, sizeof seen);
        touched |= stepped.contact_radius > 0.0;
    }
    assert_true(touched);
    nt_observer_close(observer);
    nt_session_close(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_frame_is_the_record)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
