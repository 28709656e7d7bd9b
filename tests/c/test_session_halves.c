/* SPDX-License-Identifier: BSD-3-Clause
 * The halves of a session: a master without a motor at its own slow rate, one of three axes, halves of one's own, and
 * what is refused when they do not fit the rig. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/rig.h"
#include "device_fixture.h"
#include "internal/session.h"
#include "larger.h"
#include "session_fixture.h"

enum { MOST = 65536 };
static nt_record records[MOST];

/* A mouse: positions, 125 times a second. */
static nt_session_setup held_setup(void)
{
    nt_session_setup setup = nt_session_defaults();
    setup.rig.master.gauge = setup.rig.master.motor = 0;
    setup.rig.master.rate = 125.0;
    setup.settings = nt_settings_defaults(&setup.rig);
    const nt_gains *gains = &setup.settings.gains;
    const double reflected = gains->alpha_f * gains->alpha_p * setup.rig.probe.spring_constant; /* k_c at the hand */
    setup.settings.gains.coupling_stiffness = 2.0 * reflected;
    setup.settings.gains.coupling_damping = 0.05 * reflected;
    setup.clearance = 20e-9;
    return setup;
}

static void hold_at(nt_session *session, double position, double duration)
{
    const nt_input input = {.master_position = {[NT_Z] = nt_session_master_start(session) + position},
                            .holds = 1,
                            .x = (double)NAN,
                            .y = (double)NAN,
                            .duration = duration};
    assert_int_equal(nt_session_aim(session, &input, NULL), NT_OK);
}

/* Down by 100 nm, 80 of them into the surface: RUN all the while, and at rest there the force stands still. */
static void a_held_master_touches(void **state)
{
    (void)state;
    const nt_session_setup setup = held_setup();
    const double depth = 100e-9, alpha_p = setup.settings.gains.alpha_p;
    nt_session *session = open_session(&setup);
    const nt_capabilities *can = nt_session_capabilities(session, NT_HALF_MASTER);
    assert_true(can->period == 1.0 / 125.0 && !(can->can & (NT_CAN_PUSH | NT_CAN_FEEL)));
    assert_true(nt_session_margins(session).margin > 0.0);
    hold_at(session, depth / alpha_p, 1.0);
    run(session, records, 30000);
    double oldest = 0.0, low = HUGE_VAL, high = -HUGE_VAL;
    int positions = 0;
    for (int k = 0; k < 30000; k++) {
        const nt_record *r = &records[k];
        assert_int_equal(r->state, NT_RUN);
        assert_true(isnan(r->operator_force[NT_Z]));
        oldest = larger(oldest, r->master_age);
        positions += k > 0 && k < 10000 && r->master_position[NT_Z] != records[k - 1].master_position[NT_Z];
        if (k >= 25000) {
            low = smaller(low, r->tip_force[NT_Z]);
            high = larger(high, r->tip_force[NT_Z]);
        }
    }
    assert_true(oldest > 78e-4 && oldest < 80e-4); /* of 80 ticks the last one: 79 periods old */
    assert_in_range(positions, 120, 125);          /* as often as it measures, no more */
    const double k_c = setup.rig.probe.spring_constant;
    print_message("force at rest %.1f .. %.1f nN\n", 1e9 * low, 1e9 * high);
    assert_true(low > 0.5 * k_c * 40e-9); /* the coupling of twice k_c takes a third of 80 nm */
    /* nothing oscillates: the tip moves by less than its force is read to, peak to peak */
    assert_true(high - low < 6.0 * nt_probe_force_noise(&setup.rig.probe));
    nt_session_close(session);
}

/* Without a motor or a coupling the stage's integral is the only loop; beyond its limit the stage oscillates. */
static void its_margin_is_that_of_the_stage(void **state)
{
    (void)state;
    nt_session_setup setup = held_setup();
    setup.settings.gains.coupling_stiffness = setup.settings.gains.coupling_damping = 0.0;
    setup.minimum_margin = 0.0;
    setup.preflight = 0;
    nt_margins margins;
    nt_verdict verdict = nt_margins_judge(&setup.rig, &setup.settings, 100.0, NT_MODE_TOUCH, &margins);
    assert_string_equal(verdict.rule, "stage integral");
    assert_true(verdict.margin == margins.integral_limit / setup.settings.gains.stage_integral);
    const double shares[] = {0.8, 1.25};
    for (int i = 0; i < 2; i++) {
        setup.settings.gains.stage_integral = shares[i] * margins.integral_limit;
        nt_session *session = open_session(&setup);
        hold_at(session, 5e-9 / setup.settings.gains.alpha_p, 0.01);
        run(session, records, 10000);
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int k = 5000; k < 10000; k++) {
            low = smaller(low, records[k].stage_position[NT_Z]);
            high = larger(high, records[k].stage_position[NT_Z]);
        }
        print_message("integral at %.2f of its limit: stage within %.1f nm\n", shares[i], 1e9 * (high - low));
        assert_int_equal(high - low > 20e-9, shares[i] > 1.0);
        nt_session_close(session);
    }
    setup.settings.gains.stage_integral = 0.0;
    verdict = nt_margins_judge(&setup.rig, &setup.settings, 100.0, NT_MODE_TOUCH, &margins);
    assert_true(isinf(verdict.margin));
    assert_string_equal(verdict.rule, "none: no loop is closed");
}

