/* SPDX-License-Identifier: BSD-3-Clause
 * The force between tip and surface as a sum of potentials of the gap, with the history of one contact.
 *
 * Every term is a potential of the gap that acts on any history; the tail is held inside the gap where adhesion takes
 * hold, and what it pulls there has been taken out of w (laws.c). History only says whether the adhesive contact has
 * been made. It is made at the capture gap, where its energy is 0 or below, and lost at the release gap, the fold of its
 * law, where its energy is 0 or above; what is lost at either is dissipated. No cycle can give out energy. */
#include <math.h>

#include "nanotouch/interaction.h"
#include "scene/parts.h"

static void add(nt_law_value *sum, nt_law_value term)
{
    sum->U += term.U;
    sum->F += term.F;
    sum->k += term.k;
    sum->a += term.a;
}

nt_place nt_interaction_place(const nt_plan *plan, double x, double y)
{
    nt_place place = {{0.0, 0.0, 0.0, 0.0, 0.0, 0.0}};
    if (plan->surface)
        place.surface = nt_surface_eval(plan->surface, x, y);
    return place;
}

/* Captured by contact or meniscus: already, or because the gap is inside the capture range. */
static int is_attached(const nt_plan *plan, const nt_interaction_state *state, double gap)
{
    if (gap <= plan->capture_gap)
        return 1;
    return state->attached && gap <= plan->release_gap;
}

nt_law_value nt_interaction_eval_gap(const nt_plan *plan, const nt_interaction_state *state, const nt_place *place,
                                     double gap)
{
    (void)place;
    nt_law_value sum = {0.0, 0.0, 0.0, 0.0};
    const nt_form contact = plan->terms[NT_PLAN_CONTACT].form;
    if (contact != NT_FORM_OFF && (is_attached(plan, state, gap) || isnan(gap)))
        sum = nt_plan_contact_eval(plan, contact, -gap);
    for (int term = NT_PLAN_VDW; term < NT_PLAN_TERMS; ++term)
        if (plan->terms[term].form != NT_FORM_OFF)
            add(&sum, nt_plan_law_eval(plan, term, plan->terms[term].form, gap));
    if (isnan(gap))
        sum.U = sum.F = sum.k = sum.a = gap;
    return sum;
}

nt_interaction_value nt_interaction_eval(const nt_plan *plan, const nt_interaction_state *state, const nt_pose *pose)
{
    const nt_place place = nt_interaction_place(plan, pose->x, pose->y);
    const double gap = pose->z - place.surface.z;
    const nt_law_value law = nt_interaction_eval_gap(plan, state, &place, gap);
    /* U(h), h = z - z_s(x, y): F = -grad U = F_z (-dz_s/dx, -dz_s/dy, 1) */
    nt_interaction_value value = {.U = law.U,
                                  .Fx = -law.F * place.surface.zx,
                                  .Fy = -law.F * place.surface.zy,
                                  .Fz = law.F,
                                  .k = law.k,
                                  .a = law.a,
                                  .gap = gap};
    return value;
}

void nt_interaction_advance_gap(const nt_plan *plan, nt_interaction_state *state, const nt_place *place, double gap)
{
    (void)place;
    if (isnan(gap))
        return;
    const int attached = is_attached(plan, state, gap);
    if (attached && !state->attached)
        state->dissipated += plan->capture_energy;
    if (!attached && state->attached)
        state->dissipated += plan->release_energy;
    state->attached = attached;
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

void nt_interaction_step_n(const nt_plan *plan, nt_interaction_state *states, const nt_interaction_arrays *arrays)
{
    for (long i = 0; i < arrays->count; ++i) {
        const nt_pose *pose = &arrays->poses[i * arrays->pose_stride];
        nt_interaction_advance(plan, &states[i], pose);
        arrays->values[i * arrays->value_stride] = nt_interaction_eval(plan, &states[i], pose);
    }
}
