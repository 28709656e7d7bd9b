/* SPDX-License-Identifier: BSD-3-Clause
 * A half of a rig on converters: which chip's channel is which position, force or deflection, and what a volt means.
 * It is a backend as hal_backend.h wants it, without an operating system: the frames go through an exchange that the
 * caller gives, spidev's (hal_spi.h) or that of a microcontroller. docs/hardware.md has a worked rig. */
#ifndef NANOTOUCH_CONVERTERS_H
#define NANOTOUCH_CONVERTERS_H

#include "nanotouch/advanced/chips.h"
#include "nanotouch/hal_backend.h"

#ifdef __cplusplus
extern "C" {
#endif

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
/* Checks one channel of it, which must be part of the setup; NT_OK for one that is not used. */
NT_API nt_status nt_converter_channel_check(const nt_converter_setup *setup, const nt_converter_channel *channel,
                                            nt_problem *problem);
/* Checks and copies the setup. Nothing is sent. */
NT_API nt_status nt_converter_half_init(nt_converter_half *converters, const nt_converter_setup *setup,
                                        nt_problem *problem);
/* The backend of a half; its context is the nt_converter_half. */
NT_API const nt_backend *nt_converter_half_backend(nt_half half);

#ifdef __cplusplus
}
#endif
#endif
