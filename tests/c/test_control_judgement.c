/* SPDX-License-Identifier: BSD-3-Clause
 * The supervisor's rules one by one, each at its border: lift, follow, stuck sensor, ages, ranges, drive of a lever
 * that taps. test_control_supervisor holds what they do together. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "control/follow.h"
#include "control/lift.h"
#include "control/stuck.h"
#include "internal/control.h"
#include "nanotouch/control.h"

/* Round numbers: a period of 1/16 s, 1 N/m, limits of some metres. */
static nt_supervisor plain(void)
{
    return (nt_supervisor){
        .master_period = 0.25,
        .period = 0.0625,
        .spring_constant = 1.0,
        .deflection_range = 64.0,
        .free_force = 1.0,
        .master_range = 8.0,
        .gauge_range = 4.0,
        .stage_range = 64.0,
        .stage_share = 0.25,
        .stage_slack = 2.0,
        .stage_most = 6.0,
        .turn_slack = 2.0,
        .lift_share = 0.5,
        .path_kept = 0.5,
        .limits = {.force = 32.0, .lateral_force = 8.0, .indentation = 16.0, .follow_time = 0.5, .retract_speed = 1.0}};
}

static nt_sample good(void)
{
    return (nt_sample){.amplitude = 1.0, .lag = 1.0};
}

static uint32_t reasons(const nt_supervisor *s, nt_supervisor_state *state, const nt_sample *sample)
{
    const nt_situation situation = {.reference = 0.0};
    nt_supervisor_step(s, state, sample, &situation);
    return state->reasons;
}

static uint32_t at_once(const nt_supervisor *s, const nt_sample *sample)
{
    nt_supervisor_state state = nt_supervisor_start();
    return reasons(s, &state, sample);
}

static void ages_at_their_borders(void **unused)
{
    (void)unused;
    const nt_supervisor s = plain();
    nt_sample sample = good();
    sample.age = 0.125;
    assert_int_equal(at_once(&s, &sample), 0u);
    sample.age = nextafter(0.125, 1.0);
    nt_supervisor_state state = nt_supervisor_start();
    assert_int_equal(reasons(&s, &state, &sample), NT_REASON_STALE);
    assert_int_equal(state.state, NT_HOLD);
    assert_int_equal(state.seen & (NT_SEES_STAGE | NT_SEES_DEFLECTION), 0u);
    sample.age = 0.3125; /* of 5 periods: it still holds */
    state = nt_supervisor_start();
    reasons(&s, &state, &sample);
    assert_int_equal(state.state, NT_HOLD);
    sample.age = nextafter(0.3125, 1.0);
    reasons(&s, &state, &sample);
    assert_int_equal(state.state, NT_RETRACT);
    sample.age = -DBL_MIN; /* a clock has jumped */
    assert_int_equal(at_once(&s, &sample), NT_REASON_INVALID);
    sample.age = (double)INFINITY;
    assert_int_equal(at_once(&s, &sample), NT_REASON_INVALID);
    sample = good();
    sample.master_age = 0.5; /* of two periods of its own */
    assert_int_equal(at_once(&s, &sample), 0u);
    sample.master_age = nextafter(0.5, 1.0);
    assert_int_equal(at_once(&s, &sample), NT_REASON_MASTER_STALE);
    sample.master_age = -DBL_MIN;
    assert_int_equal(at_once(&s, &sample), NT_REASON_MASTER_STALE);
    sample.master_age = 0.0;
    assert_int_equal(at_once(&s, &sample), 0u);
}

/* A sample of just two periods still tells where the stage is, and that nothing presses. */
static void what_an_old_sample_tells(void **unused)
{
    (void)unused;
    const nt_supervisor s = plain();
    for (int late = 0; late < 2; ++late) {
        nt_supervisor_state state = nt_supervisor_start();
        nt_sample sample = good();
        sample.age = late ? nextafter(0.125, 1.0) : 0.125;
        sample.stage_position[NT_Z] = 10.0; /* far from where it was told to be */
        uint32_t found = 0u;
        for (int k = 0; k < 3; ++k)
            found |= reasons(&s, &state, &sample);
        assert_int_equal(found & NT_REASON_FOLLOW, late ? 0u : NT_REASON_FOLLOW);
        state = nt_supervisor_start();
        state.state = NT_RETRACT;
        sample.stage_position[NT_Z] = 0.0;
        reasons(&s, &state, &sample);
        assert_int_equal(state.presses, late);
        sample.age = 0.0;
        sample.deflection[NT_Z] = 1.0;
        reasons(&s, &state, &sample);
        assert_int_equal(state.presses, 0);
        sample.deflection[NT_Z] = nextafter(1.0, 2.0);
        reasons(&s, &state, &sample);
        assert_int_equal(state.presses, 1);
    }
}

