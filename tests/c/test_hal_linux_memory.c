/* SPDX-License-Identifier: BSD-3-Clause
 * Whichever allocation of nt_gpio_open fails, our own or libgpiod's: an error, no handle, no leak, no line held. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "failing_heap.h"
#include "fake_gpiod.h"
#include "nanotouch/advanced/hal_linux.h"

static void open_without_memory(void **state)
{
    (void)state;
#if !HEAP_CAN_FAIL
    skip();
#endif
    const nt_gpio_wiring wiring = nt_gpio_wiring_defaults();
    fake_chips[0] = (fake_chip){.number = 0, .line_count = 1, .lines = {{.name = "estop", .level = 1}}};
    fake_chips[1] = (fake_chip){
        .number = 7, .line_count = 2, .lines = {{.name = "limit", .level = 1}, {.name = "laser-en", .level = 1}}};
    char reason[160];
    heap_fail(1, HEAP_ONCE);
    nt_gpio *gpio = NULL;
    const nt_status status = nt_gpio_open(&wiring, reason, sizeof reason, &gpio);
    heap_recover();
    assert_int_equal(status, NT_E_NO_MEMORY);
    assert_null(gpio);
    assert_int_equal(fake_handles, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(open_without_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
