/* SPDX-License-Identifier: BSD-3-Clause
 * A scene that changes while the tip rubs: over all pairs of plan forms, a tip that is lifted afterwards keeps no force
 * of contact and none of a history. What is left is what the new plan plans far away, asked here of an interaction that
 * has never touched. */
#include <stdio.h>

#include "assertions.h"
#include "hal/sim/sim.h"
#include "larger.h"
#include "nanotouch/advanced/sim.h"
#include "nanotouch/advanced/terrain.h"
#include "nanotouch/nanotouch.h"

#define T 1e-4
#define CLEARANCE 20e-9
enum { N = 16, FORMS = 16 };

typedef struct form {
    const char *name;
    void (*set)(nt_scene *scene);
    double accuracy; /* demanded [-] */
} form;

static void dry(nt_scene *scene)
{
    scene->medium.relative_humidity = scene->adhesion.work_of_adhesion = scene->adhesion.hamaker_constant = 0.0;
}

static void water(nt_scene *scene)
{
    scene->medium.relative_humidity = 0.5;
}

static void solid(nt_scene *scene)
{
    scene->medium.relative_humidity = 0.0;
}

static void soft(nt_scene *scene)
{
    scene->medium.relative_humidity = 0.0;
    scene->sample.youngs_modulus = 3e9;
}

static void rub(nt_scene *scene)
{
    scene->friction = (nt_scene_friction){200e6, 0.3, 0.005};
}

static void solid_rubbed(nt_scene *scene)
{
    solid(scene);
    rub(scene);
}

static void water_rubbed(nt_scene *scene)
{
    water(scene);
    rub(scene);
}

static void dry_sheared(nt_scene *scene)
{
    dry(scene);
    scene->friction.shear_strength = 200e6;
}

static void soft_loaded(nt_scene *scene)
{
    soft(scene);
    scene->friction.coefficient = 0.5;
}

static void nearly_smooth(nt_scene *scene)
{
    dry(scene);
    scene->friction.shear_strength = 1e3;
}

static void biased(nt_scene *scene)
{
    dry(scene);
    rub(scene);
    scene->tip.conducting = scene->sample.conducting = scene->sample.grounded = 1;
    scene->adhesion.contact_potential = 2.0;
}

static void dented(nt_scene *scene)
{
    dry(scene);
    scene->sample.dents = 1;
    scene->sample.yield_strength = 3e9;
}

static void dented_rubbed(nt_scene *scene)
{
    dented(scene);
    rub(scene);
}

static void gel(nt_scene *scene)
{
    soft(scene);
    scene->sample.youngs_modulus = 50e6;
    scene->friction.shear_strength = 1e6;
}

static void salt_water(nt_scene *scene)
{
    scene->medium.kind = NT_MEDIUM_LIQUID;
    scene->medium.ionic_strength = 1.0;
    scene->tip.surface_potential = scene->sample.surface_potential = -0.05;
    rub(scene);
}

static void kept_apart(nt_scene *scene)
{
    solid(scene);
    scene->range.minimum_gap = 5e-9;
}

static const form forms[FORMS] = {
    {"dry", dry, 1e-3},
    {"water", water, 1e-3},
    {"solid", solid, 1e-3},
    {"solid, loosely", solid, 0.3},
    {"soft", soft, 1e-3},
    {"solid, rubbed", solid_rubbed, 1e-3},
    {"water, rubbed", water_rubbed, 1e-2},
    {"dry, sheared", dry_sheared, 1e-3},
    {"soft, friction by load", soft_loaded, 1e-3},
    {"friction left out", nearly_smooth, 1e-2},
    {"biased", biased, 1e-2},
    {"dents", dented, 1e-3},
    {"dents, rubbed", dented_rubbed, 1e-3},
    {"gel", gel, 1e-2},
    {"salt water", salt_water, 1e-2},
    {"kept apart", kept_apart, 1e-2},
};

/* Of each place of a relief. */
static int is_local(const nt_plan *plan)
{
    return plan->terms[NT_PLAN_CONTACT].form >= NT_FORM_LOCAL_EXACT;
}

enum { FLAT, RELIEF, GROUNDS };
static nt_terrain *terrains[GROUNDS][FORMS]; /* NULL: refused over a relief */
static double heights[N * N];
static nt_rig rig;

