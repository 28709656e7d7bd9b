/* SPDX-License-Identifier: BSD-3-Clause
 * What the law of a scene says, along paths of gaps: for the hand, the tasks and the lesson. */
#include <math.h>

#include "host/state.h"
#include "nanotouch/interaction.h"

enum { GAPS = 4000 };
static const double DEEPEST = 1.5; /* of the max indentation */

const nt_plan *nt_law_with(nt_session_host *host, const char *field, double value)
{
    const nt_session_setup *setup = nt_session_setup_of(host->session);
    nt_scene scene = setup->scene;
    nt_host_kind kind;
    nt_field_set(nt_host_field(field, &kind), &scene, value);
    const nt_plan_inputs inputs = {.scene = &scene, .demand = &setup->demand};
    return nt_plan_make(&host->spare, &inputs, NULL) == NT_OK ? &host->spare : NULL;
}

/* The law on retraction, from the deepest gap out to first touch, at the first gap where the force is no more than a
 * load: between the two gaps around it. */
static nt_law_value retracted_to(const nt_plan *plan, double load, double *gap)
{
    const double deepest = DEEPEST * plan->largest_indentation;
    nt_interaction_state state = {.attached = 1};
    nt_law_value before = {0.0, INFINITY, NAN, NAN}, now = before;
    for (int i = 0; i <= GAPS; ++i) {
        *gap = -deepest * (GAPS - i) / GAPS;
        nt_interaction_advance_gap(plan, &state, NULL, *gap);
        now = nt_interaction_eval_gap(plan, &state, NULL, *gap);
        if (now.F <= load)
            break;
        before = now;
    }
    const double part = isfinite(before.F) && before.F > now.F ? (load - now.F) / (before.F - now.F) : 0.0;
    if (now.F > load || !(part > 0.0))
        return now;
    *gap -= part * deepest / GAPS;
    return (nt_law_value){0.0, load, now.k + part * (before.k - now.k), now.a + part * (before.a - now.a)};
}

double nt_law_depth(const nt_plan *plan, double load)
{
    double gap;
    (void)retracted_to(plan, load, &gap);
    return -gap;
}

double nt_law_stiffness(const nt_plan *plan, double load)
{
    double gap;
    return retracted_to(plan, load, &gap).k;
}

double nt_law_slow(const nt_plan *plan)
{
    const nt_plan_relaxation *of = &plan->relaxation;
    return plan->history == NT_HISTORY_RELAXES ? of->slow_modulus / of->bed.modulus_over_period : 1.0;
}

double nt_law_resting_radius(const nt_plan *plan)
{
    double gap;
    return retracted_to(plan, 0.0, &gap).a;
}

double nt_law_jump_gap(const nt_plan *plan, double spring)
{
    enum { STEPS = 6000 };
    nt_interaction_state state = {0};
    for (int i = STEPS; i >= 0; --i) {
        const double gap = 1e-11 * pow(1e4, (double)i / STEPS);
        nt_interaction_advance_gap(plan, &state, NULL, gap);
        if (state.attached || -nt_interaction_eval_gap(plan, &state, NULL, gap).k > spring)
            return gap;
    }
    return 0.0;
}
