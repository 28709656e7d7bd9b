/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "larger.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

#define PI 3.14159265358979323846

/* Exact transition of (x, v) over T under a held force: m v' + b v = f, by the series of the matrix exponential of
 * [[0, 1, 0], [0, -b/m, 1/m], [0, 0, 0]] with the force as third state, halved until it is small and squared back. */
static void transition(double m, double b, double T, double E[3][3])
{
    int halvings = 0;
    while (ldexp(b * T / m + T + T / m, -halvings) > 0.1)
        halvings++;
    const double t = ldexp(T, -halvings);
    const double A[3][3] = {{0, t, 0}, {0, -b / m * t, t / m}, {0, 0, 0}};
    double term[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 9; i++)
        E[i / 3][i % 3] = term[i / 3][i % 3];
    for (int n = 1; n < 16 + halvings; n++) {
        double next[3][3] = {{0}};
        for (int i = 0; i < 27 && n < 16; i++)
            next[i / 9][i / 3 % 3] += term[i / 9][i % 3] * A[i % 3][i / 3 % 3] / n;
        for (int i = 0; i < 27 && n >= 16; i++)
            next[i / 9][i / 3 % 3] += E[i / 9][i % 3] * E[i % 3][i / 3 % 3];
        for (int i = 0; i < 9; i++)
            if (n < 16) {
                term[i / 3][i % 3] = next[i / 3][i % 3];
                E[i / 3][i % 3] += next[i / 3][i % 3];
            } else {
                E[i / 3][i % 3] = next[i / 3][i % 3];
            }
    }
}

/* Largest |eigenvalue| of the 2 x 2 loop matrix with f = -kappa x held over T. */
static double spectral_radius(double m, double b, double T, double kappa)
{
    double E[3][3];
    transition(m, b, T, E);
    const double a00 = E[0][0] - kappa * E[0][2], a01 = E[0][1], a10 = E[1][0] - kappa * E[1][2], a11 = E[1][1];
    const double half = 0.5 * (a00 + a11), det = a00 * a11 - a01 * a10, root = half * half - det;
    return root < 0.0 ? sqrt(det) : fabs(half) + sqrt(root);
}

static double limit_by_bisection(double m, double b, double T)
{
    double low = 0.0, high = 1e12;
    for (int i = 0; i < 100; i++) {
        const double middle = 0.5 * (low + high);
        *(spectral_radius(m, b, T, middle) < 1.0 ? &low : &high) = middle;
    }
    return low;
}

/* 0.1 kg, 100 N s/m; from b T/m = 0.02 to 100, so that either of the two conditions is the tighter one. */
static void jury_limit_is_that_of_the_eigenvalues(void **state)
{
    (void)state;
    static const double periods[] = {20e-6, 0.1e-3, 0.25e-3, 0.5e-3, 1e-3, 3e-3, 10e-3, 0.1};
    const nt_master master = nt_rig_defaults().master;
    for (size_t i = 0; i < sizeof periods / sizeof *periods; i++) {
        const double exact = limit_by_bisection(master.mass, master.damping, periods[i]);
        const double limit = nt_margins_jury_limit(&master, periods[i]);
        print_message("T %7.3f ms: %.6g N/m by bisection, %.6g by the formula\n", 1e3 * periods[i], exact, limit);
        assert_true(fabs(limit / exact - 1.0) < 1e-6);
    }
}

/* The figures printed in docs/evidence/margins.md, three digits. */
static void jury_limit_of_the_paper_rig(void **state)
{
    (void)state;
    static const double table[][2] = {{3e-3, 119e3},    {1e-3, 239e3},    {0.5e-3, 436e3},
                                      {0.25e-3, 835e3}, {0.1e-3, 2.03e6}, {20e-6, 10.0e6}};
    const nt_master master = nt_rig_defaults().master;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        assert_true(fabs(nt_margins_jury_limit(&master, table[i][0]) / table[i][1] - 1.0) < 5e-3);
}

