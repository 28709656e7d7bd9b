/* SPDX-License-Identifier: BSD-3-Clause
 * The safety lines as a half on converters wants them. */
#include <stddef.h>

#include "hal/linux/hal_linux.h"
#include "nanotouch/advanced/hal_linux.h"
#include "nanotouch/types.h"

/* A line that cannot be read has its flag set; so has what could not be asked at all. */
static uint32_t read_flags(void *context)
{
    nt_gpio_state state = {.flags = NT_SAMPLE_EMERGENCY_STOP};
    (void)nt_gpio_read(context, &state);
    return state.flags;
}

static void beat(void *context)
{
    (void)nt_gpio_beat(context); /* a lost watchdog stops the rig by itself */
}

static void convert(void *context)
{
    (void)nt_gpio_convert(context); /* the ADC then repeats itself, which the supervisor sees as stuck */
}

static nt_status enable(void *context, int on)
{
    const nt_status status = nt_gpio_laser(context, on);
    return status == NT_E_STATE ? NT_OK : status; /* no laser is wired */
}

nt_converter_lines nt_gpio_lines(nt_gpio *gpio)
{
    return (nt_converter_lines){read_flags, beat, convert, enable, gpio};
}
