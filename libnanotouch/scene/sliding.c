/* SPDX-License-Identifier: BSD-3-Clause
 * Friction of a scene: whether it is computed, and what it errs by.
 *
 * Its error is that of the friction force, over max(|F|, S) as for vertical forces: left out, the limit tau0 pi a^2 +
 * alpha N_c; computed, the difference of the limits with the radius and load of the plan's form of contact and of the
 * fullest one. It counts by itself: what acts sideways has no part in the vertical force. */
#include <math.h>
#include <stddef.h>

#include "scene/terms/term.h"

#define TABLED 2.0     /* the error of a table oscillates within its cells: what was sampled may be half of it */
#define ROUNDING 1e-11 /* of a limit: of radius and load, which go as a root near a fold */

enum { LOADS = 256 };

/* One step beside the evaluation of contact that it asks for, by count of instructions [Hertz evaluations]. */
static const double cost_step[2] = {3.0, 3.0};
static const double cost_load[2] = {24.0, 24.0}; /* and the load inside an adhesive contact, two roots */

nt_friction_contact nt_plan_friction_contact(const nt_plan *plan, const nt_contact *contact, nt_law_value law)
{
    nt_friction_contact found = {fmax(law.a, 0.0), 0.0};
    if (plan->friction.law.coefficient == 0.0)
        return found;
    if (plan->source != NT_ADHESION_NONE)
        found.compressive_load = nt_compressive_load(NT_MAUGIS, contact, law);
    else
        found.compressive_load =
            plan->deformation.count > 0 ? nt_compressive_load(NT_HERTZ, contact, law) : fmax(law.F, 0.0);
    return found;
}

/* Where friction is looked at: a contact in the plan's form and in full, at indentations of its whole range. */
typedef struct sampled {
    nt_contact contact;
    nt_form form, full;
    double first, last; /* indentations [m] */
} sampled;

static nt_law_value contact_at(const nt_plan *plan, const sampled *at, nt_form form, double indentation)
{
    if (nt_form_is_local(form))
        return nt_plan_local_eval(plan, form, &at->contact, indentation).law;
    return nt_plan_contact_eval(plan, form, indentation);
}

static double limit_at(const nt_plan *plan, const sampled *at, nt_form form, double indentation)
{
    const nt_law_value law = contact_at(plan, at, form, indentation);
    const nt_friction_contact contact = nt_plan_friction_contact(plan, &at->contact, law);
    const double limit = nt_friction_limit(&plan->friction.law, &contact);
    return isnan(limit) ? 0.0 : limit; /* there is no contact */
}

typedef struct errors {
    double left_out, computed, largest; /* shares; the largest limit [N] */
} errors;

static void sample(const nt_plan *plan, const sampled *at, double scale, errors *worst)
{
    for (int i = 0; i <= LOADS; ++i) {
        const double share = (double)i / LOADS;
        const double indentation = at->first + share * share * (at->last - at->first); /* closer at the fold */
        const double limit = limit_at(plan, at, at->full, indentation);
        const double F = contact_at(plan, at, at->full, indentation).F + nt_plan_beside_at(plan, -indentation).F;
        const double size = fmax(fabs(F), scale);
        worst->largest = fmax(worst->largest, limit);
        worst->left_out = fmax(worst->left_out, NT_SAMPLED * limit / size);
        const double planned = limit_at(plan, at, at->form, indentation);
        worst->computed = fmax(worst->computed, (TABLED * fabs(planned - limit) + ROUNDING * limit) / size);
    }
}

static sampled sampled_uniform(const nt_plan *plan)
{
    const nt_form form = plan->terms[NT_PLAN_CONTACT].form;
    const double release = plan->source == NT_ADHESION_NONE ? 0.0 : nt_plan_last_hold(plan->release_gap);
    return (sampled){plan->contact, form, nt_plan_contact_truth(plan), -release, plan->largest_indentation};
}

static sampled sampled_corner(const nt_plan *plan, int corner, double load)
{
    const nt_form form = plan->terms[NT_PLAN_CONTACT].form;
    sampled at = {.contact = nt_plan_contact_of_corner(plan, corner), .form = form, .full = NT_FORM_LOCAL_EXACT};
    if (plan->source != NT_ADHESION_NONE)
        at.first = -nt_plan_last_hold(nt_plan_local_release_gap(plan, form, &at.contact));
    at.last = nt_plan_local_depth(plan, form, &at.contact, load);
    return at;
}

