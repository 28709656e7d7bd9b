/* SPDX-License-Identifier: BSD-3-Clause
 * A slave that taps on modelled chips, and a line over a wave with it. An AD5686 drives x, z, and amplitude and
 * frequency of the drive; an AD7606 reads x, z, deflection, amplitude and lag; behind them is the simulated slave.
 * Include after cmocka. */
#ifndef TESTS_TAPPING_RIG_H
#define TESTS_TAPPING_RIG_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "converter_rig.h"
#include "hal/sim/sim.h"
#include "host_fixture.h"
#include "larger.h"
#include "nanotouch/advanced/hal_linux.h"
#include "nanotouch/material.h"
#include "nanotouch/nanotouch.h"

enum {
    LOWEST = 1, /* code that a DAC is given */
    DOWN = 3000,
    LINE = 12000,
    TICKS = DOWN + 2 * LINE,
    DAC_OUTPUTS = 4,
    GRID = 64
};

#define A0 20e-9
#define FREQUENCY 300e3
#define PERIOD 1e-4
#define REACH 2e-6 /* of x and z [m] */
#define GRID_STEP (REACH / 2.0 / GRID)

/* What a volt means; the DAC has 0 .. 5 V. */
static const double dac_gain[DAC_OUTPUTS] = {REACH / 5.0, REACH / 5.0, 12e-9, 100e3};
static const double dac_offset[DAC_OUTPUTS] = {0.0, -0.5 * REACH, 0.0, 0.0};
/* x, z, deflection, amplitude, lag; the ADC has -10 .. 10 V. */
static const double adc_gain[5] = {0.2e-6, 0.2e-6, 33e-9, 4e-9, 0.4};

static simulated_bus bus;
static nt_sim_slave played;
static nt_terrain *terrain;
static uint32_t codes[DAC_OUTPUTS], answer;
static int is_at_once;       /* the stage stands where it is told to be */
static int is_deaf_to_drive; /* the oscillator has lost its input */

/* --- chips --- */

static double output(int channel)
{
    return dac_offset[channel] + dac_gain[channel] * 5.0 * codes[channel] / 65536.0;
}

/* A period passes with each code for z. */
static void play_dac(const uint8_t *out, uint8_t *in)
{
    const uint32_t command = out[0] >> 4u, word = (uint32_t)out[1] << 8 | out[2];
    in[1] = (uint8_t)(answer >> 8), in[2] = (uint8_t)answer;
    answer = 0;
    for (int i = 0; i < DAC_OUTPUTS; ++i) {
        if (!(out[0] >> i & 1u))
            continue;
        answer = command == 9u ? codes[i] : 0u;
        codes[i] = command == 3u ? word : codes[i];
        if (command == 3u && i == 1) {
            const nt_action action = {.size = sizeof action,
                                      .target = {output(0), 0.0, output(1)},
                                      .drive_amplitude = is_deaf_to_drive ? 0.0 : output(2),
                                      .drive_frequency = output(3)};
            assert_int_equal(nt_sim_slave_write(&played, &action), NT_OK);
        }
    }
}

static void play(simulated_bus *own, int chip, const uint8_t *out, uint8_t *in, uint32_t count)
{
    (void)own;
    if (chip == 0 && count == 3)
        play_dac(out, in);
    if (chip == 0)
        return;
    nt_reading reading = {.size = sizeof reading};
    assert_int_equal(nt_sim_slave_read(&played, &reading), NT_OK);
    const double z = is_at_once ? output(1) : reading.position[NT_Z];
    const double values[] = {reading.position[NT_X], z, reading.felt[NT_Z], reading.amplitude, reading.lag};
    for (uint32_t i = 0; i < 10 && i < count; ++i) {
        const double code = floor(values[i / 2] / adc_gain[i / 2] / 20.0 * 65536.0 + 0.5);
        in[i] = (uint8_t)((uint32_t)(int32_t)larger(-32768.0, smaller(32767.0, code)) >> (i % 2 ? 0 : 8));
    }
}

