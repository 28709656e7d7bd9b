# SPDX-License-Identifier: BSD-3-Clause
"""Force curves as Igor binary waves of version 5 (WaveMetrics, Technical Note 003), named as Asylum Research does.

Columns ``Raw`` and ``ZSnsr`` (travel of the base towards the sample, m) and ``Defl`` (m), approach first; the note says
spring constant and sensitivity. Igor, afmformats, nanite, PyJibe and Gwyddion open them.
"""

from __future__ import annotations

import struct
from datetime import datetime
from typing import Any

import numpy as np

import nanotouch

from ..errors import InvalidValue
from .curve import ForceCurve

_LABELS = ("Raw", "Defl", "ZSnsr")
_LABEL_SIZE = 32  # byte
_DOUBLE = 4  # type of the numbers
_HEADER = struct.Struct("<2h15i")  # version, checksum, sizes: wave, formula, note, units (1 + 4), labels (4), rest (3)
_WAVE = struct.Struct(
    "<3Ii2h6sh32siI4i8d4s16s2h2d10I16i3h2BIi2h2I"
)  # next, dates, points, type, ..., name, ..., shape, ...


def as_wave(curve: ForceCurve) -> bytes:
    """The file's content; pauses are left out.

    Raises
    ------
    InvalidValue
        If the curve has no spring constant, or not both branches.
    """
    approach, retract, stiffness = curve.approach, curve.retract, curve.spring_constant
    if approach is None or retract is None or approach.force is None or retract.force is None or stiffness is None:
        raise InvalidValue(f"{curve.name}: .ibw needs approach, retraction and spring constant")
    travel = -np.concatenate([approach.z, retract.z])
    bend = np.concatenate([approach.force, retract.force]) / stiffness
    values = np.asfortranarray(np.column_stack([travel, bend, travel]), dtype="<f8")
    note = _note(curve, len(approach)).encode("utf-8")
    labels = b"".join(label.encode().ljust(_LABEL_SIZE, b"\0") for label in ("", *_LABELS))
    data = values.tobytes(order="F")
    wave = _wave_header(values.shape[0])
    header = _header(0, _WAVE.size + len(data), len(note), len(labels))
    words = np.frombuffer(header + wave, dtype="<i2")
    checksum = int(-int(words.sum(dtype=np.int64)) & 0xFFFF)
    signed = checksum - 0x10000 if checksum >= 0x8000 else checksum
    return _header(signed, _WAVE.size + len(data), len(note), len(labels)) + wave + data + note + labels


def _header(checksum: int, wave: int, note: int, labels: int) -> bytes:
    return _HEADER.pack(5, checksum, wave, 0, note, *[0] * 5, 0, labels, *[0] * 5)


def _wave_header(rows: int) -> bytes:
    shape = rows, len(_LABELS), 0, 0
    return _WAVE.pack(
        0, 0, 0, rows * len(_LABELS), _DOUBLE, 0, b"", 1, b"nanotouch", 0, 0, *shape, *[1.0] * 4, *[0.0] * 4, b"", b"",
        0, 0, 0.0, 0.0, *[0] * 10, *[0] * 16, *[0] * 3, 0, 0, 0, 0, 0, 0, 0, 0,
    )  # fmt: skip


def _note(curve: ForceCurve, turn: int) -> str:
    meta: dict[str, Any] = dict(curve.meta)
    made = datetime.now().astimezone()
    rate = meta.get("rate approach", np.nan)
    lines = {
        "Origin": "nanotouch",  # afmformats cannot read the first line
        "ImagingMode": "Contact",
        "NumPtsPerSec": rate,
        "InvOLS": meta.get("sensitivity", np.nan),
        "SpringConstant": curve.spring_constant,
        "TriggerChannel": "Force" if "setpoint" in meta else "None",
        "TriggerPoint": meta.get("setpoint", np.nan),
        "InputTime": meta.get("duration", np.nan),
        "ApproachVelocity": meta.get("speed approach", np.nan),
        "RetractVelocity": meta.get("speed retract", np.nan),
        "MicroscopeModel": meta.get("instrument", "unknown"),
        "Version": f"nanotouch {nanotouch.__version__}",
        "Date": meta.get("date", made.strftime("%Y-%m-%d")),
        "Time": meta.get("time", made.strftime("%H:%M:%S")),
        "Indexes": f"0,{turn - 1}",
    }
    return "".join(f"{key}: {value}\r" for key, value in lines.items())
