/* SPDX-License-Identifier: BSD-3-Clause
 * A sensor that shows no noise while the stage moves is dead; how much it shows is learnt from its first samples. */
#include "internal/control.h"
#include "larger.h"
#include "supervisor_fixture.h"

/* Ticks to each reaction, as printed in docs/evidence/safety.md. */
static int ticks_until(input *in, nt_state wanted, double stage_speed)
{
    for (int tick = 1; tick < 100000; tick++) {
        in->sample.stage_position[NT_Z] += stage_speed * touch.period;
        in->reference += stage_speed * touch.period;
        if (step(in) >= wanted)
            return tick;
    }
    return 0;
}

static void a_stuck_sensor_is_found_while_z_moves(void **unused)
{
    (void)unused;
    input in = healthy(NT_RUN);
    assert_int_equal(ticks_until(&in, NT_HOLD, 1e-6), 51); /* the first one is new, then 50 alike */
    assert_int_equal(ticks_until(&in, NT_LATCHED, 0.0), 50);
    /* long still before it moves: HOLD comes first all the same */
    in = healthy(NT_RUN);
    assert_int_equal(ticks_until(&in, NT_HOLD, 0.0), 0);      /* at rest nobody can tell */
    assert_in_range(ticks_until(&in, NT_HOLD, 1e-6), 50, 52); /* 5 nm */
    assert_int_equal(in.history.state, NT_HOLD);
    /* a sensor whose noise is known: a quarter of that is no sign of life, more is */
    in.history.deflection.noise_samples = 200;
    in.history.deflection.band = 70e-12;
    in.sample.deflection[NT_Z] += 60e-12;
    assert_int_equal(step(&in), NT_HOLD);
    in.sample.deflection[NT_Z] += 20e-12;
    assert_int_equal(step(&in), NT_RUN);
}

/* A reading that has died at the set point of a height servo: z stands still, a scan goes on over the slopes. */
static void a_stuck_sensor_is_found_while_a_scan_goes_on(void **unused)
{
    (void)unused;
    for (int axis = NT_X; axis <= NT_Y; axis++) {
        input in = healthy(NT_RUN);
        int tick = 0;
        while (tick < 1000 && step(&in) < NT_HOLD) {
            in.sample.stage_position[axis] += 1e-6 * touch.period;
            tick++;
        }
        assert_in_range(tick, 50, 51);
        while (tick < 1000 && step(&in) < NT_LATCHED)
            tick++;
        assert_in_range(tick, 98, 101);
        assert_int_equal(in.history.reasons & NT_REASON_STUCK, NT_REASON_STUCK);
    }
}

/* The noise is that of the quietest of the first blocks, and no more than is declared. */
static void the_supervisor_learns_the_noise(void **unused)
{
    (void)unused;
    static const double steps[][2] = {{1e-12, 1e-12}, {100e-12, 100e-12}, {50e-9, 100e-12}, {30e-9, 30e-9}};
    for (int i = 0; i < 4; i++) {
        input in = healthy(NT_RUN);
        for (int tick = 0; tick < 200; tick++) {
            assert_true(in.history.deflection.band == 0.0);
            in.sample.deflection[NT_Z] = 1e-9 + steps[i][tick >= 149] * (tick % 2);
            assert_int_equal(step(&in), NT_RUN);
        }
        const double declared = touch.rig.probe.sensitivity * touch.rig.probe.noise / 6.0;
        const double wanted = 0.25 * smaller(declared, steps[i][1] / 1.128379);
        assert_true(fabs(in.history.deflection.band / wanted - 1.0) < 0.03);
        assert_int_equal(nt_supervisor_arm(&in.history, 1), NT_OK);
        assert_true(fabs(in.history.deflection.band / wanted - 1.0) < 0.03);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stuck_sensor_is_found_while_z_moves),
        cmocka_unit_test(a_stuck_sensor_is_found_while_a_scan_goes_on),
        cmocka_unit_test(the_supervisor_learns_the_noise),
    };
    return cmocka_run_group_tests(tests, make_touch, NULL);
}
