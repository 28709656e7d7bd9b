/* SPDX-License-Identifier: BSD-3-Clause
 * Can this setup be a half? And what the half says of itself: its rows of channels. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/problem.h"
#include "hal/chips/chips.h"
#include "hal/chips/half.h"
#include "internal/converters.h"

#define LEAST_STEPS 16.0 /* of a converter within a range */

typedef struct use {
    const char *name; /* of the field */
    const nt_converter_channel *channels;
    int count, is_driven;
} use;

static nt_status bad(nt_problem *problem, const char *field, double value, double minimum, double maximum)
{
    return nt_problem_set(problem, field, "", value, minimum, maximum);
}

static nt_status check_span(const nt_converter *converter, nt_problem *problem)
{
    const double low = converter->span.low, high = converter->span.high;
    if (!converter->chip)
        return bad(problem, "converter without a chip", 1.0, 0.0, 0.0);
    if (!isfinite(low) || fabs(low) > 1000.0)
        return nt_problem_set(problem, "converter.span.low", "V", low, -1000.0, 1000.0);
    if (!isfinite(high) || !(high > low) || high > 1000.0)
        return nt_problem_set(problem, "converter.span.high", "V", high, low, 1000.0);
    return NT_OK;
}

/* The two values at the ends of what the chip gives or takes, in order. */
static void reach(const nt_converter_setup *setup, const nt_converter_channel *channel, double ends[2])
{
    const nt_converter *on = &setup->converter[channel->converter];
    const double low = nt_chip_volts(on->chip, &on->span, nt_chip_lowest(on->chip));
    const double high = nt_chip_volts(on->chip, &on->span, nt_chip_highest(on->chip));
    const int falls = channel->gain < 0.0;
    ends[falls] = channel->offset + channel->gain * low;
    ends[!falls] = channel->offset + channel->gain * high;
}

static nt_status check_numbers(const nt_converter_channel *channel, const char *unit, nt_problem *problem)
{
    if (!isfinite(channel->gain) || channel->gain == 0.0)
        return bad(problem, "channel.gain, which is not 0", channel->gain, -HUGE_VAL, HUGE_VAL);
    if (!isfinite(channel->offset))
        return nt_problem_set(problem, "channel.offset", unit, channel->offset, -HUGE_VAL, HUGE_VAL);
    if (!(channel->uncertainty >= 0.0 && channel->uncertainty <= 1.0))
        return bad(problem, "channel.uncertainty", channel->uncertainty, 0.0, 1.0);
    if (!(channel->noise >= 0.0))
        return nt_problem_set(problem, "channel.noise", unit, channel->noise, 0.0, HUGE_VAL);
    if (!(channel->latency >= 0.0 && channel->latency <= 1.0))
        return nt_problem_set(problem, "channel.latency", "s", channel->latency, 0.0, 1.0);
    return NT_OK;
}

/* Both ends of the range can be reached, but for the step that a DAC keeps to itself at either end; and it has steps.
 */
static nt_status check_range(const nt_converter_setup *setup, const nt_converter_channel *channel, const char *unit,
                             nt_problem *problem)
{
    const nt_converter *on = &setup->converter[channel->converter];
    const double step = nt_chip_step(on->chip, &on->span), slack = 2.0 * fabs(channel->gain) * step;
    const double width = channel->maximum - channel->minimum, most = width / (LEAST_STEPS * step);
    double ends[2];
    reach(setup, channel, ends);
    if (!(channel->minimum >= ends[0] - slack && channel->minimum < channel->maximum))
        return nt_problem_set(problem, "channel.minimum", unit, channel->minimum, ends[0], channel->maximum);
    if (!(channel->maximum <= ends[1] + slack))
        return nt_problem_set(problem, "channel.maximum", unit, channel->maximum, channel->minimum, ends[1]);
    if (fabs(channel->gain) > most)
        return bad(problem, "channel.gain, with which the range has 16 steps", channel->gain, -most, most);
    if (channel->noise > width)
        return nt_problem_set(problem, "channel.noise", unit, channel->noise, 0.0, width);
    return NT_OK;
}

/* A session begins at travel 0. */
static nt_status check_start(const nt_converter_channel *travel, nt_problem *problem)
{
    if (travel->minimum > 0.0)
        return nt_problem_set(problem, "channel.minimum of a travel that holds 0", "m", travel->minimum, -HUGE_VAL,
                              0.0);
    if (travel->maximum < 0.0)
        return nt_problem_set(problem, "channel.maximum of a travel that holds 0", "m", travel->maximum, 0.0, HUGE_VAL);
    return NT_OK;
}

