/* SPDX-License-Identifier: BSD-3-Clause
 * The passivity observer in x and y: it leaves stable loops alone, and calms those that are not. */
#include <stdlib.h>

#include "sideways_draws.h"

enum { SEEN = 400 };

/* Peak to peak of the master over 0.2 s, in x or y, beside a straight way: down a hill it slides on [m]. */
static double ripple(loop *l, int free)
{
    static double way[2][SEEN + 1];
    double most = 0.0;
    for (int k = 0; k <= SEEN; ++k) {
        run_with(l, 0.2 / SEEN, free);
        for (int i = 0; i < 2; ++i)
            way[i][k] = l->sim.master.arm[i].position;
    }
    for (int i = 0; i < 2; ++i) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int k = 0; k <= SEEN; ++k) {
            const double beside = way[i][k] - k * (way[i][SEEN] - way[i][0]) / SEEN;
            low = smaller(low, beside);
            high = larger(high, beside);
        }
        most = larger(most, high - low);
    }
    return most;
}

/* Lands, presses, and rubs to and fro past slip. */
static void rub(loop *l, const drawn *d, double press, int free)
{
    push(l, 0.0, 0.0, press, 0.2);
    run_with(l, 0.6, free);
    const double rubs = 1.2 * l->touch.settings.gains.alpha_f * (limit_of(l) + d->slope * d->load);
    for (int way = 0; way < 4; ++way) {
        push(l, rubs * (way % 2 ? -0.8 : 0.8), rubs * (way / 2 ? -0.6 : 0.6), press, 0.02);
        run_with(l, 0.1, free);
    }
    push(l, 0.0, 0.0, press, 0.02);
    run_with(l, free ? 4.0 : 0.5, free);
}

static void open_at(loop *l, const drawn *d, double alpha_f)
{
    nt_session_setup setup = d->setup;
    setup.settings.gains.alpha_f = alpha_f;
    setup.settings.limits.lateral_force = 2.0 * d->load;
    assert_int_equal(loop_open(l, &setup), NT_OK);
    l->touch.supervisor.limits.force = l->touch.supervisor.limits.lateral_force = HUGE_VAL;
}

/* The sensors of the default rig, with their noise and steps. */
static void give_sensors(nt_rig *rig)
{
    const nt_rig real = nt_rig_defaults();
    rig->master.resolution = real.master.resolution;
    rig->master.gauge_noise = real.master.gauge_noise;
    rig->master.gauge_resolution = real.master.gauge_resolution;
    rig->stage.resolution = real.stage.resolution;
    rig->stage.command_resolution = real.stage.command_resolution;
    rig->probe.noise = real.probe.noise;
    rig->probe.resolution = real.probe.resolution;
}

static int scenes_asked(int usual)
{
    const char *asked = getenv("NANOTOUCH_SIDEWAYS_SCENES");
    return asked ? atoi(asked) : usual;
}

/* At the margin of 1.5 at which a session may be armed, with sensors that have noise and steps and without. */
static void stable_loops_keep_their_gain(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(21);
    const int scenes = scenes_asked(30);
    int trips = 0;
    for (int i = 0; i < scenes; ++i) {
        static drawn d;
        static loop l;
        double parts[3];
        draw(&d, &random);
        if (i % 2)
            give_sensors(&d.setup.rig);
        const double at = scale_at_the_limit(&d, parts);
        open_at(&l, &d, at / 1.5);
        rub(&l, &d, at / 1.5 * d.load, FREE_SIDEWAYS);
        const nt_passivity_state *of = l.state.passivity_sideways;
        trips += of[NT_X].trips + of[NT_Y].trips > 0;
    }
    print_message("%d of %d loops at a margin of 1.5 trip\n", trips, scenes);
    assert_int_equal(trips, 0);
}

/* A scene of the dice at twice to eight times the limit of x and y. Returns whether the master swings by more than
 * its sensor can tell when nobody watches; outcome: whether the observers of x and y have seen it, or those and that of
 * z; whether it is calm then, and whether it at least swings by less than eight steps of the sensor. */
enum { SEEN_SIDEWAYS, SEEN_AT_ALL, CALM, FAINT, OUTCOMES };
static int swings(nt_random *random, int outcome[OUTCOMES])
{
    static drawn d;
    static loop l;
    double parts[3], found[2];
    draw(&d, random);
    const double least = scale_at_the_limit(&d, parts) / smaller(parts[0], smaller(parts[1], parts[2]));
    const double alpha_f = least * parts[1] * between(random, 2.0, 8.0);
    for (int watched = 0; watched < 2; ++watched) {
        open_at(&l, &d, alpha_f);
        rub(&l, &d, alpha_f * d.load, watched * (FREE_SIDEWAYS | FREE_Z));
        found[watched] = ripple(&l, watched * (FREE_SIDEWAYS | FREE_Z));
    }
    const double told = 4.0 * 1e-3 * l.touch.rig.master.travel; /* taken for steps of a sensor without */
    outcome[SEEN_SIDEWAYS] = l.state.passivity_sideways[NT_X].gain < 1.0;
    outcome[SEEN_AT_ALL] = outcome[SEEN_SIDEWAYS] || l.state.passivity.gain < 1.0;
    outcome[CALM] = found[1] < larger(0.2 * found[0], told);
    outcome[FAINT] = outcome[CALM] || found[1] < 2.0 * told;
    return found[0] > told;
}

static void unstable_loops_are_calmed(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(22);
    const int scenes = scenes_asked(30);
    int swinging = 0, sum[OUTCOMES] = {0};
    for (int i = 0; i < scenes; ++i) {
        int outcome[OUTCOMES];
        if (!swings(&random, outcome))
            continue;
        ++swinging;
        for (int n = 0; n < OUTCOMES; ++n)
            sum[n] += outcome[n];
    }
    print_message(
        "%d of %d swing alone; %d of these are seen in x or y, %d at all; %d calmed, %d to below eight steps\n",
        swinging, scenes, sum[SEEN_SIDEWAYS], sum[SEEN_AT_ALL], sum[CALM], sum[FAINT]);
    assert_true(swinging > scenes / 5);
    assert_true(sum[SEEN_SIDEWAYS] >= swinging - (swinging + 19) / 20); /* of the others that along z takes the gain */
    assert_int_equal(sum[SEEN_AT_ALL], swinging);
    assert_true(sum[CALM] >= swinging - (swinging + 32) / 33);
    assert_int_equal(sum[FAINT], swinging);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stable_loops_keep_their_gain),
        cmocka_unit_test(unstable_loops_are_calmed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
