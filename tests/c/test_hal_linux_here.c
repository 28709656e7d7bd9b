/* SPDX-License-Identifier: BSD-3-Clause
 * With the real libgpiod on the machine that runs the test: it needs no chip, and touches no line where there is one.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
/* after what it needs */
#include <cmocka.h>

#include "nanotouch/advanced/hal_linux.h"

static void every_line_can_be_listed(void **unused)
{
    (void)unused;
    const long count = nt_gpio_line_count();
    nt_gpio_line line;
    print_message("%ld GPIO lines\n", count);
    for (long i = 0; i < count; i++) {
        assert_int_equal(nt_gpio_line_at(i, &line), NT_OK);
        assert_memory_equal(line.chip, "gpiochip", 8);
        print_message("%s %u \"%s\" %s\n", line.chip, line.offset, line.name, line.consumer);
    }
    assert_int_equal(nt_gpio_line_at(count, &line), NT_E_RANGE);
}

static void missing_line_fails_with_its_name(void **unused)
{
    (void)unused;
    const nt_gpio_wiring wiring = {.emergency_stop = "nanotouch-no-such-line"};
    char reason[160] = "", tiny[8] = "";
    nt_gpio *gpio = NULL;
    assert_int_equal(nt_gpio_open(&wiring, reason, sizeof reason, &gpio), NT_E_DEVICE);
    assert_non_null(strstr(reason, "nanotouch-no-such-line"));
    assert_int_equal(nt_gpio_open(&wiring, tiny, sizeof tiny, &gpio), NT_E_DEVICE);
    assert_memory_equal(tiny, reason, sizeof tiny - 1); /* cut, and ended */
    assert_int_equal(nt_gpio_open(&wiring, NULL, 0, &gpio), NT_E_DEVICE);
    assert_null(gpio);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_line_can_be_listed),
        cmocka_unit_test(missing_line_fails_with_its_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
