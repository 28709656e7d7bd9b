/* SPDX-License-Identifier: BSD-3-Clause
 * Commands in the test kernel, as somebody at a rig gives them: `nanotouch touch --scene rig.toml`, and `scan` with
 * another rig. Meanwhile this program plays the chips, and behind them the library's simulated slave plays stage, probe
 * and sample. Include after cmocka. */
#ifndef TESTS_KERNEL_COMMAND_H
#define TESTS_KERNEL_COMMAND_H

#include <sys/wait.h>

#include "hal/sim/sim.h"
#include "kernel_rig.h"
#include "nanotouch/advanced/sim.h"
#include "nanotouch/session.h"

#define COMMAND_RATE 1e3 /* of the rig file [Hz] */

static nt_sim_slave played;

static double code_of(double volts)
{
    const double code = floor(volts / 20.0 * 65536.0 + 0.5);
    return code > 32767.0 ? 32767.0 : code < -32768.0 ? -32768.0 : code;
}

/* A button and a switch that are closed hold their lines up, against the bias of a request. gpio-sim knows no such
 * thing, and is told with the first frame after it. */
static void close_switches(void)
{
    static int is_told;
    if (is_told++)
        return;
    pull_line("estop", 1);
    pull_line("limit", 1);
}

/* Of an AD5686 in the AD5791's place, 0 .. 5 V: x, y and z. */
static struct {
    uint32_t codes[NT_AXES], reply;
} outputs;

static void ad5686(const uint8_t *out, uint8_t *in)
{
    const uint32_t word = (uint32_t)out[0] << 16 | (uint32_t)out[1] << 8 | out[2];
    in[0] = 0, in[1] = (uint8_t)(outputs.reply >> 8), in[2] = (uint8_t)outputs.reply;
    outputs.reply = 0;
    for (int axis = NT_X; axis <= NT_Z; ++axis)
        if (word >> (16 + axis) & 1u) {
            outputs.reply = word >> 20 == 9u ? outputs.codes[axis] : 0u;
            outputs.codes[axis] = word >> 20 == 3u ? word & 0xFFFFu : outputs.codes[axis];
        }
}

/* A period passes with each code for z, the last of the three; the ADC says x, y, z and the deflection. */
static void play_scanned(kernel_bus *k, int chip, const uint8_t *out, struct nanotouch_frame *frame)
{
    close_switches();
    simulated_frame(&k->bus, chip, out, frame->bytes, frame->length);
    if (chip == 0 && frame->length == 3) {
        nt_action action = {.size = sizeof action};
        ad5686(out, frame->bytes);
        for (int axis = NT_X; axis <= NT_Z; ++axis)
            action.target[axis] = 20e-6 * (outputs.codes[axis] / 65536.0 - 0.5);
        if (out[0] == 0x34)
            (void)nt_sim_slave_write(&played, &action);
    }
    if (chip == 1) {
        nt_reading reading = {.size = sizeof reading};
        (void)nt_sim_slave_read(&played, &reading);
        for (uint32_t i = 0; i < 8 && i < frame->length; ++i) {
            const double volts = i < 6 ? reading.position[i / 2] / STAGE_GAIN : reading.felt[NT_Z] / DEFLECTION_GAIN;
            frame->bytes[i] = (uint8_t)((uint32_t)(int32_t)code_of(volts) >> (i % 2 ? 0 : 8));
        }
    }
}

/* A period passes with each code that the DAC is given; the ADC says where the slave is then. */
static void play_slave(kernel_bus *k, int chip, const uint8_t *out, struct nanotouch_frame *frame)
{
    close_switches();
    simulated_frame(&k->bus, chip, out, frame->bytes, frame->length);
    if (chip == 0 && out[0] >> 4 == 1) {
        const nt_action action = {.size = sizeof action, .target = {0.0, 0.0, simulated_travel(&k->bus)}};
        (void)nt_sim_slave_write(&played, &action);
    }
    if (chip == 1) {
        nt_reading reading = {.size = sizeof reading};
        (void)nt_sim_slave_read(&played, &reading);
        const double inputs[] = {reading.position[NT_Z] / STAGE_GAIN, reading.felt[NT_Z] / DEFLECTION_GAIN};
        for (uint32_t i = 0; i < 4 && i < frame->length; ++i)
            frame->bytes[i] = (uint8_t)((uint32_t)(int32_t)code_of(inputs[i / 2]) >> (i % 2 ? 0 : 8));
    }
}

