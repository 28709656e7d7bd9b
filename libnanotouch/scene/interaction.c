/* SPDX-License-Identifier: BSD-3-Clause
 * The force between tip and surface as a sum of potentials of the gap, with the history of one contact.
 *
 * How contact adhesion and tail share the same surface forces without counting twice (erratum E5b):
 *  - meniscus: either the bridge stands (contact law with w = 2 gamma_L over 2 r1; its non-contact Dugdale branch *is*
 * the capillary force) or the dry tail acts, never both;
 *  - solid: the tail's force is constant inside the range of the contact law's own adhesion, and what it pulls there
 * has been taken out of w (plan.c), so that together they pull 2 pi R w in the rigid limit. */
#include <math.h>

#include "nanotouch/plan.h"
#include "nanotouch/scene.h"

static void add(nt_law_value *sum, nt_law_value term)
{
    sum->U += term.U;
    sum->F += term.F;
    sum->k += term.k;
    sum->a += term.a;
}

/* Captured by contact or meniscus: already, or because the gap is inside the capture range. */
static int is_attached(const nt_plan *plan, const nt_interaction_state *state, double gap)
{
    if (gap <= plan->capture_gap)
        return 1;
    return state->attached && gap <= plan->release_gap;
}

nt_law_value nt_interaction_eval_gap(const nt_plan *plan, const nt_interaction_state *state, double gap)
{
    nt_law_value sum = {0.0, 0.0, 0.0, 0.0};
    const int attached = is_attached(plan, state, gap);
    if (attached || isnan(gap)) {
        nt_law_value contact = {NAN, NAN, NAN, NAN}; /* what stays if the law refuses the gap */
        (void)nt_contact_law_eval(&plan->contact, -gap, NT_BRANCH_STABLE, &contact);
        add(&sum, contact);
    }
    const int bridge = attached && plan->source == NT_ADHESION_MENISCUS;
    if (plan->terms[NT_PLAN_VDW].included && !bridge)
        add(&sum, nt_vdw_eval(&plan->vdw, gap));
    if (plan->terms[NT_PLAN_ELECTROSTATIC].included)
        add(&sum, nt_electrostatic_eval(&plan->electrostatic, gap));
    return sum;
}

nt_interaction_value nt_interaction_eval(const nt_plan *plan, const nt_interaction_state *state, const nt_pose *pose)
{
    nt_surface_value surface = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    if (plan->surface)
        surface = nt_surface_eval(plan->surface, pose->x, pose->y);
    const double gap = pose->z - surface.z;
    const nt_law_value law = nt_interaction_eval_gap(plan, state, gap);
    /* U(h), h = z - z_s(x, y): F = -grad U = F_z (-dz_s/dx, -dz_s/dy, 1) */
    nt_interaction_value value = {.U = law.U,
                                  .Fx = -law.F * surface.zx,
                                  .Fy = -law.F * surface.zy,
                                  .Fz = law.F,
                                  .k = law.k,
                                  .a = law.a,
                                  .gap = gap};
    return value;
}

void nt_interaction_advance(const nt_plan *plan, nt_interaction_state *state, double gap)
{
    state->attached = is_attached(plan, state, gap);
}
