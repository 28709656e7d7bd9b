/* SPDX-License-Identifier: BSD-3-Clause
 * A half of a rig on converters: which chip's channel is which position, force or deflection, and what a volt means.
 * It is a backend as hal_backend.h wants it, without an operating system: the frames go through an exchange that the
 * caller gives, spidev's (hal_linux.h) or that of a microcontroller. docs/hardware.md has a worked rig. */
#ifndef NANOTOUCH_ADVANCED_CONVERTERS_H
#define NANOTOUCH_ADVANCED_CONVERTERS_H

#include <stdint.h>

#include "nanotouch/hal_backend.h"
#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- Converters on SPI as data: one constant table a chip, and pure functions that make and read its frames. Nothing
 * here knows a bus or an operating system. What the tables say is from the data sheets (docs/hardware.md names them).
 * --- */

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

/* --- frames of an ADC --- */

/* What is wrong with an answer. */
typedef enum nt_chip_verdict {
    NT_CHIP_GOOD,
    NT_CHIP_STUCK,    /* all bits are 0, or all are 1: nobody drives the bus */
    NT_CHIP_DAMAGED,  /* its check sum is wrong */
    NT_CHIP_UNFIT,    /* its status says that the number is none */
    NT_CHIP_SATURATED /* good, and its status says that the input was beyond the range */
} nt_chip_verdict;

enum {
    NT_CONVERTERS = 4,                    /* chips of a half, at most */
    NT_CONVERTER_BAD = 8,                 /* bad exchanges in a row after which a half is lost */
    NT_CONVERTER_FRAMES = 2 * NT_AXES + 2 /* in one exchange, at most */
};

/* What a half drives: an axis each, and of a slave that taps two more. */
enum { NT_DRIVES_AMPLITUDE = NT_AXES, NT_DRIVES_FREQUENCY, NT_DRIVES };

/* What a lock-in amplifier gives an ADC. */
enum { NT_LOCK_IN_AMPLITUDE, NT_LOCK_IN_LAG, NT_LOCK_IN_OUTPUTS };

/* One frame of an exchange; `in` is what came back (as many bytes). */
typedef struct nt_transfer {
    const uint8_t *out;
    uint8_t *in;
    uint32_t count;
} nt_transfer;

/* Sends `count` frames to the chip with this number, each under a chip select of its own, and waits for the bus alone.
 * NT_OK: all bytes of all frames went both ways. NT_E_DEVICE: the device is gone, for good. Anything else: it did not
 * work this time, and nothing of what came back counts. */
typedef nt_status (*nt_exchange)(void *context, int converter, const nt_transfer *transfers, int count);

/* Lines beside the bus; each may be NULL. They do not wait. */
typedef struct nt_converter_lines {
    uint32_t (*flags)(void *context);           /* NT_SAMPLE_EMERGENCY_STOP, NT_SAMPLE_LIMIT_SWITCH: at each read */
    void (*beat)(void *context);                /* once in a write: the watchdog's edge */
    void (*convert)(void *context);             /* before the ADCs are read: starts a conversion */
    nt_status (*enable)(void *context, int on); /* laser or amplifier: on once armed, off at disarm */
    void *context;
} nt_converter_lines;

/* A chip on its bus. */
typedef struct nt_converter {
    const nt_chip *chip;
    nt_chip_span span; /* [V] */
} nt_converter;

/* A channel and what its volts mean: value = offset + gain * volts. */
typedef struct nt_converter_channel {
    int is_used;
    int converter;           /* which chip: 0 .. */
    int channel;             /* of that chip: 0 .. */
    double gain;             /* [m/V], [N/V], [rad/V] or [Hz/V], not 0; its sign is that of the wiring */
    double offset;           /* the value at 0 V [m], ... */
    double uncertainty;      /* of gain, one standard deviation, relative [-] */
    double minimum, maximum; /* of the value, within the chip's span [m], ... */
    double noise, latency;   /* of a reading: standard deviation [m], ...; age beyond the conversion [s] */
} nt_converter_channel;

/* A half. What is driven along an axis is travel for a slave and motor force for a master. A position that no ADC
 * measures may be the converter that drives the stage: what is read is then what the chip says that it holds. A slave
 * taps if both outputs of a lock-in amplifier are read; drives that are not used are the instrument's own. */
typedef struct nt_converter_setup {
    nt_half half;
    int axes; /* 1 (z alone), 2 or 3 */
    int converters;
    nt_converter converter[NT_CONVERTERS];
    nt_converter_channel position[NT_AXES], felt[NT_AXES], driven[NT_DRIVES], lock_in[NT_LOCK_IN_OUTPUTS];
    nt_exchange exchange;
    void *bus; /* of exchange */
    nt_converter_lines lines;
} nt_converter_setup;

/* What a half has met since it was opened [-]. */
typedef struct nt_converter_counts {
    uint64_t exchanges;
    uint64_t failed;     /* of them: short, refused, interrupted too often */
    uint64_t stuck;      /* answers of nothing but 0 or 1 */
    uint64_t damaged;    /* with a wrong check sum */
    uint64_t unfit;      /* whose status spoils them */
    uint64_t mismatched; /* read-backs that are not what was written: code or control register */
    uint64_t clipped;    /* targets beyond a range, which went to its end */
} nt_converter_counts;

/* The half itself: the caller's, of fixed size, opened through nt_converter_half_backend. */
typedef struct nt_converter_half {
    nt_converter_setup setup;
    nt_converter_counts counts;
    const nt_host *host;
    nt_channel_row rows[2 * NT_AXES + NT_DRIVES + NT_LOCK_IN_OUTPUTS];
    int row_count;
    int32_t codes[NT_DRIVES]; /* that each driven channel was told last */
    double lift;              /* that disarm owes [m] */
    uint64_t sequence;
    int bad;         /* ticks in a row that did not work */
    uint32_t driven; /* what has been driven since it was opened, bit by bit */
    int is_armed;
    int is_gone; /* the bus has said so */
} nt_converter_half;

/* Checks a setup: NT_OK; else NT_E_ARGUMENT, NT_E_RANGE or NT_E_NOT_FINITE with the field. problem may be NULL. */
NT_API nt_status nt_converter_setup_check(const nt_converter_setup *setup, nt_problem *problem);
/* Checks and copies the setup. Nothing is sent. */
NT_API nt_status nt_converter_half_init(nt_converter_half *converters, const nt_converter_setup *setup,
                                        nt_problem *problem);
/* The backend of a half; its context is the nt_converter_half. */
NT_API const nt_backend *nt_converter_half_backend(nt_half half);

#ifdef __cplusplus
}
#endif
#endif
