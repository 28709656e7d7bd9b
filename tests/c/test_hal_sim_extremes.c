/* SPDX-License-Identifier: BSD-3-Clause
 * The simulated rig at the ends of its ranges: no divergence, no number that is none, and refusals by name. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "larger.h"
#include "nanotouch/advanced/sim.h"

static nt_plan plan;

static int make_plan(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    const nt_plan_inputs inputs = {.scene = &scene};
    return nt_plan_make(&plan, &inputs, NULL) != NT_OK;
}

/* In and out of contact with the hand pushing at random; everything has to stay a number, and inside what the energy
 * allows: the stage within twice its travel, the probe within the reach of the stage and twice the pull of the surface.
 */
static void shake(const nt_rig *rig, nt_probe_model model, double period, int ticks)
{
    const nt_sim_setup setup = {.plan = &plan,
                                .rig = rig,
                                .period = period,
                                .clearance = 5e-9,
                                .seed = 3,
                                .delay = 1.3,
                                .probe_model = model,
                                .substep = 2.0};
    static nt_sim sim;
    assert_int_equal(nt_sim_init(&sim, &setup), NT_OK);
    const double half = 0.5 * rig->stage.travel;
    double reach = 0.0;
    for (int i = 0; i < ticks; i++) {
        nt_sample sample;
        assert_int_equal(nt_sim_read(&sim, &sample), NT_OK);
        const double wave = sin(0.05 * i);
        const nt_command command = {.motor_force[NT_Z] = 3.0 * wave,
                                    .stage_position[NT_Z] = smaller(half, 20e-9) * wave};
        assert_int_equal(nt_sim_write(&sim, &command), NT_OK);
        assert_true(isfinite(sample.deflection[NT_Z]) && isfinite(sample.stage_position[NT_Z]) &&
                    isfinite(sample.master_position[NT_Z]));
        assert_true(isfinite(sim.slave.truth.tip_force[NT_Z]) && isfinite(sim.slave.cantilever.speed) &&
                    isfinite(sim.slave.stage.speed));
        assert_true(fabs(sim.slave.stage.position) <= 2.0 * rig->stage.travel);
        reach = larger(reach, fabs(sim.slave.stage.position));
        const double pull = 2.0 * plan.pull_off_force / rig->probe.spring_constant;
        assert_true(fabs(sim.slave.cantilever.deflection) < 3.0 * (reach + pull + 10e-9));
    }
}

static nt_rig quiet_rig(void)
{
    nt_rig rig = nt_rig_defaults();
    rig.probe.temperature = 0.0; /* the thermal motion of a soft lever is larger than its reach here */
    rig.hand.random_force = 5.0;
    rig.hand.random_rate = 100.0;
    return rig;
}

static const double periods[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}; /* 100 Hz .. 1 MHz */

static void every_rate_and_stage_step(void **state)
{
    (void)state;
    for (int p = 0; p < 5; p++)
        for (double step = 0.0; step <= 100e-9; step = step > 0.0 ? 10.0 * step : 1e-10) {
            nt_rig rig = quiet_rig();
            rig.stage.resolution = rig.stage.command_resolution = step;
            rig.stage.hysteresis = p % 2 ? 0.3 : 0.0;
            rig.stage.creep = 0.05;
            rig.master.friction = 0.3;
            rig.hand.mass = rig.hand.damping = 0.1;
            rig.hand.stiffness = 2000.0;
            shake(&rig, NT_PROBE_QUASI_STATIC, periods[p], 2000);
        }
}

/* k_i/k_c from far below 1e-6 (air) to 1e6, Q to 1e6, of probe and stage. */
static void every_stiffness_and_quality(void **state)
{
    (void)state;
    for (double spring = 1e-3; spring < 2e3; spring *= 10.0)
        for (double quality = 0.5; quality < 2e6; quality *= 1e3) {
            nt_rig rig = quiet_rig();
            rig.probe.spring_constant = spring;
            rig.probe.quality = quality;
            rig.stage.quality = quality;
            rig.stage.stiffness = 1e3; /* as soft as the stiffest lever */
            for (int p = 1; p < 5; p++)
                shake(&rig, NT_PROBE_DYNAMIC, periods[p], p < 3 ? 10 : 100);
            shake(&rig, NT_PROBE_QUASI_STATIC, 1e-4, 1000);
        }
}

/* Converters of 1 to 32 bits, of any rate and latency. */
static void every_converter(void **state)
{
    (void)state;
    for (double bits = 1.0; bits < 33.0; bits += 7.0)
        for (double rate = 1.0; rate < 1e7; rate *= 30.0) {
            nt_rig rig = quiet_rig();
            rig.converters = (nt_converters){bits, rate, 1.37e-4, bits, 0.71e-4};
            shake(&rig, NT_PROBE_QUASI_STATIC, 1e-4, 300);
        }
}

/* Row 30 of the fault table: every number of the rig, below, above, and not a number. */
static void nonsense_is_refused(void **state)
{
    (void)state;
    int count = 0;
    const nt_field *fields = nt_rig_fields(&count);
    for (int i = 0; i < count; i++) {
        const double bad[] = {fields[i].minimum - 1.0, 2.0 * fields[i].maximum + 1.0, (double)NAN, HUGE_VAL};
        for (int k = 0; k < 4; k++) {
            nt_rig rig = nt_rig_defaults();
            static nt_sim sim;
            nt_field_set(&fields[i], &rig, bad[k]);
            const nt_sim_setup setup = {.plan = &plan, .rig = &rig, .period = 1e-4, .clearance = 5e-9};
            const int is_choice = fields[i].size != sizeof(double);
            assert_int_equal(nt_sim_init(&sim, &setup), k < 2 || is_choice ? NT_E_RANGE : NT_E_NOT_FINITE);
        }
    }
}

/* Row 31: rigs at the ends of their own ranges; each runs or is refused. */
static void ends_of_the_ranges_run_or_are_refused(void **state)
{
    (void)state;
    int count = 0, ran = 0;
    const nt_field *fields = nt_rig_fields(&count);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) {
            nt_rig rig = nt_rig_defaults();
            static nt_sim sim;
            nt_field_set(&fields[i], &rig, k ? fields[i].maximum : fields[i].minimum);
            const nt_sim_setup setup = {.plan = &plan, .rig = &rig, .period = 1e-4, .clearance = 5e-9};
            if (nt_sim_init(&sim, &setup) != NT_OK)
                continue;
            ran++;
            for (int tick = 0; tick < 50; tick++) {
                nt_sample sample;
                const nt_command command = {.motor_force[NT_Z] = 1.0, .stage_position[NT_Z] = 1e-10 * tick};
                assert_int_equal(nt_sim_read(&sim, &sample), NT_OK);
                assert_int_equal(nt_sim_write(&sim, &command), NT_OK);
                assert_true(isfinite(sim.slave.truth.tip_force[NT_Z]) && isfinite(sim.slave.stage.position) &&
                            isfinite(sim.master.arm[NT_Z].position));
            }
        }
    assert_true(ran > 3 * count / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_rate_and_stage_step),
        cmocka_unit_test(every_stiffness_and_quality),
        cmocka_unit_test(every_converter),
        cmocka_unit_test(nonsense_is_refused),
        cmocka_unit_test(ends_of_the_ranges_run_or_are_refused),
    };
    return cmocka_run_group_tests(tests, make_plan, NULL);
}
