/* SPDX-License-Identifier: BSD-3-Clause
 * The frame of a tick is its record, in the world's axes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/observer.h"
#include "internal/session.h"
#include "larger.h"
#include "nanotouch/advanced/observer.h"
#include "session_fixture.h"

static void expect_frame(const nt_frame *frame, const nt_record *record, const nt_session *session)
{
    const double base = nt_session_start_height(session) - record->stage_position[NT_Z];
    assert_true(frame->sequence == record->tick && frame->time == record->time);
    assert_true(frame->base_height == base && frame->deflection == record->deflection[NT_Z]);
    assert_true(frame->tip_position[0] == record->stage_position[NT_X]);
    assert_true(frame->tip_position[1] == record->stage_position[NT_Y]);
    const double tilt = nt_session_touch(session)->rig.probe.tilt;
    assert_true(frame->tip_position[2] == base + record->deflection[NT_Z] * cos(tilt));
    for (int i = 0; i < NT_AXES; i++) {
        assert_true(frame->tip_force[i] == record->tip_force[i]);
        assert_true(i == NT_Z ? frame->master_position[i] == record->master_position[i]
                              : isnan(frame->master_position[i])); /* it has one axis */
        assert_true(frame->motor_force[i] == record->motor_force[i]);
    }
    assert_true(frame->gap == record->gap && frame->contact_radius == record->contact_radius);
    assert_true(frame->cohesive_radius >= frame->contact_radius); /* the zone is around the contact */
    assert_true(frame->neck_radius == frame->cohesive_radius);    /* water is the source of its adhesion */
    assert_true(frame->state == record->state && frame->reasons == record->reasons && frame->phase == record->phase);
}

/* As nt_session_step returns it, and as an observer sees it, in contact. */
static void a_frame_is_the_record(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    setup.clearance = 10e-9;
    nt_session *session = open_session(&setup);
    assert_int_equal(nt_session_publish(session, NULL), NT_OK);
    nt_observer *observer = NULL;
    assert_int_equal(nt_observer_of(&observer, nt_session_frames(session)), NT_OK);
    const nt_input input = {.operator_force = {[NT_Z] = 1.0}, .x = 1e-7, .y = 2e-7, .duration = 0.1};
    int touched = 0;
    for (int i = 0; i < 3000; i++) {
        nt_frame stepped, seen;
        nt_record record;
        assert_int_equal(nt_session_step(session, i == 0 ? &input : NULL, &stepped), NT_OK);
        assert_int_equal(nt_session_read(session, &record, 1), 1);
        expect_frame(&stepped, &record, session);
        assert_int_equal(nt_observer_read(observer, &seen, 1), 1);
        assert_memory_equal(&seen, &stepped, sizeof seen);
        touched |= stepped.contact_radius > 0.0;
    }
    assert_true(touched);
    nt_observer_close(observer);
    nt_session_close(session);
}

/* Down and up again; each frame with a zone is shown. */
static void touch_and_leave(const nt_session_setup *setup, void (*look)(const nt_plan *plan, const nt_frame *frame),
                            int *contacts, int *held)
{
    nt_session *session = open_session(setup);
    const double forces[] = {1.0, -0.5};
    for (int way = 0; way < 2; way++) {
        push(session, forces[way], 0.1);
        for (int i = 0; i < 6000; i++) {
            nt_frame frame;
            nt_record record;
            assert_int_equal(nt_session_step(session, NULL, &frame), NT_OK);
            assert_int_equal(nt_session_read(session, &record, 1), 1);
            if (frame.cohesive_radius > 0.0)
                look(nt_session_plan(session), &frame);
            *contacts += frame.contact_radius > 0.0;
            *held += frame.contact_radius == 0.0 && frame.cohesive_radius > 0.0;
        }
    }
    nt_session_close(session);
}

/* A stiff lever, which neither snaps in nor off: the bridge is seen apart, too. */
static nt_session_setup exact_setup(double youngs_modulus)
{
    nt_session_setup setup = nt_session_defaults();
    setup.demand.bound = NT_BOUND_EXACT;
    setup.clearance = 10e-9;
    setup.rig.probe.spring_constant = 500.0;
    setup.scene.sample.youngs_modulus = setup.scene.tip.youngs_modulus = youngs_modulus;
    setup.minimum_margin = 0.0;
    setup.settings = nt_settings_defaults(&setup.rig);
    return setup;
}

