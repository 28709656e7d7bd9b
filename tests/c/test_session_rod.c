/* SPDX-License-Identifier: BSD-3-Clause
 * A rod in a session: its force acts on the lever, its moves are events, the same inputs give the same bits, and random
 * hands find neither energy nor a force beyond the promise.
 */
#include <string.h>

#include "assertions.h"
#include "internal/manipulation.h"
#include "internal/session.h"
#include "larger.h"
#include "nanotouch/nanotouch.h"
#include "session_fixture.h"

#define LOW 20e-9   /* height of the tip [m] */
#define RESTS 2e-15 /* what the sample itself holds is little beside it [J] */
enum { TICKS = 2000 };

static nt_rod wire(void)
{
    nt_rod rod = nt_rod_defaults();
    rod.tip_half_angle = 0.26;
    assert_int_equal(nt_rod_check(&rod, NULL), NT_OK);
    return rod;
}

/* A tip that begins beside it, in the height of the push. */
static nt_session_setup flat(const nt_rod *rod, double lever)
{
    nt_session_setup setup = nt_session_defaults();
    setup.scene.tip.radius = 20e-9;
    setup.scene.tip.half_angle = 0.26;
    setup.scene.medium.relative_humidity = 0.0;
    setup.rig.probe.spring_constant = 10.0;
    setup.rig.probe.lateral_stiffness = lever;
    setup.clearance = LOW;
    setup.minimum_margin = 0.0;
    setup.rod = rod;
    return setup;
}

static void lay(nt_session *session, double x, double y, double angle)
{
    assert_int_equal(nt_session_lay_rod(session, (double[3]){x, y, angle}), NT_OK);
}

/* The tip goes to a place within a time, and up by `up` of the master. */
static void go(nt_session *session, nt_record *records, double x, double y, double up)
{
    nt_input input = {.holds = 1, .x = x, .y = y, .duration = 0.18};
    input.master_position[NT_Z] = nt_session_master_start(session) - up;
    assert_int_equal(nt_session_aim(session, &input, NULL), NT_OK);
    run(session, records, TICKS);
}

/* The same rod led along the way that the records tell: every force is its own, and the lever bends by it. */
static void feels(double lever)
{
    static nt_record records[TICKS];
    static nt_rod_state beside;
    const nt_rod rod = wire();
    const nt_session_setup setup = flat(&rod, lever);
    nt_session *session = open_session(&setup);
    nt_rod own = rod;
    own.lever = lever;
    double largest = 0.0, off = 0.0, bent = 0.0;
    const double pose[3] = {0.5e-6, 0.25e-6, 0.3}, base[3] = {setup.x, setup.y, LOW};
    lay(session, pose[0], pose[1], pose[2]);
    assert_int_equal(nt_rod_place(&own, pose, base, &beside), NT_OK);
    const double way[4][2] = {{0.05e-6, 0.3e-6}, {0.5e-6, 0.6e-6}, {1.2e-6, 0.1e-6}, {0.0, 0.0}};
    for (int part = 0; part < 4; ++part) {
        go(session, records, way[part][0], way[part][1], 0.0);
        for (int i = 0; i < TICKS; ++i) {
            const nt_record *r = &records[i];
            const double to[3] = {r->stage_position[NT_X], r->stage_position[NT_Y], r->gap + r->surface_height};
            assert_int_equal(nt_rod_advance(&own, &beside, to), NT_OK);
            for (int axis = NT_X; axis <= NT_Z; ++axis) {
                largest = larger(largest, fabs(r->tip_force[axis]));
                if (axis < NT_Z)
                    off = larger(off, fabs(r->tip_force[axis] - beside.force[axis]));
            }
            bent = larger(bent, fabs(r->tip_force[NT_Z] - beside.force[2]));
        }
    }
    nt_session_particles found;
    assert_int_equal(nt_session_read_particles(session, &found), NT_OK);
    assert_true(largest > 30e-9);
    assert_true(off < 1e-7 * largest);
    assert_true(bent < 1e-4 * largest); /* beside the rod's own, van der Waals at 20 nm */
    assert_true(found.touches[0] >= 1 && found.length == rod.length && found.radius == rod.radius);
    assert_within(found.position[0][NT_X], beside.pose[0], 1e-11); /* of 8000 steps */
    assert_within(found.position[0][NT_Y], beside.pose[1], 1e-11);
    assert_within(found.angle[0], beside.pose[2], 1e-5);
    assert_true(fabs(found.angle[0] - pose[2]) > 0.1); /* it was turned */
    nt_session_close(session);
}

