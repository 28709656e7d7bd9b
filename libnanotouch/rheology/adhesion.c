/* SPDX-License-Identifier: BSD-3-Clause
 * JKR's contact in terms of indentation and contact radius (Maugis 2000, Sec. 4.2):
 *   F = 2 E* (delta a - a^3/(3 R)),   G = E* (a^2/R - delta)^2/(2 pi a),
 * G the energy release rate of the edge. The edge moves so that G = w_eff(v): v is the only rate, a the only state. A
 * step takes the edge's speed at its end (implicit Euler), for the equation is stiff where the edge rests. */
#include <math.h>
#include <stddef.h>

#include "core/problem.h"
#include "core/roots.h"
#include "core/same_bits.h"
#include "internal/field.h"
#include "nanotouch/rheology.h"
#include "rheology/crack.h"
#include "rheology/run.h"

#define PI 3.14159265358979323846
#define STEP 0.01 /* of the contact radius, at most, in one step */
#define WAY 0.005 /* of JKR's depth without load, at most, that the base moves in one step */
#define MOST_STEPS                                                                                                     \
    20000.0       /* between two points: 100 such depths; beyond, the points are too far apart to show a contact */
#define REST 60.0 /* in ln of the speed, below one step in the time left: the edge does not move */
#define SEED 1e-3 /* of JKR's radius without load: where a contact begins, and where it is lost */
#define ZONE 0.1  /* of that radius, at most, is the process zone */
#define MAX_BULK 0.05

typedef struct edge {
    nt_crack crack;
    double modulus, radius, work, stiffness; /* E* [Pa], R [m], w [J/m^2], k_c [N/m]; 0: rigid */
    double equilibrium_modulus;              /* E_inf [Pa] */
    double rest;                             /* contact radius without load [m] */
    double base, a;                          /* where base and edge are [m] */
    double dissipated;                       /* [J] */
} edge;

static const nt_field fields[] = {
    NT_FIELD(nt_viscoelastic_adhesion, work_of_adhesion, "J/m^2", 1e-9, 100.0, "w of an edge at rest"),
    NT_FIELD(nt_viscoelastic_adhesion, crack_length, "m", 1e-12, 1e-3, "a_0 of its process zone"),
};

static double indentation_at(const edge *of, double a)
{
    if (of->stiffness == 0.0)
        return of->base;
    const double pull = 2.0 * of->modulus * a * a * a / (3.0 * of->radius);
    return (of->stiffness * of->base + pull) / (of->stiffness + 2.0 * of->modulus * a);
}

static double force_at(const edge *of, double a)
{
    return 2.0 * of->modulus * a * (indentation_at(of, a) - a * a / (3.0 * of->radius));
}

/* G/w; below 0 where the edge is pressed shut. */
static double release_at(const edge *of, double a)
{
    const double gap = a * a / of->radius - indentation_at(of, a);
    return of->modulus * gap * fabs(gap) / (2.0 * PI * a * of->work);
}

/* Energy of sample, lever and surfaces, over that of a free tip [J]. */
static double stored_at(const edge *of, double a)
{
    const double R = of->radius, delta = indentation_at(of, a), force = force_at(of, a);
    const double elastic = of->modulus * a * (delta * delta - a * a / R * (2.0 / 3.0 * delta - a * a / (5.0 * R)));
    const double lever = of->stiffness > 0.0 ? 0.5 * force * force / of->stiffness : 0.0;
    return elastic + lever - PI * of->work * a * a;
}

/* What w_eff/w, or its inverse for an edge that closes, must be for the edge to move at all: > 1. */
static double drive_at(const edge *of, double a, int opens)
{
    const double release = release_at(of, a);
    return opens ? release : release > 0.0 ? 1.0 / release : (double)INFINITY;
}

/* The edge goes to a: what is lost there, by Simpson's rule. */
static void move(edge *of, double a)
{
    const double from = of->a, middle = 0.5 * (from + a);
    const double ends = (release_at(of, from) - 1.0) * from + (release_at(of, a) - 1.0) * a;
    of->dissipated += (from - a) / 6.0 * 2.0 * PI * of->work * (ends + 4.0 * (release_at(of, middle) - 1.0) * middle);
    of->a = a;
}

