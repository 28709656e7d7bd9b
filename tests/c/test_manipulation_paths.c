/* SPDX-License-Identifier: BSD-3-Clause
 * Random particles on random paths: the account of energy beside the force on the tip, and the balance of all forces.
 */
#include <stdlib.h>

#include "assertions.h"
#include "larger.h"
#include "nanotouch/advanced/manipulation.h"
#include "nanotouch/advanced/random.h"

enum { STEPS = 100, MODES = 8 };

typedef struct walk {
    nt_random random;
    nt_pushing pushing;
    nt_particle_state state;
    double least, most, turnover; /* work of the hand: sums of the smaller and the larger end of each step [J] */
    double unbalanced;            /* worst [N] */
    double rest;                  /* size of the energy at rest [J] */
    unsigned seen;
} walk;

static double between(nt_random *random, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(random));
}

static double share(nt_random *random, double zero, double low, double high)
{
    return nt_random_uniform(random) < zero ? 0.0 : between(random, low, high);
}

static nt_particle_contact random_contact(nt_random *random, double radius)
{
    const double modulus = between(random, 1e6, 1e11);
    nt_particle_contact made = {.model = floor(4.0 * nt_random_uniform(random)),
                                .effective_modulus = modulus,
                                .work_of_adhesion = share(random, 0.2, 1e-3, 0.3),
                                .effective_shear_modulus = modulus * (1.01 + 0.98 * nt_random_uniform(random)) / 6.0,
                                .shear_strength = share(random, 0.2, 1e-4, 1e-1) * modulus,
                                .coefficient = share(random, 0.3, 1e-2, 1.0),
                                .rolling_distance = share(random, 0.2, 1e-4, 1e-1) * radius};
    made.work_of_adhesion = smaller(made.work_of_adhesion, modulus * radius / (36.0 * NT_PI));
    made.cohesive_stress = made.work_of_adhesion / between(random, 0.2e-9, 2e-9);
    if (!(made.cohesive_stress > 0.0))
        made.cohesive_stress = 1e8;
    return made;
}

/* Largest sum of forces or torques (over R) on the particle, from what the state says of its contacts [N]; less what it
 * may be: 1e-7 of all forces, and their turn with the normal in the last step, which comes after the balance. */
static double unbalanced(const nt_particle_state *s, double turn)
{
    double force[3] = {0}, torque[3] = {0}, scale = 0.0, worst = 0.0;
    for (int i = 0; i < NT_PARTICLE_CONTACTS; ++i) {
        const double up[3] = {0.0, 0.0, 1.0}, *n = i == NT_AT_TIP ? s->normal : up;
        const double *f = s->bristles[i][NT_SLIDING].pull;
        for (int k = 0; k < 3; ++k) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            force[k] += s->contacts[i].F * n[k] - f[k];
            torque[k] += n[l] * f[m] - n[m] * f[l] - s->bristles[i][NT_ROLLING].pull[k] -
                         s->bristles[i][NT_SPINNING].pull[k]; /* (-n) x (-f) */
            scale += fabs(s->contacts[i].F * n[k]) + fabs(f[k]);
        }
    }
    for (int k = 0; k < 3; ++k)
        worst = larger(worst, larger(fabs(force[k]), fabs(torque[k])));
    return worst - (2.0 * turn + 1e-7) * scale;
}

static void step_to(walk *w, const double to[3])
{
    const nt_particle_state before = w->state;
    double first = 0.0, last = 0.0, turn = 0.0;
    assert_int_equal(nt_particle_advance(&w->pushing, &w->state, to), NT_OK);
    for (int k = 0; k < 3; ++k) {
        first -= before.force[k] * (to[k] - before.tip[k]);
        last -= w->state.force[k] * (to[k] - before.tip[k]);
        turn += fabs(w->state.normal[k] - before.normal[k]);
    }
    w->least += smaller(first, last);
    w->most += larger(first, last);
    w->turnover += larger(fabs(first), fabs(last));
    w->seen |= w->state.modes;
    assert_true(w->state.dissipated >= before.dissipated);
    w->unbalanced = larger(w->unbalanced, unbalanced(&w->state, turn));
}

