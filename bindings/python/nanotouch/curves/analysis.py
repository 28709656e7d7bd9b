# SPDX-License-Identifier: BSD-3-Clause
"""What a force curve shows without any contact model: baseline, contact point, snap-in, pull-off, noise, slope.

The baseline is a robust line through the part of each branch where tip and sample are apart: first the far half of
its travel, then all of it beyond the event (snap-in or pull-off), so that the line is hardly extrapolated to where it
is needed. Tilt comes from light interference and drag, and differs between the branches.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidValue
from . import contact_point as methods
from .curve import ForceCurve, Segment

_FAR = 0.5  # part of the travel taken for the first baseline
_MARGIN = 0.05  # of the travel, kept between an event and the baseline that judges it
_EVENT = 5.0  # standard deviations of the noise: one in 2e6 points
_WAVE = 3.0  # standard deviations of the scatter about the line, where interference makes waves
_MAD = 1.4826  # standard deviation over median absolute deviation, for Gaussian noise
_TUKEY = 4.685  # 95 % efficiency on Gaussian noise
_BLOCKS = 10  # the residuals' correlation is judged from the scatter of this many block means


@dataclass(frozen=True)
class Baseline:
    """Force of the free cantilever, a line: ``force + slope (z - z_mean)``.

    Attributes
    ----------
    force : float
        Force at `z_mean` [N].
    slope : float
        Tilt [N/m].
    z_mean : float
        Mean z of the points it was fitted to [m].
    scatter : float
        Robust standard deviation of those points about the line, interference waves included [N].
    variance : tuple of float
        Variances of `force` [N^2] and `slope` [N^2/m^2], with the correlation of the residuals taken into account.
    """

    force: float
    slope: float
    z_mean: float
    scatter: float
    variance: tuple[float, float]

    def at(self, z: NDArray[np.float64]) -> NDArray[np.float64]:
        """The line at z [m], in N."""
        return self.force + self.slope * (z - self.z_mean)

    def sigma(self, z: float) -> float:
        """Standard uncertainty of the line at z [m], in N."""
        return float(np.sqrt(self.variance[0] + self.variance[1] * (z - self.z_mean) ** 2))


@dataclass(frozen=True)
class CurveReport:
    """What a curve shows; plain SI floats, NaN where the curve does not show it.

    Attributes
    ----------
    contact_point : float
        z of the base [m] on the approach, coming out of contact: the median of `contact_points`. Its sigma contains
        their standard deviation.
    contact_points : mapping
        By each of the methods of :mod:`nanotouch.curves.contact_point` that can say [m]; the first is where the force
        crosses the baseline (``"crossing"``, after a snap-in) or can no longer be told from it (``"deviation"``).
    snap_in_force, pull_off_force : float
        Depth below the baseline on the approach and on the retraction [N], positive; 0 where no dip is deeper than five
        times the noise and three times the scatter of the baseline.
    snap_in_z, pull_off_z : float
        z of the base there [m]; NaN where there is none.
    contact_slope : float
        -dF/dz in hard contact (upper half of the load) [N/m]: at most the spring constant, and equal to it on a sample
        that does not yield.
    contact_stiffness : float
        k = k_c s/(k_c - s) of the contact itself, with s the contact slope [N/m]; NaN where s is not below k_c.
    adhesion_work : float
        Area of the retraction below its baseline, over z of the base [J]; 0 without pull-off.
    baseline_tilt : float
        Slope of the approach's baseline (the retraction's where there is no approach) [N/m].
    noise : float
        Standard deviation of the force from point to point [N].
    baselines : mapping
        The :class:`Baseline` of ``"approach"`` and ``"retract"``, as far as there are such segments.
    sigma : mapping
        Standard uncertainties of ``contact_point``, ``snap_in_force``, ``pull_off_force``, ``contact_slope``,
        ``contact_stiffness``, ``adhesion_work``:
        statistical, without those of the spring constant and the sensitivity.
    notes : tuple of str
        What the reader should know before using the numbers.
    """

    contact_point: float
    snap_in_force: float
    snap_in_z: float
    pull_off_force: float
    pull_off_z: float
    contact_slope: float
    contact_stiffness: float
    adhesion_work: float
    baseline_tilt: float
    noise: float
    baselines: Mapping[str, Baseline]
    sigma: Mapping[str, float]
    contact_points: Mapping[str, float]
    notes: tuple[str, ...] = ()

    def __str__(self) -> str:
        return (
            f"pull-off {_in_nn(self.pull_off_force, self.sigma['pull_off_force'])}, "
            f"snap-in {_in_nn(self.snap_in_force, self.sigma['snap_in_force'])}, "
            f"contact slope {self.contact_slope:.3g} N/m, noise {self.noise * 1e12:.3g} pN"
            + "".join(f"; {note}" for note in self.notes)
        )


@dataclass(frozen=True, eq=False)
class _Branch:
    """An approach or a retraction with its baseline taken off."""

    z: NDArray[np.float64]
    force: NDArray[np.float64]
    baseline: Baseline
    noise: float

    @property
    def visible(self) -> float:
        """Smallest force that can be told from the baseline [N]."""
        return max(_EVENT * self.noise, _WAVE * self.baseline.scatter)

    def sigma(self, z: float) -> float:
        """Standard uncertainty of one force at z [N]."""
        return float(np.hypot(self.noise, self.baseline.sigma(z)))


def analyse(curve: ForceCurve, *, baseline: Literal["line", "constant"] = "line") -> CurveReport:
    """Find baseline, contact point, snap-in and pull-off of a curve.

    Parameters
    ----------
    curve : ForceCurve
        With force in its segments; an approach, a retraction or both.
    baseline : {"line", "constant"}
        ``"constant"`` takes the median of the far half and leaves the tilt in, as many published values do.

    Raises
    ------
    InvalidValue
        If it has no force (no spring constant), or neither approach nor retraction of at least 16 points.
    """
    if baseline not in ("line", "constant"):
        raise InvalidValue(f"baseline: {baseline!r}, expected 'line' or 'constant'")
    branches = {}
    for role, segment in (("approach", curve.approach), ("retract", curve.retract)):
        if segment is not None and len(segment) >= 16:
            branches[role] = _branch(segment, baseline, curve.name)
    if not branches:
        raise InvalidValue(f"{curve.name}: neither an approach nor a retraction of at least 16 points")
    dips = {role: _dip(branch) for role, branch in branches.items()}
    nothing = (np.nan, np.nan, np.nan)
    snap_in, snap_in_z, snap_in_sigma = dips.get("approach", nothing)
    pull_off, pull_off_z, pull_off_sigma = dips.get("retract", nothing)
    first = next(iter(branches))
    stiffness = curve.spring_constant
    contacts, contact_sigma = _contact_points(branches[first], stiffness, adhesive=dips[first][0] > 0)
    slope, slope_sigma = _contact_slope(branches[first])
    softening = 1.0 - slope / stiffness if stiffness is not None and slope < stiffness else np.nan
    work, work_sigma = _adhesion_work(branches["retract"], pull_off > 0) if "retract" in branches else (np.nan, np.nan)
    return CurveReport(
        contact_point=float(np.median(list(contacts.values()))) if contacts else np.nan,
        snap_in_force=snap_in,
        snap_in_z=snap_in_z,
        pull_off_force=pull_off,
        pull_off_z=pull_off_z,
        contact_slope=slope,
        contact_stiffness=slope / softening,
        adhesion_work=work,
        baseline_tilt=branches[first].baseline.slope,
        noise=float(np.mean([branch.noise for branch in branches.values()])),
        baselines={role: branch.baseline for role, branch in branches.items()},
        sigma={
            "contact_point": contact_sigma,
            "snap_in_force": snap_in_sigma,
            "pull_off_force": pull_off_sigma,
            "contact_slope": slope_sigma,
            "contact_stiffness": slope_sigma / softening**2,
            "adhesion_work": work_sigma,
        },
        contact_points=contacts,
        notes=_notes(curve),
    )


def sensitivity(curve: ForceCurve) -> tuple[float, float]:
    """Deflection sensitivity from a contact that does not yield, where the tip follows the base.

    Returns
    -------
    value, sigma : float
        What the sensitivity [m/V] would have to be for a contact slope equal to the spring constant, and its standard
        uncertainty: half the difference of approach and retraction (friction) where there are both.

    Raises
    ------
    InvalidValue
        If the curve states no sensitivity or spring constant, or shows no contact.
    """
    assumed, stiffness = curve.meta.get("sensitivity"), curve.spring_constant
    if assumed is None or stiffness is None:
        raise InvalidValue(f"{curve.name}: states no sensitivity or no spring constant; give it to curves.read")
    slopes = []
    for segment in (curve.approach, curve.retract):
        if segment is not None and len(segment) >= 16:
            slopes.append(_contact_slope(_branch(segment, "line", curve.name)))
    slopes = [(slope, sigma) for slope, sigma in slopes if slope > 0.0]
    if not slopes:
        raise InvalidValue(f"{curve.name}: shows no contact whose slope could be taken")
    found = np.array([float(assumed) * stiffness / slope for slope, _ in slopes])
    statistical = max(float(assumed) * stiffness * sigma / slope**2 for slope, sigma in slopes)
    return float(found.mean()), float(np.hypot(statistical, 0.5 * np.ptp(found)))


def _notes(curve: ForceCurve) -> tuple[str, ...]:
    return tuple(
        f"the file's {name} ({curve.meta[name]:g}) is a placeholder: give the calibrated one to curves.read"
        for name in curve.meta.get("placeholders", ())
    )


def force_gap(
    curve: ForceCurve, report: CurveReport, role: str = "retract"
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Tip-sample separation and force of a branch, free of the baseline and of the cantilever's bending.

    Returns
    -------
    gap : ndarray, shape (n,)
        z + deflection - contact point [m]: the distance of the tip from where it stands undeflected in contact,
        negative when pressed in.
    force : ndarray, shape (n,)
        Force above the baseline [N], + repulsive.
    """
    segment: Segment | None = {"approach": curve.approach, "retract": curve.retract}.get(role)
    if segment is None or segment.force is None or role not in report.baselines:
        raise InvalidValue(f"role: {curve.name} has no {role} with force")
    stiffness = curve.spring_constant
    if stiffness is None:
        raise InvalidValue(f"{curve.name}: no spring constant; give it to curves.read")
    force = segment.force - report.baselines[role].at(segment.z)
    return segment.z + force / stiffness - report.contact_point, force


