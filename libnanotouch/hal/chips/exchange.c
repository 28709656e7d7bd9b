/* SPDX-License-Identifier: BSD-3-Clause
 * What goes between a half and its chips: setting them up, driving, reading back. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "hal/chips/chips.h"
#include "hal/chips/half.h"
#include "internal/converters.h"

nt_status nt_converter_half_send(nt_converter_half *c, int converter, nt_chip_frame *frames, int count)
{
    uint8_t in[NT_CONVERTER_FRAMES][NT_CHIP_FRAME_SIZE];
    nt_transfer transfers[NT_CONVERTER_FRAMES] = {{NULL, NULL, 0}};
    if (c->is_gone)
        return NT_E_DEVICE;
    for (int i = 0; i < count; ++i)
        transfers[i] = (nt_transfer){frames[i].bytes, in[i], frames[i].count};
    const nt_status status = c->setup.exchange(c->setup.bus, converter, transfers, count);
    ++c->counts.exchanges;
    c->counts.failed += status != NT_OK;
    c->is_gone = status == NT_E_DEVICE;
    for (int i = 0; i < count && status == NT_OK; ++i)
        memcpy(frames[i].bytes, in[i], frames[i].count);
    return status;
}

double nt_converter_half_value(const nt_converter_half *c, const nt_converter_channel *channel, int32_t code)
{
    const nt_converter *on = &c->setup.converter[channel->converter];
    return channel->offset + channel->gain * nt_chip_volts(on->chip, &on->span, code);
}

nt_status nt_converter_half_code(nt_converter_half *c, const nt_converter_channel *channel, double value, int32_t *code)
{
    const nt_converter *on = &c->setup.converter[channel->converter];
    if (!isfinite(value))
        return NT_E_NOT_FINITE;
    const double inside = value < channel->minimum   ? channel->minimum
                          : value > channel->maximum ? channel->maximum
                                                     : value;
    c->counts.clipped += inside != value;
    const double volts = (inside - channel->offset) / channel->gain;
    if (nt_chip_code(on->chip, &on->span, volts, code) != NT_OK) /* the step that a DAC keeps to itself at the ends */
        *code = volts < 0.5 * (on->span.low + on->span.high) ? nt_chip_lowest(on->chip) : nt_chip_highest(on->chip);
    return NT_OK;
}

nt_status nt_converter_half_drive(nt_converter_half *c, int axis, int32_t code)
{
    const nt_converter_channel *driven = &c->setup.driven[axis];
    nt_chip_frame frame = nt_chip_write(c->setup.converter[driven->converter].chip, driven->channel, code);
    c->codes[axis] = code; /* sent or not: what is read back is compared with it */
    c->driven |= 1u << axis;
    return nt_converter_half_send(c, driven->converter, &frame, 1);
}

/* Asks each channel that a DAC drives what it holds, and whether it is still set up: one that has lost its supply for a
 * moment takes codes as before, with its output off. An answer comes with the next frame, so one frame more. */
static nt_status ask_dac(nt_converter_half *c, int converter, nt_converter_answers *answers)
{
    const nt_converter *on = &c->setup.converter[converter];
    const nt_chip *chip = on->chip;
    nt_chip_frame set, frames[NT_CONVERTER_FRAMES];
    int axes[NT_DRIVES], count = 0;
    for (int axis = 0; axis < NT_DRIVES; ++axis)
        if (c->setup.driven[axis].is_used && c->setup.driven[axis].converter == converter) {
            frames[count] = nt_chip_ask(chip, c->setup.driven[axis].channel);
            axes[count++] = axis;
        }
    if (count == 0)
        return NT_OK;
    const int has_control = nt_chip_control(chip, &on->span, &set, &frames[count]);
    frames[count + has_control] = nt_chip_nothing(chip);
    const nt_status status = nt_converter_half_send(c, converter, frames, count + has_control + 1);
    if (status == NT_OK && has_control && !nt_chip_is_set(chip, &on->span, frames[count + 1].bytes))
        answers->is_unset = 1;
    for (int i = 0; i < count && status == NT_OK; ++i)
        answers->held[axes[i]] = nt_chip_code_of(chip, frames[i + 1].bytes);
    return status;
}

