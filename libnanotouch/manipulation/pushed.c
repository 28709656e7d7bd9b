/* SPDX-License-Identifier: BSD-3-Clause
 * Spheres and rods behind one interface: see advanced/manipulation.h. */
#include "internal/manipulation.h"
#include "nanotouch/advanced/manipulation.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "manipulation/particles.h"
#include "manipulation/pushed.h"
#include "manipulation/rod.h"
#include "manipulation/rod_step.h"
#include "manipulation/set.h"

#define FACES 3.0 /* a tip lies against so many spheres at most ... */
#define PAIRS 9.0 /* ... and so many pairs of six equal ones touch on a plane */
enum { BISECTIONS = 60 };

nt_pushed nt_pushed_particles(const nt_particles *particles)
{
    return (nt_pushed){.kind = NT_PUSHED_PARTICLES, .of = {.particles = *particles}};
}

nt_pushed nt_pushed_rod(const nt_rod *rod)
{
    return (nt_pushed){.kind = NT_PUSHED_ROD, .of = {.rod = *rod}};
}

nt_pushed nt_pushed_under(const nt_pushed *pushed, double lever)
{
    nt_pushed under = *pushed;
    if (under.kind == NT_PUSHED_ROD) {
        under.of.rod.lever = lever;
    } else if (under.kind == NT_PUSHED_PARTICLES) {
        under.of.particles.lever[0] = under.of.particles.lever[1] = lever;
        under.of.particles.lever[2] = 0.0;
    }
    return under;
}

/* --- spheres --- */

/* The contact under a load [N]: the deepest of its branches. */
static nt_law_value pressed(const nt_particle_laws *laws, double load)
{
    const double R = laws->normal.maugis.contact.radius;
    double shallow = laws->rest_indentation, deep = R;
    nt_law_value value = {0};
    for (int i = 0; i < BISECTIONS; ++i) {
        const double middle = 0.5 * (shallow + deep);
        if (nt_contact_law_eval(&laws->normal, middle, NT_BRANCH_STABLE, &value) == NT_OK && value.F < load)
            shallow = middle;
        else
            deep = middle;
    }
    (void)nt_contact_law_eval(&laws->normal, deep, NT_BRANCH_STABLE, &value);
    return value;
}

/* What gives way at a contact under a load [N]. */
static double limit_under(const nt_particle_laws *laws, int bristle, double load)
{
    const nt_law_value value = pressed(laws, load);
    const nt_friction_contact contact = {value.a,
                                         nt_compressive_load(laws->normal.model, &laws->normal.maugis.contact, value)};
    return nt_particle_limit(laws, bristle, &contact);
}

/* Largest push sideways that all of them resist while the tip presses with a load [N]. Each slides at most. Or each
 * rolls, no faster than the tip goes: by the power of the push, its rolling torque over R, and friction times how fast
 * surfaces can rub: 3 at the tip, 2 where two of them touch. */
static double resistance_of(const nt_particles *particles, double load)
{
    const nt_particle_laws *laws = particles->pushing.laws;
    const double R = particles->pushing.particle.radius;
    const double slides = NT_PARTICLES * limit_under(&laws[NT_AT_SUBSTRATE], NT_SLIDING, load);
    const double most = load + slides;
    const double rolls = NT_PARTICLES * limit_under(&laws[NT_AT_SUBSTRATE], NT_ROLLING, load) / R +
                         FACES * limit_under(&laws[NT_AT_TIP], NT_ROLLING, most) / R +
                         PAIRS * limit_under(&particles->pair, NT_ROLLING, most) / R;
    const double rubs = 3.0 * FACES * limit_under(&laws[NT_AT_TIP], NT_SLIDING, most) +
                        2.0 * PAIRS * limit_under(&particles->pair, NT_SLIDING, most);
    return fmin(slides, rolls + rubs);
}

