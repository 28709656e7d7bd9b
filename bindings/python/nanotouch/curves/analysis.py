# SPDX-License-Identifier: BSD-3-Clause
"""What a force curve shows without any contact model: baseline, contact point, snap-in, pull-off, noise, slope."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..errors import InvalidValue
from .baseline import Kind, choice_of, fit_baseline
from .curve import ForceCurve, Segment
from .events import Branch, Rupture, arrays_of
from .report import CurveReport

_FEWEST = 16  # points of a branch
_NONE = np.empty(0), np.empty(0)
_UNKNOWN = (np.nan, np.nan, np.nan)
_DRAG = 15e-6  # N s/m: the most that the drag of a lever in water makes at its speed
_GAUSSIAN = 1.96
_BOUND = 3  # nt_curve_support: nothing of the retraction is free
_DOUBTFUL = 0.2  # part of the pull-off by which a constant baseline would change it


def analyse(curve: ForceCurve, *, baseline: Kind = "auto", drag: tuple[float, float] | None = None) -> CurveReport:
    """Find baseline, contact point, snap-in and pull-off of a curve.

    Parameters
    ----------
    curve : ForceCurve
        With force in its segments; an approach, a retraction or both.
    baseline : {"auto", "line", "wave", "constant"} or (float, float)
        What the free cantilever shows: a line, with a wave of interference where there is very strong evidence for
        one. ``"constant"`` takes the median of the far half and leaves the tilt in, as many published values do.

    drag : (float, float), optional
        Least and largest force by which drag puts the free retraction below the free approach [N]: 2 D of a lever that
        moves with +-v, from lever and medium or from curves at two speeds (value -+ two sigma). Two free branches alone
        cannot tell it from a tether that holds to the end. Default: 0 to 30 pN for each um/s, above what levers show
        in water (1.2 .. 8 pN each way); unknown where the file records no time.

    Raises
    ------
    InvalidValue
        If it has no force (no spring constant), or neither approach nor retraction of at least 16 points.
    """
    segments = {
        role: segment
        for role, segment in (("approach", curve.approach), ("retract", curve.retract))
        if segment is not None and len(segment) >= _FEWEST
    }
    if not segments:
        raise InvalidValue(f"{curve.name}: neither an approach nor a retraction of at least {_FEWEST} points")
    arrays = [arrays_of(segments[role], curve.name) if role in segments else _NONE for role in ("approach", "retract")]
    stiffness = curve.spring_constant
    read = _core.read_curve(
        *arrays, np.nan if stiffness is None else stiffness, drag or _drag_of(curve), choice_of(baseline)
    )
    branches = {role: Branch.found(read[role]) for role in segments}
    approach, retract = branches.get("approach"), branches.get("retract")
    snap_in, snap_in_z, snap_in_sigma = approach.dip if approach else _UNKNOWN
    pull_off, pull_off_z, pull_off_sigma = retract.dip if retract else _UNKNOWN
    first = next(iter(branches.values()))
    contact_point, contact_sigma = read["contact_point"]
    slope, slope_sigma = first.contact_slope
    softening = 1.0 - slope / stiffness if stiffness is not None and slope < stiffness else np.nan
    work, work_sigma = retract.adhesion_work if retract else _UNKNOWN[:2]
    return CurveReport(
        contact_point=contact_point,
        snap_in_force=snap_in,
        snap_in_z=snap_in_z,
        pull_off_force=pull_off,
        pull_off_z=pull_off_z,
        contact_slope=slope,
        contact_stiffness=slope / softening,
        adhesion_work=work,
        baseline_tilt=first.baseline.slope,
        noise=float(np.mean([branch.noise for branch in branches.values()])),
        branches=branches,
        sigma={
            "contact_point": contact_sigma,
            "snap_in_force": snap_in_sigma,
            "pull_off_force": pull_off_sigma,
            "contact_slope": slope_sigma,
            "contact_stiffness": slope_sigma / softening**2,
            "adhesion_work": work_sigma,
        },
        contact_points=read["contact_points"],
        pull_off_interval=_interval(*read["pull_off"]),
        ruptures=tuple(Rupture(*row) for row in read["ruptures"]),
        notes=(*_notes(curve, approach, retract), *_interval_notes(read, pull_off)),
    )


def sensitivity(curve: ForceCurve) -> tuple[float, float]:
    """Deflection sensitivity from a contact that does not deform, where the tip follows the base.

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
        if segment is not None and len(segment) >= _FEWEST:
            slopes.append(Branch.of(segment, "auto", curve.name).contact_slope)
    slopes = [(slope, sigma) for slope, sigma in slopes if slope > 0.0]
    if not slopes:
        raise InvalidValue(f"{curve.name}: shows no contact whose slope could be taken")
    found = np.array([float(assumed) * stiffness / slope for slope, _ in slopes])
    statistical = max(float(assumed) * stiffness * sigma / slope**2 for slope, sigma in slopes)
    return float(found.mean()), float(np.hypot(statistical, 0.5 * np.ptp(found)))


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
        raise InvalidValue(f"{curve.name}: no spring constant; give it to curves.read, or --spring-constant")
    force = segment.force - report.baselines[role].at(segment.z)
    return segment.z + force / stiffness - report.contact_point, force


