/* SPDX-License-Identifier: BSD-3-Clause
 * The driver of spidev with the system calls in the test's hands: what it asks of the kernel, and what it makes of each
 * errno, of lengths that no kernel returns and of nonsense. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "conformance.h"
#include "converter_rig.h"
#include "host_fixture.h"
#include "nanotouch/advanced/hal_linux.h"
#include "spidev_model.h"

/* A kernel with two devices, whose next results can be set. */
static struct {
    simulated_bus bus;
    spidev_model model[2];
    int opened, refuse_open; /* errno */
    int results[8], result_count, next;
    int is_sticky; /* the first result comes again and again */
} kernel;

static int open_call(void *context, const char *path)
{
    (void)context;
    if (kernel.refuse_open)
        return -kernel.refuse_open;
    ++kernel.opened;
    return path[strlen(path) - 1] == '0' ? 10 : 11;
}

static void close_call(void *context, int file)
{
    (void)context;
    kernel.opened -= file == 10 || file == 11;
}

static int copy_bytes(void *context, uint64_t theirs, uint8_t *ours, uint32_t count, int is_write)
{
    (void)context;
    assert_true(theirs != 0);
    memcpy(is_write ? (void *)(uintptr_t)theirs : ours, is_write ? ours : (const void *)(uintptr_t)theirs, count);
    return 0;
}

static int control_call(void *context, int file, unsigned long request, void *argument)
{
    (void)context;
    if (kernel.next < kernel.result_count || (kernel.is_sticky && kernel.result_count))
        return kernel.results[kernel.is_sticky ? 0 : kernel.next++];
    return model_request(&kernel.model[file - 10], (unsigned)request, argument, copy_bytes, NULL);
}

static const nt_spi_calls calls = {open_call, control_call, close_call, NULL};
static const nt_spi_device devices[] = {{"/dev/spidev0.0", 1, 10e6}, {"/dev/spidev0.1", 2, 17e6}};
static nt_spi spi;

static void boot(void)
{
    memset(&kernel, 0, sizeof kernel);
    kernel.bus = simulated_bus_after_power_up();
    for (int i = 0; i < 2; ++i)
        kernel.model[i] = (spidev_model){.bus = &kernel.bus, .chip = i};
}

static void start(void)
{
    boot();
    assert_int_equal(nt_spi_open(&spi, devices, 2, &calls, NULL), NT_OK);
}

static void next_result(int result)
{
    kernel.results[0] = result;
    kernel.result_count = 1;
    kernel.next = 0;
}

static void it_sets_the_devices_up(void **state)
{
    (void)state;
    start();
    assert_true(kernel.model[0].mode == 1 && kernel.model[1].mode == 2 && kernel.opened == 2);
    assert_true(kernel.model[0].bits == 8 && kernel.model[0].clock == 10000000 && kernel.model[1].clock == 17000000);
    nt_spi_close(&spi);
    nt_spi_close(&spi);
    nt_spi_close(NULL);
    assert_int_equal(kernel.opened, 0);
}

static void what_is_refused_is_said(void **state)
{
    (void)state;
    char reason[NT_SPI_REASON];
    const int errors[] = {ENOENT, EACCES, EBUSY};
    for (int i = 0; i < 3; ++i) {
        boot();
        kernel.refuse_open = errors[i];
        assert_int_equal(nt_spi_open(&spi, devices, 2, &calls, reason), NT_E_DEVICE);
        assert_non_null(strstr(reason, "/dev/spidev0.0: open: "));
        assert_non_null(strstr(reason, strerror(errors[i])));
    }
    boot();
    next_result(-EINVAL); /* the controller does not know this mode */
    assert_int_equal(nt_spi_open(&spi, devices, 2, &calls, reason), NT_E_DEVICE);
    assert_string_equal(reason, "/dev/spidev0.0: mode: Invalid argument");
    assert_int_equal(kernel.opened, 0);
    boot();
    next_result(0); /* said to be done, and not done */
    assert_int_equal(nt_spi_open(&spi, devices, 2, &calls, reason), NT_E_DEVICE);
    assert_string_equal(reason, "/dev/spidev0.0: mode: it was not taken");
    assert_int_equal(kernel.opened, 0);
    const nt_spi_device fast = {"/dev/spidev0.0", 1, 1e9}, odd = {"/dev/spidev0.0", 4, 1e6};
    assert_int_equal(nt_spi_open(&spi, &fast, 1, &calls, reason), NT_E_RANGE);
    assert_int_equal(nt_spi_open(&spi, &odd, 1, &calls, reason), NT_E_ARGUMENT);
    assert_int_equal(nt_spi_open(&spi, devices, 0, &calls, reason), NT_E_ARGUMENT);
    assert_int_equal(kernel.opened, 0);
}

static nt_status send(int frames)
{
    static uint8_t out[8][16], in[8][16];
    nt_transfer transfers[8];
    for (int i = 0; i < frames; ++i)
        transfers[i] = (nt_transfer){out[i], in[i], 16};
    return nt_spi_exchange(&spi, 1, transfers, frames);
}

/* Frames of 16 bytes: four to a message, each under its own chip select. */
static void long_exchanges_are_chained(void **state)
{
    (void)state;
    for (int frames = 1; frames <= 8; ++frames) {
        start();
        assert_int_equal(send(frames), NT_OK);
        assert_int_equal(kernel.bus.frames[1], frames);
        assert_int_equal(kernel.model[1].messages, (frames + 3) / 4);
        assert_true(kernel.model[1].longest <= NT_SPI_MESSAGE);
        nt_spi_close(&spi);
    }
    start();
    uint8_t out[65] = {0}, in[65];
    const nt_transfer longer = {out, in, 65};
    assert_int_equal(nt_spi_exchange(&spi, 1, &longer, 1), NT_E_CAPACITY);
    assert_int_equal(nt_spi_exchange(&spi, 2, &longer, 1), NT_E_DEVICE);
    assert_int_equal(kernel.model[1].messages, 0);
    nt_spi_close(&spi);
}