static errors errors_of(const nt_plan *plan, double load)
{
    const int felt = plan->quantity == NT_QUANTITY_FORCE;
    const double scale = felt ? plan->scale : nt_plan_force_scale(plan, load);
    errors worst = {0.0, 0.0, 0.0};
    if (!nt_form_is_local(plan->terms[NT_PLAN_CONTACT].form)) {
        const sampled at = sampled_uniform(plan);
        sample(plan, &at, scale, &worst);
        return worst;
    }
    for (int corner = 0; corner < NT_CORNERS; ++corner) {
        const sampled at = sampled_corner(plan, corner, load);
        sample(plan, &at, scale, &worst);
    }
    return worst;
}

static void make_law(nt_plan *plan, const nt_scene *scene, const nt_probe *probe)
{
    const nt_scene_friction *given = &scene->friction;
    const nt_material tip = {scene->tip.youngs_modulus, scene->tip.poisson_ratio};
    const nt_material sample = {scene->sample.youngs_modulus, scene->sample.poisson_ratio};
    const double lever = probe && probe->lateral_stiffness > 0.0 ? 1.0 / probe->lateral_stiffness : 0.0;
    plan->friction.law = (nt_friction){nt_effective_shear_modulus(tip, sample), given->lateral_compliance + lever,
                                       given->shear_strength, given->coefficient};
    plan->friction.tip_compliance = 2.0 * (1.0 + tip.poisson_ratio) * (2.0 - tip.poisson_ratio) / tip.youngs_modulus;
    plan->friction.sample_factor = 2.0 * (1.0 + sample.poisson_ratio) * (2.0 - sample.poisson_ratio);
}

/* Adhesion of a cone or a punch is JKR's: where its pressure turns is not known. */
static nt_status check_shape(const nt_plan *plan, nt_problem *problem)
{
    if (plan->friction.law.coefficient == 0.0 || plan->terms[NT_PLAN_CONTACT].form != NT_FORM_JKR)
        return NT_OK;
    if (problem)
        *problem = nt_problem_coded(NT_PROBLEM_FRICTION_SHAPE, nt_problem_of("friction.coefficient", "",
                                                                             plan->friction.law.coefficient, 0.0, 0.0));
    return NT_E_RANGE;
}

static nt_status take(nt_plan *plan, const errors *of, nt_problem *problem)
{
    nt_plan_term *term = &plan->friction.term;
    const int asks_load = plan->source != NT_ADHESION_NONE && plan->friction.law.coefficient > 0.0;
    const nt_plan_term *contact = &plan->terms[NT_PLAN_CONTACT];
    term->form = NT_FORM_ON;
    term->words = "sticks and slips";
    term->bound = plan->deformation.count > 0 || plan->history == NT_HISTORY_DENTS ? (double)NAN : of->computed;
    term->cost = contact->cost + cost_step[0] + asks_load * cost_load[0];
    term->latency = contact->latency + cost_step[1] + asks_load * cost_load[1];
    plan->cost += term->cost;
    plan->latency += term->latency;
    plan->full_cost += term->cost;
    if (plan->demand.budget > 0.0 && plan->cost > plan->demand.budget * NT_BUDGET_ROUNDS) {
        if (problem)
            *problem = nt_demand_budget(plan->demand.budget, plan->cost);
        return NT_E_RANGE;
    }
    return NT_OK;
}

nt_status nt_plan_friction_of(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem)
{
    const nt_scene scene = nt_plan_scene_over(inputs);
    make_law(plan, &scene, inputs->probe);
    const nt_friction *law = &plan->friction.law;
    plan->friction.term = (nt_plan_term){.name = "friction", .title = "friction", .words = "left out"};
    if ((law->shear_strength == 0.0 && law->coefficient == 0.0) || plan->terms[NT_PLAN_CONTACT].form == NT_FORM_OFF)
        return NT_OK;
    const nt_status status = check_shape(plan, problem);
    if (status != NT_OK)
        return status;
    const errors found = errors_of(plan, scene.range.maximum_load);
    plan->friction.term.force = found.largest;
    plan->friction.term.bound = found.left_out;
    if (plan->deformation.count == 0 && plan->history != NT_HISTORY_DENTS && found.left_out <= plan->accuracy)
        return NT_OK;
    return take(plan, &found, problem);
}

void nt_plan_warn_friction(nt_plan *plan)
{
    const nt_plan_term *term = &plan->friction.term;
    const double demanded = plan->accuracy;
    if (term->form == NT_FORM_OFF)
        return;
    if (isnan(term->bound) && plan->history != NT_HISTORY_DENTS)
        nt_plan_add_warning(plan, (nt_plan_warning){"friction on a sample that deforms, whose bound is not known: its "
                                                    "largest force about",
                                                    "N", term->force, NAN});
    else if (demanded > 0.0 && term->bound > demanded)
        nt_plan_add_warning(plan,
                            (nt_plan_warning){"error of friction, more than demanded", "", term->bound, demanded});
}