/* A coupling closes one through its own spring. */
static void its_margin_is_that_of_the_coupling(void **state)
{
    (void)state;
    nt_session_setup setup = held_setup();
    setup.settings.gains.stage_integral = 0.0;
    nt_session *session = open_session(&setup);
    const double stiffness = nt_session_plan(session)->maximum_stiffness;
    nt_margins margins;
    const nt_verdict verdict = nt_margins_judge(&setup.rig, &setup.settings, stiffness, NT_MODE_TOUCH, &margins);
    assert_string_equal(verdict.rule, "virtual coupling");
    assert_true(verdict.margin > setup.minimum_margin);
    nt_session_close(session);
    setup.settings.gains.coupling_stiffness *= 0.1; /* a fifth of k_c at the hand, and nearly no damper */
    setup.settings.gains.coupling_damping *= 1e-3;
    nt_problem problem = {0};
    assert_int_equal(nt_session_open(&session, &setup, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "stability margin (virtual coupling)");
    assert_true(problem.value < setup.minimum_margin && problem.minimum == setup.minimum_margin);
}

/* Three axes: x and y go with the hand, as z does. */
static void a_master_of_three_axes_leads_the_tip(void **state)
{
    (void)state;
    nt_session_setup setup = held_setup();
    setup.rig.master.axes = 3.0;
    setup.clearance = 0.5e-6;
    nt_session *session = open_session(&setup);
    const double alpha_p = setup.settings.gains.alpha_p, start = nt_session_master_start(session);
    const nt_input input = {.master_position = {0.2e-6 / alpha_p, -0.1e-6 / alpha_p, start + 0.05e-6 / alpha_p},
                            .holds = 1,
                            .x = (double)NAN,
                            .y = (double)NAN,
                            .duration = 1.0};
    run(session, records, 2000); /* the force fades in first */
    assert_int_equal(nt_session_aim(session, &input, NULL), NT_OK);
    run(session, records, 20000);
    const nt_record *last = &records[19999];
    assert_true(fabs(last->stage_command[NT_X] - 0.2e-6) < 1e-12);
    assert_true(fabs(last->stage_command[NT_Y] + 0.1e-6) < 1e-12);
    assert_true(fabs(last->stage_command[NT_Z] - 0.05e-6) < 2e-9); /* read and driven in steps */
    assert_true(last->stage_position[NT_X] == last->stage_command[NT_X]);
    const double most = setup.settings.limits.lateral_speed / setup.settings.gains.rate;
    for (int k = 1; k < 20000; k++) {
        assert_int_equal(records[k].state, NT_RUN);
        const double dx = records[k].stage_command[NT_X] - records[k - 1].stage_command[NT_X];
        const double dy = records[k].stage_command[NT_Y] - records[k - 1].stage_command[NT_Y];
        assert_true(hypot(dx, dy) <= most * (1.0 + 1e-9));
    }
    nt_session_close(session);
}

/* A master of one's own that has been pressed on, then says nothing more. */
typedef struct mute_master {
    int64_t (*now)(const nt_host *host);
    const nt_host *host;
    uint64_t sequence, last; /* silent after the last one; 0: never */
    double motor_force;
    int closes;
} mute_master;

static nt_status open_mute(void *context, const nt_host *host, nt_problem *problem)
{
    (void)problem;
    ((mute_master *)context)->host = host;
    return NT_OK;
}

static nt_status read_mute(void *context, nt_reading *reading)
{
    mute_master *m = context;
    if (m->last != 0 && m->sequence >= m->last)
        return NT_OK; /* nothing new */
    ++m->sequence;
    *reading = (nt_reading){.size = sizeof *reading,
                            .sequence = m->sequence,
                            .time = m->host->now(m->host),
                            .position = {[NT_Z] = smaller(2e-3, 1e-6 * (double)m->sequence)},
                            .felt = {[NT_Z] = 0.0},
                            .valid = 1u << (NT_READS_POSITION + NT_Z) | 1u << (NT_READS_FELT + NT_Z)};
    return NT_OK;
}

static nt_status write_mute(void *context, const nt_action *action)
{
    ((mute_master *)context)->motor_force = action->target[NT_Z];
    return NT_OK;
}

static void close_mute(void *context)
{
    ++((mute_master *)context)->closes;
}

static const nt_backend mute_backend = {.size = sizeof mute_backend,
                                        .version = NT_HAL_API_VERSION,
                                        .name = "mute",
                                        .half = NT_HALF_MASTER,
                                        .open = open_mute,
                                        .read = read_mute,
                                        .write = write_mute,
                                        .close = close_mute};

/* HOLD after two of its own periods, not sooner and not later; the force fades; RUN when it speaks again. */
static void a_master_that_falls_silent(void **state)
{
    (void)state;
    for (int slow = 0; slow < 2; slow++) {
        mute_master m = {0};
        nt_session_setup setup = nt_session_defaults();
        setup.rig.master.rate = slow ? 125.0 : 0.0;
        setup.minimum_margin = 0.0;
        setup.preflight = 0;
        setup.clearance = 20e-9;
        setup.master = (nt_hal_choice){&mute_backend, &m};
        nt_session *session = open_session(&setup);
        assert_int_equal(nt_session_capabilities(session, NT_HALF_MASTER)->axes, 1);
        run(session, records, 10000);
        assert_int_equal(records[9999].state, NT_RUN);
        assert_true(records[9999].motor_force[NT_Z] < -0.1); /* it pushes back */
        m.last = m.sequence;
        run(session, records, 5000);
        const int held = slow ? 161 : 3; /* ages of 1 T, 2 T, .. follow the last reading, which was 0 old */
        for (int k = 0; k < 5000; k++) {
            const int is_stale = k >= held - 1;
            assert_int_equal(records[k].state, is_stale ? NT_HOLD : NT_RUN);
            assert_int_equal(records[k].reasons & NT_REASON_MASTER_STALE, is_stale ? NT_REASON_MASTER_STALE : 0);
        }
        assert_true(fabs(records[4999].motor_force[NT_Z]) < 1e-6 && m.motor_force == records[4999].motor_force[NT_Z]);
        assert_true(fabs(records[4999].stage_command[NT_Z] - records[held + 1].stage_command[NT_Z]) < 10e-9);
        m.last = 0;
        run(session, records, 3000);
        assert_int_equal(records[2999].state, NT_RUN);
        assert_true(records[2999].motor_force[NT_Z] < -0.1);
        nt_session_close(session);
        assert_int_equal(m.closes, 1);
    }
}

static void expect_refusal(const nt_session_setup *setup, nt_status status, const char *field)
{
    nt_session *session = NULL;
    nt_problem problem = {0};
    assert_int_equal(nt_session_open(&session, setup, &problem), status);
    assert_string_equal(problem.field ? problem.field : "", field);
    assert_null(session);
}

/* Closed again after each refusal. */
static void halves_that_do_not_fit_the_rig_are_refused(void **state)
{
    (void)state;
    const nt_backend hand = backend_of(NT_HALF_MASTER), probe = backend_of(NT_HALF_SLAVE);
    const struct {
        nt_capabilities says;
        const char *field;
    } cases[] = {
        {{.can = NT_CAN_PUSH | NT_CAN_FEEL, .axes = 1, .period = 1e-2}, "master.rate (of the loop where it is 0)"},
        {{.can = NT_CAN_PUSH, .axes = 1}, "master.gauge (this master measures no force)"},
        {{.can = NT_CAN_FEEL, .axes = 1}, "master.motor (this master has none)"},
    };
    nt_session_setup setup = nt_session_defaults();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        device d = {.describes_itself = 1, .says = cases[i].says};
        setup.master = (nt_hal_choice){&hand, &d};
        expect_refusal(&setup, NT_E_RANGE, cases[i].field);
        assert_string_equal(d.calls, "odC");
    }
    device d = {.describes_itself = 1, .says = {.can = NT_CAN_PUSH | NT_CAN_FEEL, .axes = 1}};
    setup.master = (nt_hal_choice){&hand, &d};
    setup.rig.master.axes = 3.0;
    expect_refusal(&setup, NT_E_RANGE, "master.axes (this master has fewer)");
    setup = nt_session_defaults();
    device e = {.describes_itself = 1, .says = {.can = NT_CAN_FEEL, .axes = 3, .period = 1e-3}};
    setup.slave = (nt_hal_choice){&probe, &e};
    expect_refusal(&setup, NT_E_RANGE, "gains.rate");
    assert_string_equal(e.calls, "odC");
    d = (device){.describes_itself = 1, .says = {.can = NT_CAN_PUSH | NT_CAN_FEEL | NT_LEADS_CLOCK, .axes = 1}};
    e = (device){.describes_itself = 1, .says = {.can = NT_CAN_FEEL | NT_LEADS_CLOCK, .axes = 3}};
    setup.master = (nt_hal_choice){&hand, &d};
    expect_refusal(&setup, NT_E_RANGE, "halves that lead the clock");
    d = (device){.opens = NT_E_DEVICE};
    expect_refusal(&setup, NT_E_DEVICE, "no such line");
    assert_string_equal(d.calls, "oC");
}

