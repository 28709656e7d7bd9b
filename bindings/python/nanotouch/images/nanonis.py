# SPDX-License-Identifier: BSD-3-Clause
"""Nanonis scans, ``.sxm``: a text header of ``:KEY:`` lines and their values, then floats, mostly big-endian.

The table ``DATA_INFO`` names channel, unit and direction. After ``:SCANIT_END:`` and the bytes 1A 04 each channel
follows with its forward picture. Where the direction is ``both`` its backward one follows, whose lines are stored in
the order of time, from right to left. ``SCAN_DIR`` says whether the first line is the lowest (``up``) or the top one
(``down``). Lines that were not scanned are NaN, or 0 to the end. Where the language of the computer has decimal commas,
numbers may have them. A scan in several passes names the pass: ``[P1] Z``.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .._arrays import Floats
from .._io.words import counted
from ..errors import ReadError
from .channel import Channel, Plane, chosen, si_unit, with_default
from .checks import LENGTHS, check_shape

NAME = "nanotouch/nanonis"
SIGNATURE = b":NANONIS_VERSION:"
_END = re.compile(rb"^:SCANIT_END:\s*\x1a\x04", re.MULTILINE)  # a comment may hold the words alone
_DECIDES = ("SCANIT_TYPE", "SCAN_PIXELS", "SCAN_RANGE", "SCAN_DIR", "DATA_INFO")
_HEADER_LIMIT = 1 << 22  # byte; those seen have 20 KiB
_ORDERS = {"MSBFIRST": ">f4", "LSBFIRST": "<f4"}
_PASS = re.compile(r"\[[^\]]*\]")


@dataclass(frozen=True)
class _Scan:
    """What the header says."""

    shape: tuple[int, int]
    size: tuple[float, float]  # (Ly, Lx) [m]
    up: bool  # the first line stored is the lowest
    pictures: tuple[tuple[str, str, bool], ...]  # name, unit, backward
    start: int  # of the data [byte]
    order: str  # of the bytes


def recognises(file: Path, head: bytes) -> bool:
    """Whether it is a Nanonis scan."""
    return head.startswith(SIGNATURE)


def channels(file: Path) -> list[Channel]:
    """Forward and backward pictures of all channels."""
    return _listed(_header(file))


def read(file: Path, channel: str | None) -> Plane:
    """One picture; forward heights if none is named."""
    scan = _header(file)
    check_shape(file, scan.shape)
    listed = _listed(scan)
    number = chosen(listed, channel, file)
    _, unit, backward = scan.pictures[number]
    count = scan.shape[0] * scan.shape[1]
    held, needed = file.stat().st_size, scan.start + 4 * count * len(scan.pictures)
    cut = f"{held} bytes long, but its header states {needed}: it is cut off"
    if held < scan.start + 4 * count * (number + 1):
        raise ReadError(f"{file}: {cut}")
    if held >= needed + 4 * scan.shape[1]:
        raise ReadError(f"{file}: {held} bytes long, but its header states {needed}: its pixels or channels are wrong")
    raw = np.fromfile(file, scan.order, count, offset=scan.start + 4 * count * number)
    lines, notes = _measured(raw.astype(np.float64).reshape(scan.shape))
    values = lines[:: 1 if scan.up else -1, :: -1 if backward else 1]
    ny, nx = scan.shape
    pixel_size = scan.size[0] / ny, scan.size[1] / nx
    notes += (f"{cut} after this picture",) if held < needed else ()
    return Plane(listed[number].name, np.array(values), unit, pixel_size, NAME, notes=notes)


def _measured(lines: Floats) -> tuple[Floats, tuple[str, ...]]:
    """In the order of time, with NaN for the last lines where all is exactly 0; and a note of them."""
    seen = np.flatnonzero(lines.any(axis=1))
    unseen = len(lines) - 1 - int(seen[-1]) if seen.size else 0
    if not unseen:
        return lines, ()
    lines[-unseen:] = np.nan
    return lines, (f"the last {counted(unseen, 'line')} of the scan hold 0 alone: taken as not scanned",)


def _listed(scan: _Scan) -> list[Channel]:
    return with_default(
        [
            Channel(
                f"{name} backward" if backward else name,
                scan.shape,
                scan.size,
                unit,
                "height" if _PASS.sub("", name).strip().casefold() == "z" and unit in LENGTHS else name.casefold(),
                False,
            )
            for name, unit, backward in scan.pictures
        ]
    )


def _header(file: Path) -> _Scan:
    with file.open("rb") as stream:
        content = stream.read(_HEADER_LIMIT)
    ends = _END.search(content)
    if ends is None:
        raise ReadError(f"{file}: its header does not end")
    facts = _facts(file, content[: ends.start()].decode("latin-1"))
    scan_type = _words(file, facts, "SCANIT_TYPE")
    if len(scan_type) != 2 or scan_type[0] != "FLOAT" or scan_type[1] not in _ORDERS:
        raise ReadError(f"{file}: numbers of the type {' '.join(scan_type)}, expected FLOAT MSBFIRST or LSBFIRST")
    try:
        nx, ny = (int(word) for word in _pair(file, facts, "SCAN_PIXELS", "whole numbers"))
        width, height = (float(word.replace(",", ".")) for word in _pair(file, facts, "SCAN_RANGE", "lengths [m]"))
    except ValueError as error:
        raise ReadError(f"{file}: SCAN_PIXELS or SCAN_RANGE holds what is no number: {error}") from None
    direction = [word.casefold() for word in _words(file, facts, "SCAN_DIR")]
    if direction not in (["up"], ["down"]):
        raise ReadError(f"{file}: scanned {' '.join(direction)!r}, expected up or down")
    up, order = direction == ["up"], _ORDERS[scan_type[1]]
    return _Scan((ny, nx), (height, width), up, _pictures(file, facts), ends.end(), order)


def _facts(file: Path, text: str) -> dict[str, list[str]]:
    """The lines below each key. One that decides how the data are read is not stated twice in two ways."""
    found: list[tuple[str, list[str]]] = []
    for line in text.splitlines():
        if line.startswith(":") and line.rstrip().endswith(":"):
            found.append((line.strip().strip(":").upper(), []))
        elif line.strip() and found:
            found[-1][1].append(line)
    facts: dict[str, list[str]] = {}
    for key, lines in found:
        known = facts.setdefault(key, lines)
        if key in _DECIDES and [line.split() for line in known] != [line.split() for line in lines]:
            told = " and as ".join(repr(" ".join(" ".join(one).split())[:60]) for one in (known, lines))
            raise ReadError(f"{file}: its header states {key} as {told}")
    return facts


def _words(file: Path, facts: dict[str, list[str]], key: str) -> list[str]:
    if not facts.get(key):
        raise ReadError(f"{file}: its header lacks {key}")
    return facts[key][0].split()


def _pair(file: Path, facts: dict[str, list[str]], key: str, noun: str) -> list[str]:
    words = _words(file, facts, key)
    if len(words) != 2:
        raise ReadError(f"{file}: {key} is {' '.join(words)!r}, expected two {noun}, along x and y")
    return words


def _pictures(file: Path, facts: dict[str, list[str]]) -> tuple[tuple[str, str, bool], ...]:
    """Rows of the table: number, name, unit, direction, ..., between tabs or, in some files, spaces."""
    found: list[tuple[str, str, bool]] = []
    for row in facts.get("DATA_INFO", [])[1:]:
        words = row.strip()
        cells = [cell.strip() for cell in (words.split("\t") if "\t" in words else words.split())]
        if len(cells) < 4 or cells[3].casefold() not in ("both", "forward", "backward"):
            raise ReadError(
                f"{file}: a channel of its table is {row.strip()!r}, expected number, name, unit, direction"
            )
        way = cells[3].casefold()
        directions = (False, True) if way == "both" else (way == "backward",)
        found += [(cells[1].replace("_", " "), si_unit(cells[2]), backward) for backward in directions]
    if not found:
        raise ReadError(f"{file}: its header lists no channel")
    return tuple(found)