/* Griffith's equation of Maugis (1992), which the frame does not use: a and m = c/a at equilibrium. */
static double worst_of_griffith;
static void by_griffith(const nt_plan *plan, const nt_frame *frame)
{
    const nt_contact *contact = &plan->contact;
    const double a = frame->contact_radius / plan->maugis.radius_scale,
                 m = frame->cohesive_radius / frame->contact_radius;
    const double lambda = plan->maugis.lambda;
    if (frame->contact_radius == 0.0) { /* apart: the pull is the stress over the zone */
        const double area = 3.14159265358979 * frame->cohesive_radius * frame->cohesive_radius;
        const double force = nt_plan_term_eval(plan, NT_PLAN_CONTACT, frame->gap).F;
        assert_true(fabs(force + contact->cohesive_stress * area) < 1e-6 * fabs(force));
        return;
    }
    const double root = sqrt(m * m - 1.0), angle = acos(1.0 / m);
    const double one = 0.5 * lambda * a * a * ((m * m - 2.0) * angle + root) +
                       4.0 / 3.0 * lambda * lambda * a * (root * angle - m + 1.0);
    worst_of_griffith = larger(worst_of_griffith, fabs(one - 1.0));
}

static void the_zone_is_that_of_maugis(void **state)
{
    (void)state;
    int contacts = 0, held = 0;
    const nt_session_setup setup = exact_setup(5e9);
    worst_of_griffith = 0.0;
    touch_and_leave(&setup, by_griffith, &contacts, &held);
    print_message("%d in contact, %d held apart; Griffith off by %.1e\n", contacts, held, worst_of_griffith);
    assert_true(contacts > 1000 && held > 0);
    assert_true(worst_of_griffith < 1e-6);
}

/* Rigid bodies, apart: the bridge ends where the gap is that of a meniscus of radius r1 (Israelachvili, Eq. 17.37):
 * x^2 = 2 R (2 r1 - h). */
static const double r1 = 1e-9;
static void by_israelachvili(const nt_plan *plan, const nt_frame *frame)
{
    if (frame->contact_radius > 0.0)
        return;
    const double square = 2.0 * plan->contact.radius * (2.0 * r1 - frame->gap);
    assert_true(fabs(frame->neck_radius * frame->neck_radius - square) < 0.01 * square);
}

static void the_neck_is_that_of_a_meniscus(void **state)
{
    (void)state;
    int contacts = 0, held = 0;
    nt_session_setup setup = exact_setup(9e12);
    setup.scene.medium.meniscus_radius = r1;
    touch_and_leave(&setup, by_israelachvili, &contacts, &held);
    assert_true(held > 0);
}

static nt_frame pressed(const nt_session_setup *setup)
{
    nt_session *session = open_session(setup);
    nt_frame frame;
    push(session, 1.0, 0.1);
    for (int i = 0; i < 4000; i++) {
        nt_record record;
        assert_int_equal(nt_session_step(session, NULL, &frame), NT_OK);
        assert_int_equal(nt_session_read(session, &record, 1), 1);
    }
    nt_session_close(session);
    return frame;
}

/* The table of a plan for 1 % is as good as that; without adhesion no law of the plan has a zone. */
static void other_forms_of_contact(void **state)
{
    (void)state;
    nt_session_setup setup = exact_setup(5e9);
    const nt_frame exact = pressed(&setup);
    setup.demand.bound = NT_BOUND_KEPT;
    const nt_frame table = pressed(&setup);
    print_message("c %.4f nm exact, %.4f nm by the plan for 1 %%\n", 1e9 * exact.cohesive_radius,
                  1e9 * table.cohesive_radius);
    assert_true(exact.cohesive_radius > exact.contact_radius && exact.contact_radius > 0.0);
    assert_true(fabs(table.cohesive_radius - exact.cohesive_radius) < 0.01 * exact.cohesive_radius);
    setup.scene.medium.kind = NT_MEDIUM_VACUUM;
    setup.scene.adhesion.work_of_adhesion = 0.0;
    setup.scene.adhesion.hamaker_constant = 0.0; /* or the sample would jump to the tip: refused */
    const nt_frame dry = pressed(&setup);
    assert_true(dry.contact_radius > 0.0 && isnan(dry.cohesive_radius) && dry.neck_radius == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_frame_is_the_record),
        cmocka_unit_test(the_zone_is_that_of_maugis),
        cmocka_unit_test(the_neck_is_that_of_a_meniscus),
        cmocka_unit_test(other_forms_of_contact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