def _drag_of(curve: ForceCurve) -> tuple[float, float]:
    """Bounds of twice the drag, by the speed of the retraction [N]; the second 0 where that is unknown."""
    segment = curve.retract
    if segment is None or len(segment) < _FEWEST:
        return 0.0, 0.0
    duration = float(np.ptp(segment.time))
    return 0.0, 2.0 * _DRAG * float(np.ptp(segment.z)) / duration if duration > 0.0 else 0.0


def _interval(least: float, most: float, sigma: float) -> tuple[float, float]:
    """95 %, of all depths between the least and the most [N]."""
    return max(least - _GAUSSIAN * sigma, 0.0), most + _GAUSSIAN * sigma


def _interval_notes(read: Mapping[str, Any], depth: float) -> list[str]:
    """Why the pull-off is an interval, where it is a wide one about the depth [N]."""
    least, most, _ = read["pull_off"]
    offset, sigma = read["offset"]
    between = f"the pull-off is {least * 1e9:.3g} to {most * 1e9:.3g} nN"
    notes = []
    ringing = read["ringing"]
    if ringing > 0.0:
        notes.append(
            f"the force swings to both sides of the free level after the turn, by {ringing * 1e9:.3g} nN at the lowest "
            f"point, as a lever that rings does: {between}"
        )
    least, most = least + ringing, most - ringing
    if read["support"] == _BOUND:
        notes.append(
            f"the retraction ends {offset * 1e9:.3g} nN below the approach, more than drag explains: nothing of it is "
            f"free, or a film or a step offsets it; below the approach {between}"
        )
    elif most - depth > 5.0 * sigma and most > 1.2 * depth:
        notes.append(
            f"the retraction ends {abs(offset) * 1e9:.3g} nN {'below' if offset > 0.0 else 'above'} the approach: a "
            f"tether that holds to the end and drag or an offset look the same, so {between}"
        )
    elif depth - least > max(5.0 * sigma, _DOUBTFUL * depth):
        notes.append(
            f"the approach repels where the retraction is held, as a squeeze film under the lever does, or the force "
            f"declines before it tears, as drift makes it: {between}"
        )
    return notes


def _notes(curve: ForceCurve, approach: Branch | None, retract: Branch | None) -> tuple[str, ...]:
    notes = [
        f"the file's {name} ({curve.meta[name]:g}) is a placeholder: give the calibrated one to curves.read"
        for name in curve.meta.get("placeholders", ())
    ]
    notes += curve.meta.get("notes", ())
    if approach is not None and approach.baseline.bend is not None:
        notes.append(_bend_note(approach, retract is not None and retract.baseline.bend is not None))
    if retract is not None:
        notes += _baseline_notes(retract, curve.retract)
    return tuple(notes)


def _bend_note(approach: Branch, both: bool) -> str:
    """What was taken off the approach besides a line, where its free part shows it; `both`: off the retraction too."""
    baseline = approach.baseline
    bend = baseline.bend
    assert bend is not None
    parts = []
    if bend.film:
        parts.append(f"a squeeze film of {1e12 * bend.film / (bend.nearest - bend.pole):.3g} pN at the contact")
    if bend.bow:
        middle = 0.25 * float(approach.z[-1] - baseline.z_mean) ** 2
        parts.append(f"a bow of the baseline of {1e12 * abs(bend.bow) * middle:.2g} pN over half of its travel")
    told = f"{' and '.join(parts)} {'are' if len(parts) > 1 else 'is'} taken off the approach"
    told += ", the bow off the retraction too" * both
    return told + "; in contact the film is not measured: its force there counts as unknown" * bool(bend.film)


def _baseline_notes(retract: Branch, segment: Segment | None) -> list[str]:
    """Where the pull-off depends on what is taken as the baseline, say by how much."""
    notes = []
    wave = retract.baseline.wave
    if wave is not None:
        notes.append(
            f"interference of {wave.amplitude * 1e9:.2g} nN with a period of {wave.period * 1e9:.3g} nm is taken off"
        )
    if segment is None or segment.force is None or retract.baseline.slope == 0.0:
        return notes
    constant = fit_baseline(segment.z, segment.force, "constant")
    other = float(np.max(constant.at(segment.z) - segment.force))
    depth, _, sigma = retract.dip
    if other > 5.0 * retract.noise and abs(other - depth) > max(3.0 * sigma, _DOUBTFUL * depth):
        notes.append(
            f"the baseline is not level: over it the pull-off is {depth * 1e9:.3g} nN, over the constant level of its "
            f"far half (baseline='constant') it would be {other * 1e9:.3g} nN"
        )
    return notes
