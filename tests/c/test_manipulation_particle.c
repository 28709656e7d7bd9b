/* SPDX-License-Identifier: BSD-3-Clause
 * A particle that is pushed beside closed forms. JKR's contact radius is computed here (Johnson 1985, Eq. 5.47). */
#include <string.h>

#include "assertions.h"
#include "larger.h"
#include "manipulation/particle.h"
#include "nanotouch/advanced/manipulation.h"
#include "particle_fixture.h"

/* A tip that neither pulls nor rubs: its force goes through the centre. */
static nt_particle smooth_tip(void)
{
    nt_particle particle = nt_particle_defaults();
    nt_particle_contact *tip = &particle.contacts[NT_AT_TIP];
    tip->work_of_adhesion = tip->shear_strength = tip->rolling_distance = 0.0;
    return particle;
}

static nt_pushing made(const nt_particle *particle)
{
    nt_pushing pushing;
    nt_problem problem;
    assert_int_equal(nt_pushing_init(&pushing, particle, &problem), NT_OK);
    return pushing;
}

/* At rest, the tip at the side of it (x < 0), its flank `gap` away. */
static nt_particle_state beside(const nt_pushing *pushing, double offset, double gap)
{
    const nt_particle *particle = &pushing->particle;
    const double reach = particle->radius + particle->tip_radius + gap, psi = particle->tip_half_angle;
    const double along = sqrt(reach * reach - offset * offset), height = particle->radius - particle->tip_radius;
    const double tip[3] = {-along * cos(psi), offset * cos(psi), height + reach * sin(psi)};
    nt_particle_state state;
    assert_int_equal(nt_particle_place(pushing, 0.0, 0.0, tip, &state), NT_OK);
    return state;
}

static void push(const nt_pushing *pushing, nt_particle_state *state, double x, double y, double z)
{
    const double to[3] = {state->tip[0] + x, state->tip[1] + y, state->tip[2] + z};
    assert_int_equal(nt_particle_advance(pushing, state, to), NT_OK);
}

/* Sumer and Sitti 2008, polystyrene on glass: xi = 42, 84, 128 nm for R = 5, 10, 15 um. Torque: F R = 4 F_c (a/a0)^1.5
 * xi, and the way to it is xi and the elastic slip. */
static void rolls_at_the_published_distances(void **unused)
{
    (void)unused;
    static const double radii[] = {5e-6, 10e-6, 15e-6}, ways[] = {42e-9, 84e-9, 128e-9};
    for (int i = 0; i < 3; ++i) {
        nt_particle particle = smooth_tip();
        nt_particle_contact *substrate = &particle.contacts[NT_AT_SUBSTRATE];
        const double R = particle.radius = radii[i], w = substrate->work_of_adhesion;
        substrate->rolling_distance = ways[i];
        particle.step = 0.2e-9;
        const nt_pushing pushing = made(&particle);
        nt_particle_state state = beside(&pushing, 0.0, 1e-9);
        double onset = -1.0;
        for (int step = 0; step < 2000 && onset < 0.0; ++step) {
            push(&pushing, &state, 0.2e-9, 0.0, 0.0);
            onset = state.modes & NT_PARTICLE_ROLLED ? state.position[0] : -1.0;
        }
        push(&pushing, &state, 200e-9, 0.0, 0.0);
        const double a = jkr_radius(substrate, R, state.force[2]), a0 = jkr_radius(substrate, R, 0.0);
        const double torque = 4.0 * 1.5 * NT_PI * w * R * pow(a / a0, 1.5) * ways[i];
        assert_within(-state.force[0] * R, torque, 1e-6 * torque); /* of the solver */
        const double slip = torque / R / (8.0 * a * substrate->effective_shear_modulus);
        assert_within(onset, ways[i] + slip, 0.01 * ways[i]); /* a step, and the load that grows with it: 0.7 % */
        assert_int_equal(state.modes & (NT_PARTICLE_SLID | NT_PARTICLE_SPUN), 0);
    }
}

static void slides_at_its_shear_strength(void **unused)
{
    (void)unused;
    static const double strengths[] = {9e6, 12e6, 15e6};
    for (int i = 0; i < 3; ++i) {
        nt_particle particle = smooth_tip();
        nt_particle_contact *substrate = &particle.contacts[NT_AT_SUBSTRATE];
        substrate->rolling_distance = 1e-3;
        substrate->shear_strength = strengths[i];
        const nt_pushing pushing = made(&particle);
        nt_particle_state state = beside(&pushing, 0.0, 1e-9);
        push(&pushing, &state, 2e-6, 0.0, 0.0); /* rolled against its spring by 1.4 um at most */
        const double a = jkr_radius(substrate, particle.radius, state.force[2]);
        assert_within(-state.force[0], strengths[i] * NT_PI * a * a, 1e-6 * state.force[2]);
        assert_true(state.modes & NT_PARTICLE_SLID && !(state.modes & NT_PARTICLE_ROLLED));
        const double before = state.dissipated, x = state.tip[0], pull = -state.force[0];
        push(&pushing, &state, 100e-9, 0.0, 0.0);
        assert_within(state.dissipated - before, pull * (state.tip[0] - x), 1e-6 * pull * 100e-9);
    }
}