/* A master that gives no position cannot say where the stage is to follow from. */
static void a_master_without_a_position_is_refused(void **state)
{
    (void)state;
    const nt_backend hand = backend_of(NT_HALF_MASTER);
    device d = {0};
    nt_session_setup setup = nt_session_defaults();
    setup.master = (nt_hal_choice){&hand, &d};
    expect_refusal(&setup, NT_E_DEVICE, "the master's first reading along z");
    assert_string_equal(d.calls, "odcarDC");
}

static void paces_that_a_half_cannot_keep_are_refused(void **state)
{
    (void)state;
    const nt_backend hand = backend_of(NT_HALF_MASTER);
    nt_session_setup setup = nt_session_defaults();
    setup.preflight = 0;
    for (int real = 0; real < 2; real++) {
        device d = {.describes_itself = 1,
                    .says = {.can = NT_CAN_PUSH | NT_CAN_FEEL | (real ? NT_IS_REAL : NT_IS_SLOW), .axes = 1},
                    .next = reading_of(1)};
        d.next.position[NT_Z] = d.next.felt[NT_Z] = 0.0;
        setup.master = (nt_hal_choice){&hand, &d};
        nt_session *session = open_session(&setup);
        assert_true(nt_session_master_start(session) == 0.0);
        assert_int_equal(nt_session_advance(session, 1), real ? NT_E_UNSUPPORTED : NT_OK);
        const nt_pace refused[] = {NT_PACE_HARD, NT_PACE_FREE}; /* a real master on a simulated slave: wall */
        assert_int_equal(nt_session_start(session, refused[real], 1), NT_E_UNSUPPORTED);
        const nt_input input = {.operator_force = {[NT_Z] = 1.0}, .duration = 1.0};
        nt_problem problem = {0};
        assert_int_equal(nt_session_aim(session, &input, &problem), NT_E_UNSUPPORTED); /* its hand is real */
        assert_string_equal(problem.field,
                            "input.operator_force of a device, which a hand leads (x and y of the tip may "
                            "be scripted)");
        nt_snapshot *snapshot = NULL;
        assert_int_equal(nt_session_snapshot(session, &snapshot), NT_E_UNSUPPORTED);
        nt_session_close(session);
    }
}

