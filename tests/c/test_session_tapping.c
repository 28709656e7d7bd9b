/* SPDX-License-Identifier: BSD-3-Clause
 * Mode tapping: a session holds the amplitude of a driven lever on the simulated slave, and what happens when drive or
 * lock-in amplifier fail. A half between session and simulated slave spoils what the test wants. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "hal/sim/sim.h"
#include "internal/tapping.h"
#include "larger.h"
#include "session_fixture.h"

enum { TICKS = 6000, AT = 3000 };

static nt_record records[TICKS];

static nt_session_setup tapping_setup(void)
{
    nt_session_setup setup = nt_session_defaults();
    setup.rig.probe.spring_constant = 40.0;
    setup.rig.probe.quality = 200.0;
    setup.rig.probe.resonance = 300e3;
    setup.rig.stage.axes = 1.0;
    setup.scene.medium.relative_humidity = 0.0;
    setup.scene.tip.radius = 10e-9;
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.mode = NT_MODE_TAPPING;
    return setup;
}

/* --- it taps --- */

/* The set point is held; the motion is that of the slow flow settled at the height where it is held. */
static void the_amplitude_is_held(void **state)
{
    (void)state;
    const nt_session_setup setup = tapping_setup();
    nt_session *session = open_session(&setup);
    run(session, records, TICKS);
    const nt_record *last = &records[TICKS - 1];
    const double A0 = 20e-9;
    double mean = 0.0;
    for (int i = TICKS - 1000; i < TICKS; i++) {
        assert_int_equal(records[i].state, NT_RUN);
        mean += records[i].amplitude / 1000.0;
    }
    assert_true(fabs(mean - 0.7 * A0) < 0.01 * A0);
    const nt_drive drive = {NT_DRIVE_BASE, 0.0, A0};
    nt_tapping lever;
    assert_int_equal(nt_tapping_init(&lever, &setup.rig.probe, &drive, 1e-9, NULL), NT_OK);
    nt_flow_state flow = nt_flow_free(&lever);
    nt_flow_value settled;
    const nt_tapping_over over = {nt_session_plan(session), NULL, last->gap + lever.cosine * 0.7 * A0};
    assert_int_equal(nt_flow_settle(&lever, &flow, &over, &settled, NULL), NT_OK);
    assert_true(fabs(settled.amplitude - 0.7 * A0) < 0.05 * A0);
    assert_true(fabs(settled.phase - last->lag) < 0.1);
    assert_true(settled.phase < 1.5); /* repulsive */
    nt_session_close(session);
}

/* Likewise the phase; attraction reads as too far up, and is gone through. The drive is at the resonance. */
static void the_phase_is_held(void **state)
{
    (void)state;
    for (int humid = 0; humid < 2; humid++) {
        nt_session_setup setup = tapping_setup();
        setup.scene.medium.relative_humidity = 0.4 * humid;
        setup.settings.tap.hold = 1;
        setup.settings.tap.set_phase = 0.9;
        nt_session *session = open_session(&setup);
        run(session, records, TICKS);
        double mean = 0.0;
        for (int i = TICKS - 1000; i < TICKS; i++) {
            assert_int_equal(records[i].state, NT_RUN);
            mean += records[i].lag / 1000.0;
        }
        print_message("phase %.3f rad of 0.9, amplitude %.2f nm\n", mean, 1e9 * records[TICKS - 1].amplitude);
        assert_true(fabs(mean - 0.9) < 0.02);
        assert_true(records[TICKS - 1].amplitude < 20e-9 * sin(0.9) + 0.2e-9); /* losses only make it smaller */
        nt_session_close(session);
        setup.settings.tap.frequency = 301e3;
        nt_problem problem = {0};
        assert_int_equal(nt_session_open(&session, &setup, &problem), NT_E_RANGE);
        assert_non_null(strstr(problem.field, "tap.frequency"));
    }
}