/* The tip sticks to the flank and moves across: the force times its arm is 2/3 pi tau a^3. */
static void spins_at_its_torque(void **unused)
{
    (void)unused;
    nt_particle particle = smooth_tip();
    nt_particle_contact *substrate = &particle.contacts[NT_AT_SUBSTRATE], *tip = &particle.contacts[NT_AT_TIP];
    substrate->rolling_distance = 1e-3;
    tip->shear_strength = 1e12;
    const nt_pushing pushing = made(&particle);
    nt_particle_state state = beside(&pushing, 0.0, 1e-9);
    push(&pushing, &state, 10e-9, 0.0, 0.0);
    push(&pushing, &state, 0.0, 100e-9, 0.0);
    assert_int_equal(state.modes & (NT_PARTICLE_SLID | NT_PARTICLE_ROLLED | NT_PARTICLE_SPUN), NT_PARTICLE_SPUN);
    const double R = particle.radius, *n = state.normal, *f = state.force; /* -f on the particle, at -R n */
    const double torque = R * (n[0] * f[1] - n[1] * f[0]);
    const double a = jkr_radius(substrate, R, f[2]), limit = 2.0 / 3.0 * NT_PI * substrate->shear_strength * a * a * a;
    assert_within(fabs(torque), limit, 1e-3 * limit); /* the normal turns by a step after the balance */
    assert_true(state.turned[2] < -1e-3);
}

/* Pulled up, the weaker of both contacts opens, at 1.5 pi w R. */
static void opens_the_weaker_contact(void **unused)
{
    (void)unused;
    for (int i = 0; i < 2; ++i) {
        nt_particle particle = nt_particle_defaults();
        particle.radius = 500e-9;
        particle.tip_radius = 500e-9; /* R/2 reduced */
        particle.step = 0.02e-9;
        particle.contacts[NT_AT_TIP].work_of_adhesion = i == 0 ? 0.06 : 0.3;
        const nt_pushing pushing = made(&particle);
        nt_particle_state state;
        assert_int_equal(nt_particle_place(&pushing, 0.0, 0.0, (double[3]){0.0, 0.0, 1.01e-6}, &state), NT_OK);
        push(&pushing, &state, 0.0, 0.0, -14e-9);
        double most = 0.0;
        for (int step = 0; step < 2000; ++step) {
            push(&pushing, &state, 0.0, 0.0, 0.02e-9);
            most = larger(most, -state.force[2]);
        }
        const double weaker = 1.5 * NT_PI * 0.06 * (i == 0 ? 250e-9 : 500e-9);
        assert_within(most, weaker, 1e-4 * weaker); /* force is flat there: (0.02 nm over some nm)^2 */
        assert_int_equal(state.modes & (NT_PARTICLE_LIFTED | NT_PARTICLE_APART),
                         i == 0 ? NT_PARTICLE_APART : NT_PARTICLE_LIFTED);
        assert_true(state.dissipated > 0.0);
    }
}

/* Straight down and up again: no heat, and the work comes back, as far as forces are known. */
static void gives_back_what_is_elastic(void **unused)
{
    (void)unused;
    nt_particle particle = smooth_tip();
    particle.step = 0.1e-9;
    const nt_pushing pushing = made(&particle);
    nt_particle_state state;
    const double tip[3] = {0.0, 0.0, 2.0 * particle.radius};
    assert_int_equal(nt_particle_place(&pushing, 0.0, 0.0, tip, &state), NT_OK);
    push(&pushing, &state, 0.0, 0.0, -20e-9);
    const double most = state.work;
    assert_true(most > 1e-16);
    push(&pushing, &state, 0.0, 0.0, 20e-9);
    assert_true(state.dissipated <= 1e-9 * most && fabs(state.work) <= 1e-9 * most);
    assert_true(state.modes & NT_PARTICLE_APART);
}

/* Pushed beside its middle it gives way to the other side, and the tip goes past it. */
static void lets_the_tip_pass(void **unused)
{
    (void)unused;
    nt_particle particle = smooth_tip();
    particle.radius = 1e-6;
    particle.contacts[NT_AT_TIP].shear_strength = 5e6;
    const nt_pushing pushing = made(&particle);
    nt_particle_state state = beside(&pushing, 0.3e-6, 1e-9);
    push(&pushing, &state, 0.5e-6, 0.0, 0.0);
    assert_true(state.position[1] < -10e-9 && state.position[0] > 0.1e-6);
    assert_true(state.force[0] < 0.0 && state.force[1] > 0.0);
    push(&pushing, &state, 15e-6, 0.0, 0.0);
    assert_true(state.modes & NT_PARTICLE_APART);
    assert_true(state.force[0] == 0.0 && state.force[1] == 0.0 && state.force[2] == 0.0);
    assert_true(state.turned[2] != 0.0 && state.position[0] < 14e-6);
}

