/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what hal_linux.h does not promise. */
#ifndef NANOTOUCH_HAL_LINUX_HAL_LINUX_PRIVATE_H
#define NANOTOUCH_HAL_LINUX_HAL_LINUX_PRIVATE_H

#include "nanotouch/advanced/hal_linux.h"

/* The one line of that name over all chips. NT_E_DEVICE if there is none, NT_E_ARGUMENT if several bear the name. */
nt_status nt_gpio_line_find(const char *name, nt_gpio_line *line);
/* A press shorter than the time between two calls is seen. Unlike elsewhere *state is written on failure too: when a
 * line cannot be read (NT_E_DEVICE: chip gone) its flag is set, now and for good. */
nt_status nt_gpio_read(nt_gpio *gpio, nt_gpio_state *state);
/* Switches the laser. NT_E_STATE if no laser line was wired, NT_E_DEVICE if the line is gone. */
nt_status nt_gpio_laser(nt_gpio *gpio, int on);
/* The next edge of the watchdog; a pulse of the conversion line. NT_E_STATE if it is not wired, NT_E_DEVICE if it is
 * gone. */
nt_status nt_gpio_beat(nt_gpio *gpio);
/* A pulse of the conversion line; fails as nt_gpio_beat. */
nt_status nt_gpio_convert(nt_gpio *gpio);

#endif
