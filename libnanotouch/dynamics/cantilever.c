/* SPDX-License-Identifier: BSD-3-Clause
 * Quasi-static cantilever (Eq. 2-3 at rest): the tip rests where spring and surface force balance,
 *     N(z) = F(z) - K (z - z_b) = 0,  K = k_c / cos(alpha),  from k_c zeta = F and z_t = z_b + zeta cos(alpha),
 * and the balance is stable where S = -dN/dz = K + k > 0. With its inertia neglected the tip follows the sign of N: it
 * comes to rest at the first stable equilibrium downhill from where it stands. That is jump-in, and snap-off.
 *
 * So this is not root finding but a walk: from the last position along the sign of N, in steps over which N is
 * resolved (its change agrees with the mean of its slopes), until N changes sign; there the root is enclosed and
 * polished. In a tick in which the base moves little the first step is Newton's and the walk is over. History (contact
 * branch, meniscus) is committed at each position the tip passes.
 *
 * Steps double up to LONGEST field lengths or 1/64 of the way to the base. A well that is narrower than the step and
 * without a precursor in N or S can be stepped over; among oscillating forces (liquid layers) that happened in 5 of
 * 640 000 random moves of up to 2 nm at once. The walk ends in a minimum of
 * U + K (z_t - z_b)^2 / 2; with a tilt it is this K, not k_c / cos^2(alpha), that k_c zeta = F implies. */
#include "internal/dynamics.h"
#include "nanotouch/dynamics.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

#include "core/clamp.h"

#define LONGEST 64.0    /* longest step of the walk, in field lengths */
#define SHORTEST 0.125  /* a jump of the force is crossed in a step of this many field lengths */
#define UNRESOLVED 0.05 /* mismatch of N over a step, relative to the N at its ends */
#define CLOSE 1e-7      /* Newton steps below this many field lengths are exact to about its square */
enum { EVALUATIONS_MAX = 400 };

typedef struct walk {
    const nt_force_field *field;
    double stiffness; /* K [N/m] */
    double base;      /* z_b [m] */
    double way;       /* +1 up, -1 down */
    int evaluations;
} walk;

/* The tip at z: the net force along the way and how fast it is used up. */
typedef struct place {
    double z;     /* [m] */
    double drive; /* way * N [N] */
    double slope; /* S [N/m] */
} place;

static inline place place_at(walk *w, double z)
{
    const nt_law_value value = w->field->eval(w->field->context, z);
    w->evaluations++;
    return (place){z, w->way * (value.F - w->stiffness * (z - w->base)), w->stiffness + value.k};
}

/* A slope of minus infinity is allowed: the end of JKR's branch at fixed displacement. */
static int place_is_finite(const place *p)
{
    return isfinite(p->drive) && p->slope < HUGE_VAL;
}

static void commit(const walk *w, double z)
{
    if (w->field->advance != NULL)
        w->field->advance(w->field->context, z);
}

/* Trapezoidal rule for the change of the drive between two places: does the step see all of the structure? */
static int is_resolved(const place *a, const place *b)
{
    const double expected = a->drive - 0.5 * (a->slope + b->slope) * fabs(b->z - a->z);
    return fabs(b->drive - expected) <= UNRESOLVED * (fabs(a->drive) + fabs(b->drive));
}

static int is_monotone(const place *a, const place *b)
{
    return a->slope > 0.0 && b->slope > 0.0;
}

/* Newton's distance along the way to the equilibrium; infinite where there is none ahead. */
static double newton_distance(const place *p)
{
    return p->slope > 0.0 ? p->drive / p->slope : HUGE_VAL;
}

/* One step of the walk, of at most *step: b becomes the next place, or one beyond the equilibrium. Shortens *step until
 * the force is resolved. */
