# SPDX-License-Identifier: BSD-3-Clause
"""A model fitted to two arrays, where there is no curve to be analysed: see :func:`fit_points`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from nanotouch._arrays import Floats, as_floats
from nanotouch.errors import InvalidValue

from .contact_part import Contact, contact_of
from .fitting import ASSUMED_HALF_ANGLE, ASSUMED_RADIUS
from .models import Model, extension, find, is_sharp, layer_of
from .result import Status
from .solving import Setup, solve
from .uncertainties import Uncertainties

_MISFIT = 1.6  # residual over the noise stated, where the fit itself has taken the larger one
_LEAST, _PART = 50, 4  # points of a way, and of its parts in which it is compared with the other one
_SURELY = 6.0  # standard errors between them
_EXACT = 1e-6  # of all forces: two computed curves that are one


@dataclass(frozen=True, eq=False)
class PointsFit:
    """What a fit of two arrays found; SI.

    Attributes
    ----------
    values, sigma, identifiable : mapping
        By parameter, as of :class:`FitResult`; sigma is statistical.
    residual_rms, residual_noise : float
        Of the force [N]; the noise of the residuals from point to point [N], which equals it where they are noise.
    converged : bool
    torn : bool
        Whether the arrays hold a tear: the force jumps from below back to its straight end.
    status : {"ok", "undetermined", "misfit", "not converged"}
        ``"misfit"``: the residuals are not noise, or a baseline is not level (straight: ``fit_tilt``), or the way
        there and the way back differ: the model does not describe these points and sigma is too small.
        ``"undetermined"``: `identifiable` holds a parameter that the
        points do not determine, as w of an adhesion that drowns in the noise.
    """

    values: Mapping[str, float]
    sigma: Mapping[str, float]
    identifiable: Mapping[str, bool]
    residual_rms: float
    residual_noise: float
    converged: bool
    torn: bool
    status: Status
    message: str = ""
    """how the fit ended, and what these points do not tell, in words"""


def fit_points(
    position: ArrayLike,
    force: ArrayLike,
    model: str | Model = "hertz",
    *,
    radius: float | None = None,
    half_angle: float | None = None,
    spring_constant: float = 0.0,
    contact_point: float | None = None,
    fit_offset: bool = True,
    fit_tilt: bool = False,
    noise: float = 0.0,
    fixed: Mapping[str, float] | None = None,
) -> PointsFit:
    """Fit a model to forces over positions, all points with the same weight.

    Hertz, cone and pyramid over the indentation about a given contact point are solved in closed form. With adhesion
    the points in contact are fitted alone; a straight end beyond them is the baseline. Where the force jumps back to it
    and the arrays run away from the sample, the place of this tear is used as well.

    Parameters
    ----------
    position : array_like, shape (n,)
        Travel of the base towards the sample, growing into it; without `spring_constant` the indentation, up to its
        zero [m].
    force : array_like, shape (n,)
        + repulsive [N].
    model : str or Model
        As of :func:`nanotouch.fit.fit_curve`.
    radius, half_angle : float, optional
        Of the tip [m], [rad]. Without them 20 nm and 20 degrees are assumed, and `message` says so.
    spring_constant : float
        k_c [N/m]; 0: `position` is the indentation.
    contact_point : float, optional
        Where the undeformed bodies touch, held [m]; fitted by default.
    fit_offset, fit_tilt : bool
        Whether a baseline, level and tilt, is fitted too.
    noise : float
        Standard deviation of the force [N]; 0: taken from the residuals.
    fixed : mapping, optional
        Parameters to hold, by name, at a value [SI].
    """
    compiled, chosen = extension(), find(model)
    if chosen.kernel:
        raise InvalidValue(f"model {chosen.name!r} is fitted to a whole curve over time: fit_curve")
    X, F = as_floats(position, "position"), as_floats(force, "force")
    held = dict(fixed or {})
    layer_of(chosen, None, None, held)
    if contact_point is not None:
        held["contact_point"] = contact_point
    fit_offset, fit_tilt = fit_offset and "force_offset" not in held, fit_tilt and "force_tilt" not in held
    setup = Setup(
        model=chosen,
        radius=ASSUMED_RADIUS if radius is None else radius,
        half_angle=ASSUMED_HALF_ANGLE if half_angle is None else half_angle,
        spring_constant=spring_constant,
        held=held,
    )
    usable = chosen.adhesive and X.ndim == 1 and X.shape == F.shape and bool(np.isfinite([X, F]).all())
    contact = contact_of(X, F, noise, offset=fit_offset, tilt=fit_tilt) if usable else None
    if contact is not None:
        found, options = _run_contact(compiled, setup, contact)
        found["residuals_are_noise"] &= contact.is_level and not 0.0 < noise < found["residual_rms"] / _MISFIT
    else:
        options = setup.options(compiled)
        options.force_noise = noise
        for name in ["force_offset"] * fit_offset + ["force_tilt"] * fit_tilt:
            options.free(name)
        found = compiled.run(options, X, F)
    found["residuals_are_noise"] &= X.ndim != 1 or not _ways_differ(X, F)
    found["message"] += _assumed(chosen, radius, half_angle)
    return _result(found, options, contact is not None and contact.torn)


def _assumed(model: Model, radius: float | None, half_angle: float | None) -> str:
    """What was not given and counts in this law, in words."""
    if is_sharp(model.name):
        degrees = np.degrees(ASSUMED_HALF_ANGLE)
        return "" if half_angle is not None else f"; half angle {degrees:.3g} degrees assumed: {model.scaling}"
    return "" if radius is not None else f"; tip radius {ASSUMED_RADIUS * 1e9:g} nm assumed: {model.scaling}"


def _ways_differ(position: Floats, force: Floats) -> bool:
    """Whether arrays that go there and come back hold two curves: somewhere surely, by more than their noise."""
    turn = int(np.argmax(np.abs(position - position[0])))
    ways = [(position[: turn + 1], force[: turn + 1]), (position[turn:], force[turn:])]
    if any(len(x) < _LEAST or abs(np.mean(np.sign(np.diff(x)))) < 0.5 for x, _ in ways):
        return False
    (x, there), (back, f) = ((x[np.argsort(x)], f[np.argsort(x)]) for x, f in ways)
    common = (x >= back[0]) & (x <= back[-1])
    apart = there[common] - np.interp(x[common], back, f)
    noise = 1.4826 * float(np.median(np.abs(np.diff(force, 2)))) / np.sqrt(6.0)
    least = max(noise, _EXACT * float(np.ptp(force)))
    return any(
        abs(part.mean()) > max(least, _SURELY * noise * np.sqrt(2.0 / part.size))
        for part in np.array_split(apart, max(1, apart.size // _PART)) if part.size > 1
    )  # fmt: skip


def _run_contact(compiled: ModuleType, setup: Setup, contact: Contact) -> tuple[dict[str, Any], Any]:
    """The fit of the points in contact; its offset and tilt are the whole baseline's, the offset that at position 0."""
    points, exact = contact.points, Uncertainties(sensitivity=0.0)
    if setup.spring_constant == 0.0 or setup.model.force is not None:
        points = points.without_tear()
    elif contact.torn:  # what may lie next to the tear, where the model is only continued, would bend it
        without = solve(compiled, setup, points.without_tear(), exact)
        width = compiled.steep_width(without.options, without.found["value"])
        points = points.kept(points.z[-1] - points.z > width, "fit_points")
    solution = solve(compiled, setup, points, exact)
    found, place = solution.found, {p[0]: i for i, p in enumerate(solution.options.parameters) if p is not None}
    value, sigma, middle = found["value"], found["sigma"], points.baseline_z
    offset, tilt = place["force_offset"], place["force_tilt"]
    value[tilt] -= contact.tilt
    value[offset] += contact.level + middle * value[tilt]
    sigma[offset] = np.hypot(sigma[offset], middle * sigma[tilt])
    return found, solution.options


def _result(found: dict[str, Any], options: Any, torn: bool) -> PointsFit:
    present = [(i, parameter[0]) for i, parameter in enumerate(options.parameters) if parameter is not None]
    identifiable = {name: bool(found["identifiable"][i]) for i, name in present if options.is_free(name)}
    status: Status = "ok" if all(identifiable.values()) else "undetermined"
    if not found["converged"]:
        status = "not converged"
    elif not found["residuals_are_noise"]:
        status = "misfit"
    return PointsFit(
        values={name: float(found["value"][i]) for i, name in present},
        sigma={name: float(found["sigma"][i]) for i, name in present},
        identifiable=identifiable,
        residual_rms=found["residual_rms"],
        residual_noise=found["residual_noise"],
        converged=found["converged"],
        torn=torn,
        status=status,
        message=found["message"],
    )