def _branch(segment: Segment, baseline: str, name: str) -> _Branch:
    z, force = segment.z, segment.force
    if force is None:
        raise InvalidValue(f"{name}: no force without a spring constant; give it to curves.read")
    noise = _noise(force)
    line = _baseline_line(z, force, noise) if baseline == "line" else _baseline_constant(z, force)
    return _Branch(z, force - line.at(z), line, noise)


def _noise(force: NDArray[np.float64]) -> float:
    """Of white noise, from differences of neighbours, so that no shape of the curve enters."""
    return _MAD * float(np.median(np.abs(np.diff(force)))) / float(np.sqrt(2.0))


def _far(z: NDArray[np.float64]) -> NDArray[np.bool_]:
    return np.asarray(z >= z.max() - _FAR * np.ptp(z), dtype=bool)


def _baseline_constant(z: NDArray[np.float64], force: NDArray[np.float64]) -> Baseline:
    x, y = z[_far(z)], force[_far(z)]
    level = float(np.median(y))
    rest = y - level
    scatter = _MAD * float(np.median(np.abs(rest)))
    return Baseline(level, 0.0, float(x.mean()), scatter, (scatter**2 * _correlation(rest, scatter) / x.size, 0.0))


def _baseline_line(z: NDArray[np.float64], force: NDArray[np.float64], noise: float) -> Baseline:
    """A line through the far half, then through all beyond the outermost point that this line cannot explain."""
    line = _line(z, force, _far(z))
    off = np.abs(force - line.at(z))
    event = off > max(_EVENT * noise, _WAVE * line.scatter) + 0.1 * float(off.max())
    start = float(z[event].max(initial=-np.inf)) + _MARGIN * float(np.ptp(z))
    return _line(z, force, _far(z) | (z > start)) if np.isfinite(start) else line


