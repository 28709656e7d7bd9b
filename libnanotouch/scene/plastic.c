/* SPDX-License-Identifier: BSD-3-Clause
 * Where elastic laws end: a round tip begins to yield at a peak pressure of 1.6 Y, and at a mean pressure of 3 Y all
 * of the contact is plastic (Tabor 1951; Johnson, Contact Mechanics, 1985, Sec. 6.2 and 6.3). Pressures are those of
 * the tip's own radius at the largest load. */
#include <math.h>
#include <string.h>

#include "scene/deformation/deform.h"
#include "scene/parts.h"

#define ONSET 1.6
#define PLASTIC 3.0
#define OF_MEAN 1.5              /* Hertz' peak over his mean */
#define SQRT2 1.4142135623730951 /* a groove is wider than a dent by this */
#define KEEPS 0.98               /* of a load that is named: another table is made for it */

/* Y of the weaker body; 0 where neither is known [Pa]. */
static double weaker(const nt_scene *scene, int *is_tip)
{
    const double tip = scene->tip.yield_strength, sample = scene->sample.yield_strength;
    *is_tip = tip > 0.0 && (!(sample > 0.0) || tip < sample);
    return *is_tip ? tip : sample;
}

static nt_law_value at(const nt_plan *plan, double indentation)
{
    return nt_plan_contact_eval(plan, nt_plan_contact_truth(plan), indentation);
}

static double mean_pressure(const nt_law_value *law)
{
    return law->F / (NT_PI * law->a * law->a);
}

/* Without adhesion a table knows what presses on a sample that deforms, before contact, too. */
static int is_tabulated(const nt_plan *plan)
{
    return plan->deformation.count > 0 && plan->source == NT_ADHESION_NONE;
}

/* Hertz's 2 E* a/(pi R), of which adhesion takes away; of tips that are not round 1.5 times the mean. */
static double peak_pressure(const nt_plan *plan, const nt_scene *scene)
{
    if (is_tabulated(plan))
        return nt_deform_table_pressure(&plan->deformation, scene->range.maximum_load, nt_deform_peak_at);
    const nt_law_value law = at(plan, plan->largest_indentation);
    const nt_shape_kind kind = plan->shape.kind;
    const double hertz = 2.0 * plan->contact.effective_modulus * law.a / (NT_PI * plan->contact.radius);
    const double round = kind == NT_SHAPE_PARABOLOID || kind == NT_SHAPE_SPHERE ? hertz : 0.0;
    return fmax(OF_MEAN * mean_pressure(&law), round);
}

/* At the largest load [Pa]. */
static double largest_mean(const nt_plan *plan, const nt_scene *scene)
{
    if (is_tabulated(plan))
        return nt_deform_table_pressure(&plan->deformation, scene->range.maximum_load, nt_deform_mean_at);
    const nt_law_value law = at(plan, plan->largest_indentation);
    return mean_pressure(&law);
}

/* The largest load up to that mean pressure, which nowhere falls with the depth [N]. */
static double load_at(const nt_plan *plan, double pressure)
{
    if (is_tabulated(plan))
        return KEEPS * nt_deform_table_load(&plan->deformation, pressure, nt_deform_mean_at);
    double low = 0.0, high = plan->largest_indentation;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        const nt_law_value law = at(plan, middle);
        if (mean_pressure(&law) > pressure)
            high = middle;
        else
            low = middle;
    }
    return at(plan, low).F;
}

static nt_status refuse(nt_problem *problem, nt_problem_code code, nt_problem range)
{
    return nt_problem_refuse(problem, nt_problem_coded(code, range));
}

