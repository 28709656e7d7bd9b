/* SPDX-License-Identifier: BSD-3-Clause
 * A half that leads the clock: its readings give the ticks, at every pace that its session may keep; when it dies, the
 * loop neither stops nor spins, and the reaction is that of the half. Judged by ticks and reasons: a busy machine may
 * be late, and a HOLD for lateness is no fault here. */
#define _POSIX_C_SOURCE 200809L

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

#include <cmocka.h>

#include "internal/session.h"
#include "larger.h"
#include "session_fixture.h"

#define RATE 250.0
#define STEP 1e-6 /* of the hand in a reading [m] */
enum { LIVES = 120, MOST = 4096 };

typedef enum death { SILENT, AT_ONCE, GONE } death;

/* Says where it is, once in each of its periods; after the last one it dies. */
typedef struct metronome {
    nt_capabilities says;
    death dies;
    uint64_t last;
    double step;
    const nt_host *host;
    uint64_t sequence, calls;
    int64_t next;
    double position;
} metronome;

static int64_t clock_now(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * INT64_C(1000000000) + now.tv_nsec;
}

static void sleep_until(int64_t time)
{
    for (int64_t left = time - clock_now(); left > 0; left = time - clock_now()) {
        const struct timespec nap = {.tv_sec = left / 1000000000, .tv_nsec = left % 1000000000};
        (void)nanosleep(&nap, NULL);
    }
}

static nt_status open_it(void *context, const nt_host *host, nt_problem *problem)
{
    (void)problem;
    ((metronome *)context)->host = host;
    return NT_OK;
}

static nt_status describe_it(void *context, nt_capabilities *capabilities)
{
    const uint32_t size = capabilities->size;
    *capabilities = ((metronome *)context)->says;
    capabilities->size = size;
    return NT_OK;
}

static nt_status read_it(void *context, nt_reading *reading)
{
    metronome *m = context;
    const int64_t period = (int64_t)(1e9 / RATE), now = clock_now();
    ++m->calls;
    if (m->sequence >= m->last) {
        if (m->dies == SILENT) /* as long as a half may wait */
            sleep_until(now + 2 * period);
        return m->dies == GONE ? NT_E_DEVICE : NT_OK;
    }
    m->next = m->next + period > now ? m->next + period : now;
    sleep_until(m->next);
    m->position += m->step;
    const int feels = (m->says.can & NT_CAN_FEEL) != 0;
    *reading = (nt_reading){.size = sizeof *reading,
                            .sequence = ++m->sequence,
                            .time = m->host->now(m->host),
                            .position = {(double)NAN, (double)NAN, m->position},
                            .felt = {(double)NAN, (double)NAN, feels ? 1e-12 * (double)(m->calls % 5u) : (double)NAN},
                            .valid = 1u << NT_Z | (feels ? 1u << (NT_READS_FELT + NT_Z) : 0u)};
    return NT_OK;
}

static nt_status write_it(void *context, const nt_action *action)
{
    metronome *m = context;
    if (m->says.can & NT_CAN_FEEL) /* a slave goes where it is told */
        m->position = action->target[NT_Z];
    return NT_OK;
}

static nt_backend backend_for(nt_half half)
{
    return (nt_backend){.size = sizeof(nt_backend),
                        .version = NT_HAL_API_VERSION,
                        .name = "metronome",
                        .half = half,
                        .open = open_it,
                        .describe = describe_it,
                        .read = read_it,
                        .write = write_it};
}

/* A position device over a stage of one axis; no preflight. */
static nt_session_setup setup_of(void)
{
    nt_session_setup setup = nt_session_defaults();
    setup.rig.master.gauge = setup.rig.master.motor = 0;
    setup.rig.stage.axes = 1.0;
    setup.rig.stage.resonance = 100.0;
    setup.rig.stage.quality = 1.0;
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.settings.gains.rate = RATE;
    setup.settings.gains.alpha_p = 1e-3;
    setup.clearance = 1e-6;
    setup.preflight = 0;
    return setup;
}

static nt_record records[MOST];
static long count;

/* Until it has made so many ticks; returns the seconds that took. */
static double play(nt_session *session, nt_pace pace, long ticks)
{
    const int64_t begun = clock_now();
    assert_int_equal(nt_session_start(session, pace, (uint64_t)ticks), NT_OK);
    while (nt_session_progress(session).runs)
        sleep_until(clock_now() + 2000000);
    assert_int_equal(nt_session_halt(session), NT_OK);
    count = nt_session_read(session, records, MOST);
    assert_int_equal(count, ticks);
    return 1e-9 * (double)(clock_now() - begun);
}

