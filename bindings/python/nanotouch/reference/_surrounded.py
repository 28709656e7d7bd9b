# SPDX-License-Identifier: BSD-3-Clause
"""Adhesive contact with other laws around it: one gap, one pressure. Where the surface follows the tip, Abel's
transform of the pressure is known. From there to the end of adhesion at gap h0 the pressure is -w/h0 (Maugis 1992).
Outside it is that of the laws, which act from there on, at h0 as at the interatomic distance. It shares no code with
plans.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from nanotouch._arrays import Floats
from nanotouch.errors import SolverError
from nanotouch.reference._deformation import WIDEST
from nanotouch.reference._half_space import NODES, Mesh
from nanotouch.reference._pressures import Pressure

_FADED = 1e-8  # of the energy: the mesh goes so far
_OCTAVES = 1.25  # from panel to panel
_FIRST = 0.05  # of the width of adhesion: the first panel outside it


class Touching(NamedTuple):
    """One equilibrium in contact."""

    contact_radius: float
    """[m]"""
    cohesive_radius: float
    """where adhesion ends [m]"""
    gap: float
    """h of the undeformed bodies [m]"""
    force: float
    """on the tip, + repulsive [N]"""


class Surrounded:
    """The contact of a paraboloid; `law` over the gap, with its value at the interatomic distance at h0."""

    def __init__(self, law: Pressure, radius: float, effective_modulus: float, work: float, end_gap: float) -> None:
        self.law, self.R, self.E, self.w, self.h0 = law, radius, effective_modulus, work, end_gap
        self._reach, self._width = self._far(), 2.0 * radius * end_gap
        self.release: Touching | None = None

    def touching(self, contact_radius: float) -> Touching:
        """At a radius of contact [m]: the width of adhesion by the gap at its end."""
        from scipy.optimize import brentq

        def excess(log_width: float) -> float:
            return self._solve(contact_radius, math.exp(log_width))[1] / self.h0 - 1.0

        low = high = math.log(self._width)
        step = 0.05
        while excess(low) > 0.0:
            low, step = low - step, 2.0 * step
        while excess(high) < 0.0:
            high, step = high + step, 2.0 * step
        self._width = math.exp(brentq(excess, low, high, xtol=1e-9))
        return self._solve(contact_radius, self._width)[0]

    def find_release(self, near: float) -> Touching:
        """Where contact lets go under grips: the largest gap, by golden sections over the radius, from one near it."""
        from scipy.optimize import minimize_scalar

        found = minimize_scalar(
            lambda log_radius: -self.touching(math.exp(log_radius)).gap / self.R * 1e6,
            bracket=(math.log(near), math.log(0.9 * near)), method="golden", options={"xtol": 1e-3},
        )  # fmt: skip
        self.release = self.touching(math.exp(float(found.x)))
        return self.release

    def at(self, gap: float) -> Touching:
        """At a gap [m] below that of release, where contact holds."""
        from scipy.optimize import brentq

        assert self.release is not None
        low = high = math.log(self.release.contact_radius)
        while self.touching(math.exp(high)).gap > gap:
            low, high = high, high + 0.2

        def excess(log_radius: float) -> float:
            return (self.touching(math.exp(log_radius)).gap - gap) / self.h0

        return self.touching(math.exp(brentq(excess, low, high, xtol=1e-9)))

    def _far(self) -> float:
        at_end = abs(float(self.law.energy(np.array([self.h0]))[0]))
        rise = self.h0
        while abs(float(self.law.energy(np.array([self.h0 + rise]))[0])) > _FADED * at_end and rise < WIDEST * self.R:
            rise *= 1.2
        return rise

    def _edges(self, a: float, width: float) -> Floats:
        far = 2.0 * self.R * self._reach + a * a + 4.0 * width
        count = max(4, math.ceil(math.log2(far / (_FIRST * width)) / _OCTAVES))
        return np.concatenate([[0.0, width], width + np.geomspace(_FIRST * width, far, count + 1)])

    def _inside(self, a: float, x: Floats, h: float) -> Floats:
        """What the pressure in contact does outside."""
        square = a * a + x
        arc = np.arcsin(np.minimum(a / np.sqrt(square), 1.0))
        return np.asarray(2.0 / np.pi * ((-h - square / (2.0 * self.R)) * arc + a / (2.0 * self.R) * np.sqrt(x)))

    def _solve(self, a: float, width: float) -> tuple[Touching, float]:
        """For a width of adhesion, r^2 - a^2 [m^2]; the gap where it ends [m]."""
        mesh, R = Mesh(self._edges(a, width), self.E, a), self.R
        x, count, outside = mesh.x, mesh.x.size, np.arange(mesh.x.size) >= NODES
        adhesion = np.where(outside, 0.0, -self.w / self.h0)
        slope_h = -2.0 / np.pi * np.arcsin(np.minimum(a / np.sqrt(a * a + x), 1.0))
        h = -(a * a / R + 2.0 / self.E * float(mesh.B0 @ adhesion))
        g = np.maximum(h + (a * a + x) / (2.0 * R) + self._inside(a, x, h) + mesh.K @ adhesion, self.h0)
        A = np.empty((count + 1, count + 1))
        for _ in range(80):
            p = adhesion + np.where(outside, self.law.pressure(g), 0.0)
            slope = np.where(outside, self.law.slope(g), 0.0)
            A[:-1, :-1] = np.eye(count) - mesh.K * slope
            A[:-1, -1], A[-1, :-1], A[-1, -1] = -1.0 - slope_h, -2.0 / self.E * mesh.B0 * slope, -1.0
            lift = h + (a * a + x) / (2.0 * R) + self._inside(a, x, h) + mesh.K @ p - g
            step = np.linalg.solve(A, np.append(lift, h + a * a / R + 2.0 / self.E * float(mesh.B0 @ p)))
            ahead = min(1.0, 0.7 / max(float(np.max(np.where(outside, -step[:-1] / g, 0.0))), 0.7))
            g, h = g + ahead * step[:-1], h + ahead * float(step[-1])
            if np.abs(step[:-1]).max() < 1e-12 * (np.abs(g).max() + abs(h)):
                break
        else:
            raise SolverError(f"no equilibrium at a contact radius of {a:g} m")
        q = mesh.B @ (adhesion + np.where(outside, self.law.pressure(g), 0.0))
        force = 2.0 * self.E * a * (-h - a * a / (3.0 * R)) + 4.0 * float(mesh.weight @ q)
        force += 2.0 * np.pi * R * float(self.law.energy(g[-1:])[0])
        return Touching(a, math.sqrt(a * a + width), h, force), self._end_gap(mesh, q, h, width)

    def _end_gap(self, mesh: Mesh, q: Floats, h: float, width: float) -> float:
        """U(r) = 4/(pi E*) Int q dt/sqrt(r^2 - t^2) at the edge itself."""
        tau = mesh.t**2 - mesh.a**2
        inside = np.arange(tau.size) < tau.size // (mesh.edges.size - 1)
        u = 4.0 / (np.pi * self.E) * float(np.sum((mesh.weight * q)[inside] / np.sqrt(width - tau[inside])))
        rim = float(self._inside(mesh.a, np.array([width]), h)[0])
        return h + (mesh.a**2 + width) / (2.0 * self.R) + rim + u
