/* SPDX-License-Identifier: BSD-3-Clause
 * The steps of nt_plan_make, in their order; private to scene/. Each reads what the ones before it wrote. */
#ifndef NANOTOUCH_SCENE_PARTS_H
#define NANOTOUCH_SCENE_PARTS_H

#include "core/problem.h"
#include "internal/maugis.h"
#include "nanotouch/interaction.h"
#include "nanotouch/plan.h"

/* adhesion.c: z0 that is computed with [m]. Van der Waals of flats at z0 is no more than w, of which it is a part:
 * where the scene's values say otherwise, atoms are kept apart so far that it is w, D0 = sqrt(H/(12 pi w))
 * (Israelachvili, Intermolecular and Surface Forces, 3rd ed., Sec. 13.13). */
double nt_plan_atomic_distance(const nt_scene *scene);
/* NT_E_RANGE where that is farther than atoms in contact are. */
nt_status nt_plan_check_distance(const nt_scene *scene, nt_problem *problem);

/* contact.c: source, shape, contact with all of w, capture; and, with what the tail leaves of w, the laws of contact.
 */
void nt_plan_contact_of(nt_plan *plan, const nt_scene *scene, double work_of_adhesion);
nt_status nt_plan_contact_laws(nt_plan *plan, const nt_scene *scene);
/* The fullest form of the scene's contact, and the one that stands for it as the truth that others are measured by. */
nt_form nt_plan_contact_form(const nt_plan *plan);
nt_form nt_plan_contact_truth(const nt_plan *plan);
/* Its own pull-off force, 0 without adhesion [N]. */
double nt_plan_contact_pull_off(const nt_plan *plan);
/* {U, F, k, a} of the contact in a form; all NaN where it refuses the indentation. */
nt_law_value nt_plan_contact_eval(const nt_plan *plan, nt_form form, double indentation);

/* Whether a form of contact is Maugis-Dugdale's, whose adhesion has a range. A switch over forms has no default: what a
 * new form is does not compile unless it is said. */
static inline int nt_form_is_maugis(nt_form form)
{
    switch (form) {
    case NT_FORM_TABLE:
    case NT_FORM_POLISHED:
    case NT_FORM_EXACT:
    case NT_FORM_LOCAL:
    case NT_FORM_LOCAL_EXACT:
        return 1;
    case NT_FORM_OFF:
    case NT_FORM_ON:
    case NT_FORM_DERJAGUIN:
    case NT_FORM_SPHERE:
    case NT_FORM_TIP:
    case NT_FORM_PARABOLOID:
    case NT_FORM_SERIES:
    case NT_FORM_SHAPE:
    case NT_FORM_JKR:
    case NT_FORM_DEFORMED:
        return 0;
    }
    return 0;
}
/* Whether the contact of the scene can follow the effective radius of each place, and whether a form does. */
int nt_plan_has_local_form(const nt_plan *plan);
static inline int nt_form_is_local(nt_form form)
{
    return form == NT_FORM_LOCAL || form == NT_FORM_LOCAL_EXACT;
}
/* Whether the force follows what a place is like: its contact, or how the sample deforms. */
static inline int nt_plan_follows(const nt_plan *plan)
{
    return plan->relief.count > 0 || nt_form_is_local(plan->terms[NT_PLAN_CONTACT].form);
}
/* nt_interaction_eval_gap and nt_interaction_advance_gap for a step that asks several times, at once where nothing but
 * a contact acts, the same everywhere, and the tip is in it; where the contact has been made and still is. */
static inline nt_law_value nt_interaction_law(const nt_plan *plan, const nt_interaction_state *state,
                                              const nt_place *place, double gap)
{
    const nt_form form = plan->terms[NT_PLAN_CONTACT].form;
    const int is_alone = plan->on_count == 0 && plan->deformation.count == 0;
    if (is_alone && gap <= plan->capture_gap && form != NT_FORM_OFF && !nt_form_is_local(form))
        return nt_plan_contact_eval(plan, form, -gap);
    return nt_interaction_eval_gap(plan, state, place, gap);
}
static inline void nt_interaction_move(const nt_plan *plan, nt_interaction_state *state, const nt_place *place,
                                       double gap)
{
    if (!(state->attached && plan->relief.count == 0 && gap <= plan->capture_gap))
        nt_interaction_advance_gap(plan, state, place, gap);
}
/* {U, F, k, a} and dU/dR of a local form for the contact of a place; all NaN where it refuses. A law that cannot follow
 * the radius says dU/dR = U/(2 R), as Hertz. */