/* Called stale just when it is: a thread that is stopped between reading and clock ages even what has just come. */
static void only_what_is_old_is_stale(const nt_record *r)
{
    assert_int_equal((r->reasons & NT_REASON_MASTER_STALE) != 0, r->master_age > 2.0 / RATE && r->age <= 2.0 / RATE);
    assert_int_equal((r->reasons & NT_REASON_STALE) != 0, r->age > 2.0 / RATE);
}

/* What is not only late. */
static int is_held_for(const nt_record *r, uint32_t reason)
{
    return r->state == NT_HOLD && r->reasons & reason;
}

/* Each of its readings is a tick, none is held and none is lost; the stage goes as the hand does. */
static void its_readings_are_the_ticks(const nt_session *session, const metronome *m, int is_real)
{
    const double alpha_p = nt_session_touch(session)->settings.gains.alpha_p;
    double youngest = HUGE_VAL;
    assert_true(m->calls == m->sequence);
    for (long k = 1; k < count; k++) {
        const nt_record *r = &records[k];
        assert_true(r->tick == (uint64_t)k && r->master_age >= 0.0 && r->age >= 0.0);
        assert_true(fabs(r->master_position[NT_Z] - records[k - 1].master_position[NT_Z] - STEP) < 1e-15);
        assert_int_equal(r->reasons & NT_REASON_INVALID, 0);
        only_what_is_old_is_stale(r);
        youngest = smaller(youngest, r->master_age);
        if (!is_real)
            assert_true(r->lateness == 0.0 && r->master_age == 0.0 && r->state == NT_RUN);
        if (r->state == NT_RUN && records[k - 1].state == NT_RUN && !(r->reasons & NT_REASON_COMMAND_LIMITED))
            assert_true(fabs(r->stage_command[NT_Z] - records[k - 1].stage_command[NT_Z]) < 3.0 * alpha_p * STEP);
    }
    assert_true(youngest < 0.25 / RATE); /* the tick begins when the reading has come, and the host's clock says so */
}

/* A mouse-like master at wall pace, a real one at hard pace; each leads a simulated slave. */
static void a_master_leads(void **state)
{
    (void)state;
    const nt_backend hand = backend_for(NT_HALF_MASTER);
    for (int is_real = 0; is_real < 2; is_real++) {
        metronome m = {.says = {.can = NT_LEADS_CLOCK | (is_real ? NT_IS_REAL : 0u), .axes = 1, .period = 1.0 / RATE},
                       .last = UINT64_MAX,
                       .step = STEP};
        nt_session_setup setup = setup_of();
        setup.master = (nt_hal_choice){&hand, &m};
        nt_session *session = open_session(&setup);
        const double took = play(session, is_real ? NT_PACE_HARD : NT_PACE_WALL, LIVES);
        assert_true(took > 0.9 * (LIVES - 1) / RATE); /* it does not run ahead of its leader */
        its_readings_are_the_ticks(session, &m, is_real);
        nt_session_close(session);
    }
}

/* And at free pace, where it is advanced by hand. */
static void a_master_leads_a_session_by_hand(void **state)
{
    (void)state;
    const nt_backend hand = backend_for(NT_HALF_MASTER);
    metronome m = {.says = {.can = NT_LEADS_CLOCK, .axes = 1}, .last = UINT64_MAX, .step = STEP};
    nt_session_setup setup = setup_of();
    setup.master = (nt_hal_choice){&hand, &m};
    nt_session *session = open_session(&setup);
    const int64_t begun = clock_now();
    run(session, records, LIVES);
    count = LIVES;
    assert_true(1e-9 * (double)(clock_now() - begun) > 0.9 * (LIVES - 1) / RATE);
    its_readings_are_the_ticks(session, &m, 0);
    nt_session_close(session);
}

/* The loop goes on at its own period: it does not spin, it does not stop. */
static void a_master_dies(void **state)
{
    (void)state;
    const nt_backend hand = backend_for(NT_HALF_MASTER);
    for (int i = 0; i < 6; i++) {
        const int is_real = i % 2;
        metronome m = {.says = {.can = NT_LEADS_CLOCK | (is_real ? NT_IS_REAL : 0u), .axes = 1},
                       .dies = (death)(i / 2),
                       .last = LIVES / 2};
        nt_session_setup setup = setup_of();
        setup.master = (nt_hal_choice){&hand, &m};
        nt_session *session = open_session(&setup);
        const double took = play(session, is_real ? NT_PACE_HARD : NT_PACE_WALL, LIVES);
        assert_true(took > 0.9 * (LIVES - 1) / RATE);
        const nt_record *end = &records[count - 1];
        if (m.dies == GONE)
            assert_true(end->state == NT_LATCHED && end->reasons & NT_REASON_DEVICE);
        else
            assert_true(is_held_for(end, NT_REASON_MASTER_STALE));
        for (long k = 0; k < LIVES / 2 - 1; k++) { /* alive until then; the first reading came at open */
            assert_int_equal(records[k].reasons & (NT_REASON_DEVICE | NT_REASON_INVALID), 0);
            only_what_is_old_is_stale(&records[k]);
        }
        nt_session_close(session);
    }
}

