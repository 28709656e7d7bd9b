/* SPDX-License-Identifier: BSD-3-Clause
 * A sample that relaxes: whether time matters in a scene, and the springs that a session follows it with.
 *
 * Each spring of the contact (rheology/loop.c) carries Int E(t - s) du. An elastic one of the modulus E(T), T the
 * longest touch, differs from it by no more than v eta, eta = Int_0^T (E - E(T)) dt, at any motion no faster than v: so
 * does one that the tip does not press, which stays back by v eta/E(T) at most. Over all springs that the tip can reach
 * that is 1/(1 - nu^2) g'(delta + v eta/E(T)) v eta, g(delta) the elastic law over E*. */
#include <math.h>

#include "internal/rheology.h"
#include "rheology/loop.h"
#include "rheology/profile.h"
#include "scene/parts.h"
#include "scene/scene.h"

#define USUAL_PERIOD 1e-4 /* of a session [s] */
#define SMALL 1e-3        /* forces below this part of the max load count as it does, where time is left out ... */
#define FOLLOWED 1e-2     /* ... and where springs follow it */
#define OF_DEMAND 0.5     /* of the accuracy, what leaving time out may cost */
#define OF_KERNEL 0.05    /* of the accuracy, what the arms may err by */
#define FINEST 1e-4       /* of the arms; all arms that a loop has do no better over six decades of time */
#define COARSEST 0.1
#define LOOSER 3.0
#define HISTORIES 2.0 /* times the error on loading: any motion (tests/c/test_scene_relaxation.c) */
#define ROOM 2.0      /* depth of the springs over that of the max load */
#define STEEPEST 0.85 /* exponent of a kernel */
enum { HALVINGS = 200, SAMPLES = 96, STRIPS = 48 };

static double period_of(const nt_plan_inputs *inputs)
{
    return inputs->period > 0.0 ? inputs->period : USUAL_PERIOD;
}

static nt_demand demand_of(const nt_plan_inputs *inputs)
{
    return inputs->demand ? *inputs->demand : nt_demand_defaults();
}

static double accuracy_of(const nt_demand *demand)
{
    return demand->bound == NT_BOUND_EXACT ? 0.0 : demand->relative_accuracy;
}

static double factor_of(const nt_scene *scene)
{
    return 1.0 / (1.0 - scene->sample.poisson_ratio * scene->sample.poisson_ratio);
}

/* The indentation of a load on a modulus; no more than the law has [m]. */
static double depth_of(const nt_profile *profile, double load_over_modulus)
{
    double low = 0.0, high = 1e-9;
    while (high < profile->deepest && nt_profile_at(profile, high).g < load_over_modulus)
        high *= 2.0;
    high = fmin(high, profile->deepest);
    for (int i = 0; i < HALVINGS && low < high; ++i) {
        const double middle = 0.5 * (low + high);
        *(nt_profile_at(profile, middle).g < load_over_modulus ? &low : &high) = middle;
    }
    return high;
}

/* What is small beside it does not count [N]. */
static double scale_of(const nt_scene *scene, const nt_demand *demand)
{
    const double accuracy = accuracy_of(demand), floor = accuracy > 0.0 ? demand->force_floor / accuracy : 0.0;
    return fmax(SMALL * scene->range.maximum_load, floor);
}

/* What an elastic sample of slow_modulus errs by, over max(|F|, scale): most where F is the scale. */
static double elastic_error(const nt_plan_inputs *inputs, double slow_modulus)
{
    const nt_scene *scene = inputs->scene;
    const nt_demand demand = demand_of(inputs);
    const nt_shape shape = nt_scene_shape(scene);
    const nt_profile profile = nt_profile_make(&shape, 0.0);
    const double T = scene->range.duration, v = scene->range.speed;
    const double eta = nt_rheology_relaxation_integral(&scene->rheology, T) - slow_modulus * T;
    if (!(eta > 1e-12 * slow_modulus * T))
        return 0.0;
    if (!(v > 0.0) || !(slow_modulus > 0.0) || demand.quantity != NT_QUANTITY_FORCE)
        return INFINITY;
    const double S = scale_of(scene, &demand), factor = factor_of(scene);
    const double delta = depth_of(&profile, S / (factor * slow_modulus));
    return factor * nt_profile_at(&profile, delta + v * eta / slow_modulus).slope * v * eta / S;
}

nt_plan_relaxation nt_plan_relaxation_before(const nt_plan_inputs *inputs)
{
    const nt_rheology *rheology = &inputs->scene->rheology;
    const nt_demand demand = demand_of(inputs);
    const double period = period_of(inputs), quick = nt_rheology_relaxation_integral(rheology, period) / period;
    nt_plan_relaxation found = {.relaxes = 1,
                                .slow_modulus = nt_rheology_relaxation(rheology, inputs->scene->range.duration)};
    found.error = elastic_error(inputs, found.slow_modulus);
    const int matters = found.error > OF_DEMAND * accuracy_of(&demand);
    found.modulus = matters ? quick : found.slow_modulus;
    found.bed.springs = matters;
    return found;
}

