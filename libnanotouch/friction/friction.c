/* SPDX-License-Identifier: BSD-3-Clause
 * A contact that sticks like a spring in the plane and slips on a circle: see friction.h.
 *
 * p is the pull of the hand on the contact (minus the force on the tip), K the stiffness, F the limit, n the direction
 * of the way. Stuck, dp/ds = K n. Slipping, p stays on the circle, dp/ds = K (n - (n.p) p/F^2): with t the angle
 * between p and n, dt/ds = -(K/F) sin t, so that tan(t/2) falls as exp(-K s/F). The slip is along p, its rate cos t,
 * and the heat is F times the integral of cos t ds. */
#include <math.h>
#include <stddef.h>

#include "core/same_bits.h"
#include "internal/field.h"
#include "internal/friction.h"
#include "nanotouch/friction.h"

#define FIELD(path, ...) NT_FIELD(nt_friction, path, __VA_ARGS__)

static const nt_field friction_fields[] = {
    FIELD(effective_shear_modulus, "Pa", 1.0, 1e13, "G* of tip and sample, 1/G* = sum of (2 - nu)/G"),
    FIELD(lateral_compliance, "m/N", 0.0, 1e6, "of tip and lever at the apex, 0 for rigid"),
    FIELD(shear_strength, "Pa", 0.0, 1e12, "tau0, friction per contact area without load"),
    FIELD(coefficient, "", 0.0, 100.0, "alpha, friction per load inside the contact"),
};

enum { FRICTION_FIELDS = (int)(sizeof friction_fields / sizeof friction_fields[0]) };

nt_friction nt_friction_defaults(void)
{
    const nt_material silicon = {.youngs_modulus = 135e9, .poisson_ratio = 0.35};
    return (nt_friction){.effective_shear_modulus = nt_effective_shear_modulus(silicon, silicon),
                         .shear_strength = 100e6,
                         .coefficient = 0.1};
}

const nt_field *nt_friction_fields(int *count)
{
    if (count != NULL)
        *count = FRICTION_FIELDS;
    return friction_fields;
}

nt_status nt_friction_check(const nt_friction *friction, nt_problem *problem)
{
    return nt_field_check(friction_fields, FRICTION_FIELDS, friction, problem);
}

double nt_effective_shear_modulus(nt_material tip, nt_material sample)
{
    const double tip_modulus = tip.youngs_modulus / (2.0 * (1.0 + tip.poisson_ratio));
    const double sample_modulus = sample.youngs_modulus / (2.0 * (1.0 + sample.poisson_ratio));
    return 1.0 / ((2.0 - tip.poisson_ratio) / tip_modulus + (2.0 - sample.poisson_ratio) / sample_modulus);
}

double nt_friction_stiffness(const nt_friction *friction, double radius)
{
    const double contact = 8.0 * radius * friction->effective_shear_modulus;
    return contact / (1.0 + contact * friction->lateral_compliance);
}

double nt_friction_limit(const nt_friction *friction, const nt_friction_contact *contact)
{
    return friction->shear_strength * NT_PI * contact->radius * contact->radius +
           friction->coefficient * contact->compressive_load;
}

/* The pull falls to `share` of itself and the spring to `left` of its energy; the rest is heat. */
static void give_up(nt_friction_state *state, double share, double left)
{
    state->force[0] *= share;
    state->force[1] *= share;
    state->dissipated += state->stored * (1.0 - left);
    state->stored *= left;
}

/* To another stiffness and limit, nothing moves. A growing contact: p^2/(2 K) falls with 1/K, the rest is locked in and
 * lost at the next slip. A shrinking one: p = K times its elastic slip, which stays. */
static void change_contact(nt_friction_state *state, double stiffness, double limit)
{
    if (stiffness > state->stiffness) {
        if (state->stiffness > 0.0)
            give_up(state, 1.0, state->stiffness / stiffness);
    } else if (stiffness < state->stiffness) {
        const double ratio = stiffness / state->stiffness;
        give_up(state, ratio, ratio);
    }
    state->stiffness = stiffness;
    const double pull = hypotenuse(state->force[0], state->force[1]);
    if (pull > limit) {
        const double share = limit / pull;
        give_up(state, share, share * share);
    }
}

