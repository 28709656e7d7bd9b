/* SPDX-License-Identifier: BSD-3-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "nanotouch/hal.h"

/* CMake builds tiny_backend.c with and without one thing that is wrong. */
static const char *object(const char *name)
{
    static char path[1024];
    (void)snprintf(path, sizeof path, TINY_FOLDER "/%s.so", name);
    return path;
}

static int64_t clock_now;
static int said;

static int64_t now(const nt_host *host)
{
    (void)host;
    return clock_now;
}

static void say(const nt_host *host, const char *text)
{
    (void)host;
    said += strcmp(text, "tiny is open") == 0;
}

static void pass(const nt_host *host, double period)
{
    (void)host;
    clock_now += (int64_t)(1e9 * period);
}

static const nt_host host = {sizeof host, NT_HAL_API_VERSION, now, say, NULL};

static void an_object_that_links_nothing_is_a_half(void **state)
{
    (void)state;
    nt_module module;
    assert_int_equal(nt_hal_load(&module, object("tiny"), NT_HALF_MASTER), NT_OK);
    assert_string_equal(module.text, "");
    assert_string_equal(module.backend->name, "tiny");
    nt_hal hal;
    const nt_hal_choice choice = {module.backend, NULL};
    said = 0;
    clock_now = 5;
    assert_int_equal(nt_hal_open(&hal, NT_HALF_MASTER, &choice, &host, NULL), NT_OK);
    assert_int_equal(said, 1); /* the host's table has reached it */
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    assert_true(hal.reading.position[NT_Z] == 1e-3 && hal.reading.time == 5 && hal.reading.sequence == 1);
    assert_true(hal.reading.position[NT_X] != hal.reading.position[NT_X]); /* NaN: it does not measure it */
    nt_hal_close(&hal);
    nt_hal_unload(&module);
    nt_hal_unload(&module);
    nt_hal_unload(NULL);
}

static void it_keeps_the_contract(void **state)
{
    (void)state;
    nt_module module;
    assert_int_equal(nt_hal_load(&module, object("tiny"), NT_HALF_MASTER), NT_OK);
    const nt_rehearsal rehearsal = {.half = NT_HALF_MASTER,
                                    .choice = {module.backend, NULL},
                                    .host = &host,
                                    .configuration = {sizeof(nt_configuration), 0, 1e-3, 0.0, ""},
                                    .periods = 10,
                                    .pass = pass};
    nt_rehearsed seen;
    nt_problem problem = {0};
    const nt_status status = nt_hal_rehearse(&rehearsal, &seen, &problem);
    assert_string_equal(problem.field ? problem.field : "", "");
    assert_int_equal(status, NT_OK);
    assert_int_equal(seen.readings, 20);
    nt_hal_unload(&module);
}

static void refuses(const char *name, nt_half half, nt_status expected, const char *why)
{
    nt_module module;
    assert_int_equal(nt_hal_load(&module, object(name), half), expected);
    if (!strstr(module.text, why) || !strstr(module.text, name))
        fail_msg("%s: \"%s\" does not say \"%s\"", name, module.text, why);
    assert_true(!module.backend && !module.handle);
}

static void what_is_wrong_is_said(void **state)
{
    (void)state;
    refuses("missing", NT_HALF_MASTER, NT_E_DEVICE, "No such file");
    refuses("tiny", NT_HALF_SLAVE, NT_E_UNSUPPORTED, "is a master, a slave is wanted");
    refuses("tiny_old", NT_HALF_MASTER, NT_E_UNSUPPORTED, "written for version 1 of the contract");
    refuses("tiny_nameless", NT_HALF_MASTER, NT_E_ARGUMENT, "has no function nanotouch_backend");
    refuses("tiny_empty", NT_HALF_MASTER, NT_E_ARGUMENT, "returns no table");
    refuses("tiny_mute", NT_HALF_MASTER, NT_E_ARGUMENT, "no read or no write");
    nt_module module;
    assert_int_equal(nt_hal_load(&module, __FILE__, NT_HALF_MASTER), NT_E_DEVICE); /* no object at all */
    assert_non_null(strstr(module.text, __FILE__));
    assert_int_equal(nt_hal_load(NULL, "x", NT_HALF_MASTER), NT_E_ARGUMENT);
    assert_int_equal(nt_hal_load(&module, NULL, NT_HALF_MASTER), NT_E_ARGUMENT);
    assert_int_equal(nt_hal_load(&module, "x", (nt_half)2), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_object_that_links_nothing_is_a_half),
        cmocka_unit_test(it_keeps_the_contract),
        cmocka_unit_test(what_is_wrong_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