/* A real slave is armed with a force whose bound is known, and with no other; a simulated one takes both. */
static void a_real_slave_wants_a_bound(void **state)
{
    (void)state;
    const nt_backend stage = backend_of(NT_HALF_SLAVE);
    for (int real = 0; real < 2; real++)
        for (int known = 0; known < 2; known++) {
            device d = {.describes_itself = 1, .says = {.can = NT_CAN_FEEL | (real ? NT_IS_REAL : 0u), .axes = 1}};
            nt_session_setup setup = nt_session_defaults();
            setup.preflight = 0;
            setup.rig.stage.axes = 1.0;
            setup.slave = (nt_hal_choice){&stage, &d};
            setup.scene.medium.relative_humidity = 0.0;
            setup.scene.adhesion.hamaker_constant = known ? 1e-21 : 1e-17; /* alone it pulls more than all of w */
            setup.demand = (nt_demand){.relative_accuracy = 0.3, .bound = NT_BOUND_ANY};
            nt_session *session = NULL;
            nt_problem problem = {0};
            const nt_status status = nt_session_open(&session, &setup, &problem);
            if (real && !known) {
                assert_int_equal(status, NT_E_RANGE);
                assert_int_equal(problem.code, NT_PROBLEM_BOUND_OF_REAL_SLAVE);
                assert_null(session);
                assert_null(strchr(d.calls, 'a')); /* never armed */
            } else {
                assert_int_equal(status, NT_OK);
                nt_session_close(session);
            }
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_held_master_touches),
        cmocka_unit_test(a_real_slave_wants_a_bound),
        cmocka_unit_test(its_margin_is_that_of_the_stage),
        cmocka_unit_test(its_margin_is_that_of_the_coupling),
        cmocka_unit_test(a_master_of_three_axes_leads_the_tip),
        cmocka_unit_test(a_master_that_falls_silent),
        cmocka_unit_test(halves_that_do_not_fit_the_rig_are_refused),
        cmocka_unit_test(a_master_without_a_position_is_refused),
        cmocka_unit_test(paces_that_a_half_cannot_keep_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
