/* SPDX-License-Identifier: BSD-3-Clause
 * A command in the test kernel, as somebody at a rig gives it: `nanotouch touch --scene rig.toml`. Meanwhile this
 * program plays the chips, and behind them the library's simulated slave plays stage, probe and sample. Include after
 * cmocka. */
#ifndef TESTS_KERNEL_COMMAND_H
#define TESTS_KERNEL_COMMAND_H

#include <sys/wait.h>

#include "kernel_rig.h"
#include "nanotouch/session.h"
#include "nanotouch/sim.h"

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

/* Without the noise of sensors: what is left are the steps of the converters. */
static nt_terrain *begin_to_play(void)
{
    const nt_session_setup defaults = nt_session_defaults();
    nt_rig rig = nt_rig_defaults();
    nt_terrain_setup ground = nt_terrain_defaults();
    nt_terrain *terrain = NULL;
    rig.stage.axes = 1.0;
    rig.stage.noise = rig.probe.noise = 0.0;
    assert_int_equal(nt_terrain_make(&terrain, &ground, NULL), NT_OK);
    const nt_sim_setup made = {.plan = nt_terrain_plan(terrain),
                               .rig = &rig,
                               .period = 1.0 / COMMAND_RATE,
                               .clearance = defaults.clearance,
                               .seed = defaults.seed,
                               .delay = nt_settings_defaults(&rig).gains.delay};
    assert_int_equal(nt_sim_slave_init(&played, &made), NT_OK);
    chips.plays = play_slave;
    return terrain;
}

/* In FOLDER, which has rig.toml and gets the recording; NANOTOUCH is the command. */
static void a_command_touches(void **state)
{
    (void)state;
    const char *folder = getenv("FOLDER"), *command = getenv("NANOTOUCH");
    int ended = -1;
    assert_non_null(command);
    assert_int_equal(chdir(folder), 0);
    nt_terrain *terrain = begin_to_play();
    const pid_t child = fork();
    if (child == 0) {
        (void)execl(command, command, "touch", "--scene", "rig.toml", "--mode", "curve", "--out", "real", "--overwrite",
                    (char *)NULL);
        _exit(127);
    }
    assert_int_equal(waitpid(child, &ended, 0), child);
    assert_true(WIFEXITED(ended));
    assert_int_equal(WEXITSTATUS(ended), 0);
    assert_int_equal(line_level("laser-en"), 0);
    assert_int_equal(chips.wrong_mode, 0);
    chips.plays = NULL;
    nt_terrain_close(terrain);
}

#endif
