# SPDX-License-Identifier: BSD-3-Clause
"""Viscoelastic samples: how a modulus relaxes, and the force of a tip along any history of the probe's base.

docs/rheology.md has the equations, what was measured against what, and the limits. All SI.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, NamedTuple, Self, get_args

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import Floats, as_floats, plain
from nanotouch._io.files import toml_tables
from nanotouch._io.words import shortened, told
from nanotouch.contact.geometry import KINDS, Shape
from nanotouch.errors import InvalidValue
from nanotouch.units import key_spellings, to_si

Kind = Literal["power_law", "standard_linear_solid", "prony"]
KINDS_OF_KERNEL: tuple[Kind, ...] = get_args(Kind)


def number_of(kind: Kind) -> int:
    """That of the C library, where 0 is a sample that does not relax."""
    return 1 + KINDS_OF_KERNEL.index(kind)


_UNITS = {
    "modulus": "Pa", "exponent": "", "reference_time": "s", "equilibrium_modulus": "Pa",
    "arm_moduli": "Pa", "relaxation_times": "s",
}  # fmt: skip
_KEYS: dict[str, tuple[str, ...]] = {
    "power_law": ("modulus", "exponent", "reference_time"),
    "standard_linear_solid": ("equilibrium_modulus", "arm_moduli", "relaxation_times"),
    "prony": ("equilibrium_modulus", "arm_moduli", "relaxation_times"),
}


class Spectrum(NamedTuple):
    """E(t) as a sum of exponentials: E_inf + Sum moduli exp(-rates t)."""

    equilibrium_modulus: float
    """E_inf [Pa]"""
    moduli: Floats
    """E_k [Pa]"""
    rates: Floats
    """1/tau_k [1/s]"""
    error: float
    """max relative error over the times asked for"""


class Force(NamedTuple):
    """What a history gives; one of each per point."""

    force: Floats
    """F, without adhesion never below 0 [N]"""
    indentation: Floats
    """delta; below 0: above the sample [m]"""
    derivatives: Floats | None
    """of F: a row per point, by ``contact``, then by :attr:`Rheology.parameters`"""
    arms: int
    """of the sum of exponentials"""
    kernel_error: float
    """max relative error of that sum; the force errs by some tenth of it"""
    by_springs: bool
    """a contact that had shrunk grew again, and 128 springs followed it: 3e-4 of the max force"""
    bulk_error: float = 0.0
    """with adhesion: what the bulk still relaxes, estimated, over the max absolute force"""
    dissipated: float = 0.0
    """with adhesion: at the edge of the contact [J]"""


@dataclass(frozen=True)
class Rheology:
    """How Young's modulus of a sample relaxes.

    Parameters
    ----------
    kind : {"power_law", "standard_linear_solid", "prony"}
        modulus (t/reference_time)^-exponent, or equilibrium_modulus + Sum arm_moduli exp(-t/relaxation_times), with one
        arm for a standard linear solid.
    modulus : float
        E_1, of a power law at the reference time [Pa].
    exponent : float
        beta of a power law, 0 (elastic) to 0.85.
    reference_time : float
        t_0 of a power law [s].
    equilibrium_modulus : float
        E_inf [Pa]; 0: a fluid.
    arm_moduli, relaxation_times : sequence of float
        E_k [Pa] and tau_k [s], up to 8 of each.
    """

    kind: Kind
    modulus: float = 1e3
    exponent: float = 0.2
    reference_time: float = 1.0
    equilibrium_modulus: float = 1e3
    arm_moduli: Sequence[float] = ()
    relaxation_times: Sequence[float] = ()

    def __post_init__(self) -> None:
        for name in ("arm_moduli", "relaxation_times"):
            object.__setattr__(self, name, tuple(float(value) for value in getattr(self, name)))
        _ = self._core  # the C library checks the values

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), tuple(getattr(self, name) for name in self.__dataclass_fields__)

    @cached_property
    def _core(self) -> _core.Rheology:
        if self.kind not in KINDS_OF_KERNEL:
            raise InvalidValue(f"kind {told(self.kind)}: valid are {', '.join(KINDS_OF_KERNEL)}")
        arms, times = len(self.arm_moduli), len(self.relaxation_times)
        most = {"power_law": 0, "standard_linear_solid": 1, "prony": 8}[self.kind]
        if arms != times or not min(most, 1) <= arms <= most:
            raise InvalidValue(
                f"{self.kind}: {arms} arm_moduli and {times} relaxation_times; "
                f"valid {'is none' if most == 0 else 'is 1 of each' if most == 1 else f'are 1 to {most} of each'}"
            )
        numbers = [float(self.modulus), float(self.exponent), float(self.reference_time)]
        return _core.Rheology(
            number_of(self.kind),
            [*numbers, float(self.equilibrium_modulus)],
            list(self.arm_moduli),
            list(self.relaxation_times),
        )

    @classmethod
    def power_law(cls, modulus: float, exponent: float, reference_time: float = 1.0) -> Self:
        """E(t) = modulus (t/reference_time)^-exponent."""
        return cls("power_law", modulus=modulus, exponent=exponent, reference_time=reference_time)

    @classmethod
    def standard_linear_solid(cls, equilibrium_modulus: float, arm_modulus: float, relaxation_time: float) -> Self:
        """E(t) = equilibrium_modulus + arm_modulus exp(-t/relaxation_time)."""
        arms: dict[str, Any] = {"arm_moduli": (arm_modulus,), "relaxation_times": (relaxation_time,)}
        return cls("standard_linear_solid", equilibrium_modulus=equilibrium_modulus, **arms)

    @classmethod
    def prony(cls, equilibrium_modulus: float, arm_moduli: Sequence[float], relaxation_times: Sequence[float]) -> Self:
        """E(t) = equilibrium_modulus + Sum arm_moduli exp(-t/relaxation_times)."""
        arms: dict[str, Any] = {"arm_moduli": arm_moduli, "relaxation_times": relaxation_times}
        return cls("prony", equilibrium_modulus=equilibrium_modulus, **arms)

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Self:
        """The table ``[rheology]`` of a TOML file; each key carries its unit: ``modulus_kPa = 1.2``."""
        tables = toml_tables(path)
        if "rheology" not in tables:
            raise InvalidValue(f"{os.fspath(path)} has no table [rheology]")
        return cls.from_table(tables["rheology"])

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Self:
        """From the table ``[rheology]``: ``{"kind": "power_law", "modulus_kPa": 1.2, "exponent": 0.2}``."""
        if not isinstance(table, Mapping):
            raise InvalidValue(f"[rheology] is {told(table)}, not a table")
        kind = table.get("kind")
        if not isinstance(kind, str) or kind not in KINDS_OF_KERNEL:
            raise InvalidValue(f"[rheology] kind = {told(kind)}: valid are {', '.join(KINDS_OF_KERNEL)}")
        spellings = {
            spelling: (name, factor)
            for name in _KEYS[kind]
            for spelling, factor in key_spellings(name, _UNITS[name]).items()
        }
        values: dict[str, Any] = {}
        for key, value in table.items():
            if key == "kind":
                continue
            if key not in spellings:
                likely = ", ".join(f"{name}{_example(name)}" for name in _KEYS[kind])
                raise InvalidValue(f"[rheology] has no key {shortened(key)} for a {kind}; it takes {likely}")
            name, factor = spellings[key]
            if name in values:
                raise InvalidValue(f"[rheology] has {name} twice: give one")
            is_list = name in ("arm_moduli", "relaxation_times")
            numbers = value if is_list and isinstance(value, list) else [value]
            if not all(isinstance(one, int | float) and not isinstance(one, bool) for one in numbers):
                raise InvalidValue(
                    f"[rheology] {key} = {told(value)}: it must be {'numbers' if is_list else 'a number'}"
                )
            si = [to_si(float(one), factor) if np.isfinite(one) else float(one) for one in numbers]
            values[name] = tuple(si) if is_list else si[0]
        needed = [name for name in _KEYS[kind] if name not in values and name != "reference_time"]
        if needed:
            raise InvalidValue(
                f"[rheology] of a {kind} lacks {', '.join(f'{name}{_example(name)}' for name in needed)}"
            )
        return cls(kind, **values)

    @property
    def keys(self) -> tuple[str, ...]:
        """The fields that its kind has."""
        return _KEYS[self.kind]

    @property
    def parameters(self) -> tuple[str, ...]:
        """What a fit varies, in the order of :attr:`Force.derivatives`."""
        if self.kind == "power_law":
            return "modulus", "exponent"
        arms = range(len(self.arm_moduli))
        return "equilibrium_modulus", *(f"{name}[{k}]" for k in arms for name in ("arm_moduli", "relaxation_times"))

    def relaxation(self, time: ArrayLike) -> Any:
        """E(t) [Pa] at times [s]; NaN below 0."""
        return plain(self._core.relaxation(as_floats(time, "time")))

    def relaxation_integral(self, time: ArrayLike) -> Any:
        """Integral of E from 0 to t [Pa s]."""
        return plain(self._core.relaxation_integral(as_floats(time, "time")))

    def creep(self, time: ArrayLike) -> Any:
        """J(t) [1/Pa]: strain under a unit stress since 0."""
        return plain(self._core.creep(as_floats(time, "time")))

    def discretize(self, shortest: float, longest: float, error: float = 1e-4) -> Spectrum:
        """As few exponentials as keep a relative error (1e-8 to 0.1) of E(t) between two times [s]."""
        equilibrium, moduli, rates, found = self._core.discretize(shortest, longest, error)
        return Spectrum(equilibrium, np.array(moduli), np.array(rates), found)

    def force(
        self,
        time: ArrayLike,
        position: ArrayLike,
        shape: Shape,
        *,
        contact: float = 0.0,
        poisson_ratio: float = 0.5,
        thickness: float = 0.0,
        spring_constant: float = 0.0,
        derivatives: bool = False,
        work_of_adhesion: float = 0.0,
        crack_length: float = 0.0,
    ) -> Force:
        """The force of a rigid tip along a history of the probe's base (Lee and Radok; Ting).

        With a work of adhesion it is JKR's contact with the equilibrium modulus, whose edge is a crack: opening takes
        w_eff(v) from w at rest to w E_0/E_inf at high speed (Persson and Brener 2005), closing returns w^2/w_eff.
        Then a paraboloid on a half-space, a kernel with finite E_0/E_inf, and a base so slow that the bulk relaxes
        (``bulk_error`` at most 5 %) are needed; anything else is an InvalidValue.

        Parameters
        ----------
        time : array (n,)
            Increasing [s]; the base moves in straight lines in between.
        position : array (n,)
            Of the base, towards the sample [m]; the first point is out of contact. With a rigid lever position -
            contact is the indentation.
        shape : Shape
            Paraboloid, sphere, cone (or pyramid) or punch.
        contact : float
            Position of first touch [m].
        poisson_ratio : float
            Of the sample.
        thickness : float
            Of a layer bonded to rigid ground [m]; 0: a half-space. Paraboloid and cone, Poisson ratio 0.5.
        spring_constant : float
            Of the lever [N/m], whose bending is solved for; 0: rigid.
        derivatives : bool
            Also those of the force, by ``contact`` and by :attr:`parameters`; not with adhesion.
        work_of_adhesion : float
            w of a contact at rest [J/m^2]; 0: none.
        crack_length : float
            a_0, length of the process zone at the edge of a contact at rest [m], about E* w/(2 pi sigma^2) for a
            cohesive stress sigma; at most a tenth of the contact radius without load.
        """
        times, positions = as_floats(time, "time"), as_floats(position, "position")
        if times.ndim != 1 or times.shape != positions.shape:
            raise InvalidValue(
                f"time and position of {times.shape} and {positions.shape}: two equal arrays of 2 or more"
            )
        stands = np.flatnonzero(np.diff(times) <= 0.0)
        if stands.size:
            i = int(stands[0]) + 1
            raise InvalidValue(f"time[{i}] = {times[i]:.9g} s: it must be above time[{i - 1}] = {times[i - 1]:.9g} s")
        tip = _core.Shape(KINDS.index(shape.kind), shape.sides, shape.radius, shape.half_angle, shape.transition)
        law = _core.Viscoelastic(tip, self._core, float(poisson_ratio), float(thickness), float(spring_constant))
        if work_of_adhesion == 0.0 and crack_length == 0.0:
            return Force(*law.run(times, positions, float(contact), bool(derivatives)))
        self._check_adhesion(shape, derivatives)
        edge = float(work_of_adhesion), float(crack_length)
        forces, depths, arms, bulk_error, dissipated = law.run_adhesive(times, positions, float(contact), *edge)
        return Force(forces, depths, None, arms, 0.0, False, bulk_error, dissipated)

    def _check_adhesion(self, shape: Shape, derivatives: bool) -> None:
        """InvalidValue for what the law with adhesion does not know, in words."""
        if shape.kind != "paraboloid":
            raise InvalidValue(f"a {shape.kind} with adhesion: only a paraboloid has this law (JKR)")
        if self.kind == "power_law" or self.equilibrium_modulus == 0.0:
            raise InvalidValue(
                f"a {self.kind} with adhesion: E_0/E_inf must be finite; take a standard_linear_solid or a prony "
                "series with an equilibrium_modulus above 0 Pa"
            )
        if derivatives:
            raise InvalidValue("derivatives with adhesion: there are none")


def _example(name: str) -> str:
    return {"Pa": "_kPa", "s": "_s", "": ""}[_UNITS[name]]
