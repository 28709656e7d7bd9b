/* SPDX-License-Identifier: BSD-3-Clause
 * A real rig on a Linux machine: safety lines on GPIO, buses of SPI, and a thread in real time.
 *
 * Safety lines: emergency stop and limit switch in, laser enable, watchdog and conversion start out. Built into
 * nanotouch::linux on libgpiod 2.1 or newer. One thread per handle; nothing here is real-time safe by proof: reading
 * costs up to four system calls, which do not wait. */
#ifndef NANOTOUCH_ADVANCED_HAL_LINUX_H
#define NANOTOUCH_ADVANCED_HAL_LINUX_H

#include <stdint.h>

#include "nanotouch/advanced/converters.h"
#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { NT_GPIO_NAME_SIZE = 64 };

/* A line that a chip of this machine offers. */
typedef struct nt_gpio_line {
    char name[NT_GPIO_NAME_SIZE];     /* "" if the line has none */
    char chip[NT_GPIO_NAME_SIZE];     /* "gpiochip0" */
    char consumer[NT_GPIO_NAME_SIZE]; /* who holds it; "" if it is free */
    unsigned offset;                  /* number of the line on its chip [-] */
} nt_gpio_line;

/* How many lines all chips have together; 0 where there is no chip, or none that may be opened. */
NT_API long nt_gpio_line_count(void);
/* Line `index` (0 .. count - 1), chips in the order of their numbers. NT_E_RANGE beyond the last one. */
NT_API nt_status nt_gpio_line_at(long index, nt_gpio_line *line);

/* Names of the lines, as the device tree gives them. NULL: not wired (the emergency stop must be).
 * Inputs are read fail-safe: HIGH is well, LOW is pressed, so that a cut wire, pulled down, reads as pressed. */
typedef struct nt_gpio_wiring {
    const char *emergency_stop; /* input, normally closed to HIGH */
    const char *limit_switch;   /* input, normally closed to HIGH */
    const char *laser_enable;   /* output, HIGH switches the laser on; needs a pull-down in hardware */
    const char *watchdog; /* output, an edge in each period of the loop; a circuit that misses them stops the rig */
    const char *convert;  /* output, a pulse before the ADCs are read; low at rest */
    double debounce;      /* of the limit switch alone: an emergency stop is never late [s], 0 .. 0.1 */
} nt_gpio_wiring;
/* "estop", "limit", "laser-en"; neither watchdog nor conversion line; 0 s. */
NT_API nt_gpio_wiring nt_gpio_wiring_defaults(void);

typedef struct nt_gpio nt_gpio;

/* Takes the lines: inputs with pull-down and edge detection, the laser off. On failure (NT_E_ARGUMENT, NT_E_DEVICE,
 * NT_E_NO_MEMORY) nothing is held, and the reason is in `reason` (size bytes, always ended by 0; NULL with 0 allowed).
 */
NT_API nt_status nt_gpio_open(const nt_gpio_wiring *wiring, char *reason, unsigned size, nt_gpio **gpio);
/* Switches the laser off and gives the lines back. NULL is allowed. */
NT_API void nt_gpio_close(nt_gpio *gpio);

/* What the inputs said since the last call. */
typedef struct nt_gpio_state {
    uint32_t flags;        /* NT_SAMPLE_EMERGENCY_STOP, NT_SAMPLE_LIMIT_SWITCH (types.h) */
    uint64_t lost_events;  /* edges that the kernel dropped since open [-]; each counts as pressed when it is seen */
    uint64_t lost_outputs; /* writes to an output that failed since open [-] */
} nt_gpio_state;
/* The lines of a half on converters: what is not wired is left alone. A lost input is an emergency stop; a lost laser
 * or watchdog line counts in lost_outputs of nt_gpio_state. */
NT_API nt_converter_lines nt_gpio_lines(nt_gpio *gpio);

/* --- The SPI buses of a Linux machine through the kernel's spidev, as the exchange of a half on converters
 * (converters.h). One thread per handle. A message costs one system call, which waits for the bus alone. --- */

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

/* --- What a Linux machine grants the thread of a loop: a real-time priority, memory that stays, a processor of its
 * own, no deep sleep. Each refusal is told in words; the loop may run without. NT_E_UNSUPPORTED elsewhere. --- */

typedef struct nt_realtime_wish {
    int priority;    /* of SCHED_FIFO: 1 .. 99; 0: not wished */
    int processor;   /* to stay on: 0 ..; -1: not wished */
    int locks;       /* memory is locked (mlockall), and some stack touched */
    int stays_awake; /* no deep idle state: /dev/cpu_dma_latency */
} nt_realtime_wish;
/* Priority 80, any processor, locked, awake. */
NT_API nt_realtime_wish nt_realtime_wish_defaults(void);

enum { NT_REALTIME_PRIORITY = 1, NT_REALTIME_PROCESSOR = 2, NT_REALTIME_MEMORY = 4, NT_REALTIME_AWAKE = 8 };

typedef struct nt_realtime {
    unsigned wished, granted; /* of the bits above */
    char refused[640];        /* a line for each wish that was refused, with why and what would help; "" if none */
    int awake_file;           /* -1: none */
    int policy, priority;     /* of the thread before */
} nt_realtime;

/* Asks for the calling thread. NT_OK whatever was granted; NT_E_RANGE for a priority or a processor that cannot be. */
NT_API nt_status nt_realtime_begin(nt_realtime *realtime, const nt_realtime_wish *wish);
/* Gives priority, memory and wakefulness back, by the same thread. Accepts NULL. */
NT_API void nt_realtime_end(nt_realtime *realtime);

#ifdef __cplusplus
}
#endif
#endif