/* A few rest indentations, or a part of the tip's radius: what a contact bears without being crushed. */
static double length_of(const walk *w)
{
    const double rest = w->pushing.laws[NT_AT_TIP].rest_indentation, hard = 2e-3 * w->pushing.particle.tip_radius;
    return rest > 0.0 ? rest : hard;
}

static void random_direction(nt_random *random, double out[3])
{
    const double z = 2.0 * nt_random_uniform(random) - 1.0, angle = 2.0 * NT_PI * nt_random_uniform(random);
    out[0] = sqrt(1.0 - z * z) * cos(angle);
    out[1] = sqrt(1.0 - z * z) * sin(angle);
    out[2] = z;
}

/* Beside the particle, as near as nothing pulls. */
static void begin(walk *w, uint64_t seed)
{
    *w = (walk){.random = nt_random_seed(seed)};
    nt_particle particle = nt_particle_defaults();
    particle.radius = between(&w->random, 20e-9, 20e-6);
    particle.tip_radius = between(&w->random, 10e-9, 1e-6);
    particle.tip_half_angle = 0.5 * nt_random_uniform(&w->random);
    particle.step = 1e-6; /* one step a call */
    for (int i = 0; i < NT_PARTICLE_CONTACTS; ++i)
        particle.contacts[i] = random_contact(&w->random, smaller(particle.radius, particle.tip_radius) / 2.0);
    nt_problem problem;
    assert_int_equal(nt_pushing_init(&w->pushing, &particle, &problem), NT_OK);
    const double elevation = 0.5 + nt_random_uniform(&w->random), R = particle.radius, r = particle.tip_radius;
    nt_status status = NT_E_RANGE;
    for (double gap = 0.1 * length_of(w); status != NT_OK; gap *= 1.5) {
        const double reach = R + r + gap, tip[3] = {-reach * cos(elevation), 0.0, R - r + reach * sin(elevation)};
        status = nt_particle_place(&w->pushing, 0.0, 0.0, tip, &w->state);
    }
    w->rest = fabs(w->state.contacts[NT_AT_SUBSTRATE].U) + 1e-30;
}

static void step_on(walk *w, double bias)
{
    const double length = length_of(w) * between(&w->random, 1e-3, 0.05);
    double way[3], to[3];
    random_direction(&w->random, way);
    for (int k = 0; k < 3; ++k) {
        const double inwards = w->state.normal[k];
        to[k] = w->state.tip[k] + length * (way[k] + bias * inwards);
    }
    if (to[2] > 0.0)
        step_to(w, to);
}

/* 100 steps to and fro; energies over what went to and fro, what contacts and heat (kT) have. The account of the
 * library is closed. The work in it lies between the sums of the forces at the ends of the steps: never below (what a
 * jump sets free is heat), and above by what a step may be too long. NANOTOUCH_PARTICLE_PATHS=100000 is the heavy run.
 */
static void never_gives_more_than_it_took(void **unused)
{
    (void)unused;
    const char *more = getenv("NANOTOUCH_PARTICLE_PATHS");
    const long paths = more ? atol(more) : 500;
    double open = 0.0, forces = 0.0, above = 0.0;
    unsigned seen = 0;
    for (long seed = 0; seed < paths; ++seed) {
        walk w;
        begin(&w, (uint64_t)seed);
        for (int i = 0; i < STEPS; ++i)
            step_on(&w, i < STEPS / 3 ? 0.7 : 1.4 * (nt_random_uniform(&w.random) - 0.55));
        const double work = w.state.work, size = w.turnover + w.state.dissipated + w.rest + 4e-21;
        open = larger(open, fabs(w.state.stored + w.state.dissipated - work) / size);
        assert_true(work >= w.least - 1e-12 * size);
        above = larger(above, (work - w.most) / size);
        forces = larger(forces, w.unbalanced);
        seen |= w.seen;
    }
    print_message("%ld paths: open %.2g, unbalanced %.2g N, above %.2g, modes %x\n", paths, open, forces, above, seen);
    assert_true(open <= 1e-12);   /* roundings of 100 steps */
    assert_true(forces <= 1e-13); /* FAINT */
    assert_true(above <= 0.2);    /* DMT opens within a step: all its pull is at the rim of its range */
    assert_int_equal(seen, (1u << MODES) - 1u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(never_gives_more_than_it_took)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
