/* SPDX-License-Identifier: BSD-3-Clause
 * What holds a tip sideways, at most: friction of the places of a plan, slope and curvature of a surface. */
#include <math.h>

#include "core/same_bits.h"
#include "internal/hazard.h"
#include "nanotouch/margins.h"
#include "nanotouch/plan.h"
#include "scene/interaction.h"
#include "scene/parts.h"
#include "session/grip.h"
#include "session/well.h"
#include "surface/extremes.h"

#define CLOSE 1.002      /* of a push: no closer is looked */
#define CLOSE_RATIO 0.01 /* of a ratio of radii, which is 0.1 or more at each pixel */

enum { STEPS = 64, RADII = 9 };

/* A place of the sharpest or the bluntest contact, on the softest or the hardest sample. */
static nt_place corner(const nt_plan *plan, int blunt, int hard)
{
    nt_place place = {.radius = {.radius = blunt ? plan->most.radius : plan->least.radius}};
    if (!plan->properties)
        return place;
    const nt_surface *moduli = &plan->properties->youngs_modulus;
    place.youngs_modulus.value = hard ? moduli->height_maximum : moduli->height_minimum;
    place.work_of_adhesion.value = plan->properties->work_of_adhesion.height_maximum;
    return place;
}

static double limit_at(const nt_plan *plan, const nt_place *place, double gap)
{
    const nt_interaction_state attached = {.attached = 1};
    const nt_friction_contact contact = nt_interaction_friction_contact(plan, &attached, place, gap);
    return nt_friction_limit(&plan->friction.law, &contact);
}

double nt_grip_friction(const nt_plan *plan, double load)
{
    double most = 0.0;
    for (int i = 0; i < 4; ++i) {
        const nt_well well = {.plan = plan, .place = corner(plan, i & 1, i >> 1)};
        most = fmax(most, limit_at(plan, &well.place, nt_well_gap_of_force(&well, load, 0.0)));
    }
    return most;
}

static double stiffest_shear(const nt_plan *plan)
{
    const nt_plan_friction *friction = &plan->friction;
    if (!plan->properties || !(plan->properties->youngs_modulus.height_maximum > 0.0))
        return friction->law.effective_shear_modulus;
    return 1.0 / (friction->tip_compliance + friction->sample_factor / plan->properties->youngs_modulus.height_maximum);
}

/* From no load to the largest one: below, adhesion holds the tip by a bounded distance only. */
static void add_friction(nt_sideways_contact *found, const nt_plan *plan, double load)
{
    nt_friction law = plan->friction.law;
    law.effective_shear_modulus = stiffest_shear(plan);
    const nt_interaction_state attached = {.attached = 1};
    for (int i = 0; i < 4; ++i) {
        const nt_well well = {.plan = plan, .place = corner(plan, i & 1, i >> 1)};
        const double shallow = nt_well_gap_of_force(&well, 0.0, 0.0), deep = nt_well_gap_of_force(&well, load, 0.0);
        const double step = (shallow - deep) / STEPS;
        for (int k = 0; k < STEPS && step > 0.0; ++k) {
            const double above = shallow - k * step, below = above - step;
            const double rise = limit_at(plan, &well.place, below) - limit_at(plan, &well.place, above);
            found->grip = fmax(found->grip, rise / step);
        }
        const double radius = nt_interaction_eval_gap(plan, &attached, &well.place, deep).a;
        found->stick = fmax(found->stick, nt_friction_stiffness(&law, radius));
    }
}

/* First derivatives of a cubic spline are means of first differences of its coefficients: their largest sizes. */
static double gradient_of(const nt_surface *surface)
{
    const long nx = surface->nx, ny = surface->ny;
    double x = 0.0, y = 0.0;
    for (long j = 0; surface->coefficients && j < ny; ++j)
        for (long i = 0; i < nx; ++i) {
            const double *c = surface->coefficients + j * nx + i;
            x = i + 1 < nx ? fmax(x, fabs(c[1] - c[0])) : x;
            y = j + 1 < ny ? fmax(y, fabs(c[nx] - c[0])) : y;
        }
    return x > 0.0 || y > 0.0 ? hypotenuse(x / surface->dx, y / surface->dy) : 0.0;
}