nt_bank_value nt_plan_local_eval(const nt_plan *plan, nt_form form, const nt_contact *contact, double indentation);
/* Where that contact lets go under grips [m]. */
double nt_plan_local_release_gap(const nt_plan *plan, nt_form form, const nt_contact *contact);

/* places.c: E* on a sample of Young's modulus E_s [Pa]. */
double nt_plan_effective_modulus(const nt_plan *plan, double youngs_modulus);
/* The contact of a scene at the corner plan->corner of what its surface is made of. */
void nt_plan_take_properties(nt_plan *plan, const nt_scene *scene);
/* The scene as it is computed: with the modulus of a sample that relaxes, modulus and adhesion of that corner 0, and
 * the z0 of w. */
nt_scene nt_plan_scene_over(const nt_plan_inputs *inputs);
/* Facts at all corners: the worst of them, with the contact of corner 0. */
nt_status nt_plan_over_surface(nt_plan *plan, const nt_scene *scene, nt_problem *problem);
/* The contact at a place (NULL: the plan's own), at a radius, at a corner of least and most. */
nt_contact nt_plan_contact_of_place(const nt_plan *plan, const nt_place *place);
nt_contact nt_plan_contact_of_radius(const nt_plan *plan, double radius);
nt_contact nt_plan_contact_of_corner(const nt_plan *plan, int corner);
/* How much larger than the plan's own the units of stiffness, radius and indentation can be, at least 1. */
double nt_plan_largest_unit(const nt_plan *plan, nt_quantity quantity);
/* Whether the contact changes from place to place: with the radius, or with what the surface is made of. */
int nt_plan_varies(const nt_plan *plan);
/* The largest gap at which a contact is held anywhere [m]. */
double nt_plan_farthest_release(const nt_plan *plan);
/* Where a local contact carries `load` [m]; NaN if it never does. */
double nt_plan_local_depth(const nt_plan *plan, nt_form form, const nt_contact *contact, double load);

/* local.c: where the contact lets go under grips, of the form that was chosen, at a place (NULL: the plan's own) [m].
 */
double nt_plan_release_gap(const nt_plan *plan, const nt_place *place);
/* Whether the surface is curved where the contact can follow it. */
int nt_plan_is_curved(const nt_plan *plan);
/* The largest effective radius of the surface over the tip's own, at least 1. */
double nt_plan_largest_ratio(const nt_plan *plan);
/* How far the radii of the surface move the release gap from that of the tip's own [m]. */
double nt_plan_curvature_shift(const nt_plan *plan);
/* How far off the bank is over the places of the surface, in the norm of a demand; its fold [m]. */
double nt_plan_bank_error(const nt_plan *plan, nt_quantity quantity);
double nt_plan_bank_shift(const nt_plan *plan);
/* Just inside a release gap, where the contact still holds: on the fold itself rounding decides. */
double nt_plan_last_hold(double release_gap);
/* Pull-off, stiffness, jump-in and folds of a local contact: the worst of the surface. */
void nt_plan_local_facts(nt_plan *plan, double maximum_load);

/* laws.c: everything beside contact, by the rows of terms/: first what is tabulated once, ... */
nt_status nt_plan_tabulate(nt_plan *plan, const nt_scene *scene, nt_problem *problem);
/* ... then what depends on the gap where adhesion takes hold [m], and on the contact, and what it leaves of w. */
void nt_plan_prepare_laws(nt_plan *plan, const nt_scene *scene, double capture_gap);
nt_status nt_plan_laws_of(nt_plan *plan, const nt_scene *scene, nt_problem *problem);
/* One of these terms in a form at a gap; the sum of all of them in full. */
nt_law_value nt_plan_law_eval(const nt_plan *plan, int term, nt_form form, double gap);
nt_law_value nt_plan_beside_at(const nt_plan *plan, double gap);
/* What is taken out of w, because a tail pulls it already (E5b) [J/m^2]. */
double nt_plan_tail_share(const nt_plan *plan);
/* The law whose tail takes most of w; NT_PLAN_CONTACT: none has one. */
int nt_plan_strongest_tail(const nt_plan *plan);
nt_scene nt_plan_scene_without_tails(const nt_scene *scene);
/* The largest |F| or |k| of a term at all gaps from `gap` on; signs that could cancel are not trusted. */
double nt_plan_law_limit(const nt_plan *plan, int term, double gap, nt_quantity quantity);
/* The gap below which a term keeps its value [m]; 0 for contact. */
double nt_plan_hold_gap(const nt_plan *plan, int term);
/* The fullest form of a term that the scene has, NT_FORM_OFF if it has none. */
nt_form nt_plan_full_form(const nt_plan *plan, int term);

