/* SPDX-License-Identifier: BSD-3-Clause
 * The loop: read the slave, one touch step, write. The same half on converters as on a PC; only the exchange is the
 * board's. All of it is of fixed size, and nothing is planned here: plan.h has it as constants. */
#include "touch.h"

#include <string.h>

#include "plan.h"
#include "sample.h"

#define STAGE_GAIN 1e-6       /* [m/V] */
#define DEFLECTION_GAIN 33e-9 /* [m/V] */
#define SAMPLE_AT 2e-6f       /* travel at which the computed sample is met [m] */

static nt_converter_half half; /* too large for a small stack */
static ntf_touch_state state;
static lever model;

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

static nt_status open_slave(nt_hal *slave, const board *at)
{
    const nt_converter_setup setup = converters_of(at);
    const nt_configuration configuration = {sizeof configuration, 0, (double)plan_touch.period, 1e-6, ""};
    const nt_hal_choice choice = {nt_converter_half_backend(NT_HALF_SLAVE), &half};
    nt_status status = nt_converter_half_init(&half, &setup, NULL);
    if (status == NT_OK)
        status = nt_hal_open(slave, NT_HALF_SLAVE, &choice, &at->host, NULL);
    if (status == NT_OK)
        status = nt_hal_configure(slave, &configuration, NULL);
    return status == NT_OK ? nt_hal_arm(slave) : status;
}

static void add_to_sum(outcome *so_far, float command)
{
    uint8_t bytes[sizeof command];
    memcpy(bytes, &command, sizeof bytes);
    for (size_t i = 0; i < sizeof bytes; ++i) /* FNV-1a */
        so_far->command_sum = (so_far->command_sum ^ bytes[i]) * 0x100000001b3u;
}

/* A hand at rest at 0: this mode needs none. */
static ntf_sample sample_of(const nt_reading *reading, const board *at, long tick)
{
    ntf_sample sample = {.tick = (uint64_t)tick, .flags = reading->flags};
    sample.age = 1e-9f * (float)(at->host.now(&at->host) - reading->time);
    sample.stage_position[NTF_Z] = (float)reading->position[NT_Z];
    sample.deflection[NTF_Z] = (float)reading->felt[NT_Z];
    if (at->has_no_lever)
        sample.deflection[NTF_Z] =
            lever_read(&model, &plan_force, &plan_touch.rig.probe, SAMPLE_AT - sample.stage_position[NTF_Z]);
    return sample;
}

static nt_status one_tick(nt_hal *slave, const board *at, outcome *so_far)
{
    ntf_command command;
    nt_action action = {.size = sizeof action, .tick = (uint64_t)so_far->ticks};
    nt_status status = nt_hal_read(slave);
    const ntf_sample sample = sample_of(&slave->reading, at, so_far->ticks);
    ntf_touch_step(&plan_touch, &state, &sample, &command);
    action.state = command.state;
    action.target[NT_Z] = (double)command.stage_position[NTF_Z];
    if (status == NT_OK)
        status = nt_hal_write(slave, &action);
    so_far->state = command.state;
    so_far->travel = slave->reading.position[NT_Z];
    so_far->force = (double)(plan_touch.rig.probe.spring_constant * sample.deflection[NTF_Z]);
    so_far->largest = so_far->force > so_far->largest ? so_far->force : so_far->largest;
    so_far->weakest = so_far->force < so_far->weakest ? so_far->force : so_far->weakest;
    add_to_sum(so_far, command.stage_position[NTF_Z]);
    return status;
}

outcome touch_run(const board *at, long ticks)
{
    outcome result = {.command_sum = 0xcbf29ce484222325u};
    nt_hal slave = {.backend = NULL};
    state = ntf_touch_start(&plan_touch, 0.0f, 0.0f, 0.0f);
    model = (lever){0, 0.0f, 1u};
    result.status = open_slave(&slave, at);
    for (; result.ticks < ticks && result.status == NT_OK; ++result.ticks) {
        result.status = one_tick(&slave, at, &result);
        at->wait(at->context);
    }
    nt_hal_close(&slave);
    return result;
}