static void another_mode_has_no_amplitude(void **state)
{
    (void)state;
    nt_session_setup setup = tapping_setup();
    nt_problem problem = {0};
    setup.mode = NT_MODE_TOPOGRAPHY;
    nt_session *session = open_session(&setup);
    run(session, records, 10);
    assert_true(isnan(records[9].amplitude) && isnan(records[9].lag));
    assert_int_equal(nt_session_capabilities(session, NT_HALF_SLAVE)->can & NT_CAN_TAP, 0);
    assert_int_equal(nt_session_set_mode(session, NT_MODE_TAPPING, &problem), NT_E_ARGUMENT);
    nt_session_close(session);
    setup.mode = NT_MODE_TAPPING;
    session = open_session(&setup);
    assert_int_equal(nt_session_set_mode(session, NT_MODE_TOUCH, &problem), NT_E_ARGUMENT);
    assert_int_equal(nt_session_change(session, NT_EVENT_SETTING, "tap.set_amplitude", 0.8, &problem), NT_OK);
    assert_int_equal(nt_session_change(session, NT_EVENT_SETTING, "tap.free_amplitude", 1e-8, &problem), NT_E_ARGUMENT);
    nt_session_close(session);
}

/* --- what fails --- */

typedef enum spoilt {
    WELL,
    DRIVE_GONE,    /* the oscillator no longer hears, and rings down */
    DRIVE_DOUBLED, /* another program has turned it up */
    DRIVE_UP,      /* by half */
    QUALITY_UP,    /* the medium takes half as much */
    INVALID,       /* no valid bit, in each tick */
    INVALID_ONCE,
    NAN_AMPLITUDE, /* with a valid bit */
    NAN_LAG,
    STUCK, /* the last amplitude, whatever comes */
    ABSURD /* a number that no lock-in amplifier of this rig gives */
} spoilt;

/* A slave of one's own: the simulated one, spoilt from a tick on. */
typedef struct spoiler {
    nt_sim_slave slave;
    const nt_plan *plan;
    nt_session_setup setup;
    spoilt how;
    double gain; /* of the amplitude, from the beginning */
    long reads;
    long from; /* read from which it is spoilt */
    double held;
    double deepest; /* gap that the tip has come to [m] */
} spoiler;

static spoiler probe;

static nt_status open_spoilt(void *context, const nt_host *host, nt_problem *problem)
{
    return nt_sim_slave_backend()->open(context, host, problem);
}
static nt_status describe_spoilt(void *context, nt_capabilities *capabilities)
{
    return nt_sim_slave_backend()->describe(context, capabilities);
}
static nt_status read_spoilt(void *context, nt_reading *reading)
{
    spoiler *s = context;
    const nt_status status = nt_sim_slave_backend()->read(&s->slave, reading);
    reading->amplitude *= s->gain;
    s->deepest = smaller(s->deepest, s->slave.truth.deepest_gap);
    if (++s->reads < s->from) {
        s->held = reading->amplitude;
        return status;
    }
    if (s->how == INVALID || (s->how == INVALID_ONCE && s->reads == s->from))
        reading->valid &= ~(1u << NT_READS_AMPLITUDE);
    if (s->how == NAN_AMPLITUDE)
        reading->amplitude = (double)NAN;
    if (s->how == NAN_LAG)
        reading->lag = (double)NAN;
    if (s->how == STUCK)
        reading->amplitude = s->held;
    if (s->how == ABSURD)
        reading->amplitude = 1e-6;
    return status;
}
static nt_status write_spoilt(void *context, const nt_action *action)
{
    spoiler *s = context;
    nt_action heard = *action;
    if (s->reads >= s->from && s->how == DRIVE_GONE)
        heard.drive_amplitude = 0.0;
    if (s->reads >= s->from && s->how == DRIVE_DOUBLED)
        heard.drive_amplitude *= 2.0;
    if (s->reads >= s->from && s->how == DRIVE_UP)
        heard.drive_amplitude *= 1.5;
    if (s->reads == s->from && s->how == QUALITY_UP)
        s->slave.tap.lever.quality *= 2.0;
    return nt_sim_slave_backend()->write(&s->slave, &heard);
}
static void disarm_spoilt(void *context)
{
    nt_sim_slave_backend()->disarm(context);
}

static const nt_backend spoilt_backend = {.size = sizeof spoilt_backend,
                                          .version = NT_HAL_API_VERSION,
                                          .name = "spoilt",
                                          .half = NT_HALF_SLAVE,
                                          .open = open_spoilt,
                                          .describe = describe_spoilt,
                                          .read = read_spoilt,
                                          .write = write_spoilt,
                                          .disarm = disarm_spoilt};

/* Owns the plan of the spoilt slave, which borrows the contact surface of this session. */
static nt_session *owner;

