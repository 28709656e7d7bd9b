/* SPDX-License-Identifier: BSD-3-Clause
 * Particles in a session: their force acts on the lever, their moves are events, and the same inputs give the same
 * bits.
 */
#include <string.h>

#include "assertions.h"
#include "internal/manipulation.h"
#include "internal/session.h"
#include "larger.h"
#include "nanotouch/nanotouch.h"
#include "session_fixture.h"

#define R 500e-9   /* of the particles [m] */
#define LOW 300e-9 /* height of the tip [m] */
enum { TICKS = 2000 };

static nt_particles latex(void)
{
    nt_particles_setup setup = nt_particles_defaults();
    nt_particles made;
    setup.particle.radius = R;
    setup.particle.tip_radius = 50e-9;
    setup.particle.contacts[NT_AT_SUBSTRATE].rolling_distance = 4.2e-9;
    setup.particle.contacts[NT_AT_TIP].rolling_distance = 0.4e-9;
    setup.particle.contacts[NT_AT_TIP].work_of_adhesion = 0.01;
    assert_int_equal(nt_particles_init(&made, &setup, NULL), NT_OK);
    return made;
}

/* A tip on glass that begins beside them, in the height of the push. */
static nt_session_setup glass(const nt_particles *particles)
{
    nt_session_setup setup = nt_session_defaults();
    setup.scene.tip.radius = 50e-9;
    setup.scene.tip.half_angle = 0.26;
    setup.scene.sample.youngs_modulus = 70e9;
    setup.scene.medium.relative_humidity = 0.0;
    setup.rig.probe.spring_constant = 10.0;
    setup.clearance = LOW;
    setup.minimum_margin = 0.0;
    setup.particles = particles;
    return setup;
}

static void lay(nt_session *session, int number, double x, double y)
{
    assert_int_equal(nt_session_lay(session, number, (double[2]){x, y}), NT_OK);
}

/* The tip goes to a place within a time, and stays high or low as it is. */
static void go(nt_session *session, nt_record *records, double x, double y)
{
    nt_input input = {.holds = 1, .x = x, .y = y, .duration = 0.18};
    input.master_position[NT_Z] = nt_session_master_start(session);
    assert_int_equal(nt_session_aim(session, &input, NULL), NT_OK);
    run(session, records, TICKS);
}

/* The same particles led along the way that the records tell: every force is theirs, and the lever bends by it. */
static void the_lever_feels_them(void **state)
{
    (void)state;
    static nt_record records[TICKS];
    const nt_particles particles = latex();
    const nt_session_setup setup = glass(&particles);
    nt_session *session = open_session(&setup);
    nt_particles_state beside;
    lay(session, 0, 0.8e-6, 0.0);
    lay(session, 1, 1.85e-6, 0.1e-6);
    double largest = 0.0, off = 0.0, bent = 0.0;
    const double base[3] = {setup.x, setup.y, LOW};
    assert_int_equal(nt_particles_begin(&particles, base, &beside), NT_OK);
    assert_int_equal(nt_particles_lay(&particles, &beside, 0, (double[2]){0.8e-6, 0.0}), NT_OK);
    assert_int_equal(nt_particles_lay(&particles, &beside, 1, (double[2]){1.85e-6, 0.1e-6}), NT_OK);
    for (int part = 0; part < 4; ++part) {
        go(session, records, 0.3e-6 * (part + 1), 0.01e-6);
        for (int i = 0; i < TICKS; ++i) {
            const nt_record *r = &records[i];
            const double to[3] = {r->stage_position[NT_X], r->stage_position[NT_Y], r->gap + r->surface_height};
            assert_int_equal(nt_particles_advance(&particles, &beside, to), NT_OK);
            for (int axis = NT_X; axis < NT_Z; ++axis) {
                largest = larger(largest, fabs(r->tip_force[axis]));
                off = larger(off, fabs(r->tip_force[axis] - beside.force[axis]));
            }
            bent = larger(bent, fabs(r->tip_force[NT_Z]));
        }
    }
    nt_session_particles found;
    assert_int_equal(nt_session_read_particles(session, &found), NT_OK);
    assert_true(largest > 3e-9 && bent > 1e-9);
    assert_true(off < 1e-4 * largest);
    assert_true(found.position[1][NT_X] > 1.9e-6); /* it was pushed by its neighbour */
    for (int i = 0; i < 2; ++i)
        for (int axis = 0; axis < NT_AXES; ++axis)
            assert_within(found.position[i][axis], beside.particles[i].position[axis], 1e-11); /* of 8000 steps */
    assert_true(found.touches[0] >= 1 && found.touches[1] == 0);
    nt_session_close(session);
}

static void assert_same(const nt_session_particles *a, const nt_session_particles *b)
{
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->position, b->position, sizeof a->position);
    assert_memory_equal(&a->dissipated, &b->dissipated, sizeof a->dissipated);
    assert_memory_equal(a->losses, b->losses, sizeof a->losses);
}

