# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of linux/input-event-codes.h."""

EV_KEY, EV_ABS, EV_FF = 0x01, 0x03, 0x15
ABS_X, FF_CONSTANT, BTN_JOYSTICK = 0x00, 0x52, 0x120
FF_GAIN, FF_AUTOCENTER = 0x60, 0x61
