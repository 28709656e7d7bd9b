/* SPDX-License-Identifier: BSD-3-Clause
 * The tables against the data sheets, typed in here by hand as whole frames and voltages; the check sum against its
 * published check value and against a division of polynomials, bit by bit. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "hal/chips/chips.h"
#include "internal/converters.h"
#include "nanotouch/advanced/converters.h"

static const nt_chip *chip(const char *name)
{
    const nt_chip *found = nt_chip_find(name);
    assert_non_null(found);
    return found;
}

static void assert_frame(nt_chip_frame frame, uint32_t word)
{
    assert_int_equal(frame.count, 3);
    assert_int_equal((uint32_t)frame.bytes[0] << 16 | (uint32_t)frame.bytes[1] << 8 | frame.bytes[2], word);
}

static void close_to(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.12g instead of %.12g", value, expected);
}

static void the_list_is_whole(void **state)
{
    (void)state;
    assert_int_equal(nt_chip_count(), 10);
    for (int i = 0; i < nt_chip_count(); ++i) {
        const nt_chip *one = nt_chip_at(i);
        assert_ptr_equal(nt_chip_find(one->name), one);
        assert_true(one->spi_mode < 4 && one->clock >= 1e6 && one->channels >= 1 && one->channels <= NT_CHIP_CHANNELS);
        assert_true(one->answer.count <= NT_CHIP_FRAME_SIZE);
        assert_true(one->is_dac ? one->words.write != 0 : one->answer.count >= 2);
    }
    assert_null(nt_chip_at(-1));
    assert_null(nt_chip_at(nt_chip_count()));
    assert_null(nt_chip_find("AD5790"));
    assert_null(nt_chip_find(NULL));
}

/* Data sheet Rev. D: table 10 (DAC register, address 001), 11 (control, 010); equation of V_OUT. */
static void ad5791_words(void **state)
{
    (void)state;
    const nt_chip *dac = chip("AD5791");
    const nt_chip_span span = {-10.0, 10.0}, narrow = {0.0, 10.0}, middle = {-5.0, 7.0};
    nt_chip_frame set, ask;
    assert_frame(nt_chip_write(dac, 0, 0x80000), 0x180000);
    assert_frame(nt_chip_write(dac, 0, 0xFFFFE), 0x1FFFFE);
    assert_frame(nt_chip_ask(dac, 0), 0x900000);
    assert_frame(nt_chip_nothing(dac), 0x000000);
    assert_int_equal(nt_chip_control(dac, &span, &set, &ask), 1);
    assert_frame(set, 0x200312); /* LINCOMP 1100, plain binary, output on, amplifier off */
    assert_frame(ask, 0xA00000);
    assert_int_equal(nt_chip_control(dac, &narrow, &set, &ask), 1);
    assert_frame(set, 0x200012);
    assert_int_equal(nt_chip_control(dac, &middle, &set, &ask), 1);
    assert_frame(set, 0x200052);
    const uint8_t held[] = {0x12, 0x34, 0x56}, on[] = {0x20, 0x03, 0x12}, off[] = {0x20, 0x00, 0x0E};
    assert_int_equal(nt_chip_code_of(dac, held), 0x23456);
    assert_true(nt_chip_is_set(dac, &span, on) && !nt_chip_is_off(dac, on));
    assert_true(!nt_chip_is_set(dac, &span, off) && nt_chip_is_off(dac, off)); /* as after power-up */
    close_to(nt_chip_volts(dac, &span, 0), -10.0, 0.0);
    close_to(nt_chip_volts(dac, &span, 0xFFFFF), 10.0, 1e-14);
    close_to(nt_chip_volts(dac, &span, 0x80000), 9.5367522590018e-06, 1e-15); /* 20 V 2^19 / (2^20 - 1) - 10 V */
    assert_frame(nt_chip_write(chip("AD5781"), 0, 0x20001), 0x180004);        /* 18 bits, two below are not looked at */
    assert_int_equal(nt_chip_code_of(chip("AD5781"), held), 0x23456 >> 2);
    assert_frame(nt_chip_write(chip("AD5760"), 0, 0x8001), 0x180010);
    assert_int_equal(nt_chip_control(chip("AD5760"), &middle, &set, &ask), 1);
    assert_frame(set, 0x200312);
}