static void each_errno_has_its_reaction(void **state)
{
    (void)state;
    const struct {
        int result;
        nt_status status;
    } table[] = {{-EIO, NT_E_STATE},     {-ETIMEDOUT, NT_E_STATE}, {-EAGAIN, NT_E_STATE}, {-EINVAL, NT_E_STATE},
                 {-ENOMEM, NT_E_STATE},  {0, NT_E_STATE},          {15, NT_E_STATE},      {17, NT_E_STATE},
                 {-ENODEV, NT_E_DEVICE}, {-ENXIO, NT_E_DEVICE},    {-EBADF, NT_E_DEVICE}, {-ESHUTDOWN, NT_E_DEVICE}};
    for (size_t i = 0; i < sizeof table / sizeof *table; ++i) {
        start();
        next_result(table[i].result);
        assert_int_equal(send(1), table[i].status);
        assert_int_equal(kernel.next, 1); /* once, and not again */
        assert_int_equal(send(1), NT_OK);
        assert_int_equal(spi.refused, table[i].result < 0);
        assert_int_equal(spi.short_ones, table[i].result >= 0);
        assert_int_equal(spi.error, table[i].result < 0 ? -table[i].result : 0);
        nt_spi_close(&spi);
    }
}

static void an_interrupt_is_tried_again_but_not_for_ever(void **state)
{
    (void)state;
    start();
    next_result(-EINTR);
    assert_int_equal(send(1), NT_OK);
    assert_int_equal(spi.interrupted, 1);
    next_result(-EINTR);
    kernel.is_sticky = 1;
    const uint64_t before = spi.messages;
    assert_int_equal(send(1), NT_E_STATE);
    assert_int_equal(spi.messages - before, NT_SPI_ATTEMPTS);
    nt_spi_close(&spi);
}

/* --- the whole half over it --- */

static nt_converter_setup over_spi(void)
{
    nt_converter_setup setup = slave_setup(&kernel.bus, 0);
    setup.exchange = nt_spi_exchange;
    setup.bus = &spi;
    return setup;
}

static void silence(void *device, int on)
{
    (void)device;
    next_result(-EIO);
    kernel.is_sticky = on;
    kernel.result_count = on;
}

static void lose(void *device)
{
    (void)device;
    kernel.bus.fault = BUS_GONE;
}

static double left_at(void *device)
{
    (void)device;
    return simulated_travel(&kernel.bus);
}

static void the_half_conforms(void **state)
{
    (void)state;
    start();
    const nt_converter_setup setup = over_spi();
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
    const char *rule = conform("spidev's driver on a model of the kernel", &c);
    if (rule)
        fail_msg("%s", rule);
    assert_true(kernel.model[0].longest <= NT_SPI_MESSAGE && kernel.model[1].longest <= NT_SPI_MESSAGE);
    nt_spi_close(&spi);
}

/* Any errno at any moment: no tick costs more than its attempts, nothing that is no number is called valid, and after
 * the storm the tip is lifted unless the bus was gone. */
static void a_storm_of_errors(void **state)
{
    (void)state;
    uint32_t dice = 20261122;
    const nt_configuration configuration = {sizeof configuration, 0, 1e-3, 1e-6, ""};
    for (int life = 0; life < 300; ++life) {
        start();
        const nt_converter_setup setup = over_spi();
        nt_converter_half half;
        nt_hal hal;
        const nt_hal_choice choice = {nt_converter_half_backend(NT_HALF_SLAVE), &half};
        assert_int_equal(nt_converter_half_init(&half, &setup, NULL), NT_OK);
        assert_int_equal(nt_hal_open(&hal, NT_HALF_SLAVE, &choice, &host, NULL), NT_OK);
        assert_int_equal(nt_hal_configure(&hal, &configuration, NULL), NT_OK);
        assert_int_equal(nt_hal_arm(&hal), NT_OK);
        for (int tick = 0; tick < 200; ++tick) {
            const uint64_t before = spi.messages;
            dice ^= dice << 13, dice ^= dice >> 17, dice ^= dice << 5;
            kernel.result_count = dice % 3 ? 0 : 1 + (int)(dice >> 8 & 3u);
            kernel.next = 0;
            for (int i = 0; i < kernel.result_count; ++i)
                kernel.results[i] = (int)(dice >> (12 + 4 * i) & 63u) - 48; /* errnos, and some lengths */
            assert_int_equal(nt_hal_read(&hal), NT_OK);
            assert_true(hal.reading.valid == 0 || isfinite(hal.reading.position[NT_Z]));
            const nt_action action = {.size = sizeof action, .target = {0.0, 0.0, 1e-6 * (dice % 7)}};
            assert_int_equal(nt_hal_write(&hal, &action), NT_OK);
            assert_true(spi.messages - before <= 3 * NT_SPI_ATTEMPTS);
        }
        kernel.result_count = 0;
        const double stood = simulated_travel(&kernel.bus);
        const int was_gone = half.is_gone;
        nt_hal_close(&hal);
        assert_true(was_gone || simulated_travel(&kernel.bus) <= stood - 0.9e-6);
        nt_spi_close(&spi);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_sets_the_devices_up),
        cmocka_unit_test(what_is_refused_is_said),
        cmocka_unit_test(long_exchanges_are_chained),
        cmocka_unit_test(each_errno_has_its_reaction),
        cmocka_unit_test(an_interrupt_is_tried_again_but_not_for_ever),
        cmocka_unit_test(the_half_conforms),
        cmocka_unit_test(a_storm_of_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
