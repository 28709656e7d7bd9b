/* SPDX-License-Identifier: BSD-3-Clause
 * The force between tip and surface as a sum of potentials of the gap, with the history of one contact.
 *
 * Every term is a potential of the gap that acts on any history; the tail is held inside the gap where adhesion takes
 * hold, and what it pulls there has been taken out of w (laws.c). History only says whether the adhesive contact has
 * been made. It is made at the capture gap, where its energy is 0 or below, and lost at the release gap, the fold of
 * its law, where its energy is 0 or above; what is lost at either is dissipated. No cycle can give out energy. */
#include <math.h>

#include "internal/interaction.h"
#include "internal/maugis.h"
#include "nanotouch/interaction.h"
#include "scene/deformation/deform.h"
#include "scene/interaction.h"
#include "scene/terms/term.h"

static void add(nt_law_value *sum, nt_law_value term)
{
    sum->U += term.U;
    sum->F += term.F;
    sum->k += term.k;
    sum->a += term.a;
}

nt_place nt_interaction_place(const nt_plan *plan, double x, double y)
{
    if (nt_plan_follows(plan)) {
        nt_place found = nt_surface_place(plan->surface, plan->followed, plan->properties, x, y);
        if (!plan->followed)
            found.radius.radius = plan->contact.radius;
        return found;
    }
    nt_place place = {.radius = {.radius = plan->contact.radius}};
    if (plan->surface)
        place.surface = nt_surface_height(plan->surface, x, y);
    else if (isnan(x) || isnan(y)) /* of a flat, too: what is not a number is no place */
        place.surface.z = NAN;
    return place;
}

double nt_plan_radius_at(const nt_plan *plan, const nt_place *place)
{
    return place ? place->radius.radius : plan->contact.radius;
}

/* Asked several times in each period: where nothing moves it, without a call. */
static inline double capture_gap(const nt_plan *plan, const nt_place *place)
{
    return plan->relief.count == 0 ? plan->capture_gap : nt_plan_capture_gap(plan, place);
}

int nt_plan_is_attached(const nt_plan *plan, int attached, const nt_place *place, double gap)
{
    if (gap <= capture_gap(plan, place))
        return 1;
    return attached && gap <= nt_plan_release_gap(plan, place);
}

nt_bank_value nt_plan_contact_at(const nt_plan *plan, const nt_place *place, double gap)
{
    const nt_form form = plan->terms[NT_PLAN_CONTACT].form;
    if (!nt_form_is_local(form))
        return (nt_bank_value){nt_plan_contact_eval(plan, form, -gap), 0.0};
    const nt_contact contact = nt_plan_contact_of_place(plan, place);
    return nt_plan_local_eval(plan, form, &contact, -gap);
}

/* The vertical law, and how U changes with what varies from place to place. */
typedef struct vertical {
    nt_law_value law;
    double dU_dR; /* [J/m] */
    double dU_dE; /* over E_s [J/Pa] */
    double dU_dw; /* [m^2] */
} vertical;

/* With one range of adhesion U = pi w R d_s f(delta/d_s), d_s ~ (w^2 R/K^2)^(1/3): the slope over R is that over d_s,
 * too, and with it
 *     dU/dln E* = 2 (U - R dU/dR), dU/dln w = 2 R dU/dR - U. */
static void add_properties(vertical *sum, const nt_plan *plan, const nt_place *place, const nt_bank_value *contact)
{
    const nt_contact here = nt_plan_contact_of_place(plan, place);
    const double E = place->youngs_modulus.value, by_modulus = 2.0 * (contact->law.U - here.radius * contact->dU_dR);
    if (E > 0.0)
        sum->dU_dE = by_modulus * here.effective_modulus * plan->sample_factor / (E * E);
    if (here.work_of_adhesion > 0.0)
        sum->dU_dw = (contact->law.U - by_modulus) / here.work_of_adhesion;
}

