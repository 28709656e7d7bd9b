# SPDX-License-Identifier: BSD-3-Clause
"""Laws of one's own in a scene: registered once by name, given their parameters in a scene, tabulated by the C library
when a plan is made. What runs never calls Python."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib.metadata import entry_points
from typing import Any

from nanotouch import _core
from nanotouch._io.words import shortened
from nanotouch.errors import Error, InvalidValue
from nanotouch.units import UNITS, key_spellings, to_si

TermLaw = Callable[..., float]
LONGEST_NAME = 31
GROUP = "nanotouch.terms"
RESERVED = ("gap", "version")  # the argument of all laws, and what recordings hold beside the parameters


@dataclass(frozen=True, eq=False)
class CustomTerm:
    """A law of one's own, equal to itself alone; see :func:`register`."""

    name: str
    energy: TermLaw
    force: TermLaw
    stiffness: TermLaw
    bound: TermLaw
    parameters: Mapping[str, float | str | None] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    version: int = 1

    def values(self, given: Mapping[str, Any]) -> dict[str, float | str]:
        """All parameters, those that are not given by their defaults; a text is the name of a field of the scene."""
        unknown = set(given) - set(self.parameters)
        if unknown:
            has = ", ".join(self.parameters) or "none"
            raise InvalidValue(f"terms.{self.name} has no parameter {min(unknown)!r}; it has {has}")
        values: dict[str, float | str] = {}
        for name, default in self.parameters.items():
            value = given.get(name, default)
            if value is None:
                raise InvalidValue(f"terms.{self.name} needs {name} [{self.units.get(name, '')}]")
            values[name] = value if isinstance(value, str) else self._number(name, value)
        return values

    def _number(self, name: str, value: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise InvalidValue(f"terms.{self.name}.{name} = {value!r}: it must be a finite number")
        return float(value)

    def from_table(self, table: Mapping[str, Any]) -> dict[str, float]:
        """The parameters of a table of a TOML file, whose keys carry their units."""
        values: dict[str, float] = {}
        for key, value in table.items():
            spelled = {
                spelling: (name, factor)
                for name in self.parameters
                for spelling, factor in key_spellings(name, self.units.get(name, "")).items()
            }
            if key not in spelled:
                raise InvalidValue(
                    f"[terms.{self.name}] has no key {shortened(key)}; it has {', '.join(self.parameters)}"
                )
            name, factor = spelled[key]
            values[name] = to_si(self._number(name, value), factor)
        return values

    def failure(self, values: Mapping[str, float], gap: float) -> Exception | None:
        """What its functions raise at a gap [m]."""
        try:
            for law in (self.energy, self.force, self.stiffness, self.bound):
                float(law(gap, **values))
        except Exception as error:
            return error
        return None

    def bind(self, values: Mapping[str, float]) -> tuple[str, Callable[[float], Any], Callable[[float], float]]:
        """Name, {U, F, k} and bound as functions of the gap alone; what they raise becomes a NaN, which is refused."""

        def law(gap: float) -> tuple[float, float, float]:
            try:
                energy, force, stiffness = (f(gap, **values) for f in (self.energy, self.force, self.stiffness))
                return float(energy), float(force), float(stiffness)
            except Exception:
                return math.nan, math.nan, math.nan

        def bound(gap: float) -> float:
            try:
                return float(self.bound(gap, **values))
            except Exception:
                return math.nan

        return self.name, law, bound


_known: dict[str, CustomTerm] = {}


def register(
    name: str,
    *,
    energy: TermLaw,
    force: TermLaw,
    stiffness: TermLaw,
    bound: TermLaw,
    parameters: Mapping[str, float | str | None] | None = None,
    units: Mapping[str, str] | None = None,
    version: int = 1,
) -> None:
    """Make a law of one's own known, so that scenes can have it by its name.

    Parameters
    ----------
    name : str
        An identifier of at most 31 letters that no law of the library has. A name that is registered again gets the new
        functions; scenes that have it keep the old ones.
    energy, force, stiffness : callable
        ``energy(gap, **parameters)`` [J] falls to 0 at large gaps [m]; ``force`` = -dU/dh [N], + repulsive;
        ``stiffness`` = -dF/dh [N/m]. Pure functions of a float, called when a plan is made, never by what runs.
    bound : callable
        ``bound(gap, **parameters)`` [N]: what the magnitude of the force never exceeds at this gap and all larger ones.
    parameters : mapping
        Name and default of each parameter; None: it must be given; a text: the field of the scene that it follows, such
        as ``"tip.radius"``.
    units : mapping
        The SI unit of each parameter; "" where there is none.
    version : int
        Raise it when the law changes: recordings hold it, and a scene of another version is refused.
    """
    taken = {row[0] for row in _core.term_rows()}
    if not name.isidentifier() or len(name.encode()) > LONGEST_NAME or name in taken:
        raise InvalidValue(
            f"name {name!r}: it must be an identifier of at most {LONGEST_NAME} letters that no law of the library has"
        )
    lacking = set(parameters or {}) ^ set(units or {})
    if lacking:
        raise InvalidValue(f"{name}: {min(lacking)!r} must be in both parameters and units")
    for parameter, unit in (units or {}).items():
        if unit not in UNITS:
            raise InvalidValue(f"{name}: unit {unit!r} of {parameter!r}; known are {', '.join(filter(None, UNITS))}")
    for parameter in parameters or {}:
        if not parameter.isidentifier() or parameter in RESERVED:
            raise InvalidValue(f"{name}: no parameter may be called {parameter}")
    _known[name] = CustomTerm(name, energy, force, stiffness, bound, dict(parameters or {}), dict(units or {}), version)


def registered() -> tuple[str, ...]:
    """The names of all laws of one's own."""
    return tuple(_known)


def find(name: str, version: int | None = None) -> CustomTerm:
    """The law of a name, of a version if one is asked for."""
    if name not in _known:
        _install(name)
    if name not in _known:
        raise InvalidValue(
            f"terms.{name}: no such law is registered (nanotouch.scene.register); registered: "
            f"{', '.join(_known) or 'none'}"
        )
    if version is not None and version != _known[name].version:
        raise InvalidValue(f"terms.{name}: version {version} is needed, version {_known[name].version} is registered")
    return _known[name]


def _install(name: str) -> None:
    """Let an installed package register its law: an entry point of that name, a function without arguments."""
    for entry in entry_points(group=GROUP, name=name):
        try:
            entry.load()()
        except Exception as error:
            raise Error(f"the law {name!r} ({entry.value}) cannot be registered: {error}") from error
