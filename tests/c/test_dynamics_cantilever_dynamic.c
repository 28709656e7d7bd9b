/* SPDX-License-Identifier: BSD-3-Clause
 * The dynamic cantilever against closed forms, its own energy balance, equipartition and the quasi-static one. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "cantilever_fields.h"
#include "core/rig.h"
#include "internal/dynamics.h"
#include "internal/random.h"
#include "larger.h"

#define PI 3.14159265358979323846
#define BOLTZMANN 1.380649e-23

static nt_probe probe_of(double spring_constant, double quality, double temperature)
{
    nt_probe probe = nt_rig_defaults().probe;
    probe.spring_constant = spring_constant;
    probe.quality = quality;
    probe.temperature = temperature;
    return probe;
}

static nt_cantilever_model model_of(const nt_probe *probe, double period, double substep)
{
    nt_cantilever_model model;
    assert_int_equal(nt_cantilever_model_init(&model, probe, period, substep), NT_OK);
    return model;
}

/* A spring on both sides of z = 0, with a contact of constant radius. */
typedef struct glue {
    double stiffness, radius;
} glue;

static nt_law_value glue_eval(void *context, double z)
{
    const glue *g = context;
    return (nt_law_value){0.5 * g->stiffness * z * z, -g->stiffness * z, g->stiffness, g->radius};
}

static nt_force_field glue_field(glue *g)
{
    return (nt_force_field){.eval = glue_eval, .context = g, .length = 1e-9};
}

static double energy(const nt_cantilever_model *m, const nt_cantilever_state *s, double potential)
{
    const double mass = nt_probe_effective_mass(&m->probe);
    return 0.5 * mass * s->speed * s->speed + 0.5 * m->probe.spring_constant * s->deflection * s->deflection +
           potential / m->cosine;
}

/* From a deflection, far from anything: e^(-st) (cos, sin), at any period, to rounding. */
static void free_ringing_is_exact(void **state)
{
    (void)state;
    glue none = {0.0, 0.0};
    const nt_force_field field = glue_field(&none);
    static const double qualities[] = {1.0, 100.0, 1e6};
    for (size_t q = 0; q < 3; q++)
        for (double period = 1e-6; period < 2e-2; period *= 10.0) {
            const nt_probe probe = probe_of(8.0, qualities[q], 0.0);
            const nt_cantilever_model model = model_of(&probe, period, 0.25);
            const double s = 0.5 * model.rate / probe.quality, w = sqrt(model.rate * model.rate - s * s);
            nt_cantilever_state now = {.deflection = 5e-9, .tip_height = 105e-9};
            for (int k = 1; k <= 100; k++) {
                assert_int_equal(nt_cantilever_step(&model, &now, &field, 100e-9, NULL), NT_OK);
                const double t = k * period;
                const double exact = 5e-9 * exp(-s * t) * (cos(w * t) + s / w * sin(w * t));
                assert_true(fabs(now.deflection - exact) <
                            5e-9 * (1e-12 + 1e-14 * w * t)); /* phase: sum of roundings */
            }
        }
}

/* Tip glued to a spring of k_i: the frequency is w0 sqrt(1 + k_i/k_c) and the energy stays, for k_i/k_c = 1e-6 .. 1e6.
 * A held force delays the phase by (w h)^2/12 of its angle, 0.52 % at most. */
static void stiff_and_soft_contacts_ring_right(void **state)
{
    (void)state;
    double worst_phase = 0.0, worst_energy = 0.0;
    for (double ratio = 1e-6; ratio < 2e6; ratio *= 10.0) {
        const nt_probe probe = probe_of(8.0, 1e7, 0.0);
        glue g = {8.0 * ratio, 1e-9};
        const nt_force_field field = glue_field(&g);
        const nt_cantilever_model model = model_of(&probe, 1e-5, 0.25);
        nt_cantilever_state now = {.deflection = 1e-9, .tip_height = 1e-9}; /* base at 0 */
        const double before = energy(&model, &now, 0.5 * g.stiffness * 1e-18);
        const double w = model.rate * sqrt(1.0 + ratio);
        double phase = 0.0;
        for (int k = 0; k < 10; k++) {
            assert_int_equal(nt_cantilever_step(&model, &now, &field, 0.0, NULL), NT_OK);
            const double after = energy(&model, &now, 0.5 * g.stiffness * now.tip_height * now.tip_height);
            const double t = (k + 1) * 1e-5, lost = expm1(-model.rate / 1e7 * t); /* on average; twice at most */
            worst_energy = larger(worst_energy, fabs(after / before - 1.0));
            assert_true(after / before - 1.0 < 1e-10 && after / before - 1.0 > 2.0 * lost - 1e-10);
            phase = atan2(-now.speed / w, now.deflection);
            const double error = remainder(phase - w * t, 2.0 * PI) / (w * t);
            worst_phase = larger(worst_phase, fabs(error));
        }
        assert_int_equal(now.unresolved, 0);
    }
    print_message("phase within %.2g of the angle, energy within %.1e\n", worst_phase, worst_energy);
    assert_true(worst_phase < 0.25 * 0.25 / 12.0 && worst_energy < 1e-5);
}

