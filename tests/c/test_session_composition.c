/* SPDX-License-Identifier: BSD-3-Clause
 * What a session is composed of: the slope and the rise that its path meets, or the whole surface, and the room that
 * the master is given for them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/margins.h"
#include "internal/session.h"
#include "session/hazard.h"
#include "session_fixture.h"

enum { N = 64 };
static double heights[N * N];

/* A ramp along x of 5 % from the middle on; level before. */
static nt_session_setup over_a_ramp(void)
{
    for (int i = 0; i < N * N; i++)
        heights[i] = 5e-10 * (i % N > N / 2 ? i % N - N / 2 : 0);
    nt_session_setup setup = nt_session_defaults();
    setup.map = (nt_height_map){.heights = heights, .nx = N, .ny = N, .dx = 10e-9, .dy = 10e-9};
    setup.dilated = 1;
    setup.x = 50e-9;
    setup.y = 300e-9;
    setup.clearance = 5e-9;
    return setup;
}

/* On the level part neither slope nor rise; over the ramp both; freely all of the surface. */
static void the_reach_is_that_of_the_path(void **state)
{
    (void)state;
    static const double level[] = {50e-9, 300e-9, 150e-9, 300e-9}, ramp[] = {50e-9, 300e-9, 600e-9, 300e-9};
    nt_session_setup setup = over_a_ramp();
    setup.path = level;
    setup.path_count = 2;
    nt_session *flat = open_session(&setup);
    setup.path = ramp;
    nt_session *steep = open_session(&setup);
    setup.path = NULL;
    setup.path_count = 0;
    nt_session *whole = open_session(&setup);
    const nt_reach none = nt_session_reach(flat), some = nt_session_reach(steep), all = nt_session_reach(whole);
    assert_true(none.slope < 1e-6 && none.rise < 1e-13);
    assert_true(some.slope > 0.05 && some.slope < 0.07); /* the spline overshoots at the bend */
    assert_true(fabs(some.rise - 5e-10 * (60 - N / 2)) < 1e-11);
    assert_true(all.slope >= some.slope * (1.0 - 1e-3) && all.rise > some.rise);
    /* what is promised is worse by the slope */
    assert_true(nt_session_guarantee(flat).force < nt_session_guarantee(steep).force);
    nt_session_close(flat);
    nt_session_close(steep);
    nt_session_close(whole);
}

/* A hand of three axes leaves any path; a stage of one axis has the slope that it stands on, in any direction. */
static void what_leads_the_tip_says_where_it_goes(void **state)
{
    (void)state;
    static const double level[] = {50e-9, 300e-9, 150e-9, 300e-9};
    nt_session_setup setup = over_a_ramp();
    nt_session *whole = open_session(&setup);
    setup.path = level;
    setup.path_count = 2;
    setup.rig.master.axes = 3.0;
    nt_session *led = open_session(&setup);
    assert_true(nt_session_reach(led).slope == nt_session_reach(whole).slope);
    assert_true(nt_session_guarantee(led).force == nt_session_guarantee(whole).force);
    setup = over_a_ramp();
    setup.rig.stage.axes = 1.0;
    setup.x = 450e-9; /* on the ramp */
    nt_session *stands = open_session(&setup);
    const nt_guarantee there = nt_session_guarantee(stands);
    assert_true(fabs(nt_session_reach(stands).slope - 0.05) < 0.002 && nt_session_reach(stands).relief < 1e-12);
    assert_true(there.lateral_force >= 0.0498 * there.force);
    nt_session_close(stands);
    nt_session_close(led);
    nt_session_close(whole);
}

/* Where nothing else leads, a path holds what leads the tip: inputs, and requests, which are checked by the same call.
 */
static void what_lies_beside_a_declared_path_is_refused(void **state)
{
    (void)state;
    static const double level[] = {50e-9, 300e-9, 150e-9, 310e-9};
    nt_session_setup setup = over_a_ramp();
    setup.path = level;
    setup.path_count = 2;
    nt_session *session = open_session(&setup);
    const nt_input on = {.x = 100e-9, .y = 305e-9}, off = {.x = 151e-9, .y = 305e-9}, above = {.x = 1e-7, .y = 4e-7};
    nt_problem problem = {0};
    assert_int_equal(nt_session_aim(session, &on, NULL), NT_OK);
    assert_int_equal(nt_session_aim(session, &off, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "input.x beside the declared path");
    assert_true(problem.minimum == level[0] && problem.maximum == level[2]);
    assert_int_equal(nt_session_aim(session, &above, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "input.y beside the declared path");
    nt_session_close(session);
}

/* The promise is nt_guarantee_compute's for the slope of the reach and the plan's jump and stiffness. */
static void the_promise_knows_the_slope(void **state)
{
    (void)state;
    const nt_session_setup setup = over_a_ramp();
    nt_session *session = open_session(&setup);
    const nt_plan *plan = nt_session_plan(session);
    nt_hazard hazard =
        nt_hazard_of(plan, &setup.rig, &setup.settings, nt_session_reach(session).slope, setup.clearance);
    const nt_guarantee with = nt_session_guarantee(session);
    assert_true(with.force == nt_guarantee_compute(&setup.rig, &setup.settings, &hazard).force);
    hazard.slope = 0.0;
    assert_true(with.force > nt_guarantee_compute(&setup.rig, &setup.settings, &hazard).force);
    nt_session_close(session);
}

/* NaN: what the surface rises above the clearance, at the master's scale. A number: that. */
static void the_master_has_room_to_draw_back(void **state)
{
    (void)state;
    nt_session_setup setup = over_a_ramp();
    const double low = -0.4 * setup.rig.master.travel, alpha_p = setup.settings.gains.alpha_p;
    nt_session *session = open_session(&setup);
    const double rise = nt_session_reach(session).rise;
    assert_true(rise > setup.clearance);
    assert_true(nt_session_master_start(session) == low + (rise - setup.clearance) / alpha_p);
    nt_session_close(session);
    setup.rise = 20e-9;
    session = open_session(&setup);
    assert_true(nt_session_master_start(session) == low + (20e-9 - setup.clearance) / alpha_p);
    nt_session_close(session);
    setup.rise = 0.0;
    session = open_session(&setup);
    assert_true(nt_session_master_start(session) == low);
    nt_session_close(session);
}

static void paths_that_leave_the_surface_are_refused(void **state)
{
    (void)state;
    static const double away[] = {50e-9, 300e-9, 50e-9, 640e-9};
    nt_session_setup setup = over_a_ramp();
    nt_session *session = NULL;
    nt_problem problem = {0};
    setup.path = away;
    setup.path_count = 2;
    assert_int_equal(nt_session_open(&session, &setup, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "path.y");
    setup.path_count = 0;
    assert_int_equal(nt_session_open(&session, &setup, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "path.count");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_reach_is_that_of_the_path),
        cmocka_unit_test(what_leads_the_tip_says_where_it_goes),
        cmocka_unit_test(what_lies_beside_a_declared_path_is_refused),
        cmocka_unit_test(the_promise_knows_the_slope),
        cmocka_unit_test(the_master_has_room_to_draw_back),
        cmocka_unit_test(paths_that_leave_the_surface_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