static nt_status refuse(nt_problem *problem, const nt_scene *scene, const char *cause)
{
    const nt_field *field = nt_scene_field("rheology.kind");
    nt_problem found = nt_problem_coded(NT_PROBLEM_RELAXES_BESIDE,
                                        nt_problem_of(field->name, field->unit, scene->rheology.kind, 0.0, 0.0));
    found.cause = cause;
    return nt_problem_refuse(problem, found);
}

nt_status nt_plan_check_relaxation(const nt_plan_inputs *inputs, nt_problem *problem)
{
    const nt_scene *scene = inputs->scene;
    const nt_shape_kind kind = nt_scene_shape(scene).kind;
    if (scene->rheology.kind == NT_RHEOLOGY_ELASTIC)
        return NT_OK;
    const struct {
        int is;
        const char *cause;
    } refused[] = {
        {nt_scene_adhesion_source(scene) != NT_ADHESION_NONE, "adhesion"},
        {scene->friction.shear_strength > 0.0 || scene->friction.coefficient > 0.0, "friction"},
        {scene->sample.thickness > 0.0, "the thickness of a layer"},
        {scene->sample.dents != 0, "dents"},
        {inputs->properties != NULL, "a map of properties"},
        {kind == NT_SHAPE_BLUNTED || kind == NT_SHAPE_TRUNCATED, "a blunted or truncated tip"},
    };
    for (size_t i = 0; i < sizeof refused / sizeof *refused; ++i)
        if (refused[i].is)
            return refuse(problem, scene, refused[i].cause);
    return NT_OK;
}

double nt_plan_slow_depth(const nt_plan *plan, double load)
{
    if (plan->history != NT_HISTORY_RELAXES)
        return 0.0;
    const nt_profile profile = nt_profile_make(&plan->shape, 0.0);
    return depth_of(&profile, load / (plan->relaxation.bed.factor * plan->relaxation.slow_modulus));
}

double nt_plan_quick_stiffness(const nt_plan *plan, double indentation)
{
    if (plan->history != NT_HISTORY_RELAXES)
        return 0.0;
    const nt_profile profile = nt_profile_make(&plan->shape, 0.0);
    return plan->relaxation.bed.factor * plan->relaxation.bed.modulus_over_period *
           nt_profile_at(&profile, fmin(indentation, profile.deepest)).slope;
}

/* At a steady speed a spring's force grows as (delta - depth)^p, p = 1 - beta, E ~ t^-beta: the steeper E falls, the
 * more do springs carry that the tip has just reached. The least p from one period on. */
static double least_exponent(const nt_rheology *rheology, double period, double duration)
{
    double p = 1.0;
    for (double t = period; t < duration; t *= 2.0)
        p = fmin(p, 1.0 + log2(nt_rheology_relaxation(rheology, 2.0 * t) / nt_rheology_relaxation(rheology, t)));
    return fmax(p, 1.0 - STEEPEST);
}

/* Int (delta - D)^p d(slope) over all springs that the tip has reached, with (delta - D)^p = delta^p (1 - r^2). */
static double whole_of(const nt_profile *profile, double delta, double p)
{
    double sum = 0.0;
    for (int i = 0; i < STRIPS; ++i) {
        const double r = (i + 0.5) / STRIPS;
        sum += 2.0 * r * nt_profile_at(profile, delta * (1.0 - pow(1.0 - r * r, 1.0 / p))).slope / STRIPS;
    }
    return sum * pow(delta, p);
}

/* Of the springs on loading, over max(F, that of `shallow`). */
static double springs_error(const nt_viscoelastic_bed *bed, const nt_profile *profile, double shallow, double p)
{
    const double least = whole_of(profile, shallow, p);
    double worst = 0.0;
    for (int i = 0; i <= SAMPLES; ++i) {
        const double delta = bed->max_indentation * pow(0.1 * shallow / bed->max_indentation, (double)i / SAMPLES);
        const double whole = whole_of(profile, delta, p);
        double sum = 0.0;
        for (int j = 0; j < bed->springs && bed->depth[j] < delta; ++j)
            sum += bed->weight[j] * pow(delta - bed->depth[j], p);
        worst = fmax(worst, fabs(sum - whole) / fmax(whole, least));
    }
    return worst;
}

/* The least error of the arms that a loop can have, from one that is wanted on. */
static nt_status make_bed(const nt_viscoelastic *contact, nt_viscoelastic_demand *wanted, double grading,
                          nt_viscoelastic_bed *bed, nt_problem *problem)
{
    nt_status status = NT_E_CAPACITY;
    while (status == NT_E_CAPACITY && wanted->kernel_error <= COARSEST) {
        status = nt_viscoelastic_bed_graded(contact, wanted, grading, bed, problem);
        if (status == NT_E_CAPACITY)
            wanted->kernel_error *= LOOSER;
    }
    return status;
}

