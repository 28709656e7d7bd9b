/* SPDX-License-Identifier: BSD-3-Clause
 * Every term of the guarantee and every threshold of the supervisor as docs/safety.md gives them, on random rigs: the
 * numbers, not what follows from them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "control/bound.h"
#include "control/margins.h"
#include "control_draws.h"
#include "internal/control.h"
#include "internal/margins.h"
#include "larger.h"
#include "nanotouch/control.h"
#include "nanotouch/margins.h"

#define PI 3.14159265358979323846
#define EXACT 1e-11 /* rounding of some twenty operations */
enum { DRAWS = 200 };

static double series(double a, double b)
{
    return a * b / (a + b);
}

/* Of a step answered by a resonance. */
static double overshoots(double quality)
{
    const double zeta = 0.5 / quality;
    return zeta < 1.0 ? exp(-PI * zeta / sqrt(1.0 - zeta * zeta)) : 0.0;
}

/* exp(-pi zeta/sqrt(1 - zeta^2)) by which a swing shrinks in half a period; the integral of |1 - step response|. */
static double rings(double zeta, double speed, double resonance)
{
    const double wn = 2.0 * PI * resonance, root = sqrt(larger(0.0, 1.0 - zeta * zeta));
    const double square_wave = 4.0 / PI * (zeta < sqrt(0.5) ? 1.0 / (2.0 * zeta * root) : 1.0);
    const double all = zeta < 1.0 ? 2.0 / (1.0 - exp(-PI * zeta / root)) - 2.0 * zeta : 0.0;
    return larger(square_wave, all) * speed / wn;
}

static double dead_time(const nt_rig *rig, const nt_settings *settings)
{
    return settings->gains.delay / settings->gains.rate + rig->converters.adc_latency + rig->converters.dac_latency;
}

/* Declared slack, and what a read-out or a converter may be off by. */
static double turns_after(const nt_rig *rig, const nt_settings *settings)
{
    const double lag = settings->gains.stage_damping / (PI * rig->stage.resonance) + dead_time(rig, settings);
    const double way = settings->limits.stage_speed * (lag + 1.0 / settings->gains.rate);
    return larger(larger(20e-9, way), 20.0 * larger(rig->stage.resolution, rig->stage.command_resolution));
}

static double declared(const nt_stage *stage)
{
    return 0.5 * stage->travel * (stage->hysteresis + 4.0 * stage->creep);
}

static void thresholds_of_the_supervisor(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(1);
    for (int i = 0; i < DRAWS; ++i) {
        nt_rig rig = drawn_rig(&random);
        nt_settings settings = drawn_settings(&random, &rig);
        settings.gains.stage_integral *= i % 3 != 0;
        rig.master.rate *= i % 4 != 0;
        rig.stage.resolution *= i % 5 != 0;
        const int follows = i % 3 != 0;
        const double T = 1.0 / settings.gains.rate, sigma = rig.probe.sensitivity * rig.probe.noise / 6.0;
        const double step = rig.probe.sensitivity * rig.probe.resolution, error = settings.limits.follow_error;
        const double lag = settings.gains.stage_damping / (PI * rig.stage.resonance) + dead_time(&rig, &settings);
        const double all = error + declared(&rig.stage), slack = turns_after(&rig, &settings);
        const nt_supervisor s = nt_supervisor_make(&rig, &settings);
        assert_true(alike(s.period, T, EXACT) && s.spring_constant == rig.probe.spring_constant);
        assert_true(alike(s.master_period, rig.master.rate > 0.0 ? larger(T, 1.0 / rig.master.rate) : T, EXACT));
        assert_true(alike(s.free_force, rig.probe.spring_constant * (6.0 * sigma + 1.001 * step), EXACT));
        assert_true(alike(s.deflection_range, rig.probe.range * rig.probe.sensitivity, EXACT));
        assert_true(s.master_range == rig.master.travel && s.stage_range == rig.stage.travel && s.noise == sigma);
        const double read_step = larger(rig.stage.resolution, 0.1e-9);
        assert_true(alike(s.stuck_distance, sigma > step ? 5.0 * read_step : 0.0, EXACT));
        assert_true(alike(s.stage_share, T / (T + lag), EXACT));
        assert_true(alike(s.stage_slack, follows ? slack : all, EXACT));
        assert_true(alike(s.stage_most, follows ? error : all, EXACT));
        assert_true(alike(s.correction_most, follows ? all : 0.0, EXACT));
        assert_true(alike(s.turn_slack, slack, EXACT));
        assert_true(alike(s.lift_share, 2.0 * rig.stage.hysteresis + 4.0 * rig.stage.creep, EXACT));
        assert_true(alike(s.path_kept, exp(-T / settings.limits.follow_time), EXACT));
    }
}