/* A tip that pulls drags it back: rolling takes M/R both ways. 4 nm are more than the contact's reach: a step of them,
 * all at once, would tear it off. */
static void follows_a_tip_that_pulls(void **unused)
{
    (void)unused;
    nt_particle particle = smooth_tip();
    particle.radius = 1e-6;
    particle.tip_half_angle = 0.0;
    particle.step = 4e-9;
    particle.contacts[NT_AT_TIP].work_of_adhesion = 0.1;
    particle.contacts[NT_AT_SUBSTRATE].rolling_distance = 2e-9;
    const nt_pushing pushing = made(&particle);
    nt_particle_state state = beside(&pushing, 0.0, 5e-9);
    push(&pushing, &state, 20e-9, 0.0, 0.0);
    push(&pushing, &state, -300e-9, 0.0, 0.0);
    const nt_particle_contact *substrate = &particle.contacts[NT_AT_SUBSTRATE];
    const double R = particle.radius, ratio = jkr_radius(substrate, R, state.force[2]) / jkr_radius(substrate, R, 0.0);
    const double torque = 4.0 * 1.5 * NT_PI * 0.06 * R * pow(ratio, 1.5) * 2e-9;
    assert_within(state.force[0], torque / particle.radius, 1e-6 * torque / particle.radius); /* of the solver */
    assert_true(state.position[0] < -250e-9 && state.modes & NT_PARTICLE_ROLLED);
}

/* Half the step, half the distance to a fine one. */
static void converges_with_its_step(void **unused)
{
    (void)unused;
    double y[4];
    for (int i = 0; i < 4; ++i) {
        nt_particle particle = nt_particle_defaults();
        particle.step = 4e-9 / pow(2.0, i == 3 ? 6.0 : i);
        const nt_pushing pushing = made(&particle);
        nt_particle_state state = beside(&pushing, 1e-6, 5e-9);
        push(&pushing, &state, 1e-6, 0.0, 0.0);
        y[i] = state.position[1];
    }
    assert_true(fabs(y[0] - y[3]) < 1e-3 * fabs(y[3]));
    assert_true(fabs(y[2] - y[3]) < 0.6 * fabs(y[1] - y[3]) && fabs(y[1] - y[3]) < 0.6 * fabs(y[0] - y[3]));
}

static void refuses_what_is_no_particle(void **unused)
{
    (void)unused;
    nt_problem problem;
    nt_pushing pushing;
    nt_particle wrong = nt_particle_defaults();
    wrong.contacts[NT_AT_TIP].effective_shear_modulus *= 3.0;
    assert_int_equal(nt_pushing_init(&pushing, &wrong, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "tip.effective_shear_modulus");
    wrong = nt_particle_defaults();
    wrong.contacts[NT_AT_SUBSTRATE].effective_modulus = 1e6;
    wrong.contacts[NT_AT_SUBSTRATE].effective_shear_modulus = 0.25e6;
    assert_int_equal(nt_pushing_init(&pushing, &wrong, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "substrate.work_of_adhesion");
    wrong.radius = NAN;
    assert_int_equal(nt_particle_check(&wrong, &problem), NT_E_NOT_FINITE);
    const nt_particle good = nt_particle_defaults();
    pushing = made(&good);
    nt_particle_state state = beside(&pushing, 0.0, 5e-9), before = state;
    assert_int_equal(nt_particle_advance(&pushing, &state, (double[3]){0.0, NAN, 0.0}), NT_E_NOT_FINITE);
    assert_int_equal(nt_particle_advance(&pushing, &state, (double[3]){0.0, 0.0, -1e-9}), NT_E_RANGE);
    assert_int_equal(nt_particle_advance(&pushing, &state, (double[3]){1.0, 0.0, 0.0}), NT_E_RANGE);
    assert_memory_equal(&state, &before, sizeof state);
    assert_int_equal(nt_particle_place(&pushing, 0.0, 0.0, (double[3]){0.0, 0.0, 9e-6}, &state), NT_E_RANGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rolls_at_the_published_distances),
        cmocka_unit_test(slides_at_its_shear_strength),
        cmocka_unit_test(spins_at_its_torque),
        cmocka_unit_test(opens_the_weaker_contact),
        cmocka_unit_test(gives_back_what_is_elastic),
        cmocka_unit_test(lets_the_tip_pass),
        cmocka_unit_test(follows_a_tip_that_pulls),
        cmocka_unit_test(converges_with_its_step),
        cmocka_unit_test(refuses_what_is_no_particle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
