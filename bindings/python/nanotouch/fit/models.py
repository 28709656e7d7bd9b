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

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from types import ModuleType
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from nanotouch.errors import InvalidValue, MissingExtra

Floats = NDArray[np.float64]
MOST_PARAMETERS = 4
INCOMPRESSIBLE = 0.5  # Poisson's ratio of a layer
_THINNEST, _THICKEST = 1e-9, 1.0  # m


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
    tip: Literal["paraboloid", "sphere", "cone", "punch"] = "paraboloid"
    """shape of the tip, as a scene calls it; of a law of one's own it says nothing"""
    sides: int | None = None
    """of a sharp tip of the library, which has an angle and no radius: 0 of a cone, 3 or 4 of a pyramid; None: round"""
    scaling: str = "E* goes as 1/sqrt(R), w as 1/R"
    """what an error of the tip's size or angle does to the result"""
    law: str = ""
    """of the library: force over indentation, in words"""
    exponent: float = 0.0
    """of the library: n of F ~ E* delta^n without adhesion"""
    transition: float = 0.0
    """of the library: Maugis' lambda that stands for its range of adhesion; 0: it has one, or no adhesion"""
    kernel: str = ""
    """of the library: how the sample relaxes, of models that are fitted to a whole curve over time; else empty"""
    remark: Callable[[float, dict[str, float], float], str] | None = None
    """of radius [m], values and largest force [N]: a note to each result"""

    @property
    def has_range(self) -> bool:
        """Whether it is a law of the library with a range of adhesion h0."""
        return self.force is None and any(parameter.name == "cohesive_range" for parameter in self.parameters)

    @property
    def is_layer(self) -> bool:
        """Whether it is a law of the library for a layer of a thickness."""
        return self.force is None and any(parameter.name == "thickness" for parameter in self.parameters)

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


@cache
def built_in() -> dict[str, Model]:
    """The laws of the C library by name, from their rows; empty in a build without :mod:`nanotouch._fit`."""
    try:
        rows = extension().models()
    except MissingExtra:
        return {}
    return {
        name: Model(name, parameters=tuple(Parameter(*own) for own in row.pop("parameters")), **row)
        for name, row in rows.items()
    }


def is_sharp(name: str) -> bool:
    """Whether the tip of a model of the library has an angle and no radius."""
    known = built_in() | _over_time
    return name in known and known[name].sides is not None


def layer_of(
    model: Model, thickness: float | None, poisson_ratio: float | None, held: Mapping[str, float]
) -> dict[str, float]:
    """The thickness to hold [m], empty of a half-space; raises InvalidValue where it does not go with the model."""
    if model.kernel and model.sides in (None, 0) and model.tip in ("paraboloid", "cone"):
        if thickness is None:
            return {}
    elif not model.is_layer:
        if thickness is not None:
            layers = ", ".join(name for name, known in built_in().items() if known.is_layer)
            raise InvalidValue(f"model {model.name!r} is of a half-space: thickness goes with {layers}")
        return {}
    thickness = held.get("thickness") if thickness is None else thickness
    if thickness is None:
        raise InvalidValue(f"model {model.name!r} needs the thickness of the layer: thickness=, or --thickness 5um")
    if not _THINNEST <= thickness <= _THICKEST:
        raise InvalidValue(f"thickness {thickness:g} m: valid is {_THINNEST:g} to {_THICKEST:g} m")
    if poisson_ratio not in (None, INCOMPRESSIBLE):
        raise InvalidValue(f"poisson_ratio {poisson_ratio}: model {model.name!r} holds for {INCOMPRESSIBLE} only")
    return {"thickness": float(thickness)}


_over_time: dict[str, Model] = {}  # of the library, fitted to a whole curve
_own: dict[str, Model] = {}  # written in Python: the library's, and those that were registered
_named: set[str] = set()  # the library's among them


def _known() -> dict[str, Model]:
    return built_in() | (_over_time if built_in() else {}) | _own


def add_over_time(rows: Mapping[str, Model]) -> None:
    """The library's models that are fitted to a whole curve over time."""
    _over_time.update(rows)


def add_named(model: Model) -> None:
    """One of the library that is written in Python; it cannot be replaced either."""
    check(model)
    _own[model.name] = model
    _named.add(model.name)


def models() -> tuple[str, ...]:
    """Names of all models that :func:`nanotouch.fit.fit_curve` knows."""
    return tuple(_known())


def register(model: Model) -> None:
    """Make a model known by its name; one of the library cannot be replaced.

    Raises
    ------
    InvalidValue
        If its description is not complete.
    """
    if model.name in _named or model.name in built_in() or model.name in _over_time:
        raise InvalidValue(f"model {model.name!r} is one of the library; give yours another name")
    check(model)
    _own[model.name] = model


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
    return (_known()[name].title if name in _known() else "") or name


def find(model: str | Model) -> Model:
    """The model of a name; a Model is returned as it is."""
    if isinstance(model, Model):
        if model.force is not None or model.name not in built_in() | _over_time:
            check(model)
        return model
    known = _known()
    if model not in known:
        extension()  # without it there are none of the library
        raise InvalidValue(f"model {model!r}: valid are {', '.join(known)}; nanotouch.fit.register adds your own")
    return known[model]


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
