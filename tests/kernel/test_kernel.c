/* SPDX-License-Identifier: BSD-3-Clause
 * The drivers on a kernel: its spidev, whose controller asks a thread of this program (kernel_bus.h), and its GPIO
 * lines, which gpio-sim moves. Runs as root in the kernel of tests/kernel/run.sh, and nowhere else. */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/reboot.h>
#include <time.h>

#include <cmocka.h>

#include "conformance.h"
#include "hal/chips/chips.h"
#include "hal/linux/hal_linux.h"
#include "kernel_command.h"
#include "kernel_rig.h"
#include "kernel_tapping.h"
#include "larger.h"

/* --- the rules of a half --- */

static bus_fault silence_is;

static void silence(void *device, int on)
{
    (void)device;
    chips.bus.fault = on ? silence_is : BUS_WELL;
}

static void lose(void *device)
{
    (void)device;
    chips.bus.fault = BUS_GONE;
}

static double left_at(void *device)
{
    (void)device;
    return simulated_travel(&chips.bus);
}

static void the_half_conforms(void **state)
{
    (void)state;
    static const char *const silences[] = {"well", "0", "1", "short", "refusing"};
    for (int fault = BUS_ALL_ZERO; fault <= BUS_REFUSED; ++fault) {
        open_drivers();
        const nt_converter_setup setup = setup_of_slave(fault % 2);
        assert_int_equal(nt_converter_half_init(&l.half, &setup, NULL), NT_OK);
        const conformance c = {.half = NT_HALF_SLAVE,
                               .choice = {nt_converter_half_backend(NT_HALF_SLAVE), &l.half},
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
        (void)snprintf(name, sizeof name, "spidev and GPIO of a kernel, bus %s", silences[fault]);
        const char *rule = conform(name, &c);
        if (rule)
            fail_msg("%s: %s", name, rule);
        close_drivers();
    }
    assert_int_equal(chips.wrong_mode, 0);
    assert_true(chips.clock == 10000000);
}

/* --- a touch --- */

/* The same loop without kernel and converters: what was told is where the stage is, the lever reads what it does. */
static void a_touch_is_the_simulated_one(void **state)
{
    (void)state;
    const double dac = 20e-6 / 1048575.0, adc = DEFLECTION_GAIN * 20.0 / 65536.0;
    approach(APPROACH);
    const double travel = simulated_travel(&chips.bus), deflection = simulated_deflection(&chips.bus);
    end();
    begin_touch();
    nt_sample sample = {.tick = 0};
    nt_command command = {.state = NT_RUN};
    for (int i = 0; i < APPROACH; ++i) {
        const double beyond = command.stage_position[NT_Z] - SURFACE;
        sample.stage_position[NT_Z] = command.stage_position[NT_Z];
        sample.deflection[NT_Z] = beyond > 0.0 ? 0.5 * beyond : 0.0;
        sample.deflection[NT_Z] += 1e-15 * (i % 2); /* a lever that does not move at all is stuck */
        nt_touch_step(&l.touch, &l.state, &sample, &command);
        assert_int_equal(command.state, NT_RUN);
        ++sample.tick;
    }
    assert_true(deflection > 0.0);
    print_message("set-point held at %.2f nm of travel, in the simulated run at %.2f nm\n", 1e9 * travel,
                  1e9 * sample.stage_position[NT_Z]);
    assert_true(fabs(travel - sample.stage_position[NT_Z]) <= 2.0 * (2.0 * adc + dac)); /* spring and lever are alike */
    assert_true(fabs(deflection - sample.deflection[NT_Z]) <= 2.0 * adc + dac);
}

/* --- safety --- */

static void press(const char *line)
{
    pull_line(line, 0);
}

static void tap(const char *line)
{
    pull_line(line, 0);
    pull_line(line, 1);
}

static void lose_the_chip(const char *line)
{
    (void)line;
    gpio_chip(0);
}

static void unbind_the_dac(const char *line)
{
    (void)line;
    bind_spidev("spi0.0", 0);
}

static void restore(void)
{
    if (!has_gpio_chip())
        gpio_chip(1);
    bind_spidev("spi0.0", 1);
    chips.bus.fault = BUS_WELL;
    chips.bus.errors = 0;
}

static void lines_in_ticks(void **state)
{
    (void)state;
    static const struct {
        const char *name, *line;
        void (*strike)(const char *line);
        uint32_t reaction;
    } table[] = {
        {"emergency stop pressed", "estop", press, NT_LATCHED},
        {"emergency stop tapped between two ticks", "estop", tap, NT_LATCHED},
        {"limit switch pressed", "limit", press, NT_RETRACT},
        {"limit switch tapped between two ticks", "limit", tap, NT_RETRACT},
        {"the GPIO chip is pulled out", "estop", lose_the_chip, NT_LATCHED},
        {"the DAC's device is unbound (ESHUTDOWN)", "", unbind_the_dac, NT_LATCHED},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; ++i) {
        approach(UNDER_WAY);
        table[i].strike(table[i].line);
        const uint32_t reached = tick();
        print_message("%-40s %s after 1 tick\n", table[i].name, reached == NT_LATCHED ? "LATCHED" : "RETRACT");
        assert_int_equal(reached, table[i].reaction);
        end();
        restore();
    }
}

static void outputs_are_what_was_asked(void **state)
{
    (void)state;
    begin();
    assert_int_equal(line_level("laser-en"), 1);
    for (int i = 0, before = line_level("watchdog"); i < 100; ++i) {
        assert_int_equal(tick(), NT_RUN);
        assert_int_equal(line_level("watchdog"), before = !before);
    }
    nt_gpio *second = NULL;
    char reason[NT_SPI_REASON];
    const nt_gpio_wiring wiring = {"estop", NULL, NULL, NULL, NULL, 0.0};
    assert_int_equal(nt_gpio_open(&wiring, reason, sizeof reason, &second), NT_E_DEVICE);
    assert_non_null(strstr(reason, "in use by \"nanotouch\""));
    end();
    assert_int_equal(line_level("laser-en"), 0);
    assert_int_equal(line_level("watchdog"), 0);
}

/* --- faults of the bus, in ticks --- */

static void bus_in_ticks(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        bus_fault fault;
        int error, errors;
        int hold, retract, latched;
    } table[] = {
        {"all zero", BUS_ALL_ZERO, 0, 0, 1, 2, NT_CONVERTER_BAD},
        {"all one", BUS_ALL_ONE, 0, 0, 1, 2, NT_CONVERTER_BAD},
        {"one bit wrong", BUS_FLIPPED, 0, 0, 1, 2, NT_CONVERTER_BAD},
        {"a byte short", BUS_SHORT, 0, 0, 1, 2, NT_CONVERTER_BAD},
        {"EIO", BUS_WELL, EIO, -1, 1, 2, NT_CONVERTER_BAD},
        {"EIO, once", BUS_WELL, EIO, 1, 1, -1, -1},
        {"ENODEV", BUS_WELL, ENODEV, -1, -1, -1, 1},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; ++i) {
        int ticks[4] = {-1, -1, -1, -1};
        approach(UNDER_WAY);
        chips.bus.fault = table[i].fault;
        chips.bus.error = table[i].error;
        chips.bus.errors = table[i].errors;
        for (int k = 1; k <= AFTER; ++k) {
            const uint32_t reached = tick();
            ticks[reached] = ticks[reached] < 0 ? k : ticks[reached];
        }
        print_message("%-16s HOLD %d, RETRACT %d, LATCHED %d\n", table[i].name, ticks[NT_HOLD], ticks[NT_RETRACT],
                      ticks[NT_LATCHED]);
        assert_int_equal(ticks[NT_HOLD], table[i].hold);
        assert_int_equal(ticks[NT_RETRACT], table[i].retract);
        assert_int_equal(ticks[NT_LATCHED], table[i].latched);
        end();
        restore();
    }
}

