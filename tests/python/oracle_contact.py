# SPDX-License-Identifier: BSD-3-Clause
"""Contact laws for :mod:`oracle`, by bisection of the textbooks' parametric forms; force, stiffness and radius at
indentations, with the indentations at which they go as a root."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

import numpy as np


class Values(NamedTuple):
    """Force [N], stiffness [N/m], contact radius [m]; each an array."""

    F: Any
    k: Any
    a: Any


class Contact(Protocol):
    """A law of the indentation d [m]."""

    def values(self, d: Any) -> Values: ...

    def roots(self) -> list[float]: ...


def round_angle(sides: int, angle: float) -> float:
    """Half-angle of the cone in place of a pyramid of 0 (round), 3 or 4 sides."""
    factor = {0: 2.0 / math.pi, 3: 0.87960, 4: 0.73762}[sides]
    return math.atan(0.5 * math.pi * factor * math.tan(angle))


def bisect(rising: Callable[[Any], Any], target: Any, low: float, high: float) -> Any:
    """Where a rising function has its targets (n,)."""
    below, above = np.full_like(target, low), np.full_like(target, high)
    for _ in range(62):
        middle = 0.5 * (below + above)
        short = rising(middle) < target
        below, above = np.where(short, middle, below), np.where(short, above, middle)
    return above


class Maugis:
    """Maugis 1992, Eqs. for a and m = c/a, in theta = acos(1/m): explicit in it but for the root of a square.

    lambda c^2/2 f1 + 4/3 lambda^2 c f2 = 1    f1 = sin(2 theta)/2 - theta cos(2 theta)   f2 = theta sin + cos - 1
    a = c cos    P = a^3 - lambda c^2 (sin(2 theta)/2 + theta)    d = a^2 - 4/3 lambda c sin
    """

    def __init__(self, radius: float, modulus: float, work: float, stress: float) -> None:
        K = 4.0 / 3.0 * modulus
        self.stress_number = 2.0 * stress * (radius / (math.pi * work * K**2)) ** (1.0 / 3.0)
        self.a_unit = (math.pi * work * radius**2 / K) ** (1.0 / 3.0)
        self.units = math.pi * work * radius, self.a_unit**2 / radius
        slope = self._state(np.array([30.0]))[4]  # of d at a = 0
        self.fold = 30.0
        if slope[0] > 0.0:
            self.fold = float(bisect(lambda x: self._state(x)[4], np.zeros(1), -75.0, 30.0)[0])

    def _state(self, x: Any) -> tuple[Any, ...]:
        """a, P, d, dP, dd by theta for x = ln tan theta; reduced."""
        lam, tangent = self.stress_number, np.exp(x)
        theta, hyp = np.arctan(tangent), np.hypot(1.0, tangent)
        cos, sin = 1.0 / hyp, tangent / hyp
        sin2, cos2, u2 = 2.0 * sin * cos, (1.0 - tangent) * (1.0 + tangent) / hyp**2, (2.0 * theta) ** 2
        series, term = np.zeros_like(x), 2.0 * theta * u2 / 6.0  # sin u - u cos u = Sum (-1)^n 2n u^(2n+1)/(2n+1)!
        for n in range(1, 9):
            series, term = series + 2 * n * term, -term * u2 / ((2 * n + 2) * (2 * n + 3))
        f1 = np.where(theta < 0.25, 0.5 * series, 0.5 * sin2 - theta * cos2)
        f2 = theta * sin - tangent * tangent / (hyp * (1.0 + hyp))
        B = 4.0 / 3.0 * lam**2 * f2
        root = np.sqrt(B * B + 2.0 * lam * f1)
        c = 2.0 / (B + root)
        c1 = -(lam * c * c * theta * sin2 + 4.0 / 3.0 * lam**2 * c * theta * cos) / root
        a, a1, zone = c * cos, c1 * cos - c * sin, 0.5 * sin2 + theta
        P1 = 3.0 * a * a * a1 - lam * c * (2.0 * c1 * zone + c * 2.0 * cos * cos)
        d1 = 2.0 * a * a1 - 4.0 / 3.0 * lam * (c1 * sin + c * cos)
        return a, a**3 - lam * c * c * zone, a * a - 4.0 / 3.0 * lam * c * sin, P1, d1, a1

    def _ends(self) -> tuple[float, float]:
        """Reduced indentations where contact begins, and where the stress lets go."""
        begin, lam = float(self._state(np.array([self.fold]))[2][0]), self.stress_number
        if self.fold < 30.0:
            return begin, begin
        return begin, -2.0 / (math.pi * lam) - 0.5 * (8.0 * lam / (3.0 * math.pi)) ** 2

    def roots(self) -> list[float]:
        return [end * self.units[1] for end in self._ends()]

    def values(self, d: Any) -> Values:
        reduced, lam = np.asarray(d) / self.units[1], self.stress_number
        begin, release = self._ends()
        x = bisect(lambda at: -self._state(at)[2], -np.maximum(reduced, begin), -75.0, self.fold)
        a, P, at, P1, d1, a1 = self._state(x)
        rest = np.maximum(reduced, begin) - at
        with np.errstate(divide="ignore", invalid="ignore"):
            k, F, a = P1 / d1, P + P1 / d1 * rest, a + a1 / d1 * rest
        fold = 8.0 * lam / (3.0 * math.pi)
        beyond = np.sqrt(np.maximum(fold**2 + 2.0 * (reduced + 2.0 / (math.pi * lam)), 1e-300))
        apart, held = reduced < begin, reduced >= release
        F = np.where(apart, -0.5 * math.pi * lam * (fold + beyond) ** 2, F)
        k = np.where(apart, -math.pi * lam * (fold + beyond) / beyond, k)
        force, length = self.units
        return Values(
            np.where(held, F * force, 0.0),
            np.where(held, k * force / length, 0.0),
            np.where(apart, 0.0, a * self.a_unit),
        )


class Bare:
    """Sneddon's d = a Int f'/sqrt(a^2 - r^2) dr, F = 2 E* Int r^2 f'/sqrt(a^2 - r^2) dr, k = 2 E* a"""

    def __init__(self, shape: str, radius: float, angle: float, modulus: float) -> None:
        self.shape, self.radius, self.modulus = shape, radius, modulus
        self.flank = 0.0 if math.isnan(angle) else 1.0 / math.tan(angle)

    def roots(self) -> list[float]:
        return [0.0]

    def profile(self, a: Any) -> tuple[Any, Any]:
        """d and F/(2 E*) at a contact radius."""
        R, flank = self.radius, self.flank
        if self.shape == "paraboloid":
            return a * a / R, 2.0 / 3.0 * a**3 / R
        if self.shape == "cone":
            return 0.5 * math.pi * flank * a, 0.25 * math.pi * flank * a * a
        cut = R if self.shape == "truncated" else R * flank
        a = np.maximum(a, cut)
        s, arc = np.sqrt((a - cut) * (a + cut)), np.arccos(np.minimum(cut / a, 1.0))
        arc = np.arctan2(s, cut)
        depth, load = flank * a * arc, flank * (0.5 * a * a * arc + 0.5 * cut * s)
        if self.shape == "blunted":
            depth = depth + a * (cut * cut / (a + s)) / R
            load = load + (2.0 * a**3 / 3.0 - a * a * s + s**3 / 3.0) / R
        return depth, load

    def _sphere(self, deep: Any) -> tuple[Any, Any]:
        """a = R tanh u: d = R u tanh u, F = E* R^2 (u - tanh u + u tanh^2 u)."""
        u = np.exp(bisect(lambda x: np.exp(x) * np.tanh(np.exp(x)), deep / self.radius, -350.0, 20.0))
        t = np.tanh(u)
        series = sum(t ** (2 * n + 1) / (2 * n + 1) for n in range(1, 9))  # of artanh t - t
        return self.radius * t, 0.5 * self.radius**2 * (np.where(t < 0.1, series, u - t) + u * t * t)

    def values(self, d: Any) -> Values:
        d = np.asarray(d)
        deep, R, shape = np.maximum(d, 1e-300), self.radius, self.shape
        if shape == "punch":
            a, load = np.full_like(deep, R), R * deep
        elif shape == "sphere":
            a, load = self._sphere(deep)
        else:
            a = np.exp(bisect(lambda x: self.profile(np.exp(x))[0], deep, -350.0, 20.0))
            depth, load = self.profile(a)
            load = load + a * (deep - depth)
            if shape == "blunted":
                cap = deep < R * self.flank**2
                a = np.where(cap, np.sqrt(R * deep), a)
                load = np.where(cap, 2.0 / 3.0 * a**3 / R, load)
        inside = d > 0.0
        return Values(
            *(np.where(inside, value, 0.0) for value in (2.0 * self.modulus * load, 2.0 * self.modulus * a, a))
        )


