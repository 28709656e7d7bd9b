# SPDX-License-Identifier: BSD-3-Clause
"""What a force curve shows without any contact model: baseline, contact point, snap-in, pull-off, noise, slope."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidValue
from . import contact_point as methods
from .baseline import Kind, fit_baseline
from .curve import ForceCurve, Segment
from .events import Branch
from .report import CurveReport

_FEWEST = 16  # points of a branch
_DOUBTFUL = 0.2  # part of the pull-off by which a constant baseline would change it


def analyse(curve: ForceCurve, *, baseline: Kind = "auto") -> CurveReport:
    """Find baseline, contact point, snap-in and pull-off of a curve.

    Parameters
    ----------
    curve : ForceCurve
        With force in its segments; an approach, a retraction or both.
    baseline : {"auto", "line", "wave", "constant"} or (float, float)
        What the free cantilever shows: a line, with a wave of interference where there is very strong evidence for
        one. ``"constant"`` takes the median of the far half and leaves the tilt in, as many published values do.

    Raises
    ------
    InvalidValue
        If it has no force (no spring constant), or neither approach nor retraction of at least 16 points.
    """
    branches = {}
    for role, segment in (("approach", curve.approach), ("retract", curve.retract)):
        if segment is not None and len(segment) >= _FEWEST:
            branches[role] = Branch.of(segment, baseline, curve.name)
    if not branches:
        raise InvalidValue(f"{curve.name}: neither an approach nor a retraction of at least {_FEWEST} points")
    nothing = (np.nan, np.nan, np.nan)
    approach, retract = branches.get("approach"), branches.get("retract")
    snap_in, snap_in_z, snap_in_sigma = approach.dip() if approach else nothing
    pull_off, pull_off_z, pull_off_sigma = retract.dip() if retract else nothing
    first = next(iter(branches.values()))
    stiffness = curve.spring_constant
    contacts, contact_sigma = _contact_points(first, stiffness)
    slope, slope_sigma = first.contact_slope()
    softening = 1.0 - slope / stiffness if stiffness is not None and slope < stiffness else np.nan
    work, work_sigma = retract.adhesion_work() if retract else (np.nan, np.nan)
    return CurveReport(
        contact_point=float(np.median(list(contacts.values()))) if contacts else np.nan,
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
        contact_points=contacts,
        notes=_notes(curve, retract),
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
        if segment is not None and len(segment) >= _FEWEST:
            slopes.append(Branch.of(segment, "auto", curve.name).contact_slope())
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
        raise InvalidValue(f"{curve.name}: no spring constant; give it to curves.read")
    force = segment.force - report.baselines[role].at(segment.z)
    return segment.z + force / stiffness - report.contact_point, force


def _contact_points(branch: Branch, stiffness: float | None) -> tuple[dict[str, float], float]:
    """Coming out of the strongest contact, where the force is down to the baseline, and the uncertainty [m].

    Without adhesion the force leaves the baseline gradually: then it is the last point above what is visible.
    """
    z, force, adhesive = branch.z, branch.force, branch.dips
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


def _notes(curve: ForceCurve, retract: Branch | None) -> tuple[str, ...]:
    notes = [
        f"the file's {name} ({curve.meta[name]:g}) is a placeholder: give the calibrated one to curves.read"
        for name in curve.meta.get("placeholders", ())
    ]
    notes += curve.meta.get("notes", ())
    if retract is not None:
        notes += _baseline_notes(retract, curve.retract)
    return tuple(notes)


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
    depth, _, sigma = retract.dip()
    if other > 5.0 * retract.noise and abs(other - depth) > max(3.0 * sigma, _DOUBTFUL * depth):
        notes.append(
            f"the baseline is not level: over it the pull-off is {depth * 1e9:.3g} nN, over the constant level of its "
            f"far half (baseline='constant') it would be {other * 1e9:.3g} nN"
        )
    return notes
