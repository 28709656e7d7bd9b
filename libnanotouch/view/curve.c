/* SPDX-License-Identifier: BSD-3-Clause
 * The force curve of a plan in three parts. Each is sampled in s^2 from its fold, because force changes as the root of
 * the distance there. */
#include <math.h>

#include "internal/contact.h"
#include "internal/geometry.h"
#include "nanotouch/advanced/view.h"
#include "scene/parts.h"

static double radius_at(const nt_plan *plan, const nt_place *place)
{
    return place && nt_plan_follows(plan) ? place->radius.radius : plan->contact.radius;
}

/* Where the way in ends: adhesion takes hold, or the bodies touch. */
static double inner_end(const nt_plan *plan, const nt_place *place)
{
    const double capture = nt_plan_capture_gap(plan, place);
    return isfinite(capture) ? capture : 0.0;
}

static double outer_end(const nt_plan *plan, const nt_place *place)
{
    const double release = nt_plan_release_gap(plan, place);
    return isfinite(release) ? fmax(release, inner_end(plan, place)) : inner_end(plan, place);
}

static nt_view_point point_at(const nt_plan *plan, const nt_place *place, int attached, double gap)
{
    const nt_interaction_state state = {attached, 0.0, 0.0};
    return (nt_view_point){gap, nt_interaction_eval_gap(plan, &state, place, gap).F};
}

/* From `fold` to `end`, which is the last point, or in the other order. */
static double spread(double fold, double end, long i, long count)
{
    const double s = (double)i / (double)(count - 1);
    return fold * (1.0 - s * s) + end * s * s;
}

/* The law of the contact that a Maugis-Dugdale or JKR plan means at this place. */
typedef struct unstable_law {
    nt_maugis maugis;
    const nt_jkr_shape *jkr; /* NULL: maugis */
} unstable_law;

static int has_unstable(const nt_plan *plan, const nt_place *place, unstable_law *law)
{
    const nt_form form = plan->terms[NT_PLAN_CONTACT].form;
    if (plan->deformation.count > 0 || !(plan->contact.work_of_adhesion > 0.0))
        return 0;
    law->jkr = form == NT_FORM_JKR ? &plan->jkr : NULL;
    if (law->jkr)
        return 1;
    nt_contact contact = plan->contact;
    contact.radius = radius_at(plan, place);
    return nt_form_is_maugis(form) && nt_maugis_init(&law->maugis, &contact) == NT_OK;
}

static nt_status eval_unstable(const unstable_law *law, double gap, nt_law_value *value)
{
    return law->jkr ? nt_jkr_shape_eval(law->jkr, -gap, NT_BRANCH_UNSTABLE, value)
                    : nt_maugis_eval(&law->maugis, -gap, NT_BRANCH_UNSTABLE, value, NULL);
}

static long unstable(const nt_plan *plan, const nt_place *place, nt_view_point points[], long count)
{
    const double from = inner_end(plan, place), to = outer_end(plan, place);
    unstable_law law;
    long made = 0;
    if (!(to > from) || !has_unstable(plan, place, &law))
        return 0;
    for (long i = count - 1; i >= 0; --i) {
        const double gap = spread(to, from, i, count);
        nt_law_value value;
        if (eval_unstable(&law, gap, &value) != NT_OK)
            continue;
        const double beside = point_at(plan, place, 0, fmax(gap, nextafter(from, INFINITY))).force;
        points[made++] = (nt_view_point){gap, beside + value.F};
    }
    return made;
}

long nt_view_curve(const nt_plan *plan, const nt_place *place, const nt_view_range *range, nt_view_point points[],
                   long count)
{
    if (count < 2 || !(range->farthest > range->nearest))
        return 0;
    if (range->part == NT_VIEW_UNSTABLE)
        return unstable(plan, place, points, count);
    const int attached = range->part == NT_VIEW_ATTACHED;
    const double wanted = attached ? outer_end(plan, place) : nextafter(inner_end(plan, place), INFINITY);
    const double fold = fmin(fmax(wanted, range->nearest), range->farthest);
    const double end = attached ? range->nearest : range->farthest;
    if (fold == end)
        return 0;
    for (long i = 0; i < count; ++i) /* both begin at the far end */
        points[i] = point_at(plan, place, attached, spread(fold, end, count - 1 - i, count));
    return count;
}
