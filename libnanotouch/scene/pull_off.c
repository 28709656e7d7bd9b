/* SPDX-License-Identifier: BSD-3-Clause
 * The laws of a scene at its work of adhesion; where a pull-off force was measured, at the w with which contact, tail
 * and all else together pull off with it. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/roots.h"
#include "scene/parts.h"
#include "scene/scene.h"

#define WORK_MIN 1e-12 /* [J/m^2] */
#define WORK_MAX 1e2
#define STEP 4.0  /* of w, on the way to a bracket */
#define MET 1e-9  /* of the measured force */
#define JUST 1e-9 /* of w: beyond where the tail leaves nothing of it */

nt_status nt_plan_laws_at(nt_plan *plan, const nt_scene *scene, double work_of_adhesion, nt_problem *problem)
{
    nt_plan_contact_of(plan, scene, work_of_adhesion);
    if (plan->deformation.count > 0 && plan->deformation.jumps)
        plan->capture_gap = plan->deformation.touch;
    nt_status status = nt_plan_laws_of(plan, scene, problem);
    if (status == NT_OK)
        status = nt_plan_contact_laws(plan, scene);
    if (status == NT_OK && plan->deformation.holds)
        nt_plan_hold_facts(plan, scene->range.maximum_load);
    return status == NT_OK ? nt_plan_facts(plan) : status;
}

typedef struct sought {
    nt_plan *plan;
    const nt_scene *scene;
    double measured; /* [N] */
} sought;

/* Pull-off force of the whole less the measured one [N]. Where the tail leaves nothing of w, w is too small. */
static double excess(double work_of_adhesion, const void *context)
{
    const sought *in = context;
    const nt_status status = nt_plan_laws_at(in->plan, in->scene, work_of_adhesion, NULL);
    if (status == NT_E_RANGE) /* 0 would be a root */
        return -fmax(in->measured, DBL_MIN);
    return status == NT_OK ? in->plan->pull_off_force - in->measured : (double)NAN;
}

/* The pull-off force of the largest w, or of the least that the tail leaves anything of [N]; NaN where neither is
 * known. */
static double extreme(const sought *in, int largest)
{
    const sought any = {in->plan, in->scene, 0.0};
    double w = largest ? WORK_MAX : WORK_MIN;
    if (excess(w, &any) < 0.0 && nt_root_find(excess, &any, (double[]){WORK_MIN, WORK_MAX}, &w, NULL) == NT_OK)
        w *= 1.0 + JUST;
    return excess(w, &any);
}

/* What can be measured goes from or up to `limit`; to its other end from there. */
static nt_status refuse(const sought *in, double limit, nt_problem *problem)
{
    const nt_field *field = nt_scene_field("adhesion.pull_off_force");
    const double measured = in->measured;
    const int less = measured < limit;
    if (problem) {
        const double other = extreme(in, less), least = less ? limit : other, most = less ? other : limit;
        *problem = nt_problem_of(field->name, field->unit, measured, fmax(least * (1.0 + MET), field->minimum),
                                 fmin(most * (1.0 - MET), field->maximum));
    }
    return NT_E_RANGE;
}

static nt_status find(const sought *in, nt_problem *problem)
{
    const double measured = in->measured;
    double w = fmin(fmax(measured / (2.0 * NT_PI * in->scene->tip.radius), WORK_MIN), WORK_MAX); /* rigid */
    double bracket[2] = {w, w};
    while (excess(bracket[1], in) < 0.0 && bracket[1] < WORK_MAX)
        bracket[1] = fmin(bracket[1] * STEP, WORK_MAX);
    while (excess(bracket[0], in) > 0.0 && bracket[0] > WORK_MIN)
        bracket[0] = fmax(bracket[0] / STEP, WORK_MIN);
    const double least = excess(bracket[0], in), most = excess(bracket[1], in);
    if (least > 0.0 || most < 0.0)
        return refuse(in, measured + (least > 0.0 ? least : most), problem);
    const nt_status status = nt_root_find(excess, in, bracket, &w, NULL);
    if (status != NT_OK)
        return status;
    double over = excess(w, in);
    if (over < -MET * measured)
        over = excess(w * (1.0 + JUST), in);
    return fabs(over) <= MET * measured ? NT_OK : refuse(in, measured + over, problem);
}

nt_status nt_plan_adhere(nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    const sought in = {plan, scene, scene->adhesion.pull_off_force};
    nt_status status;
    if (scene->adhesion.given != NT_ADHESION_GIVEN_PULL_OFF || nt_scene_adhesion_source(scene) == NT_ADHESION_NONE)
        status = nt_plan_laws_at(plan, scene, 0.0, problem);
    else
        status = find(&in, problem);
    return status == NT_OK ? nt_plan_over_surface(plan, scene, problem) : status;
}