static nt_pushed_bound bound_of_particles(const nt_pushed *pushed, double load)
{
    const nt_particle_laws *tip = &pushed->of.particles.pushing.laws[NT_AT_TIP];
    const double resistance = resistance_of(&pushed->of.particles, load);
    const nt_law_value value = pressed(tip, load + resistance); /* what a row bears beside the flank */
    return (nt_pushed_bound){.resistance = resistance,
                             .stiffness = fmax(value.k, nt_particle_stiffness(tip, NT_SLIDING, value.a)),
                             .pull_off = FACES * tip->pull_off};
}

static void tell_particles(const nt_pushed *pushed, nt_pushed_state *state)
{
    const nt_particles_state *of = &state->memory.particles;
    (void)pushed;
    state->count = of->count;
    state->resistance = of->resistance;
    state->stored = of->stored;
    state->dissipated = of->dissipated;
    memcpy(state->force, of->force, sizeof state->force);
    for (int i = 0; i < of->count; ++i) {
        nt_pushed_body *body = &state->bodies[i];
        memcpy(body->place, of->particles[i].position, sizeof body->place);
        memcpy(body->force, of->particles[i].force, sizeof body->force);
        body->touched = of->particles[i].attached[NT_AT_TIP];
        body->angle = 0.0;
    }
}

static nt_status begin_particles(const nt_pushed *pushed, const double base[3], nt_pushed_state *state)
{
    return nt_particles_begin(&pushed->of.particles, base, &state->memory.particles);
}

static nt_status lay_particle(const nt_pushed *pushed, nt_pushed_state *state, int number, const double pose[3])
{
    return nt_particles_lay(&pushed->of.particles, &state->memory.particles, number, pose);
}

static nt_status advance_particles(const nt_pushed *pushed, nt_pushed_state *state, const double base[3])
{
    return nt_particles_advance(&pushed->of.particles, &state->memory.particles, base);
}

static void copy_particles(const nt_pushed *pushed, nt_pushed_state *to, const nt_pushed_state *from)
{
    (void)pushed;
    particles_copy(&to->memory.particles, &from->memory.particles);
}

static int touches_particles(const nt_pushed *pushed, const nt_pushed_state *state)
{
    (void)pushed;
    return nt_particles_touches(&state->memory.particles);
}

/* --- a rod --- */

/* Each piece resists with q of its length, in any direction; adhesion and friction at the tip are left out. */
static nt_pushed_bound bound_of_rod(const nt_pushed *pushed, double load)
{
    const nt_rod *rod = &pushed->of.rod;
    (void)load;
    return (nt_pushed_bound){.resistance = nt_rod_friction(rod) * rod->length, .stiffness = rod->tip_stiffness};
}

static void tell_rod(const nt_pushed *pushed, nt_pushed_state *state)
{
    const nt_rod_state *of = &state->memory.rod;
    nt_pushed_body *body = &state->bodies[0];
    state->resistance = of->resistance;
    state->stored = of->stored;
    state->dissipated = of->dissipated;
    memcpy(state->force, of->force, sizeof state->force);
    memcpy(body->force, of->force, sizeof body->force);
    body->place[0] = of->pose[0];
    body->place[1] = of->pose[1];
    body->place[2] = pushed->of.rod.radius;
    body->angle = of->pose[2];
    body->touched = nt_rod_touches(of);
}

static nt_status begin_rod(const nt_pushed *pushed, const double base[3], nt_pushed_state *state)
{
    nt_rod_state *of = &state->memory.rod;
    (void)pushed;
    if (!isfinite(base[0] + base[1] + base[2]))
        return NT_E_NOT_FINITE;
    memset(of, 0, sizeof *of);
    memcpy(of->base, base, sizeof of->base);
    memcpy(of->tip, base, sizeof of->tip);
    return base[2] >= 0.0 ? NT_OK : NT_E_RANGE;
}