/* The part of a way s that is stuck: until |p + K s n| = F. along: n.p */
static double stuck_part(const nt_friction_state *state, double along, double limit)
{
    const double pull = hypotenuse(state->force[0], state->force[1]);
    const double room = fmax((limit - pull) * (limit + pull), 0.0); /* F^2 - p^2 */
    const double root = sqrt(along * along + room);
    return (along > 0.0 ? room / (along + root) : root - along) / state->stiffness;
}

static void stick(nt_friction_state *state, const double pull[2], const double n[2], double way)
{
    const double stretch = state->stiffness * way;
    const double after[2] = {pull[0] + stretch * n[0], pull[1] + stretch * n[1]};
    state->work += 0.5 * way * ((pull[0] + after[0]) * n[0] + (pull[1] + after[1]) * n[1]);
    state->stored = 0.5 * (after[0] * after[0] + after[1] * after[1]) / state->stiffness;
    state->force[0] = -after[0];
    state->force[1] = -after[1];
}

/* On the circle. Heat F (s - F/K ln((1 + t0^2)/(1 + t1^2))), t = tan(angle/2). */
static void slip(nt_friction_state *state, const double n[2], double way, double limit)
{
    if (!(limit > 0.0))
        return;
    const double along = -(state->force[0] * n[0] + state->force[1] * n[1]) / limit;
    const double across = -(state->force[1] * n[0] - state->force[0] * n[1]) / limit;
    const double reach = limit / state->stiffness, decay = way / reach;
    const double before = across / (1.0 + fmax(along, 0.0)), after = before * exp(-decay);
    const double turned = -before * before * expm1(-2.0 * decay) / (1.0 + after * after);
    const double heat = fmax(limit * (way - reach * log1p(turned)), 0.0);
    const double norm = limit / (1.0 + after * after);
    const double p = norm * (1.0 - after) * (1.0 + after), q = norm * 2.0 * after;
    state->force[0] = -(p * n[0] - q * n[1]);
    state->force[1] = -(p * n[1] + q * n[0]);
    state->work += heat; /* p.n integrated: all that the hand does goes into the slip */
    state->dissipated += heat;
}

static nt_status check_step(const nt_friction_contact *contact, const double way[2])
{
    if (!isfinite(contact->radius) || !isfinite(contact->compressive_load) || !isfinite(way[0]) || !isfinite(way[1]))
        return NT_E_NOT_FINITE;
    return contact->radius >= 0.0 && contact->compressive_load >= 0.0 ? NT_OK : NT_E_RANGE;
}

nt_status nt_friction_advance(const nt_friction *friction, nt_friction_state *state, const nt_friction_contact *contact,
                              const double way[2])
{
    const nt_status status = check_step(contact, way);
    if (status != NT_OK)
        return status;
    const double limit = nt_friction_limit(friction, contact);
    change_contact(state, nt_friction_stiffness(friction, contact->radius), limit);
    const double length = hypotenuse(way[0], way[1]);
    if (!(length > 0.0) || !(state->stiffness > 0.0))
        return NT_OK;
    const double n[2] = {way[0] / length, way[1] / length};
    const double pull[2] = {-state->force[0], -state->force[1]};
    const double stuck = stuck_part(state, pull[0] * n[0] + pull[1] * n[1], limit);
    stick(state, pull, n, fmin(stuck, length));
    if (length > stuck)
        slip(state, n, length - stuck, limit);
    return NT_OK;
}

nt_status nt_friction_run_n(const nt_friction *friction, nt_friction_state *state, const nt_friction_path *path)
{
    for (long i = 0; i < path->count; ++i) {
        const nt_status status = nt_friction_advance(friction, state, &path->contacts[i], path->ways[i]);
        if (status != NT_OK)
            return status;
        path->states[i] = *state;
    }
    return NT_OK;
}