/* --- the rig --- */

static nt_rig rig_without_noise(void)
{
    nt_rig rig = nt_rig_defaults();
    rig.probe.spring_constant = 40.0;
    rig.probe.quality = 200.0;
    rig.probe.resonance = FREQUENCY;
    rig.stage.noise = rig.probe.noise = rig.stage.resolution = 0.0;
    rig.stage.command_resolution = rig.probe.resolution = 1e-13;
    rig.stage.resolution = 1e-13;
    return rig;
}

static nt_settings settings_of(const nt_rig *rig)
{
    nt_settings settings = nt_settings_defaults(rig);
    settings.tap.noise = 0.0;
    return settings;
}

/* A wave along x, 20 nm high and 1 um long. */
static void begin_to_play(void)
{
    static double heights[GRID * GRID];
    const nt_rig rig = rig_without_noise();
    nt_terrain_setup ground = nt_terrain_defaults();
    for (int i = 0; i < GRID * GRID; ++i)
        heights[i] = 10e-9 * sin(2.0 * NT_PI * (i % GRID) / GRID);
    ground.map = (nt_height_map){.heights = heights, .nx = GRID, .ny = GRID, .dx = GRID_STEP, .dy = GRID_STEP};
    ground.scene.tip.radius = 10e-9;
    ground.scene.medium.relative_humidity = 0.0;
    assert_int_equal(nt_terrain_make(&terrain, &ground, NULL), NT_OK);
    const nt_sim_lock_in lock_in = {.drive = {NT_DRIVE_BASE, 0.0, A0}, .time = 20e-6, .sensor = {0.0, 0.0, 4.0 * A0}};
    const nt_sim_setup setup = {.plan = nt_terrain_plan(terrain),
                                .rig = &rig,
                                .period = PERIOD,
                                .x = 0.1e-6,
                                .clearance = 0.1e-6,
                                .seed = 1,
                                .delay = 1.0,
                                .lock_in = &lock_in};
    assert_int_equal(nt_sim_slave_init(&played, &setup), NT_OK);
    is_deaf_to_drive = is_at_once = 0;
    codes[0] = 3277u; /* 0.1 um */
    codes[1] = 0x8000u;
    codes[2] = codes[3] = answer = 0u;
    bus = simulated_bus_after_power_up();
    bus.plays = play;
}

static nt_converter_channel channel(int converter, int number, double gain, double minimum, double maximum)
{
    return (nt_converter_channel){
        .is_used = 1, .converter = converter, .channel = number, .gain = gain, .minimum = minimum, .maximum = maximum};
}

static nt_converter_setup tapping_half(nt_spi *spi)
{
    nt_converter_setup setup = {
        .half = NT_HALF_SLAVE, .axes = 2, .converters = 2, .exchange = nt_spi_exchange, .bus = spi};
    setup.converter[0] = (nt_converter){nt_chip_find("AD5686"), {0.0, 5.0}};
    setup.converter[1] = (nt_converter){nt_chip_find("AD7606"), {-10.0, 10.0}};
    setup.driven[NT_X] = channel(0, 0, dac_gain[0], 0.0, REACH);
    setup.driven[NT_Z] = channel(0, 1, dac_gain[1], -0.5 * REACH, 0.5 * REACH);
    setup.driven[NT_Z].offset = dac_offset[1];
    setup.driven[NT_DRIVES_AMPLITUDE] = channel(0, 2, dac_gain[2], 0.0, 3.0 * A0);
    setup.driven[NT_DRIVES_FREQUENCY] = channel(0, 3, dac_gain[3], 100e3, 499e3);
    setup.position[NT_X] = channel(1, 0, adc_gain[0], -0.5 * REACH, 0.99 * REACH);
    setup.position[NT_Z] = channel(1, 1, adc_gain[1], -0.5 * REACH, 0.5 * REACH);
    setup.felt[NT_Z] = channel(1, 2, adc_gain[2], -0.3e-6, 0.3e-6);
    setup.lock_in[NT_LOCK_IN_AMPLITUDE] = channel(1, 3, adc_gain[3], -1e-9, 39e-9);
    setup.lock_in[NT_LOCK_IN_LAG] = channel(1, 4, adc_gain[4], -3.2, 3.2);
    return setup;
}

