/* SPDX-License-Identifier: BSD-3-Clause
 * A stage whose travel and read-out are off by up to 3 sigma of their calibration: it goes faster than it is told, and
 * is deeper than it reads. What is promised counts with both. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "larger.h"
#include "loop_fixture.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/margins.h"
#include "nanotouch/plan.h"

static double between(nt_random *random, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(random));
}

/* -1, 1 or anything between. */
static double side(nt_random *random)
{
    const double drawn = 3.0 * nt_random_uniform(random);
    return drawn < 1.0 ? -1.0 : drawn < 2.0 ? 1.0 : 2.0 * nt_random_uniform(random) - 1.0;
}

/* Samples from gels to silicon; the force limit binds on hard ones, the limit of indentation on soft ones. */
static nt_session_setup draw(nt_random *random)
{
    nt_session_setup setup = nt_session_defaults();
    nt_rig *rig = &setup.rig;
    rig->probe.spring_constant = between(random, 0.1, 20.0);
    rig->probe.noise = rig->probe.temperature = 0.0;
    rig->probe.drift = rig->stage.drift = 1e-15;
    rig->probe.spring_constant_sigma = rig->probe.sensitivity_sigma = 0.0;
    rig->master.motor = 0; /* a hand that nothing holds back */
    rig->stage.travel_sigma = nt_random_uniform(random) < 0.2 ? 0.0 : 0.1 * nt_random_uniform(random);
    rig->stage.position_sigma = nt_random_uniform(random) < 0.2 ? 0.0 : 0.1 * nt_random_uniform(random);
    setup.scene.medium.relative_humidity = 0.0;
    setup.scene.adhesion.work_of_adhesion = setup.scene.adhesion.hamaker_constant = 0.0;
    setup.scene.sample.youngs_modulus = between(random, 1e6, 1e11);
    setup.settings = nt_settings_defaults(rig);
    setup.settings.limits.stage_speed = between(random, 1e-6, 50e-6);
    setup.settings.limits.force = between(random, 0.2, 0.9) * setup.settings.limits.force;
    setup.settings.limits.indentation = between(random, 2e-9, 100e-9);
    setup.settings.gains.rate = floor(between(random, 2e3, 2e4));
    setup.settings.gains.delay = floor(3.0 * nt_random_uniform(random));
    setup.clearance = 20e-9;
    setup.probe_model = NT_PROBE_QUASI_STATIC;
    return setup;
}

static void off_by(loop *l, nt_random *random)
{
    const nt_stage *stage = &l->touch.rig.stage;
    const double driven = 1.0 + 3.0 * stage->travel_sigma * side(random);
    const double read = 1.0 + 3.0 * stage->position_sigma * side(random);
    nt_faults faults = {0};
    assert_int_equal(nt_faults_add(&faults, &(nt_fault){NT_FAULT_GAIN, NT_CHANNEL_STAGE, 0.0, HUGE_VAL, driven}),
                     NT_OK);
    assert_int_equal(nt_faults_add(&faults, &(nt_fault){NT_FAULT_GAIN, NT_CHANNEL_STAGE_POSITION, 0.0, HUGE_VAL, read}),
                     NT_OK);
    l->sim.slave.link.faults = faults;
}

/* Pressed at any speed, far past the limit. */
static void press(loop *l, nt_random *random, double *force, double *indentation)
{
    assert_int_equal(nt_touch_arm(&l->state, 1), NT_OK);
    for (int way = 0; way < 4; ++way) {
        loop_push(l, between(random, 0.05, 5.0) * (way % 2 ? -1.0 : 1.0), between(random, 1e-3, 0.2));
        for (double t = 0.0; t < 0.4; t += l->touch.period) {
            assert_int_equal(loop_tick(l, NULL, NULL), NT_OK);
            *force = larger(*force, l->sim.slave.truth.peak_force);
            *indentation = larger(*indentation, -l->sim.slave.truth.deepest_gap);
        }
    }
}

/* NANOTOUCH_STAGE_SCENES of them. */
static void a_stage_that_is_off_breaks_no_promise(void **state)
{
    (void)state;
    const char *asked = getenv("NANOTOUCH_STAGE_SCENES");
    const int scenes = asked ? atoi(asked) : 60;
    nt_random random = nt_random_seed(23);
    int past_force = 0, past_depth = 0, opened = 0, limited = 0;
    double nearest_force = 0.0, nearest_depth = 0.0, over = 0.0;
    for (int i = 0; i < scenes; ++i) {
        static loop l;
        const nt_session_setup setup = draw(&random);
        if (loop_open(&l, &setup) != NT_OK)
            continue;
        ++opened;
        const nt_guarantee promised = promise(&l, 0.0);
        loop blind = l;
        blind.touch.rig.stage.travel_sigma = blind.touch.rig.stage.position_sigma = 0.0;
        const nt_guarantee without = promise(&blind, 0.0);
        off_by(&l, &random);
        double force = 0.0, indentation = 0.0;
        press(&l, &random, &force, &indentation);
        if (force > promised.force || indentation > promised.indentation)
            print_message("scene %d: %.4g of %.4g N, %.4g of %.4g m\n", i, force, promised.force, indentation,
                          promised.indentation);
        assert_true(force <= promised.force && indentation <= promised.indentation);
        nearest_force = larger(nearest_force, force / promised.force);
        nearest_depth = larger(nearest_depth, indentation / promised.indentation);
        over = larger(over, larger(force / without.force, indentation / without.indentation));
        past_force += force > without.force;
        past_depth += indentation > without.indentation;
        limited += (l.command.reasons & (NT_REASON_FORCE_LIMIT | NT_REASON_INDENTATION)) != 0;
    }
    print_message(
        "%d scenes, %d stopped at a limit: force at most %.2f of the promise, indentation %.2f; without the sigmas "
        "%d and %d would have been past it, by up to %.2f times\n",
        opened, limited, nearest_force, nearest_depth, past_force, past_depth, over);
    assert_true(opened > scenes / 2 && nearest_force > 0.2 && nearest_depth > 0.2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_stage_that_is_off_breaks_no_promise)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
