/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/rig.h"
#include "larger.h"
#include "nanotouch/nanotouch.h"

enum { MOST = 65536 };
static nt_record records[MOST], others[MOST];

static nt_session *open_session(const nt_session_setup *setup)
{
    nt_session *session = NULL;
    nt_problem problem = {0};
    if (nt_session_open(&session, setup, &problem) != NT_OK)
        fail_msg("%s", problem.field ? problem.field : "?");
    return session;
}

/* Neither force nor indentation leaves what was promised. */
static void check_promise(const nt_session *session, long count)
{
    const nt_guarantee promised = nt_session_guarantee(session);
    for (long k = 0; k < count; k++)
        assert_true(fabs(records[k].tip_force[NT_Z]) < promised.force && -records[k].gap < promised.indentation);
}

/* The hand goes to `force` in `duration`; returns the records of the `time` from then on. */
static long feel(nt_session *session, double force, double duration, double time)
{
    const nt_input input = {.operator_force[NT_Z] = force, .duration = duration};
    assert_int_equal(nt_session_aim(session, &input, NULL), NT_OK);
    const long ticks = lround(time / nt_session_touch(session)->period);
    assert_int_equal(nt_session_advance(session, ticks), NT_OK);
    assert_int_equal(nt_session_read(session, records, MOST), ticks);
    check_promise(session, ticks);
    return ticks;
}

/* From approach to hard pressing to pull-off at the defaults: nothing but RUN, forces inside the limits, snap-in,
 * contact and pull-off as the plan has them. */
static void a_touch_from_approach_to_pull_off(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    setup.settings = nt_settings_defaults(&setup.rig); /* it may press as hard as the rig can */
    nt_session *session = open_session(&setup);
    const nt_plan *plan = nt_session_plan(session);
    static const double script[][2] = {{0.2, 3.0}, {2.0, 3.0}, {-0.3, 4.0}};
    double strongest_push = 0.0, strongest_pull = 0.0, snap = 0.0, read_pull = 0.0, last_force = 0.0;
    int contacts = 0, releases = 0, touching = 0;
    for (int i = 0; i < 3; i++) {
        const long count = feel(session, script[i][0], 0.5, script[i][1]);
        for (long k = 0; k < count; k++) {
            const nt_record *r = &records[k];
            assert_int_equal(r->state, NT_RUN);
            assert_int_equal(r->reasons & ~(uint32_t)NT_REASON_COMMAND_LIMITED, 0);
            if (!touching && r->contact_radius > 0.0)
                contacts++, snap = -r->tip_force[NT_Z];
            if (touching && r->contact_radius == 0.0)
                releases++;
            touching = r->contact_radius > 0.0;
            strongest_push = larger(strongest_push, r->tip_force[NT_Z]);
            strongest_pull = larger(strongest_pull, -r->tip_force[NT_Z]);
            read_pull = larger(read_pull, -r->slave_force);
            last_force = r->tip_force[NT_Z];
        }
    }
    assert_true(contacts == 1 && releases == 1 && !touching);
    assert_true(strongest_push > 0.5e-6 && strongest_push < setup.settings.limits.force);
    print_message("snap-in %.2f nN, pull-off %.2f nN, read %.2f nN; plan %.2f nN\n", 1e9 * snap, 1e9 * strongest_pull,
                  1e9 * read_pull, 1e9 * plan->pull_off_force);
    /* the meniscus forms at the capture gap; the tip falls to the surface, a fraction of 1 nm into it, and the spring,
     * whose base has stayed, is drawn out by that */
    const double k_c = setup.rig.probe.spring_constant;
    assert_true(snap > k_c * plan->capture_gap && snap < k_c * (plan->capture_gap + 0.2e-9));
    /* pull-off: a spring of 8 N/m on a meniscus of 18 nN over 1.1 nm: softer, so nearly a dead weight, but read in
     * ticks */
    assert_true(strongest_pull > 0.95 * plan->pull_off_force && strongest_pull < plan->pull_off_force * (1.0 + 1e-9));
    /* as the probe reads it: within its noise, of which 1e5 samples show 4.5 sigma and one step */
    const double noise = nt_probe_force_noise(&setup.rig.probe);
    assert_true(fabs(read_pull - strongest_pull) < 6.0 * noise);
    assert_true(fabs(last_force) < 1e-12);
    nt_session_close(session);
}

