# SPDX-License-Identifier: BSD-3-Clause
"""Chips, channels and lines of a rig file: each a table, read key by key."""

from __future__ import annotations

import datetime
from typing import Any

from nanotouch import _core
from nanotouch.errors import InvalidValue
from nanotouch.touch._rig_table import Table

MOST_DEBOUNCE = 0.1
"""of the limit switch [s], as nt_gpio_open has it"""
LINES = ("emergency_stop", "limit_switch", "laser_enable", "watchdog", "convert")
CONTEXTS = ("local:", "ip:", "usb:", "serial:")
"""where libiio may look; what else it knows would open files and plug-ins that the name says"""


def context(table: Table) -> str:
    """Where the devices of IIO are."""
    given: str = table.word("context", example='"local:"')
    if not given.startswith(CONTEXTS):
        raise InvalidValue(f"[{table.where}] context = {given!r}: valid begin with {', '.join(CONTEXTS)}")
    return given


def chip(table: Table) -> dict[str, Any]:
    """A converter on a bus of its own."""
    kind = table.word("chip", example=f'"{_core.rigs.chips()[0]}"')
    if kind not in _core.rigs.chips():
        raise InvalidValue(f"[{table.where}] chip = {kind!r}: known are {', '.join(_core.rigs.chips())}")
    made = {
        "chip": kind,
        "device": table.word("device", example='"/dev/spidev0.0"'),
        "clock": table.number("clock", "Hz"),
        "low": table.number("low", "V"),
        "high": table.number("high", "V"),
    }
    table.done()
    return made


def iio_chip(table: Table) -> dict[str, Any]:
    """A device of IIO: what its driver does not say."""
    ways = [way for way in ("inputs", "outputs") if way in table.left]
    if len(ways) != 1:
        raise InvalidValue(f'[{table.where}] needs inputs or outputs, one of them: write inputs = ["voltage0"]')
    channels = table.left.pop(ways[0])
    if not isinstance(channels, list) or not channels or not all(_is_word(channel) for channel in channels):
        raise InvalidValue(f'[{table.where}] {ways[0]} = {channels!r}: write {ways[0]} = ["voltage0"]')
    made = {
        "chip": "IIO",
        "device": table.word("device", example='"ad5791"'),
        "channels": channels,
        "is_output": ways[0] == "outputs",
        "bits": table.word("bits", int, "16"),
        "low": table.number("low", "V"),
        "high": table.number("high", "V"),
    }
    table.done()
    return made


def _is_word(given: object) -> bool:
    return isinstance(given, str) and bool(given) and given.isprintable() and " " not in given


def channel(table: Table, chips: list[str], unit: str, calibrated: dict[str, datetime.date]) -> dict[str, Any]:
    """What a channel of one of these chips means; its day goes into ``calibrated``."""
    name = table.word("chip", example=f'"{chips[0]}"')
    if name not in chips:
        raise InvalidValue(f"[{table.where}] chip = {name!r}: this half has {', '.join(chips)}")
    made = {
        "converter": chips.index(name),
        "channel": table.word("channel", int, "0"),
        "gain": table.number("gain", f"{unit}/V"),
        "offset": table.number("offset", unit),
        "uncertainty": table.number("uncertainty", ""),
        "minimum": table.number("minimum", unit),
        "maximum": table.number("maximum", unit),
        "noise": table.number("noise", unit, 0.0),
        "latency": table.number("latency", "s", 0.0),
    }
    day = table.word("calibrated", datetime.date, "2026-11-20")
    if isinstance(day, datetime.datetime):
        day = day.date()
    if day > datetime.date.today() + datetime.timedelta(days=1):  # a day: of another time zone
        raise InvalidValue(f"[{table.where}] calibrated = {day} is in the future: today is {datetime.date.today()}")
    calibrated[table.where] = day
    table.done()
    return made


def lines(table: Table) -> dict[str, Any]:
    """The digital lines of a half."""
    made: dict[str, Any] = {"emergency_stop": table.word("emergency_stop", example='"estop"')}
    for name in LINES[1:]:
        made[name] = table.word(name, example='"..."') if name in table.left else None
    made["debounce"] = table.number("debounce", "s", 0.0)
    if not 0.0 <= made["debounce"] <= MOST_DEBOUNCE:
        raise InvalidValue(f"[{table.where}] debounce = {made['debounce']:g} s: valid is 0 .. {MOST_DEBOUNCE:g} s")
    table.done()
    return made
