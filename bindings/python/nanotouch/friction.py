# SPDX-License-Identifier: BSD-3-Clause
"""Friction of a sliding tip: a contact that sticks like a spring and slips at a limit; atomic corrugation.

docs/friction.md has the equations, what was measured against what, and what is left out. All SI.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import Floats, LawValue, as_floats, check_between, plain
from nanotouch.contact import MODELS, Contact, Model
from nanotouch.errors import InvalidValue


class FrictionState(NamedTuple):
    """Where a contact is and what it remembers: enough to go on from."""

    x: float
    """of the support of tip and lever [m]"""
    y: float
    """[m]"""
    force_x: float
    """of the surface on the tip [N]"""
    force_y: float
    """[N]"""
    stiffness: float
    """of stick, contact and lever in series [N/m]"""
    stored: float
    """in that spring [J]"""
    dissipated: float
    """heat so far [J]"""
    work: float
    """done by the hand so far [J]; stored + dissipated"""


class FrictionPath(NamedTuple):
    """Forces and energies along a path; one of each per point."""

    force_x: Floats
    """of the surface on the tip, against its motion [N]"""
    force_y: Floats
    """[N]"""
    stored: Floats
    """elastic energy [J]"""
    dissipated: Floats
    """heat since the beginning, never falling [J]"""
    work: Floats
    """done by the hand since the beginning [J]"""
    state: FrictionState
    """at the end"""


@dataclass(frozen=True)
class Friction:
    """A contact that sticks with 8 a G*, in series with tip and lever, and slips at tau0 pi a^2 + alpha N_c.

    Parameters
    ----------
    effective_shear_modulus : float
        G* [Pa], see :func:`effective_shear_modulus`.
    lateral_compliance : float
        Of tip and lever at the apex [m/N]; 0: rigid.
    shear_strength : float
        tau0, friction per contact area [Pa].
    coefficient : float
        alpha, friction per load inside the contact.
    """

    effective_shear_modulus: float
    lateral_compliance: float = 0.0
    shear_strength: float = 0.0
    coefficient: float = 0.0

    def __post_init__(self) -> None:
        _ = self._core  # the C library checks the values

    @cached_property
    def _core(self) -> _core.Friction:
        return _core.Friction(
            self.effective_shear_modulus, self.lateral_compliance, self.shear_strength, self.coefficient
        )

    def stiffness(self, radius: float) -> float:
        """Of stick at a contact radius [m]: contact and lever in series [N/m]."""
        _check_at_least_zero("radius", as_floats(radius, "radius"), "m")
        return self._core.stiffness(radius)

    def limit(self, radius: float, compressive_load: float = 0.0) -> float:
        """Largest friction [N] at a contact radius [m] and a load inside the contact [N]."""
        _check_at_least_zero("radius", as_floats(radius, "radius"), "m")
        _check_at_least_zero("compressive_load", as_floats(compressive_load, "compressive_load"), "N")
        return self._core.limit(radius, compressive_load)

    def run(
        self,
        x: ArrayLike,
        y: ArrayLike,
        radius: ArrayLike,
        compressive_load: ArrayLike = 0.0,
        *,
        state: FrictionState | None = None,
    ) -> FrictionPath:
        """Along a path of the support, straight from point to point; each with the contact of its end.

        Parameters
        ----------
        x, y : array_like
            Points of the path [m], one-dimensional.
        radius, compressive_load : array_like
            a [m] and N_c [N] of the contact, of each point or of all.
        state : FrictionState, optional
            Go on from here; without it the first point is where nothing pulls yet.
        """
        columns = {"x": x, "y": y, "radius": radius, "compressive_load": compressive_load}
        points = np.broadcast_arrays(*(np.atleast_1d(as_floats(value, name)) for name, value in columns.items()))
        if points[0].ndim != 1 or points[0].size == 0:
            raise InvalidValue("x, y: at least one point, in one dimension")
        for name, values in zip(columns, points, strict=True):
            if not np.isfinite(values).all():
                raise InvalidValue(f"{name} has values that are no numbers or infinite")
        _check_at_least_zero("radius", points[2], "m")
        _check_at_least_zero("compressive_load", points[3], "N")
        begun = FrictionState(float(points[0][0]), float(points[1][0]), *np.zeros(6)) if state is None else state
        ways = [np.diff(line, prepend=start) for line, start in zip(points[:2], begun[:2], strict=True)]
        states = self._core.run(np.array(begun[2:]), np.stack(ways, axis=1), np.stack(points[2:], axis=1))
        last = FrictionState(float(points[0][-1]), float(points[1][-1]), *map(float, states[-1]))
        force_x, force_y, _, stored, dissipated, work = states.T
        return FrictionPath(force_x, force_y, stored, dissipated, work, last)


@dataclass(frozen=True)
class Corrugation:
    """Prandtl's and Tomlinson's tip: on a spring, over a lattice, with or without heat.

    Parameters
    ----------
    energy : float
        E0, corrugation from valley to top [J].
    period : float
        a, of the lattice [m].
    stiffness : float
        k, of contact and lever in series [N/m].
    damping : float
        gamma, of the sliding tip [N s/m].
    temperature : float
        T [K]; 0: athermal.
    """

    energy: float
    period: float
    stiffness: float
    damping: float = 1e-6
    temperature: float = 0.0

    def __post_init__(self) -> None:
        _ = self._core

    @cached_property
    def _core(self) -> _core.Corrugation:
        return _core.Corrugation(self.energy, self.period, self.stiffness, self.damping, self.temperature)

    @property
    def onset(self) -> float:
        """eta = 2 pi^2 E0/(k a^2): above 1 the tip sticks and slips, at 1 and below it slides smoothly."""
        return self._core.onset

    @property
    def largest_force(self) -> float:
        """pi E0/a [N]."""
        return self._core.largest_force

    def mean_force(self, speed: ArrayLike) -> Any:
        """Mean friction [N] at speeds of the support [m/s] above 0.

        Without heat eta up to 20 and gamma v up to 10 pi E0/a; with heat within 2 % of Langevin's equation for eta
        3 .. 20, kT/E0 1/500 .. 1/13 and gamma v up to 0.1 (2 kT/E0)^1.5 pi E0/a; refused elsewhere.
        """
        speeds = as_floats(speed, "speed")
        found = [self._core.mean_force(float(one)) for one in speeds.ravel()]
        return plain(np.array(found).reshape(speeds.shape))


def effective_shear_modulus(
    tip_youngs_modulus: float, tip_poisson_ratio: float, sample_youngs_modulus: float, sample_poisson_ratio: float
) -> float:
    """G* [Pa] of two bodies: 1/G* = (2 - nu_t)/G_t + (2 - nu_s)/G_s, G = E/(2 (1 + nu)) (Mindlin 1949)."""
    check_between("tip_youngs_modulus", tip_youngs_modulus, "Pa", above=0.0)
    check_between("sample_youngs_modulus", sample_youngs_modulus, "Pa", above=0.0)
    check_between("tip_poisson_ratio", tip_poisson_ratio, "", above=-1.0, up_to=0.5)
    check_between("sample_poisson_ratio", sample_poisson_ratio, "", above=-1.0, up_to=0.5)
    return _core.Friction.effective_shear_modulus(
        tip_youngs_modulus, tip_poisson_ratio, sample_youngs_modulus, sample_poisson_ratio
    )


def compressive_load(model: Model, law: LawValue, contact: Contact) -> Any:
    """Load inside the contact [N], where the pressure is positive, of what ``contact.evaluate`` returned.

    It is never below 0. Hertz and DMT: 4/3 E* a^3/R. JKR and Maugis: less, for the rim pulls.
    """
    if model not in MODELS:
        raise InvalidValue(f"model {model!r}: valid are {', '.join(MODELS)}")
    force, radius = np.broadcast_arrays(as_floats(law.F, "force"), as_floats(law.a, "radius"))
    stress = (
        contact.work_of_adhesion / contact.cohesive_range
        if contact.cohesive_range is not None
        else contact.cohesive_stress
    )
    if model == "maugis" and stress is None and contact.work_of_adhesion > 0.0:
        raise InvalidValue("the model 'maugis' needs cohesive_stress [Pa] or cohesive_range [m] of the adhesion")
    parameters = contact.radius, contact.effective_modulus, contact.work_of_adhesion, stress or 1.0
    return plain(_core.Friction.compressive_load(MODELS.index(model), *parameters, force, radius))


class FrictionFit(NamedTuple):
    """tau0 and alpha of measured friction over load."""

    shear_strength: float
    """tau0 [Pa]; below 0 where the data are so"""
    shear_strength_sigma: float
    """standard deviation, the scale's included"""
    coefficient: float
    """alpha, of the load inside the contact"""
    coefficient_sigma: float
    """standard deviation, the scale's included"""
    correlation: float
    """between both, -1 .. 1: near -1 the loads tell only their sum"""
    reduced_chi_square: float
    """mean square of what is left over, in sigmas: about 1 where law and sigmas are right; NaN of two points"""