static int drives_it(const nt_converter_setup *setup, const nt_converter_channel *read, int axis)
{
    const nt_converter_channel *driven = &setup->driven[axis];
    return driven->is_used && driven->converter == read->converter && driven->channel == read->channel;
}

static const char *unit_of(const nt_converter_setup *setup, const use *as, int axis)
{
    if (as->channels == setup->lock_in)
        return axis == NT_LOCK_IN_LAG ? "rad" : "m";
    if (as->is_driven && axis == NT_DRIVES_FREQUENCY)
        return "Hz";
    return setup->half == NT_HALF_SLAVE || as->channels == setup->position ? "m" : "N";
}

static nt_status check_channel(const nt_converter_setup *setup, const use *as, int axis, nt_problem *problem)
{
    const nt_converter_channel *channel = &as->channels[axis];
    const int is_slave = setup->half == NT_HALF_SLAVE;
    const char *unit = unit_of(setup, as, axis);
    if (channel->converter < 0 || channel->converter >= setup->converters)
        return bad(problem, "channel.converter", channel->converter, 0.0, setup->converters - 1);
    const nt_chip *chip = setup->converter[channel->converter].chip;
    if (channel->channel < 0 || channel->channel >= chip->channels)
        return bad(problem, "channel.channel", channel->channel, 0.0, chip->channels - 1);
    if (as->is_driven ? !chip->is_dac
                      : chip->is_dac && !(as->channels == setup->position && drives_it(setup, channel, axis)))
        return bad(problem, as->name, chip->is_dac, as->is_driven, as->is_driven);
    nt_status status = check_numbers(channel, unit, problem);
    if (status == NT_OK)
        status = check_range(setup, channel, unit, problem);
    return status == NT_OK && is_slave && as->is_driven && axis == NT_Z ? check_start(channel, problem) : status;
}

enum { USES = 4 };

static void list_uses(const nt_converter_setup *setup, use uses[USES])
{
    uses[0] = (use){"position: channels of an ADC", setup->position, NT_AXES, 0};
    uses[1] = (use){"felt: channels of an ADC", setup->felt, NT_AXES, 0};
    uses[2] = (use){"driven: channels of a DAC", setup->driven, NT_DRIVES, 1};
    uses[3] = (use){"lock_in: channels of an ADC", setup->lock_in, NT_LOCK_IN_OUTPUTS, 0};
}

nt_status nt_converter_channel_check(const nt_converter_setup *setup, const nt_converter_channel *channel,
                                     nt_problem *problem)
{
    use uses[USES];
    list_uses(setup, uses);
    for (int i = 0; i < USES; ++i)
        for (int axis = 0; axis < uses[i].count; ++axis) {
            if (channel != &uses[i].channels[axis] || !channel->is_used)
                continue;
            if (setup->axes == 1 && axis < NT_Z && uses[i].channels != setup->lock_in)
                return bad(problem, "channels of an axis that the half does not have", 1.0, 0.0, 0.0);
            return check_channel(setup, &uses[i], axis, problem);
        }
    return NT_OK;
}

static nt_status check_uses(const nt_converter_setup *setup, nt_problem *problem)
{
    use uses[USES];
    list_uses(setup, uses);
    nt_status status = NT_OK;
    for (int i = 0; i < USES; ++i)
        for (int axis = 0; axis < uses[i].count && status == NT_OK; ++axis)
            status = nt_converter_channel_check(setup, &uses[i].channels[axis], problem);
    return status;
}

/* A slave taps with all of a lock-in amplifier, and its drive can be switched off. */
static nt_status check_tapping(const nt_converter_setup *setup, nt_problem *problem)
{
    const nt_converter_channel *drive = &setup->driven[NT_DRIVES_AMPLITUDE];
    const int has_drive = drive->is_used || setup->driven[NT_DRIVES_FREQUENCY].is_used;
    const int outputs = setup->lock_in[NT_LOCK_IN_AMPLITUDE].is_used + setup->lock_in[NT_LOCK_IN_LAG].is_used;
    if (setup->half == NT_HALF_MASTER && (has_drive || outputs))
        return bad(problem, "drive or lock-in amplifier of a master", 1.0, 0.0, 0.0);
    if (outputs == 1 || (has_drive && outputs == 0))
        return bad(problem, "outputs of the lock-in amplifier, amplitude and lag", outputs, 2.0, 2.0);
    if (drive->is_used && !(drive->minimum <= 0.0 && drive->maximum > 0.0))
        return nt_problem_set(problem, "drive amplitude: its minimum, which switches it off", "m", drive->minimum,
                              -HUGE_VAL, 0.0);
    return NT_OK;
}