/* Random probes, tips, samples, rates, sub-steps from fine to absurd: with the base at rest the energy never rises. */
static void the_energy_never_rises(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(7);
    double worst = 0.0;
    for (int run = 0; run < 300; run++) {
        sphere s = silicon;
        nt_probe probe = probe_of(pow(10.0, 8.0 * nt_random_uniform(&random) - 4.0),
                                  pow(10.0, 8.0 * nt_random_uniform(&random) - 1.0), 0.0);
        probe.resonance = pow(10.0, 3.0 + 3.0 * nt_random_uniform(&random));
        probe.tilt = run % 3 ? 0.2 : 0.0;
        s.hertz *= pow(10.0, 6.0 * nt_random_uniform(&random) - 4.0);
        s.adhesion *= pow(10.0, 2.0 * nt_random_uniform(&random) - 1.0);
        const double period = pow(10.0, -6.0 + 4.0 * nt_random_uniform(&random));
        const double rate = 2.0 * PI * probe.resonance, coarse = pow(10.0, 4.0 * nt_random_uniform(&random));
        const nt_cantilever_model model = model_of(&probe, period, larger(0.1, 1e-2 * rate * period) * coarse);
        const nt_force_field field = sphere_field(&s);
        const double base = (nt_random_uniform(&random) - 0.3) * 5e-9;
        nt_cantilever_state now = nt_cantilever_at(base);
        now.deflection = (nt_random_uniform(&random) - 0.5) * 4e-9;
        now.tip_height = base + model.cosine * now.deflection;
        double before = energy(&model, &now, sphere_eval(&s, now.tip_height).U), scale = fabs(before);
        for (int k = 0; k < 30; k++) {
            assert_int_equal(nt_cantilever_step(&model, &now, &field, base, NULL), NT_OK);
            const nt_law_value law = sphere_eval(&s, now.tip_height);
            const double after = energy(&model, &now, law.U);
            scale = larger(scale, fabs(law.U));
            assert_true(isfinite(after));
            worst = larger(worst, (after - before) / scale);
            before = after;
        }
    }
    print_message("largest rise of the energy over one period: %.1e of it\n", worst);
    assert_true(worst < 1e-9); /* Newton's last step, squared, over up to some 1e4 sub-steps */
}

/* <zeta^2> = k_B T/k_c and <zeta'^2> = k_B T/m, free, at any period; glued to a spring, k_B T/(k_c + k_i). N samples
 * that are independent after Q/w0 have a variance that is known to sqrt(2/N): 5 sigma are allowed. */
static void thermal_motion_has_its_energy(void **state)
{
    (void)state;
    enum { N = 20000 };
    nt_noise noise = nt_noise_of(11, 0);
    static const double periods[] = {1e-5, 1e-4, 1e-3}, ratios[] = {0.0, 0.0, 0.0, 1.0, 30.0};
    for (int i = 0; i < 5; i++) {
        const nt_probe probe = probe_of(0.1, 2.0, 300.0);
        const double period = i < 3 ? periods[i] : 1e-5;
        const nt_cantilever_model model = model_of(&probe, period, 0.25);
        glue g = {0.1 * ratios[i], 0.0};
        const nt_force_field field = glue_field(&g);
        nt_cantilever_state now = nt_cantilever_at(0.0);
        double squares = 0.0, speeds = 0.0;
        for (int k = -100; k < N; k++) {
            for (int skip = 0; skip < (i == 0 || i > 2 ? 3 : 1); skip++)
                assert_int_equal(nt_cantilever_step(&model, &now, &field, 0.0, &noise), NT_OK);
            squares += k < 0 ? 0.0 : now.deflection * now.deflection;
            speeds += k < 0 ? 0.0 : now.speed * now.speed;
        }
        const double kT = BOLTZMANN * 300.0;
        const double potential = squares / N * (0.1 + g.stiffness) / kT;
        const double kinetic = speeds / N * nt_probe_effective_mass(&probe) / kT;
        print_message("T = %g s, k_i/k_c = %g: %.3f and %.3f of k_B T\n", period, ratios[i], potential, kinetic);
        assert_true(fabs(potential - 1.0) < 5.0 * sqrt(2.0 / N));
        assert_true(fabs(kinetic - 1.0) < 5.0 * sqrt(2.0 / N));
    }
}

