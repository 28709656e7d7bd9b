/* SPDX-License-Identifier: BSD-3-Clause
 * Back to a tick, and on from there as before, to the last bit. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/session.h"
#include "session_fixture.h"

enum { TICKS = 8000 };
static nt_record first[TICKS], second[TICKS];

/* In contact, the tip under way to somewhere else, with faults and a slow converter whose memories count, too. */
static nt_session *open_pressing(nt_probe_model probe_model, long ticks)
{
    static nt_faults faults;
    faults = (nt_faults){0};
    const nt_fault loud = {
        .kind = NT_FAULT_NOISE, .channel = NT_CHANNEL_DEFLECTION, .start = 0.4, .duration = 0.1, .value = 2.0};
    const nt_fault stuck = {
        .kind = NT_FAULT_STUCK, .channel = NT_CHANNEL_MASTER_POSITION, .start = 0.5, .duration = 0.002};
    assert_int_equal(nt_faults_add(&faults, &loud), NT_OK);
    assert_int_equal(nt_faults_add(&faults, &stuck), NT_OK);
    nt_session_setup setup = nt_session_defaults();
    setup.clearance = 20e-9;
    setup.preflight = 0;
    setup.minimum_margin = 0.0;
    setup.faults = &faults;
    setup.rig.master.rate = 3e3;
    setup.rig.hand.random_force = 0.3;
    setup.rig.hand.random_rate = 50.0;
    setup.probe_model = probe_model;
    nt_session *session = open_session(&setup);
    const nt_input input = {.operator_force = {[NT_Z] = 1.0}, .x = 1e-7, .duration = 0.6};
    assert_int_equal(nt_session_aim(session, &input, NULL), NT_OK);
    run(session, first, ticks);
    return session;
}

static void it_goes_on_to_the_last_bit(void **state)
{
    (void)state;
    static const struct {
        nt_probe_model model;
        long begin, ticks;
    } cases[] = {{NT_PROBE_QUASI_STATIC, 4000, TICKS}, {NT_PROBE_DYNAMIC, 200, 300}}; /* which is slow */
    for (int i = 0; i < 2; i++) {
        const long begin = cases[i].begin, ticks = cases[i].ticks;
        nt_session *session = open_pressing(cases[i].model, begin);
        nt_snapshot *snapshot = NULL;
        assert_int_equal(nt_session_snapshot(session, &snapshot), NT_OK);
        run(session, first, ticks);
        for (int again = 0; again < 2; again++) { /* as often as one likes */
            assert_int_equal(nt_session_restore(session, snapshot, NULL), NT_OK);
            assert_int_equal(nt_session_touch_state(session)->ticks, begin);
            run(session, second, ticks);
            assert_memory_equal(first, second, (size_t)ticks * sizeof *first);
        }
        nt_event events[4];
        assert_int_equal(nt_session_read_events(session, events, 4), 3); /* the aim, and both rewinds */
        assert_int_equal(events[2].kind, NT_EVENT_REWIND);
        assert_true(events[2].tick == (uint64_t)(begin + ticks) && events[2].value[0] == (double)begin);
        assert_true(events[1].value[1] == 1.0 && events[2].value[1] == 1.0); /* the aim was kept by then */
        nt_snapshot_close(snapshot);
        nt_session_close(session);
    }
}

/* Mode and scales go back with it; what was changed has to be changed back first. */
static void changes_have_to_be_taken_back(void **state)
{
    (void)state;
    nt_session *session = open_pressing(NT_PROBE_QUASI_STATIC, 4000);
    nt_snapshot *snapshot = NULL;
    assert_int_equal(nt_session_snapshot(session, &snapshot), NT_OK);
    run(session, first, TICKS);
    const nt_settings *settings = &nt_session_touch(session)->settings;
    const double gain = settings->gains.force_gain, modulus = nt_session_setup_of(session)->scene.sample.youngs_modulus;
    assert_int_equal(nt_session_set_mode(session, NT_MODE_CURVE, NULL), NT_OK);
    for (int i = 1; i < 4; i++) { /* more than one: memory is used again */
        assert_int_equal(nt_session_change(session, NT_EVENT_SETTING, "gains.force_gain", gain + 0.1 * i, NULL), NT_OK);
        assert_int_equal(nt_session_restore(session, snapshot, NULL), NT_E_STATE);
    }
    assert_int_equal(nt_session_change(session, NT_EVENT_SETTING, "gains.force_gain", gain, NULL), NT_OK);
    assert_int_equal(nt_session_change(session, NT_EVENT_SCENE, "sample.youngs_modulus", 0.9 * modulus, NULL), NT_OK);
    assert_int_equal(nt_session_restore(session, snapshot, NULL), NT_E_STATE);
    assert_int_equal(nt_session_change(session, NT_EVENT_SCENE, "sample.youngs_modulus", modulus, NULL), NT_OK);
    assert_int_equal(nt_session_restore(session, snapshot, NULL), NT_OK);
    run(session, second, TICKS);
    assert_memory_equal(first, second, sizeof first);
    nt_snapshot_close(snapshot);
    nt_session_close(session);
}