static nt_spi spi;
static nt_converter_half half;

/* --- a line, there and back --- */

typedef struct line {
    double height[TICKS], amplitude[TICKS], lag[TICKS];
    uint32_t state;
} line;

/* Comes down, goes along the line and back, for so many ticks of it. */
static void take(const nt_hal_choice *choice, line *taken, int ticks)
{
    const nt_rig rig = rig_without_noise();
    const nt_settings settings = settings_of(&rig);
    nt_touch touch;
    nt_hal hal;
    nt_problem problem = {0};
    if (nt_touch_make(&touch, &rig, &settings, NT_MODE_TAPPING, &problem) != NT_OK)
        fail_msg("%s = %g", problem.field, problem.value);
    nt_touch_state state = nt_touch_start(&touch, 0.0, 0.1e-6, 0.0);
    const nt_configuration configuration = {sizeof configuration, 0, PERIOD, 1e-7, ""};
    assert_int_equal(nt_hal_open(&hal, NT_HALF_SLAVE, choice, &host, NULL), NT_OK);
    assert_true(hal.capabilities.can & NT_CAN_TAP);
    assert_int_equal(nt_hal_configure(&hal, &configuration, NULL), NT_OK);
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
    nt_sample sample = {.tick = 0};
    nt_command command = {.drive_amplitude = touch.drive_amplitude, .drive_frequency = touch.drive_frequency};
    for (int i = -200; i < ticks; ++i) { /* first the lever swings up */
        nt_action action = {.size = sizeof action};
        pass(&host, PERIOD);
        assert_int_equal(nt_hal_read(&hal), NT_OK);
        sample.flags = hal.reading.flags;
        sample.stage_position[NT_X] = hal.reading.position[NT_X];
        sample.stage_position[NT_Z] = hal.reading.position[NT_Z];
        sample.deflection[NT_Z] = hal.reading.felt[NT_Z];
        sample.amplitude = hal.reading.amplitude;
        sample.lag = hal.reading.lag;
        if (i == DOWN || i == DOWN + LINE)
            assert_int_equal(nt_touch_aim(&touch, &state, i == DOWN ? 0.9e-6 : 0.1e-6, 0.0, PERIOD * LINE), NT_OK);
        if (i >= 0) {
            nt_touch_step(&touch, &state, &sample, &command);
            taken->height[i] = -sample.stage_position[NT_Z];
            taken->amplitude[i] = sample.amplitude;
            taken->lag[i] = sample.lag;
            taken->state = command.state > taken->state ? command.state : taken->state;
        }
        action.state = command.state;
        action.target[NT_X] = i < 0 ? 0.1e-6 : command.stage_position[NT_X];
        action.target[NT_Z] = command.stage_position[NT_Z];
        action.drive_amplitude = command.drive_amplitude;
        action.drive_frequency = command.drive_frequency;
        assert_int_equal(nt_hal_write(&hal, &action), NT_OK);
        ++sample.tick;
    }
    nt_hal_close(&hal);
}

/* From a tick to another one. */
static double apart(const double *a, const double *b, int from, int to)
{
    double most = 0.0;
    for (int i = from; i < to; ++i)
        most = larger(most, fabs(a[i] - b[i]));
    return most;
}

/* A step of each converter that the height is made of [m]. */
static double steps_of_height(void)
{
    return dac_gain[1] * 5.0 / 65536.0 + (adc_gain[1] + adc_gain[3]) * 20.0 / 65536.0;
}

#endif