/* At rest f_m = alpha_f f_s for any K_f. The mean of 8000 samples; noise of the tip: 0.04 N/sqrt(8000). */
static void forces_agree_at_rest_for_any_gain(void **state)
{
    (void)state;
    static const double gains[] = {0.0, 0.5, 2.0, 10.0, 50.0}, forces[] = {0.8, 2.313, 3.1};
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 3; j++) {
            nt_session_setup setup = nt_session_defaults();
            setup.settings = nt_settings_defaults(&setup.rig); /* it may press as hard as the rig can */
            setup.settings.gains.force_gain = gains[i];
            setup.clearance = 20e-9;
            setup.seed = (uint64_t)(10 * i + j);
            nt_session *session = open_session(&setup);
            feel(session, forces[j], 1.0, 3.0); /* free motion at K_f = 0: 10 mm/s */
            feel(session, forces[j], 0.0, 3.0);
            const long count = feel(session, forces[j], 0.0, 0.8);
            double f_m = 0.0, f_s = 0.0;
            for (long k = 0; k < count; k++) {
                f_m += records[k].operator_force[NT_Z] / (double)count;
                f_s += setup.settings.gains.alpha_f * records[k].tip_force[NT_Z] / (double)count;
            }
            print_message("K_f %4.1f: f_m %.4f N, alpha_f f_s %.4f N\n", gains[i], f_m, f_s);
            assert_true(fabs(f_m - f_s) < 0.0105); /* half a step of the gauge: 2.313 N is read as 2.32 N */
            assert_true(fabs(forces[j] - f_s) < 0.0105);
            nt_session_close(session);
        }
}

/* At rest in contact the loop is quiet: the master does not wander, the force shows the sensors' noise through the law
 * (R5). */
static void the_loop_is_quiet_at_its_defaults(void **state)
{
    (void)state;
    const nt_session_setup setup = nt_session_defaults();
    nt_session *session = open_session(&setup);
    feel(session, 1.0, 0.5, 4.0);
    const long count = feel(session, 1.0, 0.0, 2.0);
    double low = HUGE_VAL, high = -HUGE_VAL, mean = 0.0, square = 0.0;
    for (long k = 0; k < count; k++) {
        low = smaller(low, records[k].master_position[NT_Z]);
        high = larger(high, records[k].master_position[NT_Z]);
        mean += records[k].motor_force[NT_Z] / (double)count;
    }
    for (long k = 0; k < count; k++)
        square += (records[k].motor_force[NT_Z] - mean) * (records[k].motor_force[NT_Z] - mean) / (double)count;
    assert_true(high - low < 3.1 * setup.rig.master.resolution);
    const nt_margins margins = nt_session_margins(session);
    print_message("motor noise %.4f N RMS, R5 says %.4f; margin %.1f\n", sqrt(square), margins.force_noise,
                  margins.margin);
    assert_true(sqrt(square) < hypot(1.2 * margins.force_noise, margins.quantisation_step));
    assert_true(margins.margin > 1.5);
    nt_session_close(session);
}

static void run_script(uint64_t seed, nt_record *out)
{
    nt_session_setup setup = nt_session_defaults();
    setup.seed = seed;
    nt_session *session = open_session(&setup);
    const nt_input inputs[] = {{.operator_force[NT_Z] = 1.0, .duration = 0.3},
                               {.operator_force[NT_Z] = -0.5, .x = 1e-6, .duration = 0.2}};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(nt_session_aim(session, &inputs[i], NULL), NT_OK);
        assert_int_equal(nt_session_advance(session, 15000), NT_OK);
    }
    assert_int_equal(nt_session_read(session, out, 30000), 30000);
    nt_session_close(session);
}

static void the_same_seed_gives_the_same_record(void **state)
{
    (void)state;
    memset(records, 0, sizeof records);
    memset(others, 0, sizeof others);
    run_script(5, records);
    run_script(5, others);
    assert_memory_equal(records, others, 30000 * sizeof *records);
    run_script(6, others);
    assert_memory_not_equal(records, others, 30000 * sizeof *records);
}

/* In blocks of any size, read in blocks of any other: the same record as at one go, no tick lost or twice. */
static void blocks_make_no_difference(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    run_script(1, records);
    setup.ring_capacity = 1000; /* 1024 */
    nt_session *session = open_session(&setup);
    const nt_input inputs[] = {{.operator_force[NT_Z] = 1.0, .duration = 0.3},
                               {.operator_force[NT_Z] = -0.5, .x = 1e-6, .duration = 0.2}};
    long done = 0, got = 0;
    for (int block = 0; done < 30000; block++) {
        if (done == 0 || done == 15000)
            assert_int_equal(nt_session_aim(session, &inputs[done / 15000], NULL), NT_OK);
        long ticks = 1 + (block * 37) % 600;
        const long rest = (done < 15000 ? 15000 : 30000) - done;
        ticks = ticks < rest ? ticks : rest;
        const nt_status status = nt_session_advance(session, ticks);
        if (status == NT_OK)
            done += ticks;
        else
            assert_int_equal(status, NT_E_CAPACITY);
        got += nt_session_read(session, others + got, 1 + (block * 53) % 500);
    }
    while (got < done)
        got += nt_session_read(session, others + got, 100);
    for (long k = 0; k < 30000; k++)
        assert_int_equal(others[k].tick, k);
    assert_memory_equal(records, others, 30000 * sizeof *records);
    nt_session_close(session);
}

