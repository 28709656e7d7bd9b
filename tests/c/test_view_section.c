/* SPDX-License-Identifier: BSD-3-Clause
 * The section through a contact against the textbook: Hertz' and Boussinesq's displacements in closed form, the balance
 * of Maugis' zone, bodies that touch where they touch and nowhere else. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assertions.h"
#include "nanotouch/advanced/view.h"

static nt_plan plan;

static void make(const nt_scene *scene)
{
    const nt_plan_inputs inputs = {.scene = scene};
    assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
}

static nt_scene dry(void)
{
    nt_scene scene = nt_scene_defaults();
    scene.medium.relative_humidity = 0.0;
    scene.medium.film_thickness = 0.0;
    scene.adhesion.work_of_adhesion = 0.0;
    scene.adhesion.hamaker_constant = 0.0;
    return scene;
}

static nt_view_contact contact_at(double gap, double force)
{
    const nt_view_pose pose = {gap, force, 0.3};
    return nt_view_contact_at(&plan, NULL, &pose);
}

static double closer(const nt_view_contact *contact, double r)
{
    nt_view_profile profile;
    nt_view_section(contact, &r, &profile, 1);
    return (profile.tip - profile.rigid_tip) - profile.sample;
}

/* Johnson, Contact Mechanics, Eq. 3.42a: u = (p0/(2 a E*)) ((2a^2 - r^2) asin(a/r) + a sqrt(r^2 - a^2)), p0 = 2 E*
 * a/(pi R). */
static void hertz_as_in_the_textbook(void **state)
{
    (void)state;
    const nt_scene scene = dry();
    make(&scene);
    const nt_view_contact contact = contact_at(-1e-9, 1e-7);
    const double R = scene.tip.radius, a = sqrt(R * 1e-9);
    assert_within(contact.contact_radius, a, 1e-6 * a);
    for (double r = 0.1 * a; r < 8.0 * a; r += 0.31 * a) {
        const double root = r > a ? sqrt(r * r - a * a) : 0.0, angle = r > a ? asin(a / r) : 0.5 * NT_PI;
        const double outside = ((2.0 * a * a - r * r) * angle + a * root) / (NT_PI * R);
        const double expected = r <= a ? 1e-9 - r * r / (2.0 * R) : outside;
        assert_within(closer(&contact, r), expected, 1e-3 * 1e-9);
    }
}

/* Boussinesq: u = 2 delta/pi asin(a/r) outside a flat punch. */
static void punch_as_in_the_textbook(void **state)
{
    (void)state;
    nt_scene scene = dry();
    scene.tip.shape = NT_SHAPE_PUNCH;
    scene.tip.radius = 50e-9;
    make(&scene);
    const nt_view_contact contact = contact_at(-0.5e-9, 1e-7);
    nt_view_profile profile;
    for (double r = 51e-9; r < 400e-9; r += 37e-9) {
        nt_view_section(&contact, &r, &profile, 1);
        assert_true(isinf(profile.tip));
        assert_within(-profile.sample / 0.7, 2.0 * 0.5e-9 / NT_PI * asin(50e-9 / r), 1e-12);
    }
}

/* Far away any contact is a point load: u = F/(pi E* r) (Boussinesq). */
static void far_away_the_force_is_a_point_load(void **state)
{
    (void)state;
    nt_scene scene = nt_scene_defaults();
    scene.medium.relative_humidity = 0.0;
    scene.sample.youngs_modulus = 2e9;
    scene.adhesion.hamaker_constant = 0.0;
    make(&scene);
    const double gaps[] = {-2e-9, -0.5e-9, 0.0, 0.2e-9};
    for (int i = 0; i < 4; ++i) {
        const nt_interaction_state held = {1, 0.0, 0.0};
        const nt_law_value law = nt_interaction_eval_gap(&plan, &held, NULL, gaps[i]);
        const nt_view_contact contact = contact_at(gaps[i], law.F);
        const double r = 300.0 * contact.cohesive_radius;
        assert_within(closer(&contact, r) * NT_PI * contact.modulus * r, law.F, 2e-3 * plan.pull_off_force);
    }
}

/* At the edge of the zone the surfaces are h0 = w/sigma0 apart (Maugis 1992), inside it less. */
static void the_zone_ends_where_its_range_does(void **state)
{
    (void)state;
    nt_scene scene = nt_scene_defaults();
    scene.adhesion.hamaker_constant = 0.0;
    scene.sample.youngs_modulus = 5e9;
    make(&scene);
    const double range = plan.contact.work_of_adhesion / plan.contact.cohesive_stress;
    for (double gap = -1e-9; gap < 0.5e-9; gap += 0.25e-9) {
        const nt_interaction_state held = {1, 0.0, 0.0};
        const nt_view_contact contact = contact_at(gap, nt_interaction_eval_gap(&plan, &held, NULL, gap).F);
        assert_true(contact.cohesive_radius > contact.contact_radius);
        const double r[] = {contact.cohesive_radius, 0.7 * contact.cohesive_radius + 0.3 * contact.contact_radius};
        nt_view_profile profile[2];
        nt_view_section(&contact, r, profile, 2);
        assert_within(profile[0].tip - profile[0].sample, range, 0.02 * range);
        assert_true(profile[1].tip > profile[1].sample);
        assert_true(profile[1].tip - profile[1].sample < range);
    }
}

static void bodies_touch_inside_a_and_are_apart_outside(void **state)
{
    (void)state;
    const nt_scene scene = dry();
    make(&scene);
    const nt_view_contact contact = contact_at(-1e-9, 1e-7);
    for (double share = 0.0; share < 3.0; share += 0.1) {
        const double r = share * contact.contact_radius;
        nt_view_profile profile;
        nt_view_section(&contact, &r, &profile, 1);
        if (share < 1.0)
            assert_true(profile.tip == profile.sample);
        else if (share > 1.05)
            assert_true(profile.tip > profile.sample);
    }
}

static void the_force_tells_the_branch(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    make(&scene);
    const double gap = 0.5 * (plan.capture_gap + plan.release_gap);
    const nt_interaction_state apart = {0, 0.0, 0.0}, held = {1, 0.0, 0.0};
    assert_false(contact_at(gap, nt_interaction_eval_gap(&plan, &apart, NULL, gap).F).attached);
    assert_true(contact_at(gap, nt_interaction_eval_gap(&plan, &held, NULL, gap).F).attached);
    assert_false(contact_at(10.0 * plan.release_gap, 0.0).attached);
    assert_true(contact_at(-1e-10, 0.0).attached);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hertz_as_in_the_textbook),
        cmocka_unit_test(punch_as_in_the_textbook),
        cmocka_unit_test(far_away_the_force_is_a_point_load),
        cmocka_unit_test(the_zone_ends_where_its_range_does),
        cmocka_unit_test(bodies_touch_inside_a_and_are_apart_outside),
        cmocka_unit_test(the_force_tells_the_branch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
