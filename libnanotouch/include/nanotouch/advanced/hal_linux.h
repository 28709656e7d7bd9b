/* SPDX-License-Identifier: BSD-3-Clause
 * Safety lines of a real rig on a Linux machine's GPIO: emergency stop and limit switch in, laser enable, watchdog
 * and conversion start out.
 * Built into nanotouch::linux on libgpiod 2.1 or newer. One thread per handle; nothing here is real-time safe by proof:
 * reading costs up to four system calls, which do not wait. */
#ifndef NANOTOUCH_HAL_LINUX_H
#define NANOTOUCH_HAL_LINUX_H

#include <stdint.h>

#include "nanotouch/advanced/converters.h"

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

#ifdef __cplusplus
}
#endif
#endif
