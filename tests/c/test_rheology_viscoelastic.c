/* SPDX-License-Identifier: BSD-3-Clause
 * What must hold of a history whatever the numbers are; the numbers are in tests/python/test_rheology.py. */
#include <string.h>

#include "assertions.h"
#include "nanotouch/rheology.h"

enum { POINTS = 301, ROOM = 40000 };

static double times[POINTS], positions[POINTS], forces[POINTS], depths[POINTS], derivatives[POINTS * 3];
static double workspace[ROOM];

static nt_status run(const nt_viscoelastic *contact, double *by)
{
    nt_viscoelastic_result result = {.forces = forces, .indentations = depths, .derivatives = by};
    nt_problem problem;
    for (int i = 0; i < POINTS; i++) {
        times[i] = 0.01 * i;
        positions[i] = 1e-8 * (i < 150 ? i : 300 - i) - 2e-8;
    }
    assert_true(nt_viscoelastic_workspace(contact, POINTS, by != NULL) <= ROOM);
    const nt_viscoelastic_path path = {times, positions, 0.0, POINTS, workspace};
    return nt_viscoelastic_run(contact, &path, &result, &problem);
}

/* Work of the tip on the sample, by the trapezoid rule. */
static double work(void)
{
    double sum = 0.0;
    for (int i = 1; i < POINTS; i++)
        sum += 0.5 * (forces[i] + forces[i - 1]) * (depths[i] - depths[i - 1]);
    return sum;
}

/* No sample gives energy; an elastic one gives back all but the trapezoid's error. */
static void no_cycle_gives_energy(void **unused)
{
    (void)unused;
    for (int kind = NT_RHEOLOGY_POWER_LAW; kind < NT_RHEOLOGY_COUNT; kind++)
        for (int shape = NT_SHAPE_PARABOLOID; shape <= NT_SHAPE_PUNCH; shape++) {
            nt_viscoelastic contact = nt_viscoelastic_defaults();
            contact.rheology.kind = (nt_rheology_kind)kind;
            contact.shape.kind = (nt_shape_kind)shape;
            contact.spring_constant = 0.05;
            assert_int_equal(run(&contact, NULL), NT_OK);
            assert_true(work() > 0.0);
            assert_true(forces[POINTS - 1] == 0.0 && forces[1] == 0.0 && forces[100] > 0.0);
        }
    nt_viscoelastic elastic = nt_viscoelastic_defaults();
    elastic.rheology.exponent = 0.0;
    assert_int_equal(run(&elastic, NULL), NT_OK);
    assert_within(work(), 0.0, 1e-6 * forces[150] * 1.5e-6);
}

/* Twice the modulus on twice the lever is twice the force, to the last bits; times over t_0 are all that counts. */
static void scales(void **unused)
{
    (void)unused;
    double first[POINTS];
    nt_viscoelastic contact = nt_viscoelastic_defaults();
    contact.spring_constant = 0.05;
    assert_int_equal(run(&contact, NULL), NT_OK);
    memcpy(first, forces, sizeof first);
    contact.rheology.modulus *= 2.0;
    contact.spring_constant *= 2.0;
    assert_int_equal(run(&contact, NULL), NT_OK);
    for (int i = 0; i < POINTS; i++)
        assert_within(forces[i], 2.0 * first[i], 1e-13 * first[150]);
    contact.rheology.reference_time = 10.0; /* E_1 at 10 s that is the same law */
    contact.rheology.modulus *= pow(10.0, -contact.rheology.exponent);
    assert_int_equal(run(&contact, NULL), NT_OK);
    for (int i = 0; i < POINTS; i++)
        assert_within(forces[i], 2.0 * first[i], 1e-12 * first[150]);
}

/* The same bits again, with derivatives beside them or without. */
static void repeats(void **unused)
{
    (void)unused;
    double first[POINTS];
    nt_viscoelastic contact = nt_viscoelastic_defaults();
    contact.spring_constant = 0.05;
    assert_int_equal(run(&contact, NULL), NT_OK);
    memcpy(first, forces, sizeof first);
    assert_int_equal(run(&contact, derivatives), NT_OK);
    assert_memory_equal(first, forces, sizeof first);
    /* F goes with E_1 on a rigid lever alone */
    contact.spring_constant = 0.0;
    assert_int_equal(run(&contact, derivatives), NT_OK);
    for (int i = 0; i < POINTS; i++)
        assert_within(derivatives[3 * i + 1] * contact.rheology.modulus, forces[i], 1e-12 * forces[150]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_cycle_gives_energy),
        cmocka_unit_test(scales),
        cmocka_unit_test(repeats),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