class Jkr(Bare):
    """Maugis and Barquins 1978: a bare shape less a flat punch of sqrt(2 pi a w/E*)."""

    def __init__(self, shape: str, radius: float, angle: float, modulus: float, work: float) -> None:
        super().__init__(shape, radius, angle, modulus)
        self.work = work
        self.least = radius if shape == "punch" else 2.0 * work / (math.pi * modulus * self.flank**2)

    def _state(self, a: Any) -> tuple[Any, Any, Any]:
        E, w = self.modulus, self.work
        d = 0.5 * math.pi * self.flank * a - np.sqrt(2.0 * math.pi * a * w / E)
        F = 0.5 * math.pi * self.flank * E * a * a - np.sqrt(8.0 * math.pi * E * w * a**3)
        slope = 0.5 * math.pi * self.flank - np.sqrt(0.5 * math.pi * w / (E * a))
        with np.errstate(divide="ignore"):
            k = (math.pi * self.flank * E * a - 1.5 * np.sqrt(8.0 * math.pi * E * w * a)) / slope
        return d, F, k

    def roots(self) -> list[float]:
        if self.shape == "punch":
            return [-math.sqrt(2.0 * math.pi * self.radius * self.work / self.modulus)]
        return [float(self._state(np.array([self.least]))[0][0])]

    def values(self, d: Any) -> Values:
        d = np.asarray(d)
        fold = self.roots()[0]
        held = d >= fold
        if self.shape == "punch":
            k = 2.0 * self.modulus * self.radius
            return Values(np.where(held, k * d, 0.0), np.where(held, k, 0.0), np.where(held, self.radius, 0.0))
        low = math.log(self.least)
        target = np.maximum(d, fold)
        a = np.exp(bisect(lambda x: self._state(np.exp(x))[0], target, low, low + 80.0))
        at, F, k = self._state(a)
        return Values(*(np.where(held, value, 0.0) for value in (F + k * (target - at), k, a)))
