/* SPDX-License-Identifier: BSD-3-Clause
 * Spheres and a rod behind one interface: the same bits as without it, and bounds that no push goes beyond. */
#include <string.h>

#include "assertions.h"
#include "internal/manipulation.h"
#include "larger.h"
#include "manipulation/pushed.h"
#include "nanotouch/advanced/manipulation.h"
#include "nanotouch/advanced/random.h"

static nt_particles latex(void)
{
    nt_particles_setup setup = nt_particles_defaults();
    nt_particles made;
    setup.particle.radius = 500e-9;
    setup.particle.tip_radius = 50e-9;
    setup.particle.contacts[NT_AT_SUBSTRATE].rolling_distance = 4.2e-9;
    setup.particle.contacts[NT_AT_TIP].work_of_adhesion = 0.01;
    assert_int_equal(nt_particles_init(&made, &setup, NULL), NT_OK);
    return made;
}

static nt_rod wire(void)
{
    nt_rod rod = nt_rod_defaults();
    rod.tip_half_angle = 0.3;
    rod.elements = 40.0;
    return rod;
}

static void spheres_are_those_of_a_set(void **state)
{
    (void)state;
    static nt_pushed_state from, to;
    nt_particles own = latex();
    nt_particles_state beside;
    const nt_pushed given = nt_pushed_particles(&own), pushed = nt_pushed_under(&given, 30.0);
    const double base[3] = {-0.75e-6, 0.0, 0.3e-6}, end[3] = {-0.5e-6, 0.02e-6, 0.3e-6};
    own.lever[0] = own.lever[1] = 30.0;
    assert_int_equal(nt_pushed_begin(&pushed, base, &from), NT_OK);
    assert_int_equal(nt_pushed_lay(&pushed, &from, 0, (double[3]){0.0, 0.0, 1.0}), NT_OK);
    assert_int_equal(nt_particles_begin(&own, base, &beside), NT_OK);
    assert_int_equal(nt_particles_lay(&own, &beside, 0, (double[2]){0.0, 0.0}), NT_OK);
    assert_int_equal(nt_pushed_advance(&pushed, &from, end, &to), NT_OK);
    assert_int_equal(nt_particles_advance(&own, &beside, end), NT_OK);
    assert_memory_equal(to.force, beside.force, sizeof to.force);
    assert_memory_equal(to.bodies[0].place, beside.particles[0].position, sizeof to.bodies[0].place);
    assert_true(to.count == 1 && to.bodies[0].angle == 0.0 && to.bodies[0].touched);
    assert_true(to.resistance == beside.resistance && to.dissipated == beside.dissipated);
    assert_true(nt_pushed_touches(&pushed, &to) && !nt_pushed_touches(&pushed, &from));
}

static void a_rod_is_that_of_its_own(void **state)
{
    (void)state;
    static nt_pushed_state from, to;
    static nt_rod_state beside;
    nt_rod own = wire();
    const nt_pushed given = nt_pushed_rod(&own), pushed = nt_pushed_under(&given, 30.0);
    const double base[3] = {0.5e-6, -0.2e-6, 10e-9}, end[3] = {0.5e-6, -0.02e-6, 10e-9}, pose[3] = {0.0, 0.0, 0.1};
    own.lever = 30.0;
    assert_int_equal(nt_pushed_begin(&pushed, base, &from), NT_OK);
    assert_false(nt_pushed_touches(&pushed, &from));
    assert_int_equal(nt_pushed_lay(&pushed, &from, 0, pose), NT_OK);
    assert_int_equal(nt_rod_place(&own, pose, base, &beside), NT_OK);
    assert_int_equal(nt_pushed_advance(&pushed, &from, end, &to), NT_OK);
    assert_int_equal(nt_rod_advance(&own, &beside, end), NT_OK);
    assert_memory_equal(to.force, beside.force, sizeof to.force);
    assert_true(to.bodies[0].place[0] == beside.pose[0] && to.bodies[0].angle == beside.pose[2]);
    assert_true(to.bodies[0].place[2] == own.radius && to.bodies[0].touched);
    assert_true(to.stored == beside.stored && to.dissipated == beside.dissipated);
}