static nt_status lay_rod(const nt_pushed *pushed, nt_pushed_state *state, int number, const double pose[3])
{
    const nt_rod *rod = &pushed->of.rod;
    nt_rod_state *of = &state->memory.rod;
    if (number != 0)
        return NT_E_CAPACITY;
    if (state->count > 0 && nt_rod_touches(of))
        return NT_E_STATE;
    const double heat = of->dissipated + of->stored, work = of->work;
    const double base[3] = {of->base[0], of->base[1], of->base[2]};
    const nt_status status = nt_rod_place(rod, pose, base, of);
    if (status != NT_OK)
        return status == NT_E_RANGE ? NT_E_STATE : status;
    of->dissipated = heat;
    of->work = work;
    state->count = 1;
    return NT_OK;
}

static nt_status advance_rod(const nt_pushed *pushed, nt_pushed_state *state, const double base[3])
{
    return nt_rod_advance(&pushed->of.rod, &state->memory.rod, base);
}

static void copy_rod(const nt_pushed *pushed, nt_pushed_state *to, const nt_pushed_state *from)
{
    rod_copy(&pushed->of.rod, &to->memory.rod, &from->memory.rod);
}

static int touches_rod(const nt_pushed *pushed, const nt_pushed_state *state)
{
    (void)pushed;
    return state->count > 0 && nt_rod_touches(&state->memory.rod);
}

/* --- both --- */

/* What a kind has to be able to do; `tell` fills in all but the memory. */
typedef struct kind {
    nt_pushed_bound (*bound)(const nt_pushed *pushed, double load);
    nt_status (*begin)(const nt_pushed *pushed, const double base[3], nt_pushed_state *state);
    nt_status (*lay)(const nt_pushed *pushed, nt_pushed_state *state, int number, const double pose[3]);
    nt_status (*advance)(const nt_pushed *pushed, nt_pushed_state *state, const double base[3]);
    void (*copy)(const nt_pushed *pushed, nt_pushed_state *to, const nt_pushed_state *from);
    int (*touches)(const nt_pushed *pushed, const nt_pushed_state *state);
    void (*tell)(const nt_pushed *pushed, nt_pushed_state *state);
} kind;
static const kind kinds[] = {
    [NT_PUSHED_PARTICLES] = {bound_of_particles, begin_particles, lay_particle, advance_particles, copy_particles,
                             touches_particles, tell_particles},
    [NT_PUSHED_ROD] = {bound_of_rod, begin_rod, lay_rod, advance_rod, copy_rod, touches_rod, tell_rod},
};

nt_pushed_bound nt_pushed_bound_of(const nt_pushed *pushed, double load)
{
    return kinds[pushed->kind].bound(pushed, load);
}

nt_status nt_pushed_begin(const nt_pushed *pushed, const double base[3], nt_pushed_state *state)
{
    memset(state, 0, offsetof(nt_pushed_state, memory));
    return kinds[pushed->kind].begin(pushed, base, state);
}

nt_status nt_pushed_lay(const nt_pushed *pushed, nt_pushed_state *state, int number, const double pose[3])
{
    const nt_status status = kinds[pushed->kind].lay(pushed, state, number, pose);
    if (status == NT_OK)
        kinds[pushed->kind].tell(pushed, state);
    return status;
}

void nt_pushed_copy(const nt_pushed *pushed, nt_pushed_state *to, const nt_pushed_state *from)
{
    memcpy(to, from, offsetof(nt_pushed_state, memory));
    kinds[pushed->kind].copy(pushed, to, from);
}

nt_status nt_pushed_advance(const nt_pushed *pushed, const nt_pushed_state *from, const double base[3],
                            nt_pushed_state *to)
{
    nt_pushed_copy(pushed, to, from);
    const nt_status status = kinds[pushed->kind].advance(pushed, to, base);
    if (status == NT_OK)
        kinds[pushed->kind].tell(pushed, to);
    return status;
}

int nt_pushed_touches(const nt_pushed *pushed, const nt_pushed_state *state)
{
    return kinds[pushed->kind].touches(pushed, state);
}
