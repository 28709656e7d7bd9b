/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/control.h"
#include "larger.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

#define PI 3.14159265358979323846

/* The stage itself, x'' + wn x'/Q + wn^2 x = wn^2 u, by Runge-Kutta in small steps: independent of the library. */
typedef struct plant {
    double x, v, wn, Q, highest;
} plant;

static void slope(const plant *p, double u, double x, double v, double *dx, double *dv)
{
    *dx = v;
    *dv = p->wn * p->wn * (u - x) - p->wn / p->Q * v;
}

static void run_plant(plant *p, double u, double T)
{
    const int steps = 20 + (int)(200.0 * p->wn * T / (2.0 * PI) + 20.0 * p->wn * T / p->Q);
    const double h = T / steps;
    for (int i = 0; i < steps; i++) {
        double a[2], b[2], c[2], d[2];
        slope(p, u, p->x, p->v, &a[0], &a[1]);
        slope(p, u, p->x + 0.5 * h * a[0], p->v + 0.5 * h * a[1], &b[0], &b[1]);
        slope(p, u, p->x + 0.5 * h * b[0], p->v + 0.5 * h * b[1], &c[0], &c[1]);
        slope(p, u, p->x + h * c[0], p->v + h * c[1], &d[0], &d[1]);
        p->x += h / 6.0 * (a[0] + 2.0 * b[0] + 2.0 * c[0] + d[0]);
        p->v += h / 6.0 * (a[1] + 2.0 * b[1] + 2.0 * c[1] + d[1]);
        p->highest = larger(p->highest, p->x);
    }
}

/* Follows a unit step for `time`; disturbance: an offset of what the stage makes of its command. */
static plant follow_step(const nt_stage *stage, const nt_gains *gains, double disturbance, double time)
{
    const nt_stage_loop loop = nt_stage_loop_make(stage, gains);
    nt_stage_loop_state state = {0};
    plant p = {.wn = 2.0 * PI * stage->resonance, .Q = stage->quality};
    for (double t = 0.0; t < time; t += 1.0 / gains->rate)
        run_plant(&p, nt_stage_loop_step(&loop, &state, 1.0, p.x) + disturbance, 1.0 / gains->rate);
    return p;
}

static nt_gains gains_of(double rate, double damping, double integral)
{
    return (nt_gains){.rate = rate, .stage_damping = damping, .stage_integral = integral};
}

/* Overshoot of a second-order system: exp(-pi zeta/sqrt(1 - zeta^2)). The samples of a coarse grid may fall beside its
 * peak, and the held command delays it; more than 1 % above it would be the resonance coming through. Looked at between
 * the samples, too. */
static void a_step_is_as_damped_as_designed(void **state)
{
    (void)state;
    static const double rates[] = {50e3, 10e3, 4e3, 2e3, 1e3}, dampings[] = {0.5, 0.7, 0.9};
    const nt_stage stage = nt_rig_defaults().stage;
    for (int i = 0; i < 15; i++) {
        const double zeta = dampings[i % 3];
        const nt_gains gains = gains_of(rates[i / 3], zeta, 0.0);
        const plant p = follow_step(&stage, &gains, 0.0, 0.3);
        const double design = exp(-PI * zeta / sqrt(1.0 - zeta * zeta));
        print_message("%5.0f Hz, zeta %.1f: overshoot %.4f, design %.4f\n", gains.rate, zeta, p.highest - 1.0, design);
        assert_true(p.highest - 1.0 < design + (gains.rate > 1500.0 ? 0.01 : 0.03)); /* 2.2 samples per oscillation */
        assert_true(fabs(p.x - 1.0) < 1e-9 && fabs(p.v) < 1e-9 * p.wn);
    }
    /* without the notch it would ring: */
    nt_stage_loop_state none = {0};
    const nt_stage_loop direct = {.b = {1.0}, .a = {1.0}};
    plant bare = {.wn = 2.0 * PI * stage.resonance, .Q = stage.quality};
    for (int k = 0; k < 100; k++)
        run_plant(&bare, nt_stage_loop_step(&direct, &none, 1.0, bare.x), 1e-4);
    assert_true(bare.highest > 1.8);
}

