/* SPDX-License-Identifier: BSD-3-Clause
 * Converters that a driver of the kernel's Industrial I/O runs, as the exchange of a half on converters (converters.h).
 * Each number is a file of sysfs, or a message over a network: for slow channels. Built into nanotouch::linux with
 * libiio 0.23 or newer, below 1.0; else NT_E_UNSUPPORTED. One thread per handle; nothing here is real-time safe. */
#ifndef NANOTOUCH_HAL_IIO_H
#define NANOTOUCH_HAL_IIO_H

#include "nanotouch/advanced/converters.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    NT_IIO_INPUTS = 5,  /* channels of a device that measures, at most */
    NT_IIO_OUTPUTS = 4, /* of one that drives */
    NT_IIO_REASON = 256 /* characters of why something cannot be opened, with the final 0 */
};

/* A device of the context, as the rig file names it. */
typedef struct nt_iio_device {
    const char *device;                  /* name or id: "ad5791", "iio:device0" */
    const char *channels[NT_IIO_INPUTS]; /* ids: "voltage0"; a converter's channel 0 is the first one */
    nt_chip chip;                        /* nt_chip_of_iio */
    nt_chip_span span;                   /* volts at the lowest and at the highest code */
} nt_iio_device;

/* The stand-in of a chip whose frames a driver makes: `bits` 2 .. 24 (20 where it drives) and `channels` 1 ..
 * NT_IIO_INPUTS or NT_IIO_OUTPUTS. A name of NULL: these are none. */
NT_API nt_chip nt_chip_of_iio(int bits, int channels, int is_output);

typedef struct nt_iio {
    void *context; /* libiio's; NULL: not open */
    int count;
    struct {
        void *channels[NT_IIO_INPUTS];
        nt_chip chip;
        nt_chip_span span;
        long long lowest; /* the raw number of the lowest code */
        uint8_t reply[3]; /* what the next word brings */
    } converter[NT_CONVERTERS];
    uint64_t read, written, refused; /* numbers so far [-] */
    int error;                       /* errno of the last one that was refused */
} nt_iio;

/* Opens a context ("local:", "ip:HOST", ...) and finds the channels, in the order of a half's converters. What the
 * driver says of scale and offset must be the span's. Nothing is driven. NT_E_ARGUMENT; NT_E_DEVICE with why in
 * `reason` (NULL is allowed), and nothing is open then; NT_E_UNSUPPORTED. */
NT_API nt_status nt_iio_open(nt_iio *iio, const char *uri, const nt_iio_device *devices, int count,
                             char reason[NT_IIO_REASON]);
/* As nt_exchange wants it; the context is the nt_iio. A device that is gone, or a connection that is lost, is
 * NT_E_DEVICE; what else is refused, and a number beyond the span, NT_E_STATE. */
NT_API nt_status nt_iio_exchange(void *iio, int converter, const nt_transfer *transfers, int count);
/* `count` scans of a device's channels at its trigger (NULL: the one that it has), into volts[count * channels], scan
 * by scan [V]. Waits for all: 1 s, and twice their time where trigger or device has a sampling_frequency. None is
 * written on failure. Fails as nt_iio_exchange; NT_E_ARGUMENT for a device that drives, or without a buffer.
 */
NT_API nt_status nt_iio_scan(nt_iio *iio, int converter, const char *trigger, double *volts, long count);
/* Accepts NULL and one that is closed. */
NT_API void nt_iio_close(nt_iio *iio);

#ifdef __cplusplus
}
#endif
#endif
