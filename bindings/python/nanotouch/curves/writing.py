# SPDX-License-Identifier: BSD-3-Clause
"""Write force curves so that others open them: afmformats' HDF5 and text, and Igor waves; nanite and PyJibe read all.

The layout is that of afmformats' documentation: one group (or one file of text) per curve, a column per channel under
afmformats' name, in SI; ``segment`` counts 0 for the approach, 1 for the retraction. A pause counts 2, or 3, ...
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from numbers import Integral, Real
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import nanotouch

from .._io.writing import replacing
from ..errors import InvalidValue, require
from .curve import ForceCurve
from .igor import as_wave

ENDINGS = (".h5", ".hdf5", ".tab", ".ibw")
_UNITS = {"force": "N", "height (measured)": "m", "height (piezo)": "m", "segment": "", "time": "s"}
_WHOLE = ("enum", "point count", "segment count", "grid index x", "grid index y", "grid shape x", "grid shape y")
_NUMBERS = (
    "sensitivity", "spring constant", "duration", "duration approach", "duration retract", "rate approach",
    "rate retract", "setpoint", "speed approach", "speed retract", "z range", "grid center x", "grid center y",
    "grid size x", "grid size y", "position x", "position y",
)  # fmt: skip
_TEXTS = ("instrument", "curve id", "date", "session id", "time", "feedback mode")


def write(
    path: str | os.PathLike[str], curves: Sequence[ForceCurve], progress: Callable[[float], None] | None = None
) -> Path:
    """Write curves as ``.h5`` (many), ``.tab`` or ``.ibw`` (one), whole or not at all; all read back with :func:`read`.

    Force, height of the base, time where it is known, and what of ``curve.meta`` afmformats has a name for. The
    deflection is force over spring constant.

    Raises
    ------
    InvalidValue
        If the ending is another, a file of one is to hold several curves, or a curve has no force.
    """
    file = Path(path)
    if file.suffix.lower() not in ENDINGS:
        raise InvalidValue(f"{file}: curves are written as {', '.join(ENDINGS)}")
    if not curves:
        raise InvalidValue(f"{file}: no curve to write")
    if file.suffix.lower() == ".ibw":
        if len(curves) > 1:
            raise InvalidValue(f"{file}: holds one curve, not {len(curves)}; pick one, or write .h5")
        wave = as_wave(curves[0])
        with replacing(file) as part:
            part.write_bytes(wave)
        return file
    every = [(_facts(curve, number), _columns(curve)) for number, curve in enumerate(curves)]
    if file.suffix.lower() == ".tab":
        if len(every) > 1:
            raise InvalidValue(f"{file}: holds one curve, not {len(every)}; pick one, or write .h5")
        _write_tab(file, *every[0])
    else:
        _write_hdf5(file, every, progress)
    return file


Facts = dict[str, str | int | float]
Columns = dict[str, NDArray[Any]]


def _columns(curve: ForceCurve) -> Columns:
    """By afmformats' names; SI."""
    channel = curve.segments[0].z_channel
    if any(segment.force is None for segment in curve.segments):
        raise InvalidValue(
            f"{curve.name}: no force without a spring constant; give it to curves.read, or --spring-constant"
        )
    columns: Columns = {
        "force": np.concatenate([segment.force for segment in curve.segments if segment.force is not None]),
        channel if channel in _UNITS else "height (measured)": np.concatenate([s.z for s in curve.segments]),
        "segment": np.repeat(_numbers(curve), [len(s) for s in curve.segments]).astype(np.uint8),
    }
    time = np.concatenate([segment.time for segment in curve.segments])
    return columns | ({"time": time} if np.isfinite(time).all() else {})


def _numbers(curve: ForceCurve) -> list[int]:
    """Of the segments: the approach 0, the retraction 1, all others from 2 on."""
    main = dict.fromkeys(map(id, curve.parts("approach")), 0) | dict.fromkeys(map(id, curve.parts("retract")), 1)
    numbers, others = [], 2
    for segment in curve.segments:
        numbers.append(main.get(id(segment), others))
        others += id(segment) not in main
    return numbers


def _facts(curve: ForceCurve, number: int) -> Facts:
    """What afmformats has a name for."""
    facts: Facts = {"imaging mode": "force-distance", "enum": number}
    facts |= {"point count": sum(map(len, curve.segments)), "segment count": len(curve.segments)}
    facts |= {"software": "nanotouch", "software version": nanotouch.__version__}
    for key, value in curve.meta.items():
        if key in facts:
            continue
        if key in _WHOLE and isinstance(value, Integral):
            facts[key] = int(value)
        elif key in _NUMBERS and isinstance(value, Real) and np.isfinite(float(value)):
            facts[key] = float(value)
        elif key in _TEXTS and isinstance(value, str):
            facts[key] = value
    return facts


def _write_hdf5(
    file: Path, every: Sequence[tuple[Facts, Columns]], progress: Callable[[float], None] | None = None
) -> None:
    h5py = require("h5py", "record")
    with replacing(file) as part, h5py.File(part, "w") as stored:
        stored.attrs["software"], stored.attrs["software version"] = "nanotouch", nanotouch.__version__
        for number, (facts, columns) in enumerate(every):
            group = stored.create_group(str(number))
            group.attrs.update(facts)
            for name, values in columns.items():
                dataset = group.create_dataset(name, data=values, compression="gzip", fletcher32=True)
                dataset.attrs["unit"] = _UNITS[name]
            if progress:
                progress((number + 1) / len(every))


def _write_tab(file: Path, facts: Facts, columns: Columns) -> None:
    told = json.dumps(facts, indent=2, sort_keys=True)
    lines = [f"# nanotouch {nanotouch.__version__}", "#", "# BEGIN METADATA"]
    lines += [f"# {line}" for line in told.splitlines()] + ["# END METADATA", "#", "# " + "\t".join(columns)]
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    with replacing(file) as part:
        part.write_text("\n".join([*lines, *("\t".join(map(repr, row)) for row in rows)]) + "\n", encoding="utf-8")
