/* SPDX-License-Identifier: BSD-3-Clause
 * The table of docs/evidence/safety.md: every state x every event, every pair of events, and how long each takes. */
#include <float.h>

#include "core/rig.h"
#include "internal/control.h"
#include "supervisor_fixture.h"

static void no_event(input *in)
{
    (void)in;
}

static void nan_force(input *in)
{
    in->sample.operator_force[NT_Z] = NAN;
}

static void bad_frame_again(input *in)
{
    in->sample.flags |= NT_SAMPLE_INVALID;
    in->history.invalid_run = 1;
}

static void saturated(input *in)
{
    in->sample.deflection[NT_Z] = nt_probe_deflection_range(&touch.rig.probe);
}

static void pulled_to_the_end(input *in)
{
    in->sample.deflection[NT_Z] = -nt_probe_deflection_range(&touch.rig.probe);
}

static void above_force_limit(input *in)
{
    in->sample.deflection[NT_Z] = 1.0001 * touch.settings.limits.force / touch.rig.probe.spring_constant;
}

static void below_negative_limit(input *in)
{
    in->sample.deflection[NT_Z] = -1.0001 * touch.settings.limits.force / touch.rig.probe.spring_constant;
}

static void age_three_periods(input *in)
{
    in->sample.age = 3.0 * touch.period;
}

static void age_six_periods(input *in)
{
    in->sample.age = 6.0 * touch.period;
}

static void stuck(input *in)
{
    in->history.deflection.value = in->sample.deflection[NT_Z];
    in->history.deflection.run = 49;
    in->history.deflection.position[NT_Z] = in->sample.stage_position[NT_Z] - 6e-9; /* has moved by six steps */
}

static void stuck_for_long(input *in)
{
    stuck(in);
    in->history.deflection.run = 99;
}

static void off_its_command(input *in)
{
    in->reference -= 1.1 * touch.supervisor.stage_slack; /* below where it was told to be */
    in->history.expected = in->reference;
    in->history.off_run = 2;
}

static void off_for_long(input *in)
{
    off_its_command(in);
    in->history.off_run = (uint32_t)ceil(touch.settings.limits.follow_time / touch.period);
}

static void no_gain_left(input *in)
{
    in->unstable = 1;
}

static void emergency_stop(input *in)
{
    in->sample.flags |= NT_SAMPLE_EMERGENCY_STOP;
}

static void limit_switch(input *in)
{
    in->sample.flags |= NT_SAMPLE_LIMIT_SWITCH;
}

static void fifth_late_tick(input *in)
{
    in->sample.lateness = 0.21 * touch.period;
    in->history.late_run = 4;
}

static void device_gone(input *in)
{
    in->sample.flags |= NT_SAMPLE_DEVICE_LOST;
}

static void too_deep(input *in)
{
    in->history.surface = in->sample.stage_position[NT_Z] - 1.05 * touch.settings.limits.indentation;
    in->sample.deflection[NT_Z] += 3e-9; /* in contact */
}

static void gauge_at_its_range(input *in)
{
    in->sample.operator_force[NT_Z] = -touch.rig.master.gauge_range;
}

typedef struct event {
    void (*happen)(input *in);
    nt_state verdict; /* from RUN or HOLD */
    uint32_t reason;
    int kind;     /* events of one kind exclude each other */
    int measured; /* reads the sample's numbers: 1: an invalid sample is not read, 2: nor an old one, for this */
} event;

static const event events[] = {
    {no_event, NT_RUN, 0, 0, 0},
    {nan_force, NT_HOLD, NT_REASON_INVALID, 1, 0},
    {bad_frame_again, NT_RETRACT, NT_REASON_INVALID, 1, 0},
    {saturated, NT_RETRACT, NT_REASON_SATURATED | NT_REASON_FORCE_LIMIT, 2, 1},
    {pulled_to_the_end, NT_RETRACT, NT_REASON_SATURATED | NT_REASON_FORCE_LIMIT | NT_REASON_INDENTATION, 2, 1},
    {above_force_limit, NT_RETRACT, NT_REASON_FORCE_LIMIT, 2, 1},
    {below_negative_limit, NT_RETRACT, NT_REASON_FORCE_LIMIT, 2, 1},
    {age_three_periods, NT_HOLD, NT_REASON_STALE, 3, 1},
    {age_six_periods, NT_RETRACT, NT_REASON_STALE, 3, 1},
    {stuck, NT_HOLD, NT_REASON_STUCK, 2, 1},
    {stuck_for_long, NT_LATCHED, NT_REASON_STUCK, 2, 1},
    {off_its_command, NT_HOLD, NT_REASON_FOLLOW, 4, 2},
    {off_for_long, NT_LATCHED, NT_REASON_FOLLOW, 4, 2},
    {no_gain_left, NT_HOLD, NT_REASON_UNSTABLE, 5, 0},
    {emergency_stop, NT_LATCHED, NT_REASON_EMERGENCY_STOP, 6, 0},
    {limit_switch, NT_RETRACT, NT_REASON_LIMIT_SWITCH, 7, 0},
    {fifth_late_tick, NT_HOLD, NT_REASON_LATE, 8, 0},
    {device_gone, NT_LATCHED, NT_REASON_DEVICE | NT_REASON_INVALID, 1, 0},
    {too_deep, NT_RETRACT, NT_REASON_INDENTATION, 2, 1},
    {gauge_at_its_range, NT_RUN, NT_REASON_OPERATOR_CLIPPED, 1, 1},
};
enum { EVENTS = (int)(sizeof events / sizeof *events) };

