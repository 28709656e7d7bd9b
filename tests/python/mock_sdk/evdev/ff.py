# SPDX-License-Identifier: BSD-3-Clause
"""Structs of linux/input.h, with the fields of python-evdev."""

import ctypes

u16, s16 = ctypes.c_uint16, ctypes.c_int16


class Replay(ctypes.Structure):
    _fields_ = (("length", u16), ("delay", u16))


class Trigger(ctypes.Structure):
    _fields_ = (("button", u16), ("interval", u16))


class Envelope(ctypes.Structure):
    _fields_ = (("attack_length", u16), ("attack_level", u16), ("fade_length", u16), ("fade_level", u16))


class Constant(ctypes.Structure):
    _fields_ = (("level", s16), ("ff_envelope", Envelope))


class EffectType(ctypes.Union):
    _fields_ = (("ff_constant_effect", Constant),)


class Effect(ctypes.Structure):
    _fields_ = (("type", u16), ("id", s16), ("direction", u16), ("ff_trigger", Trigger), ("ff_replay", Replay),
                ("u", EffectType))  # fmt: skip
