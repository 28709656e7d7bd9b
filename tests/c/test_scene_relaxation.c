/* SPDX-License-Identifier: BSD-3-Clause
 * Whether time matters over a sample that relaxes: the bounds of a plan against springs of this file and against Ting's
 * law, and what it refuses. With an argument: so many random samples instead of 6. */
#include <stdlib.h>
#include <string.h>

#include "assertions.h"
#include "internal/rheology.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/plan.h"
#include "rheology/profile.h"

enum { FINE = 800, TICKS = 2001 };
#define T 1e-3
static int draws = 6;
static nt_plan plan;

static nt_scene scene_of(nt_rheology_kind kind)
{
    nt_scene scene = nt_scene_defaults();
    scene.tip.shape = NT_SHAPE_PARABOLOID;
    scene.tip.radius = 2.5e-6;
    scene.tip.half_angle = 0.0;
    scene.sample.poisson_ratio = 0.5;
    scene.medium.kind = NT_MEDIUM_LIQUID;
    scene.medium.relative_humidity = 0.0;
    scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
    scene.range = (nt_range){-1e-5, 2e-9, 0.0, 1e-3, 0.0, 10.0};
    scene.rheology.kind = kind;
    return scene;
}

static nt_status make(const nt_scene *scene, const nt_demand *demand, nt_problem *problem)
{
    const nt_plan_inputs inputs = {.scene = scene, .demand = demand, .period = T};
    return nt_plan_make(&plan, &inputs, problem);
}

static double draw(nt_random *random, double low, double high)
{
    return low + (high - low) * nt_random_uniform(random);
}

/* Slow on stiff PDMS, one arm of a millisecond: elastic with E_inf. The same at a millimetre a second is not, nor
 * where the speed is not known; and a power law never is, but for an exponent of 0. */
static void a_slow_touch_stays_elastic(void **unused)
{
    (void)unused;
    nt_scene scene = scene_of(NT_RHEOLOGY_STANDARD_LINEAR_SOLID);
    scene.rheology.equilibrium_modulus = 2e6;
    scene.rheology.arm_moduli[0] = 2e5;
    scene.rheology.relaxation_times[0] = 1e-3;
    scene.range.maximum_load = 1e-6;
    scene.range.speed = 1e-7;
    assert_int_equal(make(&scene, NULL, NULL), NT_OK);
    assert_true(plan.history == NT_HISTORY_NONE && plan.relaxation.bed.springs == 0);
    assert_within(plan.relaxation.modulus, 2e6, 1.0);
    assert_true(plan.relaxation.error > 0.0 && plan.bound.force_error >= plan.relaxation.error &&
                plan.bound.force_error <= 0.01);
    scene.range.speed = 1e-3;
    assert_int_equal(make(&scene, NULL, NULL), NT_OK);
    assert_true(plan.history == NT_HISTORY_RELAXES && plan.relaxation.bed.arms == 1);
    scene.range.speed = 0.0;
    assert_int_equal(make(&scene, NULL, NULL), NT_OK);
    assert_true(plan.history == NT_HISTORY_RELAXES);
    scene = scene_of(NT_RHEOLOGY_POWER_LAW);
    scene.range.speed = 1e-9;
    assert_int_equal(make(&scene, NULL, NULL), NT_OK);
    assert_true(plan.history == NT_HISTORY_RELAXES);
    scene.rheology.exponent = 0.0;
    assert_int_equal(make(&scene, NULL, NULL), NT_OK);
    assert_true(plan.history == NT_HISTORY_NONE && plan.relaxation.error == 0.0);
}

/* Springs of our own, far finer, of an arm each way: the definition, with no regard to cost. */
typedef struct reference {
    const nt_rheology *of;
    nt_profile profile;
    double factor, deepest;
    double u[FINE], z[FINE][NT_RHEOLOGY_ARMS], depth[FINE], weight;
} reference;
static reference fine;

static void begin(const nt_scene *scene, double deepest)
{
    fine = (reference){.of = &scene->rheology, .factor = 4.0 / 3.0, .deepest = deepest};
    fine.profile = (nt_profile){.kind = NT_SHAPE_PARABOLOID};
    fine.weight = 2.0 * sqrt(scene->tip.radius * deepest) / FINE; /* of the contact's width */
    for (int i = 0; i < FINE; i++)
        fine.depth[i] = deepest * (i + 0.5) * (i + 0.5) / ((double)FINE * FINE);
}

static double advance(double indentation)
{
    double force = 0.0;
    for (int i = 0; i < FINE; i++) {
        const nt_rheology *of = fine.of;
        double held = of->equilibrium_modulus * fine.u[i], A = of->equilibrium_modulus;
        for (int k = 0; k < of->arm_count; k++) {
            const double x = T / of->relaxation_times[k];
            fine.z[i][k] *= exp(-x);
            held += of->arm_moduli[k] * fine.z[i][k];
            A += of->arm_moduli[k] * (1.0 - exp(-x)) / x;
        }
        double way = indentation - fine.depth[i] - fine.u[i];
        if (held + A * way > 0.0)
            force += fine.weight * (held + A * way);
        else
            way = -held / A;
        fine.u[i] += way;
        for (int k = 0; k < of->arm_count; k++)
            fine.z[i][k] += (1.0 - exp(-T / of->relaxation_times[k])) * of->relaxation_times[k] / T * way;
    }
    return fine.factor * force;
}

