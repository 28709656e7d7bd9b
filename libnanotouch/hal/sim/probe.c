/* SPDX-License-Identifier: BSD-3-Clause
 * The probe of the simulated rig: the cantilever over the interaction of the plan, quasi-static or dynamic. Heights
 * count from the surface under the tip, so that a surface that passes by below is the same as a base that moves. */
#include <math.h>
#include <stddef.h>

#include "core/clamp.h"
#include "core/rig.h"
#include "core/same_bits.h"
#include "hal/sim/sim.h"
#include "internal/dynamics.h"
#include "internal/rheology.h"
#include "parts.h"
#include "plasticity/dents.h"
#include "rheology/loop.h"
#include "scene/interaction.h"
#include "scene/parts.h"

#define PERCEIVED 1e-3 /* touch feels nothing quicker [s] */
#define NEAR 1e-3      /* and good enough for a peak this close */
#define SAME_LAW 1e-6  /* a law is known by its derivatives this close to where it was asked, over plan->length */

/* What the cantilever asks: the force at a gap, here. The last answer is kept: contact laws are by far the dearest part
 * of a period, and the probe begins each one where it ended the last. */
typedef struct probe_context {
    const nt_plan *plan;
    nt_interaction_state *interaction;
    nt_dents *dents;
    const nt_place *place;
    nt_sim_slave *slave;
    nt_pushed_state *pushed; /* of the last answer; NULL: nothing lies there */
    double surface;          /* z_s under the tip [m] */
    double gap;              /* of the last answer [m] */
    nt_law_value law;
    double peak, deepest; /* |F| and h on the way [N], [m] */
    int parted;           /* 1: there was no contact on the way */
} probe_context;

/* The force of what lies there beside the surface's. */
static void add_pushed(probe_context *probe, double gap)
{
    const nt_status status = nt_sim_lead_pushed(probe->slave, gap + probe->surface, probe->pushed);
    probe->law.F = status == NT_OK ? probe->law.F + probe->pushed->force[NT_Z] : (double)NAN;
    probe->law.k += probe->pushed->resistance;
}

/* Of a contact that depends on what was done before. */
static nt_law_value law_of_history(const probe_context *probe, double gap)
{
    const nt_sim_relaxing *relaxing = &probe->slave->relaxing;
    if (probe->plan->history == NT_HISTORY_DENTS)
        return nt_dents_eval(&probe->plan->indentation, probe->dents, gap);
    return nt_viscoelastic_at(&probe->plan->relaxation.bed, &relaxing->state, relaxing->held, -gap);
}

static nt_law_value force_at(void *context, double gap)
{
    probe_context *probe = context;
    if (gap != probe->gap) {
        probe->gap = gap;
        probe->law = probe->plan->history ? law_of_history(probe, gap)
                                          : nt_interaction_law(probe->plan, probe->interaction, probe->place, gap);
        if (probe->pushed)
            add_pushed(probe, gap);
    }
    return probe->law;
}

static void moved_to(void *context, double gap)
{
    probe_context *probe = context;
    if (!probe->plan->history) {
        nt_interaction_move(probe->plan, probe->interaction, probe->place, gap);
        return;
    }
    if (probe->plan->history == NT_HISTORY_RELAXES)
        return; /* at the end of the period */
    const double heat = probe->dents->dissipated;
    nt_dents_advance(&probe->plan->indentation, probe->dents, gap);
    if (probe->dents->dissipated > heat)
        probe->gap = NAN; /* the law is another one now */
}

/* A dynamic probe has really been where it passes. */
static void passed(void *context, double gap)
{
    probe_context *probe = context;
    const double step = gap - probe->gap, force = fabs(probe->law.F - probe->law.k * step);
    if (fabs(step) <= NEAR * probe->plan->length && force > probe->peak)
        probe->peak = force;
    if (gap < probe->deepest)
        probe->deepest = gap;
    if (!(probe->law.a > 0.0))
        probe->parted = 1;
    moved_to(context, gap);
}

/* The law where the probe has come to: that of its last question, mostly one Newton step away. */
static nt_law_value law_there(probe_context *probe, double gap)
{
    const double step = gap - probe->gap;
    if (!(fabs(step) <= SAME_LAW * probe->plan->length))
        return force_at(probe, gap);
    nt_law_value law = probe->law;
    law.U -= law.F * step;
    law.F -= law.k * step;
    return law;
}