/* Data sheet AD5686 Rev. D: tables 8 (commands) and 9 (channels A, B, C, D = 1, 2, 4, 8). */
static void ad5686_words(void **state)
{
    (void)state;
    const nt_chip *dac = chip("AD5686");
    const nt_chip_span span = {0.0, 5.0};
    nt_chip_frame set, ask;
    assert_frame(nt_chip_write(dac, 0, 0x1234), 0x311234);
    assert_frame(nt_chip_write(dac, 3, 0xABCD), 0x38ABCD);
    assert_frame(nt_chip_ask(dac, 1), 0x920000);
    assert_int_equal(nt_chip_control(dac, &span, &set, &ask), 0);
    close_to(nt_chip_volts(dac, &span, 0x8000), 2.5, 0.0);
    close_to(nt_chip_volts(dac, &span, 0xFFFF), 4.99992370605, 1e-11);
    assert_frame(nt_chip_write(chip("AD5684"), 2, 0xABC), 0x34ABC0);
    const uint8_t held[] = {0x00, 0xAB, 0xC0};
    assert_int_equal(nt_chip_code_of(chip("AD5684"), held), 0xABC);
}

/* Data sheet AD7606 Rev. C: 128 clocks on DOUTA, V1 first; a step of 305 uV at +-10 V and of 152 uV at +-5 V. */
static void ad7606_samples(void **state)
{
    (void)state;
    const nt_chip *adc = chip("AD7606");
    const nt_chip_span span = {-10.0, 10.0}, half = {-5.0, 5.0};
    const uint8_t frame[16] = {0x7F, 0xFF, 0x00, 0x01, 0xFF, 0xFF, 0x80, 0x00,
                               0x40, 0x00, 0xC0, 0x00, 0,    0,    0x12, 0x34};
    const int32_t codes[8] = {32767, 1, -1, -32768, 16384, -16384, 0, 0x1234};
    assert_int_equal(nt_chip_poll(adc).count, 16);
    assert_int_equal(nt_chip_check(adc, frame), NT_CHIP_GOOD);
    for (int i = 0; i < 8; ++i)
        assert_int_equal(nt_chip_decode(adc, frame, i), codes[i]);
    close_to(nt_chip_step(adc, &span), 305.176e-6, 0.5e-9);
    close_to(nt_chip_step(adc, &half), 152.588e-6, 0.5e-9);
    close_to(nt_chip_volts(adc, &span, 0), 0.0, 0.0);
    close_to(nt_chip_volts(adc, &span, -32768), -10.0, 0.0);
    close_to(nt_chip_volts(adc, &span, 32767), 10.0 - 305.1757812e-6, 1e-12);
    assert_int_equal(nt_chip_poll(chip("AD7606-4")).count, 8);
}

/* Divides the message, with `start` on its first byte and eight zeros behind, by x^8 + x^2 + x + 1. */
static uint8_t remainder_of(const uint8_t *bytes, int count, uint8_t start)
{
    unsigned rest = 0;
    for (int bit = 0; bit < 8 * (count + 1); ++bit) {
        const unsigned byte = bit / 8 < count ? bytes[bit / 8] ^ (bit < 8 ? start : 0u) : 0u;
        rest = rest << 1 | (byte >> (7 - bit % 8) & 1u);
        if (rest & 0x100u)
            rest ^= 0x107u;
    }
    return (uint8_t)rest;
}

