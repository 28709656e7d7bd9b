/* SPDX-License-Identifier: BSD-3-Clause
 * A whole touch, as `nanotouch touch --mode curve` makes it: a session at hard pace on the devices of the test kernel,
 * behind whose chips the library's simulated slave plays stage, probe and sample; beside the same session on that
 * slave without kernel and converters. Include after cmocka. */
#ifndef TESTS_KERNEL_SESSION_H
#define TESTS_KERNEL_SESSION_H

#include "kernel_rig.h"
#include "session_fixture.h"

enum { TOUCH_TICKS = 4000, TOUCH_RATE = 1000 };
#define TOUCH_SPEED 0.1e-6 /* [m/s] */

static nt_sim_slave played;

static double code_of(double volts)
{
    const double code = floor(volts / 20.0 * 65536.0 + 0.5);
    return code > 32767.0 ? 32767.0 : code < -32768.0 ? -32768.0 : code;
}

/* A period passes with each code that the DAC is given; the ADC says where the slave is then. */
static void play_slave(kernel_bus *k, int chip, const uint8_t *out, struct nanotouch_frame *frame)
{
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

/* Down to 100 nN and back by 200 nm, without the noise of sensors: what is left are the steps of the converters. */
static nt_session_setup setup_of_touch(void)
{
    nt_session_setup setup = nt_session_defaults();
    setup.rig.stage.axes = 1.0;
    setup.rig.stage.noise = setup.rig.probe.noise = 0.0;
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.settings.gains.rate = TOUCH_RATE;
    setup.settings.gains.approach_speed = TOUCH_SPEED;
    setup.settings.gains.curve_length = 0.2e-6;
    setup.mode = NT_MODE_CURVE;
    setup.ring_capacity = TOUCH_TICKS;
    setup.minimum_margin = 0.0;
    return setup;
}

static void play_from(const nt_session_setup *setup, nt_terrain **terrain)
{
    nt_terrain_setup ground = nt_terrain_defaults();
    ground.scene = setup->scene;
    assert_int_equal(nt_terrain_make(terrain, &ground, NULL), NT_OK);
    const nt_sim_setup made = {.plan = nt_terrain_plan(*terrain),
                               .rig = &setup->rig,
                               .period = 1.0 / TOUCH_RATE,
                               .clearance = setup->clearance,
                               .seed = setup->seed,
                               .delay = setup->settings.gains.delay};
    assert_int_equal(nt_sim_slave_init(&played, &made), NT_OK);
}

static long touch_on_kernel(nt_record *records)
{
    nt_session_setup setup = setup_of_touch();
    nt_terrain *terrain = NULL;
    play_from(&setup, &terrain);
    open_drivers();
    chips.plays = play_slave;
    const nt_converter_setup converters = setup_of_slave(1);
    assert_int_equal(nt_converter_half_init(&l.half, &converters, NULL), NT_OK);
    setup.slave = (nt_hal_choice){nt_converter_half_backend(NT_HALF_SLAVE), &l.half};
    nt_session *session = open_session(&setup);
    assert_int_equal(nt_session_start(session, NT_PACE_HARD, TOUCH_TICKS), NT_OK);
    const struct timespec whole = {.tv_sec = 1 + TOUCH_TICKS / TOUCH_RATE};
    (void)nanosleep(&whole, NULL);
    assert_int_equal(nt_session_halt(session), NT_OK);
    const long count = nt_session_read(session, records, TOUCH_TICKS);
    nt_session_close(session);
    chips.plays = NULL;
    close_drivers();
    nt_terrain_close(terrain);
    return count;
}

/* The nearest deflection of the simulated touch within two ticks: where the lever jumps, it may do so a tick apart. */
static double bend_apart(const nt_record *simulated, long at, double deflection)
{
    double least = HUGE_VAL;
    for (long i = at - 2; i <= at + 2; ++i)
        if (i >= 0 && i < TOUCH_TICKS)
            least = smaller(least, fabs(deflection - simulated[i].deflection[NT_Z]));
    return least;
}

/* In virtual time only: on a machine that is busy ticks come late, and a late tick is held. */
static void a_whole_touch_is_the_simulated_one(void **state)
{
    (void)state;
    static nt_record real[TOUCH_TICKS], simulated[TOUCH_TICKS];
    const double tick = TOUCH_SPEED / TOUCH_RATE, dac = 20e-6 / 1048575.0, sensor = 20e-6 / 65536.0;
    if (!getenv("TIME"))
        return;
    const nt_session_setup setup = setup_of_touch();
    /* of the travel one step of the simulated stage's own read-out, too, on whose edge both may lie */
    const double bend_bound = tick + 2.0 * (dac + sensor), bound = bend_bound + setup.rig.stage.resolution;
    nt_session *session = open_session(&setup);
    run(session, simulated, TOUCH_TICKS);
    nt_session_close(session);
    assert_int_equal(touch_on_kernel(real), TOUCH_TICKS);
    double way = 0.0, bend = 0.0, pull = 0.0, press = 0.0;
    for (long i = 0; i < TOUCH_TICKS; ++i) {
        way = larger(way, fabs(real[i].stage_position[NT_Z] - simulated[i].stage_position[NT_Z]));
        bend = larger(bend, bend_apart(simulated, i, real[i].deflection[NT_Z]));
        press = larger(press, real[i].slave_force);
        pull = larger(pull, -real[i].slave_force);
        assert_int_equal(real[i].state, simulated[i].state);
    }
    print_message(
        "a whole touch, %d ticks: pressed by %.1f nN, pulled by %.1f nN; beside the simulated one travel within "
        "%.2f nm (steps: %.2f nm), deflection within %.2f nm\n",
        TOUCH_TICKS, 1e9 * press, 1e9 * pull, 1e9 * way, 1e9 * bound, 1e9 * bend);
    assert_true(press > 90e-9 && pull > 10e-9);
    assert_int_equal(real[TOUCH_TICKS - 1].phase, NT_PHASE_DONE);
    assert_int_equal(simulated[TOUCH_TICKS - 1].phase, NT_PHASE_DONE);
    assert_true(way <= bound);
    assert_true(bend <= bend_bound);
}

#endif