/* The terms beside contact, where nothing varies. */
static inline nt_law_value beside_at(const nt_plan *plan, double gap)
{
    nt_law_value sum = {0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < plan->on_count; ++i) {
        const int term = plan->on[i];
        add(&sum, nt_term_rows[term]->eval(nt_term_law(plan, term), plan->terms[term].form, gap));
    }
    return sum;
}

static int has_contact(const nt_plan *plan, const nt_interaction_state *state, const nt_place *place, double gap)
{
    return plan->terms[NT_PLAN_CONTACT].form != NT_FORM_OFF && nt_plan_is_attached(plan, state->attached, place, gap);
}

/* A sample that deforms under all together. */
static nt_law_value deformed_at(const nt_plan *plan, const nt_interaction_state *state, const nt_place *place,
                                double gap)
{
    const int holds = plan->source != NT_ADHESION_NONE && has_contact(plan, state, place, gap);
    nt_law_value sum = nt_plan_around(plan, holds, gap);
    if (holds)
        add(&sum, nt_plan_contact_at(plan, place, gap).law);
    return sum;
}

/* And with the radius of each place; what the tail takes of w changes with it. */
static vertical relief_at(const nt_plan *plan, const nt_interaction_state *state, const nt_place *place, double gap)
{
    const int holds = plan->source != NT_ADHESION_NONE && has_contact(plan, state, place, gap);
    const nt_bank_value around = nt_deform_relief_at(plan, place, holds, gap);
    vertical sum = {.law = around.law, .dU_dR = around.dU_dR};
    if (!holds || plan->deformation.holds)
        return sum;
    const nt_bank_value contact = nt_plan_contact_at(plan, place, gap);
    const nt_contact here = nt_plan_contact_of_place(plan, place);
    double taken;
    (void)nt_deform_relief_share(plan, here.radius, &taken);
    add(&sum.law, contact.law);
    sum.dU_dR += contact.dU_dR - taken * (2.0 * here.radius * contact.dU_dR - contact.law.U) / here.work_of_adhesion;
    return sum;
}

/* The same contact everywhere. */
static nt_law_value uniform_at(const nt_plan *plan, const nt_interaction_state *state, double gap)
{
    nt_law_value sum = beside_at(plan, gap);
    if (has_contact(plan, state, NULL, gap))
        add(&sum, nt_plan_contact_eval(plan, plan->terms[NT_PLAN_CONTACT].form, -gap));
    return sum;
}

/* That of each place; beside contact all is proportional to the effective radius. */
static vertical local_at(const nt_plan *plan, const nt_interaction_state *state, const nt_place *place, double gap)
{
    vertical sum = {.law = beside_at(plan, gap)};
    const double ratio = nt_plan_radius_at(plan, place) / plan->contact.radius;
    sum.dU_dR = sum.law.U / plan->contact.radius;
    sum.law.U *= ratio;
    sum.law.F *= ratio;
    sum.law.k *= ratio;
    if (has_contact(plan, state, place, gap)) {
        const nt_bank_value contact = nt_plan_contact_at(plan, place, gap);
        add(&sum.law, contact.law);
        sum.dU_dR += contact.dU_dR;
        if (plan->properties && place)
            add_properties(&sum, plan, place, &contact);
    }
    return sum;
}

static vertical eval_at(const nt_plan *plan, const nt_interaction_state *state, const nt_place *place, double gap)
{
    if (isnan(gap))
        return (vertical){{gap, gap, gap, gap}, gap, gap, gap};
    if (plan->relief.count > 0 && place)
        return relief_at(plan, state, place, gap);
    if (plan->deformation.count > 0)
        return (vertical){.law = deformed_at(plan, state, place, gap)};
    if (nt_form_is_local(plan->terms[NT_PLAN_CONTACT].form))
        return local_at(plan, state, place, gap);
    return (vertical){.law = uniform_at(plan, state, gap)};
}