def fit(
    load: ArrayLike,
    force: ArrayLike,
    sigma: ArrayLike,
    contact: Contact,
    *,
    model: Model = "jkr",
    scale_sigma: float = 0.0,
) -> FrictionFit:
    """tau0 and alpha from half-widths of friction loops at several loads: F = tau0 pi a^2 + alpha N_c, weighted least
    squares. Nothing is clamped at 0.

    Parameters
    ----------
    load : array (n,)
        Net load of the lever, negative where adhesion holds the tip down [N].
    force, sigma : array (n,)
        Friction, and its standard deviation, above 0 (one, or one for all) [N].
    contact : Contact
        Radius, effective modulus and work of adhesion, taken as known.
    model : {"hertz", "dmt", "jkr"}
        From load to radius and load inside.
    scale_sigma : float
        Relative standard deviation of the lateral calibration, common to all forces.
    """
    loads, forces = as_floats(load, "load"), as_floats(force, "force")
    sigmas = np.broadcast_to(as_floats(sigma, "sigma"), forces.shape)
    if loads.ndim != 1 or loads.shape != forces.shape or len(loads) < 2:
        raise InvalidValue(f"load and force of {loads.shape} and {forces.shape}: two equal arrays of 2 or more")
    if not (np.isfinite(loads + forces).all() and np.isfinite(sigmas).all() and (sigmas > 0.0).all()):
        raise InvalidValue("a fit of friction needs finite loads and forces, and sigmas above 0 N")
    if not 0.0 <= scale_sigma <= 1.0:
        raise InvalidValue(f"scale_sigma = {scale_sigma:g}: valid is 0 to 1")
    radius = radius_under(loads, contact, model)
    law = LawValue(np.zeros_like(loads), loads, np.zeros_like(loads), radius)
    rows = np.stack([np.pi * radius**2, as_floats(compressive_load(model, law, contact), "load")], axis=1)
    weighted = rows / sigmas[:, None]
    size = np.linalg.norm(weighted, axis=0)
    if not (size > 0.0).all() or np.linalg.cond(weighted / size) > 1e8:
        raise InvalidValue("these loads do not tell shear strength and coefficient apart: take more of them")
    spread = np.linalg.inv((weighted / size).T @ (weighted / size))
    found = spread @ ((weighted / size).T @ (forces / sigmas)) / size
    left = forces / sigmas - weighted @ found
    sigma_of = np.hypot(np.sqrt(np.diag(spread)) / size, scale_sigma * found)
    freedom = len(loads) - 2
    return FrictionFit(
        float(found[0]), float(sigma_of[0]), float(found[1]), float(sigma_of[1]),
        float(spread[0, 1] / np.sqrt(spread[0, 0] * spread[1, 1])),
        float(left @ left) / freedom if freedom else float("nan"),
    )  # fmt: skip