/* facts.c: pull-off, stiffness, energies of the jumps, with everything on. */
nt_status nt_plan_facts(nt_plan *plan);
/* The largest value above 0 at gaps from `first` to `last` [m] that laws of one's own tell apart, which sweeps pass. */
typedef double nt_plan_gap_law(const nt_plan *plan, double gap);
double nt_plan_largest_at_edges(const nt_plan *plan, nt_plan_gap_law *law, double first, double last);
/* A pull, 0 where the tables of laws of one's own err by more [N]. */
double nt_plan_known_pull(const nt_plan *plan, double pull);

/* pull_off.c: all of the above at a work of adhesion [J/m^2], which a scene reads that gives a pull-off force; and with
 * the w that has the measured one. */
nt_status nt_plan_laws_at(nt_plan *plan, const nt_scene *scene, double work_of_adhesion, nt_problem *problem);
nt_status nt_plan_adhere(nt_plan *plan, const nt_scene *scene, nt_problem *problem);

/* distance.c: what of the range is visited, from which alone the scale S follows. */
void nt_plan_visit(nt_plan *plan, const nt_scene *scene);
/* The largest gap at which there can be contact, at every place of the surface [m]. */
double nt_plan_contact_reach(const nt_plan *plan);
/* The quantity of a demand. */
double nt_plan_pick(nt_law_value value, nt_quantity quantity);
/* What forces are measured by, whatever is demanded; of adhesive contact no more than its own pull-off force [N]. */
double nt_plan_force_scale(const nt_plan *plan, double maximum_load);
/* S: the pull-off force or what would be its like; never so small that what cannot be felt would count. */
double nt_plan_scale_of(const nt_plan *plan, double maximum_load);
/* The largest difference, over max(|truth|, S), of a form of contact to the fullest one; of the
 * tip's own radius to the radii of the surface. */
double nt_plan_contact_distance(const nt_plan *plan, nt_form form);
double nt_plan_curvature_distance(const nt_plan *plan);
/* From which distance to a fold or to first touch on the bound holds where the folds are in place [m]. */
double nt_plan_away_from_folds(const nt_plan *plan);
/* And so many shifts of a fold by how the sample deforms. */
#define NT_ELASTIC_BESIDE 3.0
/* What Hertz, DMT and JKR would err by, on what load control can hold, away from its fold; Hertz and DMT know contact
 * only from first touch on. */
void nt_plan_rivals_of(nt_plan *plan);

/* options.c: the forms of every term with error and cost. */
enum { NT_OPTIONS_MAX = NT_FORM_COUNT }; /* each at most once */
#define NT_SAMPLED                                                                                                     \
    1.05 /* a largest value that was sampled on a smooth curve may be this much short of the true one                  \
          */
typedef struct nt_plan_options {
    struct {
        nt_form form;
        double error, cost, latency;
        double beside[2]; /* of contact: what the first law beside it costs more, and its latency */
    } option[NT_PLAN_TERMS][NT_OPTIONS_MAX];
    int count[NT_PLAN_TERMS];
} nt_plan_options;
void nt_plan_options_of(nt_plan *plan, const nt_scene *scene, nt_plan_options *options);
/* Adds a form; its cost is that of its row. */
void nt_plan_offer(const nt_plan *plan, nt_plan_options *options, int term, nt_form form, double error);
/* Costs are sums of decimals: a budget that was printed does. */
#define NT_BUDGET_ROUNDS (1.0 + 1e-9)
/* What the surface under a contact in a form costs; 0: cost, 1: latency. */
double nt_plan_cost_of_place(const nt_plan *plan, nt_form form, int which);
/* An error in the demanded quantity as a share of its scale. */
double nt_plan_share(const nt_plan *plan, double error);
/* What the tables of laws of one's own err by [N or N/m]. */
double nt_plan_table_error(const nt_plan *plan, nt_quantity quantity);
/* A refusal that names no accuracy: because the sample deforms under a law, or of such a table if that errs by more. */
nt_problem nt_plan_reason(const nt_plan *plan, const char *law, double error);

