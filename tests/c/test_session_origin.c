/* SPDX-License-Identifier: BSD-3-Clause
 * A snapshot goes back into a session of the same setup only, and what differs is named. */
// clang-format off
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
// clang-format on

#include <string.h>

#include "session_fixture.h"

static nt_record record;

static void expect_other(const nt_snapshot *snapshot, const nt_session_setup *setup, const char *field)
{
    nt_session *session = open_session(setup);
    nt_problem problem = {0};
    assert_int_equal(nt_session_restore(session, snapshot, &problem), NT_E_STATE);
    if (!problem.field || strcmp(problem.field, field) != 0)
        fail_msg("%s: the problem names %s", field, problem.field ? problem.field : "nothing");
    nt_session_close(session);
}

static void what_differs_is_named(void **state)
{
    (void)state;
    const nt_session_setup setup = nt_session_defaults();
    nt_session *session = open_session(&setup);
    nt_snapshot *snapshot = NULL;
    run(session, &record, 1);
    assert_int_equal(nt_session_snapshot(session, &snapshot), NT_OK);
#define DIFFERS(field, value, name)                                                                                    \
    do {                                                                                                               \
        nt_session_setup other = nt_session_defaults();                                                                \
        other.field = value;                                                                                           \
        expect_other(snapshot, &other, name);                                                                          \
    } while (0)
    DIFFERS(seed, 2, "seed");
    DIFFERS(probe_model, NT_PROBE_DYNAMIC, "probe_model");
    DIFFERS(preflight, 0, "preflight");
    DIFFERS(demand.relative_accuracy, 0.05, "demand.relative_accuracy");
    DIFFERS(mode, NT_MODE_APPROACH, "mode");
    DIFFERS(x, 1e-7, "x");
    DIFFERS(clearance, 0.2e-6, "clearance");
    DIFFERS(settings.gains.force_gain, 1.0, "gains.force_gain");
    DIFFERS(scene.tip.radius, 21e-9, "tip.radius");
    DIFFERS(rig.probe.spring_constant, 8.5, "probe.spring_constant");
    const double path[] = {0.0, 0.0, 1e-7, 0.0};
    nt_session_setup other = nt_session_defaults();
    other.path = path;
    other.path_count = 2;
    expect_other(snapshot, &other, "path");
    nt_faults faults = {.list = {{NT_FAULT_NOISE, NT_CHANNEL_DEFLECTION, 0.0, 0.01, 1.0}}, .count = 1};
    other = nt_session_defaults();
    other.faults = &faults;
    expect_other(snapshot, &other, "faults");
    nt_snapshot_close(snapshot);
    nt_session_close(session);
}

/* Mode and scales are part of the moment: what was judged of them comes back with it. */
static void mode_and_scales_come_back(void **state)
{
    (void)state;
    const nt_session_setup setup = nt_session_defaults();
    nt_session *session = open_session(&setup);
    const nt_margins before = nt_session_margins(session);
    const nt_gains gains = nt_session_setup_of(session)->settings.gains;
    const nt_scaling coarser = {gains.alpha_p, 0.5 * gains.alpha_f};
    nt_snapshot *snapshot = NULL;
    assert_int_equal(nt_session_snapshot(session, &snapshot), NT_OK);
    assert_int_equal(nt_session_rescale(session, &coarser, NULL), NT_OK);
    assert_int_equal(nt_session_set_mode(session, NT_MODE_TOPOGRAPHY, NULL), NT_OK);
    assert_true(nt_session_setup_of(session)->settings.gains.alpha_f == coarser.alpha_f);
    assert_int_equal(nt_session_setup_of(session)->mode, NT_MODE_TOPOGRAPHY);
    assert_true(fabs(nt_session_margins(session).loop_stiffness / before.loop_stiffness - 0.5) < 1e-12);
    assert_int_equal(nt_session_restore(session, snapshot, NULL), NT_OK);
    assert_true(nt_session_setup_of(session)->settings.gains.alpha_f == gains.alpha_f);
    assert_int_equal(nt_session_setup_of(session)->mode, setup.mode);
    const nt_margins after = nt_session_margins(session);
    assert_memory_equal(&before, &after, sizeof before);
    nt_snapshot_close(snapshot);
    nt_session_close(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_differs_is_named),
        cmocka_unit_test(mode_and_scales_come_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
