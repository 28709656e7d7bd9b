/* SPDX-License-Identifier: BSD-3-Clause
 * The SPI buses of a Linux machine through the kernel's spidev, as the exchange of a half on converters (converters.h).
 * One thread per handle. A message costs one system call, which waits for the bus alone. */
#ifndef NANOTOUCH_HAL_SPI_H
#define NANOTOUCH_HAL_SPI_H

#include "nanotouch/advanced/converters.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    NT_SPI_MESSAGE = 64, /* bytes of a message at most: a Raspberry Pi 5 fails above (longer ones are chained) */
    NT_SPI_ATTEMPTS = 3, /* of a message that signals interrupt */
    NT_SPI_REASON = 256  /* characters of why a device cannot be opened, with the final 0 */
};

/* A chip's place. */
typedef struct nt_spi_device {
    const char *path; /* "/dev/spidev0.0" */
    uint32_t mode;    /* clock polarity << 1 | phase: nt_chip.spi_mode */
    double clock;     /* [Hz], 1e3 .. 1e8 */
} nt_spi_device;

/* The system calls, so that a test can stand in between. Each returns what the call returns, or -errno. */
typedef struct nt_spi_calls {
    int (*open)(void *context, const char *path); /* for this program alone: -EBUSY if another one has it */
    int (*control)(void *context, int file, unsigned long request, void *argument);
    void (*close)(void *context, int file);
    void *context;
} nt_spi_calls;

typedef struct nt_spi {
    nt_spi_calls calls;
    int count;
    int file[NT_CONVERTERS]; /* -1: not open */
    uint32_t clock[NT_CONVERTERS];
    uint64_t messages, interrupted, short_ones, refused; /* so far [-]; short: of another length than was asked for */
    int error;                                           /* errno of the last one that was refused */
} nt_spi;

/* Opens the devices in the order of a half's converters, sets mode, 8 bits and clock, and reads them back. calls: NULL
 * for the kernel's. NT_E_ARGUMENT, NT_E_RANGE; NT_E_DEVICE with why in `reason` (NULL is allowed), and nothing is open
 * then; NT_E_UNSUPPORTED without calls where there is no spidev. */
NT_API nt_status nt_spi_open(nt_spi *spi, const nt_spi_device *devices, int count, const nt_spi_calls *calls,
                             char reason[NT_SPI_REASON]);
/* As nt_exchange wants it; the context is the nt_spi. EIO and the like are NT_E_STATE: this tick did not work. ENODEV,
 * ENXIO, ESHUTDOWN and EBADF are NT_E_DEVICE: the bus is gone. The kernel returns the whole length whatever went
 * through, and leaves bytes of the message before where nothing came: a short transfer is for read-back and check sum
 * to find. Any other length is no answer of the kernel's, and NT_E_STATE. */
NT_API NT_REALTIME nt_status nt_spi_exchange(void *spi, int converter, const nt_transfer *transfers, int count);
/* Accepts NULL and one that is closed. */
NT_API void nt_spi_close(nt_spi *spi);

#ifdef __cplusplus
}
#endif
#endif
