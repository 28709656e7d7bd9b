/* SPDX-License-Identifier: BSD-3-Clause
 * The section through a contact: how far the surfaces have come closer at each distance from the axis. */
#include <math.h>

#include "core/same_bits.h"
#include "nanotouch/advanced/view.h"
#include "scene/parts.h"

double nt_view_tip_share(const nt_scene *scene)
{
    const double tip = (1.0 - scene->tip.poisson_ratio * scene->tip.poisson_ratio) / scene->tip.youngs_modulus;
    const double sample =
        (1.0 - scene->sample.poisson_ratio * scene->sample.poisson_ratio) / scene->sample.youngs_modulus;
    return tip / (tip + sample);
}

/* --- Which contact it is --- */

static int is_attached(const nt_plan *plan, const nt_place *place, const nt_view_pose *pose)
{
    const nt_interaction_state apart = {0, 0.0, 0.0}, held = {1, 0.0, 0.0};
    if (pose->gap <= nt_plan_capture_gap(plan, place) || pose->gap <= 0.0)
        return 1;
    if (!nt_plan_is_attached(plan, 1, place, pose->gap))
        return 0;
    const double free = nt_interaction_eval_gap(plan, &apart, place, pose->gap).F;
    const double bound = nt_interaction_eval_gap(plan, &held, place, pose->gap).F;
    return fabs(pose->force - bound) < fabs(pose->force - free);
}

/* Maugis: delta = a^2/R - 2 sigma0/E* sqrt(c^2 - a^2); without contact the zone alone pulls, F = -pi c^2 sigma0. */
static double cohesive_radius(const nt_view_contact *contact, double force)
{
    const double a = contact->contact_radius, stress = contact->cohesive_stress;
    if (!(stress > 0.0) || !isfinite(stress))
        return a;
    if (a == 0.0)
        return sqrt(fmax(-force, 0.0) / (NT_PI * stress));
    const double width = (a * a / contact->radius - contact->indentation) * contact->modulus / (2.0 * stress);
    return hypotenuse(a, fmax(width, 0.0));
}

/* The sum of all forces as Hertz' would deform the bodies; what pulls deforms nothing that is drawn. */
static nt_view_contact deformed(const nt_plan *plan, nt_view_contact contact, double force)
{
    contact.indentation = force > 0.0 ? nt_shape_indentation(&plan->shape, contact.modulus, force) : 0.0;
    contact.contact_radius = nt_shape_eval(&plan->shape, contact.modulus, contact.indentation).a;
    contact.cohesive_radius = contact.contact_radius;
    contact.attached = contact.gap <= 0.0;
    return contact;
}

nt_view_contact nt_view_contact_at(const nt_plan *plan, const nt_place *place, const nt_view_pose *pose)
{
    const nt_form form = plan->terms[NT_PLAN_CONTACT].form;
    nt_view_contact contact = {.shape = plan->shape,
                               .radius = nt_plan_follows(plan) && place ? place->radius.radius : plan->contact.radius,
                               .modulus = plan->contact.effective_modulus,
                               .gap = pose->gap,
                               .indentation = -pose->gap,
                               .cohesive_stress = nt_form_is_maugis(form) ? plan->contact.cohesive_stress : 0.0,
                               .tip_share = pose->tip_share};
    if (nt_plan_follows(plan))
        contact.shape.radius = contact.radius;
    if (plan->deformation.count > 0)
        return deformed(plan, contact, pose->force);
    contact.attached = is_attached(plan, place, pose);
    if (!contact.attached)
        return contact;
    const nt_law_value law = nt_plan_contact_at(plan, place, pose->gap).law;
    contact.contact_radius = law.a;
    contact.cohesive_radius = cohesive_radius(&contact, law.F);
    return contact;
}

/* --- The shape of the tip: a cap of curvature 1/R up to r = b, a flank of a slope beyond --- */

typedef struct outline {
    double cap;   /* curvature of the cap, 0: flat or none [1/m] */
    double edge;  /* b, where the flank begins; infinite: nowhere [m] */
    double slope; /* of the flank [-] */
} outline;

static outline outline_of(const nt_shape *shape)
{
    const double slope = 1.0 / tan(nt_pyramid_equivalent_angle(shape->sides, shape->half_angle));
    switch (shape->kind) {
    case NT_SHAPE_CONE:
        return (outline){0.0, 0.0, slope};
    case NT_SHAPE_PUNCH:
        return (outline){0.0, INFINITY, 0.0};
    case NT_SHAPE_BLUNTED:
        return (outline){1.0 / shape->radius, shape->transition > 0.0 ? shape->transition : shape->radius * slope,
                         slope};
    case NT_SHAPE_TRUNCATED:
        return (outline){0.0, shape->radius, slope};
    case NT_SHAPE_PARABOLOID:
    case NT_SHAPE_SPHERE:
        break;
    }
    return (outline){1.0 / shape->radius, INFINITY, 0.0};
}