enum { WAVE = 64 };              /* pixels to a side */
#define WAVE_PIXEL (2e-6 / WAVE) /* [m] */
#define PARKED 0.5e-6            /* of the stage before a scan, x and y [m] */

/* Waves along x, 40 nm high and 2 um long, as the apex of the tip goes over them: those of command.py. */
static nt_height_map waves(double heights[WAVE * WAVE])
{
    for (int i = 0; i < WAVE * WAVE; ++i)
        heights[i] = 20e-9 * cos(2.0 * NT_PI * (i % WAVE) / WAVE);
    return (nt_height_map){.heights = heights, .nx = WAVE, .ny = WAVE, .dx = WAVE_PIXEL, .dy = WAVE_PIXEL};
}

/* Without the noise of sensors: what is left are the steps of the converters. */
static nt_terrain *begin_to_play(int is_scan)
{
    static double heights[WAVE * WAVE];
    const nt_session_setup defaults = nt_session_defaults();
    nt_rig rig = nt_rig_defaults();
    nt_terrain_setup ground = nt_terrain_defaults();
    nt_terrain *terrain = NULL;
    rig.stage.axes = is_scan ? 3.0 : 1.0;
    rig.stage.noise = rig.probe.noise = 0.0;
    if (is_scan)
        ground.map = waves(heights);
    assert_int_equal(nt_terrain_make(&terrain, &ground, NULL), NT_OK);
    const nt_sim_setup made = {.plan = nt_terrain_plan(terrain),
                               .rig = &rig,
                               .period = 1.0 / COMMAND_RATE,
                               .x = is_scan ? PARKED : 0.0,
                               .y = is_scan ? PARKED : 0.0,
                               .clearance = defaults.clearance,
                               .seed = defaults.seed,
                               .delay = nt_settings_defaults(&rig).gains.delay};
    assert_int_equal(nt_sim_slave_init(&played, &made), NT_OK);
    for (int axis = NT_X; axis <= NT_Z; ++axis)
        outputs.codes[axis] = axis == NT_Z ? 0x8000u : (uint32_t)lround(65536.0 * (0.5 + PARKED / 20e-6));
    chips.plays = is_scan ? play_scanned : play_slave;
    return terrain;
}

/* In FOLDER, which has NAME.toml and gets the results; NANOTOUCH is the command, `words` its arguments. */
static void run_command(char *const words[])
{
    const char *folder = getenv("FOLDER"), *command = getenv("NANOTOUCH");
    int ended = -1;
    assert_non_null(command);
    assert_int_equal(chdir(folder), 0);
    nt_terrain *terrain = begin_to_play(strcmp(words[1], "scan") == 0);
    const pid_t child = fork();
    if (child == 0) {
        (void)execv(command, words);
        _exit(127);
    }
    assert_int_equal(waitpid(child, &ended, 0), child);
    assert_true(WIFEXITED(ended));
    assert_int_equal(WEXITSTATUS(ended), 0);
    assert_int_equal(line_level("laser-en"), 0);
    chips.plays = NULL;
    nt_terrain_close(terrain);
}

static void a_command_touches(void **state)
{
    (void)state;
    static char *words[] = {"nanotouch", "touch", "--scene",       "rig.toml",    "--mode", "curve",
                            "--out",     "real",  "--no-pictures", "--overwrite", NULL};
    run_command(words);
    assert_int_equal(chips.wrong_mode, 0);
}

static void a_command_scans(void **state)
{
    (void)state;
    static char *words[] = {"nanotouch", "scan", "--scene", "scan.toml", "--out", "scanned", "--overwrite", NULL};
    run_command(words);
}

#endif
