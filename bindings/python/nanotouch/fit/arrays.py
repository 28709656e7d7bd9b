# SPDX-License-Identifier: BSD-3-Clause
"""A model fitted to two arrays, where there is no curve to be analysed: see :func:`fit_points`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .models import Model, extension, find


@dataclass(frozen=True, eq=False)
class PointsFit:
    """What a fit of two arrays found; SI.

    Attributes
    ----------
    values, sigma, identifiable : mapping
        By parameter, as of :class:`FitResult`; sigma is statistical.
    residual_rms : float
        Of the force [N].
    converged : bool
    """

    values: Mapping[str, float]
    sigma: Mapping[str, float]
    identifiable: Mapping[str, bool]
    residual_rms: float
    converged: bool


def fit_points(
    position: ArrayLike,
    force: ArrayLike,
    model: str | Model = "hertz",
    *,
    radius: float = 20e-9,
    half_angle: float | None = None,
    spring_constant: float = 0.0,
    contact_point: float | None = None,
    fit_offset: bool = True,
    fit_tilt: bool = False,
    noise: float = 0.0,
    fixed: Mapping[str, float] | None = None,
) -> PointsFit:
    """Fit a model to forces over positions, all points with the same weight.

    Hertz, cone and pyramid over the indentation about a given contact point are solved in closed form.

    Parameters
    ----------
    position : array_like, shape (n,)
        Travel of the base towards the sample, growing into it; without `spring_constant` the indentation, up to its
        zero [m].
    force : array_like, shape (n,)
        + repulsive [N].
    model : str or Model
        As of :func:`nanotouch.fit.fit_curve`.
    radius, half_angle : float
        Of the tip [m], [rad].
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
    options = find(model).options(extension(), radius)
    if half_angle is not None:
        options.half_angle = half_angle
    options.spring_constant, options.force_noise = spring_constant, noise
    if contact_point is not None:
        options.hold("contact_point", contact_point)
    if fit_offset:
        options.free("force_offset")
    if fit_tilt:
        options.free("force_tilt")
    for name, value in (fixed or {}).items():
        options.hold(name, value)
    compiled = extension()
    X, F = np.asarray(position, dtype=np.float64), np.asarray(force, dtype=np.float64)
    found = compiled.run(options, X, F)
    present = [(i, parameter[0]) for i, parameter in enumerate(options.parameters) if parameter is not None]
    return PointsFit(
        values={name: float(found["value"][i]) for i, name in present},
        sigma={name: float(found["sigma"][i]) for i, name in present},
        identifiable={name: bool(found["identifiable"][i]) for i, name in present if options.is_free(name)},
        residual_rms=found["residual_rms"],
        converged=found["converged"],
    )
