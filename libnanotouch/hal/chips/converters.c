/* SPDX-License-Identifier: BSD-3-Clause
 * A half on converters as a backend. A tick that does not work (short, stuck, damaged, not what was written) is read as
 * invalid, with nothing of it used: HOLD, and in the second tick RETRACT. NT_CONVERTER_BAD of them, or a bus that is
 * gone, are a lost device. */
#include "internal/converters.h"
#include "nanotouch/advanced/converters.h"

#include <math.h>
#include <stddef.h>

#include "hal/chips/chips.h"
#include "hal/chips/half.h"

enum { ATTEMPTS = 3 }; /* of each frame when a half is left: nobody comes after */

nt_status nt_converter_half_init(nt_converter_half *converters, const nt_converter_setup *setup, nt_problem *problem)
{
    const nt_status status = converters ? nt_converter_setup_check(setup, problem) : NT_E_ARGUMENT;
    if (status == NT_OK)
        *converters = (nt_converter_half){.setup = *setup};
    return status;
}

/* --- lines --- */

static uint32_t flags_of(const nt_converter_half *c)
{
    const nt_converter_lines *lines = &c->setup.lines;
    return lines->flags ? lines->flags(lines->context) : 0u;
}

static nt_status enable(const nt_converter_half *c, int on)
{
    const nt_converter_lines *lines = &c->setup.lines;
    return lines->enable ? lines->enable(lines->context, on) : NT_OK;
}

/* --- open, describe, configure, arm --- */

static nt_status open_half(void *context, const nt_host *host, nt_problem *problem)
{
    nt_converter_half *c = context;
    const nt_converter_setup setup = c->setup;
    const nt_status status = nt_converter_half_init(c, &setup, problem);
    c->host = host;
    if (status == NT_OK)
        nt_converter_half_describe(c);
    return status;
}

static nt_status describe_half(void *context, nt_capabilities *capabilities)
{
    const nt_converter_half *c = context;
    const nt_converter_setup *setup = &c->setup;
    capabilities->can = NT_IS_REAL | (setup->felt[NT_Z].is_used ? (uint32_t)NT_CAN_FEEL : 0u);
    if (setup->half == NT_HALF_MASTER && setup->driven[NT_Z].is_used)
        capabilities->can |= NT_CAN_PUSH;
    if (setup->lock_in[NT_LOCK_IN_AMPLITUDE].is_used)
        capabilities->can |= NT_CAN_TAP;
    capabilities->axes = setup->axes;
    capabilities->period = 0.0;
    capabilities->rows = c->row_count;
    capabilities->channels = c->rows;
    return NT_OK;
}

static nt_status configure_half(void *context, const nt_configuration *configuration, nt_problem *problem)
{
    nt_converter_half *c = context;
    (void)problem;
    c->lift = configuration->lift;
    return NT_OK;
}

static nt_status arm_half(void *context)
{
    nt_converter_half *c = context;
    c->is_armed = 1; /* from here on close has something to do, whatever fails */
    const nt_status status = nt_converter_half_set_up(c);
    return status == NT_OK ? enable(c, 1) : status;
}

/* --- read --- */

static void mark(nt_reading *reading, int channel, double *at, double value)
{
    *at = value;
    reading->valid |= 1u << channel;
}

static void judge(nt_converter_half *c, nt_chip_verdict verdict, nt_status *status)
{
    c->counts.stuck += verdict == NT_CHIP_STUCK;
    c->counts.damaged += verdict == NT_CHIP_DAMAGED;
    c->counts.unfit += verdict == NT_CHIP_UNFIT;
    if (verdict != NT_CHIP_GOOD && verdict != NT_CHIP_SATURATED)
        *status = NT_E_RANGE; /* whatever it is not: NT_OK */
}

