/* SPDX-License-Identifier: BSD-3-Clause
 * A frame of /dev/nanotouch-bus, between the controller in the test kernel and the program that plays the chips. */
#ifndef TESTS_KERNEL_NANOTOUCH_BUS_H
#define TESTS_KERNEL_NANOTOUCH_BUS_H

#include <linux/types.h>

#define NANOTOUCH_FRAME 512 /* bytes under one chip select, at most */

struct nanotouch_frame {
    __u32 sequence; /* an answer has that of its question */
    __u32 chip;
    __u32 mode;  /* of SPI, 0 to 3 */
    __u32 clock; /* [Hz] */
    __u32 length; /* of an answer: what went through */
    __s32 error; /* of an answer: 0 or -errno */
    __u8 bytes[NANOTOUCH_FRAME];
};

#endif
