/* SPDX-License-Identifier: BSD-3-Clause
 * Codes, voltages and frames of the chips in the tables. */
#include "internal/converters.h"
#include "nanotouch/advanced/converters.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "hal/chips/chips.h"
#include "hal/chips/families.h"

/* --- which chips there are --- */

static const struct {
    const nt_chip *chips;
    int count;
} families[] = {
    {nt_chips_ad5791, NT_CHIPS_AD5791},
    {nt_chips_ad5686, NT_CHIPS_AD5686},
    {nt_chips_ad7606, NT_CHIPS_AD7606},
    {nt_chips_ad7768, NT_CHIPS_AD7768},
};
enum { FAMILIES = sizeof families / sizeof families[0] };

const nt_chip *nt_chip_at(int index)
{
    for (int i = 0; i < FAMILIES && index >= 0; ++i) {
        if (index < families[i].count)
            return &families[i].chips[index];
        index -= families[i].count;
    }
    return NULL;
}

int nt_chip_count(void)
{
    int count = 0;
    while (nt_chip_at(count))
        ++count;
    return count;
}

const nt_chip *nt_chip_find(const char *name)
{
    for (int i = 0; name && nt_chip_at(i); ++i)
        if (strcmp(nt_chip_at(i)->name, name) == 0)
            return nt_chip_at(i);
    return NULL;
}

/* --- codes and voltages --- */

double nt_chip_step(const nt_chip *chip, const nt_chip_span *span)
{
    return (span->high - span->low) / chip->steps;
}

static int32_t bottom(const nt_chip *chip)
{
    return chip->is_signed ? -(int32_t)(1u << (chip->bits - 1)) : 0;
}

double nt_chip_volts(const nt_chip *chip, const nt_chip_span *span, int32_t code)
{
    return span->low + ((double)code - (double)bottom(chip)) * (span->high - span->low) / chip->steps;
}

int32_t nt_chip_lowest(const nt_chip *chip)
{
    return bottom(chip) + (chip->is_dac ? 1 : 0);
}

int32_t nt_chip_highest(const nt_chip *chip)
{
    return bottom(chip) + (int32_t)((1u << chip->bits) - 1u) - (chip->is_dac ? 1 : 0);
}

nt_status nt_chip_code(const nt_chip *chip, const nt_chip_span *span, double volts, int32_t *code)
{
    const double steps = (volts - span->low) / nt_chip_step(chip, span) + (double)bottom(chip);
    if (!isfinite(steps))
        return NT_E_NOT_FINITE;
    const double nearest = floor(steps + 0.5);
    if (nearest < (double)nt_chip_lowest(chip) || nearest > (double)nt_chip_highest(chip))
        return NT_E_RANGE;
    *code = (int32_t)nearest;
    return NT_OK;
}

/* --- words of a DAC --- */

static nt_chip_frame frame_of(uint32_t word)
{
    return (nt_chip_frame){{(uint8_t)(word >> 16), (uint8_t)(word >> 8), (uint8_t)word}, 3};
}

static uint32_t word_of(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 16 | (uint32_t)bytes[1] << 8 | bytes[2];
}

nt_chip_frame nt_chip_write(const nt_chip *chip, int channel, int32_t code)
{
    const nt_chip_words *words = &chip->words;
    return frame_of(words->write | words->channels[channel] | (uint32_t)code << (words->field - (uint32_t)chip->bits));
}

nt_chip_frame nt_chip_ask(const nt_chip *chip, int channel)
{
    return frame_of(chip->words.read | chip->words.channels[channel]);
}

nt_chip_frame nt_chip_nothing(const nt_chip *chip)
{
    return frame_of(chip->words.nothing);
}

int32_t nt_chip_code_of(const nt_chip *chip, const uint8_t *bytes)
{
    const uint32_t field = chip->words.field;
    return (int32_t)((word_of(bytes) & ((1u << field) - 1u)) >> (field - (uint32_t)chip->bits));
}

static uint32_t control_of(const nt_chip *chip, const nt_chip_span *span)
{
    const nt_chip_words *words = &chip->words;
    const double width = span->high - span->low;
    int i = 0;
    while (words->spans[i + 1] > 0.0 && width > words->spans[i] * (1.0 + 1e-9)) /* references are not exact */
        ++i;
    return words->always | words->matching[i];
}

int nt_chip_control(const nt_chip *chip, const nt_chip_span *span, nt_chip_frame *set, nt_chip_frame *ask)
{
    if (!chip->words.control)
        return 0;
    *set = frame_of(chip->words.control | control_of(chip, span));
    *ask = frame_of(chip->words.ask);
    return 1;
}

int nt_chip_is_set(const nt_chip *chip, const nt_chip_span *span, const uint8_t *bytes)
{
    const uint32_t looked_at = 0x0003DEu; /* LINCOMP, BIN/2sC, DACTRI, OPGND, RBUF */
    return (word_of(bytes) & looked_at) == control_of(chip, span);
}

int nt_chip_is_off(const nt_chip *chip, const uint8_t *bytes)
{
    return (word_of(bytes) & chip->words.off) != 0;
}

/* --- answers of an ADC --- */

nt_chip_frame nt_chip_poll(const nt_chip *chip)
{
    return (nt_chip_frame){.count = chip->answer.count};
}

/* x^8 + x^2 + x + 1, most significant bit first. */
static uint8_t crc8(const uint8_t *bytes, uint32_t count, uint8_t start)
{
    unsigned crc = start;
    for (uint32_t i = 0; i < count; ++i) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit)
            crc = crc << 1 ^ (crc & 0x80u ? 0x107u : 0u);
    }
    return (uint8_t)crc;
}

static int is_all(const uint8_t *bytes, uint32_t count, uint8_t value)
{
    uint32_t same = 0;
    while (same < count && bytes[same] == value)
        ++same;
    return same == count;
}

nt_chip_verdict nt_chip_check(const nt_chip *chip, const uint8_t *bytes)
{
    const nt_chip_answer *answer = &chip->answer;
    if (is_all(bytes, answer->count, 0x00) || is_all(bytes, answer->count, 0xFF))
        return NT_CHIP_STUCK;
    if (answer->sum && crc8(bytes, answer->sum, answer->sum_start) != bytes[answer->sum])
        return NT_CHIP_DAMAGED;
    if (answer->status && bytes[answer->status] & answer->bad)
        return NT_CHIP_UNFIT;
    return answer->status && bytes[answer->status] & answer->clips ? NT_CHIP_SATURATED : NT_CHIP_GOOD;
}

int32_t nt_chip_decode(const nt_chip *chip, const uint8_t *bytes, int channel)
{
    const uint32_t width = chip->answer.width;
    uint32_t value = 0;
    for (uint32_t i = 0; i < width; ++i)
        value = value << 8 | bytes[(uint32_t)channel * width + i];
    const uint32_t sign = 1u << (chip->bits - 1); /* two's complement, without a shift of what is negative */
    return (int32_t)(value ^ sign) - (int32_t)sign;
}