static nt_scene any_scene(nt_random *random)
{
    nt_scene scene = scene_of(NT_RHEOLOGY_PRONY);
    scene.rheology.equilibrium_modulus = 1e3 * pow(10.0, draw(random, 0.0, 2.0));
    scene.rheology.arm_count = 1 + (int)draw(random, 0.0, 2.999);
    for (int k = 0; k < scene.rheology.arm_count; k++) {
        scene.rheology.arm_moduli[k] = scene.rheology.equilibrium_modulus * draw(random, 0.1, 2.0);
        scene.rheology.relaxation_times[k] = 1e-3 * pow(10.0, draw(random, 0.0, 2.5));
    }
    return scene;
}

/* Pressed at random speeds, held, drawn back, pressed into the dent again: never past the max load. */
static double next_tip(nt_random *random, double tip, double force, double speed[2], double load)
{
    if (nt_random_uniform(random) < 0.02)
        *speed = draw(random, -1.0, 1.0) * speed[1] * (nt_random_uniform(random) < 0.3 ? 0.0 : 1.0);
    if (force > 0.9 * load && *speed > 0.0)
        *speed = -*speed;
    if (tip < -0.3e-6 && *speed < 0.0)
        *speed = -*speed;
    return tip + T * *speed;
}

/* The plan's springs against 800 of our own along any motion: within the bound of the max force so far, and within
 * its bound of the force while it only grows. The stiffness of a tick is within that of the plan. */
static void springs_keep_the_bound(void **unused)
{
    (void)unused;
    nt_random random = nt_random_seed(4343);
    const nt_demand rough = {.relative_accuracy = 0.05};
    for (int d = 0; d < draws; d++) {
        const nt_scene scene = any_scene(&random);
        if (d % 2 || make(&scene, NULL, NULL) != NT_OK) /* finer than 128 springs */
            assert_int_equal(make(&scene, &rough, NULL), NT_OK);
        assert_int_equal(plan.history, NT_HISTORY_RELAXES);
        const nt_viscoelastic_bed *bed = &plan.relaxation.bed;
        nt_viscoelastic_state state = {0};
        begin(&scene, bed->max_indentation);
        double tip = -1e-7, most = plan.scale, speed[2] = {2e-6, 1e-6 * pow(10.0, draw(&random, 0.0, 2.0))};
        int grows = 1;
        for (int i = 0; i < 400; i++) {
            const double to = next_tip(&random, tip, state.force, speed, scene.range.maximum_load);
            grows = grows && to >= tip;
            assert_int_equal(nt_viscoelastic_advance(bed, &state, to), NT_OK);
            const double truth = advance(to);
            most = larger(most, truth);
            const double over = grows ? larger(truth, plan.scale) : most;
            assert_true(fabs(state.force - truth) <= plan.bound.force_error * over);
            if (state.force <= scene.range.maximum_load)
                assert_true(state.stiffness <= plan.maximum_stiffness);
            tip = to;
        }
    }
}

/* Left out, time costs no more than was said, at any motion within the speed; and once at least a tenth of that. */
static void leaving_time_out_keeps_its_bound(void **unused)
{
    (void)unused;
    nt_random random = nt_random_seed(44);
    double closest = 0.0;
    for (int d = 0; d < draws; d++) {
        nt_scene scene = any_scene(&random);
        const nt_demand any = {.relative_accuracy = 0.5, .bound = NT_BOUND_KEPT};
        scene.range.speed = 0.05e-6;
        for (int k = 0; k < scene.rheology.arm_count; k++)
            scene.rheology.relaxation_times[k] *= 0.1;
        assert_int_equal(make(&scene, &any, NULL), NT_OK);
        if (plan.history != NT_HISTORY_NONE)
            continue;
        begin(&scene, 2.0 * plan.largest_indentation);
        const double E = plan.relaxation.modulus * fine.factor;
        double tip = -2e-9, force = 0.0, speed[2] = {scene.range.speed, scene.range.speed};
        for (int i = 0; i < 1500; i++) {
            tip = next_tip(&random, tip, force, speed, scene.range.maximum_load);
            tip = larger(tip, -5e-9);
            force = advance(tip);
            const double elastic = tip > 0.0 ? 4.0 / 3.0 * E * sqrt(scene.tip.radius * tip) * tip : 0.0;
            const double quadrature = 1e-3 * larger(force, plan.scale); /* of the 800 */
            assert_true(fabs(force - elastic) <= plan.relaxation.error * larger(force, plan.scale) + quadrature);
            closest = larger(closest,
                             fabs(force - elastic) / larger(force, plan.scale) / larger(plan.relaxation.error, 1e-3));
        }
    }
    assert_true(closest > 0.1);
}

