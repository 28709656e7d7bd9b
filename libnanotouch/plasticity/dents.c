/* SPDX-License-Identifier: BSD-3-Clause
 * Dents of a sample while it is touched: see advanced/plasticity.h.
 *
 * With s the share that is ploughed a contact carries c = 1 - s/2 of what it would at rest, F = c F_0(delta). A way ds
 * of the tip takes ds/a of what is left, up to the share of the depth that is plastic. At a given load c F_0 = P: in
 * full plasticity F_0 = 2 P, a^2 = 2 P/(pi H), the groove of a ploughing tip. Stored energy and heat of the law at rest
 * count with c, so that a way in depth has stored + dissipated = work; as c falls, U falls at the same depth: heat. */
#include "nanotouch/advanced/plasticity.h"

#include <math.h>

#include "core/same_bits.h"
#include "nanotouch/material.h"
#include "plasticity/dents.h"

#define GROWN 1e-3  /* a dent is another one if it is so much wider */
#define GROOVE 0.25 /* a groove is longer than this many of its radii */

/* --- the list --- */

static double away(const nt_imprint *of, double x, double y)
{
    const double wx = of->end[0] - of->start[0], wy = of->end[1] - of->start[1];
    const double px = x - of->start[0], py = y - of->start[1], length2 = wx * wx + wy * wy;
    const double t = length2 > 0.0 ? fmin(fmax((px * wx + py * wy) / length2, 0.0), 1.0) : 0.0;
    return hypotenuse(px - t * wx, py - t * wy);
}

/* Of the apex in a paraboloid of the radius of curvature C = a^2/(2 depth) > R: at the distance s from its middle it
 * touches at s C/(C - R), or, beyond the rim, the rim itself. */
static double lowered_by(const nt_indentation *indentation, const nt_imprint *of, double s)
{
    const double R = indentation->radius, a = of->radius;
    if (!(s < a) || !(of->depth > 0.0))
        return 0.0;
    const double C = 0.5 * a * a / of->depth;
    if (s * C <= a * (C - R))
        return of->depth - 0.5 * s * s / (C - R);
    return 0.5 * (a - s) * (a - s) / R;
}

/* The dent that lowers most; the newest of those alike. -1: none. */
static int deepest_at(const nt_indentation *indentation, const nt_dents *dents, double x, double y, double *lowered)
{
    int found = -1;
    *lowered = 0.0;
    for (int i = dents->count - 1; i >= 0; --i) {
        const nt_imprint *of = &dents->made[i].imprint;
        const double by = lowered_by(indentation, of, away(of, x, y));
        if (by > *lowered) {
            *lowered = by;
            found = i;
        }
    }
    return found;
}

double nt_dents_lowered(const nt_indentation *indentation, const nt_dents *dents, double x, double y)
{
    double lowered;
    (void)deepest_at(indentation, dents, x, y, &lowered);
    return lowered;
}

int nt_dents_undo(nt_dents *dents)
{
    if (dents->touches || dents->count == 0)
        return 0;
    --dents->count;
    dents->full = 0;
    if (dents->inside >= dents->count) { /* the tip is over it: nothing is known here until it is placed anew */
        dents->inside = -1;
        dents->began = dents->bottom = 0.0;
        dents->contact = (nt_indentation_state){.dent_radius = 0.0};
    }
    return 1;
}

/* --- one contact --- */

static double carried(const nt_dents *dents)
{
    return 1.0 - 0.5 * dents->ploughed;
}

/* From a dent, deeper than where it lets go, and back to it: Hertz' contact with the radius R'. */
static nt_law_value in_dent(const nt_indentation *indentation, const nt_first_loading *dent, double pressed)
{
    const double deep = pressed > 0.0 ? pressed : 0.0, a = sqrt(dent->effective_radius * deep);
    const double E = indentation->effective_modulus, F = 4.0 / 3.0 * E * a * deep;
    return (nt_law_value){.U = 0.4 * F * deep, .F = F, .k = 2.0 * E * a, .a = a};
}

/* At rest, by the depth from where nothing had yielded. U with the heat of this dent. */
static nt_law_value at_rest(const nt_indentation *indentation, double dent_radius, double depth)
{
    const nt_first_loading dent = nt_indentation_first(indentation, dent_radius);
    if (!(depth > dent.indentation)) {
        nt_law_value law = in_dent(indentation, &dent, depth - dent.residual_depth);
        law.U += dent.dissipated;
        return law;
    }
    const nt_first_loading now = nt_indentation_first(indentation, nt_indentation_radius_at_depth(indentation, depth));
    return (nt_law_value){
        .U = now.stored + now.dissipated, .F = now.force, .k = now.stiffness, .a = now.contact_radius};
}

nt_law_value nt_dents_eval(const nt_indentation *indentation, const nt_dents *dents, double gap)
{
    if (isnan(gap))
        return (nt_law_value){gap, gap, gap, gap};
    const double c = carried(dents);
    nt_law_value law = at_rest(indentation, dents->contact.dent_radius, dents->bottom - gap);
    law.U *= c;
    law.F *= c;
    law.k *= c;
    return law;
}

