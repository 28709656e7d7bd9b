/* SPDX-License-Identifier: BSD-3-Clause
 * A lever that taps, through spidev and the GPIO lines of the test kernel, beside the simulated slave alone: down to
 * the sample and along a wave. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "kernel_bus.h"
#include "kernel_tapping.h"
#include "nanotouch/advanced/hal_linux.h"
#include "tapping_rig.h"

enum { WAY = DOWN + 600 }; /* ticks: down, and 40 nm along the wave */

void tapping_is_the_simulated_one(void **state)
{
    kernel_bus *chips = *state;
    static line alone, through;
    begin_to_play();
    const nt_hal_choice simulated = {nt_sim_slave_backend(), &played};
    take(&simulated, &alone, WAY);
    nt_terrain_close(terrain);
    begin_to_play();
    chips->bus = bus;
    const nt_spi_device devices[] = {{"/dev/spidev0.0", 1, 10e6}, {"/dev/spidev0.1", 2, 10e6}};
    const nt_gpio_wiring wiring = {"estop", "limit", "laser-en", "watchdog", NULL, 0.0};
    char reason[NT_SPI_REASON] = "";
    nt_gpio *gpio = NULL;
    if (nt_spi_open(&spi, devices, 2, NULL, reason) != NT_OK ||
        nt_gpio_open(&wiring, reason, sizeof reason, &gpio) != NT_OK)
        fail_msg("%s", reason);
    pull_line("estop", 1); /* closed switches: a request's own pull-down is all that gpio-sim has until then */
    pull_line("limit", 1);
    nt_converter_setup setup = tapping_half(&spi);
    setup.lines = nt_gpio_lines(gpio);
    assert_int_equal(nt_converter_half_init(&half, &setup, NULL), NT_OK);
    const nt_hal_choice converters = {nt_converter_half_backend(NT_HALF_SLAVE), &half};
    take(&converters, &through, WAY);
    nt_spi_close(&spi);
    nt_gpio_close(gpio);
    nt_terrain_close(terrain);
    chips->bus = simulated_bus_after_power_up();
    const double heights = apart(alone.height, through.height, 0, WAY),
                 amplitudes = apart(alone.amplitude, through.amplitude, 0, WAY);
    print_message("tapping, %d ticks: heights within %.3f nm, amplitudes within %.3f nm of the simulated slave (steps: "
                  "%.3f nm)\n",
                  WAY, 1e9 * heights, 1e9 * amplitudes, 2e9 * steps_of_height());
    assert_int_equal(alone.state, NT_RUN);
    assert_int_equal(through.state, NT_RUN);
    assert_int_equal(chips->wrong_mode, 0);
    assert_true(through.amplitude[WAY - 1] < 15e-9); /* it taps */
    assert_true(fabs(through.height[WAY - 1] - through.height[DOWN]) > 1e-9);
    assert_true(heights <= 2.0 * steps_of_height() && amplitudes <= 2.0 * steps_of_height());
}