static void a_tip_that_is_held_feels_it(void **state)
{
    (void)state;
    feels(0.0);
}

static void a_tip_on_a_lever_feels_it(void **state)
{
    (void)state;
    feels(40.0);
}

/* Twice from the beginning, and once more from a snapshot: the same bits. */
static void the_same_inputs_give_the_same_bits(void **state)
{
    (void)state;
    static nt_record first[TICKS], again[TICKS];
    const nt_rod rod = wire();
    const nt_session_setup setup = flat(&rod, 40.0);
    nt_session *sessions[2];
    nt_session_particles found[2] = {{0}, {0}};
    nt_snapshot *snapshot;
    for (int i = 0; i < 2; ++i) {
        sessions[i] = open_session(&setup);
        lay(sessions[i], 0.4e-6, 0.2e-6, 0.1);
        go(sessions[i], i ? again : first, 0.1e-6, 0.25e-6, 0.0);
    }
    assert_memory_equal(first, again, sizeof first);
    assert_int_equal(nt_session_snapshot(sessions[0], &snapshot), NT_OK);
    go(sessions[0], first, -0.2e-6, 0.4e-6, 0.0);
    go(sessions[1], again, -0.2e-6, 0.4e-6, 0.0);
    assert_memory_equal(first, again, sizeof first);
    assert_int_equal(nt_session_restore(sessions[0], snapshot, NULL), NT_OK);
    go(sessions[0], first, -0.2e-6, 0.4e-6, 0.0);
    assert_memory_equal(first, again, sizeof first);
    for (int i = 0; i < 2; ++i)
        assert_int_equal(nt_session_read_particles(sessions[i], &found[i]), NT_OK);
    assert_memory_equal(found[0].position, found[1].position, sizeof found[0].position);
    assert_memory_equal(found[0].angle, found[1].angle, sizeof found[0].angle);
    assert_memory_equal(&found[0].dissipated, &found[1].dissipated, sizeof found[0].dissipated);
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
    const nt_rod rod = wire();
    const nt_session_setup setup = flat(&rod, 0.0);
    nt_session *session = open_session(&setup);
    lay(session, 0.4e-6, 0.2e-6, 0.1);
    go(session, records, 0.1e-6, 0.25e-6, 0.0);
    assert_int_equal(nt_session_lay_rod(session, (double[3]){0.4e-6, 0.2e-6, 0.1}), NT_E_STATE); /* the tip is at it */
    go(session, records, 0.0, 0.0, 0.0);
    const long count = nt_session_read_events(session, events, 16);
    long pushed = -1;
    for (long i = 0; i < count; ++i)
        pushed = events[i].kind == NT_EVENT_PUSHED ? i : pushed;
    assert_int_equal(events[0].kind, NT_EVENT_LAY_ROD);
    assert_true(pushed > 0 && pushed + 1 < count);
    assert_int_equal(events[pushed + 1].kind, NT_EVENT_TURNED);
    nt_session_particles found;
    assert_int_equal(nt_session_read_particles(session, &found), NT_OK);
    const double *moved = events[pushed].value, *turned = events[pushed + 1].value;
    assert_within(moved[3], found.position[0][NT_Y], 1e-9);
    assert_within(turned[1], found.angle[0], 1e-3);
    assert_true(moved[1] == 0.2e-6 && moved[3] > 0.22e-6 && turned[0] == 0.1);
    lay(session, moved[0], moved[1], turned[0]);
    assert_int_equal(nt_session_read_particles(session, &found), NT_OK);
    assert_true(found.position[0][NT_X] == 0.4e-6 && found.angle[0] == 0.1);
    assert_within(found.stored, 0.0, 1e-25);
    nt_session_close(session);
}

