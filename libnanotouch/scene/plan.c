/* SPDX-License-Identifier: BSD-3-Clause
 * From a scene and a demand to the laws that have to be computed.
 *
 * Contact law, by its error in F(delta) against Maugis-Dugdale (docs/accuracy in docs/contact.md):
 *  - JKR errs by less than 0.09/lambda^2 of max(|F|, |F_pull-off|) for lambda > 0.5;
 *  - DMT is never chosen: it has no attraction at a distance, and its F(delta) errs by 2 sqrt(lambda);
 *  - Hertz only where adhesion is nil or cannot be felt.
 * The paper's thresholds (0.12, 5.8, 20 P_a) are rules for the contact radius under load control, not for F(delta). */
#include <math.h>

#include "nanotouch/plan.h"

#include <stddef.h>

#define JKR_ERROR_COEFFICIENT 0.09
#define JKR_MINIMUM_LAMBDA 0.5
/* The demand holds for the sum: half of it for the contact law, a quarter for each term that may be left out. */
#define CONTACT_SHARE 0.5
#define TERM_SHARE 0.25

#define FIELD(member, unit, minimum, maximum, doc)                                                                     \
    {"demand." #member, unit, minimum, maximum, (unsigned)offsetof(nt_demand, member), doc}

static const nt_field demand_fields[] = {
    FIELD(relative_accuracy, "", 1e-6, 0.5, "largest |dF| / max(|F|, |F_pull-off|)"),
    FIELD(force_floor, "N", 0.0, 1.0, "forces below this cannot be felt"),
    FIELD(maximum_load, "N", 1e-15, 1.0, "the largest load that will be visited"),
};

nt_demand nt_demand_defaults(void)
{
    nt_demand demand = {.relative_accuracy = 0.01, .force_floor = 0.0, .maximum_load = 2.2e-6};
    return demand;
}

nt_status nt_demand_check(const nt_demand *demand, nt_problem *problem)
{
    return nt_field_check(demand_fields, (int)(sizeof demand_fields / sizeof demand_fields[0]), demand, problem);
}

/* w and sigma0 of the scene's adhesion source. */
static nt_contact contact_of(const nt_scene *scene, nt_adhesion_source source)
{
    const nt_material tip = {scene->tip.youngs_modulus, scene->tip.poisson_ratio};
    const nt_material sample = {scene->sample.youngs_modulus, scene->sample.poisson_ratio};
    nt_contact contact = {.radius = scene->tip.radius, .effective_modulus = nt_effective_modulus(tip, sample)};
    if (source == NT_ADHESION_MENISCUS) { /* w = 2 gamma_L, Laplace pressure gamma_L/r1 (E12) */
        contact.work_of_adhesion = 2.0 * scene->medium.surface_tension;
        contact.cohesive_stress = scene->medium.surface_tension / nt_scene_meniscus_radius(scene);
    } else if (source == NT_ADHESION_SOLID) {
        contact.work_of_adhesion = scene->adhesion.work_of_adhesion;
        contact.cohesive_stress =
            nt_cohesive_stress_atomic(scene->adhesion.work_of_adhesion, scene->adhesion.equilibrium_distance);
    }
    return contact;
}

/* The gap is measured between atoms in contact, z0 apart, and between the means of rough surfaces; inside `saturation`
 * the tail keeps its value. */
static nt_vdw tail_of(const nt_scene *scene, double saturation)
{
    const double distance = scene->adhesion.equilibrium_distance;
    nt_vdw vdw = {.radius = scene->tip.radius,
                  .hamaker_constant = scene->adhesion.hamaker_constant,
                  .roughness = scene->sample.roughness + 2.0 * distance,
                  .minimum_gap = fmax(saturation, 1e-3 * distance)};
    return vdw;
}

static nt_electrostatic electrostatic_of(const nt_scene *scene)
{
    nt_electrostatic electrostatic = {.radius = scene->tip.radius,
                                      .potential = scene->adhesion.contact_potential,
                                      .minimum_gap = scene->adhesion.equilibrium_distance};
    return electrostatic;
}

/* The law of least cost whose error the demand allows, and that error. */
static nt_model choose_contact(const nt_contact *contact, const nt_demand *demand, double *error)
{
    const double adhesion = nt_dmt_pull_off_force(contact); /* the most that any theory lets it pull */
    *error = 0.0;
    if (!(adhesion > 0.0))
        return NT_HERTZ;
    if (adhesion <= demand->force_floor) {
        *error = 1.0; /* of a pull-off that cannot be felt */
        return NT_HERTZ;
    }
    const double lambda = nt_maugis_lambda(contact);
    const double jkr_error = JKR_ERROR_COEFFICIENT / (lambda * lambda);
    if (lambda > JKR_MINIMUM_LAMBDA && jkr_error <= CONTACT_SHARE * demand->relative_accuracy) {
        *error = jkr_error;
        return NT_JKR;
    }
    *error = 1e-12;
    return NT_MAUGIS;
}

/* The stable branch where it carries `load`: bracket upwards from first touch, where it cannot push, then bisect. */
static nt_status law_at_load(const nt_contact_law *law, double load, nt_law_value *value)
{
    const nt_contact *contact = &law->maugis.contact;
    double low = 0.0;
    double high = nt_hertz_indentation(contact, load);
    nt_status status = nt_contact_law_eval(law, high, NT_BRANCH_STABLE, value);
    for (int i = 0; i < 64 && status == NT_OK && value->F < load; ++i) {
        low = high;
        high *= 2.0;
        status = nt_contact_law_eval(law, high, NT_BRANCH_STABLE, value);
    }
    if (status == NT_OK && value->F < load)
        return NT_E_NO_CONVERGENCE;
    for (int i = 0; i < 60 && status == NT_OK; ++i) {
        const double middle = 0.5 * (low + high);
        status = nt_contact_law_eval(law, middle, NT_BRANCH_STABLE, value);
        if (value->F < load)
            low = middle;
        else
            high = middle;
    }
    return status;
}

static nt_status refuse(nt_problem *problem, const char *field, const char *unit, double value, double maximum)
{
    if (problem) {
        nt_problem found = {.field = field, .unit = unit, .value = value, .minimum = 0.0, .maximum = maximum};
        *problem = found;
    }
    return NT_E_RANGE;
}

/* The tail and its share of the adhesion. Solid: what the tail pulls at contact is taken out of w (E5b), so that the
 * two together pull 2 pi R w in the rigid limit; a tail that alone pulls more than w is refused. */
static nt_status plan_tail(nt_plan *plan, nt_contact *contact, const nt_scene *scene, double felt, nt_problem *problem)
{
    const double solid_range =
        contact->work_of_adhesion > 0.0 ? contact->work_of_adhesion / contact->cohesive_stress : 0.0;
    const double bridge_gap = fmin(2.0 * scene->medium.film_thickness, solid_range);
    plan->vdw = tail_of(scene, plan->source == NT_ADHESION_MENISCUS ? bridge_gap : solid_range);
    plan->capture_gap = plan->source == NT_ADHESION_MENISCUS ? bridge_gap : solid_range;
    const double pull = -nt_vdw_eval(&plan->vdw, 0.0).F;
    plan->terms[NT_PLAN_VDW].name = "vdw";
    plan->terms[NT_PLAN_VDW].included = pull > felt;
    plan->terms[NT_PLAN_VDW].bound = pull;
    if (plan->source != NT_ADHESION_SOLID || pull <= felt)
        return NT_OK;
    const double share = pull / (2.0 * NT_PI * contact->radius);
    if (share >= contact->work_of_adhesion)
        return refuse(problem, "adhesion.hamaker_constant", "J", plan->vdw.hamaker_constant,
                      plan->vdw.hamaker_constant * contact->work_of_adhesion / share);
    contact->work_of_adhesion -= share;
    contact->cohesive_stress = contact->work_of_adhesion / solid_range;
    return NT_OK;
}

static void plan_electrostatic(nt_plan *plan, const nt_scene *scene, double felt)
{
    plan->electrostatic = electrostatic_of(scene);
    const double pull = -nt_electrostatic_eval(&plan->electrostatic, 0.0).F;
    plan->terms[NT_PLAN_ELECTROSTATIC].name = "electrostatic";
    plan->terms[NT_PLAN_ELECTROSTATIC].included = pull > felt;
    plan->terms[NT_PLAN_ELECTROSTATIC].bound = pull;
}

static nt_status plan_contact(nt_plan *plan, const nt_contact *contact, const nt_demand *demand)
{
    double error = 0.0;
    const nt_model model = choose_contact(contact, demand, &error);
    const nt_status status = nt_contact_law_init(&plan->contact, model, contact);
    if (status != NT_OK)
        return status;
    plan->terms[NT_PLAN_CONTACT].name = nt_model_name(model);
    plan->terms[NT_PLAN_CONTACT].included = 1;
    plan->terms[NT_PLAN_CONTACT].bound = error;
    plan->lambda = nt_maugis_lambda(contact);
    plan->release_gap = -nt_contact_law_grip_indentation(&plan->contact);
    if (model != NT_MAUGIS)
        plan->capture_gap = fmin(plan->capture_gap, 0.0);
    return NT_OK;
}

nt_status nt_plan_make(nt_plan *plan, const nt_scene *scene, const nt_demand *demand, const nt_surface *surface,
                       nt_problem *problem)
{
    nt_status status = nt_scene_check(scene, problem);
    if (status == NT_OK)
        status = nt_demand_check(demand, problem);
    if (status != NT_OK)
        return status;
    nt_plan made = {.source = nt_scene_adhesion_source(scene), .surface = surface};
    nt_contact contact = contact_of(scene, made.source);
    const double least_pull_off = nt_jkr_pull_off_force(&contact); /* that any theory gives */
    const double felt = fmax(0.5 * demand->force_floor, TERM_SHARE * demand->relative_accuracy * least_pull_off);
    plan_electrostatic(&made, scene, felt);
    status = plan_tail(&made, &contact, scene, felt, problem);
    if (status == NT_OK)
        status = plan_contact(&made, &contact, demand);
    if (status != NT_OK)
        return status;
    const int tail_in_contact = made.terms[NT_PLAN_VDW].included && made.source != NT_ADHESION_MENISCUS;
    made.pull_off_force = nt_contact_law_pull_off_force(&made.contact) +
                          (tail_in_contact ? made.terms[NT_PLAN_VDW].bound : 0.0) +
                          (made.terms[NT_PLAN_ELECTROSTATIC].included ? made.terms[NT_PLAN_ELECTROSTATIC].bound : 0.0);
    nt_law_value loaded;
    status = law_at_load(&made.contact, demand->maximum_load, &loaded);
    if (status != NT_OK)
        return status;
    made.maximum_stiffness = loaded.k;
    made.contact_strain = loaded.a / contact.radius;
    *plan = made;
    return NT_OK;
}
