/* SPDX-License-Identifier: BSD-3-Clause
 * A stage of one axis: x and y stay where the session starts. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "device_fixture.h"
#include "session_fixture.h"

enum { MOST = 15000 };
static nt_record records[MOST];

/* A bump, and where it is steep. */
static const double steep[] = {1.6e-6, 1e-6};
static double bump[41 * 41];

static nt_session_setup bumpy_setup(double stage_axes)
{
    for (int i = 0; i < 41 * 41; i++) {
        const double x = 0.05e-6 * (i % 41) - 1e-6, y = 0.05e-6 * (double)(i / 41) - 1e-6;
        bump[i] = 100e-9 * exp(-(x * x + y * y) / 0.25e-12);
    }
    nt_session_setup setup = nt_session_defaults();
    setup.map = (nt_height_map){.heights = bump, .nx = 41, .ny = 41, .dx = 0.05e-6, .dy = 0.05e-6};
    setup.scene.tip.radius = 20e-9;
    setup.x = steep[NT_X];
    setup.y = steep[NT_Y];
    setup.clearance = 20e-9;
    setup.rig.stage.axes = stage_axes;
    return setup;
}

/* It touches where it starts; x and y stand there and can be sent nowhere else; the guarantee counts with that. */
static void a_stage_of_one_axis_touches_where_it_starts(void **state)
{
    (void)state;
    nt_session_setup setup = bumpy_setup(1.0);
    setup.rig.master.axes = 3.0; /* the hand may go where it will */
    nt_session *session = open_session(&setup);
    const nt_capabilities *has = nt_session_capabilities(session, NT_HALF_SLAVE);
    assert_true(has->axes == 1 && has->rows == 3); /* position, deflection and travel, all of z */
    push(session, 1.0, 0.5);
    run(session, records, 15000);
    int touched = 0;
    for (int k = 0; k < 15000; k++) {
        const nt_record *r = &records[k];
        assert_int_equal(r->state, NT_RUN);
        for (int i = NT_X; i < NT_Z; i++)
            assert_true(r->stage_position[i] == steep[i] && r->stage_command[i] == steep[i]);
        touched |= r->contact_radius > 0.0;
    }
    assert_true(touched);
    const nt_input away = {.x = steep[NT_X] + 1e-9, .y = steep[NT_Y], .duration = 1.0};
    nt_problem problem = {0};
    assert_int_equal(nt_session_aim(session, &away, &problem), NT_E_RANGE);
    assert_true(problem.minimum == steep[NT_X] && problem.maximum == steep[NT_X]);
    nt_frame frame;
    assert_int_equal(nt_session_step(session, NULL, &frame), NT_OK);
    assert_true(frame.tip_position[NT_X] == steep[NT_X] && frame.tip_position[NT_Y] == steep[NT_Y]);
    const nt_guarantee one = nt_session_guarantee(session);
    nt_session_close(session);
    setup = bumpy_setup(3.0);
    session = open_session(&setup);
    const nt_guarantee three = nt_session_guarantee(session);
    assert_true(three.moves_sideways && !one.moves_sideways && one.motion < three.motion);
    nt_session_close(session);
}

static void what_a_stage_of_one_axis_cannot_do_is_refused(void **state)
{
    (void)state;
    const double line[] = {steep[NT_X], steep[NT_Y], 1e-6, 1e-6};
    nt_session_setup setup = bumpy_setup(1.0);
    setup.path = line;
    setup.path_count = 2;
    nt_session *session = NULL;
    nt_problem problem = {0};
    assert_int_equal(nt_session_open(&session, &setup, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "path.x of a stage of one axis");
    const nt_backend probe = backend_of(NT_HALF_SLAVE);
    device d = {.describes_itself = 1, .says = {.can = NT_CAN_FEEL, .axes = 1}};
    setup = bumpy_setup(3.0);
    setup.slave = (nt_hal_choice){&probe, &d};
    assert_int_equal(nt_session_open(&session, &setup, &problem), NT_E_RANGE); /* the rig says more than it has */
    assert_string_equal(problem.field, "stage.axes (this slave has fewer)");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stage_of_one_axis_touches_where_it_starts),
        cmocka_unit_test(what_a_stage_of_one_axis_cannot_do_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
