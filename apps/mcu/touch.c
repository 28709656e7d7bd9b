/* SPDX-License-Identifier: BSD-3-Clause
 * The loop: read the slave, one touch step, write. The same half on converters as on a PC; only the exchange is the
 * board's. All of it is of fixed size. */
#include "touch.h"

#include <math.h>
#include <string.h>

#define STAGE_GAIN 1e-6       /* [m/V] */
#define DEFLECTION_GAIN 33e-9 /* [m/V] */

static nt_converter_half half; /* too large for a small stack */
static nt_touch touch;
static nt_touch_state state;

static nt_converter_setup converters_of(const board *at)
{
    nt_converter_setup setup = {
        .half = NT_HALF_SLAVE, .axes = 1, .converters = 2, .exchange = at->exchange, .bus = at->bus};
    setup.converter[0] = (nt_converter){nt_chip_find("AD5791"), {-10.0, 10.0}};
    setup.converter[1] = (nt_converter){nt_chip_find("AD7606"), {-10.0, 10.0}};
    setup.driven[NT_Z] = (nt_converter_channel){.is_used = 1, .gain = STAGE_GAIN, .minimum = -10e-6, .maximum = 10e-6};
    setup.position[NT_Z] = setup.driven[NT_Z]; /* what the DAC says that it holds */
    setup.felt[NT_Z] = (nt_converter_channel){
        .is_used = 1, .converter = 1, .channel = 1, .gain = DEFLECTION_GAIN, .minimum = -0.33e-6, .maximum = 0.33e-6};
    return setup;
}

static nt_status make_touch(void)
{
    nt_rig rig = nt_rig_defaults();
    rig.stage.axes = 1.0;
    const nt_settings settings = nt_settings_defaults(&rig);
    const nt_status status = nt_touch_make(&touch, &rig, &settings, NT_MODE_APPROACH, NULL);
    if (status == NT_OK)
        state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
    return status;
}

static nt_status open_slave(nt_hal *slave, const board *at)
{
    const nt_converter_setup setup = converters_of(at);
    const nt_configuration configuration = {sizeof configuration, 0, touch.period, 1e-6, ""};
    const nt_hal_choice choice = {nt_converter_half_backend(NT_HALF_SLAVE), &half};
    nt_status status = nt_converter_half_init(&half, &setup, NULL);
    if (status == NT_OK)
        status = nt_hal_open(slave, NT_HALF_SLAVE, &choice, &at->host, NULL);
    if (status == NT_OK)
        status = nt_hal_configure(slave, &configuration, NULL);
    return status == NT_OK ? nt_hal_arm(slave) : status;
}

static void add_to_sum(outcome *so_far, const nt_command *command)
{
    uint8_t bytes[sizeof command->stage_position[NT_Z]];
    memcpy(bytes, &command->stage_position[NT_Z], sizeof bytes);
    for (size_t i = 0; i < sizeof bytes; ++i) /* FNV-1a */
        so_far->command_sum = (so_far->command_sum ^ bytes[i]) * 0x100000001b3u;
}

static nt_status one_tick(nt_hal *slave, const board *at, outcome *so_far)
{
    nt_command command;
    nt_action action = {.size = sizeof action, .tick = (uint64_t)so_far->ticks};
    nt_sample sample = {.tick = action.tick}; /* a hand at rest at 0: this mode needs none */
    nt_status status = nt_hal_read(slave);
    const nt_reading *reading = &slave->reading;
    sample.flags = reading->flags;
    sample.age = 1e-9 * (double)(at->host.now(&at->host) - reading->time);
    sample.stage_position[NT_Z] = reading->position[NT_Z];
    sample.deflection[NT_Z] = reading->felt[NT_Z];
    nt_touch_step(&touch, &state, &sample, &command);
    action.state = command.state;
    action.target[NT_Z] = command.stage_position[NT_Z];
    if (status == NT_OK)
        status = nt_hal_write(slave, &action);
    so_far->state = command.state;
    so_far->travel = reading->position[NT_Z];
    so_far->force = touch.rig.probe.spring_constant * reading->felt[NT_Z];
    so_far->largest = so_far->force > so_far->largest ? so_far->force : so_far->largest;
    add_to_sum(so_far, &command);
    return status;
}

outcome touch_run(const board *at, long ticks)
{
    outcome result = {.status = make_touch(), .command_sum = 0xcbf29ce484222325u};
    nt_hal slave = {.backend = NULL};
    if (result.status == NT_OK)
        result.status = open_slave(&slave, at);
    for (; result.ticks < ticks && result.status == NT_OK; ++result.ticks) {
        result.status = one_tick(&slave, at, &result);
        at->wait(at->context);
    }
    nt_hal_close(&slave);
    return result;
}