def radius_under(load: ArrayLike, contact: Contact, model: Model = "jkr") -> Floats:
    """Contact radius [m] under a net load [N]: a^3 = R/K P, K = 4/3 E*, with P the load (Hertz), load + 2 pi w R (DMT),
    or load + 3 pi w R + sqrt(6 pi w R load + (3 pi w R)^2) (JKR, Johnson 1971). Below pull-off it is refused."""
    loads, pull = as_floats(load, "load"), np.pi * contact.work_of_adhesion * contact.radius
    if model not in ("hertz", "dmt", "jkr"):
        raise InvalidValue(f"model {model!r}: valid for a load are hertz, dmt, jkr")
    least = {"hertz": 0.0, "dmt": -2.0 * pull, "jkr": -1.5 * pull}[model]
    if not (loads >= least * (1.0 + 1e-12)).all():
        raise InvalidValue(f"load = {np.min(loads):g} N: the {model} contact holds from {least:g} N on")
    pressed = loads - least if model != "jkr" else loads + 3.0 * pull
    if model == "jkr":
        pressed = pressed + np.sqrt(np.maximum(6.0 * pull * loads + (3.0 * pull) ** 2, 0.0))
    radius: Floats = np.cbrt(contact.radius * np.maximum(pressed, 0.0) / (4.0 / 3.0 * contact.effective_modulus))
    return radius


def _check_at_least_zero(name: str, values: Floats, unit: str) -> None:
    if not (values >= 0.0).all():
        raise InvalidValue(f"{name} = {float(np.nanmin(values)):g} {unit}: valid is 0 and above")