/* A reading at the end of what its sensor gives is one, anything beyond is not. */
static void readings_at_the_end_of_their_ranges(void **unused)
{
    (void)unused;
    nt_supervisor s = plain();
    s.leads_sideways = 1;
    s.amplitude = (nt_amplitude_limits){.most = 4.0, .settling = 9u, .reach = 1e9, .kept = 0.5};
    const struct {
        size_t field;
        double end;
    } cases[] = {
        {offsetof(nt_sample, master_position) + NT_X * sizeof(double), 8.0},
        {offsetof(nt_sample, master_position) + NT_Y * sizeof(double), 8.0},
        {offsetof(nt_sample, master_position) + NT_Z * sizeof(double), 8.0},
        {offsetof(nt_sample, operator_force) + NT_Z * sizeof(double), 8.0},
        {offsetof(nt_sample, stage_position) + NT_Z * sizeof(double), 64.0},
        {offsetof(nt_sample, amplitude), 8.0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        nt_sample sample = good();
        double *field = (double *)((char *)&sample + cases[i].field);
        *field = cases[i].end;
        assert_int_equal(at_once(&s, &sample) & NT_REASON_INVALID, 0u);
        *field = nextafter(cases[i].end, 1e9);
        assert_int_equal(at_once(&s, &sample) & NT_REASON_INVALID, NT_REASON_INVALID);
        *field = -cases[i].end;
        assert_int_equal(at_once(&s, &sample) & NT_REASON_INVALID, 0u);
    }
    s.gauge_range = 0.0; /* nobody looks at it */
    nt_sample sample = good();
    sample.operator_force[NT_Z] = NAN;
    assert_int_equal(at_once(&s, &sample), 0u);
    sample.deflection[NT_X] = NAN; /* nor at this, of a lever that does not show it */
    assert_int_equal(at_once(&s, &sample), 0u);
    s.lateral_stiffness = 2.0;
    assert_int_equal(at_once(&s, &sample), NT_REASON_INVALID);
    sample.deflection[NT_X] = 0.0;
    sample.deflection[NT_Y] = NAN;
    assert_int_equal(at_once(&s, &sample), NT_REASON_INVALID);
    s.lateral_stiffness = 0.0;
    sample.lag = NAN;
    assert_int_equal(at_once(&s, &sample), NT_REASON_INVALID);
    s.amplitude.most = 0.0;
    assert_int_equal(at_once(&s, &sample), 0u);
}

static void forces_at_their_limits(void **unused)
{
    (void)unused;
    nt_supervisor s = plain();
    s.lateral_stiffness = 2.0;
    nt_sample sample = good();
    sample.deflection[NT_Z] = -32.0;
    assert_int_equal(at_once(&s, &sample), 0u);
    sample.deflection[NT_Z] = nextafter(-32.0, -64.0);
    assert_int_equal(at_once(&s, &sample), NT_REASON_FORCE_LIMIT);
    s.limits.force = 100.0;
    sample.deflection[NT_Z] = -nextafter(64.0, 0.0);
    assert_int_equal(at_once(&s, &sample), 0u);
    sample.deflection[NT_Z] = -64.0;
    assert_int_equal(at_once(&s, &sample), NT_REASON_SATURATED);
    sample.deflection[NT_Z] = 0.0;
    sample.flags = NT_SAMPLE_SATURATED;
    assert_int_equal(at_once(&s, &sample), NT_REASON_SATURATED);
    sample = good();
    sample.deflection[NT_Y] = 4.0; /* times 2 N/m */
    assert_int_equal(at_once(&s, &sample), 0u);
    sample.deflection[NT_X] = 0.01;
    assert_int_equal(at_once(&s, &sample), NT_REASON_LATERAL);
    sample = good();
    sample.operator_force[NT_Z] = nextafter(-4.0, 0.0);
    assert_int_equal(at_once(&s, &sample), 0u);
    sample.operator_force[NT_Z] = -4.0;
    assert_int_equal(at_once(&s, &sample), NT_REASON_OPERATOR_CLIPPED);
}

/* From the last free reading: travel of the stage less the lever's deflection. */
static void indentation_is_travel_since_first_touch(void **unused)
{
    (void)unused;
    nt_supervisor s = plain();
    s.stage_most = s.stage_slack = 1e9;
    nt_supervisor_state state = nt_supervisor_start();
    nt_sample sample = good();
    sample.deflection[NT_Z] = 1.0; /* the free force: free */
    sample.stage_position[NT_Z] = 3.0;
    reasons(&s, &state, &sample);
    assert_true(state.surface == 2.0 && state.indentation == 0.0);
    sample.deflection[NT_Z] = 4.0;
    sample.stage_position[NT_Z] = 22.0;
    assert_int_equal(reasons(&s, &state, &sample), 0u);
    assert_true(state.surface == 2.0 && state.indentation == 16.0);
    nt_supervisor_state moved = state;
    const nt_situation sideways = {.moves_sideways = 1};
    sample.stage_position[NT_Z] = 30.0; /* over a surface that passes by: not followed */
    nt_supervisor_step(&s, &moved, &sample, &sideways);
    assert_true(moved.indentation == 16.0 && moved.surface == 10.0 && moved.state == NT_RUN);
    sample.stage_position[NT_Z] = 22.5;
    assert_int_equal(reasons(&s, &state, &sample), NT_REASON_INDENTATION);
    assert_true(state.indentation == 16.5);
}

/* Late by more than a fifth of a period five times: held until as many punctual ticks have made up for it. */
static void late_ticks_are_counted(void **unused)
{
    (void)unused;
    nt_supervisor s = plain();
    s.period = 1.0;
    nt_supervisor_state state = nt_supervisor_start();
    nt_sample sample = good();
    sample.lateness = 0.2;
    reasons(&s, &state, &sample);
    assert_int_equal(state.late_ticks, 0u);
    assert_true(state.late == 0.2);
    sample.lateness = nextafter(0.2, 1.0);
    for (uint32_t i = 1; i <= 5; ++i) {
        assert_int_equal(reasons(&s, &state, &sample), i < 5u ? 0u : NT_REASON_LATE);
        assert_int_equal(state.late_ticks, i);
    }
    assert_int_equal(state.state, NT_HOLD);
    sample.lateness = 0.0;
    for (int i = 1; i <= 5; ++i)
        assert_int_equal(reasons(&s, &state, &sample), i < 5 ? NT_REASON_LATE : 0u);
    assert_int_equal(state.state, NT_RUN);
    for (int i = 0; i < 10; ++i) { /* four in a row, never five */
        sample.lateness = i % 5 ? 1.0 : 0.0;
        assert_int_equal(reasons(&s, &state, &sample), 0u);
    }
    sample.lateness = 5000.0; /* a stop makes up for a thousand periods at most */
    reasons(&s, &state, &sample);
    assert_true(state.late == 1000.0);
    sample.lateness = NAN;
    reasons(&s, &state, &sample);
    assert_true(state.late == 0.0 && state.late_ticks == 15u);
}

/* D Q f0/f A sin(phi) >= share (A^2 + memory (A^2)') less what is lost; the tip's way has the base's shake in it. */
static void the_power_of_a_drive(void **unused)
{
    (void)unused;
    nt_supervisor s = plain();
    s.amplitude = (nt_amplitude_limits){.lost = 0.5,
                                        .most = 4.0,
                                        .settling = 2u,
                                        .shake = 0.25,
                                        .reach = 2.0,
                                        .memory = 0.75,
                                        .kept = 0.5,
                                        .share = 0.5};
    nt_supervisor_state state = nt_supervisor_start();
    nt_sample sample = good();
    sample.amplitude = 1.0;
    sample.lag = 1.0;
    assert_int_equal(reasons(&s, &state, &sample), 0u);
    const double sine = sin(1.0), cosine = cos(1.0) + 0.25, square = sine * sine + cosine * cosine;
    assert_true(fabs(state.power - sine) < 1e-15 && fabs(state.loss - square) < 1e-15);
    sample.amplitude = 2.0;
    sample.lag = 0.9;
    const double sine2 = 2.0 * sin(0.9), cosine2 = 2.0 * cos(0.9) + 0.25, square2 = sine2 * sine2 + cosine2 * cosine2;
    const double power = 0.5 * (sine + sine2), loss = 0.5 * (square + square2);
    const double needed = 0.5 * (loss + 0.75 * (square2 - loss)) - 0.25;
    for (int side = 0; side < 2; ++side) {
        nt_supervisor_state now = state;
        s.amplitude.reach = needed / power * (side ? 1.0 - 1e-12 : 1.0 + 1e-12);
        assert_int_equal(reasons(&s, &now, &sample), side ? NT_REASON_AMPLITUDE : 0u);
        assert_true(fabs(now.power - power) < 1e-15 && fabs(now.loss - loss) < 1e-14);
        assert_int_equal(now.state, side ? NT_LATCHED : NT_RUN);
    }
    s.amplitude.reach = 1e9;
    const double amplitudes[] = {0.5, nextafter(0.5, 0.0), 4.0, nextafter(4.0, 5.0)};
    for (int i = 0; i < 4; ++i) {
        nt_supervisor_state now = state;
        sample.amplitude = amplitudes[i];
        for (int k = 1; k <= 4; ++k) /* it may be lost for as long as lever and amplifier take */
            assert_int_equal(reasons(&s, &now, &sample), i % 2 && k > 2 ? NT_REASON_AMPLITUDE : 0u);
    }
}

static void where_the_stage_should_be(void **unused)
{
    (void)unused;
    const nt_supervisor s = plain();
    nt_supervisor_state state = nt_supervisor_start();
    nt_follow_expect(&s, &state, 8.0);
    assert_true(state.expected == 8.0 && state.path == 0.0 && state.reference == 8.0 && !state.lifts);
    nt_follow_expect(&s, &state, 16.0);
    assert_true(state.expected == 10.0 && state.path == 2.0 && !state.lifts);
    nt_follow_expect(&s, &state, 16.0);
    assert_true(state.expected == 11.5 && state.path == 2.5 && !state.lifts); /* it stays: no lift */
    nt_follow_expect(&s, &state, 3.5);
    assert_true(state.expected == 9.5 && state.path == 3.25 && state.lifts);
    /* three quarters of the way, 2.4375, are more than the slack of 2 */
    for (int k = 1; k <= 2; ++k)
        assert_false(nt_follow_is_off(&s, &state, 9.5 + 2.4375));
    assert_int_equal(state.off_run, 0u);
    for (uint32_t k = 1; k <= 3; ++k) {
        assert_int_equal(nt_follow_is_off(&s, &state, 9.5 - 2.4375 - 1e-12), k == 3u);
        assert_int_equal(state.off_run, k);
    }
    state.path = 0.0; /* at rest the slack */
    assert_false(nt_follow_is_off(&s, &state, 11.5));
    assert_false(nt_follow_is_off(&s, &state, nextafter(11.5, 12.0)) || state.off_run != 1u);
    state.path = 100.0; /* never more than follow_error */
    assert_false(nt_follow_is_off(&s, &state, 15.5));
    assert_false(nt_follow_is_off(&s, &state, nextafter(15.5, 16.0)) || state.off_run != 1u);
}

/* In a stop it may be farther up than told, and lose a share of the way and what late ticks have lifted. */
static void where_it_should_be_in_a_stop(void **unused)
{
    (void)unused;
    const nt_supervisor s = plain();
    nt_supervisor_state state = nt_supervisor_start();
    state.state = NT_RETRACT;
    state.expected = 2.0;
    state.stopped = 10.0;
    state.late = 0.75; /* 1 m/s, over a filter that takes four ticks: 3 m */
    assert_false(nt_follow_is_off(&s, &state, -50.0) || state.off_run != 0u);
    assert_false(nt_follow_is_off(&s, &state, 2.0 + 2.0 + 4.0 + 3.0));
    assert_int_equal(state.off_run, 0u);
    assert_false(nt_follow_is_off(&s, &state, nextafter(11.0, 12.0)));
    assert_int_equal(state.off_run, 1u);
    state.stopped = (double)INFINITY; /* not known: nothing is allowed for */
    state.off_run = 0;
    assert_false(nt_follow_is_off(&s, &state, 4.0) || state.off_run != 0u);
    assert_false(nt_follow_is_off(&s, &state, nextafter(4.0, 5.0)) || state.off_run != 1u);
    state.state = NT_HOLD;
    state.off_run = 8u; /* of 1/16 s: follow_time */
    assert_int_equal(nt_follow_judge(&s, &state, 1), NT_HOLD);
    assert_int_equal(state.lift, NT_LIFT_GOES);
    state.off_run = 9u;
    assert_int_equal(nt_follow_judge(&s, &state, 1), NT_LATCHED);
    assert_int_equal(state.lift, NT_LIFT_WAITS);
    state.state = NT_RETRACT;
    state.off_run = 3u;
    state.lift = NT_LIFT_GOES;
    assert_int_equal(nt_follow_judge(&s, &state, 1), NT_LATCHED);
    assert_int_equal(state.lift, NT_LIFT_GOES); /* the force tells */
    state.off_run = 9u;                         /* for long: a stop goes on all the same */
    assert_int_equal(nt_follow_judge(&s, &state, 1), NT_LATCHED);
    assert_int_equal(state.lift, NT_LIFT_GOES);
    const nt_lift after[] = {NT_LIFT_WAITS, NT_LIFT_WAITS, NT_LIFT_GIVEN_UP, NT_LIFT_GIVEN_UP};
    for (int i = 0; i < 4; ++i) {
        state.lift = (nt_lift)i;
        assert_int_equal(nt_follow_judge(&s, &state, 0), NT_LATCHED);
        assert_int_equal(state.lift, after[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ages_at_their_borders),
        cmocka_unit_test(readings_at_the_end_of_their_ranges),
        cmocka_unit_test(what_an_old_sample_tells),
        cmocka_unit_test(forces_at_their_limits),
        cmocka_unit_test(indentation_is_travel_since_first_touch),
        cmocka_unit_test(late_ticks_are_counted),
        cmocka_unit_test(the_power_of_a_drive),
        cmocka_unit_test(where_the_stage_should_be),
        cmocka_unit_test(where_it_should_be_in_a_stop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