nt_law_value nt_interaction_eval_gap(const nt_plan *plan, const nt_interaction_state *state, const nt_place *place,
                                     double gap)
{
    const int is_uniform = plan->deformation.count == 0 && !nt_form_is_local(plan->terms[NT_PLAN_CONTACT].form);
    return is_uniform && !isnan(gap) ? uniform_at(plan, state, gap) : eval_at(plan, state, place, gap).law;
}

/* U(h, R, E_s, w) with h = z - z_s(x, y) and R(x, y), ..: F_x = -dU/dx = -F dz_s/dx - dU/dR dR/dx - .. */
static void sides_of(const nt_plan *plan, const nt_place *place, const vertical *here, double sides[2])
{
    sides[0] = -here->law.F * place->surface.zx - here->dU_dR * place->radius.dx;
    sides[1] = -here->law.F * place->surface.zy - here->dU_dR * place->radius.dy;
    if (plan->properties) {
        sides[0] -= here->dU_dE * place->youngs_modulus.dx + here->dU_dw * place->work_of_adhesion.dx;
        sides[1] -= here->dU_dE * place->youngs_modulus.dy + here->dU_dw * place->work_of_adhesion.dy;
    }
}

void nt_plan_sides(const nt_plan *plan, const nt_interaction_state *state, const nt_place *place, double gap,
                   double force, double sides[2])
{
    vertical here = {.law.F = force};
    if (nt_plan_follows(plan))
        here = eval_at(plan, state, place, gap);
    sides_of(plan, place, &here, sides);
}

nt_interaction_value nt_interaction_eval(const nt_plan *plan, const nt_interaction_state *state, const nt_pose *pose)
{
    const nt_place place = nt_interaction_place(plan, pose->x, pose->y);
    const double gap = pose->z - place.surface.z;
    const vertical here = eval_at(plan, state, &place, gap);
    double sides[2];
    sides_of(plan, &place, &here, sides);
    return (nt_interaction_value){.U = here.law.U,
                                  .Fx = sides[0],
                                  .Fy = sides[1],
                                  .Fz = here.law.F,
                                  .k = here.law.k,
                                  .a = here.law.a,
                                  .gap = gap};
}

void nt_interaction_advance_gap(const nt_plan *plan, nt_interaction_state *state, const nt_place *place, double gap)
{
    if (isnan(gap) || nt_plan_is_attached(plan, state->attached, place, gap) == state->attached)
        return;
    const nt_term_row *contact = nt_term_rows[NT_PLAN_CONTACT]; /* the one law with a history */
    state->dissipated += contact->advance(plan, &state->attached, place, gap, 0.0).dissipated;
}

void nt_interaction_advance(const nt_plan *plan, nt_interaction_state *state, const nt_pose *pose)
{
    const nt_place place = nt_interaction_place(plan, pose->x, pose->y);
    nt_interaction_advance_gap(plan, state, &place, pose->z - place.surface.z);
}

void nt_interaction_change(const nt_plan *plan, const nt_plan *changed, nt_interaction_state *state,
                           const nt_pose *pose)
{
    const double before = nt_interaction_eval(plan, state, pose).U + state->dissipated;
    if (isnan(before))
        return;
    nt_interaction_advance(changed, state, pose);
    state->port += nt_interaction_eval(changed, state, pose).U + state->dissipated - before;
}

void nt_interaction_eval_n(const nt_plan *plan, const nt_interaction_state *state, const nt_interaction_arrays *arrays)
{
    for (long i = 0; i < arrays->count; ++i)
        arrays->values[i * arrays->value_stride] =
            nt_interaction_eval(plan, state, &arrays->poses[i * arrays->pose_stride]);
}

void nt_interaction_run_n(const nt_plan *plan, nt_interaction_state *state, const nt_interaction_arrays *arrays)
{
    for (long i = 0; i < arrays->count; ++i) {
        const nt_pose *pose = &arrays->poses[i * arrays->pose_stride];
        nt_interaction_advance(plan, state, pose);
        arrays->values[i * arrays->value_stride] = nt_interaction_eval(plan, state, pose);
    }
}