def _line(z: NDArray[np.float64], force: NDArray[np.float64], part: NDArray[np.bool_]) -> Baseline:
    """Line by iterated least squares with Tukey's weights."""
    x, y = z[part], force[part]
    weight = np.ones(x.size)
    mean = slope = level = scatter = 0.0
    for _ in range(10):
        total = weight.sum()
        mean, level = float(weight @ x / total), float(weight @ y / total)
        spread = float(weight @ (x - mean) ** 2)
        slope = float(weight @ ((x - mean) * (y - level)) / spread) if spread > 0 else 0.0
        rest = y - level - slope * (x - mean)
        scatter = _MAD * float(np.median(np.abs(rest)))
        if scatter == 0.0:
            return Baseline(level, slope, mean, 0.0, (0.0, 0.0))
        weight = np.clip(1 - (rest / (_TUKEY * scatter)) ** 2, 0.0, None) ** 2
    worth = scatter**2 * _correlation(rest, scatter)
    return Baseline(level, slope, mean, scatter, (worth / x.size, worth / float(((x - mean) ** 2).sum())))


def _correlation(rest: NDArray[np.float64], scatter: float) -> float:
    """By how much the residuals' correlation raises the variance of their mean (1 for white noise)."""
    blocks = np.array_split(rest, _BLOCKS)
    if scatter == 0.0 or len(blocks[-1]) < 2:
        return 1.0
    return max(1.0, float(np.mean([block.mean() ** 2 for block in blocks])) * len(blocks[-1]) / scatter**2)


