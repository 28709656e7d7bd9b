/* SPDX-License-Identifier: BSD-3-Clause
 * Springs in a loop, against Ting's law and Prony's complex modulus, and by their energy.
 *
 * With an argument: so many random histories instead of 300 (100000 take two minutes). */
#include <stdlib.h>
#include <string.h>

#include "assertions.h"
#include "internal/rheology.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/material.h"
#include "nanotouch/rheology.h"

enum { TICKS = 2001, HISTORY = 200 };
static int histories = 300;
static double times[TICKS], positions[TICKS], forces[TICKS];

static nt_viscoelastic series(void)
{
    nt_viscoelastic made = nt_viscoelastic_defaults();
    made.rheology.kind = NT_RHEOLOGY_PRONY;
    made.rheology.arm_count = 5;
    for (int k = 0; k < 5; k++) {
        made.rheology.arm_moduli[k] = 400.0 + 100.0 * k;
        made.rheology.relaxation_times[k] = 3e-3 * pow(5.0, k);
    }
    return made;
}

static nt_viscoelastic_bed bed_of(const nt_viscoelastic *contact, int springs)
{
    nt_viscoelastic_demand demand = nt_viscoelastic_demand_defaults();
    nt_viscoelastic_bed bed;
    nt_problem problem;
    demand.springs = springs;
    assert_int_equal(nt_viscoelastic_bed_make(contact, &demand, &bed, &problem), NT_OK);
    return bed;
}

/* Error over F_max along a triangle of 2 s. */
static double distance_to_ting(const nt_viscoelastic *contact, int springs)
{
    double *workspace = malloc(sizeof(double) * (size_t)nt_viscoelastic_workspace(contact, TICKS, 0));
    const nt_viscoelastic_path path = {times, positions, 0.0, TICKS, workspace};
    nt_viscoelastic_result result = {.forces = forces};
    nt_problem problem;
    const nt_viscoelastic_bed bed = bed_of(contact, springs);
    nt_viscoelastic_state state = {0};
    double worst = 0.0, most = 0.0;
    for (int i = 0; i < TICKS; i++) {
        times[i] = 1e-3 * i;
        positions[i] = 0.99e-9 * (i <= 1000 ? i : 2000 - i);
    }
    assert_int_equal(nt_viscoelastic_run(contact, &path, &result, &problem), NT_OK);
    for (int i = 0; i < TICKS; i++) {
        assert_int_equal(nt_viscoelastic_advance(&bed, &state, positions[i]), NT_OK);
        worst = larger(worst, fabs(state.force - forces[i]));
        most = larger(most, forces[i]);
    }
    free(workspace);
    return worst / most;
}

/* 2e-4 with 64 springs and 6e-5 with 128 on five arms; a power law also errs by its arms. */
static void follows_ting(void **unused)
{
    (void)unused;
    nt_viscoelastic contact = series();
    assert_true(distance_to_ting(&contact, 64) < 2e-4);
    assert_true(distance_to_ting(&contact, 128) < 6e-5);
    contact.shape = (nt_shape){.kind = NT_SHAPE_SPHERE, .radius = 5e-6};
    assert_true(distance_to_ting(&contact, 128) < 6e-5);
    contact.shape = (nt_shape){.kind = NT_SHAPE_CONE, .half_angle = 0.6};
    assert_true(distance_to_ting(&contact, 128) < 1.2e-4);
    contact = nt_viscoelastic_defaults();
    assert_true(distance_to_ting(&contact, 128) < 1e-4); /* exponent 0.2 */
    contact.rheology.exponent = 0.5;
    assert_true(distance_to_ting(&contact, 128) < 5e-4);
}

/* E' + i E" = E_inf + Sum E_k i w/(i w + r_k), from 1 to 20 Hz, at 1 kHz. */
static void oscillates_with_the_complex_modulus(void **unused)
{
    (void)unused;
    const nt_viscoelastic contact = series();
    const nt_viscoelastic_bed bed = bed_of(&contact, 64);
    const double frequencies[] = {1.0, 5.0, 20.0}; /* whole ticks a period */
    for (int j = 0; j < 3; j++) {
        const double f = frequencies[j];
        nt_viscoelastic_state state = {0};
        double in_phase = 0.0, out = 0.0, storage = contact.rheology.equilibrium_modulus, loss = 0.0;
        const double w = 2.0 * NT_PI * f;
        const int period = (int)lround(1000.0 / f), count = 40 * 1000 / period * period;
        for (int i = 0; i < count + 16 * period; i++) { /* all arms forget the start */
            const double phase = w * 1e-3 * i;
            assert_int_equal(nt_viscoelastic_advance(&bed, &state, 0.5e-6 + 1e-9 * sin(phase)), NT_OK);
            if (i >= count) {
                in_phase += state.force * sin(phase) / (8.0 * period);
                out += state.force * cos(phase) / (8.0 * period);
            }
        }
        for (int k = 0; k < 5; k++) {
            const double x = w * contact.rheology.relaxation_times[k], E = contact.rheology.arm_moduli[k];
            storage += E * x * x / (1.0 + x * x);
            loss += E * x / (1.0 + x * x);
        }
        const double per_modulus = state.stiffness / bed.modulus_over_period * 1e-9;
        assert_within(in_phase / per_modulus / storage, 1.0, 2e-3);
        assert_within(out / per_modulus / loss, 1.0, 5e-3);
    }
}