/* A power law: along a triangle against Ting's law, which knows neither springs nor ticks. */
static void a_power_law_keeps_the_bound(void **unused)
{
    (void)unused;
    static double times[TICKS], positions[TICKS], forces[TICKS];
    const double exponents[] = {0.1, 0.2, 0.5};
    const nt_demand rough = {.relative_accuracy = 0.05};
    for (int j = 0; j < 3; j++) {
        nt_scene scene = scene_of(NT_RHEOLOGY_POWER_LAW);
        scene.rheology.exponent = exponents[j];
        assert_int_equal(make(&scene, &rough, NULL), NT_OK);
        const nt_viscoelastic_bed *bed = &plan.relaxation.bed;
        const nt_viscoelastic contact = {
            .shape = plan.shape, .rheology = scene.rheology, .poisson_ratio = scene.sample.poisson_ratio};
        double *workspace = malloc(sizeof(double) * (size_t)nt_viscoelastic_workspace(&contact, TICKS, 0));
        const nt_viscoelastic_path path = {times, positions, 0.0, TICKS, workspace};
        nt_viscoelastic_result result = {.forces = forces};
        nt_viscoelastic_state state = {0};
        double most = plan.scale;
        for (int i = 0; i < TICKS; i++) {
            times[i] = T * i;
            positions[i] = 0.3 * plan.largest_indentation * (i <= 1000 ? i : 2000 - i) / 1000.0;
        }
        assert_int_equal(nt_viscoelastic_run(&contact, &path, &result, NULL), NT_OK);
        for (int i = 0; i < TICKS; i++) {
            assert_int_equal(nt_viscoelastic_advance(bed, &state, positions[i]), NT_OK);
            most = larger(most, forces[i]);
            const double over = i <= 1000 ? larger(forces[i], plan.scale) : most;
            assert_true(fabs(state.force - forces[i]) <= plan.bound.force_error * over);
        }
        free(workspace);
    }
}

static void is_refused(const nt_scene *scene, const char *cause)
{
    nt_problem problem = {0};
    assert_int_equal(make(scene, NULL, &problem), NT_E_RANGE);
    assert_int_equal(problem.code, NT_PROBLEM_RELAXES_BESIDE);
    assert_string_equal(problem.field, "rheology.kind");
    assert_string_equal(problem.cause, cause);
}

static void refuses_what_it_does_not_know(void **unused)
{
    (void)unused;
    nt_scene scene = scene_of(NT_RHEOLOGY_POWER_LAW);
    scene.adhesion.work_of_adhesion = 1e-3;
    is_refused(&scene, "adhesion");
    scene = scene_of(NT_RHEOLOGY_PRONY);
    scene.friction.coefficient = 0.1;
    is_refused(&scene, "friction");
    scene = scene_of(NT_RHEOLOGY_PRONY);
    scene.sample.thickness = 1e-6;
    is_refused(&scene, "the thickness of a layer");
    scene = scene_of(NT_RHEOLOGY_PRONY);
    scene.tip.shape = NT_SHAPE_TRUNCATED;
    scene.tip.half_angle = 0.3;
    is_refused(&scene, "a blunted or truncated tip");
    scene = scene_of(NT_RHEOLOGY_PRONY);
    scene.medium.brush_thickness = 0.5e-6;
    scene.medium.brush_spacing = 80e-9;
    is_refused(&scene, "forces before contact");
    scene = scene_of(NT_RHEOLOGY_PRONY);
    nt_demand demand = nt_demand_defaults();
    nt_problem problem = {0};
    demand.quantity = NT_QUANTITY_STIFFNESS;
    assert_int_equal(make(&scene, &demand, &problem), NT_E_RANGE);
    assert_int_equal(problem.code, NT_PROBLEM_RELAXES_BESIDE);
    demand = nt_demand_defaults();
    demand.relative_accuracy = 1e-9; /* finer than 128 springs */
    assert_int_equal(make(&scene, &demand, &problem), NT_E_RANGE);
    assert_int_equal(problem.code, NT_PROBLEM_ACCURACY);
    demand.relative_accuracy = problem.minimum * 1.0001;
    assert_int_equal(make(&scene, &demand, &problem), NT_OK);
    assert_int_equal(plan.relaxation.bed.springs, NT_LOOP_SPRINGS);
    scene.tip.shape = NT_SHAPE_SPHERE;
    scene.range.maximum_load = 1e-6;
    assert_int_equal(make(&scene, NULL, &problem), NT_E_RANGE);
    assert_int_equal(problem.code, NT_PROBLEM_RELAXES_DEPTH);
    scene.range.maximum_load = 0.999 * problem.maximum;
    assert_int_equal(make(&scene, NULL, &problem), NT_OK);
    scene.rheology.arm_moduli[0] = (double)NAN;
    assert_int_equal(make(&scene, NULL, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "rheology.arm_modulus_1");
}

int main(int count, char **words)
{
    if (count > 1)
        draws = atoi(words[1]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slow_touch_stays_elastic),       cmocka_unit_test(springs_keep_the_bound),
        cmocka_unit_test(leaving_time_out_keeps_its_bound), cmocka_unit_test(a_power_law_keeps_the_bound),
        cmocka_unit_test(refuses_what_it_does_not_know),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
