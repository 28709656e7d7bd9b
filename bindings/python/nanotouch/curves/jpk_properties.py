# SPDX-License-Identifier: BSD-3-Clause
"""The properties of a segment of a JPK archive: conversions from integers to volts, lengths and forces, by their units.

A conversion is written ``conversion.force.scaling.multiplier=0.043`` with ``...scaling.unit.unit=N`` and the slot that
it converts from; a unit may have a prefix (``nm``), and what is converted is in the unit of that slot.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ReadError

TYPES = {"signedshort": ">i2", "unsignedshort": ">u2", "signedinteger": ">i4", "unsignedinteger": ">u4",
          "signedlong": ">i8"}  # fmt: skip
FLOATS = {"float-data": ">f4", "double-data": ">f8", "float": ">f4", "double": ">f8"}
_PREFIX = {"": 1.0, "k": 1e3, "m": 1e-3, "u": 1e-6, "\xb5": 1e-6, "\xc2\xb5": 1e-6, "n": 1e-9,
           "p": 1e-12}  # fmt: skip

_ESCAPE = re.compile(r"\\(u[0-9a-fA-F]{4}|.)")
_LETTERS = {"t": "\t", "n": "\n", "r": "\r", "f": "\f"}
_LINE = re.compile(r"\s*([^\\\s=:]*(?:\\.[^\\\s=:]*)*)\s*[=:]?\s*(.*)")

Properties = dict[str, str]


class Facts:
    """The properties of one segment."""

    def __init__(self, file: Path, place: str, properties: Mapping[str, str]) -> None:
        self.file, self.place, self.properties = file, place, properties

    def text(self, key: str) -> str:
        if key not in self.properties:
            raise ReadError(f"{self.file}: {self.place} lacks {key!r}")
        return self.properties[key]

    def either(self, key: str, other: str) -> str:
        return self.properties[key] if key in self.properties else self.text(other)

    def number(self, key: str, other: str = "") -> float:
        value = as_number(self.either(key, other or key))
        if value is None:
            raise ReadError(f"{self.file}: {self.place}: {key!r} is {self.either(key, other or key)!r}, no number")
        return value

    def number_type(self, channel: str) -> str:
        """Of the encoder; of the data where there is none, as in float data."""
        for key in (f"channel.{channel}.data.encoder.type", f"channel.{channel}.encoder.type",
                    f"channel.{channel}.data.type", f"channel.{channel}.type"):  # fmt: skip
            if key in self.properties:
                return self.properties[key]
        return self.text(f"channel.{channel}.data.encoder.type")

    def converted(self, channel: str, slot: str, raw: NDArray[Any], unit: str) -> NDArray[np.float64]:
        """The integers in `unit`, that of `slot`: what leads from the base to it, and before that the encoder."""
        encoder, other = f"channel.{channel}.data.encoder.scaling.", f"channel.{channel}.encoder.scaling."
        conversions = f"channel.{channel}.conversion-set."
        base = self.text(f"{conversions}conversions.base")
        if unit == "V" and base in ("distance", "force"):
            raise ReadError(f"{self.file}: {self.place}: {channel} is stored as a {base}, not in volts")
        steps: list[str] = []
        while slot != base and slot != "volts":
            if len(steps) > 8:
                raise ReadError(f"{self.file}: {self.place}: the conversions of {channel} go round")
            steps.append(f"{conversions}conversion.{slot}.")
            if not self._is_defined(steps[-1]):
                raise ReadError(f"{self.file}: {self.place}: {steps[-1]}defined is false: {channel} has no {slot}")
            slot = self.text(f"{steps[-1]}base-calibration-slot")
        if self.number_type(channel) in FLOATS and not {f"{encoder}multiplier", f"{other}multiplier"} & set(
            self.properties
        ):
            values = raw.astype(np.float64)
        else:
            values = raw * self.number(f"{encoder}multiplier", f"{other}multiplier")
            values += self.number(f"{encoder}offset", f"{other}offset")
        for step in reversed(steps):
            self._check_linear(f"{step}scaling.")
            values *= self.number(f"{step}scaling.multiplier")
            values += self.number(f"{step}scaling.offset")
        return np.asarray(values * (self.factor(f"{steps[0]}scaling.", unit) if steps else self._base(channel, unit)))

    def _base(self, channel: str, unit: str) -> float:
        """What one unit of a channel's stored values is in `unit`."""
        scalings = (
            f"channel.{channel}.{place}" for place in ("data.encoder.scaling.", "encoder.scaling.", "data.", "")
        )
        return next((self.factor(one, unit) for one in scalings if f"{one}unit.unit" in self.properties), 1.0)

    def _check_linear(self, scaling: str) -> None:
        for key, known in (("type", "linear"), ("style", "offsetmultiplier")):
            told = self.properties.get(f"{scaling}{key}", known)
            if told != known:
                raise ReadError(f"{self.file}: {self.place}: {scaling}{key} is {told!r}, expected {known!r}")

    def factor(self, scaling: str, unit: str) -> float:
        """What one of a scaling's unit is in `unit`, which is meant where none is stated."""
        stated = self.properties.get(f"{scaling}unit.unit", unit)
        prefix = stated.removesuffix(unit)
        if not stated.endswith(unit) or prefix not in _PREFIX:
            raise ReadError(
                f"{self.file}: {self.place}: {scaling}unit is {stated!r}, expected {unit} with or without a prefix"
            )
        return _PREFIX[prefix]

    def _is_defined(self, conversion: str) -> bool:
        return self.properties.get(f"{conversion}defined", "true") != "false"

    def data_file(self, channel: str) -> str:
        """The file of the archive that holds a channel, in the folder of the segment."""
        usual = f"channels/{channel}.dat"
        name = self.properties.get(f"channel.{channel}.data.file.name", usual)
        if name.startswith("/") or ".." in name.split("/"):
            raise ReadError(
                f"{self.file}: {self.place}: channel.{channel}.data.file.name is {name!r}, outside the segment"
            )
        return self.place + name

    def multiplier(self, slot: str, unit: str, below: str, per: str) -> float | None:
        """Of the deflection's conversion to `slot` from that `below`, in `unit` per `per`; None where there is none."""
        conversion = f"channel.vDeflection.conversion-set.conversion.{slot}."
        if f"{conversion}scaling.multiplier" not in self.properties or not self._is_defined(conversion):
            return None
        base = self.properties.get(f"{conversion}base-calibration-slot", below)
        if base != below:
            raise ReadError(f"{self.file}: {self.place}: {slot} is converted from {base!r}, expected {below!r}")
        self._check_linear(f"{conversion}scaling.")
        if below == "volts":
            one = self._base("vDeflection", per)
        else:
            one = self.factor(f"channel.vDeflection.conversion-set.conversion.{below}.scaling.", per)
        return self.number(f"{conversion}scaling.multiplier") * self.factor(f"{conversion}scaling.", unit) / one

    def offset(self, slot: str, unit: str) -> float:
        scaling = f"channel.vDeflection.conversion-set.conversion.{slot}.scaling."
        return (
            self.number(f"{scaling}offset") * self.factor(scaling, unit)
            if f"{scaling}offset" in self.properties and self._is_defined(scaling.removesuffix("scaling."))
            else 0.0
        )