typedef struct step {
    const edge *of;
    double time; /* [s] */
    int opens;
} step;

/* Where an edge goes that crosses its process zone s times a second: drive over ratio, and the place. */
static double excess(double log_s, const void *context)
{
    const step *of = context;
    const double s = exp(log_s), ratio = nt_crack_ratio(&of->of->crack, s);
    const double far = of->of->crack.length * ratio * s * of->time;
    return drive_at(of->of, of->opens ? of->of->a - far : of->of->a + far, of->opens) - ratio;
}

static double speed_of(const nt_crack *crack, double ratio)
{
    return crack->length * ratio * nt_crack_crossings(crack, ratio);
}

/* In the time that is left the edge moves less than one step: where to. */
static nt_status settle(edge *of, double left, int opens)
{
    const step now = {of, left, opens};
    double bracket[2], log_s;
    nt_status status = nt_crack_log_crossings_at(&of->crack, STEP * of->a / left, &bracket[1]);
    bracket[0] = bracket[1] - REST;
    if (status != NT_OK || excess(bracket[0], &now) <= 0.0)
        return status; /* it rests */
    status = nt_root_find(excess, &now, bracket, &log_s, NULL);
    if (status != NT_OK)
        return status;
    const double s = exp(log_s), far = of->crack.length * nt_crack_ratio(&of->crack, s) * s * left;
    move(of, opens ? of->a - far : of->a + far);
    return NT_OK;
}

/* The base stands; the edge moves for a time. */
static nt_status creep(edge *of, double left)
{
    while (of->a > 0.0) {
        const int opens = release_at(of, of->a) > 1.0;
        const double next = of->a * (opens ? 1.0 - STEP : 1.0 + STEP);
        const double drive = drive_at(of, next, opens);
        if (drive >= of->crack.max_ratio) { /* no speed is high enough: it jumps */
            move(of, next);
        } else {
            const double speed = drive > 1.0 ? speed_of(&of->crack, drive) : 0.0;
            const double needs = fabs(next - of->a) / speed;
            if (!(needs <= left))
                return settle(of, left, opens);
            move(of, next);
            left -= needs;
        }
        if (opens && of->a < SEED * of->rest && indentation_at(of, 0.0) <= 0.0) {
            of->dissipated += stored_at(of, of->a); /* a soft lever still holds much there */
            of->a = 0.0;
        }
    }
    return NT_OK;
}

static nt_status advance(edge *of, double time, double base)
{
    const double from = of->base;
    if (of->a == 0.0 && base <= 0.0) {
        of->base = base;
        return NT_OK;
    }
    const double depth = of->rest * of->rest / (3.0 * of->radius);
    const int count = (int)fmin(ceil(1.0 + fabs(base - from) / (WAY * depth)), MOST_STEPS);
    nt_status status = NT_OK;
    for (int i = 1; i <= count && status == NT_OK; i++) {
        of->base = from + (base - from) * i / count;
        if (of->a == 0.0 && of->base > 0.0) {
            of->a = SEED * of->rest;
            of->dissipated -= stored_at(of, of->a);
        }
        status = creep(of, time / count);
    }
    return status;
}

static nt_status check(const nt_viscoelastic *contact, const nt_viscoelastic_adhesion *adhesion, nt_problem *problem)
{
    nt_status status = nt_viscoelastic_check(contact, problem);
    if (status == NT_OK)
        status = nt_field_check(fields, (int)(sizeof fields / sizeof fields[0]), adhesion, problem);
    if (status != NT_OK)
        return status;
    const nt_rheology *rheology = &contact->rheology;
    if (contact->shape.kind != NT_SHAPE_PARABOLOID)
        return nt_problem_set(problem, "shape.kind", "", contact->shape.kind, NT_SHAPE_PARABOLOID, NT_SHAPE_PARABOLOID);
    if (contact->thickness > 0.0)
        return nt_problem_set(problem, "thickness", "m", contact->thickness, 0.0, 0.0);
    if (rheology->kind != NT_RHEOLOGY_STANDARD_LINEAR_SOLID && rheology->kind != NT_RHEOLOGY_PRONY)
        return nt_problem_set(problem, "rheology.kind", "", rheology->kind, NT_RHEOLOGY_STANDARD_LINEAR_SOLID,
                              NT_RHEOLOGY_PRONY);
    if (!(rheology->equilibrium_modulus > 0.0))
        return nt_problem_set(problem, "rheology.equilibrium_modulus", "Pa", rheology->equilibrium_modulus, 1e-3,
                              (double)INFINITY);
    return NT_OK;
}

