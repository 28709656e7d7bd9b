/* SPDX-License-Identifier: BSD-3-Clause
 * The simulated halves keep the contract that real ones have to keep. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "host_fixture.h"
#include "nanotouch/advanced/sim.h"

static void rehearse(nt_half half, void *context, const nt_sim_setup *setup)
{
    const nt_backend *backend = half == NT_HALF_MASTER ? nt_sim_master_backend() : nt_sim_slave_backend();
    const nt_rehearsal rehearsal = {.half = half,
                                    .choice = {backend, context},
                                    .host = &host,
                                    .configuration = {sizeof(nt_configuration), 0, setup->period, 1e-6, ""},
                                    .periods = 500,
                                    .pass = pass};
    nt_problem problem = {0};
    nt_rehearsed seen;
    const nt_status status = nt_hal_rehearse(&rehearsal, &seen, &problem);
    if (status != NT_OK)
        fail_msg("half %d: status %d, %s = %g", (int)half, (int)status, problem.field, problem.value);
    const double own = seen.capabilities.period > 0.0 ? seen.capabilities.period : setup->period;
    assert_true(fabs((double)seen.readings - 1000.0 * setup->period / own) <= 2.0);
}

static void both_halves_keep_it(const nt_rig *rig)
{
    const nt_scene scene = nt_scene_defaults();
    const nt_demand demand = nt_demand_defaults();
    const nt_plan_inputs inputs = {.scene = &scene, .demand = &demand};
    static nt_plan plan;
    assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
    const nt_sim_setup setup = {.plan = &plan, .rig = rig, .period = 1e-4, .clearance = 1e-7, .seed = 1};
    static nt_sim sim;
    assert_int_equal(nt_sim_init(&sim, &setup), NT_OK);
    rehearse(NT_HALF_MASTER, &sim.master, &setup);
    rehearse(NT_HALF_SLAVE, &sim.slave, &setup);
}

static void three_axes_at_their_own_rate(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    rig.master.axes = 3.0;
    rig.master.rate = 125.0;
    both_halves_keep_it(&rig);
}

static void three_axes_and_slow_converters(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    rig.master.axes = 3.0;
    rig.converters.adc_latency = 1.5e-4;
    both_halves_keep_it(&rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_axes_at_their_own_rate),
        cmocka_unit_test(three_axes_and_slow_converters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