def pairs_of(text: str) -> Iterator[tuple[str, str]]:
    """Keys and values of Java properties: between them ``=``, ``:`` or a space, and spaces about it. A backslash at the
    end of a line goes on with the next."""
    begun = ""
    for line in re.split(r"\r\n|\r|\n", text):
        line = begun + (line.lstrip(" \t\f") if begun else line)
        begun = ""
        if (len(line) - len(line.rstrip("\\"))) % 2:
            begun = line[:-1]
        elif line and line[0] not in "#!":
            yield _pair_of(line)
    if begun:
        yield _pair_of(begun)


def _pair_of(line: str) -> tuple[str, str]:
    match = _LINE.fullmatch(line)
    key, value = (match[1], match[2]) if match else (line, "")
    return (_unescaped(key), _unescaped(value)) if "\\" in line else (key, value)


def _unescaped(text: str) -> str:
    def meant(match: re.Match[str]) -> str:
        code = match[1]
        return chr(int(code[1:], 16)) if len(code) == 5 else _LETTERS.get(code, code)

    return _ESCAPE.sub(meant, text)


def segments_of(names: Iterable[str]) -> dict[str, list[int]]:
    """For each folder of a curve the numbers of its segments that have a header, in order."""
    found: dict[str, list[int]] = {}
    for name in names:
        folder, mark, rest = name.rpartition("segments/")
        number, _, last = rest.partition("/")
        if mark and last == "segment-header.properties" and number.isdecimal():
            found.setdefault(folder, []).append(int(number))
    return {folder: sorted(numbers) for folder, numbers in found.items()}


def as_number(text: str) -> float | None:
    try:
        value = float(text if "_" not in text else "")
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def grouped(shared: Properties) -> dict[tuple[str, str], Properties]:
    """``lcd-info.0.unit=V`` as ``[("lcd-info", "0")]["unit"] = "V"``."""
    groups: dict[tuple[str, str], Properties] = {}
    for key, value in shared.items():
        kind, _, rest = key.partition(".")
        number, _, rest = rest.partition(".")
        groups.setdefault((kind, number), {})[rest] = value
    return groups