/* Opens a session on a slave that is spoilt from so many ticks after the first on; NULL if it is refused. */
static nt_session *spoil(spoilt how, double gain, long from, nt_problem *problem)
{
    nt_session_setup setup = tapping_setup();
    nt_session_close(owner);
    owner = open_session(&setup);
    const nt_tap *tap = &setup.settings.tap;
    const nt_sim_lock_in lock_in = {.drive = {NT_DRIVE_BASE, 0.0, tap->free_amplitude},
                                    .time = tap->lock_in,
                                    .sensor = {tap->noise, 0.0, 4.0 * tap->free_amplitude}};
    const nt_sim_setup simulated = {.plan = nt_session_plan(owner),
                                    .rig = &setup.rig,
                                    .period = 1e-4,
                                    .clearance = setup.clearance,
                                    .delay = setup.settings.gains.delay,
                                    .seed = 1,
                                    .lock_in = &lock_in};
    probe = (spoiler){.how = how, .gain = gain, .from = 1L << 30};
    assert_int_equal(nt_sim_slave_init(&probe.slave, &simulated), NT_OK);
    setup.slave = (nt_hal_choice){&spoilt_backend, &probe};
    nt_session *session = NULL;
    const nt_status status = nt_session_open(&session, &setup, problem);
    if (status == NT_OK)
        probe.from = probe.reads + from;
    return status == NT_OK ? session : NULL;
}

/* Ticks from the fault until a state; -1: it never came. */
static long until(nt_state wanted)
{
    for (long i = 0; i < TICKS; i++)
        if (records[i].state >= (uint32_t)wanted)
            return i - (AT - 2);
    return -1;
}

/* The farthest down after a tick [m]. */
static double lowest_after(long tick)
{
    double lowest = -HUGE_VAL;
    for (long i = tick; i < TICKS; i++)
        lowest = larger(lowest, records[i].stage_position[NT_Z]);
    return lowest;
}

typedef struct expected {
    spoilt how;
    long hold, retract, latched; /* ticks from the fault, at the latest; -1: never */
    uint32_t reason;
    double deeper; /* the stage goes on by no more than this [m] */
} expected;

static void a_fault_lifts_and_is_never_zero_force(void **state)
{
    (void)state;
    const expected all[] = {
        {INVALID_ONCE, 1, -1, -1, NT_REASON_INVALID, 2e-9},
        {INVALID, 1, 2, -1, NT_REASON_INVALID, 2e-9},
        {NAN_AMPLITUDE, 1, 2, -1, NT_REASON_INVALID, 2e-9},
        {NAN_LAG, 1, 2, -1, NT_REASON_INVALID, 2e-9},
        {ABSURD, 1, 2, -1, NT_REASON_INVALID, 2e-9},
        {DRIVE_GONE, 30, 30, 30, NT_REASON_AMPLITUDE, 2e-9},
        {DRIVE_DOUBLED, 60, 60, 60, NT_REASON_AMPLITUDE, 8e-9},
        {DRIVE_UP, 60, 60, 60, NT_REASON_AMPLITUDE, 8e-9},
        {QUALITY_UP, 60, 60, 60, NT_REASON_AMPLITUDE, 8e-9},
    };
    for (size_t n = 0; n < sizeof all / sizeof *all; n++) {
        nt_problem problem = {0};
        nt_session *session = spoil(all[n].how, 1.0, AT, &problem);
        assert_non_null(session);
        run(session, records, TICKS);
        const nt_record *last = &records[TICKS - 1];
        const double stood = records[AT - 2].stage_position[NT_Z];
        assert_true(records[AT - 2].state == NT_RUN && fabs(records[AT - 2].amplitude - 14e-9) < 1e-9);
        print_message("fault %d: HOLD %ld, RETRACT %ld, LATCHED %ld, deeper %.2g nm, lifted %.0f nm\n", all[n].how,
                      until(NT_HOLD), until(NT_RETRACT), until(NT_LATCHED), 1e9 * (lowest_after(AT) - stood),
                      1e9 * (stood - last->stage_position[NT_Z]));
        assert_true(until(NT_HOLD) >= 1 && until(NT_HOLD) <= all[n].hold);
        assert_true(all[n].retract < 0 ? until(NT_RETRACT) < 0 : until(NT_RETRACT) <= all[n].retract);
        assert_true(all[n].latched < 0 ? until(NT_LATCHED) < 0 : until(NT_LATCHED) <= all[n].latched);
        assert_true(lowest_after(AT) < stood + all[n].deeper);
        if (all[n].retract > 0) {
            assert_true(last->stage_position[NT_Z] < stood - 0.49e-6); /* limits.retract_distance */
            assert_true(last->reasons & all[n].reason);
        }
        nt_session_close(session);
    }
}