/* f(r), infinite beyond the wall of a punch and the equator of a sphere [m] */
static double height_of(const nt_shape *shape, double r)
{
    const outline tip = outline_of(shape);
    const double R = shape->radius;
    if ((shape->kind == NT_SHAPE_SPHERE || shape->kind == NT_SHAPE_PUNCH) && r > R)
        return INFINITY;
    if (shape->kind == NT_SHAPE_SPHERE)
        return R - sqrt(R * R - r * r);
    if (r <= tip.edge)
        return 0.5 * tip.cap * r * r;
    return 0.5 * tip.cap * tip.edge * tip.edge + tip.slope * (r - tip.edge);
}

/* t Int_0^t f'(s)/sqrt(t^2 - s^2) ds [m] */
static double sunk(const nt_shape *shape, double t)
{
    const outline tip = outline_of(shape);
    if (shape->kind == NT_SHAPE_SPHERE)
        return t < shape->radius ? t * atanh(t / shape->radius) : (double)INFINITY;
    if (t <= tip.edge)
        return tip.cap * t * t;
    return t * (tip.cap * (t - sqrt(t * t - tip.edge * tip.edge)) + tip.slope * acos(tip.edge / t));
}

/* --- How far the surfaces come closer --- */

/* Gauss-Legendre, of 16 points on -1 .. 1; the other half is the mirror image. */
static const double node[8] = {0.0950125098376374, 0.2816035507792589, 0.4580167776572274, 0.6178762444026438,
                               0.7554044083550030, 0.8656312023878318, 0.9445750230732326, 0.9894009349916499};
static const double weight[8] = {0.1894506104550685, 0.1826034150449236, 0.1691565193950025, 0.1495959888165767,
                                 0.1246289712555339, 0.0951585116824928, 0.0622535239386479, 0.0271524594117541};

typedef double integrand(const nt_view_contact *contact, double r, double angle);

static double integrate(integrand *f, const nt_view_contact *contact, double r, const double limits[2])
{
    const double half = 0.5 * (limits[1] - limits[0]), middle = 0.5 * (limits[1] + limits[0]);
    double sum = 0.0;
    for (int i = 0; i < 8; ++i)
        sum += weight[i] * (f(contact, r, middle + half * node[i]) + f(contact, r, middle - half * node[i]));
    return half * sum;
}

/* theta(t)/sqrt(r^2 - t^2) dt with t = r sin(angle) */
static double of_contact(const nt_view_contact *contact, double r, double angle)
{
    return contact->indentation - sunk(&contact->shape, r * sin(angle));
}

/* sqrt(c^2 - t^2)/sqrt(r^2 - t^2) dt, inside the zone with t = r sin(angle), outside with t = c sin(angle) */
static double of_zone_inside(const nt_view_contact *contact, double r, double angle)
{
    const double t = r * sin(angle), c = contact->cohesive_radius;
    return sqrt(fmax(c * c - t * t, 0.0));
}

static double of_zone_outside(const nt_view_contact *contact, double r, double angle)
{
    const double c = contact->cohesive_radius, t = c * sin(angle), along = c * cos(angle);
    return along * along / sqrt(r * r - t * t);
}

static double closer_by(const nt_view_contact *contact, double r)
{
    const double a = contact->contact_radius, c = contact->cohesive_radius;
    double u = 0.0;
    if (a > 0.0) {
        const double limits[2] = {0.0, asin(fmin(a / r, 1.0))};
        u = integrate(of_contact, contact, r, limits);
    }
    if (c > a) {
        const double outer = fmin(r, c), limits[2] = {asin(fmin(a / outer, 1.0)), 0.5 * NT_PI};
        u -= 2.0 * contact->cohesive_stress / contact->modulus *
             integrate(r <= c ? of_zone_inside : of_zone_outside, contact, r, limits);
    }
    return 2.0 / NT_PI * u;
}

void nt_view_section(const nt_view_contact *contact, const double r[], nt_view_profile profiles[], long count)
{
    const double a = contact->contact_radius, depth = contact->indentation;
    for (long i = 0; i < count; ++i) {
        const double f = height_of(&contact->shape, r[i]);
        const int loaded = a > 0.0 && r[i] <= a;
        const double u = loaded ? depth - f : closer_by(contact, fmax(r[i], 1e-15));
        const nt_view_profile profile = {.tip = f + contact->gap + contact->tip_share * u,
                                         .sample = -(1.0 - contact->tip_share) * u,
                                         .rigid_tip = f + contact->gap};
        profiles[i] = profile;
        if (loaded && depth == -contact->gap) /* they touch: one surface, to the last bit */
            profiles[i].tip = profile.sample;
    }
}
