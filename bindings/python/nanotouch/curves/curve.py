# SPDX-License-Identifier: BSD-3-Clause
"""A force curve as an ordered list of segments.

Signs as everywhere: z is the height of the cantilever's base and grows away from the sample, the deflection is positive
away from the sample, the force is positive where tip and sample repel. So z falls during the approach, and the tip is
at z + deflection.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from .._arrays import as_floats
from ..errors import InvalidValue

Role = Literal["approach", "pause", "retract"]
_CONTRADICTION = 0.2  # of the spring constant, in force over deflection: a baseline may be taken from one of them


@dataclass(frozen=True, eq=False)
class Segment:
    """One movement (or rest) of the base.

    Attributes
    ----------
    role : {"approach", "pause", "retract"}
        What the base does.
    time : ndarray, shape (n,)
        Time since the start of the curve [s]; NaN throughout where the file records none.
    z : ndarray, shape (n,)
        Height of the cantilever's base [m], growing away from the sample.
    z_channel : str
        The column z comes from, under afmformats' name: ``"height (measured)"`` or ``"height (piezo)"``.
    force : ndarray, shape (n,), or None
        Force on the tip [N], + repulsive; the offset of the detector is still in it. None without a spring constant.
    deflection : ndarray, shape (n,), or None
        Deflection of the cantilever [m], + away from the sample. None without a spring constant.
    """

    role: Role
    time: NDArray[np.float64]
    z: NDArray[np.float64]
    z_channel: str
    force: NDArray[np.float64] | None = None
    deflection: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        if self.role not in get_args(Role):
            raise InvalidValue(f"role: {self.role!r}, expected one of {', '.join(get_args(Role))}")
        if self.force is None and self.deflection is None:
            raise InvalidValue("segment: neither force nor deflection is given")
        for key in ("z", "time", "force", "deflection"):
            value = getattr(self, key)
            if value is None:
                continue
            array = as_floats(value, key).view()
            if array.ndim != 1 or array.size != len(self.z):
                raise InvalidValue(f"{key}: shape {array.shape}, expected that of z, ({len(self.z)},)")
            array.flags.writeable = False
            object.__setattr__(self, key, array)

    def __len__(self) -> int:
        return int(self.z.size)

    def __repr__(self) -> str:
        return f"Segment({self.role!r}, {len(self)} points, z from {self.z_channel!r})"


@dataclass(frozen=True, eq=False)
class ForceCurve:
    """One force-distance curve.

    Attributes
    ----------
    segments : tuple of Segment
        In the order of time.
    meta : mapping
        What the file says, under afmformats' keys in SI: ``"spring constant"`` [N/m], ``"sensitivity"`` [m/V],
        ``"setpoint"`` [N], ``"speed approach"`` [m/s], ``"instrument"``, ``"date"``, ``"enum"``, ...
    name : str
        The file's name without its folder.
    """

    segments: tuple[Segment, ...]
    meta: Mapping[str, Any] = field(default_factory=dict)
    name: str = ""

    def __post_init__(self) -> None:
        stiffness = self.spring_constant
        for segment in self.segments:
            found = _stiffness(segment)
            if found is None or not found:
                continue
            stiffness = found if stiffness is None else stiffness
            if not abs(found - stiffness) <= _CONTRADICTION * abs(stiffness):
                raise InvalidValue(
                    f"force, deflection: in the {segment.role} they differ by {found:.4g} N/m, but the spring constant "
                    f"is {stiffness:.4g} N/m; valid is up to {100 * _CONTRADICTION:g} % from it. Leave one of them out"
                )

    @property
    def approach(self) -> Segment | None:
        """The first approach, with what goes on in its direction after a pause; None if there is none."""
        return self._joined("approach", self.parts("approach"))

    @property
    def retract(self) -> Segment | None:
        """The last retraction, with what went before it in its direction; None if there is none."""
        return self._joined("retract", self.parts("retract"))

    def parts(self, role: Literal["approach", "retract"]) -> tuple[Segment, ...]:
        """The segments that make up the approach or the retraction: those between which the base only rests."""
        order = self.segments if role == "approach" else self.segments[::-1]
        found: list[Segment] = []
        for segment in order:
            if segment.role == role:
                found.append(segment)
            elif segment.role != "pause" and found:
                break
        return tuple(found if role == "approach" else found[::-1])

    def _joined(self, role: Role, parts: tuple[Segment, ...]) -> Segment | None:
        if len(parts) < 2:
            return parts[0] if parts else None
        columns = {
            key: None if any(getattr(one, key) is None for one in parts)
            else np.concatenate([getattr(one, key) for one in parts])
            for key in ("time", "z", "force", "deflection")
        }  # fmt: skip
        return Segment(role, z_channel=parts[0].z_channel, **columns)  # type: ignore[arg-type]

    @property
    def spring_constant(self) -> float | None:
        """k_c of the cantilever [N/m]; None if unknown."""
        value = self.meta.get("spring constant")
        return None if value is None else float(value)

    @property
    def tip_radius(self) -> float | None:
        """R of the tip [m]; None where the file states none."""
        value = self.meta.get("tip radius")
        return None if value is None else float(value)

    def __repr__(self) -> str:
        parts = ", ".join(f"{s.role} {len(s)}" for s in self.segments)
        return f"ForceCurve({self.name!r} #{self.meta.get('enum', 0)}: {parts})"


def _stiffness(segment: Segment) -> float | None:
    """Force over deflection [N/m], between their extremes; None where one of them is missing or does not change."""
    force, bent = segment.force, segment.deflection
    if force is None or bent is None or not bent.size:
        return None
    low, high = int(bent.argmin()), int(bent.argmax())
    span = float(bent[high] - bent[low])
    return float(force[high] - force[low]) / span if span > 0.0 else None