static void flags_of_the_supervisor(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    for (int axes = 0; axes < 4; ++axes) {
        rig.master.axes = axes & 1 ? 3.0 : 1.0;
        rig.stage.axes = axes & 2 ? 3.0 : 1.0;
        assert_int_equal(nt_supervisor_make(&rig, &settings).leads_sideways, axes == 3);
    }
    assert_true(nt_supervisor_make(&rig, &settings).gauge_range == rig.master.gauge_range);
    rig.master.gauge = 0;
    assert_true(nt_supervisor_make(&rig, &settings).gauge_range == 0.0);
    rig.probe.resolution = rig.probe.noise / 6.0; /* noise of just one step: identical codes are normal */
    assert_true(nt_supervisor_make(&rig, &settings).stuck_distance == 0.0);
}

/* D (1 - r^2 + i r/Q) A = D drive: what of A0 at the drive's frequency is left of D; a driven base has r (r + i/Q). */
static void limits_of_an_amplitude(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(2);
    for (int i = 0; i < DRAWS; ++i) {
        nt_rig rig = drawn_rig(&random);
        nt_settings settings = drawn_settings(&random, &rig);
        nt_tap *tap = &settings.tap;
        tap->at = i % 2;
        tap->frequency = i % 3 ? rig.probe.resonance * between(&random, 0.95, 1.05) : 0.0;
        tap->free_amplitude = between(&random, 1e-9, 1e-7);
        tap->tolerance = between(&random, 0.01, 0.3);
        tap->lock_in = between(&random, 1e-4, 1e-2);
        tap->noise = between(&random, 1e-12, 1e-10);
        tap->resolution = i % 5 == 0 ? tap->noise : between(&random, 1e-12, 1e-10);
        rig.stage.resolution *= i % 7 != 0;
        const double Q = rig.probe.quality, f0 = rig.probe.resonance, r = i % 3 ? tap->frequency / f0 : 1.0;
        const double lag = tap->lock_in + Q / (PI * f0), rate = settings.gains.rate;
        double drive = tap->free_amplitude * sqrt((1.0 - r * r) * (1.0 - r * r) + r * r / (Q * Q));
        if (tap->at)
            drive /= r * sqrt(r * r + 1.0 / (Q * Q));
        const nt_amplitude_limits found = nt_supervisor_amplitude(&rig, &settings);
        assert_true(alike(found.lost, 0.1 * tap->free_amplitude, EXACT));
        assert_true(alike(found.most, 1.5 * tap->free_amplitude, EXACT));
        assert_int_equal(found.settling, 1 + (int)ceil(3.0 * lag * rate));
        assert_true(found.stuck.noise == tap->noise);
        const double way = 5.0 * larger(rig.stage.resolution, 0.1e-9);
        assert_true(alike(found.stuck.distance, tap->noise > tap->resolution ? way : 0.0, EXACT));
        assert_true(alike(found.shake, tap->at ? drive : 0.0, 1e-9)); /* 1 - r^2 cancels */
        assert_true(alike(found.reach, drive * Q / r, 1e-9));
        assert_true(alike(found.memory, Q / (2.0 * PI * f0) / (10.0 * lag), EXACT));
        assert_true(alike(found.kept, exp(-1.0 / (10.0 * lag * rate)), EXACT));
        assert_true(alike(found.share, pow(1.0 + tap->tolerance, -2.0), EXACT));
    }
}