/* The tip has gone straight to its place of this period. A last step of Newton's that is too small to matter is not
 * asked again. */
static void keep_pushed(probe_context *probe, double gap)
{
    nt_status status = NT_OK;
    if (!(fabs(gap - probe->gap) <= SAME_LAW * probe->plan->length))
        status = nt_sim_lead_pushed(probe->slave, gap + probe->surface, probe->pushed);
    if (status == NT_OK)
        nt_sim_keep_pushed(probe->slave, probe->pushed);
}

/* On a sample that yields the front half alone holds a tip that ploughs; what the groove takes adds to the limit, as a
 * load with a coefficient of 1. */
static void slide_in_dent(nt_sim_slave *slave)
{
    const nt_dents *dents = &slave->dents;
    nt_slide *last = &slave->slide;
    nt_friction law = slave->plan->friction.law;
    const double way[2] = {last->placed ? slave->x - last->x : 0.0, last->placed ? slave->y - last->y : 0.0};
    const double ploughing = nt_dents_ploughing(&slave->plan->indentation, dents);
    const nt_friction_contact contact = {sqrt(1.0 - 0.5 * dents->ploughed) * dents->contact.contact_radius,
                                         law.coefficient * dents->contact.force + ploughing};
    law.coefficient = 1.0;
    (void)nt_friction_advance(&law, &last->friction, &contact, way);
    last->x = slave->x;
    last->y = slave->y;
    last->placed = 1;
}

/* A tip that hangs back by its springs leaves its groove where it slips. */
static void plough(nt_sim_slave *slave)
{
    const nt_friction_state *friction = &slave->slide.friction;
    const double give = friction->stiffness > 0.0 ? 1.0 / friction->stiffness : 0.0;
    nt_dents_slide(&slave->plan->indentation, &slave->dents, slave->x + give * friction->force[NT_X],
                   slave->y + give * friction->force[NT_Y]);
}

/* Nothing is held sideways any more: what the spring of friction held is heat. */
static void release(nt_sim_slave *slave)
{
    static const nt_friction_contact none = {0.0, 0.0};
    (void)nt_friction_advance(&slave->plan->friction.law, &slave->slide.friction, &none, (double[2]){0.0, 0.0});
}

/* Friction at the end of a period; what it held is lost where the contact was, even for a moment. The support of the
 * tip is where the stage is: tip and lever are its spring. */
static void slide(nt_sim_slave *slave, int parted, double gap)
{
    const int rubs = slave->plan->friction.term.form != NT_FORM_OFF;
    const nt_pose here = {slave->x, slave->y, gap};
    if (parted && rubs)
        release(slave);
    if (slave->plan->history == NT_HISTORY_DENTS && rubs)
        slide_in_dent(slave);
    else if (rubs || slave->slide.placed) /* or has rubbed by another plan */
        nt_interaction_slide_gap(slave->plan, &slave->interaction, &slave->slide, &slave->place, &here);
}

double nt_sim_surface_height(const nt_sim_slave *slave)
{
    return nt_interaction_place(slave->plan, slave->x, slave->y).surface.z - slave->lowered +
           nt_sim_surface_jump(&slave->link);
}

/* Of the dent. */
static double radius_of(const nt_viscoelastic_bed *bed, int touched)
{
    double radius = 0.0;
    for (int i = 0; i < touched; i++)
        radius += 0.5 * bed->weight[i];
    return radius;
}

/* The sample relaxes for a period. A tip that has left the contact comes down on what was never touched. */
static void relax(nt_sim_slave *slave)
{
    nt_sim_relaxing *of = &slave->relaxing;
    const nt_viscoelastic_bed *bed = &slave->plan->relaxation.bed;
    const double x = slave->x - of->x, y = slave->y - of->y;
    if (of->state.pressed > 0) {
        of->x = slave->x;
        of->y = slave->y;
    } else if (of->state.touched > 0 && hypotenuse(x, y) > radius_of(bed, of->state.touched)) {
        of->state = (nt_viscoelastic_state){.touched = 0};
    }
    nt_viscoelastic_begin(bed, &of->state, of->held);
    slave->law_gap = NAN; /* the law is another one now */
}

