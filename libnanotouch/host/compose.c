/* SPDX-License-Identifier: BSD-3-Clause
 * How a session is opened that a person touches: scales by which the forces of the sample are felt, a hand without a
 * motor that reaches over the surface, and a start where next to nothing is felt. */
#include <math.h>

#include "core/problem.h"
#include "host/state.h"

static const double INDENTATION = 0.3e-6, ATTRACTION = 0.6e-6,
                    CLEARANCE = 0.1e-6;                       /* Eq. 21, the paper's [m], [N], [m] */
static const double MIN_CLEARANCE = 20e-9, MAX_RELIEF = 1e-3; /* [m] */
static const double SEEN = 0.93;                              /* of a plan's pull-off that a loop shows at least */
static const double LATERAL_REACH = 1.5;                      /* travel of the master over the size of the surface */
static const double DOWN_REACH = 1.5;                         /* and over what lies below where it starts */
static const double COUPLING = 0.25;                          /* spring between proxy and tip over the lever's */
static const double SETTLING = 2e-3; /* of the virtual tool [s], times the lever's spring over its own */
static const double DEEPEST = 1.5;   /* limit of the indentation over that of the max load */

/* alpha_f at which a pull-off would be clearly felt; no loop closes that could be less than calm. */
static double felt_scale(const nt_rig *rig, double usual, double pull_off, double load)
{
    const nt_master *master = &rig->master;
    const double hand = master->gauge ? fmin(master->gauge_range, master->max_force) : master->max_force;
    const double wanted = pull_off > 0.0 ? NT_CLEARLY_FELT / (SEEN * pull_off) : (double)INFINITY;
    return fmax(usual, fmin(wanted, 2.0 * hand / (load + pull_off)));
}

static double clearance_of(const nt_plan *plan, double load)
{
    const double reach = nt_plan_cutoff_gap(plan, 0.002 * fmax(load, plan->pull_off_force));
    const double release = isfinite(plan->release_gap) ? 2.0 * plan->release_gap : 0.0;
    return fmax(MIN_CLEARANCE, fmax(1.5 * fmin(reach, 1e-6), release));
}

static void choose_settings(nt_session_setup *setup, const nt_plan *plan, double relief)
{
    nt_settings *settings = &setup->settings;
    const double load = setup->scene.range.maximum_load;
    *settings = nt_settings_defaults(&setup->rig);
    const nt_scaling scaling = nt_scaling_heuristic(&setup->rig, CLEARANCE + INDENTATION + relief, ATTRACTION);
    nt_gains *gains = &settings->gains;
    gains->alpha_p = scaling.alpha_p;
    nt_settings_keep_to(settings, load);
    gains->alpha_f = felt_scale(&setup->rig, scaling.alpha_f, plan->pull_off_force, load);
    gains->force_gain = 0.0; /* no gauge hears the hand */
    gains->coupling_stiffness = COUPLING * setup->rig.probe.spring_constant * gains->alpha_p * gains->alpha_f;
    gains->coupling_damping = gains->coupling_stiffness * SETTLING / COUPLING;
    settings->limits.indentation = fmax(settings->limits.indentation, DEEPEST * plan->largest_indentation);
}

/* With the springs between pressed to the force limit. */
static void choose_hand(nt_session_setup *setup, double down, double extent)
{
    const double soft = COUPLING / (1.0 + COUPLING) * setup->rig.probe.spring_constant;
    const double far = fmax(LATERAL_REACH * extent, DOWN_REACH * (down + setup->settings.limits.force / soft));
    nt_master *master = &setup->rig.master;
    master->motor = master->gauge = 0;
    master->axes = 3;
    master->resolution = 1e-7;
    master->travel = fmin(10.0, fmax(master->travel, 2.0 * far / setup->settings.gains.alpha_p));
}

nt_status nt_host_compose(nt_session_host *host, nt_session_setup *setup, const nt_host_ground *ground,
                          nt_problem *problem)
{
    if (!(ground->relief <= MAX_RELIEF))
        return nt_problem_set(problem, "height of the surface", "m", ground->relief, 0.0, MAX_RELIEF);
    nt_plan *plan = &host->spare;
    const nt_plan_inputs inputs = {.scene = &setup->scene, .demand = &setup->demand};
    const nt_status status = nt_plan_make(plan, &inputs, problem);
    if (status != NT_OK)
        return host->reopens
                   ? nt_host_refuse_change(host, host->reopening.field, host->reopening.after, problem, status)
                   : status;
    choose_settings(setup, plan, ground->relief);
    setup->clearance =
        ground->clearance > 0.0 ? ground->clearance : clearance_of(plan, setup->scene.range.maximum_load);
    for (int i = 0; ground->keeps && i < host->kept_count; ++i) {
        nt_host_kind kind;
        const nt_field *field = nt_host_field(host->kept[i].field, &kind);
        nt_field_set(field, &setup->settings, host->kept[i].after);
    }
    const double extent = fmax(ground->width, ground->height);
    choose_hand(setup, setup->clearance + ground->relief + DEEPEST * plan->largest_indentation, extent);
    setup->mode = NT_MODE_TOUCH;
    setup->x = 0.5 * ground->width;
    setup->y = 0.5 * ground->height;
    return NT_OK;
}