/* Down and up again through jump-in and snap-off at 10 um/s, Q = 5: both models jump at the same height, and away from
 * the ringing after a jump they differ by no more than the lag allows. */
static void slow_motion_is_quasi_static(void **state)
{
    (void)state;
    sphere one = silicon, two = silicon;
    const double period = 1e-5, speed = 10e-6;
    nt_probe probe = probe_of(8.0, 5.0, 0.0);
    const nt_cantilever_model model = model_of(&probe, period, 0.25);
    const nt_force_field a = sphere_field(&one), b = sphere_field(&two);
    nt_cantilever_state dynamic = nt_cantilever_at(8e-9), still = dynamic;
    nt_stage stage = nt_rig_defaults().stage;
    stage.max_speed = speed;
    const double bound = nt_cantilever_lag_of(&probe, &stage).force;
    double worst = 0.0;
    const int n = (int)(12e-9 / (speed * period));
    int jumps = 0, since = 0;
    for (int k = 0; k < 2 * n; k++, since++) {
        const double base = 8e-9 - speed * period * (k < n ? k + 1 : 2 * n - k - 1), last = still.tip_height;
        assert_int_equal(nt_cantilever_step(&model, &dynamic, &a, base, NULL), NT_OK);
        assert_int_equal(nt_cantilever_settle(&still, &probe, &b, base, NULL), NT_OK);
        if (fabs(still.tip_height - last) > 0.3e-9) {
            jumps++;
            since = 0;
        }
        const double error = 8.0 * fabs(dynamic.deflection - still.deflection);
        const double softness = 1.0 + sphere_eval(&two, still.tip_height).k / 8.0; /* near a fold all is slow */
        if (since > 30 && softness > 0.5)
            worst = larger(worst, error);
    }
    print_message("%d jumps; lag %.2g N, bound %.2g N\n", jumps, worst, bound);
    assert_int_equal(jumps, 2);
    assert_true(worst < bound);
}

/* The same approach in sub-steps of 0.25 and 0.03 rad: the moment of the jump, the deepest point after it, the rest. */
static void results_do_not_depend_on_the_substep(void **state)
{
    (void)state;
    static const double substeps[] = {0.5, 0.25, 0.125, 0.03};
    double deepest[4] = {0}, end[4] = {0}, after_jump[4] = {0};
    for (int i = 0; i < 4; i++) {
        sphere s = silicon;
        nt_probe probe = probe_of(2.0, 50.0, 0.0);
        const nt_cantilever_model model = model_of(&probe, 1e-5, substeps[i]);
        const nt_force_field field = sphere_field(&s);
        nt_cantilever_state now = nt_cantilever_at(6e-9);
        for (int k = 0; k < 800; k++) {
            const double base = 6e-9 - smaller(k + 1, 300) * 2e-11;
            assert_int_equal(nt_cantilever_step(&model, &now, &field, base, NULL), NT_OK);
            deepest[i] = larger(deepest[i], now.deflection);
            if (k == 320)
                after_jump[i] = energy(&model, &now, sphere_eval(&s, now.tip_height).U);
        }
        end[i] = now.deflection;
        print_message(
            "substep %.3f: %.4g N at most, %.8g N at the end, energy after the jump %.6g J; %ld evaluations\n",
            substeps[i], 2.0 * deepest[i], 2.0 * end[i], after_jump[i], s.evaluations);
    }
    for (int i = 0; i < 3; i++) {
        assert_true(fabs(end[i] / end[3] - 1.0) < 1e-6);
        assert_true(fabs(after_jump[i] / after_jump[3] - 1.0) < 1e-4);
        assert_true(fabs(deepest[i] / deepest[3] - 1.0) < 0.01);
    }
}

