# SPDX-License-Identifier: BSD-3-Clause
"""What is believed of a force curve; anything else is a damaged header or a wrong unit, and refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..errors import ReadError
from .curve import ForceCurve, Segment

Z_RANGE = (1e-10, 1e-3)  # travel of the base [m]
FORCE_LIMIT = 1e-2  # [N]
DEFLECTION_LIMIT = 1e-3  # [m]
DURATION_LIMIT = 1e5  # of a curve [s]
MIN_POINTS = 16  # per segment that is analysed
FEWEST = 2  # per curve that is read
MAX_POINTS = 1 << 26  # of all curves of a file


def check_curve(curve: ForceCurve, file: Path) -> None:
    """Refuse values that are not finite, a scale that no force curve has, and an approach that goes away."""
    number = curve.meta.get("enum", 0)
    where = f"{file}: curve {number}"
    for key in ("z", "force", "deflection"):
        arrays = [getattr(s, key) for s in curve.segments if getattr(s, key) is not None]
        bad = sum(int(np.count_nonzero(~np.isfinite(a))) for a in arrays)
        if bad:
            raise ReadError(f"{where}: {bad} of {sum(a.size for a in arrays)} values of {key} are not finite")
    points = sum(len(s) for s in curve.segments)
    if points < FEWEST:
        raise ReadError(f"{where} has {points} points, expected at least {FEWEST}")
    full = [s for s in curve.segments if len(s)]
    travel = max(float(s.z.max()) for s in full) - min(float(s.z.min()) for s in full)
    least = Z_RANGE[0] if points >= MIN_POINTS else 0.0  # a curve that was broken off may not have moved
    if not least <= travel <= Z_RANGE[1]:
        raise ReadError(f"{where}: the base travels {travel:.3g} m, expected {Z_RANGE[0]:g} .. {Z_RANGE[1]:g} m")
    hint = _hint(curve)
    for key, limit, unit in (("force", FORCE_LIMIT, "N"), ("deflection", DEFLECTION_LIMIT, "m")):
        largest = max((float(np.abs(getattr(s, key)).max()) for s in full if getattr(s, key) is not None), default=0.0)
        if not largest <= limit:
            raise ReadError(f"{where}: {key} of {largest:.3g} {unit}, expected up to {limit:g} {unit}{hint}")
    for segment in full:
        _check_time(segment, where)
        _check_direction(segment, where)


def _hint(curve: ForceCurve) -> str:
    left = curve.meta.get("placeholders", ())
    return f"; its {' and '.join(left)} is a placeholder, give it" if left else ""


def _check_time(segment: Segment, where: str) -> None:
    time = segment.time[np.isfinite(segment.time)]
    if time.size and not float(np.ptp(time)) <= DURATION_LIMIT:
        raise ReadError(f"{where}: the {segment.role} lasts {np.ptp(time):.3g} s, expected up to {DURATION_LIMIT:g} s")
    if np.any(np.diff(time) < 0.0):
        raise ReadError(f"{where}: time runs backwards during the {segment.role}")


def _check_direction(segment: Segment, where: str) -> None:
    rise = segment.z[-1] - segment.z[0]
    if (segment.role == "approach" and rise > 0) or (segment.role == "retract" and rise < 0):
        raise ReadError(
            f"{where}: the base moves {rise:+.3g} m during the {segment.role} "
            "(z away from the sample): the sign of its height is reversed"
        )