static nt_hazard drawn_hazard(nt_random *random)
{
    nt_hazard hazard = {.slope = between(random, 0.1, 2.0),
                        .rise = between(random, 1e-10, 1e-8),
                        .pull_off_force = between(random, 1e-9, 1e-7),
                        .snap_in = between(random, 1e-8, 1e-6),
                        .snap_in_depth = between(random, 1e-10, 1e-9),
                        .arrival = between(random, 1e-8, 1e-7),
                        .thermal = between(random, 1e-10, 1e-9),
                        .ring_down = between(random, 1e-5, 1e-1),
                        .stiffness = between(random, 10.0, 1000.0),
                        .tared = between(random, 1e-11, 1e-9),
                        .unseen = between(random, 1e-10, 1e-9),
                        .stick = between(random, 1.0, 100.0),
                        .friction = between(random, 1e-7, 1e-5),
                        .curvature = between(random, 1e4, 1e8),
                        .deepest = between(random, 1e-9, 1e-4)};
    for (int i = 0; i < NT_FAILURES; ++i)
        hazard.failing[i] = between(random, 10.0, 3000.0);
    return hazard;
}

/* What the terms have in common. */
typedef struct common {
    double spring, k_eff, reaction, travel, unread, vertical, T, hidden;
} common;

static common common_of(const nt_rig *rig, const nt_settings *settings, const nt_hazard *hazard)
{
    nt_rig slave = *rig;
    slave.master.rate = 0.0;
    common c = {.spring = rig->probe.spring_constant * (1.0 + 3.0 * rig->probe.spring_constant_sigma),
                .reaction = nt_margins_loop_delay(&slave, &settings->gains),
                .travel = 1.0 + 3.0 * rig->stage.travel_sigma,
                .unread = 3.0 * rig->stage.position_sigma / (1.0 - 3.0 * rig->stage.position_sigma),
                .T = 1.0 / settings->gains.rate};
    const double integral = settings->gains.stage_integral, error = settings->limits.follow_error;
    c.k_eff = series(c.spring, hazard->stiffness);
    c.vertical = c.travel * ((1.0 + rig->stage.hysteresis) * settings->limits.stage_speed + integral * error);
    c.hidden = c.travel * (integral > 0.0 ? 2.0 * error + declared(&rig->stage) : error + declared(&rig->stage));
    return c;
}

/* The most of what is pressed and what is left of a swing, stepped through in 400 intervals as the page says. */
static double outlasts(const common *c, const nt_guarantee *g, const nt_hazard *hazard, double still)
{
    const double end = still / (c->k_eff * g->speed);
    double most = hazard->thermal;
    for (int i = 0; i < 400; ++i) {
        const double pressed = smaller(still, still * (i + 1) / 400.0 + g->ringing);
        const double left = (hazard->snap_in - hazard->thermal) * exp(-end * i / 400.0 / hazard->ring_down);
        most = larger(most, pressed + left + hazard->thermal - still);
    }
    return most;
}

static double closer_than_limit(const common *c, const nt_rig *rig, const nt_settings *settings, double climbs,
                                double relief)
{
    const double behind = c->vertical > c->travel * rig->stage.max_speed ? c->hidden + 3.0 * c->vertical * c->T : 0.0;
    (void)settings;
    return c->vertical * c->reaction + smaller(climbs * c->reaction, relief) + behind;
}

