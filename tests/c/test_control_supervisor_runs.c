/* SPDX-License-Identifier: BSD-3-Clause
 * What the supervisor follows over many ticks: lateness, the way into the sample, laws that fail, the stage. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/control.h"
#include "larger.h"
#include "nanotouch/touch.h"

static nt_touch touch;

static int make_touch(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    return nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL) != NT_OK;
}

static nt_state step(nt_supervisor_state *state, const nt_sample *sample)
{
    const nt_situation situation = {.reference = sample->stage_position[NT_Z]};
    return nt_supervisor_step(&touch.supervisor, state, sample, &situation);
}

/* One late tick is counted, five in a row hold, five punctual ones let go; late ticks now and then never hold. */
static void late_ticks_hold(void **unused)
{
    (void)unused;
    nt_supervisor_state state = nt_supervisor_start();
    nt_sample sample = {0};
    sample.lateness = 0.3 * touch.period;
    for (int i = 1; i <= 20; i++)
        assert_int_equal(step(&state, &sample), i < 5 ? NT_RUN : NT_HOLD);
    sample.lateness = 0.0;
    for (int i = 1; i <= 10; i++)
        assert_int_equal(step(&state, &sample), i < 5 ? NT_HOLD : NT_RUN);
    for (int i = 0; i < 1000; i++) {
        sample.lateness = i % 5 ? touch.period : 0.0;
        assert_int_equal(step(&state, &sample), NT_RUN);
    }
    assert_int_equal(state.late_ticks, 20 + 800);
    sample.lateness = NAN;
    for (int i = 1; i <= 5; i++)
        step(&state, &sample);
    assert_int_equal(state.state, NT_HOLD);
}

/* Past first touch 0.3 um and no more; what a rising surface does under a tip that goes sideways is not counted. */
static void indentation_counts_from_first_touch(void **unused)
{
    (void)unused;
    const double k_c = touch.rig.probe.spring_constant, limit = touch.settings.limits.indentation;
    const double softness = 20e-9 / limit; /* deflection per indentation */
    for (double surface = 0.5e-6; surface < 3e-6; surface += 0.7e-6) {
        nt_supervisor_state state = nt_supervisor_start();
        double indentation = 0.0;
        for (int i = 0; state.state == NT_RUN && i < 5000; i++) {
            const double z = 1e-9 * i;
            indentation = larger(0.0, z - surface) / (1.0 + softness);
            const nt_sample sample = {.stage_position[NT_Z] = z,
                                      .deflection[NT_Z] = softness * indentation + 1e-10 * (i % 2)};
            const nt_situation situation = {.reference = z};
            nt_supervisor_step(&touch.supervisor, &state, &sample, &situation);
        }
        assert_int_equal(state.reasons, NT_REASON_INDENTATION);
        /* first touch is seen when the force leaves the noise */
        const double unseen = touch.supervisor.free_force / k_c / softness;
        assert_true(indentation > limit && indentation < limit + unseen + 2e-9);
    }
    nt_supervisor_state state = nt_supervisor_start();
    for (int i = 0; i < 3000; i++) { /* the stage draws back by 0.3 um to let the surface rise by 0.3 um, and returns */
        const double hill = 0.3e-6 * sin(i * 1e-3 * 3.14159);
        const nt_sample sample = {.stage_position[NT_Z] = 1e-6 - hill, .deflection[NT_Z] = 50e-9 + 1e-10 * (i % 2)};
        const nt_situation situation = {.reference = 1e-6 - hill, .moves_sideways = 1};
        assert_int_equal(nt_supervisor_step(&touch.supervisor, &state, &sample, &situation), NT_RUN);
    }
}

static void a_law_without_numbers_holds_then_retracts(void **unused)
{
    (void)unused;
    nt_supervisor_state state = nt_supervisor_start();
    assert_int_equal(nt_supervisor_fail_law(&state), NT_HOLD);
    assert_int_equal(nt_supervisor_fail_law(&state), NT_RETRACT);
    assert_int_equal(state.reasons, NT_REASON_LAW);
    assert_int_equal(nt_supervisor_arm(&state, 0), NT_OK);
    state.state = NT_LATCHED;
    assert_int_equal(nt_supervisor_arm(&state, 0), NT_E_STATE);
    assert_int_equal(state.state, NT_LATCHED);
    assert_int_equal(nt_supervisor_arm(&state, 1), NT_OK);
    assert_int_equal(state.state, NT_RUN);
}

/* A stage told to be somewhere, and what is seen of it. */
typedef struct follower {
    nt_supervisor_state state;
    nt_sample sample;
    double reference;
} follower;

static follower at_rest(void)
{
    return (follower){.state = nt_supervisor_start(),
                      .sample = {.deflection[NT_Z] = 1e-9, .stage_position[NT_Z] = 1e-6},
                      .reference = 1e-6};
}

