/* SPDX-License-Identifier: BSD-3-Clause
 * Faults of the list in docs/evidence/safety.md that lie below a session, on the drivers themselves: touch step, half
 * on converters, spidev's driver whose system calls end in a model of the kernel's, and the code of the GPIO lines on a
 * fake libgpiod. Single, and each after each other one. Prints the tables of docs/evidence/hardware.md. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "converter_rig.h"
#include "fake_gpiod.h"
#include "host_fixture.h"
#include "larger.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/advanced/hal_linux.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"
#include "spidev_calls.h"
#include "spidev_model.h"

enum { APPROACH = 5000, AFTER = 50 }; /* ticks */

static fake_line *const stop_line = &fake_chips[0].lines[0];
static simulated_bus bus;
static spidev_model model[2];
static struct {
    nt_touch touch;
    nt_touch_state state;
    nt_spi spi;
    nt_gpio *gpio;
    nt_converter_half half;
    nt_hal slave;
    nt_sample sample;
    nt_command command;
    double late; /* of each tick from now on [periods] */
} l;

static int control_call(void *context, int file, unsigned long request, void *argument)
{
    (void)context;
    return model_request(&model[file], (unsigned)request, argument, copy_bytes, NULL);
}

static void begin(int has_crc)
{
    const nt_spi_calls calls = {open_call, control_call, close_call, NULL};
    const nt_spi_device devices[] = {{"0", 1, 10e6}, {"1", has_crc ? 3 : 2, 10e6}};
    const nt_gpio_wiring wiring = {"estop", "limit", NULL, "watchdog", NULL, 0.0};
    fake_chips[0] =
        (fake_chip){.number = 0,
                    .line_count = 3,
                    .lines = {{.name = "estop", .level = 1}, {.name = "limit", .level = 1}, {.name = "watchdog"}}};
    fake_chips[1] = (fake_chip){.number = -1};
    memset(&l, 0, sizeof l);
    bus = simulated_bus_after_power_up();
    bus.has_crc = has_crc;
    for (int i = 0; i < 2; ++i)
        model[i] = (spidev_model){.bus = &bus, .chip = i};
    nt_rig rig = nt_rig_defaults();
    rig.stage.axes = 1.0;
    nt_settings settings = nt_settings_defaults(&rig);
    settings.gains.approach_speed = 10e-6;
    assert_int_equal(nt_touch_make(&l.touch, &rig, &settings, NT_MODE_APPROACH, NULL), NT_OK);
    l.state = nt_touch_start(&l.touch, 0.0, 0.0, 0.0);
    assert_int_equal(nt_spi_open(&l.spi, devices, 2, &calls, NULL), NT_OK);
    assert_int_equal(nt_gpio_open(&wiring, NULL, 0, &l.gpio), NT_OK);
    nt_converter_setup setup = slave_setup(&bus, 0);
    if (has_crc) {
        setup.converter[1].chip = nt_chip_find("AD7768-1");
        setup.felt[NT_Z].channel = 0;
    }
    setup.exchange = nt_spi_exchange;
    setup.bus = &l.spi;
    setup.lines = nt_gpio_lines(l.gpio);
    const nt_configuration configuration = {sizeof configuration, 0, l.touch.period, 1e-6, ""};
    const nt_hal_choice choice = {nt_converter_half_backend(NT_HALF_SLAVE), &l.half};
    assert_int_equal(nt_converter_half_init(&l.half, &setup, NULL), NT_OK);
    assert_int_equal(nt_hal_open(&l.slave, NT_HALF_SLAVE, &choice, &host, NULL), NT_OK);
    assert_int_equal(nt_hal_configure(&l.slave, &configuration, NULL), NT_OK);
    assert_int_equal(nt_hal_arm(&l.slave), NT_OK);
}

static void end(void)
{
    nt_hal_close(&l.slave);
    nt_spi_close(&l.spi);
    nt_gpio_close(l.gpio);
    assert_int_equal(fake_handles, 0);
}

