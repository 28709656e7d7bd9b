/* SPDX-License-Identifier: BSD-3-Clause
 * A simulated or a real master on a simulated or a real slave, at hard pace: touch, HOLD, RETRACT, stop, close. Real
 * halves are shared objects (real_backend.c). A busy machine is late, and then a session holds: that is right, and no
 * fault here. So the story is told by ticks and reasons, the hand goes on until it is stopped, and ticks that are held
 * for lateness cost no patience, as long as the machine lets any others be. */
#define _POSIX_C_SOURCE 200809L

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "internal/session.h"
#include "larger.h"
#include "session_fixture.h"

#define RATE 500.0
#define PATIENCE 10000  /* ticks, but for those ... */
#define LATE_MOST 15000 /* ... that are held for lateness, of which there may be so many */

static int left; /* halves that have said so */

static void hear(void *context, const char *text)
{
    (void)context;
    left += strncmp(text, "left after ", 11) == 0;
}

/* A position device over a stage of one axis, whoever is simulated. */
static nt_session_setup setup_of(const nt_module *master, const nt_module *slave)
{
    nt_session_setup setup = nt_session_defaults();
    setup.rig.master.gauge = setup.rig.master.motor = 0;
    setup.rig.stage.axes = 1.0;
    setup.rig.stage.resonance = 100.0; /* far from the rate of the loop */
    setup.rig.stage.quality = 1.0;
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.settings.gains.rate = RATE;
    setup.settings.gains.alpha_p = 1e-3;
    setup.settings.limits.force = 0.4e-6;
    setup.clearance = 50e-9;
    setup.say = hear;
    setup.master.backend = master->backend;
    setup.slave.backend = slave->backend;
    return setup;
}

static double seconds(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* What has come, and in which order. */
typedef struct story {
    long ticks, late;
    int touched, held, retracted, latched;
    double deepest; /* travel [m] */
} story;

static void tell(story *s, const nt_record *r, int is_real)
{
    const int is_late = r->state == NT_HOLD && r->reasons & NT_REASON_LATE;
    if (s->ticks + s->late == 0)
        assert_true(fabs(r->stage_command[NT_Z]) < 3e-9); /* a hand that moved in preflight moves no stage */
    s->ticks += !is_late;
    s->late += is_late;
    s->touched |= is_real ? r->deflection[NT_Z] > 5e-9 : r->contact_radius > 0.0;
    s->held |= r->state == NT_HOLD && r->reasons & (NT_REASON_MASTER_STALE | NT_REASON_STALE);
    s->retracted |= r->state == NT_RETRACT && r->reasons & NT_REASON_FORCE_LIMIT;
    s->latched |= r->state == NT_LATCHED && r->reasons & NT_REASON_EMERGENCY_STOP;
    s->deepest = larger(s->deepest, r->stage_position[NT_Z]);
    assert_true(isnan(r->gap) == is_real); /* only a simulation knows */
}

/* Reads until it has happened, or patience is over. */
static void await(nt_session *session, story *s, const int *happened, int is_real)
{
    const struct timespec nap = {.tv_nsec = 2000000};
    nt_record r;
    while (!*happened && s->ticks < PATIENCE && s->late < LATE_MOST && nt_session_progress(session).runs) {
        if (nt_session_read(session, &r, 1) == 1)
            tell(s, &r, is_real);
        else
            (void)nanosleep(&nap, NULL);
    }
    if (!*happened)
        fail_msg("not seen in %ld ticks and %ld that were held for lateness", s->ticks, s->late);
}

/* A simulated hand presses on, at 0.5 mm/s through most of its travel, and its link is stale for three and a half
 * periods before it touches. */
static void press(nt_session *session)
{
    const nt_input input = {.master_position = {[NT_Z] = nt_session_master_start(session) + 15e-3},
                            .holds = 1,
                            .x = (double)NAN,
                            .y = (double)NAN,
                            .duration = 30.0};
    const nt_fault stale = {.kind = NT_FAULT_STALE, .channel = NT_CHANNEL_RIG, .start = 0.05, .duration = 3.5 / RATE};
    assert_int_equal(nt_session_inject(session, &stale), NT_OK);
    assert_int_equal(nt_session_aim(session, &input, NULL), NT_OK);
}

static void play(const nt_module *master, const nt_module *slave)
{
    const nt_session_setup setup = setup_of(master, slave);
    const int reals = (master->backend != NULL) + (slave->backend != NULL), is_real = slave->backend != NULL;
    const double begun = seconds();
    left = 0;
    nt_session *session = open_session(&setup);
    if (reals > 0) /* preflight has kept its deadlines: 50 ticks of tare, 200 of a move */
        assert_true(seconds() - begun >= 249.0 / RATE);
    assert_int_equal(nt_session_start(session, NT_PACE_FREE, 1), reals > 0 ? NT_E_UNSUPPORTED : NT_OK);
    assert_int_equal(nt_session_halt(session), NT_OK);
    if (is_real) /* what can hurt a sample runs by its deadlines alone */
        assert_int_equal(nt_session_start(session, NT_PACE_WALL, 1), NT_E_UNSUPPORTED);
    if (!master->backend)
        press(session);
    assert_int_equal(nt_session_start(session, NT_PACE_HARD, 0), NT_OK);
    story s = {0};
    const int *const order[] = {&s.held, &s.touched, &s.retracted};
    for (size_t i = 0; i < sizeof order / sizeof *order; i++)
        await(session, &s, order[i], is_real);
    nt_session_emergency_stop(session, 1);
    await(session, &s, &s.latched, is_real);
    assert_int_equal(nt_session_halt(session), NT_OK);
    assert_true(s.deepest > 50e-9 && s.deepest < 1e-6);
    nt_session_close(session);
    assert_int_equal(left, reals); /* each has been left safe, once */
}

static void all_pairings(void **state)
{
    (void)state;
    nt_module simulated = {0}, master, slave;
    assert_int_equal(nt_hal_load(&master, REAL_FOLDER "/real_master.so", NT_HALF_MASTER), NT_OK);
    assert_int_equal(nt_hal_load(&slave, REAL_FOLDER "/real_slave.so", NT_HALF_SLAVE), NT_OK);
    play(&simulated, &simulated);
    play(&master, &simulated);
    play(&simulated, &slave);
    play(&master, &slave);
    nt_hal_unload(&master);
    nt_hal_unload(&slave);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_pairings)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