static nt_state follow(follower *in)
{
    const nt_situation situation = {.reference = in->reference};
    return nt_supervisor_step(&touch.supervisor, &in->state, &in->sample, &situation);
}

/* Gain -1, 0 and 0.1 of a stage that is told to move 10 um/s: HOLD three ticks after the error has passed the slack or
 * half of the way, LATCHED after follow_time. */
static void a_stage_that_does_not_follow(void **unused)
{
    (void)unused;
    static const double gains[] = {-1.0, 0.0, 0.1};
    for (int i = 0; i < 3; i++) {
        follower in = at_rest();
        int held = 0, latched = 0;
        for (int tick = 1; tick < 10000 && latched == 0; tick++) {
            in.sample.deflection[NT_Z] = 1e-10 * (tick % 2); /* alive */
            in.sample.stage_position[NT_Z] += held ? 0.0 : gains[i] * 10e-6 * touch.period;
            in.reference += held ? 0.0 : 10e-6 * touch.period;
            const nt_state found = follow(&in);
            held = found >= NT_HOLD && held == 0 ? tick : held;
            latched = found == NT_LATCHED ? tick : latched;
        }
        /* the stage should follow with a lag of 0.6 ms */
        const double reached = (touch.supervisor.stage_slack + 10e-6 * 0.6e-3) / ((1.0 - gains[i]) * 10e-6);
        assert_true(fabs(held - (reached / touch.period + 3.0)) < 4.0);
        assert_in_range(latched - held, 497, 499);
        assert_int_equal(in.state.reasons, NT_REASON_FOLLOW);
    }
}

/* What it may show: two ticks beside its way, and while it goes up to half of that way less. */
static void a_stage_that_follows_well_enough(void **unused)
{
    (void)unused;
    follower in = at_rest();
    for (int i = 0; i < 10000; i++) {
        in.sample.stage_position[NT_Z] = in.reference + (i % 50 < 2 ? 2.0 : 0.0) * touch.settings.limits.follow_error;
        in.sample.deflection[NT_Z] = 1e-10 * (i % 2); /* alive */
        assert_int_equal(follow(&in), NT_RUN);
    }
    in = at_rest();
    for (int i = 0; i < 500; i++) { /* 20 um/s for 50 ms; hysteresis takes 60 nm away, and comes back */
        in.reference += 20e-6 * touch.period;
        in.sample.stage_position[NT_Z] = in.reference - 12e-9 - 60e-9 * sin(3.14159 * i / 500.0);
        in.sample.deflection[NT_Z] = 1e-10 * (i % 2);
        assert_int_equal(follow(&in), NT_RUN);
    }
}

/* Lifting at 10 um/s: given up in the third tick in which the stage goes the wrong way, or the force grows. */
static void a_lift_that_does_not_help_is_given_up(void **unused)
{
    (void)unused;
    for (int blind = 0; blind < 2; blind++) {
        follower in = at_rest();
        in.sample.deflection[NT_Z] = 100e-9;
        follow(&in);
        in.sample.flags = NT_SAMPLE_LIMIT_SWITCH;
        int ticks = 0;
        for (; in.state.state != NT_LATCHED && ticks < 1000; ticks++) {
            in.reference -= 1e-9;
            in.sample.stage_position[NT_Z] = blind ? (double)NAN : in.sample.stage_position[NT_Z] + 1e-9;
            in.sample.deflection[NT_Z] += 1e-9;
            follow(&in);
        }
        assert_int_equal(in.state.state, NT_LATCHED);
        assert_true(in.state.reasons & NT_REASON_FOLLOW);
        /* 2 nm per tick against a slack of 20 nm; 1 nm per tick until it should have turned; the lag of 0.6 ms */
        assert_in_range(ticks, blind ? 23 : 13, blind ? 35 : 19);
    }
    follower in = at_rest(); /* one that helps: adhesion lets go on the way */
    follow(&in);
    in.sample.flags = NT_SAMPLE_LIMIT_SWITCH;
    for (int i = 0; i < 500; i++) {
        in.reference -= 1e-9;
        in.sample.stage_position[NT_Z] = in.state.expected;
        in.sample.deflection[NT_Z] = i < 60 ? 100e-9 - 2e-9 * i : 1e-10 * (i % 2);
        assert_int_equal(follow(&in), NT_RETRACT);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(late_ticks_hold),
        cmocka_unit_test(indentation_counts_from_first_touch),
        cmocka_unit_test(a_law_without_numbers_holds_then_retracts),
        cmocka_unit_test(a_stage_that_does_not_follow),
        cmocka_unit_test(a_stage_that_follows_well_enough),
        cmocka_unit_test(a_lift_that_does_not_help_is_given_up),
    };
    return cmocka_run_group_tests(tests, make_touch, NULL);
}
