# SPDX-License-Identifier: BSD-3-Clause
"""The models that can be fitted: those of the library, and the user's own.

>>> import nanotouch as nt
>>> def punch(indentation, radius, effective_modulus):
...     return 2 * effective_modulus * radius * indentation.clip(0)
>>> model = nt.fit.Model(
...     "punch", punch, (nt.fit.Parameter("effective_modulus", "Pa", 1e3, 1e12),), valid="flat punch, no adhesion")
>>> nt.fit.register(model)                                                             # doctest: +SKIP
>>> nt.fit.fit_curve(curve, "punch", radius=1e-6)                                      # doctest: +SKIP
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nanotouch.errors import InvalidValue, MissingExtra

Floats = NDArray[np.float64]
MOST_PARAMETERS = 4


@dataclass(frozen=True)
class Parameter:
    """One parameter of a model.

    Parameters
    ----------
    name, unit : str
        An identifier, and the SI unit ("" if none).
    minimum, maximum : float
        Bounds; with a minimum above 0 its logarithm is fitted, so that its scale does not matter.
    initial : float, optional
        Where the fit starts; without it the first such parameter is looked for on a logarithmic grid.
    """

    name: str
    unit: str
    minimum: float
    maximum: float
    initial: float | None = None


@dataclass(frozen=True)
class Model:
    """A law F(indentation).

    Parameters
    ----------
    name : str
        What it is called in ``fit_curve(..., model=name)``.
    force : callable
        ``force(indentation, radius, *values)``: force [N] at an array of indentations [m], shape (n,), with a tip of
        `radius` [m] and the values of `parameters` in their order; + repulsive, NaN where there is no such contact.
        A pure function; base travel must grow with the indentation. None for the laws of the library.
    parameters : tuple of Parameter
        One to four.
    valid : str
        Where it holds, in one sentence; printed with each result.
    title : str
        For pictures.
    adhesive : bool
        True: by default the retraction is fitted to its lowest force; False: the approach, where it repels.
    """

    name: str
    force: Callable[..., Any] | None = None
    parameters: tuple[Parameter, ...] = ()
    valid: str = ""
    title: str = ""
    adhesive: bool = False
    sides: int | None = None
    """of a sharp tip of the library, which has an angle and no radius: 0 of a cone, 4 of a pyramid; None: round"""
    remark: Callable[[float, dict[str, float], float], str] | None = None
    """of radius [m], values and largest force [N]: a note to each result"""

    def options(self, extension: ModuleType, radius: float) -> Any:
        """Options of the C library for this model."""
        force = self.force
        if force is None:
            made = extension.Options(self.name)
        else:
            starts = [
                (p.name, p.unit, np.nan if p.initial is None else p.initial, p.minimum, p.maximum)
                for p in self.parameters
            ]
            made = extension.Options(
                self.name,
                starts,
                lambda indentation, size, values: np.asarray(force(indentation, size, *values), dtype=np.float64),
            )
        made.radius = radius
        return made


_SMALL = "contact radius much smaller than R, elastic half-space"
BUILT_IN = (
    Model("hertz", title="Hertz", valid=f"paraboloid, no adhesion, {_SMALL}"),
    Model("dmt", title="DMT", valid=f"paraboloid, stiff with a long range of adhesion (lambda below 0.05), {_SMALL}",
          adhesive=True),
    Model("jkr", title="JKR", valid=f"paraboloid, soft with a short range of adhesion (lambda above 5), {_SMALL}",
          adhesive=True),
    Model("maugis", title="Maugis-Dugdale", valid=f"paraboloid, every lambda, {_SMALL}", adhesive=True),
    Model("cone", title="Sneddon's cone", valid="sharp cone, no adhesion, elastic half-space", sides=0),
    Model("pyramid", title="four-sided pyramid", valid="sharp pyramid of four sides, no adhesion, elastic half-space",
          sides=4),
)  # fmt: skip
SHARP = {model.name: model.sides for model in BUILT_IN if model.sides is not None}
"""sides of the tips that have an angle and no radius"""

_known: dict[str, Model] = {model.name: model for model in BUILT_IN}
_named = set(_known)  # those of the library


def add_named(model: Model) -> None:
    """One of the library that is written in Python; it cannot be replaced either."""
    check(model)
    _known[model.name] = model
    _named.add(model.name)


def models() -> tuple[str, ...]:
    """Names of all models that :func:`nanotouch.fit.fit_curve` knows."""
    return tuple(_known)


def register(model: Model) -> None:
    """Make a model known by its name; one of the library cannot be replaced.

    Raises
    ------
    InvalidValue
        If its description is not complete.
    """
    if model.name in _named:
        raise InvalidValue(f"model {model.name!r} is one of the library; give yours another name")
    check(model)
    _known[model.name] = model


def check(model: Model) -> None:
    """Raise InvalidValue unless a user's model is described completely."""
    if not model.name.isidentifier() or model.force is None or not callable(model.force):
        raise InvalidValue(f"model {model.name!r}: expected an identifier and a function for the force")
    if not 1 <= len(model.parameters) <= MOST_PARAMETERS:
        raise InvalidValue(f"model {model.name!r}: {len(model.parameters)} parameters, expected 1 .. {MOST_PARAMETERS}")
    names = [parameter.name for parameter in model.parameters]
    if len(set(names)) < len(names) or not all(name.isidentifier() for name in names):
        raise InvalidValue(f"model {model.name!r}: its parameters need different identifiers, not {', '.join(names)}")
    for p in model.parameters:
        if not (np.isfinite(p.minimum) and np.isfinite(p.maximum) and p.minimum < p.maximum):
            raise InvalidValue(f"model {model.name!r}, {p.name}: bounds {p.minimum} .. {p.maximum} are no interval")
    if not model.valid:
        raise InvalidValue(f"model {model.name!r}: say where it is valid")


def title_of(name: str) -> str:
    """What a model is called in sentences; a user's own may have its name alone."""
    return (_known[name].title if name in _known else "") or name


def find(model: str | Model) -> Model:
    """The model of a name; a Model is returned as it is."""
    if isinstance(model, Model):
        if model.force is not None or model.name not in {built_in.name for built_in in BUILT_IN}:
            check(model)
        return model
    if model not in _known:
        raise InvalidValue(f"model {model!r}: valid are {', '.join(_known)}; nanotouch.fit.register adds your own")
    return _known[model]


def extension() -> ModuleType:
    """The compiled part of this package."""
    try:
        from nanotouch import _fit
    except ImportError as error:
        raise MissingExtra(
            "fitting needs the extension nanotouch._fit, which this build lacks: install Ceres (Debian, Ubuntu: "
            "apt install libceres-dev) and build nanotouch again from its sources"
        ) from error
    return _fit
