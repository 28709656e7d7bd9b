/* SPDX-License-Identifier: BSD-3-Clause
 * Several particles beside closed forms, beside one alone, and beside the forces summed over the way. */
#include <string.h>

#include "assertions.h"
#include "internal/manipulation.h"
#include "larger.h"
#include "manipulation/particles.h"
#include "nanotouch/advanced/manipulation.h"
#include "nanotouch/advanced/random.h"
#include "particle_fixture.h"

#define LOW 1.5e-6 /* height of the tip over the substrate: its flank pushes [m] */

/* Tip and neighbours neither pull nor rub. */
static nt_particles_setup smooth(void)
{
    nt_particles_setup setup = nt_particles_defaults();
    nt_particle_contact *tip = &setup.particle.contacts[NT_AT_TIP];
    tip->work_of_adhesion = tip->shear_strength = tip->rolling_distance = setup.between.shear_strength = 0.0;
    return setup;
}

static nt_particles made(const nt_particles_setup *setup)
{
    nt_particles particles;
    nt_problem problem;
    assert_int_equal(nt_particles_init(&particles, setup, &problem), NT_OK);
    return particles;
}

/* A row along x, 2 R and a gap apart; the tip 1.7 R before the first. */
static nt_particles_state row(const nt_particles *particles, int count, double gap)
{
    const double R = particles->pushing.particle.radius, base[3] = {-1.7 * R, 0.0, LOW};
    nt_particles_state state;
    assert_int_equal(nt_particles_begin(particles, base, &state), NT_OK);
    for (int i = 0; i < count; ++i) {
        const double place[2] = {i * (2.0 * R + gap), 0.0};
        assert_int_equal(nt_particles_lay(particles, &state, i, place), NT_OK);
    }
    return state;
}

static void lead(const nt_particles *particles, nt_particles_state *state, double x, double y, double z)
{
    const double to[3] = {state->base[0] + x, state->base[1] + y, state->base[2] + z};
    assert_int_equal(nt_particles_advance(particles, state, to), NT_OK);
}

/* Without friction between them each rolls by itself: F R = sum of 4 F_c (a/a0)^1.5 xi. The first bears what the flank
 * presses down, the others nothing. */
static void a_row_resists_with_the_sum(void **unused)
{
    (void)unused;
    const nt_particles_setup setup = smooth();
    const nt_particles particles = made(&setup);
    const nt_particle_contact *substrate = &setup.particle.contacts[NT_AT_SUBSTRATE];
    const double R = setup.particle.radius, a0 = jkr_radius(substrate, R, 0.0);
    const double unit = 4.0 * 1.5 * NT_PI * substrate->work_of_adhesion * R * substrate->rolling_distance;
    for (int count = 1; count <= 4; ++count) {
        nt_particles_state state = row(&particles, count, 5e-9);
        lead(&particles, &state, 0.7 * R, 0.0, 0.0);
        const double down = state.force[2], first = unit * pow(jkr_radius(substrate, R, down) / a0, 1.5);
        assert_within(-state.force[0] * R, first + (count - 1) * unit, 1e-4 * unit); /* heights differ by 0.1 nm */
        for (int i = 0; i < count; ++i)
            assert_true(state.particles[i].modes & NT_PARTICLE_ROLLED);
        for (int i = 1; i < count; ++i) /* pressed together, by no more than Hertz' indentation of a nanometre */
            assert_within(state.particles[i].position[0] - state.particles[i - 1].position[0], 2.0 * R, 2e-9);
    }
}

/* One that nothing reaches changes not a bit, and lies where it lay. */
static void one_that_is_far_away_changes_nothing(void **unused)
{
    (void)unused;
    nt_particles_setup setup = nt_particles_defaults();
    const nt_particles particles = made(&setup);
    nt_particles_state alone = row(&particles, 1, 0.0), both = row(&particles, 2, 20e-6);
    nt_particle_state one;
    const double start[3] = {alone.base[0], 0.0, LOW};
    assert_int_equal(nt_particle_place(&particles.pushing, 0.0, 0.0, start, &one), NT_OK);
    for (int i = 0; i < 70; ++i) {
        lead(&particles, &alone, 60e-9, 4e-9, -1e-9);
        lead(&particles, &both, 60e-9, 4e-9, -1e-9);
        assert_int_equal(nt_particle_advance(&particles.pushing, &one, alone.base), NT_OK);
    }
    assert_true(one.position[0] > 1e-7);
    assert_memory_equal(alone.force, both.force, sizeof alone.force);
    assert_memory_equal(alone.force, one.force, sizeof one.force);
    assert_memory_equal(alone.particles[0].position, both.particles[0].position, sizeof one.position);
    assert_memory_equal(alone.particles[0].position, one.position, sizeof one.position);
    assert_memory_equal(&alone.dissipated, &one.dissipated, sizeof one.dissipated);
    assert_true(both.particles[1].position[0] == 2.0 * setup.particle.radius + 20e-6);
}

