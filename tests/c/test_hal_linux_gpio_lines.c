/* SPDX-License-Identifier: BSD-3-Clause */
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

static int setup(void **state)
{
    (void)state;
    fake_chips[0] = (fake_chip){.number = 2, .line_count = 2, .lines = {{.name = "a"}, {.name = "twice"}}};
    fake_chips[1] = (fake_chip){
        .number = 0, .line_count = 3, .lines = {{.name = NULL}, {.name = "twice"}, {.name = "b", .consumer = "leds"}}};
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    return fake_handles;
}

static void lines_come_in_the_order_of_chip_numbers(void **unused)
{
    (void)unused;
    nt_gpio_line line;
    assert_int_equal(nt_gpio_line_count(), 5);
    assert_int_equal(nt_gpio_line_at(0, &line), NT_OK);
    assert_string_equal(line.chip, "gpiochip0");
    assert_string_equal(line.name, "");
    assert_int_equal(nt_gpio_line_at(2, &line), NT_OK);
    assert_string_equal(line.name, "b");
    assert_string_equal(line.consumer, "leds");
    assert_int_equal(nt_gpio_line_at(4, &line), NT_OK);
    assert_string_equal(line.chip, "gpiochip2");
    assert_int_equal(line.offset, 1);
    assert_int_equal(nt_gpio_line_at(5, &line), NT_E_RANGE);
    assert_int_equal(nt_gpio_line_at(-1, &line), NT_E_RANGE);
}

static void names_are_found_if_they_are_unique(void **unused)
{
    (void)unused;
    nt_gpio_line line = {.offset = 99};
    assert_int_equal(nt_gpio_line_find("twice", &line), NT_E_ARGUMENT);
    assert_int_equal(nt_gpio_line_find("none", &line), NT_E_DEVICE);
    assert_int_equal(nt_gpio_line_find("", &line), NT_E_ARGUMENT);
    assert_int_equal(line.offset, 99); /* untouched on failure */
    assert_int_equal(nt_gpio_line_find("a", &line), NT_OK);
    assert_string_equal(line.chip, "gpiochip2");
    assert_int_equal(line.offset, 0);
}

static void chips_that_may_not_be_opened_are_absent(void **unused)
{
    (void)unused;
    nt_gpio_line line;
    fake_chips[0].may_not_open = 1;
    assert_int_equal(nt_gpio_line_count(), 3);
    assert_int_equal(nt_gpio_line_find("twice", &line), NT_OK);
    assert_string_equal(line.chip, "gpiochip0");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(lines_come_in_the_order_of_chip_numbers, setup, teardown),
        cmocka_unit_test_setup_teardown(names_are_found_if_they_are_unique, setup, teardown),
        cmocka_unit_test_setup_teardown(chips_that_may_not_be_opened_are_absent, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
