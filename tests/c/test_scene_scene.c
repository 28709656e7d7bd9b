/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/plan.h"
#include "nanotouch/rig.h"
#include "nanotouch/scene.h"
#include "scene/scene.h"

static void defaults_are_valid(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    assert_int_equal(nt_scene_check(&scene, NULL), NT_OK);
}

/* Each number of the scene, just outside either end of its range and NaN: refused by its own name. */
static void every_field_is_refused_by_name(void **state)
{
    (void)state;
    int count = 0;
    const nt_field *fields = nt_scene_fields(&count);
    size_t end = 0;
    for (int i = 0; i < count; i++) {
        const nt_field *field = &fields[i];
        assert_true(field->offset - end < sizeof(double)); /* no number is without a check */
        end = field->offset + field->size;
        const int is_choice = field->size != sizeof(double);
        const double outside[] = {nextafter(field->minimum, -HUGE_VAL), nextafter(field->maximum, HUGE_VAL), NAN,
                                  HUGE_VAL};
        for (int j = 0; j < 4; j++) {
            nt_scene scene = nt_scene_defaults();
            nt_problem problem = {0};
            nt_field_set(field, &scene, outside[j]);
            assert_int_equal(nt_scene_check(&scene, &problem), j < 2 || is_choice ? NT_E_RANGE : NT_E_NOT_FINITE);
            assert_string_equal(problem.field, field->name);
        }
    }
    assert_int_equal(end, offsetof(nt_scene, custom));
}

/* Each table is given without its length, too. */
static void the_length_of_a_table_is_optional(void **state)
{
    (void)state;
    const nt_field *(*const tables[])(int *) = {nt_scene_fields, nt_demand_fields, nt_rig_fields};
    for (int i = 0; i < 3; i++) {
        int count = 0;
        assert_ptr_equal(tables[i](NULL), tables[i](&count));
        assert_true(count > 0);
    }
}

/* A radius in nanometres by mistake, no spring of matter, ...: what people type. */
static void mistakes_of_units_are_refused(void **state)
{
    (void)state;
    nt_scene scene = nt_scene_defaults();
    nt_problem problem = {0};
    scene.tip.radius = 20.0; /* nm */
    assert_int_equal(nt_scene_check(&scene, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "tip.radius");
    scene = nt_scene_defaults();
    scene.tip.youngs_modulus = 135.0; /* GPa; 100 Pa would be a very thin jelly */
    scene.sample.youngs_modulus = 0.05;
    assert_int_equal(nt_scene_check(&scene, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "sample.youngs_modulus");
    scene = nt_scene_defaults();
    scene.medium.relative_humidity = 40.0; /* percent */
    assert_int_equal(nt_scene_check(&scene, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "medium.relative_humidity");
}

static void adhesion_has_one_source(void **state)
{
    (void)state;
    nt_scene scene = nt_scene_defaults();
    assert_int_equal(nt_scene_adhesion_source(&scene), NT_ADHESION_MENISCUS);
    scene.medium.relative_humidity = 0.0;
    assert_int_equal(nt_scene_adhesion_source(&scene), NT_ADHESION_SOLID);
    scene.adhesion.work_of_adhesion = 0.0;
    assert_int_equal(nt_scene_adhesion_source(&scene), NT_ADHESION_NONE);
    scene.medium.relative_humidity = 0.4;
    scene.medium.surface_tension = 0.0;
    assert_int_equal(nt_scene_adhesion_source(&scene), NT_ADHESION_NONE);
}

/* Water at 25 C: gamma V/(R T) = 0.0720 * 1.8e-5/(8.31446 * 298.15) m = 0.52280 nm; ln 0.4 = -0.916291. */
static void meniscus_radius_is_kelvins_unless_given(void **state)
{
    (void)state;
    nt_scene scene = nt_scene_defaults();
    assert_true(fabs(nt_scene_meniscus_radius(&scene) / (0.52280e-9 / 0.916291) - 1.0) < 1e-4);
    scene.medium.meniscus_radius = 1.06e-9;
    assert_true(nt_scene_meniscus_radius(&scene) == 1.06e-9);
}

/* A truncated tip knows no adhesion: the refusal names what the adhesion follows from. */
static void adhesion_is_refused_by_its_source(void **state)
{
    (void)state;
    nt_scene scene = nt_scene_defaults();
    nt_problem problem = {0};
    scene.tip.shape = NT_SHAPE_TRUNCATED;
    assert_int_equal(nt_scene_check(&scene, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "medium.relative_humidity");
    scene.medium.relative_humidity = 0.0;
    assert_int_equal(nt_scene_check(&scene, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "adhesion.work_of_adhesion");
    scene.adhesion.given = NT_ADHESION_GIVEN_PULL_OFF;
    scene.adhesion.pull_off_force = 1e-9;
    assert_int_equal(nt_scene_check(&scene, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "adhesion.pull_off_force");
    assert_string_equal(problem.unit, "N");
    scene.adhesion.pull_off_force = 0.0;
    assert_int_equal(nt_scene_check(&scene, &problem), NT_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_valid),
        cmocka_unit_test(every_field_is_refused_by_name),
        cmocka_unit_test(the_length_of_a_table_is_optional),
        cmocka_unit_test(mistakes_of_units_are_refused),
        cmocka_unit_test(adhesion_has_one_source),
        cmocka_unit_test(meniscus_radius_is_kelvins_unless_given),
        cmocka_unit_test(adhesion_is_refused_by_its_source),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