void nt_dents_advance(const nt_indentation *indentation, nt_dents *dents, double gap)
{
    if (isnan(gap))
        return;
    nt_indentation_state *contact = &dents->contact;
    const double depth = dents->bottom - gap, c = carried(dents);
    const nt_first_loading before = nt_indentation_first(indentation, contact->dent_radius);
    const nt_law_value law = at_rest(indentation, contact->dent_radius, depth);
    double heat = before.dissipated;
    if (depth > before.indentation) {
        const nt_first_loading now = nt_indentation_first(indentation, law.a);
        if (now.residual_depth > 0.0) {
            contact->dent_radius = law.a;
            heat = now.dissipated;
            dents->pressed[0] = dents->at[0];
            dents->pressed[1] = dents->at[1];
        }
    }
    if (heat > before.dissipated)
        dents->dissipated += c * (heat - before.dissipated);
    contact->indentation = depth;
    contact->force = c * law.F;
    contact->contact_radius = law.a;
    contact->stored = c * (law.U - heat);
    contact->dissipated = heat;
    dents->touches = law.F > 0.0;
}

/* The plastic share of the depth: as much of the rear half does not come back. */
static double plastic_share(const nt_indentation *indentation, const nt_dents *dents)
{
    const double load = dents->contact.force / carried(dents);
    const nt_first_loading at_load =
        nt_indentation_first(indentation, nt_indentation_radius_at_load(indentation, load));
    return at_load.indentation > 0.0 ? at_load.residual_depth / at_load.indentation : 0.0;
}

void nt_dents_slide(const nt_indentation *indentation, nt_dents *dents, double x, double y)
{
    nt_indentation_state *contact = &dents->contact;
    const double way = hypotenuse(x - dents->at[0], y - dents->at[1]);
    dents->at[0] = x;
    dents->at[1] = y;
    if (!dents->touches || !(way > 0.0))
        return;
    dents->slid = fmax(dents->slid, contact->force / carried(dents));
    const double share = plastic_share(indentation, dents), before = carried(dents);
    if (!(share > dents->ploughed))
        return;
    dents->ploughed += (share - dents->ploughed) * -expm1(-way / contact->contact_radius);
    const double left = carried(dents) / before;
    dents->dissipated += (1.0 - left) * contact->stored;
    contact->force *= left;
    contact->stored *= left;
}

double nt_dents_ploughing(const nt_indentation *indentation, const nt_dents *dents)
{
    const double a = dents->contact.contact_radius;
    if (!dents->touches || !(a > 0.0))
        return 0.0;
    const double mean = dents->contact.force / (carried(dents) * NT_PI * a * a);
    return dents->ploughed * mean * 2.0 / 3.0 * a * a * a / indentation->radius;
}

/* --- what a contact leaves --- */

/* Where a contact has been. */
typedef struct trace {
    const double *from, *to;
    double radius;
    int before; /* the dent that has grown; -1: none */
} trace;

/* In the list: at its end, or, where it has grown from the last one there, in the place of that. */

static int keep(const nt_indentation *indentation, nt_dents *dents, const trace *of)
{
    const nt_first_loading made = nt_indentation_first(indentation, of->radius);
    const nt_imprint imprint = {{of->from[0], of->from[1]}, {of->to[0], of->to[1]}, of->radius, made.residual_depth};
    if (of->before >= 0 && of->before == dents->count - 1) {
        nt_dent *last = &dents->made[of->before];
        *last = (nt_dent){imprint, made.force, last->before, last->grown + 1};
        return 1;
    }
    if (dents->count == NT_DENTS) {
        dents->full = 1;
        return 0;
    }
    dents->made[dents->count++] = (nt_dent){imprint, made.force, of->before, 0};
    return 1;
}

/* A groove as wide as the largest load while it slid, and a dent that is wider than that and than what was there. */
static int leave(const nt_indentation *indentation, nt_dents *dents)
{
    const double length = hypotenuse(dents->at[0] - dents->start[0], dents->at[1] - dents->start[1]);
    double groove = dents->slid > 0.0 ? nt_indentation_radius_at_load(indentation, dents->slid) : 0.0;
    const int ploughs = dents->ploughed > 0.0 && length > GROOVE * groove &&
                        nt_indentation_first(indentation, groove).residual_depth > 0.0;
    groove = ploughs ? groove : 0.0;
    int left = 0;
    if (ploughs)
        left += keep(indentation, dents, &(trace){dents->start, dents->at, groove, -1});
    if (dents->contact.dent_radius > (1.0 + GROWN) * fmax(dents->began, groove)) {
        const nt_imprint *old = dents->inside < 0 ? NULL : &dents->made[dents->inside].imprint;
        const int grows = old && !ploughs && old->start[0] == old->end[0] && old->start[1] == old->end[1];
        const double *middle = grows ? old->start : dents->pressed;
        const trace dent = {middle, middle, dents->contact.dent_radius, grows ? dents->inside : -1};
        left += keep(indentation, dents, &dent);
    }
    return left;
}

int nt_dents_place(const nt_indentation *indentation, nt_dents *dents, double x, double y)
{
    if (dents->touches)
        return 0;
    const int left = leave(indentation, dents);
    double lowered;
    const int there = deepest_at(indentation, dents, x, y, &lowered);
    const double known = there < 0 ? 0.0 : dents->made[there].imprint.radius;
    const double grown = left == 0 && there >= 0 && there == dents->inside ? dents->contact.dent_radius : 0.0;
    dents->inside = there;
    dents->began = known;
    dents->contact =
        (nt_indentation_state){.dent_radius = fmax(known, grown)}; /* what is too little to be kept adds up */
    dents->bottom = nt_indentation_first(indentation, known).residual_depth;
    dents->contact.dissipated = nt_indentation_first(indentation, dents->contact.dent_radius).dissipated;
    dents->start[0] = dents->at[0] = dents->pressed[0] = x;
    dents->start[1] = dents->at[1] = dents->pressed[1] = y;
    dents->ploughed = dents->slid = 0.0;
    return left;
}