/* As few springs as keep the accuracy, or all of them. */
static nt_status take_springs(nt_plan *plan, const nt_scene *scene, const nt_plan_inputs *inputs, nt_problem *problem)
{
    static const struct {
        int springs;
        double grading;
    } tried[] = {{32, 1.25}, {64, 1.25}, {NT_LOOP_SPRINGS, 1.25}, {NT_LOOP_SPRINGS, 2.0}};
    nt_plan_relaxation *of = &plan->relaxation;
    const nt_viscoelastic contact = {
        .shape = plan->shape, .rheology = scene->rheology, .poisson_ratio = scene->sample.poisson_ratio};
    const nt_profile profile = nt_profile_make(&contact.shape, 0.0);
    const double factor = factor_of(scene), accuracy = plan->accuracy;
    const double deep = depth_of(&profile, scene->range.maximum_load / (factor * of->slow_modulus));
    if (!(ROOM * deep <= profile.deepest)) {
        const nt_field *field = nt_scene_field("range.maximum_load");
        const double most = factor * of->slow_modulus * nt_profile_at(&profile, profile.deepest / ROOM).g;
        return nt_problem_refuse(
            problem, nt_problem_coded(NT_PROBLEM_RELAXES_DEPTH,
                                      nt_problem_of(field->name, field->unit, scene->range.maximum_load, 0.0, most)));
    }
    nt_viscoelastic_demand wanted = {.period = period_of(inputs),
                                     .max_indentation = ROOM * deep,
                                     .longest_time = fmax(scene->range.duration, 2.0 * period_of(inputs)),
                                     .kernel_error = fmax(FINEST, OF_KERNEL * accuracy)};
    plan->scale = fmax(plan->scale, FOLLOWED * scene->range.maximum_load);
    const double shallow = depth_of(&profile, plan->scale / (factor * of->modulus));
    const double p = least_exponent(&scene->rheology, wanted.period, scene->range.duration);
    nt_status status = NT_OK;
    for (size_t i = 0; i < sizeof tried / sizeof *tried && status == NT_OK; ++i) {
        wanted.springs = tried[i].springs;
        status = make_bed(&contact, &wanted, tried[i].grading, &of->bed, problem);
        if (status != NT_OK)
            return status;
        const double tip = plan->tip_compliance * factor * of->modulus;
        of->error = HISTORIES * (springs_error(&of->bed, &profile, shallow, p) + of->bed.kernel_error) + tip;
        if (of->error <= accuracy || of->bed.springs < tried[i].springs)
            break;
    }
    return NT_OK;
}

/* What a session computes per period, from the times of bench_rheology, at 20 ns a Hertz evaluation */
#define COST_OF_TICK 4.0
#define COST_OF_ARM 0.015 /* of each of a spring */

/* What follows for the plan. Springs are all that it computes. */
static nt_status follow_springs(nt_plan *plan)
{
    nt_plan_term *contact = &plan->terms[NT_PLAN_CONTACT];
    const nt_plan_relaxation *of = &plan->relaxation;
    const double deep = of->bed.max_indentation / ROOM;
    plan->history = NT_HISTORY_RELAXES;
    plan->largest_indentation = deep;
    plan->maximum_stiffness = fmax(plan->maximum_stiffness, nt_plan_quick_stiffness(plan, deep));
    contact->words = "springs that relax";
    contact->cost = contact->latency = COST_OF_TICK + COST_OF_ARM * of->bed.springs * of->bed.arms;
    plan->cost = plan->latency = plan->full_cost = contact->cost;
    plan->bound.force_error = of->error + (plan->radii ? plan->curvature_error : 0.0);
    contact->bound = plan->bound.force_error;
    const nt_profile profile = nt_profile_make(&plan->shape, 0.0);
    return nt_contact_validity_of(&plan->shape, 0.5 * nt_profile_at(&profile, deep).slope, deep, (double)INFINITY,
                                  &plan->validity);
}

nt_status nt_plan_relaxation_of(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem)
{
    const nt_scene *scene = inputs->scene;
    const int has_contact = plan->terms[NT_PLAN_CONTACT].form != NT_FORM_OFF;
    if (scene->rheology.kind == NT_RHEOLOGY_ELASTIC)
        return NT_OK;
    if (has_contact && (plan->on_count > 0 || plan->deformation.count > 0))
        return refuse(problem, scene, "forces before contact");
    plan->relaxation = nt_plan_relaxation_before(inputs);
    if (!has_contact || plan->relaxation.bed.springs == 0) {
        plan->bound.force_error += plan->relaxation.error;
        return NT_OK;
    }
    if (plan->quantity != NT_QUANTITY_FORCE)
        return refuse(problem, scene, "a demand of another quantity than the force");
    nt_status status = take_springs(plan, scene, inputs, problem);
    if (status == NT_OK)
        status = follow_springs(plan);
    if (status != NT_OK)
        return status;
    if (plan->demand.bound == NT_BOUND_KEPT && plan->relaxation.error > plan->accuracy)
        return nt_problem_refuse(problem, nt_demand_accuracy(plan->demand.relative_accuracy, plan->relaxation.error));
    if (plan->demand.budget > 0.0 && plan->cost > plan->demand.budget * NT_BUDGET_ROUNDS)
        return nt_problem_refuse(problem, nt_demand_budget(plan->demand.budget, plan->cost));
    return NT_OK;
}