/* A real slave leads a hand of the simulation, dies, and is told to draw back. */
static void a_slave_leads_and_dies(void **state)
{
    (void)state;
    const nt_backend probe = backend_for(NT_HALF_SLAVE);
    for (int i = 0; i < 3; i++) {
        metronome m = {
            .says = {.can = NT_LEADS_CLOCK | NT_IS_REAL | NT_CAN_FEEL, .axes = 1}, .dies = (death)i, .last = LIVES / 2};
        nt_session_setup setup = setup_of();
        setup.slave = (nt_hal_choice){&probe, &m};
        nt_session *session = open_session(&setup);
        const double took = play(session, NT_PACE_HARD, LIVES);
        assert_true(took > 0.9 * (LIVES - 1) / RATE);
        const nt_record *end = &records[count - 1];
        for (long k = 0; k < LIVES / 2; k++) {
            assert_int_equal(records[k].reasons & (NT_REASON_INVALID | NT_REASON_DEVICE), 0);
            only_what_is_old_is_stale(&records[k]);
        }
        assert_int_equal(end->state, m.dies == GONE ? NT_LATCHED : NT_RETRACT);
        assert_true(end->reasons & (m.dies == GONE ? NT_REASON_DEVICE : NT_REASON_STALE));
        assert_true(m.position < 0.0); /* it has been told to lift */
        nt_session_close(session);
    }
}

static void what_a_leader_cannot_do_is_refused(void **state)
{
    (void)state;
    const nt_backend hand = backend_for(NT_HALF_MASTER);
    metronome m = {.says = {.can = NT_LEADS_CLOCK, .axes = 1, .period = 0.5 / RATE}, .last = UINT64_MAX};
    nt_session_setup setup = setup_of();
    setup.master = (nt_hal_choice){&hand, &m};
    nt_session *session = NULL;
    nt_problem problem = {0};
    assert_int_equal(nt_session_open(&session, &setup, &problem), NT_E_RANGE); /* the loop has another period */
    assert_string_equal(problem.field, "gains.rate (a half leads the clock)");
    assert_true(problem.value == RATE && problem.minimum == 2.0 * RATE);
    m = (metronome){.says = {.can = NT_LEADS_CLOCK, .axes = 1}, .last = UINT64_MAX};
    session = open_session(&setup);
    assert_int_equal(nt_session_start(session, NT_PACE_WALL, 0), NT_OK);
    assert_int_equal(nt_session_set_speed(session, 0.5, &problem), NT_E_RANGE); /* no slow motion of what is real */
    assert_string_equal(problem.field, "speed of a session whose clock a half leads");
    assert_int_equal(nt_session_set_speed(session, 1.0, &problem), NT_OK);
    assert_int_equal(nt_session_halt(session), NT_OK);
    nt_session_close(session);
    m = (metronome){.says = {.can = NT_LEADS_CLOCK | NT_IS_REAL, .axes = 1}, .last = UINT64_MAX};
    session = open_session(&setup);
    assert_int_equal(nt_session_start(session, NT_PACE_FREE, 0), NT_E_UNSUPPORTED);
    nt_session_close(session);
}

/* Where a hand has gone between open and start, and between two starts, moves no stage; after that it does. */
static void a_hand_that_moved_meanwhile_moves_nothing(void **state)
{
    (void)state;
    const nt_backend hand = backend_for(NT_HALF_MASTER);
    metronome m = {.says = {.can = NT_LEADS_CLOCK, .axes = 1}, .last = UINT64_MAX, .step = 0.0};
    nt_session_setup setup = setup_of();
    setup.master = (nt_hal_choice){&hand, &m};
    nt_session *session = open_session(&setup);
    for (int i = 0; i < 2; i++) {
        const double before = nt_session_touch_state(session)->reference;
        m.position += 0.5e-3; /* half a micrometre at the stage */
        (void)play(session, NT_PACE_WALL, 20);
        for (long k = 0; k < count; k++)
            assert_true(fabs(records[k].stage_command[NT_Z] - before) < 3e-9); /* it is read in steps */
        m.step = STEP;
        (void)play(session, NT_PACE_WALL, 20);
        assert_true(nt_session_touch_state(session)->reference - before > 15.0 * 1e-3 * STEP);
        m.step = 0.0;
    }
    nt_session_close(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_master_leads),
        cmocka_unit_test(a_master_leads_a_session_by_hand),
        cmocka_unit_test(a_master_dies),
        cmocka_unit_test(a_slave_leads_and_dies),
        cmocka_unit_test(what_a_leader_cannot_do_is_refused),
        cmocka_unit_test(a_hand_that_moved_meanwhile_moves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
