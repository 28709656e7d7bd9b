/* SPDX-License-Identifier: BSD-3-Clause */
#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
/* after what it needs */
#include <cmocka.h>

#include "fake_gpiod.h"
#include "hal/linux/hal_linux.h"
#include "nanotouch/advanced/hal_linux.h"
#include "nanotouch/types.h"

static fake_line *const stop_line = &fake_chips[0].lines[1];
static fake_line *const limit_line = &fake_chips[1].lines[0];
static fake_line *const laser_line = &fake_chips[1].lines[1];
static char reason[160];

/* All wired, all well: inputs high, the laser line left high by whoever had it before. */
static int setup(void **state)
{
    (void)state;
    fake_chips[0] = (fake_chip){.number = 0, .line_count = 2, .lines = {{.name = NULL}, {.name = "estop", .level = 1}}};
    fake_chips[1] = (fake_chip){
        .number = 7, .line_count = 2, .lines = {{.name = "limit", .level = 1}, {.name = "laser-en", .level = 1}}};
    strcpy(reason, "-");
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    return fake_handles;
}

static nt_gpio *open_all(void)
{
    const nt_gpio_wiring wiring = nt_gpio_wiring_defaults();
    nt_gpio *gpio = NULL;
    assert_int_equal(nt_gpio_open(&wiring, reason, sizeof reason, &gpio), NT_OK);
    return gpio;
}

static uint32_t flags_of(nt_gpio *gpio)
{
    nt_gpio_state state = {0};
    assert_int_equal(nt_gpio_read(gpio, &state), NT_OK);
    return state.flags;
}

static void open_is_safe_and_close_gives_back(void **unused)
{
    (void)unused;
    nt_gpio *gpio = open_all();
    assert_true(stop_line->requested && limit_line->requested && laser_line->requested);
    assert_true(stop_line->pulled_down && limit_line->pulled_down && !stop_line->is_output);
    assert_true(laser_line->is_output);
    assert_int_equal(laser_line->level, 0);
    assert_int_equal(flags_of(gpio), 0);
    assert_int_equal(nt_gpio_laser(gpio, 1), NT_OK);
    assert_int_equal(laser_line->level, 1);
    nt_gpio_close(gpio);
    assert_int_equal(laser_line->level, 0);
    assert_false(stop_line->requested || limit_line->requested || laser_line->requested);
    nt_gpio_close(NULL);
}

static void levels_are_read_fail_safe(void **unused)
{
    (void)unused;
    nt_gpio *gpio = open_all();
    stop_line->level = 0; /* a wire cut before anybody looked: low without an edge */
    assert_int_equal(flags_of(gpio), NT_SAMPLE_EMERGENCY_STOP);
    stop_line->level = 1;
    limit_line->level = 0;
    assert_int_equal(flags_of(gpio), NT_SAMPLE_LIMIT_SWITCH);
    nt_gpio_close(gpio);
}

static void short_press_is_seen_once(void **unused)
{
    (void)unused;
    nt_gpio *gpio = open_all();
    fake_edge(stop_line, 0, 0);
    fake_edge(stop_line, 1, 0);
    assert_int_equal(flags_of(gpio), NT_SAMPLE_EMERGENCY_STOP);
    assert_int_equal(flags_of(gpio), 0);
    nt_gpio_close(gpio);
}

static void lost_edge_counts_as_pressed(void **unused)
{
    (void)unused;
    nt_gpio *gpio = open_all();
    nt_gpio_state state = {0};
    fake_edge(stop_line, 0, 1);
    fake_edge(stop_line, 1, 0); /* only the release arrives, as number 2 */
    assert_int_equal(nt_gpio_read(gpio, &state), NT_OK);
    assert_int_equal(state.flags, NT_SAMPLE_EMERGENCY_STOP);
    assert_int_equal(state.lost_events, 1);
    assert_int_equal(nt_gpio_read(gpio, &state), NT_OK);
    assert_int_equal(state.flags, 0);
    assert_int_equal(state.lost_events, 1);
    nt_gpio_close(gpio);
}

static void lost_chip_is_an_emergency_for_good(void **unused)
{
    (void)unused;
    nt_gpio *gpio = open_all();
    nt_gpio_state state = {0};
    stop_line->gone = 1;
    assert_int_equal(nt_gpio_read(gpio, &state), NT_E_DEVICE);
    assert_int_equal(state.flags, NT_SAMPLE_EMERGENCY_STOP);
    stop_line->gone = 0; /* it comes back: still not to be trusted */
    state.flags = 0;
    assert_int_equal(nt_gpio_read(gpio, &state), NT_E_DEVICE);
    assert_int_equal(state.flags, NT_SAMPLE_EMERGENCY_STOP);
    laser_line->gone = 1;
    assert_int_equal(nt_gpio_laser(gpio, 1), NT_E_DEVICE);
    nt_gpio_close(gpio);
}

static void unwired_lines_are_left_alone(void **unused)
{
    (void)unused;
    const nt_gpio_wiring stop_only = {.emergency_stop = "estop"}, nothing = {.limit_switch = "limit"};
    nt_gpio *gpio = NULL;
    assert_int_equal(nt_gpio_open(&stop_only, reason, sizeof reason, &gpio), NT_OK);
    assert_false(limit_line->requested || laser_line->requested);
    limit_line->level = 0;
    assert_int_equal(flags_of(gpio), 0);
    assert_int_equal(nt_gpio_laser(gpio, 1), NT_E_STATE);
    nt_gpio_close(gpio);
    assert_int_equal(nt_gpio_open(&nothing, NULL, 0, &gpio), NT_E_ARGUMENT);
}

/* Opens what must fail; the reason must hold `what`, and no line may stay taken. */
static void assert_refused(nt_status status, const char *what)
{
    const nt_gpio_wiring wiring = nt_gpio_wiring_defaults();
    nt_gpio *gpio = NULL;
    assert_int_equal(nt_gpio_open(&wiring, reason, sizeof reason, &gpio), status);
    assert_null(gpio);
    assert_non_null(strstr(reason, what));
    assert_false(stop_line->requested || limit_line->requested || laser_line->requested);
}

static void open_says_why_it_failed(void **unused)
{
    (void)unused;
    limit_line->refuse = EPERM;
    assert_refused(NT_E_DEVICE, "\"limit\" on gpiochip7 was refused");
    limit_line->refuse = 0;
    laser_line->consumer = "sysfs";
    assert_refused(NT_E_DEVICE, "\"laser-en\" is in use by \"sysfs\"");
    laser_line->name = "estop";
    assert_refused(NT_E_ARGUMENT, "several GPIO lines are named \"estop\"");
    laser_line->name = "other";
    assert_refused(NT_E_DEVICE, "no GPIO line is named \"laser-en\"");
    fake_chips[0].may_not_open = fake_chips[1].may_not_open = 1;
    assert_refused(NT_E_DEVICE, "no GPIO chip that may be opened");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(open_is_safe_and_close_gives_back, setup, teardown),
        cmocka_unit_test_setup_teardown(levels_are_read_fail_safe, setup, teardown),
        cmocka_unit_test_setup_teardown(short_press_is_seen_once, setup, teardown),
        cmocka_unit_test_setup_teardown(lost_edge_counts_as_pressed, setup, teardown),
        cmocka_unit_test_setup_teardown(lost_chip_is_an_emergency_for_good, setup, teardown),
        cmocka_unit_test_setup_teardown(unwired_lines_are_left_alone, setup, teardown),
        cmocka_unit_test_setup_teardown(open_says_why_it_failed, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
