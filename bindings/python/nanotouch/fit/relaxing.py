# SPDX-License-Identifier: BSD-3-Clause
"""Whether a curve shows a sample that relaxes: what an elastic law then finds is no modulus of it.

Approach and retraction of an elastic sample without adhesion lie on each other. Where they do not, whole curve and
approach are fitted by Ting's law on a power law, and the exponent decides.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nanotouch.curves import CurveReport, ForceCurve
from nanotouch.errors import Error

from .models import extension
from .over_time import OVER_TIME, TIPS
from .show import with_sigma
from .solving import AboutTime, Setup
from .ting import Law, noise_of, report_of, solve, track_of

LOOP = 0.03  # of the work of the approach, from where the branches differ
CERTAIN = 5.0  # standard deviations of that, and three of the exponent
EXPONENT = 0.03  # below, E changes by less than 7 % over a decade of time
_SIGMAS = 3.0
_NEAR = 3.0  # residual over the noise, or
_SMALL = 0.01  # over the peak, up to which a law describes a curve


def loop_of(report: CurveReport) -> tuple[float, float]:
    """Work that the retraction does not give back, over that of the approach in contact; its standard uncertainty."""
    approach, retract = report.branches["approach"], report.branches["retract"]
    inside = approach.z < report.contact_point
    if np.count_nonzero(inside) < 8:
        return 0.0, np.inf
    z, force = approach.z[inside], approach.force[inside]
    back = np.interp(z, retract.z, retract.force)
    work = float(np.trapezoid(force, z))
    if not work > 0.0:
        return 0.0, np.inf
    level = sum(report.baselines[role].variance[0] for role in ("approach", "retract"))
    sigma = np.sqrt(level + 2.0 * report.noise**2 / z.size) * np.ptp(z)
    return (work - float(np.trapezoid(back, z))) / work, float(sigma) / work


def relaxing(curve: ForceCurve, report: CurveReport, setup: Setup) -> AboutTime | None:
    """What the loop between the branches says; None where adhesion would make one, and where there are no two."""
    report = report_of(curve, report)
    if not {"approach", "retract"} <= report.branches.keys() or report.snap_in_force > 0.0:
        return None
    name = _like(setup)
    paused = any(part.role == "pause" and len(part) > 1 for part in curve.segments)
    adheres = report.branches["retract"].dips
    if name is None or (adheres and not paused):
        return None
    loop, sigma = loop_of(report)
    if abs(loop) < LOOP and sigma < LOOP:
        return AboutTime(
            False,
            f"approach and retraction enclose {100 * abs(loop):.1f} % of the work: what does not fit is no relaxation "
            "of the sample (a layer, the tip's shape or the calibration may be wrong)",
            "",
        )
    if not (loop > LOOP and loop > CERTAIN * sigma):
        return None
    thickness, noise = setup.held.get("thickness", 0.0), noise_of(report)
    law = Law(OVER_TIME[name], setup.radius, setup.half_angle, thickness, setup.spring_constant, noise)
    for approach_only in (False, True):
        exponent = _exponent(curve, report, law, approach_only)
        if exponent is not None:
            of = "the approach" if approach_only else "the approach with its pauses" if adheres else "the whole curve"
            verb = "relaxes or yields" if approach_only else "relaxes"  # the retraction follows from no power law
            beta = f"beta = {with_sigma(*exponent, '')}"
            return AboutTime(
                True,
                f"the sample {verb}: the retraction gives back {100 * (1 - loop):.0f} % of the work, and {of} asks "
                f"for a modulus that falls with time as t^-beta, {beta}; what an elastic law finds is that of "
                f"this speed and no property of the sample: fit {name}",
                f"the sample {verb}, {beta}: fit {name}",
            )
    return None


def _like(setup: Setup) -> str | None:
    """The model over time of the same tip."""
    model, layer = setup.model, setup.held.get("thickness", 0.0) > 0.0
    if model.force is not None:
        return None
    for tip in TIPS:
        if (tip.shape, tip.sides) == (model.tip, model.sides) and (not layer or tip.shape in ("paraboloid", "cone")):
            return f"ting_power{tip.ending}"
    return None


def _exponent(curve: ForceCurve, report: CurveReport, law: Law, approach_only: bool) -> tuple[float, float] | None:
    """Of a power law that describes the curve and surely relaxes, with its sigma."""
    try:
        track, each = track_of(curve, report, approach_only=approach_only, window=None).thinned()
        found = solve(extension(), replace(law, noise=law.noise / each**0.5), track)
    except Error:  # no times, or none that this law comes near
        return None
    place = found.free.index("exponent")
    value, sigma = found.values["exponent"], float(np.sqrt(found.covariance[place, place]))
    rms = float(np.hypot(found.rms(track), law.noise * (1.0 - 1.0 / each) ** 0.5))
    describes = rms < _NEAR * law.noise or rms < _SMALL * float(found.raw["peak"])
    sure = value - _SIGMAS * sigma > EXPONENT and bool(found.raw["converged"])
    return (value, sigma) if describes and sure else None