def _dip(branch: _Branch) -> tuple[float, float, float]:
    """Depth below the baseline [N], its z [m] and the depth's uncertainty [N]."""
    lowest = int(np.argmin(branch.force))
    depth, z = float(-branch.force[lowest]), float(branch.z[lowest])
    return (depth, z, branch.sigma(z)) if depth > branch.visible else (0.0, np.nan, branch.sigma(z))


def _contact_points(branch: _Branch, stiffness: float | None, adhesive: bool) -> tuple[dict[str, float], float]:
    """Coming out of the strongest contact, where the force is down to the baseline, and the uncertainty [m].

    Without adhesion the force leaves the baseline gradually: then it is the last point above what is visible.
    """
    order = np.argsort(branch.z, kind="stable")
    z, force = branch.z[order], branch.force[order]
    peak = int(np.argmax(force))
    level = 0.0 if adhesive else branch.visible
    below = np.flatnonzero(force[peak:] <= level)
    if force[peak] <= branch.visible or below.size == 0:
        return {}, np.nan
    after = peak + int(below[0])
    before = after - 1
    crossing = float(z[before] + (z[after] - z[before]) * (force[before] - level) / (force[before] - force[after]))
    reach = max(5, z.size // 100)
    near = slice(max(peak, after - reach), min(after + reach, z.size))
    steepness = abs(float(np.polyfit(z[near] - crossing, force[near], 1)[0]))
    outward = methods.Outward(z[peak:], force[peak:], after - peak, branch.visible, stiffness, adhesive)
    found = {"crossing" if adhesive else "deviation": crossing} | methods.others(outward)
    statistical = branch.sigma(crossing) / steepness if steepness > 0 else np.nan
    return found, float(np.hypot(statistical, np.std(list(found.values()))))


def _adhesion_work(branch: _Branch, adhesive: bool) -> tuple[float, float]:
    """Area below the baseline from where the force crosses it to its last visible dip, and its uncertainty [J]."""
    if not adhesive:
        return 0.0, np.nan
    order = np.argsort(branch.z, kind="stable")
    z, force = branch.z[order], branch.force[order]
    lowest = int(np.argmin(force))
    positive = np.flatnonzero(force[:lowest] >= 0.0)
    first = int(positive[-1]) + 1 if positive.size else 0
    back = lowest + np.flatnonzero(force[lowest:] < -branch.visible)
    part = slice(first, int(back[-1]) + 2)
    steps = np.diff(z[part])
    level = branch.baseline.sigma(float(z[lowest])) * float(np.ptp(z[part]))
    area = float(np.sum(-0.5 * (force[part][1:] + force[part][:-1]) * steps))
    return area, float(np.hypot(level, branch.noise * np.sqrt(float(steps @ steps))))


def _contact_slope(branch: _Branch) -> tuple[float, float]:
    """-dF/dz of the upper half of the load [N/m] and its uncertainty."""
    top = float(branch.force.max())
    part = branch.force > 0.5 * top
    if top <= branch.visible or np.count_nonzero(part) < 4:
        return np.nan, np.nan
    x, y = branch.z[part] - branch.z[part].mean(), branch.force[part]
    spread = float(x @ x)
    slope = float(x @ (y - y.mean())) / spread
    rest = y - y.mean() - slope * x
    return -slope, float(np.sqrt(rest @ rest / (x.size - 2) / spread))


def _in_nn(value: float, sigma: float) -> str:
    return f"({value * 1e9:.4g} +- {sigma * 1e9:.2g}) nN"