static int make_terrains(void **state)
{
    (void)state;
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            heights[j * N + i] = 1e-9 * sin(0.5 * i + 0.1 * j) + 0.7e-9 * cos(0.4 * j);
    rig = nt_rig_defaults();
    rig.stage.axes = 3.0;
    rig.probe.lateral_stiffness = 50.0;
    for (int i = 0; i < GROUNDS * FORMS; i++) {
        const form *of = &forms[i % FORMS];
        nt_terrain_setup wanted = nt_terrain_defaults();
        nt_problem problem = {0};
        of->set(&wanted.scene);
        wanted.scene.range.maximum_load = 60e-9;
        wanted.demand.relative_accuracy = of->accuracy;
        wanted.probe = &rig.probe;
        if (i / FORMS == RELIEF)
            wanted.map = (nt_height_map){heights, N, N, 6e-9, 6e-9};
        if (nt_terrain_make(&terrains[i / FORMS][i % FORMS], &wanted, &problem) != NT_OK) {
            print_message("%s: %s %g\n", of->name, problem.field ? problem.field : "?", problem.value);
            if (i / FORMS == FLAT)
                return 1;
        }
    }
    return 0;
}

static int close_terrains(void **state)
{
    (void)state;
    for (int i = 0; i < GROUNDS * FORMS; i++)
        nt_terrain_close(terrains[i / FORMS][i % FORMS]);
    return 0;
}

static void go(nt_sim_slave *slave, double x, double travel)
{
    const nt_action action = {.size = sizeof action, .target = {x, 30e-9, travel}};
    assert_int_equal(nt_sim_slave_write(slave, &action), NT_OK);
}

/* Presses and rubs, up to a load that every scene bears. Returns where along x it is. */
static double press(nt_sim_slave *slave, double *travel)
{
    double x = 30e-9;
    for (int i = 0; i < 4000 && slave->truth.tip_force[NT_Z] < 20e-9; i++)
        go(slave, x, *travel += 4e-11);
    for (int i = 0; i < 200; i++)
        go(slave, x += 2e-11, *travel);
    return x;
}

static void stay(nt_sim_slave *slave, double x, double travel, int ticks)
{
    for (int i = 0; i < ticks; i++)
        go(slave, x, travel);
}

/* What a plan plans at a pose, never touched. A sample that keeps dents knows no other force. */
static void assert_untouched(const nt_sim_slave *slave, const nt_plan *plan, const char *what)
{
    const nt_truth *truth = &slave->truth;
    const nt_pose pose = {slave->x, slave->y, truth->tip_height};
    const nt_interaction_state never = {0};
    nt_interaction_value planned = {.U = 0.0};
    if (plan->history != NT_HISTORY_DENTS)
        planned = nt_interaction_eval(plan, &never, &pose);
    const double off[] = {truth->tip_force[NT_X] - planned.Fx, truth->tip_force[NT_Y] - planned.Fy,
                          truth->tip_force[NT_Z] - planned.Fz};
    const double allowed = 1e-9 * fabs(planned.Fz) + 1e-18; /* the same sums, at a height that was added up otherwise */
    for (int i = 0; i < NT_AXES; i++)
        if (!(fabs(off[i]) <= allowed))
            fail_msg("%s: at a gap of %g m the force %d is off by %g N of %g N", what, truth->gap, i, off[i],
                     planned.Fz);
    assert_true(truth->contact_radius == 0.0 && truth->friction_stored == 0.0);
}

static nt_sim_slave slave_on(const nt_plan *plan, nt_probe_model model)
{
    const nt_sim_setup setup = {.plan = plan,
                                .rig = &rig,
                                .period = T,
                                .clearance = CLEARANCE,
                                .seed = 3,
                                .x = 30e-9,
                                .y = 30e-9,
                                .probe_model = model};
    nt_sim_slave slave;
    assert_int_equal(nt_sim_slave_init(&slave, &setup), NT_OK);
    return slave;
}

