/* SPDX-License-Identifier: BSD-3-Clause
 * What a half says of itself is refused at nt_hal_open where it cannot be: for a session as for a rehearsal. */
// clang-format off
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
// clang-format on

#include <math.h>

#include "nanotouch/hal.h"

static nt_capabilities says;

static nt_status describe(void *context, nt_capabilities *capabilities)
{
    (void)context;
    *capabilities = says;
    return NT_OK;
}

static nt_status read_nothing(void *context, nt_reading *reading)
{
    (void)context, (void)reading;
    return NT_OK;
}

static nt_status write_nothing(void *context, const nt_action *action)
{
    (void)context, (void)action;
    return NT_OK;
}

static nt_status open_with(const char *name, nt_problem *problem)
{
    const nt_backend backend = {.size = sizeof backend,
                                .version = NT_HAL_API_VERSION,
                                .name = name,
                                .half = NT_HALF_MASTER,
                                .describe = describe,
                                .read = read_nothing,
                                .write = write_nothing};
    const nt_hal_choice choice = {&backend, NULL};
    nt_hal hal;
    const nt_status status = nt_hal_open(&hal, NT_HALF_MASTER, &choice, NULL, problem);
    if (status == NT_OK)
        nt_hal_close(&hal);
    return status;
}

static nt_capabilities sound(const nt_channel_row *row)
{
    return (nt_capabilities){.size = sizeof(nt_capabilities), .axes = 1, .rows = row ? 1 : 0, .channels = row};
}

static void expect_row_refused(nt_channel_row row, const char *rule)
{
    nt_problem problem = {0};
    says = sound(&row);
    assert_int_equal(open_with("half", &problem), NT_E_RANGE);
    assert_string_equal(problem.field, rule);
}

static void channels_are_checked(void **state)
{
    (void)state;
    const nt_channel_row row = {
        .name = "p", .unit = "m", .axis = 2, .minimum = -1.0, .maximum = 1.0, .safe = (double)NAN};
    says = sound(&row);
    assert_int_equal(open_with("half", NULL), NT_OK);
    nt_channel_row wrong = row;
    wrong.unit = "mm";
    expect_row_refused(wrong, "channels with a unit other than m, N, rad and Hz");
    wrong = row, wrong.name = "";
    expect_row_refused(wrong, "channels without a name");
    wrong = row, wrong.axis = 7;
    expect_row_refused(wrong, "axis of a channel");
    wrong = row, wrong.minimum = 2.0;
    expect_row_refused(wrong, "minimum of a channel");
    wrong = row, wrong.latency = -1.0;
    expect_row_refused(wrong, "latency of a channel [s]");
    wrong = row, wrong.latency = HUGE_VAL;
    expect_row_refused(wrong, "latency of a channel [s]");
    wrong = row, wrong.noise = (double)NAN;
    expect_row_refused(wrong, "noise of a channel");
}

static void the_rest_is_checked(void **state)
{
    (void)state;
    nt_problem problem = {0};
    says = sound(NULL);
    assert_int_equal(open_with(NULL, &problem), NT_E_ARGUMENT);
    assert_string_equal(problem.field, "backends without a name");
    says.can = 1u << 9;
    assert_int_equal(open_with("half", &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "unknown bits of capabilities.can");
    says = sound(NULL), says.size = 1;
    assert_int_equal(open_with("half", &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "capabilities.size");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(channels_are_checked),
        cmocka_unit_test(the_rest_is_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
