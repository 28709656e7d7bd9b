# SPDX-License-Identifier: BSD-3-Clause
"""A round tip on a sample that yields: force and heat along any path, and the dent it leaves. All SI."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import Floats, as_floats, plain
from nanotouch.contact import Contact
from nanotouch.errors import InvalidValue

#: the contact radius is at most this share of the tip's: beyond, a sphere is no paraboloid
_LARGEST = 0.5


class FirstLoading(NamedTuple):
    """A contact that is loaded for the first time; floats, or arrays of the shape that was asked for."""

    contact_radius: Any
    """a [m]"""
    indentation: Any
    """delta [m]"""
    force: Any
    """F [N]"""
    mean_pressure: Any
    """p_m = F/(pi a^2) [Pa]"""
    residual_depth: Any
    """delta_r, of the dent that stays if it is unloaded from here [m]"""
    effective_radius: Any
    """R', of tip and dent together [m]"""
    stored: Any
    """elastic energy, which unloading gives back [J]"""
    dissipated: Any
    """heat [J]"""
    stiffness: Any
    """dF/d(delta) of going on; of unloading it is 2 E* a [N/m]"""


class IndentationState(NamedTuple):
    """Where a contact is and what it remembers: enough to go on from."""

    indentation: float = 0.0
    """delta, of the apex below the sample before it was touched [m]"""
    force: float = 0.0
    """on the tip, away from the sample [N]"""
    contact_radius: float = 0.0
    """a [m]"""
    dent_radius: float = 0.0
    """a of the dent; 0: it has not yielded [m]"""
    stored: float = 0.0
    """elastic energy [J]"""
    dissipated: float = 0.0
    """heat so far [J]"""


class IndentationPath(NamedTuple):
    """Forces and energies along a path; one of each per point."""

    force: Floats
    """on the tip, away from the sample [N]"""
    contact_radius: Floats
    """a [m]"""
    dent_radius: Floats
    """a of the dent so far; 0: it has not yielded [m]"""
    stored: Floats
    """elastic energy [J]"""
    dissipated: Floats
    """heat since the beginning, never falling [J]"""
    state: IndentationState
    """at the end"""


@dataclass(frozen=True)
class Indentation:
    """Hertz up to a peak pressure of 1.6 Y, then a mean pressure that grows to 3 Y; elastic when it unloads.

    Without adhesion, hardening or rate. The mean pressure between the two is that of Johnson's cavity (1985, Sec. 6.3),
    the depth that of Field and Swain (1993).

    Parameters
    ----------
    radius : float
        R, of tip and sample together [m].
    effective_modulus : float
        E* [Pa].
    yield_strength : float
        Y, of the sample [Pa].
    """

    radius: float
    effective_modulus: float
    yield_strength: float

    def __post_init__(self) -> None:
        _ = self._core  # the C library checks the values

    @cached_property
    def _core(self) -> _core.Indentation:
        return _core.Indentation(self.radius, self.effective_modulus, self.yield_strength)

    @property
    def yield_load(self) -> float:
        """F_Y, where yield begins: pi^3 R^2 (1.6 Y)^3/(6 E*^2) [N] (Johnson 1985, Sec. 6.2)."""
        return self._core.yield_load

    @property
    def plastic_load(self) -> float:
        """Load at which the mean pressure reaches 3 Y [N]."""
        return self._core.plastic_load

    @property
    def largest_indentation(self) -> float:
        """Where the contact radius is R/2 [m], as deep as the law goes."""
        return float(self._first(np.array([_LARGEST * self.radius])).indentation[0])

    @property
    def largest_load(self) -> float:
        """There [N]."""
        return float(self._first(np.array([_LARGEST * self.radius])).force[0])

    def at_radius(self, contact_radius: ArrayLike) -> FirstLoading:
        """The first loading at contact radii [m], 0 .. R/2."""
        radii = as_floats(contact_radius, "contact_radius")
        _check("contact_radius", radii, "m", _LARGEST * self.radius, least=0.0)
        return self._shaped(radii.ravel(), radii.shape)

    def at_load(self, load: ArrayLike) -> FirstLoading:
        """The first loading at loads [N], 0 and above."""
        loads = as_floats(load, "load")
        _check("load", loads, "N", self.largest_load, least=0.0)
        return self._shaped(self._core.radius_at_load(loads.ravel()), loads.shape)

    def at_depth(self, indentation: ArrayLike) -> FirstLoading:
        """The first loading at indentations [m], 0 and above."""
        depths = as_floats(indentation, "indentation")
        _check("indentation", depths, "m", self.largest_indentation, least=0.0)
        return self._shaped(self._core.radius_at_depth(depths.ravel()), depths.shape)

    def run(self, indentation: ArrayLike, *, state: IndentationState | None = None) -> IndentationPath:
        """Along a path of the apex [m], below 0 above the sample; from a state, or from a sample never touched."""
        depths = np.atleast_1d(as_floats(indentation, "indentation"))
        if depths.ndim != 1 or depths.size == 0:
            raise InvalidValue("indentation: at least one point, in one dimension")
        _check("indentation", depths, "m", self.largest_indentation, least=-np.inf)
        begun = IndentationState() if state is None else state
        if not 0.0 <= begun.dent_radius <= _LARGEST * self.radius:
            span = f"0 .. {_LARGEST * self.radius:g} m"
            raise InvalidValue(
                f"state.dent_radius = {begun.dent_radius:g} m: valid is {span}, half of the tip's radius"
            )
        states = self._core.run(np.array(begun, dtype=float), depths)
        _, force, radius, dent, stored, dissipated = states.T
        return IndentationPath(force, radius, dent, stored, dissipated, IndentationState(*map(float, states[-1])))

    def unloading_contact(self, load: float, work_of_adhesion: float = 0.0) -> Contact:
        """The contact of the tip in the dent that a load [N] has left, with its larger radius R'.

        Any elastic law may be evaluated with it: its pull-off is that of the dent. R' and so the pull-off grow with the
        load once the sample yields (Mesarovic and Johnson 2000, for a load far above the pull-off).
        """
        radius = float(self.at_load(load).effective_radius)
        return Contact(radius, self.effective_modulus, work_of_adhesion=work_of_adhesion)

    def _first(self, radii: Floats) -> FirstLoading:
        return FirstLoading(*self._core.first(radii).T)

    def _shaped(self, radii: Floats, shape: tuple[int, ...]) -> FirstLoading:
        return FirstLoading(*(plain(np.ascontiguousarray(column).reshape(shape)) for column in self._first(radii)))


def _check(name: str, values: Floats, unit: str, most: float, least: float) -> None:
    wrong = values[~((values >= least) & (values <= most) & np.isfinite(values))]
    if wrong.size:
        valid = f"{least:g} .. {most:.6g} {unit}" if np.isfinite(least) else f"up to {most:.6g} {unit}"
        raise InvalidValue(
            f"{name} = {float(wrong[0]):g} {unit}: valid is {valid} (contact radius up to half the tip's)"
        )
