/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "nanotouch/plan.h"
#include "scene/scene.h"

static nt_plan plan;

static void make(const nt_scene *scene)
{
    const nt_plan_inputs inputs = {.scene = scene};
    assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
}

static nt_scene dry_silicon(void)
{
    nt_scene scene = nt_scene_defaults();
    scene.medium.relative_humidity = 0.0;
    return scene;
}

static int warns_of(const char *word)
{
    int found = 0;
    for (int i = 0; i < plan.warning_count; ++i)
        found += strstr(plan.warnings[i].text, word) != NULL;
    return found;
}

/* Facts that what else the scene says leaves without effect are told, not passed over. */
static void what_is_not_used_is_told(void **state)
{
    (void)state;
    nt_scene scene = dry_silicon();
    make(&scene);
    assert_int_equal(warns_of("not used") + warns_of("does not act"), 0);
    scene.sample.conducting = 0;
    scene.adhesion.contact_potential = 1.0;
    scene.adhesion.pull_off_force = 12e-9;
    scene.medium.ionic_strength = 100.0;
    scene.medium.ph = 7.0;
    scene.medium.meniscus_radius = 1e-9;
    scene.tip.surface_potential = 0.02;
    make(&scene);
    const char *const told[] = {"contact potential", "pull-off force",   "ionic strength", "pH,",
                                "meniscus radius",   "surface potential"};
    for (int i = 0; i < 6; ++i)
        assert_int_equal(warns_of(told[i]), 1);
    scene.sample.conducting = 1;
    scene.adhesion.given = NT_ADHESION_GIVEN_PULL_OFF;
    scene.medium.kind = NT_MEDIUM_LIQUID;
    scene.tip.surface_potential = 0.0;
    make(&scene);
    assert_int_equal(warns_of("contact potential"), 1); /* ions screen it */
    assert_int_equal(warns_of("pull-off force") + warns_of("ionic strength") + warns_of("pH,"), 0);
}

/* What is never touched has no contact to warn of; what nothing pulls on is measured by its scale. */
static void warnings_are_of_what_is_visited(void **state)
{
    (void)state;
    nt_scene scene = dry_silicon();
    scene.range.maximum_load = 2.2e-6;
    make(&scene);
    assert_int_equal(warns_of("at the largest load"), 1);
    scene.range.minimum_gap = 10e-9;
    make(&scene);
    assert_int_equal(warns_of("at the largest load"), 0);
    scene = dry_silicon();
    scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
    scene.range.speed = 1e-6; /* 6 pi eta R^2 v/z0 = 0.7 fN; 1 % of a thousandth of 0.4 uN is 4 pN */
    make(&scene);
    assert_int_equal(warns_of("drag"), 0);
    scene.range.speed = 1.0; /* 0.7 nN */
    make(&scene);
    assert_int_equal(warns_of("drag"), 1);
}

/* Film, meniscus and humidity (erratum E4). */
static void what_no_one_humidity_makes_is_told(void **state)
{
    (void)state;
    nt_scene scene = nt_scene_defaults();
    make(&scene);
    assert_int_equal(warns_of("Kelvin") + warns_of("film"), 0);
    scene.medium.meniscus_radius = 1.3 * nt_scene_meniscus_radius(&scene);
    make(&scene);
    assert_int_equal(warns_of("Kelvin"), 1);
    for (int i = 0; i < plan.warning_count; ++i)
        if (strstr(plan.warnings[i].text, "Kelvin"))
            assert_true(fabs(plan.warnings[i].value - 1.3) < 1e-12 && plan.warnings[i].limit == 1.25);
    scene.medium.film_thickness = 5e-9;
    make(&scene);
    assert_int_equal(warns_of("film"), 1);
}

/* 135 where 135 GPa were meant. A gel in a liquid is as soft; a tip never is. */
static void moduli_of_no_solid_are_told(void **state)
{
    (void)state;
    nt_scene scene = dry_silicon();
    scene.sample.youngs_modulus = 3e3; /* a silicone gel */
    make(&scene);
    assert_int_equal(warns_of("Young's modulus"), 0);
    scene.sample.youngs_modulus = 1220.0; /* diamond, in GPa */
    make(&scene);
    assert_int_equal(warns_of("Young's modulus of the sample"), 1);
    assert_true(plan.warnings[0].value == 1220.0 && plan.warnings[0].limit == 2e3);
    assert_string_equal(plan.warnings[0].unit, "Pa");
    scene.medium.kind = NT_MEDIUM_LIQUID;
    make(&scene);
    assert_int_equal(warns_of("Young's modulus"), 0);
    scene.tip.youngs_modulus = 135.0;
    make(&scene);
    assert_int_equal(warns_of("Young's modulus of the tip"), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_not_used_is_told),
        cmocka_unit_test(warnings_are_of_what_is_visited),
        cmocka_unit_test(what_no_one_humidity_makes_is_told),
        cmocka_unit_test(moduli_of_no_solid_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
