/* SPDX-License-Identifier: BSD-3-Clause
 * The margin of a session that taps beside its simulation, on rigs drawn at random: stiff samples, levers that answer
 * slowly, stages with and without a notch, amplitude and phase held. With a margin of 1.5 the servo comes to rest;
 * where it begins to ring is no less than what is told. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "session_fixture.h"

enum { RIGS = 24, TICKS_MAX = 60000, HALVINGS = 5, RESTS = 0, RINGS = 1, STOPS = 2 };
#define ENOUGH 1.5
#define TOO_HIGH 8.0
#define STILL 20e-12 /* range of the stage in the last tenth [m] */
static nt_record records[TICKS_MAX];

static double between(nt_random *random, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(random));
}

static nt_session_setup draw(long n)
{
    nt_random random = nt_random_seed((uint64_t)n);
    nt_session_setup setup = nt_session_defaults();
    setup.mode = NT_MODE_TAPPING;
    setup.minimum_margin = 0.0;
    setup.preflight = 0;
    setup.scene.medium.relative_humidity = 0.0;
    setup.scene.tip.radius = between(&random, 3e-9, 30e-9);
    setup.scene.sample.youngs_modulus = between(&random, 1e9, 1.5e11);
    if (nt_random_uniform(&random) < 0.5)
        setup.scene.adhesion.work_of_adhesion = setup.scene.adhesion.hamaker_constant = 0.0;
    setup.rig.probe.noise = 0.0;
    setup.rig.probe.spring_constant = between(&random, 2.0, 60.0);
    setup.rig.probe.resonance = between(&random, 60e3, 400e3);
    setup.rig.probe.quality = smaller(1000.0, larger(15.0, setup.rig.probe.resonance / between(&random, 60.0, 5000.0)));
    setup.rig.stage.axes = 1.0;
    setup.rig.stage.resolution = setup.rig.stage.command_resolution = 0.0;
    setup.rig.stage.resonance = between(&random, 300.0, 1e4);
    setup.rig.stage.quality = between(&random, 0.8, 20.0);
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.settings.gains.rate = between(&random, 5e3, 5e4);
    nt_tap *tap = &setup.settings.tap;
    tap->hold = (int)(n % 2);
    tap->free_amplitude = between(&random, 8e-9, 60e-9);
    tap->set_amplitude = 0.4 + 0.5 * nt_random_uniform(&random);
    tap->set_phase = 0.4 + 0.8 * nt_random_uniform(&random);
    tap->lock_in = between(&random, 5e-6, 1e-3);
    tap->noise = 0.0;
    setup.clearance = 2e-9 + 2.0 * tap->free_amplitude;
    return setup;
}

static double range_of(long from, long to)
{
    double most = -HUGE_VAL, least = HUGE_VAL;
    for (long i = from; i < to; i++) {
        most = larger(most, records[i].stage_position[NT_Z]);
        least = smaller(least, records[i].stage_position[NT_Z]);
    }
    return most - least;
}

/* What the session does with a K_I, from above the sample. */
static int ends(nt_session_setup setup, double K)
{
    const nt_tap *tap = &setup.settings.tap;
    setup.settings.gains.height_gain = K;
    const double left = 1.0 - (tap->hold ? sin(tap->set_phase) : tap->set_amplitude); /* that pulls it down */
    const double time = 0.1 + (2.0 / left + 15.0) / K + 20.0 * tap->lock_in;
    const long ticks = (long)smaller(TICKS_MAX, time * setup.settings.gains.rate), tenth = ticks / 10;
    nt_session *session = open_session(&setup);
    run(session, records, ticks);
    nt_session_close(session);
    if (records[ticks - 1].state != NT_RUN)
        return STOPS;
    const double last = range_of(ticks - tenth, ticks), before = range_of(ticks - 3 * tenth, ticks - 2 * tenth);
    return last > STILL && last > 0.7 * before ? RINGS : RESTS;
}

/* The K_I of margin 1. */
static double told(nt_session_setup setup)
{
    setup.settings.gains.height_gain = 1.0;
    nt_session *session = open_session(&setup);
    nt_margins margins;
    const double k = nt_session_plan(session)->maximum_stiffness;
    const double lags = nt_margins_judge(&setup.rig, &setup.settings, k, NT_MODE_TAPPING, &margins).margin;
    const double least = smaller(nt_session_tap(session).margin, lags);
    nt_session_close(session);
    return least;
}

static void a_margin_of_1_5_does_not_ring(void **state)
{
    (void)state;
    const char *more = getenv("NANOTOUCH_TAP_RIGS");
    const long rigs = more != NULL ? strtol(more, NULL, 10) : RIGS;
    int restless = 0, quiet = 0, compared[2] = {0};
    double lowest[2] = {HUGE_VAL, HUGE_VAL}, highest[2] = {0.0};
    for (long n = 0; n < rigs; n++) {
        const nt_session_setup setup = draw(n);
        const double limit = told(setup);
        if (ends(setup, 0.1 * limit) != RESTS) { /* no motion of the set point, or caught on the way to it */
            restless++;
            continue;
        }
        const int armed = ends(setup, limit / ENOUGH);
        if (armed == RINGS)
            print_message("rig %ld rings with a margin of 1.5\n", n);
        assert_int_equal(armed, RESTS);
        double low = limit / ENOUGH, high = TOO_HIGH * limit;
        if (ends(setup, high) == RESTS) {
            quiet++;
            continue;
        }
        for (int i = 0; i < HALVINGS; i++) {
            const double middle = sqrt(low * high);
            *(ends(setup, middle) == RESTS ? &low : &high) = middle;
        }
        const int hold = setup.settings.tap.hold;
        compared[hold]++;
        lowest[hold] = smaller(lowest[hold], high / limit);
        highest[hold] = larger(highest[hold], high / limit);
        if (high < limit)
            print_message("rig %ld: rings from %.3g of what is told\n", n, high / limit);
    }
    for (int hold = 0; hold < 2; hold++)
        print_message("%s held: ringing begins at %.3g to %.3g of what is told, in %d\n", hold ? "phase" : "amplitude",
                      lowest[hold], highest[hold], compared[hold]);
    print_message("%d ring not even at %g times it; %d rest at no K_I\n", quiet, TOO_HIGH, restless);
    assert_true(compared[0] > 0 && compared[1] > 0);
    assert_true(lowest[0] > 0.9 && lowest[1] > 0.9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_margin_of_1_5_does_not_ring),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