static double draw(nt_random *random, double low, double high)
{
    return low + (high - low) * nt_random_uniform(random);
}

static nt_viscoelastic any_contact(nt_random *random)
{
    nt_viscoelastic made = nt_viscoelastic_defaults();
    made.rheology.kind = (nt_rheology_kind)(int)draw(random, 1.0, 3.999);
    made.rheology.exponent = draw(random, 0.0, 0.8);
    made.shape.kind = (nt_shape_kind)(int)draw(random, 0.0, 3.999);
    made.shape.half_angle = draw(random, 0.2, 1.2);
    made.rheology.equilibrium_modulus = draw(random, -200.0, 1e3);
    made.rheology.equilibrium_modulus = larger(made.rheology.equilibrium_modulus, 0.0);
    made.rheology.arm_count = 1 + (int)draw(random, 0.0, 7.999);
    for (int k = 0; k < NT_RHEOLOGY_ARMS; k++) {
        made.rheology.arm_moduli[k] = draw(random, 1.0, 1e3);
        made.rheology.relaxation_times[k] = 1e-5 * pow(10.0, draw(random, 0.0, 6.0));
    }
    return made;
}

/* Whatever the sample and the motion, work less stored energy never falls: not over a history, nor in any tick. */
static void no_motion_gives_energy(void **unused)
{
    (void)unused;
    nt_random random = nt_random_seed(43);
    for (int h = 0; h < histories; h++) {
        const nt_viscoelastic contact = any_contact(&random);
        const nt_viscoelastic_bed bed = bed_of(&contact, 8 + (int)draw(&random, 0.0, 60.0));
        nt_viscoelastic_state state = {0};
        const double stride = 1e-6 * pow(10.0, draw(&random, -3.0, 0.0));
        double tip = 0.0, stored = 0.0, turned_over = 0.0;
        for (int i = 0; i < HISTORY; i++) {
            const double to = smaller(larger(tip + draw(&random, -stride, stride), -1e-6), 1e-6);
            assert_int_equal(nt_viscoelastic_advance(&bed, &state, to), NT_OK);
            const double work = state.force * (to - tip), now = nt_viscoelastic_stored(&bed, &state);
            turned_over = larger(turned_over, larger(fabs(work), now));
            assert_true(work - (now - stored) >= -1e-12 * turned_over); /* rounding */
            assert_true(state.force >= 0.0);
            assert_true(state.stiffness <= nt_viscoelastic_max_stiffness(&bed, to) * (1.0 + 1e-12));
            tip = to;
            stored = now;
        }
    }
}

/* Pressed, lost, pressed again before the dent is gone: a copy goes on with the same bits. */
static void a_copy_goes_on(void **unused)
{
    (void)unused;
    const nt_viscoelastic contact = series();
    const nt_viscoelastic_bed bed = bed_of(&contact, 64);
    nt_viscoelastic_state state = {0}, copy;
    double first = 0.0;
    for (int i = 0; i < 400; i++) {
        const double tip = 0.6e-6 * sin(2.0 * NT_PI * i / 200.0);
        if (i == 150)
            copy = state;
        assert_int_equal(nt_viscoelastic_advance(&bed, &state, tip), NT_OK);
        if (i == 150)
            assert_true(state.force == 0.0 && state.u[0] > 0.0); /* in the dent */
        if (i == 50)
            first = state.force;
        if (i == 250)
            assert_true(state.force < first); /* what has not recovered yet does not push */
    }
    for (int i = 150; i < 400; i++)
        assert_int_equal(nt_viscoelastic_advance(&bed, &copy, 0.6e-6 * sin(2.0 * NT_PI * i / 200.0)), NT_OK);
    assert_memory_equal(&state, &copy, sizeof state);
}

static void refuses(void **unused)
{
    (void)unused;
    const nt_viscoelastic contact = series();
    const nt_viscoelastic_bed bed = bed_of(&contact, 64);
    nt_viscoelastic_bed made;
    nt_viscoelastic_state state = {0}, before = {0};
    nt_problem problem;
    assert_int_equal(nt_viscoelastic_advance(&bed, &state, (double)NAN), NT_E_NOT_FINITE);
    assert_int_equal(nt_viscoelastic_advance(&bed, &state, 1.1e-6), NT_E_RANGE);
    assert_memory_equal(&state, &before, sizeof state);
    nt_viscoelastic_demand demand = nt_viscoelastic_demand_defaults();
    demand.springs = 129;
    assert_int_equal(nt_viscoelastic_bed_make(&contact, &demand, &made, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "springs");
    nt_viscoelastic steep = nt_viscoelastic_defaults();
    demand = nt_viscoelastic_demand_defaults();
    demand.kernel_error = 1e-7;
    assert_int_equal(nt_viscoelastic_bed_make(&steep, &demand, &made, &problem), NT_E_CAPACITY);
    assert_string_equal(problem.field, "kernel_error");
}

int main(int count, char **words)
{
    if (count > 1)
        histories = atoi(words[1]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(follows_ting),
        cmocka_unit_test(oscillates_with_the_complex_modulus),
        cmocka_unit_test(no_motion_gives_energy),
        cmocka_unit_test(a_copy_goes_on),
        cmocka_unit_test(refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