/* elastic.c: what the terms beside contact err by where they add on the undeformed gap, as a share of the demand;
 * also the elastic number, and where a sample that is pulled jumps: 0.56 of a pressure as 1/g^3, 0.81 of an
 * exponential. */
#define NT_ELASTIC_JUMP 0.55
double nt_plan_rigid_error(nt_plan *plan, const nt_scene *scene);
/* What terms that are left out do to the stiffness of a contact without adhesion, beside their own, as a share. */
double nt_plan_press_error(const nt_plan *plan);
/* The gap below which the surface would jump to a pull [m]. */
double nt_plan_jump_gap(const nt_plan *plan);
/* Whether contact is that of the layer, and not of a half-space. */
static inline int nt_plan_solves_layer(const nt_plan *plan)
{
    return plan->deformation.count > 0 && plan->source == NT_ADHESION_NONE;
}

/* Of what acts around an adhesive contact; of folds and radius, with `tails`, also of what the tail pulls more. */
double nt_plan_around_error(const nt_plan *plan, int tails);
/* elastic_contact.c: what the force of such a contact errs by, because its tail on the undeformed gap takes too little
 * of w. */
double nt_plan_tail_error(const nt_plan *plan);
/* What a deforming plan adds to its bound, `error`, because its tail's share of w is no better than its table, which
 * errs by a part of that; deformation.doubt, deformation.beside. */
double nt_plan_doubt_share(nt_plan *plan, double of_table, double error);
/* How far the folds of an adhesive contact are from where they would be on a sample that deforms [m]. */
double nt_plan_rigid_shift(const nt_plan *plan);
/* deformation/deform.c: the tables of a sample that came to no end, and the last that did, so that no other demand
 * makes them again. */
enum { NT_DEFORM_TRIED = 64 };
typedef struct nt_deform_end {
    double tolerance, scale;
    int surrounded;
    nt_status status;
} nt_deform_end;
typedef struct nt_deform_tried {
    nt_deform_end end[NT_DEFORM_TRIED];
    int count;
    nt_deform_end last; /* tolerance 0: none yet */
    nt_deform_table table;
    double *work; /* that all tables together may still take, which is counted down; NULL: whatever they take. 1: of
                   * the equations of a full mesh, solved once, some 0.15 ms; a table takes 20 to 500 */
} nt_deform_tried;
/* The plan of a scene whose sample deforms under all terms together, within an accuracy (0: that of everything exact),
 * made from one that has facts and no choice yet. `tried`: of this scene. */
nt_status nt_plan_deform(const nt_plan *plan, const nt_scene *scene, double accuracy, nt_deform_tried *tried,
                         nt_plan *made, nt_problem *problem);
/* deformation/adhere.c: with its table, contact and facts of a scene with adhesion; errors of the table and of all that
 * is in none, as shares of the demand. NT_E_RANGE: contact and table do not fit. */
nt_status nt_plan_deform_adhere(nt_plan *plan, const nt_scene *scene, double of_table, double others,
                                nt_problem *problem);
/* Whether other laws press on the sample around its adhesive contact by so much that contact and laws are solved
 * together. */
int nt_plan_is_surrounded(const nt_plan *plan, const nt_scene *scene);
/* Of a contact that is in that table: where it lets go, its depth and stiffness at the largest load. */
void nt_plan_hold_facts(nt_plan *plan, double maximum_load);
/* All beside contact, with everything on, where contact holds or does not; at the tip's own radius. */
nt_law_value nt_plan_around(const nt_plan *plan, int attached, double gap);
/* What a deformed tail pulls of w in contact [J/m^2]. */
double nt_plan_deform_share(const nt_plan *plan);
/* U of that where contact holds less U where it does not, at a place (NULL: the tip's own radius) [J]. */
double nt_plan_rise(const nt_plan *plan, const nt_place *place, double gap);
/* How far from first touch of a table without adhesion the bound of its contact radius begins [m]. */
double nt_plan_deform_touch(const nt_plan *plan);
/* relief.c: where adhesion takes hold at a place (NULL: at the tip's own radius) [m]. */
double nt_plan_capture_gap(const nt_plan *plan, const nt_place *place);

/* plan.c: begun and decided, without the facts of a plan that is made. */
nt_status nt_plan_try(nt_plan *plan, const nt_plan_inputs *inputs, nt_deform_tried *tried, nt_problem *problem);
/* refusal.c: what can be demanded of a sample for which no table was made; NT_E_RANGE. */
nt_status nt_plan_refuse(const nt_plan *plan, const nt_plan_options *options, const nt_problem *reason,
                         nt_problem *problem);
