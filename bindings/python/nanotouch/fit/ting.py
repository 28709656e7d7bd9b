# SPDX-License-Identifier: BSD-3-Clause
"""Fit a viscoelastic contact to a whole curve: approach, pauses and retraction at once (Lee and Radok; Ting)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from nanotouch.contact.geometry import KINDS
from nanotouch.curves import CurveReport, ForceCurve, analyse
from nanotouch.curves.flicker import point_noise
from nanotouch.errors import InvalidValue
from nanotouch.rheology import number_of

from .models import INCOMPRESSIBLE, Floats, Model
from .over_time import ROWS
from .points import Window
from .uncertainties import Uncertainties
from .unified import unified_interval

_FEWEST = 16
_STEP = 0.1  # standard uncertainties, for the derivatives of the result by what is calibrated
_GAUSSIAN = 1.959963984540054
_LOGARITHM = 300.0
EXACT_EXPONENT = 0.1  # standard uncertainty up to which an exponent is known
NEAR = 0.5  # relative, of positive parameters
BACKGROUND = ("contact_point", "force_offset", "force_tilt", "drag")
UNITS = {"contact_point": "m", "force_offset": "N", "force_tilt": "N/m", "drag": "N s/m"}
DRAG_HEIGHT = "drag_height"
SMALLEST_NOISE = 1e-15  # N
_ROUNDED = 1e-6  # of a step of time: none
_GAP, _STEPS = 0.05, 10.0  # of the time that is recorded, and of its steps


@dataclass(frozen=True, eq=False)
class Track:
    """A curve in the order of time: what the C library takes.

    Attributes
    ----------
    time, position, force : ndarray, shape (n,)
        [s]; of the base towards the sample [m]; with the approach's baseline taken off [N].
    fitted : ndarray of bool, shape (n,)
        Points whose force is fitted; the others are on the path alone.
    starts : list of int
        First point of each segment.
    drift : float
        Of the force, that was taken off and is worth a note [N/s].
    gap : float
        Time before the retraction in which nothing is recorded [s]; then the retraction is not fitted.
    """

    time: Floats
    position: Floats
    force: Floats
    fitted: NDArray[np.bool_]
    starts: list[int]
    drift: float = 0.0
    gap: float = 0.0

    def path(self, extension: ModuleType, factor: float = 1.0) -> Any:
        """For the C library, forces multiplied by a factor."""
        return extension.Path(self.time, self.position, self.force * factor, self.fitted.astype(np.uint8), self.starts)

    def thinned(self, most: int = 2000) -> tuple[Track, int]:
        """Means of so many points each that hardly more than `most` are left, and how many: for a comparison of laws,
        whose time goes with the points. Ends of segments stay on the path, since they are where the base turns."""
        each = -(-self.time.size // most)
        if each < 2:
            return self, 1
        columns: list[list[Floats]] = [[], [], [], []]
        starts, count = [], 0
        for first, end in zip(self.starts, [*self.starts[1:], self.time.size], strict=True):
            blocks = slice(first, first + (end - first) // each * each)
            for place, column in enumerate((self.time, self.position, self.force, self.fitted.astype(float))):
                means = column[blocks].reshape(-1, each).mean(axis=1)
                ends = (
                    (0.0, 0.0) if place == 3 else _ends(means) if len(means) > 1 else (column[first], column[end - 1])
                )
                columns[place].append(np.concatenate([ends[:1], means, ends[1:]]))
            starts.append(count)
            count += columns[0][-1].size
        time, position, force, fitted = (np.concatenate(column) for column in columns)
        step = np.diff(time, prepend=-np.inf)
        kept = step > _ROUNDED * float(np.median(step))  # ends of two segments meet, and one point has but one end
        starts = [int(np.count_nonzero(kept[:start])) for start in starts]
        return replace(self, time=time[kept], position=position[kept], force=force[kept], fitted=fitted[kept] > 0.999,
                       starts=starts), each  # fmt: skip


@dataclass(frozen=True)
class Law:
    """Model, tip, lever and what is held; SI, positions towards the sample."""

    model: Model
    radius: float
    half_angle: float
    thickness: float
    spring_constant: float
    noise: float
    held: Mapping[str, float] = field(default_factory=dict)
    drag_height: float = 0.0
    start: Mapping[str, float] = field(default_factory=dict)

    @property
    def inner_ratio(self) -> float:
        """Poisson's ratio with which E* is turned into a modulus: any, but a layer's is fixed."""
        return INCOMPRESSIBLE if self.thickness > 0.0 else 0.0

    def places(self, extension: ModuleType) -> dict[str, int]:
        """Place of each parameter in the C library."""
        first = extension.path_background
        own = {parameter.name: place for place, parameter in enumerate(self.model.parameters)}
        return own | {name: first + i for i, name in enumerate(BACKGROUND)}

    def check_names(self, extension: ModuleType) -> None:
        """Raise InvalidValue for a parameter that is held and that the model does not have."""
        valid = self.places(extension)
        for name, value in self.held.items():
            if name not in valid:
                raise InvalidValue(f"parameter {name!r}: valid are {', '.join((*valid, DRAG_HEIGHT))}")
            low, high = {one.name: (one.minimum, one.maximum) for one in self.model.parameters}.get(name, (-1.0, 1.0))
            if not low <= value <= high:
                raise InvalidValue(f"{name} {value:g}: valid is {low:g} to {high:g}")

    def scale(self, name: str) -> float:
        """What a value of the C library is multiplied by."""
        return 1.0 / (1.0 - self.inner_ratio**2) if "modulus" in name else 1.0

    def options(self, extension: ModuleType) -> Any:
        """For the C library."""
        row = ROWS[self.model.kernel]
        shape = (KINDS.index(self.model.tip), self.model.sides or 0, self.radius, self.half_angle)
        options = extension.PathOptions(shape, number_of(row.kernel), max(row.arms, 1))
        options.poisson_ratio, options.thickness = self.inner_ratio, self.thickness
        options.spring_constant, options.noise = self.spring_constant, self.noise
        options.drag_height = self.drag_height
        for name, place in self.places(extension).items():
            if name in self.held:
                options.hold(place, self.held[name] / self.scale(name))
            elif name in self.start:
                options.start(place, self.start[name] / self.scale(name))
        return options


def _ends(means: Floats) -> tuple[float, float]:
    """Half a block before the first mean and after the last: single points jitter."""
    first, last = 0.5 * (means[1] - means[0]), 0.5 * (means[-1] - means[-2])
    return float(means[0] - first), float(means[-1] + last)


def parameters_of(model: Model) -> dict[str, tuple[int, str]]:
    """Number and unit of each parameter of a model."""
    units = {one.name: one.unit for one in model.parameters} | {name: UNITS[name] for name in BACKGROUND}
    return {name: (number, unit) for number, (name, unit) in enumerate(units.items())}


class Found(NamedTuple):
    """What the C library found: by name, E* in place of a modulus."""

    values: dict[str, float]
    covariance: Floats
    free: tuple[str, ...]
    raw: dict[str, Any]
    fitted: Floats
    indentation: Floats

    def rms(self, track: Track) -> float:
        """Of the residuals of the points that were fitted [N]."""
        return float(np.sqrt(np.mean((track.force - self.fitted)[track.fitted] ** 2)))


def report_of(curve: ForceCurve, report: CurveReport) -> CurveReport:
    """Of the first movement and the last, where pauses interrupt the approach: the force that relaxes in them would
    look like a bent baseline."""
    parts = curve.parts("approach")
    if len(parts) < 2 or len(parts[0]) < _FEWEST:
        return report
    ends = [part for part in (parts[0], *curve.parts("retract")[-1:]) if len(part) >= _FEWEST]
    return analyse(ForceCurve(tuple(ends), curve.meta, curve.name))


def track_of(
    curve: ForceCurve, report: CurveReport, *, approach_only: bool, window: Window | None, dips: bool = False
) -> Track:
    """All segments of a curve; InvalidValue where it has no times. A retraction that adheres is on the path alone, or
    with `dips` fitted, too."""
    if "approach" not in report.baselines:
        raise InvalidValue(f"{curve.name}: no approach; a fit over time begins where the sample was untouched")
    baseline = report.baselines["approach"]
    parts = _segments(curve, approach_only)
    time = np.concatenate([part.time for part in parts])
    if not np.isfinite(time).all():
        raise InvalidValue(f"{curve.name}: the file records no times; a fit over time needs those of every point")
    z = np.concatenate([part.z for part in parts])
    force = np.concatenate([np.asarray(part.force) for part in parts]) - baseline.at(z)
    number = np.concatenate([np.full(len(part), i) for i, part in enumerate(parts)])
    kept = np.concatenate([[True], time[1:] > np.maximum.accumulate(time)[:-1]])  # files repeat the point of a turn
    if np.count_nonzero(kept) < max(_FEWEST, 0.9 * time.size):
        raise InvalidValue(f"{curve.name}: its times do not increase")
    fitted = np.ones(time.size, dtype=bool)
    roles = np.array([part.role for part in parts])[number]
    gap = _gap(time, roles)
    if (adheres(report) and not dips) or gap > 0.0:
        fitted &= roles != "retract"
    if window is not None:
        fitted &= (force >= window[0]) & (force <= window[1])
    time, z, force, number, fitted = (values[kept] for values in (time, z, force, number, fitted))
    if np.count_nonzero(fitted) < _FEWEST:
        raise InvalidValue(f"{curve.name}: {np.count_nonzero(fitted)} points are left to fit; at least {_FEWEST}")
    starts = [int(i) for i in np.flatnonzero(np.diff(number, prepend=-1))]
    return Track(time, -z, force, fitted, starts, gap=gap)


def adheres(report: CurveReport) -> bool:
    """Whether the retraction surely goes below the free level: what flows returns to it from below the approach."""
    return "retract" in report.branches and report.branches["retract"].dips and report.pull_off_interval[0] > 0.0


def _gap(time: Floats, roles: NDArray[np.str_]) -> float:
    """Time before the retraction in which nothing is recorded [s]; 0 where that is short."""
    first = np.flatnonzero(roles == "retract")
    if not first.size or first[0] == 0:
        return 0.0
    gap = float(time[first[0]] - time[first[0] - 1])
    return gap if gap > max(_GAP * float(time[-1] - time[0] - gap), _STEPS * float(np.median(np.diff(time)))) else 0.0


def noise_of(report: CurveReport) -> float:
    """Of the force from point to point, of the free approach: in contact its slope would be in it [N]."""
    if "approach" not in report.branches:
        return report.noise
    branch, baseline = report.branches["approach"], report.baselines["approach"]
    free = branch.force[branch.z >= baseline.nearest]
    return max(point_noise(free) if free.size >= _FEWEST else report.noise, SMALLEST_NOISE)


def _segments(curve: ForceCurve, approach_only: bool) -> list[Any]:
    """From the first approach on, in the order of time."""
    parts = [part for part in curve.segments if part.force is not None and len(part) > 0]
    first = next((i for i, part in enumerate(parts) if part.role == "approach"), len(parts))
    parts = parts[first:]
    last = next((i for i, part in enumerate(parts) if part.role != "approach"), len(parts))
    return parts[:last] if approach_only else parts


def solve(extension: ModuleType, law: Law, track: Track, factor: float = 1.0) -> Found:
    """One fit; forces multiplied by a factor."""
    raw, fitted, indentation = extension.run_path(law.options(extension), track.path(extension, factor))
    places = law.places(extension)
    values = {name: float(raw["value"][place]) * law.scale(name) for name, place in places.items()}
    free = tuple(name for name, place in places.items() if not raw["held"] >> place & 1)
    scale = np.array([law.scale(name) for name in free])
    order = [places[name] for name in free]
    covariance = raw["covariance"][np.ix_(order, order)] * np.outer(scale, scale)
    return Found(values, covariance, free, raw, fitted, indentation)


def shifts(extension: ModuleType, law: Law, track: Track, known: Uncertainties, found: Found) -> dict[str, Floats]:
    """By what all free parameters move with one standard uncertainty of each calibration."""
    near = replace(law, start={name: found.values[name] for name in found.free})
    sharp, layer = law.model.sides is not None, law.thickness > 0.0
    changed: dict[str, tuple[Law, float]] = {}
    if known.sensitivity > 0.0:
        changed["sensitivity"] = near, 1.0 + _STEP * known.sensitivity
    if known.spring_constant > 0.0:
        factor = 1.0 + _STEP * known.spring_constant
        changed["spring_constant"] = replace(near, spring_constant=law.spring_constant * factor), factor
    if known.radius > 0.0 and not sharp:
        changed["radius"] = replace(near, radius=law.radius * (1.0 + _STEP * known.radius)), 1.0
    if known.half_angle > 0.0 and sharp:
        changed["half_angle"] = replace(near, half_angle=law.half_angle + _STEP * known.half_angle), 1.0
    if known.thickness > 0.0 and layer:
        changed["thickness"] = replace(near, thickness=law.thickness * (1.0 + _STEP * known.thickness)), 1.0
    first = np.array([found.values[name] for name in found.free])
    return {
        name: (_values(solve(extension, other, track, factor), found.free) - first) / _STEP
        for name, (other, factor) in changed.items()
    }


def _values(found: Found, names: tuple[str, ...]) -> Floats:
    return np.array([found.values[name] for name in names])


def interval_of(name: str, value: float, sigma: float, unbounded: float) -> tuple[float, float]:
    """95 %: of positive parameters symmetric in the logarithm; of an exponent that cannot fall below 0 the unified
    one of Feldman and Cousins, from where it would lie without that bound."""
    if name == "exponent" and sigma > 0.0:
        return unified_interval(unbounded, sigma)
    if ("modulus" in name or "time" in name) and value > 0.0:
        factor = float(np.exp(min(_GAUSSIAN * sigma / value, _LOGARITHM)))
        return value / factor, value * factor
    return value - _GAUSSIAN * sigma, value + _GAUSSIAN * sigma