static nt_status begin(edge *of, const nt_viscoelastic *contact, const nt_viscoelastic_adhesion *adhesion,
                       nt_problem *problem)
{
    const double nu = contact->poisson_ratio;
    *of = (edge){.modulus = contact->rheology.equilibrium_modulus / (1.0 - nu * nu),
                 .equilibrium_modulus = contact->rheology.equilibrium_modulus,
                 .radius = contact->shape.radius,
                 .work = adhesion->work_of_adhesion,
                 .stiffness = contact->spring_constant};
    of->rest = cube_root(4.5 * PI * of->work * of->radius * of->radius / of->modulus);
    if (adhesion->crack_length > ZONE * of->rest)
        return nt_problem_set(problem, "crack_length", "m", adhesion->crack_length, 1e-12, ZONE * of->rest);
    return nt_crack_make(&contact->rheology, adhesion->crack_length, &of->crack);
}

/* What the history itself shows of how fast the bulk must relax. */
typedef struct pace {
    double fastest, widest, max_force; /* of the base in contact [m/s], of the contact [m], |F| [N] */
} pace;

static nt_status check_pace(const edge *of, const pace *seen, nt_viscoelastic_result *result, nt_problem *problem)
{
    const double viscosity = of->crack.viscosity * of->modulus / of->equilibrium_modulus; /* over 1 - nu^2 */
    const double excess_force = 2.0 * seen->widest * seen->fastest * viscosity;
    result->bulk_error = seen->max_force > 0.0 ? excess_force / seen->max_force : 0.0;
    if (result->bulk_error <= MAX_BULK)
        return NT_OK;
    return nt_problem_set(problem, "speed", "m/s", seen->fastest, 0.0, seen->fastest * MAX_BULK / result->bulk_error);
}

nt_status nt_viscoelastic_run_adhesive(const nt_viscoelastic *contact, const nt_viscoelastic_adhesion *adhesion,
                                       const nt_viscoelastic_path *path, nt_viscoelastic_result *result,
                                       nt_problem *problem)
{
    nt_time_range unused;
    edge of;
    pace seen = {0.0, 0.0, 0.0};
    nt_status status = check(contact, adhesion, problem);
    if (status == NT_OK)
        status = nt_viscoelastic_check_path(path, &unused, problem);
    if (status == NT_OK)
        status = begin(&of, contact, adhesion, problem);
    if (status != NT_OK)
        return status;
    of.base = path->positions[0] - path->contact;
    for (long i = 0; i < path->count; i++) {
        const double base = path->positions[i] - path->contact, past = of.base;
        if (i > 0)
            status = advance(&of, path->times[i] - path->times[i - 1], base);
        if (status != NT_OK)
            return status;
        const double force = force_at(&of, of.a);
        if (result->forces != NULL)
            result->forces[i] = force;
        if (result->indentations != NULL)
            result->indentations[i] = indentation_at(&of, of.a);
        if (of.a > 0.0 && i > 0)
            seen.fastest = fmax(seen.fastest, fabs(base - past) / (path->times[i] - path->times[i - 1]));
        seen.widest = fmax(seen.widest, of.a);
        seen.max_force = fmax(seen.max_force, fabs(force));
    }
    result->arms = of.crack.count;
    result->kernel_error = 0.0;
    result->by_springs = 0;
    result->dissipated = of.dissipated;
    return check_pace(&of, &seen, result, problem);
}
