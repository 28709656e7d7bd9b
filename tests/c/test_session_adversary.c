/* SPDX-License-Identifier: BSD-3-Clause
 * The hard guarantee against random operators on random scenes, rigs and gains: force and indentation, as they truly
 * are, never pass what was promised before arming. 60 runs by default; NANOTOUCH_RUNS=10000 for all of them (some
 * minutes). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "larger.h"
#include "nanotouch/nanotouch.h"
#include "nanotouch/random.h"

enum { TICKS = 5000 };
static nt_record records[TICKS];

static double between(nt_random *random, double low, double high)
{
    return low + (high - low) * nt_random_uniform(random);
}

/* Evenly in the logarithm. */
static double magnitude(nt_random *random, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(random));
}

static void choose_scene(nt_scene *scene, nt_random *random)
{
    static const double moduli[] = {169e9, 70e9, 3e9, 50e6, 2e6};
    scene->sample.youngs_modulus = moduli[(int)between(random, 0.0, 4.999)];
    scene->tip.radius = magnitude(random, 8e-9, 100e-9);
    scene->medium.relative_humidity = nt_random_uniform(random) < 0.5 ? 0.0 : between(random, 0.1, 0.8);
}

static void choose_rig(nt_rig *rig, nt_random *random)
{
    rig->probe.spring_constant = magnitude(random, 0.5, 40.0);
    rig->probe.noise = nt_random_uniform(random) < 0.2 ? 0.0 : magnitude(random, 5e-3, 0.1);
    rig->master.mass = magnitude(random, 0.05, 0.5);
    rig->master.damping = magnitude(random, 20.0, 200.0);
    rig->master.gauge = nt_random_uniform(random) < 0.2 ? 0.0 : 1.0;
    rig->stage.resonance = magnitude(random, 200.0, 2000.0);
    rig->stage.quality = magnitude(random, 2.0, 50.0);
}

static void choose_settings(nt_settings *settings, nt_random *random)
{
    nt_gains *gains = &settings->gains;
    gains->rate = magnitude(random, 2e3, 20e3);
    gains->delay = floor(between(random, 0.0, 4.0));
    gains->force_gain = settings->control.choice == NT_CONTROL_IMPEDANCE ? 0.0 : between(random, 0.0, 10.0);
    gains->alpha_p *= magnitude(random, 0.3, 3.0);
    gains->alpha_f *= magnitude(random, 0.1, 2.0);
    gains->velocity_feedforward = between(random, 0.0, 0.5);
    gains->alpha_f_retract = between(random, 0.5, 1.5);
    settings->limits.force *= between(random, 0.1, 1.0);
    gains->set_point = smaller(gains->set_point, 0.5 * settings->limits.force);
    settings->limits.indentation = magnitude(random, 2e-9, 300e-9);
    settings->limits.stage_speed = magnitude(random, 2e-6, 50e-6);
}

/* How close a run came: 1 is the promise. */
typedef struct closeness {
    double force, indentation;
    int stops;
} closeness;

static void watch(const nt_session *session, long count, closeness *found, double *lowest)
{
    const nt_guarantee promised = nt_session_guarantee(session);
    for (long i = 0; i < count; i++) {
        const nt_record *r = &records[i];
        found->force = larger(found->force, fabs(r->tip_force[NT_Z]) / promised.force);
        *lowest = smaller(*lowest, r->gap);
    }
    found->indentation = larger(found->indentation, -*lowest / promised.indentation);
}

/* Blows of any force at any time, scales and modes changed between them; armed again after every stop. */
static closeness attack(nt_session *session, nt_random *random)
{
    closeness found = {0.0, 0.0, 0};
    double lowest = 0.0;
    const nt_gains *gains = &nt_session_touch(session)->settings.gains;
    const nt_input begin = {.operator_force[NT_Z] = 2.0, .duration = 0.05};
    assert_int_equal(nt_session_aim(session, &begin, NULL), NT_OK);
    for (int blow = 0; blow < 60; blow++) {
        const double share = nt_random_uniform(random);
        const nt_input input = {.operator_force[NT_Z] = between(random, -2.0, 5.0),
                                .duration = between(random, 0.0, 0.03)};
        const nt_scaling scaling = {gains->alpha_p * magnitude(random, 0.5, 2.0),
                                    gains->alpha_f * magnitude(random, 0.5, 2.0)};
        if (blow > 3)
            assert_int_equal(nt_session_aim(session, &input, NULL), NT_OK);
        if (share < 0.1)
            (void)!nt_session_rescale(session, &scaling, NULL); /* may be too close to the limit */
        else if (share < 0.15)
            nt_session_clutch(session, share < 0.125);
        else if (share < 0.2)
            (void)!nt_session_set_mode(session, (nt_mode)(int)between(random, 0.0, 3.999), NULL); /* this too */
        const long ticks = 1 + (long)between(random, 0.0, 500.0);
        assert_int_equal(nt_session_advance(session, ticks), NT_OK);
        const long count = nt_session_read(session, records, TICKS);
        watch(session, count, &found, &lowest);
        if (records[count - 1].state >= NT_RETRACT && ++found.stops)
            assert_int_equal(nt_session_arm(session, 1), NT_OK);
    }
    return found;
}

static void no_operator_breaks_the_guarantee(void **state)
{
    (void)state;
    const char *wanted = getenv("NANOTOUCH_RUNS");
    const long runs = wanted ? strtol(wanted, NULL, 10) : 60;
    nt_random random = nt_random_seed(2026);
    closeness worst = {0.0, 0.0, 0};
    long run = 0, refused = 0;
    while (run < runs) {
        nt_session_setup setup = nt_session_defaults();
        choose_scene(&setup.scene, &random);
        choose_rig(&setup.rig, &random);
        setup.settings = nt_settings_defaults(&setup.rig);
        choose_settings(&setup.settings, &random);
        setup.clearance = magnitude(&random, 2e-9, 50e-9);
        setup.seed = (uint64_t)run;
        nt_session *session = NULL;
        nt_problem problem = {0};
        const nt_status status = nt_session_open(&session, &setup, &problem);
        if (status != NT_OK) { /* what is not safe to arm */
            assert_true(++refused < 20 * (runs + 10));
            continue;
        }
        const closeness found = attack(session, &random);
        nt_session_close(session);
        if (!(found.force < 1.0 && found.indentation < 1.0))
            print_message("run %ld: force %.3f, indentation %.3f of what was promised\n", run, found.force,
                          found.indentation);
        worst.force = larger(worst.force, found.force);
        worst.indentation = larger(worst.indentation, found.indentation);
        worst.stops += found.stops;
        run++;
    }
    print_message("%ld runs, %ld refused, %d stops: at worst %.3f of the promised force, %.3f of the indentation\n",
                  runs, refused, worst.stops, worst.force, worst.indentation);
    assert_true(worst.stops > runs / 4); /* they did try */
    assert_true(worst.force < 1.0 && worst.indentation < 1.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_operator_breaks_the_guarantee)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
