/* SPDX-License-Identifier: BSD-3-Clause
 * What a session cannot be opened with is named; no call falls over what is not there. */
// clang-format off
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
// clang-format on

#include <string.h>

#include "session_fixture.h"

static void expect_refused(const nt_session_setup *setup, const char *field)
{
    nt_session *session = NULL;
    nt_problem problem = {0};
    const nt_status status = nt_session_open(&session, setup, &problem);
    if (status != NT_E_RANGE && status != NT_E_NOT_FINITE && status != NT_E_ARGUMENT)
        fail_msg("%s: %s", field, nt_status_message(status));
    if (!problem.field || strncmp(problem.field, field, strlen(field)) != 0)
        fail_msg("%s: the problem names %s", field, problem.field ? problem.field : "nothing");
    assert_null(session);
}

#define REFUSES(field, value)                                                                                          \
    do {                                                                                                               \
        nt_session_setup wrong = nt_session_defaults();                                                                \
        wrong.field = value;                                                                                           \
        expect_refused(&wrong, #field);                                                                                \
    } while (0)

static void what_cannot_be_is_named(void **state)
{
    (void)state;
    const nt_surface *none = NULL;
    REFUSES(mode, (nt_mode)7);
    REFUSES(probe_model, (nt_probe_model)9);
    REFUSES(preflight, 7);
    REFUSES(dilated, -1);
    REFUSES(x, 1e300);
    REFUSES(y, (double)NAN);
    REFUSES(substep, -1.0);
    REFUSES(substep, (double)NAN);
    REFUSES(clearance, 0.0);
    nt_session_setup wrong = nt_session_defaults();
    wrong.path_count = 5; /* of no path */
    expect_refused(&wrong, "path.count");
    wrong.path_count = -1;
    expect_refused(&wrong, "path.count");
    wrong = nt_session_defaults();
    wrong.settings.control.choice = (nt_control_choice)9;
    expect_refused(&wrong, "control.choice");
    wrong = nt_session_defaults();
    wrong.settings.control.context = &none; /* of no law */
    expect_refused(&wrong, "control.choice beside");
    wrong = nt_session_defaults();
    wrong.master_option = "x"; /* of no backend */
    expect_refused(&wrong, "master.context or master_option");
    wrong = nt_session_defaults();
    wrong.slave.context = &none;
    expect_refused(&wrong, "slave.context or slave_option");
    nt_faults faults = {.count = -1};
    wrong = nt_session_defaults();
    wrong.faults = &faults;
    expect_refused(&wrong, "faults.count");
    faults.count = 99;
    expect_refused(&wrong, "faults.count");
}

/* Nobody watches the force during the preflight: a frame that drifts as declared must not touch in it. */
static void the_tip_is_clear_when_the_preflight_ends(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    setup.rig.stage.drift = 1e-6;
    expect_refused(&setup, "clearance");
    setup.preflight = 0;
    nt_session_close(open_session(&setup));
    setup.preflight = 1;
    setup.clearance = 1e-6;
    nt_session_close(open_session(&setup));
}

static void a_substep_bounds_the_work(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    setup.probe_model = NT_PROBE_DYNAMIC;
    setup.substep = 1e-9;
    expect_refused(&setup, "substep");
    setup.probe_model = NT_PROBE_QUASI_STATIC; /* which takes none */
    setup.substep = 0.25;
    expect_refused(&setup, "substep where");
}

static void no_call_falls_over_nothing(void **state)
{
    (void)state;
    const nt_session_setup setup = nt_session_defaults();
    nt_session *session = open_session(&setup);
    nt_record record;
    nt_event event;
    nt_frame frame;
    assert_int_equal(nt_session_rescale(session, NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_change(session, NT_EVENT_SCENE, NULL, 1.0, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_aim(session, NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_step(session, NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_snapshot(session, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_restore(session, NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_inject(session, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_arm(NULL, 1), NT_E_ARGUMENT);
    assert_int_equal(nt_session_advance(NULL, 1), NT_E_ARGUMENT);
    assert_int_equal(nt_session_step(NULL, NULL, &frame), NT_E_ARGUMENT);
    assert_int_equal(nt_session_start(NULL, NT_PACE_FREE, 1), NT_E_ARGUMENT);
    assert_int_equal(nt_session_halt(NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_pause(NULL, 1), NT_E_ARGUMENT);
    assert_int_equal(nt_session_publish(NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_session_read(NULL, &record, 1), 0);
    assert_int_equal(nt_session_read_events(NULL, &event, 1), 0);
    nt_session_close(session);
}

static void a_hand_of_one_axis_goes_nowhere_else(void **state)
{
    (void)state;
    const nt_session_setup setup = nt_session_defaults();
    nt_session *session = open_session(&setup);
    nt_problem problem = {0};
    nt_input input = {.holds = 1, .master_position = {5e-3, 0.0, 0.0}, .x = (double)NAN, .y = (double)NAN};
    assert_int_equal(nt_session_aim(session, &input, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "input along x of a master of one axis");
    input = (nt_input){.operator_force = {0.0, 3.0, 0.0}, .x = (double)NAN, .y = (double)NAN};
    assert_int_equal(nt_session_aim(session, &input, &problem), NT_E_RANGE);
    assert_string_equal(problem.unit, "N");
    input = (nt_input){.holds = 7, .x = (double)NAN, .y = (double)NAN};
    assert_int_equal(nt_session_aim(session, &input, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "input.holds");
    nt_session_close(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_cannot_be_is_named),
        cmocka_unit_test(the_tip_is_clear_when_the_preflight_ends),
        cmocka_unit_test(a_substep_bounds_the_work),
        cmocka_unit_test(no_call_falls_over_nothing),
        cmocka_unit_test(a_hand_of_one_axis_goes_nowhere_else),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
