/* SPDX-License-Identifier: BSD-3-Clause
 * The driver of spidev with the kernel's own system calls, on files that answer spidev's requests (fuse_spidev.h).
 * Where FUSE may not be used it is left out, and says so. */
#define _GNU_SOURCE
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

#include <cmocka.h>

#include "conformance.h"
#include "converter_rig.h"
#include "fuse_spidev.h"
#include "host_fixture.h"
#include "nanotouch/advanced/hal_linux.h"

static simulated_bus bus;
static fuse_spidev files;
static const char *why_not;
static nt_spi spi;

static void start(void)
{
    const nt_spi_device devices[] = {{files.path[0], 1, 10e6}, {files.path[1], 2, 17e6}};
    char reason[NT_SPI_REASON];
    if (why_not) {
        print_message("left out: %s\n", why_not);
        skip();
    }
    bus = simulated_bus_after_power_up();
    if (nt_spi_open(&spi, devices, 2, NULL, reason) != NT_OK)
        fail_msg("%s", reason);
}

static bus_fault silence_is;

static void silence(void *device, int on)
{
    (void)device;
    bus.fault = on ? silence_is : BUS_WELL;
}

static void lose(void *device)
{
    (void)device;
    bus.fault = BUS_GONE;
}

static double left_at(void *device)
{
    (void)device;
    return simulated_travel(&bus);
}

static void the_half_conforms(void **state)
{
    (void)state;
    static const char *const silences[] = {"well", "0", "1", "short", "refusing"};
    for (int fault = BUS_ALL_ZERO; fault <= BUS_REFUSED; ++fault) {
        start();
        nt_converter_setup setup = slave_setup(&bus, fault % 2);
        setup.exchange = nt_spi_exchange;
        setup.bus = &spi;
        static nt_converter_half half;
        assert_int_equal(nt_converter_half_init(&half, &setup, NULL), NT_OK);
        const conformance c = {.half = NT_HALF_SLAVE,
                               .choice = {nt_converter_half_backend(NT_HALF_SLAVE), &half},
                               .host = &host,
                               .configuration = {sizeof(nt_configuration), 0, 1e-3, 1e-6, ""},
                               .periods = 100,
                               .pass = pass,
                               .silence = silence,
                               .lose = lose,
                               .left_at = left_at,
                               .slack = 1e-9};
        silence_is = (bus_fault)fault;
        char name[80];
        (void)snprintf(name, sizeof name, "files that answer as spidev, bus %s", silences[fault]);
        const char *rule = conform(name, &c);
        if (rule)
            fail_msg("%s: %s", name, rule);
        assert_true(files.model[0].longest <= NT_SPI_MESSAGE && files.model[1].longest <= NT_SPI_MESSAGE);
        nt_spi_close(&spi);
    }
}

static void a_second_program_is_refused(void **state)
{
    (void)state;
    start();
    const nt_spi_device device = {files.path[0], 1, 10e6};
    char reason[NT_SPI_REASON];
    nt_spi second;
    assert_int_equal(nt_spi_open(&second, &device, 1, NULL, reason), NT_E_DEVICE);
    assert_non_null(strstr(reason, strerror(EBUSY)));
    nt_spi_close(&spi);
    assert_int_equal(nt_spi_open(&second, &device, 1, NULL, reason), NT_OK);
    nt_spi_close(&second);
}

static void a_missing_device_is_named(void **state)
{
    (void)state;
    const nt_spi_device device = {"/dev/spidev-that-is-not-there", 1, 10e6};
    char reason[NT_SPI_REASON];
    assert_int_equal(nt_spi_open(&spi, &device, 1, NULL, reason), NT_E_DEVICE);
    assert_string_equal(reason, "/dev/spidev-that-is-not-there: open: No such file or directory");
    const nt_spi_device null = {"/dev/null", 1, 10e6};
    assert_int_equal(nt_spi_open(&spi, &null, 1, NULL, reason), NT_E_DEVICE);
    assert_non_null(strstr(reason, "/dev/null: mode: "));
}

/* Told, never judged: how long a frame takes here. */
static void frames_are_timed(void **state)
{
    (void)state;
    enum { FRAMES = 2000 };
    start();
    uint8_t out[3] = {0}, in[3];
    const nt_transfer frame = {out, in, 3};
    struct timespec from, to;
    (void)clock_gettime(CLOCK_MONOTONIC, &from);
    for (int i = 0; i < FRAMES; ++i)
        assert_int_equal(nt_spi_exchange(&spi, 0, &frame, 1), NT_OK);
    (void)clock_gettime(CLOCK_MONOTONIC, &to);
    const double taken = (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
    print_message("a frame of 24 bits through the kernel: %.1f us\n", 1e6 * taken / FRAMES);
    nt_spi_close(&spi);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_half_conforms),
        cmocka_unit_test(a_second_program_is_refused),
        cmocka_unit_test(a_missing_device_is_named),
        cmocka_unit_test(frames_are_timed),
    };
    why_not = fuse_start(&files, &bus);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    if (!why_not)
        fuse_end(&files);
    return failed;
}
