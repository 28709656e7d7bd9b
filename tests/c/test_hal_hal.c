/* SPDX-License-Identifier: BSD-3-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/hal.h"

typedef struct device {
    int reads, writes, closes;
    double motor_force;
} device;

static nt_status read_device(void *context, nt_sample *sample)
{
    device *d = context;
    *sample = (nt_sample){.tick = (uint64_t)d->reads++, .deflection = 3e-9};
    return NT_OK;
}

static nt_status write_device(void *context, const nt_command *command)
{
    device *d = context;
    d->writes++;
    d->motor_force = command->motor_force;
    return command->motor_force > 1.0 ? NT_E_DEVICE : NT_OK;
}

static void close_device(void *context)
{
    ((device *)context)->closes++;
}

static const nt_hal_backend backend = {"device", NT_HAL_API_VERSION, read_device, write_device, close_device};

static void calls_reach_the_backend(void **state)
{
    (void)state;
    device d = {0};
    nt_hal hal;
    nt_sample sample;
    assert_int_equal(nt_hal_open(&hal, &backend, &d), NT_OK);
    assert_int_equal(nt_hal_read(&hal, &sample), NT_OK);
    assert_true(sample.deflection == 3e-9);
    const nt_command small = {.motor_force = 0.5}, large = {.motor_force = 2.0};
    assert_int_equal(nt_hal_write(&hal, &small), NT_OK);
    assert_int_equal(nt_hal_write(&hal, &large), NT_E_DEVICE); /* what the device says is passed on */
    assert_true(d.reads == 1 && d.writes == 2 && d.motor_force == 2.0);
    nt_hal_close(&hal);
    nt_hal_close(&hal); /* closed once */
    assert_int_equal(d.closes, 1);
    assert_int_equal(nt_hal_read(&hal, &sample), NT_E_STATE);
    assert_int_equal(nt_hal_write(&hal, &small), NT_E_STATE);
    nt_hal_close(NULL);
}

static void incomplete_or_foreign_backends_are_refused(void **state)
{
    (void)state;
    device d = {0};
    nt_hal hal = {&backend, &d};
    nt_hal_backend broken = backend;
    assert_int_equal(nt_hal_open(&hal, NULL, &d), NT_E_ARGUMENT);
    broken.read = NULL;
    assert_int_equal(nt_hal_open(&hal, &broken, NULL), NT_E_ARGUMENT);
    broken = backend;
    broken.write = NULL;
    assert_int_equal(nt_hal_open(&hal, &broken, NULL), NT_E_ARGUMENT);
    broken = backend;
    broken.api_version++;
    assert_int_equal(nt_hal_open(&hal, &broken, NULL), NT_E_UNSUPPORTED);
    assert_true(hal.backend == &backend && hal.context == &d); /* untouched */
    broken = backend;
    broken.close = NULL; /* need not be there */
    assert_int_equal(nt_hal_open(&hal, &broken, &d), NT_OK);
    nt_hal_close(&hal);
    assert_null(hal.backend);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calls_reach_the_backend),
        cmocka_unit_test(incomplete_or_foreign_backends_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