/* All chips, each once; NT_OK if every number can be used. */
static nt_status ask_all(nt_converter_half *c, nt_converter_answers *answers)
{
    const nt_converter_setup *setup = &c->setup;
    if (setup->lines.convert)
        setup->lines.convert(setup->lines.context);
    nt_status status = nt_converter_half_held(c, answers);
    for (int i = 0; i < setup->converters && status == NT_OK; ++i) {
        const nt_chip *chip = setup->converter[i].chip;
        if (chip->is_dac)
            continue;
        answers->adc[i] = nt_chip_poll(chip);
        status = nt_converter_half_send(c, i, &answers->adc[i], 1);
        if (status != NT_OK)
            break;
        answers->verdict[i] = nt_chip_check(chip, answers->adc[i].bytes);
        judge(c, answers->verdict[i], &status);
    }
    int is_other = answers->is_unset;
    for (int axis = 0; axis < NT_DRIVES; ++axis)
        is_other |= setup->driven[axis].is_used && answers->held[axis] != c->codes[axis];
    if (status != NT_OK || !is_other)
        return status;
    ++c->counts.mismatched;
    return NT_E_RANGE;
}

static int32_t code_of(const nt_converter_half *c, const nt_converter_answers *answers, int axis,
                       const nt_converter_channel *channel)
{
    const nt_chip *chip = c->setup.converter[channel->converter].chip;
    return chip->is_dac ? answers->held[axis]
                        : nt_chip_decode(chip, answers->adc[channel->converter].bytes, channel->channel);
}

/* At an end of its code, its range or by its chip's own word. */
static int is_saturated(const nt_converter_half *c, const nt_converter_answers *answers,
                        const nt_converter_channel *channel, int32_t code)
{
    const nt_chip *chip = c->setup.converter[channel->converter].chip;
    const double value = nt_converter_half_value(c, channel, code);
    return answers->verdict[channel->converter] == NT_CHIP_SATURATED || code <= nt_chip_lowest(chip) ||
           code >= nt_chip_highest(chip) || value < channel->minimum || value > channel->maximum;
}

/* One at an end of its range is no number: an amplitude that is too large, or a lag that turns round, tells nothing. */
static void fill_lock_in(const nt_converter_half *c, const nt_converter_answers *answers, nt_reading *reading)
{
    double *const to[] = {&reading->amplitude, &reading->lag};
    for (int i = 0; i < NT_LOCK_IN_OUTPUTS; ++i) {
        const nt_converter_channel *channel = &c->setup.lock_in[i];
        if (!channel->is_used)
            continue;
        const int32_t code = code_of(c, answers, NT_Z, channel);
        if (!is_saturated(c, answers, channel, code))
            mark(reading, NT_READS_AMPLITUDE + i, to[i], nt_converter_half_value(c, channel, code));
    }
}

static void fill(const nt_converter_half *c, const nt_converter_answers *answers, nt_reading *reading)
{
    for (int axis = 0; axis < NT_AXES; ++axis) {
        const nt_converter_channel *position = &c->setup.position[axis], *felt = &c->setup.felt[axis];
        if (position->is_used)
            mark(reading, NT_READS_POSITION + axis, &reading->position[axis],
                 nt_converter_half_value(c, position, code_of(c, answers, axis, position)));
        if (!felt->is_used)
            continue;
        const int32_t code = code_of(c, answers, axis, felt);
        mark(reading, NT_READS_FELT + axis, &reading->felt[axis], nt_converter_half_value(c, felt, code));
        if (c->setup.half == NT_HALF_SLAVE && is_saturated(c, answers, felt, code))
            reading->flags |= NT_SAMPLE_SATURATED;
    }
}

static nt_status read_half(void *context, nt_reading *reading)
{
    nt_converter_half *c = context;
    nt_converter_answers answers = {.held = {0}};
    const uint32_t flags = flags_of(c);
    *reading = (nt_reading){.size = reading->size,
                            .flags = flags,
                            .sequence = ++c->sequence,
                            .time = c->host->now(c->host),
                            .position = {NAN, NAN, NAN},
                            .felt = {NAN, NAN, NAN},
                            .amplitude = NAN,
                            .lag = NAN};
    const nt_status status = ask_all(c, &answers);
    c->bad = status == NT_OK ? 0 : c->bad + 1;
    if (c->is_gone || c->bad >= NT_CONVERTER_BAD)
        return NT_E_DEVICE;
    if (status == NT_OK) {
        fill(c, &answers, reading);
        fill_lock_in(c, &answers, reading);
    } else
        reading->flags |= NT_SAMPLE_INVALID;
    return NT_OK;
}