/* The delay that R1 counts (nt_margins) is the one by which a ramp is followed, down to 2.2 samples per oscillation. */
static void a_ramp_is_followed_with_the_counted_delay(void **state)
{
    (void)state;
    static const double rates[] = {50e3, 10e3, 4e3, 2e3, 1e3};
    const nt_rig rig = nt_rig_defaults();
    for (int i = 0; i < 5; i++) {
        nt_gains gains = nt_settings_defaults(&rig).gains;
        gains.rate = rates[i];
        gains.stage_integral = 0.0;
        gains.delay = 0.0;
        const double T = 1.0 / gains.rate, counted = nt_margins_compute(&rig, &gains, 1.0).loop_delay - 0.5 * T;
        const nt_stage_loop loop = nt_stage_loop_make(&rig.stage, &gains);
        nt_stage_loop_state memory = {0};
        plant p = {.wn = 2.0 * PI * rig.stage.resonance, .Q = rig.stage.quality};
        double late = 0.0; /* mean over one period of a reference held: half a period earlier than at its end */
        const int steps = (int)(0.3 * gains.rate);
        for (int k = 0; k < steps; k++) {
            run_plant(&p, nt_stage_loop_step(&loop, &memory, T * k, p.x), T);
            late = T * (k + 1) - p.x;
        }
        print_message("%5.0f Hz: %.4f ms late, counted %.4f ms\n", gains.rate, 1e3 * late, 1e3 * counted);
        assert_true(fabs(late / counted - 1.0) < 0.01);
    }
}

static void the_integral_removes_a_constant_disturbance(void **state)
{
    (void)state;
    static const double rates[] = {10e3, 2e3, 1e3};
    const nt_stage stage = nt_rig_defaults().stage;
    for (int i = 0; i < 3; i++) {
        const nt_gains with = gains_of(rates[i], 0.7, 60.0), without = gains_of(rates[i], 0.7, 0.0);
        assert_true(fabs(follow_step(&stage, &without, -0.2, 0.5).x - 0.8) < 1e-9);
        assert_true(fabs(follow_step(&stage, &with, -0.2, 0.5).x - 1.0) < 1e-6);
    }
}

/* Seen less than twice per oscillation the resonance cannot be filtered: the reference passes as it is. The stage rings
 * as it would alone, to twice the step, and the integral, which sees the ringing aliased, adds up to one more; it
 * settles. */
static void above_half_the_rate_the_reference_passes(void **state)
{
    (void)state;
    const nt_stage stage = nt_rig_defaults().stage;
    static const double rates[] = {900.0, 700.0, 450.0, 333.0, 100.0};
    for (int i = 0; i < 5; i++) {
        const nt_gains gains = gains_of(rates[i], 0.7, 60.0);
        const nt_stage_loop loop = nt_stage_loop_make(&stage, &gains);
        assert_true(loop.b[0] == 1.0 && loop.b[1] == 0.0 && loop.b[2] == 0.0 && loop.a[1] == 0.0 && loop.a[2] == 0.0);
        const plant p = follow_step(&stage, &gains, 0.0, 1.0);
        print_message("%4.0f Hz: highest %.3f, after 1 s %.2e off\n", gains.rate, p.highest, p.x - 1.0);
        assert_true(p.highest < 3.2 && fabs(p.x - 1.0) < 1e-3);
    }
}

/* From nearly undamped to overdamped, from 20 to 20 000 samples per oscillation: gain 1 at rest and a stable filter. */
static void any_stage_gets_a_stable_filter_of_gain_one(void **state)
{
    (void)state;
    static const double qualities[] = {0.05, 0.3, 0.5, 1.0, 20.0, 1e6}, dampings[] = {0.1, 0.7, 1.0, 2.0};
    nt_stage stage = nt_rig_defaults().stage;
    for (double rate = 1e3; rate <= 1e6; rate *= 10.0)
        for (int i = 0; i < 24; i++) {
            stage.quality = qualities[i / 4];
            const nt_gains gains = gains_of(rate, dampings[i % 4], 0.0);
            const nt_stage_loop loop = nt_stage_loop_make(&stage, &gains);
            assert_true(fabs(loop.a[2]) < 1.0 && fabs(loop.a[1]) < 1.0 + loop.a[2]); /* both poles inside */
            /* (wn T)^2 is what is left of the sums: rounding over it */
            const double angle = 2.0 * PI * stage.resonance / rate;
            const double gain = (loop.b[0] + loop.b[1] + loop.b[2]) / (1.0 + loop.a[1] + loop.a[2]);
            assert_true(fabs(gain - 1.0) < 1e-14 / (angle * angle));
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_step_is_as_damped_as_designed),
        cmocka_unit_test(a_ramp_is_followed_with_the_counted_delay),
        cmocka_unit_test(the_integral_removes_a_constant_disturbance),
        cmocka_unit_test(above_half_the_rate_the_reference_passes),
        cmocka_unit_test(any_stage_gets_a_stable_filter_of_gain_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