/* spidev tells the whole length, whatever went through, and where nothing came it leaves what came before. */
static void a_short_transfer_is_told_as_whole(void **state)
{
    (void)state;
    enum { BYTES = 16 };
    uint8_t out[BYTES] = {0}, in[BYTES];
    const nt_transfer frame = {out, in, BYTES};
    open_drivers();
    assert_int_equal(nt_spi_exchange(&l.spi, 1, &frame, 1), NT_OK);
    assert_true(in[0] == 0 && in[2] == 0);
    chips.bus.dac = 0xFFFFF; /* both inputs go to the ends of their ranges */
    chips.bus.control = 0;
    chips.bus.fault = BUS_SHORT;
    for (int came = 0; came <= BYTES; ++came) {
        chips.bus.lost[1] = (uint32_t)(BYTES - came);
        memset(in, 0x55, sizeof in);
        assert_int_equal(nt_spi_exchange(&l.spi, 1, &frame, 1), NT_OK);
        assert_int_equal(in[0], came > 0 ? 0x7F : 0);
        assert_int_equal(in[2], came > 2 ? 0x7F : 0);
    }
    assert_int_equal(l.spi.short_ones, 0);
    close_drivers();
    restore();
}

/* --- time --- */

static double clock_us(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

/* A chip that never answers: the kernel waits for a second, then the tick is a bad one. */
static void a_bus_that_does_not_answer(void **state)
{
    (void)state;
    approach(UNDER_WAY);
    chips.is_mute = 1;
    const double from = clock_us();
    assert_int_equal(tick(), NT_HOLD);
    const double taken = clock_us() - from;
    chips.is_mute = 0;
    assert_int_equal(l.spi.error, ETIMEDOUT);
    print_message("a bus that does not answer: HOLD, after %.3f s\n", 1e-6 * taken);
    assert_true(taken >= 0.9e6);
    end();
}

/* Edges of the watchdog from a loop of 1 kHz; after one period of 20 ms a circuit that waits for 10 has stopped it. */
static void the_watchdog_has_its_edges(void **state)
{
    (void)state;
    enum { PERIODS = 1000, STALL = 700 };
    struct timespec due;
    double last = 0.0, longest = 0.0, stall = 0.0;
    begin();
    (void)clock_gettime(CLOCK_MONOTONIC, &due);
    for (int i = 0; i < PERIODS; ++i) {
        due.tv_nsec += i == STALL ? 20000000 : 1000000;
        due.tv_sec += due.tv_nsec / 1000000000;
        due.tv_nsec %= 1000000000;
        (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
        const int before = line_level("watchdog");
        (void)tick();
        assert_int_equal(line_level("watchdog"), !before);
        const double now_us = clock_us();
        if (i == STALL)
            stall = now_us - last;
        else if (i > 0)
            longest = larger(longest, now_us - last);
        last = now_us;
    }
    print_message("watchdog: %d edges, longest gap %.0f us, in a stall of 20 ms %.0f us\n", PERIODS, longest, stall);
    /* virtual time goes on by some ns whenever it is asked for, so that nobody waits for it in vain */
    assert_true(!is_virtual() || (fabs(longest - 1e3) < 1.0 && fabs(stall - 20e3) < 1.0));
    end();
}

static int by_size(const void *a, const void *b)
{
    const double d = *(const double *)a - *(const double *)b;
    return (d > 0.0) - (d < 0.0);
}

/* Told, never judged. */
static void latencies(void **state)
{
    (void)state;
    enum { TIMES = 1000 };
    static double frame[TIMES], press_seen[TIMES];
    uint8_t out[3] = {0}, in[3];
    const nt_transfer transfer = {out, in, 3};
    nt_gpio_state lines;
    open_drivers();
    for (int i = 0; i < TIMES; ++i) {
        const double from = clock_us();
        assert_int_equal(nt_spi_exchange(&l.spi, 0, &transfer, 1), NT_OK);
        const double to = clock_us();
        frame[i] = to - from;
        pull_line("estop", i % 2);
        assert_int_equal(nt_gpio_read(l.gpio, &lines), NT_OK);
        press_seen[i] = clock_us() - to;
        assert_int_equal(lines.flags, i % 2 && i > 0 ? 0u : (uint32_t)NT_SAMPLE_EMERGENCY_STOP);
    }
    assert_int_equal(lines.lost_events, 0);
    close_drivers();
    qsort(frame, TIMES, sizeof *frame, by_size);
    qsort(press_seen, TIMES, sizeof *press_seen, by_size);
    print_message("latency: frame of 24 bits p50 %.0f us, p99 %.0f us; line pulled and read p50 %.0f us, p99 %.0f us\n",
                  frame[TIMES / 2], frame[TIMES * 99 / 100], press_seen[TIMES / 2], press_seen[TIMES * 99 / 100]);
}

/* --- slow channels, by IIO --- */

static void iio_gives_numbers_and_scans(void **state)
{
    (void)state;
    enum { LONG = 200 };
    const int scans = is_virtual() ? LONG : 16; /* 2 s, longer than libiio waits by itself */
    const double step = 1.333e-6;
    const nt_iio_device dummy = {"dummy", {"voltage0"}, nt_chip_of_iio(13, 1, 0), {7 * step, 8198 * step}};
    nt_iio iio;
    char reason[NT_IIO_REASON] = "";
    uint8_t out[4] = {0}, in[4];
    const nt_transfer ask = {out, in, 4};
    double volts[LONG] = {0.0};
    assert_true(iio_dummy());
    if (nt_iio_open(&iio, "local:", &dummy, 1, reason) != NT_OK)
        fail_msg("%s", reason);
    assert_int_equal(nt_iio_exchange(&iio, 0, &ask, 1), NT_OK);
    const double read = nt_chip_volts(&dummy.chip, &dummy.span, nt_chip_decode(&dummy.chip, in, 0));
    assert_true(fabs(read - (73 + 7) * step) < 0.1 * step);
    assert_int_equal(nt_iio_scan(&iio, 0, "clock", volts, scans), NT_OK);
    for (int i = 0; i < scans; ++i)
        assert_true(fabs(volts[i] - (7 + 7) * step) < 0.1 * step);
    assert_int_equal(nt_iio_scan(&iio, 0, "nobody", volts, scans), NT_E_DEVICE);
    nt_iio_close(&iio);
    print_message("IIO: a number and %d scans at a trigger\n", scans);
}

/* In virtual time only what time may change; a command is a boot of its own, and so is tapping. */
static int run_all(void)
{
    const struct CMUnitTest touch[] = {cmocka_unit_test(a_command_touches)};
    const struct CMUnitTest scan[] = {cmocka_unit_test(a_command_scans)};
    const struct CMUnitTest tapping[] = {cmocka_unit_test_prestate(tapping_is_the_simulated_one, &chips)};
    const struct CMUnitTest at_own_pace[] = {cmocka_unit_test(a_touch_is_the_simulated_one),
                                             cmocka_unit_test(latencies)};
    const struct CMUnitTest at_any[] = {
        cmocka_unit_test(the_half_conforms),
        cmocka_unit_test(lines_in_ticks),
        cmocka_unit_test(outputs_are_what_was_asked),
        cmocka_unit_test(bus_in_ticks),
        cmocka_unit_test(a_short_transfer_is_told_as_whole),
        cmocka_unit_test(a_bus_that_does_not_answer),
        cmocka_unit_test(the_watchdog_has_its_edges),
        cmocka_unit_test(iio_gives_numbers_and_scans),
    };
    if (getenv("FOLDER"))
        return getenv("SCAN") ? cmocka_run_group_tests(scan, NULL, NULL) : cmocka_run_group_tests(touch, NULL, NULL);
    if (getenv("TAPPING"))
        return cmocka_run_group_tests(tapping, NULL, NULL);
    const int failed = is_virtual() ? 0 : cmocka_run_group_tests(at_own_pace, NULL, NULL);
    return failed + cmocka_run_group_tests(at_any, NULL, NULL);
}

int main(void)
{
    if (!kernel_bus_start(&chips) || !gpio_chip(1))
        return 2;
    const int failed = run_all();
    print_message("RESULT %d\n", failed);
    (void)fflush(stdout);
    if (getpid() == 1) /* of the test kernel: where its devices are missing it has returned above */
        (void)reboot(RB_POWER_OFF);
    return failed;
}