static nt_state worse(nt_state a, nt_state b)
{
    return a > b ? a : b;
}

/* A frame that is bad or old tells nothing; one with a number that is none still tells whether the stage follows. */
static int is_hidden(const event *seen, const event *beside)
{
    if (seen->measured == 2 && beside->reason & NT_REASON_STALE)
        return 1;
    return seen->measured && beside->reason & NT_REASON_INVALID &&
           !(seen->measured == 2 && beside->happen == nan_force);
}

/* What an event alone demands in this state: a lift that does not show is given up. */
static nt_state verdict_of(const event *e, nt_state from)
{
    return from >= NT_RETRACT && e->reason == NT_REASON_FOLLOW ? NT_LATCHED : e->verdict;
}

static void check_pair(nt_state from, const event *a, const event *b)
{
    input in = healthy(from);
    a->happen(&in);
    b->happen(&in);
    const int no_a = is_hidden(a, b), no_b = is_hidden(b, a);
    const nt_state verdict = worse(no_a ? NT_RUN : verdict_of(a, from), no_b ? NT_RUN : verdict_of(b, from));
    const nt_state found = step(&in);
    assert_int_equal(found, from >= NT_RETRACT ? worse(from, verdict) : verdict);
    assert_int_equal(in.history.state, found);
    assert_int_equal(in.history.reasons, (no_a ? 0 : a->reason) | (no_b ? 0 : b->reason));
}

/* All states x all pairs of events (an event with itself: that event alone). RETRACT and LATCHED are never left. */
static void every_state_and_every_pair_of_events(void **unused)
{
    (void)unused;
    int tried = 0;
    for (int s = NT_RUN; s <= NT_LATCHED; s++)
        for (int i = 0; i < EVENTS; i++)
            for (int j = i; j < EVENTS; j++) {
                if (i != j && events[i].kind == events[j].kind)
                    continue;
                check_pair((nt_state)s, &events[i], &events[j]);
                tried++;
            }
    assert_true(tried > 4 * 110);
}