/* Laid anew: what its springs held is heat. */
static void a_rod_is_laid_anew(void **state)
{
    (void)state;
    static nt_pushed_state now, to;
    const nt_rod own = wire();
    const nt_pushed pushed = nt_pushed_rod(&own);
    const double pose[3] = {0.0, 0.0, 0.0}, base[3] = {0.5e-6, -0.2e-6, 0.0};
    assert_int_equal(nt_pushed_begin(&pushed, base, &now), NT_OK);
    assert_int_equal(nt_pushed_lay(&pushed, &now, 1, pose), NT_E_CAPACITY);
    assert_int_equal(nt_pushed_lay(&pushed, &now, 0, (double[3]){0.5e-6, -0.2e-6, 0.0}), NT_E_STATE);
    assert_int_equal(nt_pushed_lay(&pushed, &now, 0, (double[3]){NAN, 0.0, 0.0}), NT_E_NOT_FINITE);
    assert_int_equal(nt_pushed_lay(&pushed, &now, 0, pose), NT_OK);
    assert_int_equal(nt_pushed_advance(&pushed, &now, (double[3]){0.5e-6, -0.04e-6, 0.0}, &to), NT_OK);
    assert_int_equal(nt_pushed_lay(&pushed, &to, 0, (double[3]){0.0, 1e-6, 0.0}), NT_E_STATE); /* the tip is at it */
    assert_int_equal(nt_pushed_advance(&pushed, &to, base, &now), NT_OK);
    assert_true(now.stored > 0.0 && now.bodies[0].place[1] > 10e-9);
    nt_pushed_copy(&pushed, &to, &now);
    assert_int_equal(nt_pushed_lay(&pushed, &to, 0, (double[3]){0.0, 1e-6, 2.0}), NT_OK);
    assert_true(to.stored == 0.0 && to.bodies[0].place[1] == 1e-6 && to.bodies[0].angle == 2.0);
    assert_within(to.dissipated, now.dissipated + now.stored, 1e-12 * now.dissipated);
    assert_int_equal(nt_pushed_begin(&pushed, (double[3]){0.0, 0.0, -1e-9}, &now), NT_E_RANGE);
    assert_int_equal(nt_pushed_begin(&pushed, (double[3]){0.0, NAN, 0.0}, &now), NT_E_NOT_FINITE);
}

/* Random ways on and against both: never more sideways than the bound under the largest load there was. */
static void no_push_goes_beyond_the_bound(void **state)
{
    (void)state;
    static nt_pushed_state now, to;
    nt_random random = nt_random_seed(11);
    const nt_particles balls = latex();
    const nt_rod rod = wire();
    const nt_pushed both[] = {nt_pushed_particles(&balls), nt_pushed_rod(&rod)};
    const double sizes[] = {500e-9, 80e-9};
    for (int i = 0; i < 2; ++i) {
        const double R = sizes[i], base[3] = {-1.6 * R, 0.0, 0.6 * R};
        double load = 0.0, sideways = 0.0;
        assert_int_equal(nt_pushed_begin(&both[i], base, &now), NT_OK);
        assert_int_equal(nt_pushed_lay(&both[i], &now, 0, (double[3]){0.0, 0.0, 1.57}), NT_OK);
        for (int way = 0; way < 60; ++way) {
            const double *at = now.bodies[0].place;
            const double end[3] = {at[0] + 1.6 * R * (2.0 * nt_random_uniform(&random) - 1.0),
                                   at[1] + 1.6 * R * (2.0 * nt_random_uniform(&random) - 1.0),
                                   0.3 * R + 1.5 * R * nt_random_uniform(&random)};
            if (nt_pushed_advance(&both[i], &now, end, &to) != NT_OK)
                continue; /* it would go through */
            nt_pushed_copy(&both[i], &now, &to);
            load = larger(load, larger(now.force[2], 0.0));
            sideways = larger(sideways, hypot(now.force[0], now.force[1]));
        }
        const nt_pushed_bound bound = nt_pushed_bound_of(&both[i], load);
        print_message("kind %d: %g of the bound\n", i + 1, sideways / (bound.resistance + bound.pull_off));
        assert_true(sideways > 0.0 && sideways <= (bound.resistance + bound.pull_off) * (1.0 + 1e-8));
        assert_true(bound.stiffness > 0.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_are_those_of_a_set),
        cmocka_unit_test(a_rod_is_that_of_its_own),
        cmocka_unit_test(a_rod_is_laid_anew),
        cmocka_unit_test(no_push_goes_beyond_the_bound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