static uint32_t tick(void)
{
    nt_action action = {.size = sizeof action};
    pass(&host, (1.0 + l.late) * l.touch.period);
    assert_int_equal(nt_hal_read(&l.slave), NT_OK);
    l.sample.flags = l.slave.reading.flags;
    l.sample.lateness = l.late * l.touch.period;
    l.sample.stage_position[NT_Z] = l.slave.reading.position[NT_Z];
    l.sample.deflection[NT_Z] = l.slave.reading.felt[NT_Z];
    nt_touch_step(&l.touch, &l.state, &l.sample, &l.command);
    action.state = l.command.state;
    action.target[NT_Z] = l.command.stage_position[NT_Z];
    assert_int_equal(nt_hal_write(&l.slave, &action), NT_OK);
    ++l.sample.tick;
    return l.command.state;
}

static void hold_the_set_point(int has_crc)
{
    begin(has_crc);
    for (int i = 0; i < APPROACH; ++i)
        assert_int_equal(tick(), NT_RUN);
    assert_true(simulated_deflection(&bus) > 0.0);
}

/* --- the faults --- */

typedef struct fault {
    int row;          /* of the list in docs/evidence/safety.md */
    const char *name; /* as the page shows it */
    bus_fault fault;
    int corrupt, error, errors; /* as of simulated_bus */
    fake_line *gone;
    int lost_edges;
    double late;                /* [periods] */
    int needs_crc;              /* the ADC with a check sum */
    int hold, retract, latched; /* ticks, -1: never */
} fault;

#define NEVER -1
static const fault table[] = {
    {.row = 7,
     .name = "a check sum wrong, once",
     .corrupt = 1,
     .needs_crc = 1,
     .hold = 1,
     .retract = NEVER,
     .latched = NEVER},
    {.row = 7,
     .name = "each check sum wrong",
     .corrupt = -1,
     .needs_crc = 1,
     .hold = 1,
     .retract = 2,
     .latched = NT_CONVERTER_BAD},
    {.row = 8,
     .name = "each frame a byte short",
     .fault = BUS_SHORT,
     .hold = 1,
     .retract = 2,
     .latched = NT_CONVERTER_BAD},
    {.row = 9, .name = "EIO, once", .error = EIO, .errors = 1, .hold = 1, .retract = NEVER, .latched = NEVER},
    {.row = 9, .name = "EIO", .error = EIO, .errors = -1, .hold = 1, .retract = 2, .latched = NT_CONVERTER_BAD},
    {.row = 9, .name = "EBUSY", .error = EBUSY, .errors = -1, .hold = 1, .retract = 2, .latched = NT_CONVERTER_BAD},
    {.row = 9, .name = "ENODEV", .error = ENODEV, .errors = -1, .hold = NEVER, .retract = NEVER, .latched = 1},
    {.row = 9, .name = "EINTR, twice", .error = EINTR, .errors = 2, .hold = NEVER, .retract = NEVER, .latched = NEVER},
    {.row = 9, .name = "EINTR", .error = EINTR, .errors = -1, .hold = 1, .retract = 2, .latched = NT_CONVERTER_BAD},
    {.row = 10,
     .name = "line of the stop gone",
     .gone = &fake_chips[0].lines[0],
     .hold = NEVER,
     .retract = NEVER,
     .latched = 1},
    {.row = 10, .name = "edges of the stop lost", .lost_edges = 1, .hold = NEVER, .retract = NEVER, .latched = 1},
    {.row = 10,
     .name = "line of the limit gone",
     .gone = &fake_chips[0].lines[1],
     .hold = NEVER,
     .retract = 1,
     .latched = NEVER},
    {.row = 10,
     .name = "line of the watchdog gone",
     .gone = &fake_chips[0].lines[2],
     .hold = NEVER,
     .retract = NEVER,
     .latched = NEVER},
    {.row = 11, .name = "each tick 1.5 periods late", .late = 1.5, .hold = 5, .retract = NEVER, .latched = NEVER},
    {.row = 11, .name = "each tick 6 periods late", .late = 6.0, .hold = 5, .retract = NEVER, .latched = NEVER},
};
enum { FAULTS = sizeof table / sizeof *table };