/* D = n (T/2 + d T) + sup over w of -Im C(jw)/w, the supremum by a scan. */
static void loop_delay_counts_holds_delays_and_stage(void **state)
{
    (void)state;
    static const double dampings[] = {0.1, 0.3, 0.5, 0.7, 0.8, 1.0, 2.0};
    nt_rig rig = nt_rig_defaults();
    nt_gains gains = nt_settings_defaults(&rig).gains;
    gains.stage_integral = 0.0;
    for (int i = 0; i < 8; i++) {
        const int bare = i == 7; /* 450 Hz seen at 800 Hz: no notch, Q = 20 */
        gains.rate = bare ? 800.0 : 10e3;
        gains.stage_damping = bare ? 0.7 : dampings[i];
        gains.delay = i % 3;
        const double zeta = bare ? 0.5 / rig.stage.quality : dampings[i], wn = 2.0 * PI * rig.stage.resonance;
        double supremum = 0.0;
        for (double u = 1e-4; u < 10.0; u += 1e-4) {
            const double real = 1.0 - u * u, imaginary = 2.0 * zeta * u;
            supremum = larger(supremum, imaginary / (real * real + imaginary * imaginary) / (u * wn));
        }
        const double expected = 2.0 * (0.5 + gains.delay) / gains.rate + supremum;
        const nt_margins margins = nt_margins_compute(&rig, &gains, 1e3);
        assert_true(fabs(margins.loop_delay / expected - 1.0) < 1e-2); /* the notch is sampled */
        assert_true(fabs(margins.stability_limit * margins.loop_delay / rig.master.damping - 1.0) < 1e-14);
    }
}

/* docs/margins.md: at 10 kHz and one period of delay R1 allows 125 kN/m behind the 450 Hz stage. */
static void margin_of_the_default_rig(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    nt_gains gains = nt_settings_defaults(&rig).gains;
    gains.stage_integral = 0.0;
    assert_true(fabs(nt_margins_compute(&rig, &gains, (double)INFINITY).stability_limit / 125e3 - 1.0) < 1e-2);
    gains.stage_integral = 60.0; /* sees 0.65 ms */
    const nt_margins rigid = nt_margins_compute(&rig, &gains, (double)INFINITY);
    assert_true(fabs(rigid.stability_limit / (125e3 / 1.039) - 1.0) < 1e-2);
    const double kappa = (1.0 + gains.force_gain) * gains.alpha_f * gains.alpha_p * rig.probe.spring_constant;
    assert_true(fabs(rigid.loop_stiffness / kappa - 1.0) < 1e-14); /* nothing is stiffer than the cantilever */
    assert_true(fabs(rigid.margin - rigid.stability_limit / kappa) < 1e-12 * rigid.margin);
    const nt_margins soft = nt_margins_compute(&rig, &gains, 4.0); /* 4 N/m behind 8 N/m: 8/3 N/m */
    assert_true(fabs(soft.loop_stiffness / kappa - 1.0 / 3.0) < 1e-14);
    assert_true(isinf(nt_margins_compute(&rig, &gains, 0.0).margin));
    assert_true(isnan(nt_margins_compute(&rig, &gains, (double)NAN).margin));
}

/* R4: motor force of one step, as the law would give it. R5: against a gauge simulated with its noise and steps. */
static void steps_and_noise_at_the_motor(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    nt_gains gains = nt_settings_defaults(&rig).gains;
    gains.force_gain = 10.0;
    const double step = larger(rig.stage.command_resolution, gains.alpha_p * rig.master.resolution);
    const double force = 11.0 * gains.alpha_f * step * 8.0;
    assert_true(fabs(nt_margins_compute(&rig, &gains, (double)INFINITY).quantisation_step / force - 1.0) < 1e-14);

    nt_random random = nt_random_seed(5);
    const double c = 1.0 - exp(-2.0 * PI * gains.force_filter / gains.rate), q = rig.master.gauge_resolution;
    double filtered = 0.0, squares = 0.0;
    enum { SAMPLES = 2000000 };
    for (int i = 0; i < SAMPLES; i++) { /* a force that falls anywhere between two steps, so that they act as noise */
        const double true_force = 10.0 * q * nt_random_uniform(&random);
        const double read = q * round((true_force + rig.master.gauge_noise * nt_random_normal(&random)) / q);
        filtered += c * (read - true_force - filtered);
        const double deflection = rig.probe.sensitivity * rig.probe.noise / 6.0 * nt_random_normal(&random);
        const double motor = 10.0 * filtered + 11.0 * gains.alpha_f * rig.probe.spring_constant * deflection;
        squares += motor * motor;
    }
    const double expected = nt_margins_compute(&rig, &gains, 1.0).force_noise;
    assert_true(fabs(sqrt(squares / SAMPLES) / expected - 1.0) < 0.005); /* 2e6 samples, correlated over 8 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jury_limit_is_that_of_the_eigenvalues),
        cmocka_unit_test(jury_limit_of_the_paper_rig),
        cmocka_unit_test(loop_delay_counts_holds_delays_and_stage),
        cmocka_unit_test(margin_of_the_default_rig),
        cmocka_unit_test(steps_and_noise_at_the_motor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