/* Alone, a round tip on one material everywhere: what the law of dents knows (plasticity.h). */
static nt_status check_dents(const nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    const nt_shape_kind kind = plan->shape.kind;
    const double largest = NT_INDENTATION_LARGEST_RADIUS * plan->indentation.radius;
    const nt_first_loading most = nt_indentation_first(&plan->indentation, largest / SQRT2);
    const double load = scene->range.maximum_load;
    if (!(scene->sample.yield_strength > 0.0))
        return refuse(problem, NT_PROBLEM_DENTS_STRENGTH,
                      nt_problem_of("sample.yield_strength", "Pa", scene->sample.yield_strength, 1.0, 1e12));
    if (plan->source != NT_ADHESION_NONE || plan->on_count > 0 || plan->deformation.count > 0)
        return refuse(problem, NT_PROBLEM_DENTS_BESIDE, nt_problem_of("sample.dents", "no|yes", 1.0, 0.0, 0.0));
    if (plan->properties || scene->sample.thickness > 0.0 || (kind != NT_SHAPE_PARABOLOID && kind != NT_SHAPE_SPHERE))
        return refuse(problem, NT_PROBLEM_DENTS_SHAPE, nt_problem_of("sample.dents", "no|yes", 1.0, 0.0, 0.0));
    if (load > most.force)
        return refuse(problem, NT_PROBLEM_DENTS_GROOVE,
                      nt_problem_of("range.maximum_load", "N", load, 0.0, most.force));
    return NT_OK;
}

nt_status nt_plan_dents_of(nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    if (!scene->sample.dents)
        return NT_OK;
    plan->indentation =
        (nt_indentation){plan->contact.radius, plan->contact.effective_modulus, scene->sample.yield_strength};
    const nt_status status = check_dents(plan, scene, problem);
    if (status != NT_OK)
        return status;
    const double a = nt_indentation_radius_at_load(&plan->indentation, scene->range.maximum_load);
    const nt_first_loading groove = nt_indentation_first(&plan->indentation, SQRT2 * a);
    plan->history = NT_HISTORY_DENTS;
    plan->maximum_stiffness = fmax(plan->maximum_stiffness, 2.0 * plan->indentation.effective_modulus * SQRT2 * a);
    plan->largest_indentation = fmax(plan->largest_indentation, groove.indentation);
    plan->bound.force_error = NAN; /* beside finite elements it errs by a tenth (docs/indentation.md) */
    return NT_OK;
}

nt_status nt_plan_check_plastic(const nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    int is_tip = 0;
    const double limit = PLASTIC * weaker(scene, &is_tip);
    if (plan->history == NT_HISTORY_DENTS || plan->terms[NT_PLAN_CONTACT].form == NT_FORM_OFF || !(limit > 0.0) ||
        !(largest_mean(plan, scene) > limit))
        return NT_OK;
    const nt_field *field = nt_scene_field("range.maximum_load");
    return refuse(problem, is_tip ? NT_PROBLEM_PLASTIC_TIP : NT_PROBLEM_PLASTIC_SAMPLE,
                  nt_problem_of(field->name, field->unit, scene->range.maximum_load, field->minimum,
                                fmax(load_at(plan, limit), field->minimum)));
}

void nt_plan_warn_plastic(nt_plan *plan, const nt_scene *scene)
{
    static const char *const texts[] = {"peak pressure at the largest load, where the sample begins to yield",
                                        "peak pressure at the largest load, where the tip begins to yield"};
    int is_tip = 0;
    const double limit = ONSET * weaker(scene, &is_tip);
    if (plan->history == NT_HISTORY_DENTS)
        nt_plan_add_warning(plan, (nt_plan_warning){"a sample that keeps dents (force within about a tenth of finite "
                                                    "elements, without a bound) yields from",
                                                    "N", nt_indentation_yield_load(&plan->indentation), NAN});
    if (plan->history == NT_HISTORY_DENTS && !is_tip)
        return;
    const double peak = peak_pressure(plan, scene);
    if (plan->terms[NT_PLAN_CONTACT].form != NT_FORM_OFF && limit > 0.0 && peak > limit)
        nt_plan_add_warning(plan, (nt_plan_warning){texts[is_tip], "Pa", peak, limit});
}