/* --- write, and the end --- */

/* What is asked of a channel; a frequency of 0 is none: the oscillator keeps its own. */
static double asked_of(const nt_converter_half *c, const nt_action *action, int axis)
{
    if (axis < NT_AXES)
        return action->target[axis];
    if (axis == NT_DRIVES_AMPLITUDE)
        return action->drive_amplitude;
    return action->drive_frequency == 0.0 ? nt_converter_half_value(c, &c->setup.driven[axis], c->codes[axis])
                                          : action->drive_frequency;
}

/* A target that is no number never reaches a chip. One that could not be sent shows in the next read-back. */
static nt_status write_half(void *context, const nt_action *action)
{
    nt_converter_half *c = context;
    int32_t codes[NT_DRIVES] = {0};
    for (int axis = 0; axis < NT_DRIVES; ++axis)
        if (c->setup.driven[axis].is_used) {
            const nt_status status =
                nt_converter_half_code(c, &c->setup.driven[axis], asked_of(c, action, axis), &codes[axis]);
            if (status != NT_OK)
                return status;
        }
    for (int axis = 0; axis < NT_DRIVES && !c->is_gone; ++axis)
        if (c->setup.driven[axis].is_used)
            (void)nt_converter_half_drive(c, axis, codes[axis]);
    if (c->setup.lines.beat)
        c->setup.lines.beat(c->setup.lines.context);
    return c->is_gone ? NT_E_DEVICE : NT_OK;
}

static void leave_axis(nt_converter_half *c, int axis)
{
    const nt_converter_channel *driven = &c->setup.driven[axis];
    const int is_zero = c->setup.half == NT_HALF_MASTER || axis == NT_DRIVES_AMPLITUDE;
    const double lift = axis == NT_Z && c->lift > 0.0 ? c->lift : 0.0;
    int32_t code;
    if (nt_converter_half_code(c, driven, is_zero ? 0.0 : nt_converter_half_value(c, driven, c->codes[axis]) - lift,
                               &code) != NT_OK)
        return;
    for (int i = 0; i < ATTEMPTS && !c->is_gone; ++i)
        if (nt_converter_half_drive(c, axis, code) == NT_OK)
            return;
}

static void disarm_half(void *context)
{
    nt_converter_half *c = context;
    for (int axis = NT_Z; axis >= NT_X && c->is_armed; --axis) /* the lift first */
        if (c->driven >> axis & 1u)
            leave_axis(c, axis);
    if (c->is_armed && c->driven >> NT_DRIVES_AMPLITUDE & 1u) /* a frequency stays */
        leave_axis(c, NT_DRIVES_AMPLITUDE);
    if (c->is_armed)
        (void)enable(c, 0);
    c->is_armed = 0;
}

static void close_half(void *context)
{
    disarm_half(context);
}

const nt_backend *nt_converter_half_backend(nt_half half)
{
#define BACKEND(which)                                                                                                 \
    {                                                                                                                  \
        .size = sizeof(nt_backend), .version = NT_HAL_API_VERSION, .name = "converters", .half = which,                \
        .open = open_half, .describe = describe_half, .configure = configure_half, .arm = arm_half, .read = read_half, \
        .write = write_half, .disarm = disarm_half, .close = close_half                                                \
    }
    static const nt_backend backends[] = {BACKEND(NT_HALF_MASTER), BACKEND(NT_HALF_SLAVE)};
    return half == NT_HALF_MASTER || half == NT_HALF_SLAVE ? &backends[half] : NULL;
}