/* What changes from place to place beside the height. */
enum { RADIUS, MODULUS, WORK, CHANGES };

/* |dU/dp| at a place, at most, from where it lets go to where a load presses it. */
static double worth_of(const nt_plan *plan, const nt_place *place, int what, double load)
{
    const nt_interaction_state attached = {.attached = 1};
    const nt_well well = {.plan = plan, .place = *place};
    const double deep = nt_well_gap_of_force(&well, load, 0.0), release = nt_plan_release_gap(plan, place);
    const double last = isfinite(release) ? fmax(release, 0.0) : 0.0;
    nt_place changes = *place;
    double *const steps[CHANGES] = {&changes.radius.dx, &changes.youngs_modulus.dx, &changes.work_of_adhesion.dx};
    double most = 0.0, sides[2];
    *steps[what] = 1.0;
    for (int k = 0; k <= STEPS; ++k) {
        nt_plan_sides(plan, &attached, &changes, deep + k * (last - deep) / STEPS, 0.0, sides);
        most = fmax(most, fabs(sides[0]));
    }
    return most;
}

static double worth_at_corners(const nt_plan *plan, int what, double load)
{
    double most = 0.0;
    for (int i = 0; i < 4; ++i) {
        const nt_place place = corner(plan, i & 1, i >> 1);
        most = fmax(most, worth_of(plan, &place, what, load));
    }
    return most;
}

/* |dU/dR| at some radii from the sharpest to the bluntest, on the softest or the hardest sample. */
typedef struct worths {
    double sharpest, blunter; /* radius [m], and the ratio from one to the next [-] */
    double of[RADII];         /* [J/m] */
} worths;

static worths worths_of(const nt_plan *plan, double load)
{
    const double sharpest = plan->least.radius, ratio = fmax(plan->most.radius / sharpest, 1.0 + 1e-9);
    worths found = {.sharpest = sharpest, .blunter = pow(ratio, 1.0 / (RADII - 1))};
    for (int k = 0; k < RADII; ++k)
        for (int hard = 0; hard < 2; ++hard) {
            nt_place place = corner(plan, 0, hard);
            place.radius.radius = sharpest * pow(found.blunter, k);
            found.of[k] = fmax(found.of[k], worth_of(plan, &place, RADIUS, load));
        }
    return found;
}

/* Of all radii from one on: the largest of those that are tabled, the one below it, too. */
static double worth_from(const worths *of, double radius)
{
    const double place = log(radius / of->sharpest) / log(of->blunter);
    double most = 0.0;
    for (int k = place > 1.0 ? (int)fmin(place, RADII - 1.0) : 0; k < RADII; ++k)
        most = fmax(most, of->of[k]);
    return most;
}

/* The least radius in a cell: no spline is below the coefficients that reach it [m]. */
static double least_radius_in(const nt_plan *plan, long i, long j)
{
    const nt_surface *s = &plan->followed->ratio;
    double least = HUGE_VAL;
    for (long q = j > 0 ? j - 1 : 0; q <= j + 2 && q < s->ny; ++q)
        for (long p = i > 0 ? i - 1 : 0; p <= i + 2 && p < s->nx; ++p)
            least = fmin(least, s->coefficients[q * s->nx + p]);
    return least * plan->contact.radius;
}