static void refused(const nt_session_setup *setup, const char *field)
{
    nt_session *session;
    nt_problem problem;
    assert_int_equal(nt_session_open(&session, setup, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, field);
}

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    nt_rod rod = wire(), soft = wire();
    nt_particles particles;
    nt_particles_setup balls = nt_particles_defaults();
    assert_int_equal(nt_particles_init(&particles, &balls, NULL), NT_OK);
    nt_session_setup setup = flat(&rod, 0.0);
    setup.particles = &particles;
    refused(&setup, "rod beside particles (a session has the one or the other)");
    setup = flat(&rod, 0.0);
    setup.probe_model = NT_PROBE_DYNAMIC;
    refused(&setup, "rod with a dynamic probe");
    setup = flat(&rod, 0.0);
    setup.scene.tip.half_angle = 0.3;
    refused(&setup, "rod.tip_half_angle (that of the scene)");
    setup = flat(&rod, 0.0);
    setup.scene.tip.radius = 30e-9;
    refused(&setup, "rod.tip_radius (that of the scene)");
    soft.tip_stiffness = 25.0; /* enough against its friction, and not under 400 nN */
    setup = flat(&soft, 0.0);
    refused(&setup, "rod.tip_stiffness (a tip that does not go through it under the force limit)");
    soft.elements = 10.5;
    setup = flat(&soft, 0.0);
    refused(&setup, "elements (a whole number)");
}

static void what_cannot_be_laid_is_refused(void **state)
{
    (void)state;
    nt_rod rod = wire();
    nt_problem problem;
    nt_session_setup setup = flat(NULL, 0.0);
    nt_session *session = open_session(&setup);
    assert_int_equal(nt_session_lay_rod(session, (double[3]){0.8e-6, 0.0, 0.0}), NT_E_UNSUPPORTED);
    nt_session_close(session);
    setup = flat(&rod, 0.0);
    session = open_session(&setup);
    assert_int_equal(nt_session_lay(session, 0, (double[2]){0.8e-6, 0.0}), NT_E_UNSUPPORTED); /* no sphere */
    assert_int_equal(nt_session_lay_rod(session, (double[3]){0.8e-6, 0.0, NAN}), NT_E_NOT_FINITE);
    assert_int_equal(nt_session_lay_rod(session, (double[3]){0.8e-6, 0.0, 0.0}), NT_E_STATE); /* the tip is there */
    assert_int_equal(nt_session_lay_rod(session, (double[3]){1.3e-6, 0.0, 0.0}), NT_OK);
    assert_int_equal(nt_session_change(session, NT_EVENT_SCENE, "tip.radius", 40e-9, &problem), NT_E_ARGUMENT);
    nt_session_close(session);
}

/* What a hand has done along the records: their forces over the way of the tip. */
typedef struct account {
    double at[3], force[3]; /* of the last record */
    double work, turnover;  /* [J] */
    double sideways, up;    /* largest forces [N] */
} account;

static void add(account *of, const nt_record *record)
{
    const double to[3] = {record->stage_position[NT_X], record->stage_position[NT_Y],
                          larger(record->gap + record->surface_height, 0.0)};
    double work = 0.0;
    for (int axis = NT_X; axis <= NT_Z; ++axis) {
        work -= 0.5 * (of->force[axis] + record->tip_force[axis]) * (to[axis] - of->at[axis]);
        of->force[axis] = record->tip_force[axis];
        of->at[axis] = to[axis];
    }
    of->work += work;
    of->turnover += fabs(work);
    of->sideways = larger(of->sideways, hypot(record->tip_force[NT_X], record->tip_force[NT_Y]));
    of->up = larger(of->up, fabs(record->tip_force[NT_Z]));
}