/* Where it touches nothing: what the last contact has left, and how deep the dents are here. */
static void begin_history(nt_sim_slave *slave)
{
    slave->left = 0;
    if (!slave->plan->history)
        return;
    if (slave->plan->history == NT_HISTORY_RELAXES)
        relax(slave);
    if (slave->plan->history == NT_HISTORY_RELAXES || slave->dents.touches)
        return;
    const double before = slave->lowered;
    slave->left = nt_dents_place(&slave->plan->indentation, &slave->dents, slave->x, slave->y);
    slave->lowered = nt_dents_lowered(&slave->plan->indentation, &slave->dents, slave->x, slave->y);
    const double gap = slave->cantilever.tip_height + slave->lowered - before; /* the apex stays where it is ... */
    const double lift = fmax(-gap, 0.0); /* ... unless a rim lifts it: what only comes near does not yield */
    slave->cantilever.tip_height = gap + lift;
    slave->cantilever.deflection += lift / cos(slave->link.rig.probe.tilt);
}

/* What this period has done to such a contact, with the truth of it. NT_E_DEVICE: it can be followed no farther. */
static nt_status end_history(nt_sim_slave *slave, double gap)
{
    if (slave->plan->history == NT_HISTORY_DENTS) {
        plough(slave);
        slave->truth.energy = slave->dents.contact.stored;
        slave->truth.dent_heat = slave->dents.dissipated;
        return slave->dents.full ? NT_E_DEVICE : NT_OK;
    }
    const nt_viscoelastic_bed *bed = &slave->plan->relaxation.bed;
    nt_sim_relaxing *of = &slave->relaxing;
    nt_viscoelastic_end(bed, &of->state, of->held, -gap);
    slave->law.U = slave->truth.energy = nt_viscoelastic_stored(bed, &of->state);
    return of->state.indentation > bed->max_indentation ? NT_E_DEVICE : NT_OK;
}

/* What is known of the place under the tip; 1: it is another one. */
static int find_place(nt_sim_slave *slave)
{
    if (slave->x == slave->place_x && slave->y == slave->place_y)
        return 0;
    slave->place = nt_interaction_place(slave->plan, slave->x, slave->y);
    slave->place_x = slave->x;
    slave->place_y = slave->y;
    return 1;
}

/* Springs of another sample, or of more depth. One that has not relaxed so far begins at rest under the tip; its lever
 * is at rest from now on. */
static void begin_to_relax(nt_sim_slave *slave, const nt_plan *before)
{
    nt_sim_relaxing *of = &slave->relaxing;
    const nt_viscoelastic_state old = of->state;
    const nt_viscoelastic_bed *bed = before->history == NT_HISTORY_RELAXES ? &before->relaxation.bed : NULL;
    nt_viscoelastic_carry(bed, &old, &slave->plan->relaxation.bed, &of->state);
    if (!bed && slave->truth.gap < 0.0)
        nt_viscoelastic_rest(&slave->plan->relaxation.bed, &of->state, -slave->truth.gap);
    slave->dynamic = 0;
}

void nt_sim_change_plan(nt_sim_slave *slave, const nt_plan *plan)
{
    const nt_plan *before = slave->plan;
    if (plan == before)
        return;
    slave->plan = plan;
    slave->lowered = slave->dents.touches = 0; /* what touched by another law has let go */
    if (plan->history)
        slave->interaction.attached = 0; /* its contact is another one */
    if (plan->history == NT_HISTORY_RELAXES)
        begin_to_relax(slave, before);
    slave->place_x = slave->law_gap = NAN; /* nothing is known of it yet */
    slave->tap.table = (nt_flow_table){.cell = {{.is_made = 0}}};
}

/* Of slopes and what is pushed. A sample that keeps dents or relaxes has one contact everywhere: the slope alone turns
 * its force aside.
 */
static void sides_of(const nt_sim_slave *slave, double gap, double force, double sides[2])
{
    const double *pushed = slave->pushed.state.force;
    double slopes[2] = {0.0, 0.0}; /* of a flat */
    if (slave->plan->surface && slave->plan->history) {
        slopes[NT_X] = -force * slave->place.surface.zx;
        slopes[NT_Y] = -force * slave->place.surface.zy;
    } else if (slave->plan->surface) {
        nt_plan_sides(slave->plan, &slave->interaction, &slave->place, gap, force, slopes);
    }
    sides[NT_X] = slopes[NT_X] + pushed[NT_X];
    sides[NT_Y] = slopes[NT_Y] + pushed[NT_Y];
}