/* 2 eta a: the ringing of a glued tip decays with s = w0/2Q + eta a/m, in tension as in compression. */
static void contact_damping_is_passive(void **state)
{
    (void)state;
    nt_probe probe = probe_of(8.0, 1e6, 0.0);
    const double mass = nt_probe_effective_mass(&probe), w0 = 2.0 * PI * probe.resonance;
    glue g = {8.0, 2e-9};
    probe.contact_viscosity = 0.01 * mass * w0 / g.radius;
    const nt_cantilever_model model = model_of(&probe, 1e-5, 0.05);
    const nt_force_field field = glue_field(&g);
    nt_cantilever_state now = {.deflection = 1e-9, .tip_height = 1e-9};
    const double before = energy(&model, &now, 0.5 * g.stiffness * 1e-18);
    for (int k = 0; k < 10; k++)
        assert_int_equal(nt_cantilever_step(&model, &now, &field, 0.0, NULL), NT_OK);
    const double after = energy(&model, &now, 0.5 * g.stiffness * now.tip_height * now.tip_height);
    const double rate = 2.0 * (0.5 * w0 / 1e6 + probe.contact_viscosity * g.radius / mass);
    /* the energy falls by e^(-rate t), on average over a swing: within the ripple of one swing */
    assert_true(fabs(log(after / before) / (-rate * 1e-4) - 1.0) < 0.03);
}

/* A meniscus forms at 1 nm and breaks at 6 nm: the tip falls by the pull that it feels, not by the energy of the bond.
 */
static void a_jump_of_the_force_gives_no_energy(void **state)
{
    (void)state;
    bridge b = {.pull = 20e-9, .make = 1e-9, .reach = 6e-9};
    const nt_force_field field = {bridge_eval, bridge_advance, &b, 0.2e-9};
    const nt_probe probe = probe_of(8.0, 1e6, 0.0);
    const nt_cantilever_model model = model_of(&probe, 1e-5, 0.25);
    nt_cantilever_state now = nt_cantilever_at(1.05e-9);
    for (int k = 0; k < 20; k++)
        assert_int_equal(nt_cantilever_step(&model, &now, &field, 1.05e-9 - 1e-11 * smaller(k, 8), NULL), NT_OK);
    assert_true(b.made);
    const double deepest = hypot(now.deflection, now.speed / model.rate);
    assert_true(deepest < 3.0 * 20e-9 / 8.0); /* twice the pull over the spring, and some for the wall */
}

static nt_law_value nan_eval(void *context, double z)
{
    (void)context;
    return (nt_law_value){.F = z < 1e-9 ? (double)NAN : 0.0};
}

static void refuses_nonsense(void **state)
{
    (void)state;
    nt_probe probe = probe_of(8.0, 10.0, 0.0);
    nt_cantilever_model model;
    assert_int_equal(nt_cantilever_model_init(&model, &probe, 0.0, 0.25), NT_E_RANGE);
    assert_int_equal(nt_cantilever_model_init(&model, &probe, 1e-4, 0.0), NT_E_RANGE);
    assert_int_equal(nt_cantilever_model_init(&model, &probe, (double)NAN, 0.25), NT_E_NOT_FINITE);
    probe.quality = 0.0;
    assert_int_equal(nt_cantilever_model_init(&model, &probe, 1e-4, 0.25), NT_E_RANGE);
    probe.quality = 10.0;
    model = model_of(&probe, 1e-4, 0.25);
    nt_force_field field = {nan_eval, NULL, NULL, 1e-10};
    nt_cantilever_state now = nt_cantilever_at(5e-9);
    assert_int_equal(nt_cantilever_step(&model, &now, &field, 0.0, NULL), NT_E_NOT_FINITE);
    assert_true(isfinite(now.tip_height) && isfinite(now.speed));
    assert_int_equal(nt_cantilever_step(&model, &now, &field, (double)NAN, NULL), NT_E_NOT_FINITE);
    field.length = 0.0;
    assert_int_equal(nt_cantilever_step(&model, &now, &field, 5e-9, NULL), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_ringing_is_exact),
        cmocka_unit_test(stiff_and_soft_contacts_ring_right),
        cmocka_unit_test(the_energy_never_rises),
        cmocka_unit_test(thermal_motion_has_its_energy),
        cmocka_unit_test(slow_motion_is_quasi_static),
        cmocka_unit_test(results_do_not_depend_on_the_substep),
        cmocka_unit_test(contact_damping_is_passive),
        cmocka_unit_test(a_jump_of_the_force_gives_no_energy),
        cmocka_unit_test(refuses_nonsense),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
