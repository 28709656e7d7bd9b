# SPDX-License-Identifier: BSD-3-Clause
"""Gwyddion Simple Field, ``.gsf``: a text header, zeros up to a multiple of four bytes, little-endian floats.

The first row is the top of the picture. Sizes are in ``XYUnits``, heights in ``ZUnits``.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..errors import ReadError
from .channel import Channel, Plane, chosen, other_kind, si_unit, with_default, written_unit
from .checks import LENGTHS, check_shape

NAME = "nanotouch/gsf"
SIGNATURE = b"Gwyddion Simple Field 1.0\n"
_HEADER_LIMIT = 1 << 20  # byte


def recognises(file: Path, head: bytes) -> bool:
    """Whether it begins as the format wants."""
    return head.startswith(SIGNATURE)


def channels(file: Path) -> list[Channel]:
    """The one picture there is."""
    facts, _ = _header(file)
    size = _size(facts)
    title = facts.get("Title", "Data")
    kind = other_kind(title) or ("height" if facts.get("ZUnits", "m") in LENGTHS else title.casefold())
    return with_default([Channel(title, _shape(file, facts), size, facts.get("ZUnits"), kind, False)])


def read(file: Path, channel: str | None) -> Plane:
    """The heights."""
    facts, start = _header(file)
    (ny, nx), size = _shape(file, facts), _size(facts)
    chosen(channels(file), channel, file)
    check_shape(file, (ny, nx))
    if file.stat().st_size != start + 4 * nx * ny:
        raise ReadError(f"{file}: {file.stat().st_size} bytes long, but its header states {start + 4 * nx * ny}")
    values = np.fromfile(file, "<f4", nx * ny, offset=start).reshape(ny, nx)[::-1].astype(np.float64)
    pixel_size = None if size is None else (size[0] / ny, size[1] / nx)
    return Plane(facts.get("Title", "Data"), values, facts.get("ZUnits"), pixel_size, NAME)


def write(file: Path, field: Plane, offset: tuple[float, float] | None = None) -> None:
    """One channel: a length in metres, another unit as it is; NaN where there is no value.

    A header of text, 1 to 4 zeros up to a multiple of four bytes, floats; `offset` of the lower left corner (y, x) [m].
    """
    ny, nx = field.values.shape
    dy, dx = field.pixel_size or (1.0, 1.0)
    facts = {"XRes": nx, "YRes": ny, "XReal": repr(float(dx * nx)), "YReal": repr(float(dy * ny))}
    if offset is not None:
        facts |= {"XOffset": repr(offset[1]), "YOffset": repr(-(offset[0] + dy * ny))}
    facts |= {"XYUnits": "m" if field.pixel_size else "", "ZUnits": written_unit(field.unit)}
    facts["Title"] = " ".join(field.name.split())
    text = SIGNATURE.decode() + "".join(f"{key} = {value}\n" for key, value in facts.items() if value != "")
    header = text.encode("utf-8", "backslashreplace")
    values = field.values * LENGTHS.get(field.unit or "", 1.0)
    with file.open("wb") as stream:
        stream.write(header + b"\0" * (4 - len(header) % 4))
        stream.write(np.ascontiguousarray(values[::-1]).astype("<f4").tobytes())


def _header(file: Path) -> tuple[dict[str, str], int]:
    with file.open("rb") as stream:
        content = stream.read(_HEADER_LIMIT)
    text, zero, _ = content.partition(b"\0")
    if not zero:
        raise ReadError(f"{file}: its header does not end")
    pairs = (line.partition("=") for line in text.decode("utf-8", "replace").splitlines()[1:])
    facts = {key.strip(): value.strip() for key, _, value in pairs}
    if "ZUnits" in facts:
        facts["ZUnits"] = si_unit(facts["ZUnits"])
    return facts, (len(text) // 4 + 1) * 4


def _shape(file: Path, facts: dict[str, str]) -> tuple[int, int]:
    try:
        return int(facts["YRes"]), int(facts["XRes"])
    except (KeyError, ValueError):
        raise ReadError(f"{file}: its header states no pixels (XRes, YRes)") from None


def _size(facts: dict[str, str]) -> tuple[float, float] | None:
    """(Ly, Lx) [m]; None where the file states none, or no length."""
    scale = LENGTHS.get(facts.get("XYUnits", ""))
    try:
        return None if scale is None else (float(facts["YReal"]) * scale, float(facts["XReal"]) * scale)
    except (KeyError, ValueError):
        return None
