/* SPDX-License-Identifier: BSD-3-Clause
 * Laws beside contact are those of a sphere of the tip's radius. On a tip with a flank or a flat end they are others:
 * here by how much, from the pressure of flats, F = Int p(h + s) dA(s), with A(s) the tip's cross-section at height s
 * (Derjaguin 1934). */
#include <math.h>

#include "scene/terms/term.h"

#define STEP 0.1                  /* of ln(gap): within 1 % of any power or exponential */
enum { POINTS = 140, GAPS = 36 }; /* up to 1e6 times the gap, and gaps up to 5e4 times the nearest */
#define NEXT 1.35                 /* from gap to gap */

/* A(s) = A0 + B s + C s^2 [m^2]. */
typedef struct section {
    double flat, edge, cone;
} section;

static int section_of(const nt_shape *shape, section *out)
{
    if (shape->kind != NT_SHAPE_CONE && shape->kind != NT_SHAPE_PUNCH && shape->kind != NT_SHAPE_TRUNCATED)
        return 0;
    const double circle = shape->sides ? shape->sides * tan(NT_PI / shape->sides) : NT_PI;
    const double R = shape->kind == NT_SHAPE_CONE ? 0.0 : shape->radius;
    const double slope = shape->kind == NT_SHAPE_PUNCH ? 0.0 : tan(shape->half_angle);
    *out = (section){circle * R * R, 2.0 * circle * R * slope, circle * slope * slope};
    return 1;
}

/* Force or stiffness of one law on that tip. */
static double on_tip(const nt_plan *plan, int term, const section *tip, double gap)
{
    const int force = plan->quantity == NT_QUANTITY_FORCE;
    const nt_pressure end = nt_plan_term_pressure(plan, term, gap);
    double sum = tip->flat * (force ? end.pressure : -end.slope);
    for (int i = 0; i < POINTS && tip->cone > 0.0; ++i) {
        const double far = gap * exp(STEP * (i + 0.5)), s = far - gap;
        const nt_pressure p = nt_plan_term_pressure(plan, term, far);
        sum += (force ? p.pressure : -p.slope) * (tip->edge + 2.0 * tip->cone * s) * far * STEP;
    }
    return sum;
}

/* The largest difference of all such laws at the gaps where they are not held. A law of one's own is what its author
 * says. */
void nt_plan_warn_flank(nt_plan *plan)
{
    const nt_quantity quantity = plan->quantity;
    section tip;
    if ((quantity != NT_QUANTITY_FORCE && quantity != NT_QUANTITY_STIFFNESS) || !section_of(&plan->shape, &tip))
        return;
    double worst = 0.0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_CUSTOM_1; ++term) {
        if (!nt_term_rows[term]->words.has_pressure || nt_plan_full_form(plan, term) == NT_FORM_OFF)
            continue;
        double gap = nt_plan_hold_gap(plan, term) * (1.0 + 1e-9);
        for (int i = 0; i < GAPS; ++i, gap *= NEXT) {
            const double sphere = nt_plan_pick(nt_plan_term_eval(plan, term, gap), quantity);
            worst = fmax(worst, fabs(on_tip(plan, term, &tip, gap) - sphere));
        }
    }
    const double share = nt_plan_share(plan, worst), demanded = plan->accuracy;
    if (share > demanded)
        nt_plan_add_warning(plan, (nt_plan_warning){"forces before contact, which are those of a sphere of the tip's "
                                                    "radius, differ on this shape by",
                                                    "", share, demanded});
}