static void strike(const fault *f)
{
    if (f->fault != BUS_WELL)
        bus.fault = f->fault;
    if (f->corrupt && bus.corrupt >= 0)
        bus.corrupt = f->corrupt;
    if (f->errors && (bus.errors >= 0 || f->errors < 0)) { /* one that stays, stays */
        bus.error = f->error;
        bus.errors = f->errors;
    }
    if (f->gone)
        f->gone->gone = 1;
    if (f->lost_edges) {
        fake_edge(stop_line, 0, 1);
        fake_edge(stop_line, 1, 1);
        fake_edge(stop_line, 1, 0);
    }
    l.late = larger(l.late, f->late);
}

static double lowest; /* that the stage was, by its travel [m] */

/* Ticks until each state, NEVER within AFTER; the second fault strikes one tick after the first. */
static void react(const fault *first, const fault *second, int ticks[4])
{
    for (int i = 0; i < 4; ++i)
        ticks[i] = NEVER;
    strike(first);
    for (int i = 1; i <= AFTER; ++i) {
        if (i == 2 && second)
            strike(second);
        const uint32_t reached = tick();
        if (ticks[reached] < 0)
            ticks[reached] = i;
        lowest = larger(lowest, simulated_travel(&bus));
    }
}

static const char *said(int ticks, char word[8])
{
    (void)snprintf(word, 8, ticks < 0 ? "-" : "%d", ticks);
    return word;
}

static void each_fault_in_ticks(void **state)
{
    (void)state;
    print_message("| row | fault | HOLD | RETRACT | LATCHED |\n|---|---|---|---|---|\n");
    for (int i = 0; i < FAULTS; ++i) {
        const fault *f = &table[i];
        char words[3][8];
        int ticks[4];
        hold_the_set_point(f->needs_crc);
        react(f, NULL, ticks);
        print_message("| %d | %s | %s | %s | %s |\n", f->row, f->name, said(ticks[NT_HOLD], words[0]),
                      said(ticks[NT_RETRACT], words[1]), said(ticks[NT_LATCHED], words[2]));
        assert_int_equal(ticks[NT_HOLD], f->hold);
        assert_int_equal(ticks[NT_RETRACT], f->retract);
        assert_int_equal(ticks[NT_LATCHED], f->latched);
        end();
    }
}

/* Two faults: what one alone would latch or retract, both do, no later; and nothing presses the tip on. */
static void two_faults_are_no_milder_than_one(void **state)
{
    (void)state;
    int pairs = 0, latched = 0;
    double most = 0.0;
    for (int i = 0; i < FAULTS; ++i)
        for (int k = 0; k < FAULTS; ++k) {
            const fault *a = &table[i], *b = &table[k];
            int ticks[4];
            hold_the_set_point(a->needs_crc || b->needs_crc);
            const double before = lowest = simulated_travel(&bus);
            react(a, b, ticks);
            const int one = a->latched > 0 ? a->latched : AFTER, other = b->latched > 0 ? b->latched + 1 : AFTER;
            const int due = one < other ? one : other;
            if (due < AFTER && !(ticks[NT_LATCHED] > 0 && ticks[NT_LATCHED] <= due))
                fail_msg("%s, then %s: LATCHED after %d ticks instead of %d", a->name, b->name, ticks[NT_LATCHED], due);
            if ((a->hold > 0 || b->hold > 0) && ticks[NT_RUN] == 1 && a->hold == 1)
                fail_msg("%s, then %s: RUN", a->name, b->name);
            most = larger(most, lowest - before);
            latched += ticks[NT_LATCHED] > 0;
            ++pairs;
            end();
        }
    print_message("%d pairs, %d latched; pressed on by %.2f nm at most\n", pairs, latched, 1e9 * most);
    assert_true(most < 2e-9);
}

static void a_second_program_is_refused(void **state)
{
    (void)state;
    const nt_gpio_wiring wiring = {"estop", NULL, NULL, NULL, NULL, 0.0};
    char reason[256] = "";
    begin(0);
    nt_gpio *second = NULL;
    stop_line->refuse = EBUSY; /* the kernel's answer to a request for a line that is held */
    assert_int_not_equal(nt_gpio_open(&wiring, reason, sizeof reason, &second), NT_OK);
    print_message("| 33 | lines that another program has | refused: %s |\n", reason);
    stop_line->refuse = 0;
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_fault_in_ticks),
        cmocka_unit_test(two_faults_are_no_milder_than_one),
        cmocka_unit_test(a_second_program_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
