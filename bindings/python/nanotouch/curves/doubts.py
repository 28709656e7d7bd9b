# SPDX-License-Identifier: BSD-3-Clause
"""What the readings of a curve say against themselves: a detector at its end, a deflection or a height with the
wrong sign, a ramp that ended before it reached its trigger."""

from __future__ import annotations

import numpy as np

from .._arrays import Floats
from .curve import ForceCurve, Segment

_SAME = 1e-6  # of the range: readings that do not differ
_STANDING = 8  # points
_TRAVEL = 0.005  # of the base, over which a free or bent lever's reading changes
_STEPS = 50  # of the digitiser in the range; fewer make any reading stand still
_BESIDE = 0.05  # of the range, by which what lies about a dip's floor is higher
_ENDS = 0.05  # of a branch, at its deepest point
_INVERTED = 0.8  # of the range
_STEADY = 0.9  # correlation with the place
_REACHED = 0.5  # of the setpoint


def doubts(curve: ForceCurve) -> tuple[str, ...]:
    """In words; nothing where the curve is as it should be."""
    branches = [one for one in (curve.approach, curve.retract) if one is not None and len(one) >= 4 * _STANDING]
    notes = []
    for words in (_saturated(branches), _inverted(branches), _turned(branches), _untriggered(curve)):
        notes += [words] if words else []
    return tuple(notes)


def _readings(segment: Segment) -> Floats:
    found = segment.deflection if segment.force is None else segment.force
    assert found is not None
    return found


def _saturated(branches: list[Segment]) -> str:
    """Readings that stand still at their greatest or least while the base moves."""
    for segment in branches:
        values = _readings(segment)
        for sign, word in ((1.0, "largest"), (-1.0, "smallest")):
            run = _standing(sign * values)
            if run is None or _is_coarse(values):
                continue
            first, last = run
            moved = abs(float(segment.z[last] - segment.z[first]))
            inside = _is_bracketed(sign * values, first, last)
            if moved >= _TRAVEL * float(np.ptp(segment.z)) and (inside or (sign > 0.0 and _is_deep(segment, first))):
                return (
                    f"saturated: the {word} {last - first + 1} readings of the {segment.role} are equal while the "
                    f"base moves by {moved * 1e9:.3g} nm; the detector is at the end of its range, and forces there "
                    "are wrong"
                )
    return ""


def _is_coarse(values: Floats) -> bool:
    steps = np.diff(np.unique(values))
    steps = steps[steps > 0.0]
    spread = float(np.ptp(values))
    return not steps.size or spread <= 0.0 or float(np.median(steps)) * _STEPS > spread


def _standing(values: Floats) -> tuple[int, int] | None:
    """First and last of the longest run at the greatest value."""
    top = values >= values.max() - _SAME * float(np.ptp(values))
    edges = np.flatnonzero(np.diff(np.concatenate([[False], top, [False]]).astype(np.int8)))
    if not edges.size:
        return None
    starts, ends = edges[::2], edges[1::2] - 1
    longest = int(np.argmax(ends - starts))
    if ends[longest] - starts[longest] + 1 < _STANDING:
        return None
    return int(starts[longest]), int(ends[longest])


def _is_bracketed(values: Floats, first: int, last: int) -> bool:
    """Whether it falls on both sides of a run."""
    step = _BESIDE * float(np.ptp(values))
    before, after = values[:first], values[last + 1 :]
    return bool(before.size and after.size and min(before.min(), after.min()) < values[first] - step
                and before.min() < values[first] - step and after.min() < values[first] - step)  # fmt: skip


def _is_deep(segment: Segment, place: int) -> bool:
    """Whether a point lies in the nearer half of the travel."""
    return bool(segment.z[place] < segment.z.min() + 0.5 * float(np.ptp(segment.z)))


def _inverted(branches: list[Segment]) -> str:
    """Readings that fall steadily where the base goes in furthest, and never rise."""
    if not branches:
        return ""
    told = []
    for segment in branches:
        readings = _readings(segment)
        if readings[int(segment.z.argmin())] > 0.5 * float(readings.max() + readings.min()):
            return ""
        values = readings[np.argsort(segment.z, kind="stable")]
        far = float(np.median(values[values.size // 2 :]))
        spread = float(np.ptp(values))
        count = max(int(_ENDS * values.size), _STANDING)
        deep = values[:count]
        inside = far - float(deep.min()) > _INVERTED * spread and float(values.max()) - far < (1 - _INVERTED) * spread
        told.append(inside and float(np.ptp(deep)) > 0.02 * spread > 0.0 and _grows(deep))
    if not all(told):
        return ""
    return "the readings fall as the base goes in, to the end of both ways: the sign of the deflection looks inverted"


def _turned(branches: list[Segment]) -> str:
    """Readings that are flat where the base is near, and rise steadily to the far end of the travel."""
    if not branches:
        return ""
    for segment in branches:
        readings = _readings(segment)
        if readings[int(segment.z.argmax())] < 0.5 * float(readings.max() + readings.min()):
            return ""
        values = readings[np.argsort(segment.z, kind="stable")]
        count, spread = max(int(_ENDS * values.size), _STANDING), float(np.ptp(values))
        near, far = values[: values.size // 2], values[-count:]
        rises = float(far.max()) - float(np.median(near)) > _INVERTED * spread and float(np.ptp(far)) > 0.02 * spread
        if not (rises and float(np.ptp(near)) < (1 - _INVERTED) * spread and _grows(far)):
            return ""
    return "the readings rise as the base goes away, and are flat where it is near: its height looks reversed"


def _grows(values: Floats) -> bool:
    return float(np.corrcoef(np.arange(values.size), values)[0, 1]) > _STEADY


def _untriggered(curve: ForceCurve) -> str:
    setpoint, approach = curve.meta.get("setpoint"), curve.approach
    if not isinstance(setpoint, float) or not setpoint > 0.0 or approach is None or approach.force is None:
        return ""
    if len(approach) < 4 * _STANDING:
        return ""
    reached = float(approach.force.max() - np.median(approach.force[: len(approach) // 2]))
    if reached >= _REACHED * setpoint:
        return ""
    return (
        f"no trigger: the approach ends at {reached * 1e9:.3g} nN of the {setpoint * 1e9:.3g} nN at which it was to "
        "turn; it may not have touched"
    )