/* Back to the first plan at a gap where a tip that has touched would be held, and one that has not, not. */
static int comes_back_free(nt_sim_slave *slave, const nt_plan *first, double x, double travel, const char *name)
{
    if (slave->truth.contact_radius > 0.0 || slave->interaction.attached)
        return 0;
    const double gap = slave->truth.gap;
    if (first->history == NT_HISTORY_DENTS || is_local(first) || gap <= first->capture_gap || gap > first->release_gap)
        return 0;
    nt_sim_change_plan(slave, first);
    stay(slave, x, travel, 1);
    if (slave->truth.gap > first->capture_gap)
        assert_untouched(slave, first, name);
    return 1;
}

/* One pair. Returns 1 if friction held the tip before it was lifted. */
static int lift_after(const nt_plan *before, const nt_plan *after, nt_probe_model model, const char *name)
{
    double travel = 0.0;
    nt_sim_slave slave = slave_on(before, model);
    const double x = press(&slave, &travel);
    nt_sim_change_plan(&slave, after);
    stay(&slave, x, travel, 20);
    const int held = slave.slide.friction.stored > 0.0;
    while (travel > -100e-9)
        go(&slave, x, travel -= 1e-9);
    stay(&slave, x, travel, 300); /* rings out */
    assert_true(slave.truth.gap > 50e-9);
    assert_untouched(&slave, after, name);
    const nt_sim_slave lifted = slave;
    nt_sim_change_plan(&slave, before);
    stay(&slave, x, travel, 20);
    assert_untouched(&slave, before, name);
    slave = lifted;
    for (int i = 0; i < 500 && !comes_back_free(&slave, before, x, travel, name); i++)
        go(&slave, x, travel += 3e-10);
    return held;
}

/* Every pair, or every so manyth. */
static void no_pair_leaves_a_force(nt_probe_model model, int every)
{
    int pairs = 0, held = 0;
    for (int ground = 0; ground < GROUNDS; ground++)
        for (int i = ground; i < FORMS * FORMS; i += every) {
            const nt_terrain *from = terrains[ground][i / FORMS], *to = terrains[ground][i % FORMS];
            char name[80];
            if (!from || !to)
                continue;
            (void)snprintf(name, sizeof name, "%s, %s -> %s", ground == FLAT ? "flat" : "relief", forms[i / FORMS].name,
                           forms[i % FORMS].name);
            held += lift_after(nt_terrain_plan(from), nt_terrain_plan(to), model, name);
            pairs++;
        }
    print_message("%d pairs, friction held the tip in %d\n", pairs, held);
    assert_true(pairs >= FORMS * FORMS / every && held > FORMS / every);
}

static void no_pair_leaves_a_force_at_rest(void **state)
{
    (void)state;
    no_pair_leaves_a_force(NT_PROBE_QUASI_STATIC, 1);
}

static void no_pair_leaves_a_force_in_motion(void **state)
{
    (void)state;
    no_pair_leaves_a_force(NT_PROBE_DYNAMIC, 31);
}

/* The table is what it says. */
static void there_is_every_form(void **state)
{
    (void)state;
    int rubs = 0, dents = 0, deforms = 0, local = 0, none = 0, adheres = 0;
    for (int i = 0; i < GROUNDS * FORMS; i++) {
        const nt_terrain *terrain = terrains[i / FORMS][i % FORMS];
        if (!terrain)
            continue;
        const nt_plan *plan = nt_terrain_plan(terrain);
        rubs += plan->friction.term.form != NT_FORM_OFF;
        dents += plan->history == NT_HISTORY_DENTS;
        deforms += plan->deformation.count > 0;
        local += is_local(plan);
        none += plan->terms[NT_PLAN_CONTACT].form == NT_FORM_OFF;
        adheres += plan->source != NT_ADHESION_NONE;
    }
    print_message("friction %d, dents %d, deforms %d, local %d, no contact %d, adhesion %d\n", rubs, dents, deforms,
                  local, none, adheres);
    assert_true(rubs > 5 && dents > 1 && deforms > 0 && local > 1 && none > 0 && adheres > 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(there_is_every_form),
        cmocka_unit_test(no_pair_leaves_a_force_at_rest),
        cmocka_unit_test(no_pair_leaves_a_force_in_motion),
    };
    return cmocka_run_group_tests(tests, make_terrains, close_terrains);
}