/* Every number of a sample, NaN and either infinity, and an age from the future. */
static void every_number_of_a_sample_is_checked(void **unused)
{
    (void)unused;
    const size_t fields[] = {offsetof(nt_sample, age),
                             offsetof(nt_sample, master_position[NT_Z]),
                             offsetof(nt_sample, operator_force[NT_Z]),
                             offsetof(nt_sample, stage_position[NT_X]),
                             offsetof(nt_sample, stage_position[NT_Y]),
                             offsetof(nt_sample, stage_position[NT_Z]),
                             offsetof(nt_sample, deflection[NT_Z])};
    const double bad[] = {NAN, HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        for (int j = 0; j < 3; j++) {
            input in = healthy(NT_RUN);
            *(double *)(void *)((char *)&in.sample + fields[i]) = bad[j];
            assert_int_equal(step(&in), NT_HOLD);
            assert_int_equal(step(&in), NT_RETRACT);
            assert_int_equal(in.history.reasons, NT_REASON_INVALID);
        }
    const double far[] = {1.01 * touch.rig.master.travel, 2.02 * touch.rig.master.gauge_range,
                          1.01 * touch.rig.stage.travel}; /* no sensor of this rig says so */
    const size_t limited[] = {offsetof(nt_sample, master_position[NT_Z]), offsetof(nt_sample, operator_force[NT_Z]),
                              offsetof(nt_sample, stage_position[NT_Z])};
    for (int i = 0; i < 3; i++) {
        input in = healthy(NT_RUN);
        *(double *)(void *)((char *)&in.sample + limited[i]) = -far[i];
        assert_int_equal(step(&in), NT_HOLD);
    }
    input in = healthy(NT_RUN);
    in.sample.age = -1e-9;
    assert_int_equal(step(&in), NT_HOLD);
}

/* x and y of a hand count where they lead the tip, and only there. */
static void a_hand_that_leads_sideways_is_judged_there(void **unused)
{
    (void)unused;
    const double bad[] = {NAN, HUGE_VAL, 1.01 * touch.rig.master.travel};
    nt_rig rig = touch.rig;
    rig.master.axes = 3.0;
    const nt_supervisor leading = nt_supervisor_make(&rig, &touch.settings);
    const nt_situation situation = {.reference = 1e-6};
    for (int axis = NT_X; axis < NT_Z; axis++)
        for (int j = 0; j < 3; j++) {
            input in = healthy(NT_RUN);
            in.sample.master_position[axis] = bad[j];
            assert_int_equal(nt_supervisor_step(&touch.supervisor, &in.history, &in.sample, &situation), NT_RUN);
            assert_int_equal(nt_supervisor_step(&leading, &in.history, &in.sample, &situation), NT_HOLD);
            assert_int_equal(nt_supervisor_step(&leading, &in.history, &in.sample, &situation), NT_RETRACT);
            assert_int_equal(in.history.reasons, NT_REASON_INVALID);
        }
}

static void a_good_sample_between_bad_ones_ends_the_run(void **unused)
{
    (void)unused;
    input in = healthy(NT_RUN);
    for (int i = 0; i < 100; i++) {
        in.sample.flags = i % 2 ? NT_SAMPLE_INVALID : 0u;
        assert_int_equal(step(&in), i % 2 ? NT_HOLD : NT_RUN);
    }
}

/* Limits are sharp: just inside is RUN. */
static void just_inside_every_limit_is_run(void **unused)
{
    (void)unused;
    const nt_limits *limits = &touch.settings.limits;
    input in = healthy(NT_RUN);
    in.sample.deflection[NT_Z] = 0.9999 * limits->force / touch.rig.probe.spring_constant;
    in.sample.age = 2.0 * touch.period;
    in.sample.operator_force[NT_Z] = 0.9999 * touch.rig.master.gauge_range;
    in.sample.stage_position[NT_Z] += 0.9999 * touch.supervisor.stage_slack;
    for (int i = 0; i < 10000; i++)
        assert_int_equal(step(&in), NT_RUN);
    assert_int_equal(in.history.reasons, 0);
}

/* A hand that nobody hears of any more endangers no tip: HOLD for as long as it takes, RUN when it is back. */
static void a_master_that_falls_silent_holds(void **unused)
{
    (void)unused;
    const double period = touch.supervisor.master_period;
    const double stale[] = {2.0 * period * (1.0 + 8.0 * DBL_EPSILON), 1e3, HUGE_VAL, NAN, -1e-9, -HUGE_VAL};
    for (size_t i = 0; i < sizeof stale / sizeof *stale; i++) {
        input in = healthy(NT_RUN);
        in.sample.master_age = stale[i];
        for (int n = 0; n < 1000; n++) {
            in.sample.deflection[NT_Z] = 1e-9 + 1e-12 * (n % 2);
            assert_int_equal(step(&in), NT_HOLD);
            assert_int_equal(in.history.reasons, NT_REASON_MASTER_STALE);
        }
        in.sample.master_age = 2.0 * period;
        assert_int_equal(step(&in), NT_RUN);
    }
}

/* Its size counts, whatever its direction; a lever that shows it must give numbers. */
static void a_lateral_force_past_its_limit_lifts(void **unused)
{
    (void)unused;
    input in = healthy(NT_RUN);
    in.sample.deflection[NT_X] = in.sample.deflection[NT_Y] = NAN;
    assert_int_equal(step(&in), NT_RUN); /* nobody reads them */
    touch.supervisor.lateral_stiffness = 50.0;
    const double most = touch.supervisor.limits.lateral_force / 50.0;
    for (int i = 0; i < 16; i++) {
        const double angle = 0.4 * i;
        in = healthy(NT_RUN);
        for (int past = 0; past < 2; past++) {
            in.sample.deflection[NT_X] = most * (past ? 1.0001 : 0.9999) * cos(angle);
            in.sample.deflection[NT_Y] = most * (past ? 1.0001 : 0.9999) * sin(angle);
            in.sample.deflection[NT_Z] = 1e-9 + 1e-12 * past;
            assert_int_equal(step(&in), past ? NT_RETRACT : NT_RUN);
        }
        assert_int_equal(in.history.reasons, NT_REASON_LATERAL);
    }
    in = healthy(NT_RUN);
    in.sample.deflection[NT_Y] = NAN;
    assert_int_equal(step(&in), NT_HOLD);
    assert_int_equal(step(&in), NT_RETRACT);
    assert_int_equal(in.history.reasons, NT_REASON_INVALID);
    touch.supervisor.lateral_stiffness = 0.0;
}

static void reasons_have_names(void **unused)
{
    (void)unused;
    for (uint32_t bit = NT_REASON_INVALID; bit <= NT_REASON_AMPLITUDE; bit <<= 1)
        assert_true(nt_reason_name(bit)[0] != 0);
    assert_string_equal(nt_reason_name(NT_REASON_AMPLITUDE << 1), "");
    assert_string_equal(nt_reason_name(0), "");
    assert_string_equal(nt_reason_name(NT_REASON_FORCE_LIMIT), "force limit");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_state_and_every_pair_of_events),
        cmocka_unit_test(every_number_of_a_sample_is_checked),
        cmocka_unit_test(a_hand_that_leads_sideways_is_judged_there),
        cmocka_unit_test(a_good_sample_between_bad_ones_ends_the_run),
        cmocka_unit_test(just_inside_every_limit_is_run),
        cmocka_unit_test(a_master_that_falls_silent_holds),
        cmocka_unit_test(a_lateral_force_past_its_limit_lifts),
        cmocka_unit_test(reasons_have_names),
    };
    return cmocka_run_group_tests(tests, make_touch, NULL);
}
