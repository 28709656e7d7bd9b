# SPDX-License-Identifier: BSD-3-Clause
"""The text header of Bruker's NanoScope files: sections ``\\*Name`` of lines ``\\Key: value``.

A value with a scale is written ``\\@4:Z scale: V [Sens. DeflSens] (0.000375 V/LSB) 2.5 V``: the integers times the
number in brackets times the named sensitivity (``\\@Sens. DeflSens: V 41.1 nm/V``, in another section). Versions write
keys with other capitals (``Ramp size``, ``Ramp Size``), and some leave the sensitivity's unit out.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from pathlib import Path

from ..errors import ReadError

SIGNATURES = (b"\\*File list", b"\\*Force file list", b"\\*Ciao", b"\\*EC File list")  # how the headers begin
_HEADER_LIMIT = 1 << 20  # byte; those seen have 80 KiB
_UNITS = {"V": 1.0, "mV": 1e-3, "nm/V": 1e-9, "um/V": 1e-6, "pm/V": 1e-12, "mm/V": 1e-3,
          "m/V": 1.0}  # fmt: skip
_PER_VOLT = {unit: value for unit, value in _UNITS.items() if unit.endswith("/V")}
_PER_VOLT |= {"\xc5/V": 1e-10, "\xc3\x85/V": 1e-10, "nm/mV": 1e-6, "pm/mV": 1e-9, "um/mV": 1e-3}  # \xc5: angstrom
_NUMBER = r"([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)"
_SCALED = re.compile(rf"V\s*\[Sens\. ([^\]]+)\]\s*\({_NUMBER}\s*(m?V)/LSB\)\s*{_NUMBER}\s*(m?V)")
_SIZE = re.compile(rf"{_NUMBER}(?:\s+{_NUMBER})?\s+(nm|um|pm|mm|m)")
_SENSITIVITY = re.compile(rf"V {_NUMBER}\s*(\S*)")
_STIFFNESS = re.compile(rf"{_NUMBER}\s*([munp]?N/m|[munp]N/[num]m)?")
_PREFIX = {"": 1.0, "m": 1e-3, "u": 1e-6, "n": 1e-9, "p": 1e-12}
# What decides size and scale, so that two values of it in one section leave neither to be believed
_DECIDES = re.compile(
    r"@sens\. .*|scan size|aspect ratio|samps/line|number of lines|bytes/pixel|data (offset|length)|spring constant"
    r"|@.*:(z scale|ramp size)"
)


class Section(dict[str, str]):
    """One section of the header; keys in lower case."""

    def __init__(self, file: Path, name: str) -> None:
        super().__init__()
        self.file, self.name = file, name
        self.header_end = 0  # of the file's header [byte], in its first section

    def text(self, key: str) -> str:
        """Of a key that must be there."""
        if key.lower() not in self:
            raise ReadError(f"{self.file}: its header lacks {key!r} in {self.name!r}")
        return self[key.lower()]

    def counts(self, key: str) -> list[int]:
        """Whole numbers."""
        words = self.text(key).split()
        if not words or not all(re.fullmatch("[0-9]{1,12}", word) for word in words):
            raise ReadError(f"{self.file}: {key!r} is {self.text(key)!r}, expected whole numbers")
        return [int(word) for word in words]

    def positive(self, key: str) -> float:
        """A number above 0, whatever unit follows it."""
        try:
            value = float(self.text(key).split()[0])
        except (ValueError, IndexError):
            value = math.nan
        if not 0.0 < value < math.inf:
            raise ReadError(f"{self.file}: {key!r} is {self.text(key)!r}, expected a positive number")
        return value

    def spring_constant(self) -> float:
        """In N/m, which is meant where no unit is stated."""
        text = self.text("Spring Constant")
        match = _STIFFNESS.fullmatch(plain_unit(text))
        value = float(match[1]) if match else math.nan
        if match is None or not 0.0 < value < math.inf:
            raise ReadError(f"{self.file}: 'Spring Constant' is {text!r}, expected a positive number [N/m]")
        newton, _, metre = (match[2] or "N/m").partition("/")
        return value * _PREFIX[newton[:-1]] / _PREFIX[metre[:-1]]

    def scaled(self, ending: str) -> tuple[str, float, float] | None:
        """Of the value whose key ends so: name of its sensitivity, V per LSB, V; None if there is none."""
        for key, value in self.items():
            match = _SCALED.match(value)
            if key.startswith("@") and key.endswith(ending.lower()) and match:
                name, per_lsb, lsb_unit, volts, unit = match.groups()
                return name, float(per_lsb) * _UNITS[lsb_unit], float(volts) * _UNITS[unit]
        return None

    def must_be_scaled(self, ending: str) -> tuple[str, float, float]:
        """The same of a value that must be there."""
        found = self.scaled(ending)
        if found is None:
            raise ReadError(f"{self.file}: its header lacks {ending!r} with a scale in {self.name!r}")
        return found

    @property
    def channel(self) -> str:
        """What an image section holds: ``S [DeflectionError] "Deflection Error"``."""
        return next((v for k, v in self.items() if k.startswith("@") and k.endswith(":image data")), "")


def sections(file: Path) -> list[Section]:
    """All sections of a file, in order."""
    with file.open("rb") as stream:
        text = stream.read(_HEADER_LIMIT).split(b"\x1a")[0].decode("latin-1")
    if "\\*File list end" not in text:
        raise ReadError(f"{file}: its header does not end")
    before, end, _ = text.partition("\\*File list end")
    found = parsed(file, before.splitlines())
    if found:
        found[0].header_end = len(before) + len(end)
    return found


def parsed(file: Path, lines: Iterable[str]) -> list[Section]:
    """The sections in the lines of a header."""
    found: list[Section] = []
    for line in lines:
        if line.startswith(("\\*", "\\?")):
            found.append(Section(file, line[2:].strip()))
        elif line.startswith("\\") and found:
            # A colon also stands in the name of a parameter: "@4:Z scale: V ..."
            key, _, value = line[1:].partition(": ")
            _state(found[-1], key.strip().rstrip(":"), value.strip())
    return found


def _state(one: Section, key: str, value: str) -> None:
    """The first statement counts; of what decides a scale, all of one section must agree."""
    known = one.setdefault(key.lower(), value)
    if known != value and _DECIDES.fullmatch(key.lower()):
        raise ReadError(f"{one.file}: {key!r} is stated as {known!r} and as {value!r} in {one.name!r}")


def section(found: list[Section], name: str) -> Section:
    """The first of this name."""
    for one in found:
        if one.name == name:
            return one
    raise ReadError(f"{found[0].file}: its header lacks the section {name!r}")


def version(found: list[Section]) -> int:
    """Of the software; 0 if not told."""
    text = found[0].get("version", "")
    return int(text, 16) if re.fullmatch("0x[0-9A-Fa-f]{8}", text) else 0


def sensitivity(found: list[Section], name: str) -> tuple[float, str] | None:
    """In m/V, with a note where its unit is left out; None where nobody measured one.

    Without a unit stand numbers of nm/V (as in versions that state it), and a bare 1 where nothing was calibrated.
    """
    for one in found:
        match = _SENSITIVITY.match(one.get(f"@sens. {name}".lower(), ""))
        if not match:
            continue
        value, unit = float(match[1]), plain_unit(match[2])
        if unit in _PER_VOLT:
            return value * _PER_VOLT[unit], ""
        if not unit and value != 1.0:
            return value * 1e-9, f"the header states the sensitivity {name} {value:g} without a unit: taken as nm/V"
    return None


def piezo(found: list[Section], name: str) -> float:
    """A sensitivity that must be there, in m/V."""
    known = sensitivity(found, name)
    if known is None:
        raise ReadError(f"{found[0].file}: {no_sensitivity(found, name)}")
    return known[0]


def no_sensitivity(found: list[Section], name: str) -> str:
    """Why it is not known."""
    stated = next((one[key] for one in found if (key := f"@sens. {name}".lower()) in one), None)
    if stated is None:
        return f"its header states no sensitivity {name!r}"
    if re.fullmatch(r"V 1\.?0*\s*", stated):
        return f"its header states no sensitivity {name!r}: a bare 1 is a placeholder"
    known = ", ".join(unit for unit in _PER_VOLT if "\xc3" not in unit)
    return f"its header states the sensitivity {name!r} as {stated!r}, expected a number of {known}"


def stated_everywhere(found: list[Section], key: str) -> list[str]:
    """Different values of a key, those of the scanner and the scan first."""

    def rank(one: Section) -> int:
        return next((i for i, name in enumerate(("scanner", "microscope", "scan")) if name in one.name.casefold()), 3)

    values = [one[key.casefold()] for one in sorted(found, key=rank) if key.casefold() in one]
    return list(dict.fromkeys(values))


def is_number(text: str) -> bool:
    """Whether it is a finite number."""
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def plain_unit(text: str) -> str:
    """A unit with its micro written as u, in whatever encoding it was stored (latin-1, UTF-8, Shift-JIS) or as ~."""
    for micro in ("\xc2\xb5", "\xce\xbc", "\x83\xca", "\xb5", "\u03bc", "~"):
        text = text.replace(micro, "u")
    return text.strip()


def size_of(text: str) -> tuple[float, float | None] | None:
    """``10 5 ~m`` as two lengths [m], the second None where only one is stated; None where it is none."""
    match = _SIZE.fullmatch(plain_unit(text))
    if match is None:
        return None
    unit = _UNITS[match[3] + "/V"]
    return float(match[1]) * unit, None if match[2] is None else float(match[2]) * unit


def scan_size(found: list[Section]) -> tuple[float, float] | None:
    """Along the fast and the slow axis [m], as the picture of a map states it, or its scan; None if neither does."""
    for name in ("Ciao image list", "Ciao scan list"):
        for one in found:
            size = size_of(one.get("scan size", "")) if one.name == name else None
            if size and size[0] > 0.0 and (size[1] or one.get("aspect ratio", "1:1") == "1:1"):
                return size[0], size[1] or size[0]
    return None