nt_status nt_converter_half_held(nt_converter_half *c, nt_converter_answers *answers)
{
    nt_status status = NT_OK;
    for (int i = 0; i < c->setup.converters && status == NT_OK; ++i)
        if (c->setup.converter[i].chip->is_dac)
            status = ask_dac(c, i, answers);
    return status;
}

/* --- setting up --- */

static nt_status send_setup(nt_converter_half *c, int converter)
{
    const nt_chip *chip = c->setup.converter[converter].chip;
    nt_status status = NT_OK;
    for (int i = 0; i < NT_CHIP_SETUP && status == NT_OK; ++i) {
        nt_chip_frame frame = chip->setup[i];
        if (frame.count > 0)
            status = nt_converter_half_send(c, converter, &frame, 1);
    }
    return status;
}

/* What its control register says now, as the answer's bytes. */
static nt_status ask_control(nt_converter_half *c, int converter, nt_chip_frame *answer)
{
    const nt_converter *on = &c->setup.converter[converter];
    nt_chip_frame set, frames[2] = {{{0}, 0}, nt_chip_nothing(on->chip)};
    (void)nt_chip_control(on->chip, &on->span, &set, &frames[0]);
    const nt_status status = nt_converter_half_send(c, converter, frames, 2);
    *answer = frames[1];
    return status;
}

/* Where it starts: a force or an oscillation at 0, a stage where it stands, or at 0 V if its output has been off. */
static nt_status start_axis(nt_converter_half *c, int axis, int was_off, const nt_converter_answers *before)
{
    const nt_converter_channel *driven = &c->setup.driven[axis];
    const nt_chip *chip = c->setup.converter[driven->converter].chip;
    int32_t code = before->held[axis];
    nt_status status = NT_OK;
    if (c->setup.half == NT_HALF_MASTER || axis == NT_DRIVES_AMPLITUDE)
        status = nt_converter_half_code(c, driven, 0.0, &code);
    else if (was_off || code < nt_chip_lowest(chip) || code > nt_chip_highest(chip))
        status = nt_converter_half_code(c, driven, driven->offset, &code);
    return status == NT_OK ? nt_converter_half_drive(c, axis, code) : status;
}

/* No control register reads as nothing but 0 or 1. */
static int is_hanging(const uint8_t *bytes)
{
    const unsigned any = bytes[0] | bytes[1] | bytes[2], all = bytes[0] & bytes[1] & bytes[2];
    return any == 0x00 || all == 0xFF;
}

static nt_status start_dac(nt_converter_half *c, int converter, const nt_converter_answers *before)
{
    const nt_converter *on = &c->setup.converter[converter];
    nt_chip_frame set, ask, answer = {.count = 0};
    const int has_control = nt_chip_control(on->chip, &on->span, &set, &ask);
    nt_status status = has_control ? ask_control(c, converter, &answer) : NT_OK;
    if (has_control && status == NT_OK && is_hanging(answer.bytes))
        return NT_E_DEVICE; /* where the stage stands is unknown: nothing is driven */
    const int was_off = has_control && nt_chip_is_off(on->chip, answer.bytes);
    for (int axis = 0; axis < NT_DRIVES && status == NT_OK; ++axis)
        if (c->setup.driven[axis].is_used && c->setup.driven[axis].converter == converter)
            status = start_axis(c, axis, was_off, before);
    if (!has_control || status != NT_OK)
        return status;
    status = nt_converter_half_send(c, converter, &set, 1); /* the code first: the output comes on at it */
    if (status == NT_OK)
        status = ask_control(c, converter, &answer);
    return status == NT_OK && !nt_chip_is_set(on->chip, &on->span, answer.bytes) ? NT_E_DEVICE : status;
}

nt_status nt_converter_half_set_up(nt_converter_half *c)
{
    nt_converter_answers before = {.held = {0}}, again = {.held = {0}};
    nt_status status = nt_converter_half_held(c, &before);
    if (status == NT_OK)
        status = nt_converter_half_held(c, &again);
    if (status == NT_OK && memcmp(before.held, again.held, sizeof before.held) != 0)
        return NT_E_DEVICE; /* the stage would jump to what has been misread */
    for (int i = 0; i < c->setup.converters && status == NT_OK; ++i)
        status = c->setup.converter[i].chip->is_dac ? start_dac(c, i, &before) : send_setup(c, i);
    return status;
}