/* --- friction --- */

static nt_contact contact_here(const nt_plan *plan, const nt_place *place)
{
    return nt_plan_follows(plan) ? nt_plan_contact_of_place(plan, place) : plan->contact;
}

nt_friction_contact nt_interaction_friction_contact(const nt_plan *plan, const nt_interaction_state *state,
                                                    const nt_place *place, double gap)
{
    if (!has_contact(plan, state, place, gap))
        return (nt_friction_contact){0.0, 0.0};
    const nt_contact contact = contact_here(plan, place);
    const nt_law_value law =
        plan->deformation.count > 0 ? eval_at(plan, state, place, gap).law : nt_plan_contact_at(plan, place, gap).law;
    return nt_plan_friction_contact(plan, &contact, law);
}

/* A plan without friction has no place for its history: what the spring held is heat. */
static void let_go(const nt_plan *plan, nt_slide *slide)
{
    static const nt_friction_contact none = {0.0, 0.0};
    if (!slide->placed)
        return;
    (void)nt_friction_advance(&plan->friction.law, &slide->friction, &none, (double[2]){0.0, 0.0});
    slide->placed = 0;
}

void nt_interaction_slide_gap(const nt_plan *plan, const nt_interaction_state *state, nt_slide *slide,
                              const nt_place *place, const nt_pose *pose)
{
    if (plan->friction.term.form == NT_FORM_OFF) {
        let_go(plan, slide);
        return;
    }
    if (isnan(pose->x) || isnan(pose->y) || isnan(pose->z))
        return;
    nt_friction law = plan->friction.law;
    if (plan->properties && place && place->youngs_modulus.value > 0.0)
        law.effective_shear_modulus =
            1.0 / (plan->friction.tip_compliance + plan->friction.sample_factor / place->youngs_modulus.value);
    const double way[2] = {slide->placed ? pose->x - slide->x : 0.0, slide->placed ? pose->y - slide->y : 0.0};
    const nt_friction_contact contact = nt_interaction_friction_contact(plan, state, place, pose->z);
    if (nt_friction_advance(&law, &slide->friction, &contact, way) != NT_OK)
        return;
    slide->x = pose->x;
    slide->y = pose->y;
    slide->placed = 1;
}

void nt_interaction_slide(const nt_plan *plan, const nt_interaction_state *state, nt_slide *slide, const nt_pose *pose)
{
    if (plan->friction.term.form == NT_FORM_OFF) {
        let_go(plan, slide);
        return;
    }
    const nt_place place = nt_interaction_place(plan, pose->x, pose->y);
    nt_interaction_slide_gap(plan, state, slide, &place, &(nt_pose){pose->x, pose->y, pose->z - place.surface.z});
}

void nt_interaction_slide_n(const nt_plan *plan, nt_interaction_state *state, nt_slide *slide,
                            const nt_interaction_arrays *arrays)
{
    for (long i = 0; i < arrays->count; ++i) {
        const nt_pose *pose = &arrays->poses[i * arrays->pose_stride];
        nt_interaction_value *value = &arrays->values[i * arrays->value_stride];
        nt_interaction_advance(plan, state, pose);
        nt_interaction_slide(plan, state, slide, pose);
        *value = nt_interaction_eval(plan, state, pose);
        value->Fx += slide->friction.force[0];
        value->Fy += slide->friction.force[1];
    }
}

void nt_interaction_step_n(const nt_plan *plan, nt_interaction_state *states, const nt_interaction_arrays *arrays)
{
    for (long i = 0; i < arrays->count; ++i) {
        const nt_pose *pose = &arrays->poses[i * arrays->pose_stride];
        nt_interaction_advance(plan, &states[i], pose);
        arrays->values[i * arrays->value_stride] = nt_interaction_eval(plan, &states[i], pose);
    }
}