/* And what is said of a plan that was refused for a reason: an accuracy that is planned, near the smallest, or why
 * there is none. */
nt_remedy nt_plan_remedy(const nt_plan_inputs *inputs);
nt_problem nt_plan_word(const nt_plan *plan, const nt_plan_inputs *inputs, nt_deform_tried *tried,
                        const nt_problem *reason);

/* demand.c: what the accuracy or the budget would have to be. */
nt_problem nt_demand_accuracy(double demanded, double least);
nt_problem nt_demand_budget(double budget, double cost);
/* scene.c: a field by its name; NULL: there is none. */
const nt_field *nt_scene_field(const char *name);

/* choice.c: one form of each term; the cheapest that keeps an accuracy (0: the fullest) and a budget (0: none). */
typedef struct nt_plan_choice {
    int index[NT_PLAN_TERMS];
    double error, cost;
} nt_plan_choice;
nt_status nt_plan_choose(const nt_plan_options *options, double accuracy, double budget, nt_plan_choice *choice,
                         nt_problem *problem);
/* Whether it leaves out all that is beside contact. */
int nt_plan_is_alone(const nt_plan_options *options, const nt_plan_choice *choice);
/* The plan has it. */
void nt_plan_take(nt_plan *plan, const nt_plan_options *options, const nt_plan_choice *choice);

/* relaxation.c: whether time matters, and with which moduli; bed and bound come with nt_plan_relaxation_of. */
nt_plan_relaxation nt_plan_relaxation_before(const nt_plan_inputs *inputs);
/* What goes with a sample that relaxes is contact alone. NT_E_RANGE with what does not. */
nt_status nt_plan_check_relaxation(const nt_plan_inputs *inputs, nt_problem *problem);
/* Takes the springs that keep the demand, of a plan with everything else decided. */
nt_status nt_plan_relaxation_of(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem);
/* How deep a load held for range.duration presses a sample that relaxes [m], and its stiffness there over a period; of
 * any other plan 0 [N/m]. */
double nt_plan_slow_depth(const nt_plan *plan, double load);
double nt_plan_quick_stiffness(const nt_plan *plan, double indentation);

/* plastic.c: a sample that keeps dents, if the scene wants one. NT_E_RANGE with what does not go with it. */
nt_status nt_plan_dents_of(nt_plan *plan, const nt_scene *scene, nt_problem *problem);
/* sliding.c: whether friction is computed, its law, bound and cost. Of a plan that has chosen; NT_E_RANGE: a budget, or
 * a shape whose load inside is not known. */
nt_status nt_plan_friction_of(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem);
void nt_plan_warn_friction(nt_plan *plan);
/* The contact of friction in a form of contact, from its law. */
nt_friction_contact nt_plan_friction_contact(const nt_plan *plan, const nt_contact *contact, nt_law_value law);

/* plastic.c: refuses a load at which the contact is plastic; warns where it begins to be. */
nt_status nt_plan_check_plastic(const nt_plan *plan, const nt_scene *scene, nt_problem *problem);
void nt_plan_warn_plastic(nt_plan *plan, const nt_scene *scene);

/* warnings.c: what the bound does not cover. */
void nt_plan_warn(nt_plan *plan, const nt_scene *scene);
/* Of a z0 that is not the one given. */
void nt_plan_warn_distance(nt_plan *plan, const nt_scene *given, const nt_scene *computed);
void nt_plan_add_warning(nt_plan *plan, nt_plan_warning warning);
/* flank.c: how far laws of a sphere are from those of a cone, a punch, a truncated tip. */
void nt_plan_warn_flank(nt_plan *plan);

/* interaction.c: the effective radius at a place (NULL: the tip's own) [m]; its contact, with dU/dR; whether it
 * is captured by contact or meniscus: already, or because the gap is inside the capture range. */
double nt_plan_radius_at(const nt_plan *plan, const nt_place *place);
nt_bank_value nt_plan_contact_at(const nt_plan *plan, const nt_place *place, double gap);

/* The force in x and y [N] at a gap [m] over a place where the vertical force [N] is known; where each place has its
 * own law it is computed again. */
void nt_plan_sides(const nt_plan *plan, const nt_interaction_state *state, const nt_place *place, double gap,
                   double force, double sides[2]);
int nt_plan_is_attached(const nt_plan *plan, int attached, const nt_place *place, double gap);

#endif
