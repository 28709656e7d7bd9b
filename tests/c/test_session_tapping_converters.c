/* SPDX-License-Identifier: BSD-3-Clause
 * A lever that taps through the real drivers: touch step, half on converters, spidev's driver on a model of the kernel,
 * modelled chips (tapping_rig.h). A line over a wave, tick by tick, is that of the simulated slave alone, within the
 * converters' steps. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "conformance.h"
#include "spidev_calls.h"
#include "spidev_model.h"
#include "tapping_rig.h"

static spidev_model model[2];

static int control_call(void *context, int file, unsigned long request, void *argument)
{
    (void)context;
    return model_request(&model[file], (unsigned)request, argument, copy_bytes, NULL);
}

static void open_bus(void)
{
    const nt_spi_calls calls = {open_call, control_call, close_call, NULL};
    const nt_spi_device devices[] = {{"0", 1, 10e6}, {"1", 2, 10e6}};
    for (int i = 0; i < 2; ++i)
        model[i] = (spidev_model){.bus = &bus, .chip = i};
    assert_int_equal(nt_spi_open(&spi, devices, 2, &calls, NULL), NT_OK);
    const nt_converter_setup setup = tapping_half(&spi);
    nt_problem problem = {0};
    if (nt_converter_half_init(&half, &setup, &problem) != NT_OK)
        fail_msg("%s = %g", problem.field, problem.value);
}

static void a_line_is_that_of_the_simulated_slave(void **state)
{
    (void)state;
    static line alone, through;
    begin_to_play();
    const nt_hal_choice simulated = {nt_sim_slave_backend(), &played};
    take(&simulated, &alone, TICKS);
    nt_terrain_close(terrain);
    begin_to_play();
    open_bus();
    const nt_hal_choice converters = {nt_converter_half_backend(NT_HALF_SLAVE), &half};
    take(&converters, &through, TICKS);
    nt_spi_close(&spi);
    nt_terrain_close(terrain);
    assert_int_equal(alone.state, NT_RUN);
    assert_int_equal(through.state, NT_RUN);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = DOWN; i < TICKS; ++i) {
        low = smaller(low, alone.height[i]);
        high = larger(high, alone.height[i]);
    }
    assert_true(high - low > 18e-9 && high - low < 22e-9); /* the wave is 20 nm high */
    const double steps = steps_of_height();
    const double height = apart(alone.height, through.height, DOWN, TICKS);
    const double amplitude = apart(alone.amplitude, through.amplitude, DOWN, TICKS);
    print_message("a line of %.1f nm: heights within %.3f nm, amplitude %.3f nm, lag %.2g rad; steps %.3f nm\n",
                  1e9 * (high - low), 1e9 * height, 1e9 * amplitude, apart(alone.lag, through.lag, DOWN, TICKS),
                  1e9 * steps);
    assert_true(height <= 2.0 * steps);
    assert_true(amplitude <= 2.0 * steps);
    assert_int_equal(half.counts.mismatched + half.counts.failed, 0);
    assert_true(codes[2] <= LOWEST);                 /* the drive is off when the half is closed ... */
    assert_true(fabs(output(3) - FREQUENCY) < 10.0); /* ... at the frequency that it had */
}

/* --- what fails, tick by tick --- */

static void the_drive_falls_silent(void **state)
{
    (void)state;
    static line taken;
    begin_to_play();
    open_bus();
    is_deaf_to_drive = 1; /* from the beginning: the amplitude never comes */
    const nt_hal_choice converters = {nt_converter_half_backend(NT_HALF_SLAVE), &half};
    take(&converters, &taken, TICKS);
    nt_spi_close(&spi);
    nt_terrain_close(terrain);
    assert_int_equal(taken.state, NT_LATCHED);
    for (int i = 0; i < TICKS; ++i)
        assert_true(taken.height[i] > -2e-9); /* it goes up only, but for the steps */
}

/* --- the rules of a half --- */

static bus_fault silence_is;

static void silence(void *device, int on)
{
    (void)device;
    bus.fault = on ? silence_is : BUS_WELL;
}
static void lose(void *device)
{
    (void)device;
    bus.fault = BUS_GONE;
}
static double left_at(void *device)
{
    (void)device;
    return output(1);
}

