# SPDX-License-Identifier: BSD-3-Clause
"""A table of a rig file, read key by key: what is missing, odd or left over is refused by its name."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from nanotouch._io.words import told
from nanotouch.errors import InvalidValue
from nanotouch.units import key_spellings, to_si

MOST = 1000
"""whole numbers of a rig file are small: axes, channels"""


AXES = ("x", "y", "z")
QUANTITIES = {
    "master": {"position": "position", "force": "felt", "motor": "driven"},
    "slave": {"position": "position", "deflection": "felt", "travel": "driven"},
}
"""tables of a half, with what the library calls them"""
DRIVES = {"drive_amplitude": "m", "drive_frequency": "Hz"}
"""tables of what a slave drives beside its axes, in the order of the library, with their units"""
LOCK_IN = {"amplitude": "m", "lag": "rad"}
"""tables of the outputs of a lock-in amplifier, likewise"""


def keys_of(half: str) -> dict[str, list[str]]:
    """Tables of its channels by what the library calls them, in its order."""
    keys = {name: [f"{word}_{axis}" for axis in AXES] for word, name in QUANTITIES[half].items()} | {"lock_in": []}
    if half == "slave":
        keys["driven"] += DRIVES
        keys["lock_in"] += LOCK_IN
    return keys


def unit_of(half: str, key: str) -> str:
    """Of a channel's value."""
    is_force = half == "master" and not key.startswith("position")
    return "N" if is_force else (DRIVES | LOCK_IN).get(key, "m")


class Table:
    """A table of the file; every key that is taken out is known, and what is left is not."""

    def __init__(self, where: str, given: object) -> None:
        if not isinstance(given, Mapping):
            raise InvalidValue(f"[{where}] must be a table")
        self.where, self.left = where, dict(given)

    def word(self, key: str, kind: type | tuple[type, ...] = str, example: str = '"..."') -> Any:
        if key not in self.left:
            raise InvalidValue(f"[{self.where}] {key} is missing: write {key} = {example}")
        value = self.left.pop(key)
        is_large = isinstance(value, int) and not 0 <= value <= MOST
        is_odd = isinstance(value, str) and not (value and value.isprintable())
        if not isinstance(value, kind) or isinstance(value, bool) or is_large or is_odd:
            raise InvalidValue(f"[{self.where}] {key} = {value!r}: write {key} = {example}")
        return value

    def number(self, name: str, unit: str, default: float | None = None) -> float:
        keys = key_spellings(name, unit)
        found = [key for key in keys if key in self.left]
        if len(found) > 1:
            raise InvalidValue(f"[{self.where}] has both {found[0]} and {found[1]}: give one")
        if not found:
            if default is not None:
                return default
            raise InvalidValue(f"[{self.where}] {name} is missing: write {' or '.join(keys)} = a number")
        value = self.left.pop(found[0])
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise InvalidValue(f"[{self.where}] {found[0]} = {value!r}: it must be a finite number")
        return to_si(float(value), keys[found[0]])

    def table(self, key: str, example: str) -> Table:
        if key not in self.left:
            raise InvalidValue(f"[{self.where}.{key}] is missing: {example}")
        return Table(f"{self.where}.{key}", self.left.pop(key))

    def done(self) -> None:
        if self.left:
            raise InvalidValue(f"[{self.where}] has no key {told(next(iter(self.left)))}")
