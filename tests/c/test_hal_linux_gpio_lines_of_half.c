/* SPDX-License-Identifier: BSD-3-Clause
 * A slave on converters with its lines on GPIO: the stop button reaches the reading, the watchdog beats once a write,
 * the laser is on while it is armed, and a chip that is pulled out is an emergency. */
#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
/* after what it needs */
#include <cmocka.h>

#include "converter_rig.h"
#include "fake_gpiod.h"
#include "hal/linux/hal_linux.h"
#include "host_fixture.h"
#include "nanotouch/advanced/hal_linux.h"

static fake_line *const stop_line = &fake_chips[0].lines[0], *const limit_line = &fake_chips[0].lines[1];
static fake_line *const laser_line = &fake_chips[1].lines[0], *const dog_line = &fake_chips[1].lines[1];
static fake_line *const convert_line = &fake_chips[1].lines[2];
static simulated_bus bus;
static nt_converter_half half;
static nt_hal hal;
static nt_gpio *gpio;

static int setup(void **state)
{
    (void)state;
    const nt_gpio_wiring wiring = {"estop", "limit", "laser-en", "watchdog", "convert", 2e-3};
    fake_chips[0] = (fake_chip){
        .number = 0, .line_count = 2, .lines = {{.name = "estop", .level = 1}, {.name = "limit", .level = 1}}};
    fake_chips[1] = (fake_chip){
        .number = 1,
        .line_count = 3,
        .lines = {{.name = "laser-en", .level = 1}, {.name = "watchdog", .level = 1}, {.name = "convert", .level = 1}}};
    bus = simulated_bus_after_power_up();
    nt_converter_setup made = slave_setup(&bus, 0);
    if (nt_gpio_open(&wiring, NULL, 0, &gpio) != NT_OK)
        return 1;
    made.lines = nt_gpio_lines(gpio);
    const nt_hal_choice choice = {nt_converter_half_backend(NT_HALF_SLAVE), &half};
    return nt_converter_half_init(&half, &made, NULL) != NT_OK ||
           nt_hal_open(&hal, NT_HALF_SLAVE, &choice, &host, NULL) != NT_OK;
}

static int teardown(void **state)
{
    (void)state;
    nt_hal_close(&hal);
    nt_gpio_close(gpio);
    return fake_handles;
}

static uint32_t flags(void)
{
    pass(&host, 1e-3);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    return hal.reading.flags;
}

static void laser_and_watchdog_follow_the_life(void **state)
{
    (void)state;
    assert_true(laser_line->level == 0 && dog_line->level == 0 && convert_line->level == 0); /* low once requested */
    assert_true(limit_line->debounce == 2000 && stop_line->debounce == 0);
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
    assert_int_equal(laser_line->level, 1);
    const long before = dog_line->edges;
    for (int i = 0; i < 11; ++i) {
        const nt_action action = {.size = sizeof action};
        assert_int_equal(flags(), 0);
        assert_int_equal(nt_hal_write(&hal, &action), NT_OK);
    }
    assert_int_equal(dog_line->edges - before, 11);
    assert_int_equal(convert_line->edges, 22); /* up and down */
    assert_int_equal(convert_line->level, 0);
    nt_hal_disarm(&hal);
    assert_int_equal(laser_line->level, 0);
    assert_int_equal(dog_line->edges - before, 11); /* no loop, no beat */
}

static void lines_reach_the_reading(void **state)
{
    (void)state;
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
    assert_int_equal(flags(), 0);
    fake_edge(stop_line, 0, 0);
    fake_edge(stop_line, 1, 0); /* pressed for less than a period */
    assert_int_equal(flags(), NT_SAMPLE_EMERGENCY_STOP);
    assert_int_equal(flags(), 0);
    limit_line->level = 0;
    assert_int_equal(flags(), NT_SAMPLE_LIMIT_SWITCH);
    assert_true(hal.reading.valid != 0);
    limit_line->level = 1;
    stop_line->gone = 1; /* the chip is pulled out: pressed, and for good */
    assert_int_equal(flags(), NT_SAMPLE_EMERGENCY_STOP);
    stop_line->gone = 0;
    assert_int_equal(flags(), NT_SAMPLE_EMERGENCY_STOP);
}

static void a_lost_laser_line_does_not_arm(void **state)
{
    (void)state;
    nt_gpio_state seen;
    laser_line->gone = 1;
    assert_int_equal(nt_hal_arm(&hal), NT_E_DEVICE);
    dog_line->gone = 1;
    assert_int_equal(nt_gpio_beat(gpio), NT_E_DEVICE);
    assert_int_equal(nt_gpio_read(gpio, &seen), NT_OK);
    assert_true(seen.lost_outputs >= 2);
}

static void what_is_not_wired_is_left_alone(void **state)
{
    (void)state;
    const nt_gpio_wiring late = {.emergency_stop = "estop", .debounce = 0.2}, stop_only = {.emergency_stop = "estop"};
    char reason[160];
    nt_gpio *second = NULL;
    assert_int_equal(nt_gpio_open(&late, reason, sizeof reason, &second), NT_E_RANGE);
    assert_non_null(strstr(reason, "0.2 s: valid is 0 .. 0.1 s"));
    nt_gpio_close(gpio);
    gpio = NULL;
    assert_int_equal(nt_gpio_open(&stop_only, NULL, 0, &gpio), NT_OK);
    assert_int_equal(nt_gpio_beat(gpio), NT_E_STATE);
    assert_int_equal(nt_gpio_convert(gpio), NT_E_STATE);
    half.setup.lines = nt_gpio_lines(gpio);
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
    assert_int_equal(flags(), 0);
    assert_int_equal(nt_gpio_beat(NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_gpio_convert(NULL), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(laser_and_watchdog_follow_the_life, setup, teardown),
        cmocka_unit_test_setup_teardown(lines_reach_the_reading, setup, teardown),
        cmocka_unit_test_setup_teardown(a_lost_laser_line_does_not_arm, setup, teardown),
        cmocka_unit_test_setup_teardown(what_is_not_wired_is_left_alone, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