static nt_status step_downhill(walk *w, const place *a, double *step, place *b)
{
    const double length = w->field->length;
    while (w->evaluations < EVALUATIONS_MAX) {
        const double reach = lesser(*step, newton_distance(a));
        *b = place_at(w, a->z + w->way * reach);
        if (!place_is_finite(b))
            return NT_E_NOT_FINITE;
        if (b->drive > 0.0 ? reach <= SHORTEST * length || is_resolved(a, b)
                           : reach <= length || (is_monotone(a, b) && is_resolved(a, b))) {
            *step = reach;
            return NT_OK;
        }
        *step = greater(0.25 * reach, SHORTEST * length);
    }
    return NT_E_NO_CONVERGENCE;
}

/* Newton within the bracket (drive > 0 at a, <= 0 at b), else bisection. Where the force jumps through 0 the tip
 * sticks at the jump: the bracket closes on it. *a becomes the equilibrium. */
static nt_status polish(walk *w, place *a, place b)
{
    place last = b;
    double size = fabs(b.z - a->z);
    while (w->evaluations < EVALUATIONS_MAX) {
        const double distance = newton_distance(&last);
        const double z = last.z + w->way * distance;
        if (fabs(distance) <= CLOSE * w->field->length || fabs(b.z - a->z) <= 2.0 * DBL_EPSILON * fabs(b.z)) {
            *a = last;
            return NT_OK;
        }
        const int inside = w->way * (z - a->z) > 0.0 && w->way * (b.z - z) > 0.0;
        const int quick = inside && fabs(distance) <= 0.5 * size;
        size = quick ? fabs(distance) : 0.5 * fabs(b.z - a->z);
        last = place_at(w, quick ? z : 0.5 * (a->z + b.z));
        if (!place_is_finite(&last))
            return NT_E_NOT_FINITE;
        if (last.drive > 0.0)
            *a = last;
        else
            b = last;
    }
    return NT_E_NO_CONVERGENCE;
}

/* From *a, the tip's last position, to the equilibrium; on failure *a is the last place the tip passed. */
static nt_status walk_downhill(walk *w, place *a)
{
    const double length = w->field->length;
    double step = 0.5 * length;
    while (!(newton_distance(a) <= CLOSE * length)) {
        place b;
        const nt_status status = step_downhill(w, a, &step, &b);
        if (status != NT_OK)
            return status;
        if (b.drive <= 0.0)
            return polish(w, a, b);
        commit(w, b.z);
        *a = b;
        step = lesser(2.0 * step, greater(LONGEST * length, fabs(w->base - a->z) / 64.0));
    }
    return NT_OK;
}

nt_cantilever_state nt_cantilever_at(double base_height)
{
    return (nt_cantilever_state){.deflection = 0.0, .tip_height = base_height};
}

nt_status nt_cantilever_settle(nt_cantilever_state *state, const nt_probe *probe, const nt_force_field *field,
                               double base_height, nt_solve_info *info)
{
    if (field->eval == NULL || !(field->length > 0.0) || !(probe->spring_constant > 0.0))
        return NT_E_ARGUMENT;
    const double cosine = probe->tilt != 0.0 ? cos(probe->tilt) : 1.0; /* most are level */
    walk w = {.field = field, .stiffness = probe->spring_constant / cosine, .base = base_height, .way = 1.0};
    place a = place_at(&w, state->tip_height);
    if (!place_is_finite(&a))
        return NT_E_NOT_FINITE;
    if (!(a.drive > 0.0)) {
        w.way = -1.0;
        a.drive = -a.drive;
    }

    const nt_status status = walk_downhill(&w, &a);
    const double rest = newton_distance(&a);
    if (status == NT_OK && fabs(rest) <= CLOSE * field->length)
        a.z += w.way * rest;
    commit(&w, a.z);
    state->tip_height = a.z;
    state->deflection = (a.z - base_height) / cosine;
    if (info != NULL)
        *info = (nt_solve_info){w.evaluations, fabs(a.drive) / (w.stiffness * field->length)};
    return status;
}
