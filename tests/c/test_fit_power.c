/* SPDX-License-Identifier: BSD-3-Clause
 * fit/power.cpp, fit/branches.cpp: a law of another tip, a contact that adheres or keeps work back is told; a right one
 * is not. */
#include "fit_curve.h"
#include "internal/fit.h"

static const double noise = 20e-12; /* N */

static nt_fit_solution solved(nt_fit_model drawn, nt_fit_model fitted, uint64_t seed)
{
    const nt_fit_options from = options_of(drawn, 0.5), options = options_of(fitted, 0.5);
    nt_fit_known known = {.noise = noise, .free = {.white = noise * noise}, .sensitivity_sigma = 0.03};
    curve made;
    synthesise(&from, noise, seed, &made);
    const nt_fit_data data = data_of(&made);
    nt_fit_solution found;
    assert_int_equal(nt_fit_solve(&options, &known, &data, &found, NULL), NT_OK);
    return found;
}

/* 200 right ones: the power is within 3 sigma of its law's (of 200 that leaves 0.5), and never doubted for more. */
static void a_right_power_is_found(void **state)
{
    (void)state;
    const nt_fit_model models[] = {NT_FIT_HERTZ, NT_FIT_CONE};
    int doubted = 0;
    for (int i = 0; i < 2; i++)
        for (uint64_t seed = 1; seed <= 100; seed++) {
            const nt_fit_solution found = solved(models[i], models[i], seed);
            const double power = nt_fit_describe(models[i]).exponent;
            assert_true(fabs(found.power[0] - power) < 4.5 * found.power[1]);
            doubted += (found.flags & NT_FIT_OTHER_POWER) != 0;
        }
    assert_true(doubted <= 4); /* 2 % */
}

static void another_tip_is_told(void **state)
{
    (void)state;
    const nt_fit_model models[] = {NT_FIT_HERTZ, NT_FIT_CONE};
    for (int i = 0; i < 2; i++)
        for (uint64_t seed = 1; seed <= 10; seed++) {
            const nt_fit_solution found = solved(models[i], models[1 - i], seed);
            assert_true(found.flags & NT_FIT_OTHER_POWER);
            assert_false(found.fit.identifiable[NT_FIT_EFFECTIVE_MODULUS]);
            const double off = found.power[0] - nt_fit_describe(models[1 - i]).exponent;
            assert_true(i == 0 ? off < 0.0 : off > 0.0);
        }
}

/* A lever of 1 N/m on a contact of F = (1 N/m) depth, whose retraction is `returned` times as strong. */
static unsigned doubts_of(double returned, double dip, double snap_in, double *kept_back)
{
    enum { N = 200 };
    double z[N], down[N], up[N];
    for (int i = 0; i < N; i++) {
        z[i] = (i - N / 2) * 1e-9;
        down[i] = z[i] < 0.0 ? -0.5 * z[i] : 0.0;
        up[i] = returned * down[i];
    }
    const nt_curve_branch approach = {.z = z,
                                      .force = down,
                                      .count = N,
                                      .dips = snap_in > 0.0,
                                      .dip = {snap_in, 0.0},
                                      .dip_z = 1e-9,
                                      .contact_slope = {0.5, 0.0}};
    const nt_curve_branch retract = {.z = z,
                                     .force = up,
                                     .count = N,
                                     .dips = dip > 0.0,
                                     .dip = {dip, 0.0},
                                     .torn = N / 2,
                                     .contact_slope = {0.5, 0.0}};
    const nt_fit_branches both = {&approach, &retract, 1, 1.0, 0.0, NAN};
    return nt_fit_branch_doubts(&both, kept_back);
}

/* Triangles: force 50 nN over 50 nm; with 0.4 times the force 20 nN over 80 nm. */
static void branches_tell_adhesion_and_loops(void **state)
{
    (void)state;
    double kept_back;
    assert_int_equal(doubts_of(1.0, 0.0, 0.0, &kept_back), 0);
    assert_true(fabs(kept_back) < 1e-12);
    assert_int_equal(doubts_of(0.4, 0.0, 0.0, &kept_back), NT_FIT_HYSTERESIS);
    assert_true(fabs(kept_back - 0.36) < 1e-9);
    assert_int_equal(doubts_of(1.0, 5e-9, 0.0, &kept_back), NT_FIT_ADHESIVE);
    assert_int_equal(doubts_of(1.0, 0.0, 2e-9, &kept_back), NT_FIT_ADHESIVE);
    assert_int_equal(doubts_of(1.0, 1e-9, 0.0, &kept_back), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_right_power_is_found), cmocka_unit_test(another_tip_is_told),
                                       cmocka_unit_test(branches_tell_adhesion_and_loops)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