/* What there is at the end of a period; sides: of slopes and of what is pushed [N]. Of a law that is no number peak and
 * depth are those on the way. */
static void tell_truth(nt_sim_slave *slave, const probe_context *context, const double sides[2])
{
    const nt_friction_state *friction = &slave->slide.friction;
    const nt_law_value law = slave->law;
    const double gap = slave->law_gap;
    slave->truth = (nt_truth){.gap = gap,
                              .tip_force = {sides[0] + friction->force[0], sides[1] + friction->force[1], law.F},
                              .peak_force = greater(fabs(law.F), context->peak),
                              .deepest_gap = lesser(gap, context->deepest),
                              .contact_radius = law.a,
                              .surface_height = context->surface,
                              .tip_height = gap + context->surface,
                              .energy = law.U,
                              .dent_heat = slave->dents.dissipated,
                              .friction_stored = friction->stored,
                              .friction_heat = friction->dissipated};
}

nt_status nt_sim_move_probe(nt_sim_slave *slave)
{
    const int is_elsewhere = find_place(slave);
    begin_history(slave);
    const double surface = slave->place.surface.z - slave->lowered + nt_sim_surface_jump(&slave->link);
    const double base = slave->start_height - slave->stage.position - nt_sim_stage_drift(&slave->link) - surface;
    if (nt_sim_taps(slave)) {
        release(slave); /* a lever that taps rubs nothing */
        return nt_sim_tap_step(slave, base, surface);
    }
    const int lie = slave->pushed.state.count > 0, pushes = lie && is_elsewhere;
    const int knows = surface == slave->truth.surface_height && !(is_elsewhere && slave->plan->properties) && !pushes;
    nt_pushed_state pushed;
    probe_context context = {.plan = slave->plan,
                             .interaction = &slave->interaction,
                             .dents = &slave->dents,
                             .place = &slave->place,
                             .slave = slave,
                             .pushed = lie ? &pushed : NULL,
                             .surface = surface,
                             .gap = knows ? slave->law_gap : (double)NAN, /* another place: nothing is known there */
                             .law = slave->law,
                             .peak = 0.0,
                             .deepest = HUGE_VAL,
                             .parted = 0};
    slave->pushed.left = 0;
    if (lie)
        nt_pushed_copy(&slave->pushed.laws, &pushed, &slave->pushed.state);
    const nt_force_field field = {force_at, slave->dynamic ? passed : moved_to, &context, slave->plan->length};
    const nt_status status = slave->dynamic
                                 ? nt_cantilever_step(&slave->cantilever_model, &slave->cantilever, &field, base,
                                                      nt_sim_noise_now(&slave->link, NT_SIM_NOISE_TIP))
                                 : nt_cantilever_settle(&slave->cantilever, &slave->link.rig.probe, &field, base, NULL);
    const double gap = slave->cantilever.tip_height;
    const nt_law_value law = law_there(&context, gap);
    if (lie && status == NT_OK)
        keep_pushed(&context, gap);
    slave->law = law;
    slave->law_gap = gap;
    double sides[2];
    sides_of(slave, gap, law.F, sides);
    slide(slave, context.parted, gap);
    tell_truth(slave, &context, sides);
    if (slave->plan->history && end_history(slave, gap) != NT_OK)
        return NT_E_DEVICE; /* a reading that is none stops the touch */
    return lie && status != NT_OK ? NT_E_DEVICE : status;
}

int nt_sim_needs_dynamics(const nt_plan *plan, const nt_rig *rig, double period)
{
    const nt_cantilever_lag lag = nt_cantilever_lag_of(&rig->probe, &rig->stage);
    const double demanded = fmax(plan->demand.relative_accuracy * plan->pull_off_force, plan->demand.force_floor);
    const double allowed = fmax(demanded, nt_probe_force_noise(&rig->probe));
    return !(lag.force <= allowed && lag.settling <= fmax(PERCEIVED, period));
}