static void the_half_conforms(void **state)
{
    (void)state;
    static const char *const silences[] = {"well", "0", "1", "short", "refusing"};
    for (int fault = BUS_ALL_ZERO; fault <= BUS_REFUSED; ++fault) {
        begin_to_play();
        is_at_once = 1;
        open_bus();
        nt_converter_setup setup = tapping_half(&spi);
        setup.exchange = bus_exchange; /* one that is told of a short frame */
        setup.bus = &bus;
        assert_int_equal(nt_converter_half_init(&half, &setup, NULL), NT_OK);
        const conformance c = {.half = NT_HALF_SLAVE,
                               .choice = {nt_converter_half_backend(NT_HALF_SLAVE), &half},
                               .host = &host,
                               .configuration = {sizeof(nt_configuration), 0, PERIOD, 1e-7, ""},
                               .periods = 100,
                               .pass = pass,
                               .silence = silence,
                               .lose = lose,
                               .left_at = left_at,
                               .slack = 1e-10};
        silence_is = (bus_fault)fault;
        char name[80];
        (void)snprintf(name, sizeof name, "converters with a lock-in amplifier, bus at %s", silences[fault]);
        const char *rule = conform(name, &c);
        if (rule)
            fail_msg("%s: %s", name, rule);
        nt_spi_close(&spi);
        nt_terrain_close(terrain);
    }
}

/* --- what is refused --- */

static void setups_are_checked(void **state)
{
    (void)state;
    nt_problem problem = {0};
    nt_converter_setup setup = tapping_half(NULL);
    assert_int_equal(nt_converter_setup_check(&setup, &problem), NT_OK);
    setup.lock_in[NT_LOCK_IN_LAG].is_used = 0;
    assert_int_equal(nt_converter_setup_check(&setup, &problem), NT_E_RANGE);
    assert_non_null(strstr(problem.field, "amplitude and lag"));
    setup.lock_in[NT_LOCK_IN_AMPLITUDE].is_used = 0;
    assert_int_equal(nt_converter_setup_check(&setup, &problem), NT_E_RANGE); /* a drive that nobody listens to */
    setup = tapping_half(NULL);
    setup.driven[NT_DRIVES_AMPLITUDE].minimum = 1e-9; /* never off */
    assert_int_equal(nt_converter_setup_check(&setup, &problem), NT_E_RANGE);
    assert_non_null(strstr(problem.field, "drive amplitude"));
    setup = tapping_half(NULL);
    setup.lock_in[NT_LOCK_IN_LAG].converter = 0; /* a DAC */
    assert_int_equal(nt_converter_setup_check(&setup, &problem), NT_E_RANGE);
    setup = tapping_half(NULL);
    setup.half = NT_HALF_MASTER;
    assert_int_equal(nt_converter_setup_check(&setup, &problem), NT_E_RANGE);
}

static void a_drive_that_is_no_number_is_not_driven(void **state)
{
    (void)state;
    nt_hal hal;
    begin_to_play();
    open_bus();
    const nt_hal_choice choice = {nt_converter_half_backend(NT_HALF_SLAVE), &half};
    const nt_configuration configuration = {sizeof configuration, 0, PERIOD, 1e-7, ""};
    assert_int_equal(nt_hal_open(&hal, NT_HALF_SLAVE, &choice, &host, NULL), NT_OK);
    assert_int_equal(nt_hal_configure(&hal, &configuration, NULL), NT_OK);
    codes[2] = 1000u; /* another program has left it on */
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
    assert_true(codes[2] <= LOWEST);
    const uint32_t before = codes[1];
    nt_action action = {.size = sizeof action, .target = {0.1e-6, 0.0, 0.1e-6}, .drive_amplitude = (double)NAN};
    assert_int_equal(hal.backend->write(hal.context, &action), NT_E_NOT_FINITE);
    assert_int_equal(codes[1], before);
    action.drive_amplitude = A0;
    action.drive_frequency = HUGE_VAL;
    assert_int_equal(hal.backend->write(hal.context, &action), NT_E_NOT_FINITE);
    assert_int_equal(codes[1], before);
    nt_hal_close(&hal);
    nt_spi_close(&spi);
    nt_terrain_close(terrain);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_is_that_of_the_simulated_slave),
        cmocka_unit_test(the_drive_falls_silent),
        cmocka_unit_test(the_half_conforms),
        cmocka_unit_test(setups_are_checked),
        cmocka_unit_test(a_drive_that_is_no_number_is_not_driven),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