/* Cell by cell; a value of each first, so that few need a close look. */
static double uneven_radii(const nt_plan *plan, double load)
{
    const nt_surface *s = &plan->followed->ratio;
    const worths worth = worths_of(plan, load);
    const double R = plan->contact.radius;
    double most = 0.0;
    for (long j = 0; j + 1 < s->ny; ++j)
        for (long i = 0; i + 1 < s->nx; ++i) {
            const nt_height_value at = nt_surface_height(s, ((double)i + 0.5) * s->dx, ((double)j + 0.5) * s->dy);
            most = fmax(most, hypotenuse(at.zx, at.zy) * R * worth_from(&worth, at.z * R));
        }
    for (long j = 0; j + 1 < s->ny; ++j)
        for (long i = 0; i + 1 < s->nx; ++i) {
            double pushes = R * worth_from(&worth, least_radius_in(plan, i, j));
            if (!(pushes > 0.0 && pushes * nt_extremes_in_cell(s, i, j, most / pushes) > CLOSE * most))
                continue;
            pushes = R * worth_from(&worth, R * nt_extremes_lowest_in_cell(s, i, j, CLOSE_RATIO));
            if (pushes > 0.0)
                most = fmax(most, pushes * nt_extremes_in_cell(s, i, j, most / pushes));
        }
    return CLOSE * most;
}

/* Where a tip stands. */
static double uneven_radius_at(const nt_plan *plan, double load, const double place[2])
{
    const nt_height_value at = nt_surface_height(&plan->followed->ratio, place[0], place[1]);
    const worths worth = worths_of(plan, load);
    const double R = plan->contact.radius;
    return hypotenuse(at.zx, at.zy) * R * worth_from(&worth, at.z * R);
}

static double slope_of(const nt_surface *surface, const double *place)
{
    if (!place)
        return gradient_of(surface);
    const nt_height_value at = nt_surface_height(surface, place[0], place[1]);
    return hypotenuse(at.zx, at.zy);
}

double nt_grip_uneven(const nt_plan *plan, double load, const double *place)
{
    const nt_properties *of = plan->properties;
    double sum = 0.0;
    if (!nt_plan_follows(plan))
        return 0.0;
    if (plan->followed && plan->followed->ratio.coefficients)
        sum += place ? uneven_radius_at(plan, load, place) : uneven_radii(plan, load);
    if (of && of->youngs_modulus.coefficients)
        sum += slope_of(&of->youngs_modulus, place) * worth_at_corners(plan, MODULUS, load);
    if (of && of->work_of_adhesion.coefficients)
        sum += slope_of(&of->work_of_adhesion, place) * worth_at_corners(plan, WORK, load);
    return sum;
}

/* Second derivatives of a cubic spline are means of second differences of its coefficients: their largest sizes. */
static double curvature_of(const nt_surface *surface)
{
    const long nx = surface->nx, ny = surface->ny;
    double xx = 0.0, yy = 0.0, xy = 0.0;
    for (long j = 0; j < ny; ++j)
        for (long i = 0; i < nx; ++i) {
            const double *c = surface->coefficients + j * nx + i;
            const long right = i + 1 < nx ? 1 : -1, up = j + 1 < ny ? nx : -nx; /* mirrored at the borders */
            const long left = i > 0 ? -1 : 1, down = j > 0 ? -nx : nx;
            xx = fmax(xx, fabs(c[left] - 2.0 * c[0] + c[right]));
            yy = fmax(yy, fabs(c[down] - 2.0 * c[0] + c[up]));
            xy = fmax(xy, fabs(c[0] - c[right] - c[up] + c[right + up]));
        }
    const double dx = surface->dx, dy = surface->dy;
    return hypotenuse(hypotenuse(xx / (dx * dx), yy / (dy * dy)), sqrt(2.0) * xy / (dx * dy));
}

nt_sideways_contact nt_grip_of(const nt_plan *plan, double slope, double load)
{
    nt_sideways_contact found = {.slope = slope, .load = load};
    if (plan->friction.term.form != NT_FORM_OFF)
        add_friction(&found, plan, load);
    if (plan->surface && plan->surface->coefficients)
        found.curvature = curvature_of(plan->surface);
    return found;
}