/* A tip between two: both are pushed aside alike. */
static void a_mirror_image_moves_as_its_image(void **unused)
{
    (void)unused;
    const nt_particles_setup setup = smooth();
    const nt_particles particles = made(&setup);
    const double R = setup.particle.radius, base[3] = {-2.5 * R, 0.0, LOW};
    nt_particles_state state;
    assert_int_equal(nt_particles_begin(&particles, base, &state), NT_OK);
    for (int i = 0; i < 2; ++i)
        assert_int_equal(nt_particles_lay(&particles, &state, i, (double[2]){0.0, (2 * i - 1) * 1.05 * R}), NT_OK);
    lead(&particles, &state, 2.0 * R, 0.0, 0.0);
    assert_true(state.particles[0].attached[NT_AT_TIP] && state.particles[1].attached[NT_AT_TIP]);
    assert_true(state.particles[1].position[1] > 1.06 * R);
    assert_within(state.particles[0].position[1], -state.particles[1].position[1], 1e-12);
    assert_within(state.particles[0].position[0], state.particles[1].position[0], 1e-12);
    assert_within(state.force[1], 0.0, 1e-6 * fabs(state.force[0]));
}

static double between(nt_random *random, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(random));
}

/* Sums over a random walk of the base. */
typedef struct sums {
    double least, most, turnover;
} sums;

static void random_step(const nt_particles *particles, nt_random *random, nt_particles_state *state, sums *sum)
{
    const nt_particles_state before = *state;
    const double step = particles->pushing.particle.step;
    double to[3], first = 0.0, last = 0.0;
    for (int i = 0; i < 3; ++i) {
        const double inwards = i == 0 ? 0.3 : 0.0;
        to[i] = state->base[i] + 0.5 * step * (2.0 * nt_random_uniform(random) - 1.0 + inwards);
    }
    assert_int_equal(nt_particles_advance(particles, state, to), NT_OK);
    for (int i = 0; i < 3; ++i) {
        first -= before.force[i] * (to[i] - before.base[i]);
        last -= state->force[i] * (to[i] - before.base[i]);
        if (particles->lever[i] > 0.0)
            assert_within(particles->lever[i] * (state->tip[i] - state->base[i]), state->force[i],
                          1e-7 * (fabs(state->force[0]) + fabs(state->force[1]) + fabs(state->force[2])) + 2e-13);
    }
    assert_true(state->dissipated >= before.dissipated);
    sum->least += smaller(first, last);
    sum->most += larger(first, last);
    sum->turnover += larger(fabs(first), fabs(last));
}

/* Heaps of three on random ways of a base with random springs: stored + dissipated = work; the work is that of the
 * forces that are felt, and never less than the smaller of them: what jumps set free is no gift. */
static void the_account_is_closed(void **unused)
{
    (void)unused;
    nt_random random = nt_random_seed(20);
    double open = 0.0;
    for (int walk = 0; walk < 40; ++walk) {
        nt_particles_setup setup = nt_particles_defaults();
        setup.particle.radius = between(&random, 50e-9, 5e-6);
        setup.particle.tip_radius = between(&random, 10e-9, 100e-9);
        setup.particle.contacts[NT_AT_SUBSTRATE].rolling_distance = between(&random, 1e-10, 1e-8);
        setup.particle.contacts[NT_AT_TIP].rolling_distance = 1e-10;
        setup.particle.contacts[NT_AT_TIP].work_of_adhesion = 0.02 * nt_random_uniform(&random);
        setup.particle.step = 1e-9;
        for (int i = 0; i < 3; ++i)
            setup.lever[i] = nt_random_uniform(&random) < 0.3 ? 0.0 : between(&random, 0.5, 500.0);
        const nt_particles particles = made(&setup);
        const double R = setup.particle.radius, r = setup.particle.tip_radius, height = 0.4 * R;
        const double reach = R + r, up = R - r - height;
        const double away = (reach + up * sin(setup.particle.tip_half_angle)) / cos(setup.particle.tip_half_angle);
        nt_particles_state state;
        const double base[3] = {-(away + 3e-9), 0.0, height};
        assert_int_equal(nt_particles_begin(&particles, base, &state), NT_OK);
        for (int i = 0; i < 3; ++i) {
            const double place[2] = {i * 1.8 * R, (i % 2) * (1.0 * R + 2e-9)};
            assert_int_equal(nt_particles_lay(&particles, &state, i, place), NT_OK);
        }
        sums sum = {0};
        for (int i = 0; i < 150; ++i)
            random_step(&particles, &random, &state, &sum);
        const double size = sum.turnover + state.dissipated + 4e-21;
        open = larger(open, fabs(state.stored + state.dissipated - state.work) / size);
        assert_true(state.work >= sum.least - 1e-9 * size);
        assert_true(state.work <= sum.most + 0.05 * size);
    }
    print_message("open %.2g\n", open);
    assert_true(open <= 1e-10);
}