static void ad7768_sums_and_status(void **state)
{
    (void)state;
    const nt_chip *adc = chip("AD7768-1");
    const nt_chip_span span = {-4.096, 4.096};
    assert_int_equal(remainder_of((const uint8_t *)"123456789", 9, 0), 0xF4); /* the published check value */
    const uint8_t words[][4] = {
        {0x00, 0x00, 0x01, 0}, {0x7F, 0xFF, 0xFF, 0}, {0x80, 0x00, 0x00, 0}, {0xFF, 0xFF, 0xFE, 0}};
    const int32_t codes[] = {1, 8388607, -8388608, -2};
    for (int i = 0; i < 4; ++i) {
        uint8_t frame[5];
        memcpy(frame, words[i], 4);
        frame[4] = remainder_of(frame, 4, 0x03);
        assert_int_equal(nt_chip_check(adc, frame), NT_CHIP_GOOD);
        assert_int_equal(nt_chip_decode(adc, frame, 0), codes[i]);
        for (int bit = 0; bit < 40; ++bit) { /* a CRC finds every single wrong bit */
            frame[bit / 8] ^= (uint8_t)(1u << bit % 8);
            assert_int_not_equal(nt_chip_check(adc, frame), NT_CHIP_GOOD);
            frame[bit / 8] ^= (uint8_t)(1u << bit % 8);
        }
        for (int bit = 0; bit < 8; ++bit) { /* the status, with a sum that fits */
            frame[3] = (uint8_t)(1u << bit);
            frame[4] = remainder_of(frame, 4, 0x03);
            assert_int_equal(nt_chip_check(adc, frame), bit == 0   ? NT_CHIP_GOOD
                                                        : bit == 3 ? NT_CHIP_SATURATED
                                                                   : NT_CHIP_UNFIT);
        }
    }
    close_to(nt_chip_volts(adc, &span, 8388607), 4.096 * 8388607.0 / 8388608.0, 1e-15);
}

static void a_hanging_bus_is_never_good(void **state)
{
    (void)state;
    for (int i = 0; i < nt_chip_count(); ++i) {
        const nt_chip *one = nt_chip_at(i);
        uint8_t low[NT_CHIP_FRAME_SIZE] = {0}, high[NT_CHIP_FRAME_SIZE];
        memset(high, 0xFF, sizeof high);
        if (one->is_dac) { /* no code that is ever written reads back like it */
            assert_true(nt_chip_code_of(one, low) < nt_chip_lowest(one));
            assert_true(nt_chip_code_of(one, high) > nt_chip_highest(one));
        } else {
            assert_int_equal(nt_chip_check(one, low), NT_CHIP_STUCK);
            assert_int_equal(nt_chip_check(one, high), NT_CHIP_STUCK);
        }
    }
}

/* Every code is the nearest one of its own voltage; what is written is what is read. */
static void codes_go_there_and_back(void **state)
{
    (void)state;
    for (int i = 0; i < nt_chip_count(); ++i) {
        const nt_chip *one = nt_chip_at(i);
        const nt_chip_span span = {one->is_dac && one->channels > 1 ? 0.0 : -9.97, 10.03};
        const int32_t lowest = nt_chip_lowest(one), highest = nt_chip_highest(one);
        const int32_t stride = (highest - lowest) / 4099 > 0 ? (highest - lowest) / 4099 : 1;
        for (int32_t code = lowest; code <= highest; code += stride) {
            int32_t back = 0;
            assert_int_equal(nt_chip_code(one, &span, nt_chip_volts(one, &span, code), &back), NT_OK);
            assert_int_equal(back, code);
            if (one->is_dac) {
                const nt_chip_frame frame = nt_chip_write(one, one->channels - 1, code);
                assert_int_equal(nt_chip_code_of(one, frame.bytes), code);
            }
        }
        int32_t kept = 7;
        const double step = nt_chip_step(one, &span);
        assert_int_equal(nt_chip_code(one, &span, nt_chip_volts(one, &span, highest) + 0.6 * step, &kept), NT_E_RANGE);
        assert_int_equal(nt_chip_code(one, &span, nt_chip_volts(one, &span, lowest) - 0.6 * step, &kept), NT_E_RANGE);
        assert_int_equal(nt_chip_code(one, &span, 1e300, &kept), NT_E_RANGE);
        assert_int_equal(nt_chip_code(one, &span, (double)NAN, &kept), NT_E_NOT_FINITE);
        assert_int_equal(kept, 7);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_list_is_whole),
        cmocka_unit_test(ad5791_words),
        cmocka_unit_test(ad5686_words),
        cmocka_unit_test(ad7606_samples),
        cmocka_unit_test(ad7768_sums_and_status),
        cmocka_unit_test(a_hanging_bus_is_never_good),
        cmocka_unit_test(codes_go_there_and_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