/* Above the sample, where the servo goes down: a reading that stands still does not send it into the sample. */
static void a_dead_amplifier_is_found_on_the_way_down(void **state)
{
    (void)state;
    nt_problem problem = {0};
    nt_session *session = spoil(STUCK, 1.0, 300, &problem); /* still 50 nm above */
    assert_non_null(session);
    run(session, records, TICKS);
    long latched = 0;
    double force = 0.0;
    for (long i = 0; i < TICKS; i++) {
        latched += records[i].state == NT_LATCHED;
        force = larger(force, fabs(records[i].slave_force));
    }
    assert_true(latched > TICKS / 2);
    assert_true(records[TICKS - 1].reasons & NT_REASON_STUCK);
    print_message("stuck: largest mean force %.3g nN\n", 1e9 * force);
    nt_session_close(session);
}

/* Twice the amplitude is above what this drive can make: the set point would be held by hitting harder. */
static void another_drive_latches(void **state)
{
    (void)state;
    nt_problem problem = {0};
    nt_session *session = spoil(DRIVE_DOUBLED, 1.0, 100, &problem); /* in air: nothing holds it down */
    assert_non_null(session);
    run(session, records, TICKS);
    assert_int_equal(records[TICKS - 1].state, NT_LATCHED);
    assert_true(records[TICKS - 1].reasons & NT_REASON_AMPLITUDE);
    nt_session_close(session);
}

/* In air, on the way down, at first touch and at the set point: it lifts or goes on, and never digs in. */
static void any_fault_at_any_time(void **state)
{
    (void)state;
    static const long when[] = {1, 100, 400, 700, 1000, 2500};
    double worst = HUGE_VAL, force = 0.0;
    for (int how = DRIVE_GONE; how <= ABSURD; how++)
        for (size_t i = 0; i < sizeof when / sizeof *when; i++) {
            nt_problem problem = {0};
            nt_session *session = spoil((spoilt)how, 1.0, when[i], &problem);
            assert_non_null(session);
            probe.deepest = HUGE_VAL;
            run(session, records, TICKS);
            for (long k = 0; k < TICKS; k++)
                force = larger(force, fabs(records[k].slave_force));
            worst = smaller(worst, probe.deepest);
            const uint32_t ends = records[TICKS - 1].state;
            assert_true(ends >= NT_RETRACT || how == INVALID_ONCE || how == DRIVE_DOUBLED || how == STUCK);
            nt_session_close(session);
        }
    print_message("any fault: deepest gap %.2f nm, largest mean force %.0f nN\n", 1e9 * worst, 1e9 * force);
    assert_true(worst > -4e-9);
}

static void a_free_amplitude_that_is_off_is_refused(void **state)
{
    (void)state;
    const double gains[] = {0.0, 0.5, 0.88, 1.12, 3.0, (double)NAN};
    for (size_t i = 0; i < sizeof gains / sizeof *gains; i++) {
        nt_problem problem = {0};
        assert_null(spoil(WELL, gains[i], AT, &problem));
        assert_non_null(strstr(problem.field, "free amplitude"));
    }
    for (double gain = 0.92; gain < 1.1; gain += 0.08) {
        nt_problem problem = {0};
        nt_session *session = spoil(WELL, gain, AT, &problem);
        assert_non_null(session);
        nt_session_close(session);
    }
}

static int close_owner(void **state)
{
    (void)state;
    nt_session_close(owner);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_amplitude_is_held),
        cmocka_unit_test(the_phase_is_held),
        cmocka_unit_test(another_mode_has_no_amplitude),
        cmocka_unit_test(a_fault_lifts_and_is_never_zero_force),
        cmocka_unit_test(a_dead_amplifier_is_found_on_the_way_down),
        cmocka_unit_test(another_drive_latches),
        cmocka_unit_test(any_fault_at_any_time),
        cmocka_unit_test(a_free_amplitude_that_is_off_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, close_owner);
}
