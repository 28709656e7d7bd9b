/* SPDX-License-Identifier: BSD-3-Clause
 * Converters on SPI as data: one constant table a chip, and pure functions that make and read its frames. Nothing here
 * knows a bus or an operating system. What the tables say is from the data sheets (docs/hardware.md names them). */
#ifndef NANOTOUCH_CHIPS_H
#define NANOTOUCH_CHIPS_H

#include <stdint.h>

#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    NT_CHIP_FRAME_SIZE = 16, /* bytes of the longest frame */
    NT_CHIP_CHANNELS = 8,    /* of the chip with most of them */
    NT_CHIP_SETUP = 2        /* frames that a chip is set up with, at most */
};

/* One exchange under one chip select: as many bytes out as in. */
typedef struct nt_chip_frame {
    uint8_t bytes[NT_CHIP_FRAME_SIZE];
    uint32_t count; /* of bytes in use */
} nt_chip_frame;

/* A DAC takes words of 24 bits: command and channel above, the code below, left-aligned in `field` bits. */
typedef struct nt_chip_words {
    uint32_t write, read;       /* words without channel and code; the answer to `read` comes with the next word */
    uint32_t nothing;           /* a word that changes nothing */
    uint32_t channels[4];       /* or-ed to both, by channel */
    uint32_t field;             /* bits below that hold the code [-] */
    uint32_t control, ask, off; /* write and read the control register, bits of it that mean "output off"; 0: none */
    uint32_t always;            /* what the control register is given in any case */
    const double *spans;        /* up to such a span of the output [V], ended by 0 */
    const uint32_t *matching;   /* this is or-ed to `always` */
} nt_chip_words;

/* An ADC answers in bytes, most significant first: its channels in order, then status, then a check sum. */
typedef struct nt_chip_answer {
    uint32_t count;              /* bytes of a frame */
    uint32_t width;              /* bytes of a channel */
    uint32_t status, bad, clips; /* where the status is (0: nowhere), its bits that spoil, and that say "saturated" */
    uint32_t sum;                /* where the CRC-8 over all before it is (0: nowhere); x^8 + x^2 + x + 1 */
    uint8_t sum_start;           /* its first value */
} nt_chip_answer;

typedef struct nt_chip {
    const char *name; /* "AD5791" */
    int is_dac;       /* 0: it measures */
    int bits;         /* of a code [-] */
    int channels;
    int is_signed;       /* codes are two's complement */
    double steps;        /* codes that the span is divided into [-] */
    uint32_t spi_mode;   /* clock polarity << 1 | phase */
    double clock;        /* fastest [Hz] */
    double settle;       /* from the frame to the settled output, or from the sample to its code, at most [s] */
    nt_chip_words words; /* of a DAC */
    nt_chip_answer answer;
    nt_chip_frame setup[NT_CHIP_SETUP]; /* sent once, those with a count */
} nt_chip;

/* Volts at the lowest code and at the upper end of the span: references and jumpers of the board. */
typedef struct nt_chip_span {
    double low, high; /* [V] */
} nt_chip_span;

/* How many chips are known. */
NT_API int nt_chip_count(void);
/* The chip of an index, 0 .. nt_chip_count() - 1; NULL for any other. */
NT_API const nt_chip *nt_chip_at(int index);
/* By its name, as it is written on the chip. NULL if it is not known. */
NT_API const nt_chip *nt_chip_find(const char *name);

/* The step between two codes [V], > 0. Real-time safe. */
NT_API NT_REALTIME double nt_chip_step(const nt_chip *chip, const nt_chip_span *span);

/* --- frames of a DAC; channel and code must be ones that it has --- */

/* The question for what a channel holds. The answer comes with the next frame. */
NT_API NT_REALTIME nt_chip_frame nt_chip_ask(const nt_chip *chip, int channel);

/* --- frames of an ADC --- */

/* The frame that fetches a sample, of the channel that the chip has. */
NT_API NT_REALTIME nt_chip_frame nt_chip_poll(const nt_chip *chip);

/* What is wrong with an answer. */
typedef enum nt_chip_verdict {
    NT_CHIP_GOOD,
    NT_CHIP_STUCK,    /* all bits are 0, or all are 1: nobody drives the bus */
    NT_CHIP_DAMAGED,  /* its check sum is wrong */
    NT_CHIP_UNFIT,    /* its status says that the number is none */
    NT_CHIP_SATURATED /* good, and its status says that the input was beyond the range */
} nt_chip_verdict;

#ifdef __cplusplus
}
#endif
#endif