/* A session that was opened with the same setup goes on from there as the first one does: a copy. */
static void a_snapshot_makes_a_copy(void **state)
{
    (void)state;
    nt_session *one = open_pressing(NT_PROBE_QUASI_STATIC, 4000), *other = open_pressing(NT_PROBE_QUASI_STATIC, 10);
    nt_snapshot *snapshot = NULL;
    assert_int_equal(nt_session_snapshot(one, &snapshot), NT_OK);
    run(one, first, TICKS);
    nt_session_close(one);
    assert_int_equal(nt_session_restore(other, snapshot, NULL), NT_OK);
    run(other, second, TICKS);
    assert_memory_equal(first, second, sizeof first);
    nt_session_close(other);
    nt_session_setup setup = nt_session_defaults();
    setup.rig.probe.spring_constant *= 2.0;
    other = open_session(&setup);
    assert_int_equal(nt_session_restore(other, snapshot, NULL), NT_E_STATE); /* another rig */
    nt_session_close(other);
    nt_snapshot_close(snapshot);
    nt_snapshot_close(NULL);
}

/* While it runs: back by a quarter of a second at least, then the ticks between are run again, the same. */
static void a_running_session_goes_back(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    setup.ring_capacity = 1L << 17;
    nt_session *session = open_session(&setup);
    assert_int_equal(nt_session_rewind(session, 0.1, NULL), NT_E_UNSUPPORTED); /* it keeps no history yet */
    assert_int_equal(nt_session_start(session, NT_PACE_FREE, 30000), NT_OK);
    while (nt_session_progress(session).ticks < 30000)
        continue;
    assert_int_equal(nt_session_halt(session), NT_OK);
    nt_problem problem = {0};
    assert_int_equal(nt_session_rewind(session, -1.0, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "rewind");
    assert_int_equal(nt_session_rewind(session, 1.1, NULL), NT_OK);
    assert_int_equal(nt_session_touch_state(session)->ticks, 17500); /* a quarter of a second before 19 000 */
    static nt_record records[50000];
    assert_int_equal(nt_session_advance(session, 12500), NT_OK);
    assert_int_equal(nt_session_read(session, records, 50000), 42500);
    assert_memory_equal(&records[17500], &records[30000], 12500 * sizeof *records);
    nt_session_close(session);
}

/* Events that nobody reads are never lost in silence: an input is refused. Where nothing is recorded none is kept, and
 * a loop may go on for ever. */
static void events_are_kept_or_refused(void **state)
{
    (void)state;
    for (int recorded = 0; recorded < 2; recorded++) {
        nt_session_setup setup = nt_session_defaults();
        setup.ring_capacity = recorded ? 65536 : 0;
        nt_session *session = open_session(&setup);
        const nt_input input = {.duration = 0.1};
        nt_frame frame;
        nt_status status = NT_OK;
        int steps = 0;
        for (; steps < 6000 && status == NT_OK; steps++)
            status = nt_session_step(session, &input, &frame);
        assert_int_equal(status, recorded ? NT_E_CAPACITY : NT_OK);
        assert_int_equal(steps, recorded ? 4097 : 6000);
        assert_int_equal(nt_session_clutch(session, 1), recorded ? NT_E_CAPACITY : NT_OK);
        nt_event event;
        assert_int_equal(nt_session_read_events(session, &event, 1), recorded);
        assert_int_equal(nt_session_clutch(session, 1), NT_OK); /* there is room again */
        nt_session_close(session);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_goes_on_to_the_last_bit), cmocka_unit_test(changes_have_to_be_taken_back),
        cmocka_unit_test(a_snapshot_makes_a_copy),    cmocka_unit_test(a_running_session_goes_back),
        cmocka_unit_test(events_are_kept_or_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