static void a_full_ring_runs_nothing_and_drops_nothing(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    setup.ring_capacity = 64;
    nt_session *session = open_session(&setup);
    assert_int_equal(nt_session_advance(session, 65), NT_E_CAPACITY);
    assert_int_equal(nt_session_advance(session, 60), NT_OK);
    assert_int_equal(nt_session_advance(session, 5), NT_E_CAPACITY);
    assert_int_equal(nt_session_advance(session, 4), NT_OK);
    assert_int_equal(nt_session_advance(session, 1), NT_E_CAPACITY);
    assert_int_equal(nt_session_read(session, records, 0), 0);
    assert_int_equal(nt_session_read(session, records, -3), 0);
    assert_int_equal(nt_session_read(session, records, MOST), 64);
    assert_int_equal(nt_session_advance(session, 64), NT_OK);
    assert_int_equal(nt_session_read(session, records + 64, MOST - 64), 64);
    for (int k = 0; k < 128; k++)
        assert_int_equal(records[k].tick, k);
    assert_int_equal(nt_session_advance(session, -1), NT_E_RANGE);
    assert_int_equal(nt_session_advance(session, 0), NT_OK);
    nt_session_close(session);
}

/* Pressed in full contact: LATCHED in the tick that sees the button, the force gone in 50 ms, the tip lifted; armed
 * only when confirmed; then on from where it stands. */
static void the_emergency_stop(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    setup.settings = nt_settings_defaults(&setup.rig); /* it may press as hard as the rig can */
    const nt_limits *limits = &setup.settings.limits;
    nt_session *session = open_session(&setup);
    feel(session, 2.0, 0.5, 4.0);
    const nt_record before = records[39999];
    assert_true(before.tip_force[NT_Z] > 0.3e-6);
    nt_session_emergency_stop(session, 1);
    const long count = feel(session, 2.0, 0.0, 1.0);
    for (long k = 0; k < count; k++) {
        const nt_record *r = &records[k], *last = k ? &records[k - 1] : &before;
        assert_int_equal(r->state, NT_LATCHED);
        assert_int_equal(r->reasons, NT_REASON_EMERGENCY_STOP);
        assert_true(fabs(r->motor_force[NT_Z] - last->motor_force[NT_Z]) <= limits->motor_rate * 1e-4 * (1.0 + 1e-12));
        assert_true(fabs(r->stage_command[NT_Z] - last->stage_command[NT_Z]) <= 1.1 * limits->retract_speed * 1e-4);
        if (k > 530) /* 50 ms, and the damping of the free master ends at the motor's rate */
            assert_true(r->motor_force[NT_Z] == 0.0);
    }
    assert_true(fabs(before.stage_command[NT_Z] - records[count - 1].stage_command[NT_Z] - limits->retract_distance) <
                3e-9);
    assert_true(records[count - 1].contact_radius == 0.0);
    assert_int_equal(nt_session_arm(session, 0), NT_E_STATE);
    assert_int_equal(nt_session_arm(session, 1), NT_OK);
    feel(session, 0.0, 0.0, 0.1);
    assert_int_equal(records[999].state, NT_LATCHED); /* still pressed */
    nt_session_emergency_stop(session, 0);
    feel(session, 0.0, 0.0, 0.1);
    assert_int_equal(records[999].state, NT_LATCHED);
    const double stage = records[999].stage_command[NT_Z];
    assert_int_equal(nt_session_arm(session, 1), NT_OK);
    feel(session, -0.2, 0.5, 1.0); /* the hand has pushed the uncoupled master to its end stop */
    assert_int_equal(records[0].state, NT_RUN);
    assert_true(fabs(records[0].stage_command[NT_Z] - stage) < 1e-10);
    for (int k = 1; k < 10000; k++) {
        assert_int_equal(records[k].state, NT_RUN);
        assert_true(fabs(records[k].stage_command[NT_Z] - records[k - 1].stage_command[NT_Z]) <
                    1.1 * limits->stage_speed * 1e-4);
    }
    assert_true(records[9999].stage_command[NT_Z] < stage - 10e-9); /* and it goes on */
    nt_session_close(session);
}

static void inputs_are_checked(void **state)
{
    (void)state;
    const nt_session_setup setup = nt_session_defaults();
    nt_session *session = open_session(&setup);
    const nt_input not_finite[] = {{.operator_force[NT_Z] = NAN}, {.x = HUGE_VAL}, {.y = NAN}, {.duration = NAN}};
    for (int i = 0; i < 4; i++)
        assert_int_equal(nt_session_aim(session, &not_finite[i], NULL), NT_E_NOT_FINITE);
    const nt_input back_in_time = {.duration = -1.0};
    assert_int_equal(nt_session_aim(session, &back_in_time, NULL), NT_E_RANGE);
    feel(session, 0.0, 0.0, 0.1);
    for (int k = 0; k < 1000; k++)
        assert_true(records[k].stage_position[NT_X] == 0.0 && fabs(records[k].operator_force[NT_Z]) <= 0.021);
    nt_session_close(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_touch_from_approach_to_pull_off),
        cmocka_unit_test(forces_agree_at_rest_for_any_gain),
        cmocka_unit_test(the_loop_is_quiet_at_its_defaults),
        cmocka_unit_test(the_same_seed_gives_the_same_record),
        cmocka_unit_test(blocks_make_no_difference),
        cmocka_unit_test(a_full_ring_runs_nothing_and_drops_nothing),
        cmocka_unit_test(the_emergency_stop),
        cmocka_unit_test(inputs_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