/* Twice from the beginning, and once more from a snapshot: the same bits. */
static void the_same_inputs_give_the_same_bits(void **state)
{
    (void)state;
    static nt_record first[TICKS], again[TICKS];
    const nt_particles particles = latex();
    const nt_session_setup setup = glass(&particles);
    nt_session *sessions[2];
    nt_session_particles found[2];
    nt_snapshot *snapshot;
    for (int i = 0; i < 2; ++i) {
        sessions[i] = open_session(&setup);
        lay(sessions[i], 0, 0.8e-6, 0.0);
        lay(sessions[i], 1, 1.85e-6, 0.1e-6);
        go(sessions[i], i ? again : first, 0.5e-6, 0.0);
    }
    assert_memory_equal(first, again, sizeof first);
    assert_int_equal(nt_session_snapshot(sessions[0], &snapshot), NT_OK);
    go(sessions[0], first, 1.1e-6, 0.05e-6);
    go(sessions[1], again, 1.1e-6, 0.05e-6);
    assert_memory_equal(first, again, sizeof first);
    assert_int_equal(nt_session_restore(sessions[0], snapshot, NULL), NT_OK);
    go(sessions[0], first, 1.1e-6, 0.05e-6);
    assert_memory_equal(first, again, sizeof first);
    for (int i = 0; i < 2; ++i)
        assert_int_equal(nt_session_read_particles(sessions[i], &found[i]), NT_OK);
    assert_same(&found[0], &found[1]);
    nt_snapshot_close(snapshot);
    nt_session_close(sessions[0]);
    nt_session_close(sessions[1]);
}

/* What was laid and pushed is told; laid where it was before, a push is undone. */
static void a_push_is_an_event_and_can_be_undone(void **state)
{
    (void)state;
    static nt_record records[TICKS];
    nt_event events[16];
    const nt_particles particles = latex();
    const nt_session_setup setup = glass(&particles);
    nt_session *session = open_session(&setup);
    lay(session, 0, 0.8e-6, 0.0);
    go(session, records, 0.6e-6, 0.0);
    assert_int_equal(nt_session_lay(session, 0, (double[2]){0.8e-6, 0.0}), NT_E_STATE); /* the tip touches it */
    go(session, records, -0.3e-6, 0.0);
    const long count = nt_session_read_events(session, events, 16);
    long pushed = -1;
    for (long i = 0; i < count; ++i)
        pushed = events[i].kind == NT_EVENT_PUSHED ? i : pushed;
    assert_int_equal(events[0].kind, NT_EVENT_LAY);
    assert_true(pushed > 0);
    nt_session_particles found;
    assert_int_equal(nt_session_read_particles(session, &found), NT_OK);
    assert_within(events[pushed].value[2], found.position[0][NT_X], 1e-9);
    assert_true(events[pushed].value[0] == 0.8e-6 && events[pushed].value[2] > 0.9e-6);
    lay(session, 0, events[pushed].value[0], events[pushed].value[1]);
    assert_int_equal(nt_session_read_particles(session, &found), NT_OK);
    assert_true(found.position[0][NT_X] == 0.8e-6);
    assert_within(found.stored, 0.0, 1e-25);
    nt_session_close(session);
}

static void what_cannot_be_laid_is_refused(void **state)
{
    (void)state;
    nt_particles particles = latex();
    nt_session_setup setup = glass(NULL);
    nt_session *session = open_session(&setup);
    nt_session_particles found;
    nt_problem problem;
    assert_int_equal(nt_session_lay(session, 0, (double[2]){0.8e-6, 0.0}), NT_E_UNSUPPORTED);
    assert_int_equal(nt_session_read_particles(session, &found), NT_E_UNSUPPORTED);
    nt_session_close(session);
    setup = glass(&particles);
    setup.probe_model = NT_PROBE_DYNAMIC;
    assert_int_equal(nt_session_open(&session, &setup, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "particles with a dynamic probe");
    setup = glass(&particles);
    setup.scene.tip.radius = 40e-9;
    assert_int_equal(nt_session_open(&session, &setup, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "particles.tip_radius (that of the scene)");
    setup = glass(&particles);
    session = open_session(&setup);
    assert_int_equal(nt_session_lay(session, 1, (double[2]){0.8e-6, 0.0}), NT_E_CAPACITY);
    assert_int_equal(nt_session_lay(session, 0, (double[2]){NAN, 0.0}), NT_E_NOT_FINITE);
    assert_int_equal(nt_session_lay(session, 0, (double[2]){0.0, 0.0}), NT_E_STATE); /* the tip is there */
    assert_int_equal(nt_session_change(session, NT_EVENT_SCENE, "tip.radius", 40e-9, &problem), NT_E_ARGUMENT);
    nt_session_close(session);
}

/* A promise with particles is never less than one without, and tells what they may add. */
static void the_promise_counts_them(void **state)
{
    (void)state;
    const nt_particles particles = latex();
    const nt_session_setup with = glass(&particles), without = glass(NULL);
    nt_session *sessions[] = {open_session(&with), open_session(&without)};
    const nt_guarantee more = nt_session_guarantee(sessions[0]), less = nt_session_guarantee(sessions[1]);
    assert_true(more.force >= less.force && more.lateral_force > less.lateral_force);
    print_message("force %g N (%g without), sideways %g N (%g)\n", more.force, less.force, more.lateral_force,
                  less.lateral_force);
    nt_session_close(sessions[0]);
    nt_session_close(sessions[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_lever_feels_them),
        cmocka_unit_test(the_same_inputs_give_the_same_bits),
        cmocka_unit_test(a_push_is_an_event_and_can_be_undone),
        cmocka_unit_test(what_cannot_be_laid_is_refused),
        cmocka_unit_test(the_promise_counts_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