static void check_failures(const nt_guarantee *g, const common *c, const nt_rig *rig, const nt_settings *settings,
                           const nt_hazard *hazard)
{
    double k[NT_FAILURES], worst = 0.0;
    for (int i = 0; i < NT_FAILURES; ++i)
        k[i] = series(c->spring, larger(hazard->stiffness, hazard->failing[i]));
    const nt_limits *limits = &settings->limits;
    const double sigma = rig->probe.sensitivity * rig->probe.noise / 6.0,
                 step = rig->probe.sensitivity * rig->probe.resolution;
    const double free = rig->probe.spring_constant * (6.0 * sigma + 1.001 * step), seen = limits->force - 2.0 * free;
    const double deep =
        limits->indentation + c->unread * (limits->indentation + limits->force / rig->probe.spring_constant);
    assert_true(
        alike(g->failure[NT_FAILURE_READ_OUT], seen > 0.0 ? c->spring * deep * limits->force / seen : HUGE_VAL, EXACT));
    const double way = sigma > step ? 5.0 * larger(rig->stage.resolution, 0.1e-9) * (1.0 + c->unread) : 0.0;
    const double unnoticed = way > 0.0 ? larger(c->vertical * 50.0 * c->T, way) : HUGE_VAL;
    assert_true(alike(g->failure[NT_FAILURE_SENSOR], k[NT_FAILURE_SENSOR] * unnoticed, EXACT));
    const double stuck = (1.0 + overshoots(rig->stage.quality)) * (c->hidden + c->vertical * 3.0 * c->T);
    const double slips = k[NT_FAILURE_SLIP] * larger(stuck, rig->stage.slip);
    assert_true(alike(g->failure[NT_FAILURE_SLIP], settings->gains.stage_integral > 0.0 ? slips : HUGE_VAL, EXACT));
    const double fastest = c->travel * rig->stage.max_speed;
    const double runs = fastest * (c->reaction + 3.0 * c->T) + 2.0 * (1.0 + c->unread) * turns_after(rig, settings) +
                        rings(settings->gains.stage_damping, fastest, rig->stage.resonance);
    assert_true(alike(g->failure[NT_FAILURE_STAGE], k[NT_FAILURE_STAGE] * runs + free + c->spring * 1e-9, EXACT));
    for (int i = 0; i < NT_FAILURES; ++i)
        worst = larger(worst, g->failure[i]);
    assert_true(alike(g->with_failure, g->force + worst, EXACT));
}