nt_status nt_converter_setup_check(const nt_converter_setup *setup, nt_problem *problem)
{
    if (!setup || !setup->exchange || (setup->half != NT_HALF_MASTER && setup->half != NT_HALF_SLAVE))
        return NT_E_ARGUMENT;
    if (setup->axes < 1 || setup->axes > NT_AXES)
        return bad(problem, "axes", setup->axes, 1.0, NT_AXES);
    if (setup->converters < 1 || setup->converters > NT_CONVERTERS)
        return bad(problem, "converters", setup->converters, 1.0, NT_CONVERTERS);
    for (int i = 0; i < setup->converters; ++i) {
        const nt_status status = check_span(&setup->converter[i], problem);
        if (status != NT_OK)
            return status;
    }
    if (!setup->position[NT_Z].is_used)
        return bad(problem, "channels of the position along z", 0.0, 1.0, 1.0);
    if (setup->half == NT_HALF_SLAVE && (!setup->driven[NT_Z].is_used || !setup->felt[NT_Z].is_used))
        return bad(problem, "channels of a slave's travel and deflection along z", 0.0, 1.0, 1.0);
    const nt_status status = check_tapping(setup, problem);
    return status == NT_OK ? check_uses(setup, problem) : status;
}

/* --- what it says of itself --- */

static const char *const names[2][3][NT_DRIVES] = {
    {{"position x", "position y", "position z"},
     {"force x", "force y", "force z"},
     {"motor force x", "motor force y", "motor force z"}},
    {{"stage x", "stage y", "stage z"},
     {"deflection x", "deflection y", "deflection z"},
     {"travel x", "travel y", "travel z", "drive amplitude", "drive frequency"}},
};

/* The numbers of a channel; what it is called, and what it is left at, is for the caller. */
static nt_channel_row row_of(const nt_converter_half *c, const nt_converter_channel *channel, const char *name,
                             const char *unit)
{
    const nt_converter *on = &c->setup.converter[channel->converter];
    return (nt_channel_row){.name = name,
                            .unit = unit,
                            .axis = NT_AXES,
                            .minimum = channel->minimum,
                            .maximum = channel->maximum,
                            .step = fabs(channel->gain) * nt_chip_step(on->chip, &on->span),
                            .noise = channel->noise,
                            .latency = channel->latency + on->chip->settle,
                            .safe = NAN};
}

static nt_channel_row axis_row(const nt_converter_half *c, int kind, int axis, const nt_converter_channel *channel)
{
    const int is_master = c->setup.half == NT_HALF_MASTER, is_force = is_master && kind != 0;
    const char *unit = is_force ? "N" : axis == NT_DRIVES_FREQUENCY ? "Hz" : "m";
    nt_channel_row row = row_of(c, channel, names[!is_master][kind][axis], unit);
    row.driven = kind == 2;
    row.axis = axis < NT_AXES ? axis : NT_AXES;
    if (row.driven && (is_force || axis == NT_DRIVES_AMPLITUDE))
        row.safe = 0.0;
    return row;
}

void nt_converter_half_describe(nt_converter_half *c)
{
    const nt_converter_channel *const kinds[] = {c->setup.position, c->setup.felt, c->setup.driven};
    const nt_converter_channel *lock_in = c->setup.lock_in;
    c->row_count = 0;
    for (int kind = 0; kind < 3; ++kind)
        for (int axis = 0; axis < (kind == 2 ? NT_DRIVES : NT_AXES); ++axis)
            if (kinds[kind][axis].is_used)
                c->rows[c->row_count++] = axis_row(c, kind, axis, &kinds[kind][axis]);
    if (lock_in[NT_LOCK_IN_AMPLITUDE].is_used) {
        c->rows[c->row_count++] = row_of(c, &lock_in[NT_LOCK_IN_AMPLITUDE], "amplitude", "m");
        c->rows[c->row_count++] = row_of(c, &lock_in[NT_LOCK_IN_LAG], "lag", "rad");
    }
}