/* Hands that go anywhere, against it and over it too: heat never falls, the recorded forces over the way of the tip pay
 * for what is stored and for the heat, and no force goes beyond the promise. */
static void random_hands_find_no_energy(void **state)
{
    (void)state;
    static nt_record records[TICKS];
    nt_random random = nt_random_seed(3);
    const nt_rod rod = wire();
    const uint32_t allowed = NT_REASON_BACKED_OFF | NT_REASON_FORCE_LIMIT; /* pressed on its top from above */
    double hot = 0.0, off = 0.0, sideways = 0.0, up = 0.0;
    for (int hand = 0; hand < 6; ++hand) {
        const nt_session_setup setup = flat(&rod, hand % 2 ? 40.0 : 0.0);
        nt_session *session = open_session(&setup);
        const nt_guarantee promised = nt_session_guarantee(session);
        account of = {.at = {setup.x, setup.y, LOW}};
        nt_session_particles found = {0};
        double heat = 0.0;
        lay(session, 0.6e-6, 0.2e-6, 0.6 * nt_random_uniform(&random) - 0.45);
        for (int way = 0; way < 6; ++way) {
            const double x = 1.2e-6 * nt_random_uniform(&random), y = 0.5e-6 * nt_random_uniform(&random);
            const double up_by = 150e-9 * nt_random_uniform(&random) - 15e-9;
            go(session, records, x, y, -up_by / setup.settings.gains.alpha_p);
            for (int i = 0; i < TICKS; ++i) {
                add(&of, &records[i]);
                assert_int_equal(records[i].reasons & ~allowed, 0);
            }
            assert_int_equal(nt_session_read_particles(session, &found), NT_OK);
            assert_true(found.dissipated >= heat && found.stored >= 0.0);
            heat = found.dissipated;
        }
        hot = larger(hot, heat);
        off = larger(off, fabs(of.work - found.stored - found.dissipated) / (of.turnover + RESTS));
        sideways = larger(sideways, of.sideways / promised.lateral_force);
        up = larger(up, of.up / promised.force);
        nt_session_close(session);
    }
    print_message("heat %g J; account off by %g; of the promise: sideways %g, up %g\n", hot, off, sideways, up);
    assert_true(hot > 1e-15);
    assert_true(off < 5e-3);
    assert_true(sideways < 1.0 + 1e-8 && sideways > 0.5);
    assert_true(up < 1.0);
}

/* A promise with a rod is never less than one without: it may resist with q L. */
static void the_promise_counts_it(void **state)
{
    (void)state;
    const nt_rod rod = wire();
    const nt_session_setup with = flat(&rod, 0.0), without = flat(NULL, 0.0);
    nt_session *sessions[] = {open_session(&with), open_session(&without)};
    const nt_guarantee more = nt_session_guarantee(sessions[0]), less = nt_session_guarantee(sessions[1]);
    assert_true(more.force >= less.force);
    assert_within(more.lateral_force - less.lateral_force, nt_rod_friction(&rod) * rod.length, 1e-15);
    nt_session_close(sessions[0]);
    nt_session_close(sessions[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tip_that_is_held_feels_it),        cmocka_unit_test(a_tip_on_a_lever_feels_it),
        cmocka_unit_test(the_same_inputs_give_the_same_bits), cmocka_unit_test(a_push_is_an_event_and_can_be_undone),
        cmocka_unit_test(what_cannot_be_is_refused),          cmocka_unit_test(what_cannot_be_laid_is_refused),
        cmocka_unit_test(random_hands_find_no_energy),        cmocka_unit_test(the_promise_counts_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