static void check_terms(const nt_rig *rig, const nt_settings *settings, const nt_hazard *hazard, double relief)
{
    const nt_guarantee g = nt_guarantee_within(rig, settings, hazard, relief);
    const common c = common_of(rig, settings, hazard);
    const nt_limits *limits = &settings->limits;
    const nt_probe *probe = &rig->probe;
    const int sideways = rig->stage.axes > 1.0;
    assert_int_equal(g.moves_sideways, sideways);
    assert_true(alike(g.reaction_time, c.reaction, EXACT));
    const double climbs = sideways ? c.travel * hazard->slope * limits->lateral_speed : 0.0;
    assert_true(alike(g.speed, c.vertical + climbs, EXACT));
    const double over = overshoots(rig->stage.quality);
    const double steps = 0.5 * rig->stage.command_resolution * (1.0 + over) / (1.0 - over);
    const double swing = rings(settings->gains.stage_damping, c.vertical, rig->stage.resonance) + c.travel * steps;
    assert_true(alike(g.ringing, c.k_eff * swing, EXACT));
    const double closer = closer_than_limit(&c, rig, settings, climbs, relief);
    const double rise = sideways && limits->lateral_speed > 0.0 ? c.spring * hazard->rise : 0.0;
    assert_true(alike(g.motion, c.k_eff * closer + rise, EXACT));
    const double off = 3.0 * sqrt(probe->spring_constant_sigma * probe->spring_constant_sigma +
                                  probe->sensitivity_sigma * probe->sensitivity_sigma);
    assert_true(alike(g.calibration, limits->force * off / (1.0 - off), EXACT));
    assert_true(alike(g.noise, c.spring * probe->sensitivity * (probe->noise + probe->resolution), EXACT));
    assert_true(g.tare == hazard->tared && g.arrival == hazard->arrival);
    assert_true(alike(g.zero_drift, c.spring * probe->drift, EXACT));
    assert_true(alike(g.frame_drift, c.spring * rig->stage.drift, EXACT));
    const double half = 0.5 * rig->stage.travel * (1.0 - 3.0 * rig->stage.travel_sigma);
    assert_true(alike(g.help_time, half / rig->stage.drift, EXACT));
    const double still = limits->force + g.calibration + g.motion + g.ringing + g.noise + g.tare;
    assert_true(alike(g.snap_in, larger(outlasts(&c, &g, hazard, still), hazard->pull_off_force), 1e-9));
    assert_true(alike(g.force, still + g.snap_in, EXACT));
    const double most = hazard->friction + hazard->slope * g.force;
    const double grows = hazard->stick + hazard->slope * hazard->slope * c.k_eff + hazard->curvature * g.force;
    const double way = c.travel * limits->lateral_speed * (c.reaction + 2.0 * c.T);
    const double shown = limits->lateral_force + grows * way + hazard->slope * (g.force - limits->force);
    assert_true(alike(g.lateral_force, probe->lateral_stiffness > 0.0 ? smaller(most, shown) : most, EXACT));
    const double wrong = 3.0 * probe->sensitivity_sigma * limits->force;
    const double read = (2.0 * g.noise + g.tare + hazard->pull_off_force + wrong) / probe->spring_constant;
    const double deep = limits->indentation + c.unread * (limits->indentation + limits->force / probe->spring_constant);
    const double by_travel = deep + closer + swing + read + hazard->unseen + hazard->snap_in_depth;
    assert_true(alike(g.indentation, smaller(by_travel, hazard->deepest), EXACT));
    check_failures(&g, &c, rig, settings, hazard);
}

static void every_term_of_the_guarantee(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(3);
    for (int i = 0; i < DRAWS; ++i) {
        nt_rig rig = drawn_rig(&random);
        nt_settings settings = drawn_settings(&random, &rig);
        const nt_hazard hazard = drawn_hazard(&random);
        settings.gains.stage_integral *= i % 5 != 0;
        settings.limits.lateral_speed *= i % 7 != 0;
        if (i % 8 == 0)
            settings.gains.stage_integral *= 1e-3; /* below 1/s it is still one */
        if (i % 10 == 0)
            rig.stage.quality = between(&random, 0.3, 0.5); /* does not ring */
        if (i % 11 == 0) {                                  /* almost hidden in the noise, or quite */
            rig.probe.noise = between(&random, 0.5, 10.0);
            settings.limits.force = between(&random, 1e-7, 1e-6);
        }
        if (i % 6 == 0) /* slower than what it is told */
            rig.stage.max_speed = between(&random, 1e-6, 1e-5);
        if (i % 13 == 0) { /* just as fast as it is told */
            rig.stage.max_speed = settings.limits.stage_speed;
            rig.stage.hysteresis = settings.gains.stage_integral = 0.0;
        }
        if (i % 9 == 0) /* a read-out so coarse that it decides when a sensor is dead */
            rig.stage.resolution = 1e-6;
        rig.stage.axes = i % 4 ? 3.0 : 1.0;
        rig.probe.lateral_stiffness *= i % 3 == 0 ? 0.0 : i % 3 == 1 ? 1.0 : 0.01;
        check_terms(&rig, &settings, &hazard, i % 2 ? HUGE_VAL : between(&random, 1e-10, 1e-8));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thresholds_of_the_supervisor),
        cmocka_unit_test(flags_of_the_supervisor),
        cmocka_unit_test(limits_of_an_amplitude),
        cmocka_unit_test(every_term_of_the_guarantee),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