static void where_none_can_lie_is_refused(void **unused)
{
    (void)unused;
    const nt_particles_setup setup = nt_particles_defaults();
    const nt_particles particles = made(&setup);
    const double R = setup.particle.radius;
    nt_particles_state state = row(&particles, 2, 1e-6);
    const nt_particles_state before = state;
    assert_int_equal(nt_particles_lay(&particles, &state, 2, (double[2]){R, 0.0}), NT_E_STATE);
    assert_int_equal(nt_particles_lay(&particles, &state, 2, (double[2]){-1.7 * R, 0.0}), NT_E_STATE); /* the tip */
    assert_int_equal(nt_particles_lay(&particles, &state, 2, (double[2]){NAN, 0.0}), NT_E_NOT_FINITE);
    assert_int_equal(nt_particles_lay(&particles, &state, 3, (double[2]){9.0 * R, 0.0}), NT_E_CAPACITY);
    assert_int_equal(nt_particles_lay(&particles, &state, -1, (double[2]){9.0 * R, 0.0}), NT_E_CAPACITY);
    assert_int_equal(nt_particles_advance(&particles, &state, (double[3]){0.0, 0.0, -1e-9}), NT_E_RANGE);
    assert_int_equal(nt_particles_advance(&particles, &state, (double[3]){0.0, INFINITY, 0.0}), NT_E_NOT_FINITE);
    assert_memory_equal(&before, &state, sizeof state);
    for (int i = 2; i < NT_PARTICLES; ++i)
        assert_int_equal(nt_particles_lay(&particles, &state, i, (double[2]){0.0, 3.0 * i * R}), NT_OK);
    assert_int_equal(nt_particles_lay(&particles, &state, NT_PARTICLES, (double[2]){0.0, -9.0 * R}), NT_E_CAPACITY);
}

/* After a push both are strained; taken away, the one leaves the other at rest, and what they held is heat. */
static void one_is_taken_away(void **unused)
{
    (void)unused;
    const nt_particles_setup setup = nt_particles_defaults();
    const nt_particles particles = made(&setup);
    const double R = setup.particle.radius;
    nt_particles_state state = row(&particles, 2, 5e-9);
    lead(&particles, &state, 0.7 * R, 0.0, 0.0);
    assert_int_equal(nt_particles_lay(&particles, &state, 0, (double[2]){0.0, 0.0}), NT_E_STATE);
    lead(&particles, &state, -0.7 * R, 0.0, 0.0);
    assert_true(!nt_particles_touches(&state) && state.stored > 0.0);
    const double work = state.work, there = state.particles[1].position[0];
    assert_int_equal(nt_particles_lay(&particles, &state, 0, (double[2]){0.0, 0.0}), NT_OK);
    assert_within(state.stored, 0.0, 1e-12 * work);
    assert_within(state.stored + state.dissipated, work, 1e-9 * work);
    assert_true(state.particles[1].position[0] == there);
}

static void what_is_no_set_is_refused(void **unused)
{
    (void)unused;
    nt_particles particles;
    nt_problem problem;
    nt_particles_setup setup = nt_particles_defaults();
    setup.lever[1] = -1.0;
    assert_int_equal(nt_particles_init(&particles, &setup, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "lever.y");
    setup = nt_particles_defaults();
    setup.between.effective_shear_modulus = setup.between.effective_modulus;
    assert_int_equal(nt_particles_init(&particles, &setup, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "between.effective_shear_modulus");
    setup = nt_particles_defaults();
    setup.particle.radius = NAN;
    assert_int_equal(nt_particles_init(&particles, &setup, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "radius");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_row_resists_with_the_sum),        cmocka_unit_test(one_that_is_far_away_changes_nothing),
        cmocka_unit_test(a_mirror_image_moves_as_its_image), cmocka_unit_test(the_account_is_closed),
        cmocka_unit_test(where_none_can_lie_is_refused),     cmocka_unit_test(one_is_taken_away),
        cmocka_unit_test(what_is_no_set_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
