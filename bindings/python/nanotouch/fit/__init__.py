# SPDX-License-Identifier: BSD-3-Clause
"""Fit a contact model to a measured force curve, and say what the curve can and cannot tell.

>>> import nanotouch as nt
>>> curve = nt.curves.read("curve.jpk-force")[0]                                           # doctest: +SKIP
>>> result = nt.fit.fit_curve(curve, model="maugis", radius=20e-9, poisson_ratio=0.3)      # doctest: +SKIP
>>> result.values["effective_modulus"], result.sigma["effective_modulus"], result.identifiable   # doctest: +SKIP

The force is fitted over the position of the cantilever's base, with the bending of the cantilever inside the model. So
the noise of the force does not enter the abscissa. A curve whose slope is that of its cantilever shows itself as one
that does not determine the modulus. How and why: docs/fit.md.
"""

from .arrays import PointsFit, fit_points
from .choice import PARABOLOIDS, Candidate, Choice, choose_model
from .fitting import TipLike, fit_curve
from .models import Model, Parameter, add_named, add_over_time, models, register
from .over_time import OVER_TIME
from .pauses import Pause, creep, pauses, relaxation
from .picture import draw
from .result import FitResult
from .sokolov import SOKOLOV, SeriesBias, series_bias
from .stability import Stability, stability
from .uncertainties import Uncertainties

add_named(SOKOLOV)
add_over_time(OVER_TIME)

__all__ = [
    "OVER_TIME",
    "PARABOLOIDS",
    "SOKOLOV",
    "Candidate",
    "Choice",
    "FitResult",
    "Model",
    "Parameter",
    "Pause",
    "PointsFit",
    "SeriesBias",
    "Stability",
    "TipLike",
    "Uncertainties",
    "choose_model",
    "creep",
    "draw",
    "fit_curve",
    "fit_points",
    "models",
    "pauses",
    "register",
    "relaxation",
    "series_bias",
    "stability",
]
