# SPDX-License-Identifier: BSD-3-Clause
"""What a count of a NanoScope channel that is no height is worth: SurfaceTopography hands such channels over as counts.

``@2:Z scale: V [Sens. X] (a V/LSB) b V`` says that the range of the integers, 256^bytes, is b volts; ``@Sens. X: V c
MPa/V`` in the scanner's or the scan's list says what a volt is. Without a sensitivity the unit is that of b.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

_LIMIT = 1 << 20  # of the header [byte]
_SCALE = re.compile(
    r"V\s*(?:\[(?P<soft>[^\]]*)\])?\s*(?:\([^)]*(?:\([^)]*\)[^)]*)*\))?\s*(?P<number>\S+)\s*(?P<unit>.*)"
)
_SOFT = re.compile(r"V\s*(?P<number>\S+)\s*(?P<unit>.*)")


def scale_of(file: Path, meta: Mapping[str, Any]) -> tuple[float, str | None]:
    """Value of a count, and its unit; NaN where the header does not say it."""
    stated = _SCALE.fullmatch(str(meta.get("@4:z scale", meta.get("@2:z scale", ""))).strip())
    if stated is None:
        return float("nan"), None
    per_count = float(stated["number"]) / 256.0 ** int(meta.get("bytes/pixel", 2))
    unit = stated["unit"].strip() or None
    if not stated["soft"]:
        return per_count, unit
    with file.open("rb") as stream:
        header = stream.read(_LIMIT).decode("latin-1")
    line = re.search(rf"\\@{re.escape(stated['soft'])}: ([^\r\n]+)", header, re.IGNORECASE)
    soft = _SOFT.fullmatch(line[1].strip()) if line else None
    if soft is None:
        return float("nan"), None
    top, per, below = soft["unit"].strip().rpartition("/")
    if per and below.strip() not in (unit, "Arb", "log(Arb)"):
        return float("nan"), None
    return per_count * float(soft["number"]), (top.strip() if per else unit) or None
