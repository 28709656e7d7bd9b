# SPDX-License-Identifier: BSD-3-Clause
"""Force, stiffness and contact radius of a scene, everything on: the textbooks' equations written anew in numpy.
It calls nothing of the library and reads of it only the fields of a scene.

Where the library has a parameter, a series or a closed form, this has another: Maugis' equations in theta = acos(a/c),
tails summed over slices of the tip, stiffnesses by complex steps, contact shapes by Sneddon's integrals.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import oracle_contact
from oracle_contact import Values

EPSILON, BOLTZMANN, AVOGADRO, CHARGE, GAS = (
    8.8541878128e-12,
    1.380649e-23,
    6.02214076e23,
    1.602176634e-19,
    8.31446261815324,
)
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_SLICES = 24


class Adhesion(NamedTuple):
    """What holds: w [J/m2] and over which range [m]; 0 if nothing does."""

    work: float
    range: float
    capture: float


def _with_atoms_apart(scene: Any) -> Any:
    """The scene with the contact distance D0 of Israelachvili, w = H/(12 pi D0^2), where that is more than its z0: van
    der Waals is a part of w. Of a measured pull-off force F, w is no less than F/(2 pi R). Up to a nanometre."""
    medium, adhesion, H = scene.medium, scene.adhesion, scene.adhesion.hamaker_constant
    wet = medium.kind == "air" and medium.relative_humidity > 0.0 and medium.surface_tension > 0.0
    if wet or scene.tip.shape in ("cone", "punch"):
        return scene
    work = {
        "pull_off_force": adhesion.pull_off_force / (2.0 * math.pi * scene.tip.radius),
        "surface_energies": 2.0 * math.sqrt(adhesion.tip_surface_energy * adhesion.sample_surface_energy),
        "work_of_adhesion": adhesion.work_of_adhesion,
    }[adhesion.given]
    if work == 0.0:
        return scene
    apart = math.sqrt(H / (12.0 * math.pi * work)) - scene.sample.roughness / 2.0
    made = scene.copy()
    if adhesion.equilibrium_distance < apart <= 1e-9:
        made.adhesion.equilibrium_distance = apart
    return made


class Oracle:
    """One scene; ``work`` [J/m2] where a pull-off force is given, which w is to be found for."""

    def __init__(self, scene: Any, work: float = 0.0) -> None:
        self.scene = _with_atoms_apart(scene)
        one, other = ((1.0 - body.poisson_ratio**2) / body.youngs_modulus for body in (scene.tip, scene.sample))
        self.modulus = 1.0 / (one + other)
        self.is_jkr = scene.tip.shape in ("cone", "punch")
        self.adhesion = self._adhesion(work)
        #: what the tail pulls where adhesion takes hold is no part of what holds then [J/m2]
        self.tail = -float(self._vdw(np.zeros(1)).F[0]) / (2.0 * math.pi * scene.tip.radius)
        self.left = self.adhesion.work - self.tail if self.adhesion.work > 0.0 else 0.0
        self._beside: list[Callable[[Any], Values]] = [self._vdw]
        for law in (self._electrostatic, self._charge, self._double_layer, self._hydration, self._brush, self._yukawa):
            self._beside.append(self._held(law))
        self._beside += [functools.partial(self._custom, name) for name in scene.terms]

    def _has_meniscus(self) -> bool:
        medium = self.scene.medium
        return bool(medium.kind == "air" and medium.relative_humidity > 0.0 and medium.surface_tension > 0.0)

    def _adhesion(self, work: float) -> Adhesion:
        medium, adhesion = self.scene.medium, self.scene.adhesion
        if adhesion.given != "pull_off_force":
            work = adhesion.work_of_adhesion
            if adhesion.given == "surface_energies":
                work = 2.0 * math.sqrt(adhesion.tip_surface_energy * adhesion.sample_surface_energy)
            if self._has_meniscus():
                work = 2.0 * medium.surface_tension
        if work == 0.0:
            return Adhesion(0.0, 0.0, 0.0)
        reach = 9.0 * math.sqrt(3.0) / 16.0 * adhesion.equilibrium_distance
        capture = reach
        if self._has_meniscus():
            kelvin = medium.meniscus_radius
            if kelvin == 0.0:
                volume, heat = medium.molar_volume, GAS * medium.temperature
                kelvin = -medium.surface_tension * volume / (heat * math.log(medium.relative_humidity))
            reach = 2.0 * kelvin
            capture = min(2.0 * medium.film_thickness, reach)
        return Adhesion(float(work), reach, 0.0 if self.is_jkr else capture)

    def over(self, modulus: float | None, work: float | None) -> Oracle:
        """The same scene on a sample of another E [Pa], with another w [J/m2] over the same range."""
        scene = self.scene.copy()
        scene.sample.youngs_modulus = scene.sample.youngs_modulus if modulus is None else modulus
        if work is not None:
            scene.adhesion.given, scene.adhesion.work_of_adhesion = "work_of_adhesion", work
        made = Oracle(scene)
        if work is not None:
            made.adhesion = made.adhesion._replace(work=work)
            made.left = work - made.tail
        return made

    # ---- contact ----

    def contact(self, radius: float | None = None) -> oracle_contact.Contact:
        """With the effective radius of a place [m]."""
        tip = self.scene.tip
        if self.left > 0.0 and not self.is_jkr:
            stress = self.left / self.adhesion.range
            return oracle_contact.Maugis(radius or tip.radius, self.modulus, self.left, stress)
        angle = math.nan
        if tip.shape in ("cone", "blunted", "truncated"):
            angle = oracle_contact.round_angle(int(tip.sides), tip.half_angle)
        if self.left > 0.0:
            return oracle_contact.Jkr(tip.shape, tip.radius, angle, self.modulus, self.left)
        return oracle_contact.Bare(tip.shape, radius or tip.radius, angle, self.modulus)

    def roots(self, radius: float | None = None) -> list[float]:
        """Gaps at which force or radius go as a root, or the force jumps [m]: capture, release, first touch."""
        gaps = [-d for d in self.contact(radius).roots()]
        return [self.adhesion.capture, *gaps] if self.left > 0.0 else gaps

    def values(self, gaps: Any, history: str, radius: float | None = None) -> Values:
        """At gaps [m] that were reached from far away (``"approach"``) or from contact (``"retract"``)."""
        gaps = np.asarray(gaps, dtype=float)
        held = np.asarray(self.contact(radius).values(-gaps))
        if self.left > 0.0 and history == "approach":
            held = np.where(gaps <= self.adhesion.capture, held, 0.0)
        ratio = (radius or self.scene.tip.radius) / self.scene.tip.radius
        terms = [law(gaps) for law in self._beside]
        F, k = (ratio * sum(np.asarray(term[i]) for term in terms) for i in range(2))
        return Values(held[0] + F, held[1] + k, held[2])

    def pull_off(self) -> float:
        """The largest attraction of the whole on the way out [N]."""
        near = np.geomspace(1e-15, 0.1, 2000)
        gaps = np.concatenate([-near[::-1], [0.0], near])
        for _ in range(12):
            total = self.values(gaps, "retract").F
            best = int(np.argmin(total))
            gaps = np.linspace(gaps[max(best - 1, 0)], gaps[min(best + 1, len(gaps) - 1)], 41)
        return -float(total[best])

    # ---- beside contact ----

    def _held(self, law: Callable[[Any], Any]) -> Callable[[Any], Values]:
        """Constant below z0; its slope by a complex step."""
        hold = self.scene.adhesion.equilibrium_distance

        def both(gaps: Any) -> Values:
            value = law(np.maximum(gaps, hold) * (1.0 + 1e-200j))
            slope = -value.imag / (1e-200 * np.maximum(gaps, hold))
            return Values(value.real, np.where(gaps < hold, 0.0, slope), 0.0 * gaps)

        return both

    def _vdw(self, gaps: Any) -> Values:
        """Hamaker's sum over slices, -H/2 Int r(z)^2/z^4 dz, in ln z."""
        tip, H = self.scene.tip, self.scene.adhesion.hamaker_constant
        if H == 0.0 or self.is_jkr:
            return Values(0.0 * gaps, 0.0 * gaps, 0.0 * gaps)
        hold = max(self.adhesion.capture, 1e-12)
        nearest = np.maximum(gaps, hold) + 0.5 * self.scene.sample.roughness + self.scene.adhesion.equilibrium_distance
        R, has_cone = tip.radius, tip.height > 0.0
        top = R * (1.0 - math.sin(tip.half_angle)) if has_cone else 2.0 * R
        parts: list[tuple[float, float, Callable[[Any], Any]]] = [(0.0, top, lambda x: x * (2.0 * R - x))]
        if has_cone:
            wide, slope = R * math.cos(tip.half_angle), math.tan(tip.half_angle)
            parts.append((top, top + tip.height, lambda x: (wide + slope * (x - top)) ** 2))
        F, k = np.zeros(len(gaps)), np.zeros(len(gaps))
        for low, high, square in parts:
            start = np.log(nearest + low)[:, None]
            edges = start + np.log1p((high - low) / (nearest + low))[:, None] * np.linspace(0.0, 1.0, _SLICES + 1)
            half = 0.5 * np.diff(edges, axis=1)[:, :, None]
            log_z = edges[:, :-1, None] + half * (1.0 + _NODES)
            x = low + (nearest + low)[:, None, None] * np.expm1(log_z - start[:, :, None])
            weight = square(np.clip(x, low, high)) * np.exp(-3.0 * log_z) * _WEIGHTS * half
            F -= 0.5 * H * weight.sum(axis=(1, 2))
            k -= 2.0 * H * (weight * np.exp(-log_z)).sum(axis=(1, 2))
        return Values(F, np.where(gaps < hold, 0.0, k), 0.0 * F)

    def _electrostatic(self, h: Any) -> Any:
        tip, sample = self.scene.tip, self.scene.sample
        if "no" in (tip.conducting, sample.conducting, sample.grounded) or self.scene.medium.kind == "liquid":
            return 0.0 * h
        U, R = self.scene.adhesion.contact_potential, tip.radius
        if tip.work_function > 0.0 and sample.work_function > 0.0:
            U += tip.work_function - sample.work_function
        if tip.height == 0.0:
            return -math.pi * EPSILON * U**2 * R**2 / (h * (h + R))
        angle, L = tip.half_angle, tip.height
        c = R * (1.0 - math.sin(angle))
        x1 = h + c
        edge = R * math.cos(angle) ** 2 / math.sin(angle)
        # Int_0^L (t + edge)/(x1 + t)^2 dt of the elements of the cone, of which nothing cancels
        half = 0.5 * np.log1p(L / x1)[:, None, None] / _SLICES
        grown = np.expm1(half * (2.0 * np.arange(_SLICES)[:, None] + 1.0 + _NODES))
        elements = (grown + edge / x1[:, None, None]) / (1.0 + grown)
        cone = (elements * half * _WEIGHTS).sum(axis=(1, 2)) / math.log(math.tan(0.5 * angle)) ** 2
        return -math.pi * EPSILON * U**2 * (R * c / (h * x1) + cone)

    def _charge(self, h: Any) -> Any:
        """A charge q and its image -q R/d at R^2/d from the centre."""
        tip, q = self.scene.tip, self.scene.sample.charge
        if tip.conducting == "no" or self.scene.medium.kind == "liquid" or q == 0.0:
            return 0.0 * h
        R, d = tip.radius, tip.radius + h
        between = h * (h + 2.0 * R) / d
        return -(q**2) * R / d / (4.0 * math.pi * EPSILON * between**2)

    def _double_layer(self, h: Any) -> Any:
        medium = self.scene.medium
        if medium.kind != "liquid" or medium.ionic_strength == 0.0:
            return 0.0 * h

        def potential(body: Any) -> float:
            by_ph = medium.potential_per_ph * (body.isoelectric_point - medium.ph)
            return float(by_ph if medium.ph > 0.0 else body.surface_potential)

        one, other = potential(self.scene.tip), potential(self.scene.sample)
        permittivity = EPSILON * medium.relative_permittivity
        per_volume = 2.0 * AVOGADRO * medium.ionic_strength * CHARGE**2
        kappa = math.sqrt(per_volume / (permittivity * BOLTZMANN * medium.temperature))
        e = np.exp(-kappa * h)
        plus = (one + other) ** 2 * e / (1.0 + e)
        minus = (one - other) ** 2 * e / -np.expm1(-kappa * h)
        return math.pi * permittivity * kappa * self.scene.tip.radius * (plus - minus)

    def _hydration(self, h: Any) -> Any:
        medium = self.scene.medium
        if medium.kind != "liquid":
            return 0.0 * h
        return 2.0 * math.pi * self.scene.tip.radius * medium.hydration_energy * np.exp(-h / medium.hydration_length)

    def _brush(self, h: Any) -> Any:
        medium, T = self.scene.medium, self.scene.medium.brush_thickness
        if medium.kind != "liquid" or self.scene.adhesion.equilibrium_distance >= T:
            return 0.0 * h
        t = np.where(h.real < T, h / T, 1.0 + 0.0j)
        work = T * (0.8 * (t**-1.25 - 1.0) - 4.0 / 7.0 * (1.0 - t**1.75))
        return 2.0 * math.pi * self.scene.tip.radius * BOLTZMANN * medium.temperature / medium.brush_spacing**3 * work

    def _yukawa(self, h: Any) -> Any:
        """Slices of the sphere at h + t in a field W/l^2 exp(-z/l)."""
        medium, R = self.scene.medium, self.scene.tip.radius
        W, decay = medium.yukawa_energy, medium.yukawa_length
        if W == 0.0 or decay == 0.0:
            return 0.0 * h
        half = min(R, 25.0 * decay) / _SLICES
        t = half * (2.0 * np.arange(_SLICES)[:, None] + 1.0 + _NODES)
        slices = math.pi * t * (2.0 * R - t) * np.exp(-t / decay) * half * _WEIGHTS
        return W / decay**2 * slices.sum() * np.exp(-h / decay)

    def _custom(self, name: str, gaps: Any) -> Values:
        """A law of one's own, by its own function."""
        hold = self.scene.adhesion.equilibrium_distance
        law = np.vectorize(functools.partial(self.scene.term_force, name), otypes=[float])
        h = np.maximum(gaps, hold)
        k = (law(h * (1.0 - 1e-5)) - law(h * (1.0 + 1e-5))) / (2e-5 * h)
        return Values(law(h), np.where(gaps < hold, 0.0, k), 0.0 * h)
