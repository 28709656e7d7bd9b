/* SPDX-License-Identifier: BSD-3-Clause
 * The same tip on its way down with the kernel's own system calls, on files that answer spidev's requests
 * (fuse_spidev.h). Where FUSE may not be used it is left out, and says so. */
#define _GNU_SOURCE
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fuse_spidev.h"
#include "tapping_rig.h"

enum { WAY = 1200 }; /* ticks, in which the tip comes down and taps */

static fuse_spidev files;
static const char *why_not;

static void the_way_down_is_that_of_the_simulated_slave(void **state)
{
    (void)state;
    static line alone, through;
    if (why_not) {
        print_message("left out: %s\n", why_not);
        skip();
    }
    begin_to_play();
    const nt_hal_choice simulated = {nt_sim_slave_backend(), &played};
    take(&simulated, &alone, WAY);
    nt_terrain_close(terrain);
    begin_to_play();
    const nt_spi_device devices[] = {{files.path[0], 1, 10e6}, {files.path[1], 2, 10e6}};
    assert_int_equal(nt_spi_open(&spi, devices, 2, NULL, NULL), NT_OK);
    const nt_converter_setup setup = tapping_half(&spi);
    assert_int_equal(nt_converter_half_init(&half, &setup, NULL), NT_OK);
    const nt_hal_choice converters = {nt_converter_half_backend(NT_HALF_SLAVE), &half};
    take(&converters, &through, WAY);
    nt_spi_close(&spi);
    nt_terrain_close(terrain);
    assert_int_equal(alone.state, NT_RUN);
    assert_int_equal(through.state, NT_RUN);
    assert_true(alone.amplitude[WAY - 1] < 15e-9); /* it taps */
    assert_true(apart(alone.height, through.height, 0, WAY) <= 2.0 * steps_of_height());
    assert_true(apart(alone.amplitude, through.amplitude, 0, WAY) <= 2.0 * steps_of_height());
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_way_down_is_that_of_the_simulated_slave)};
    why_not = fuse_start(&files, &bus);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    if (!why_not)
        fuse_end(&files);
    return failed;
}
