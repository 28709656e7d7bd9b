# SPDX-License-Identifier: BSD-3-Clause
"""An adhesive contact with laws around it, by rings: a rigid paraboloid on an elastic half-space, -sigma0 as far as the
gap is h0 (Maugis 1992), the pressure of the laws outside.

In contact the pressure is unknown at nodes in s = sqrt(1 - r^2/a^2), and vanishes as s beside -sigma0; outside Newton
finds the gaps. The kernel is the elliptic integral of `rings_oracle.py`, on panels that crowd at both rims; the uniform
-sigma0 is Johnson's disk (1985, Eq. 3.29). Nothing of the library, and no transform of Abel.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from rings_oracle import _INVERSE, _N, _W, _WY, _X, _Y
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk, ellipkm1


class Touching(NamedTuple):
    """At a radius of contact: gap of undeformed bodies [m], force [N], sqrt(c^2/a^2 - 1) of the end of adhesion."""

    gap: float
    force: float
    width: float


def _nodes(edges):
    low, high = edges[:-1, None], edges[1:, None]
    return (low + (high - low) * (_X + 1) / 2).ravel(), ((high - low) * _W / 2).ravel()


def _matrix(targets, edges, kernel, place):
    """Int f(v) kernel(t, v) dv at targets, f a polynomial on each panel; `place`: the v that a target has."""
    parts, t = [], targets[:, None]
    for low, high in pairwise(edges):
        start, part = np.clip(place(targets), low, high)[:, None], np.zeros((len(targets), _N))
        for end in (low, high):
            v, weight = start + (end - start) * _Y**4, np.abs(end - start) * 4 * _Y**3 * _WY
            values = np.where(weight > 0, kernel(t, v, (end - start) * _Y**4, start) * weight, 0.0)
            shape = np.polynomial.legendre.legvander((2 * v - low - high) / (high - low), _N - 1) @ _INVERSE
            part += np.einsum("ik,ikn->in", values, shape)
        parts.append(part)
    return np.hstack(parts)


def _ring(t, r, apart):
    return ellipkm1(np.maximum((apart / (t + r)) ** 2, 1e-300)) / (t + r) * 4 / np.pi


def _outside(t, r, dr, start):
    return r * _ring(t, r, np.where(np.abs(start - t) < 1e-13 * t, dr, r - t))


def _inside(t, s, ds, start):
    own = (t <= 1) & (np.abs(start**2 - (1 - t * t)) < 1e-13)
    r = np.sqrt(np.maximum(1 - s * s, 0.0))
    square = np.where(own, -ds * (2 * start + ds), 1 - s * s - t * t)
    return s * s * _ring(t, r, np.abs(square) / np.maximum(r + t, 1e-300))


def _disk(r, c):
    """u E*/p of an even pressure p on r < c."""
    near, far = np.minimum(r / c, 1.0), np.minimum(c / np.maximum(r, c), 1.0) ** 2
    beyond = np.where(r > c, far, 0.5)
    outer = 4 * r / np.pi * (ellipe(beyond) - (1 - beyond) * ellipk(beyond))
    return np.where(r > c, outer, 4 * c / np.pi * ellipe(near**2))


class AdhesiveRings:
    """Radii in units of the contact's."""

    def __init__(self) -> None:
        self.edges = np.concatenate([[0.0], 2.0 ** np.arange(-11, 0), [0.75, 1.0]])
        s, w = _nodes(self.edges)
        self.r, self.load = np.append(np.sqrt(1 - s**2), 1.0), 2 * np.pi * w * s**2
        self.inverse = np.linalg.inv(np.hstack([self._at(self.r), np.ones((len(self.r), 1))]))

    def _at(self, r):
        return _matrix(np.asarray(r, float), self.edges, _inside, lambda t: np.sqrt(np.maximum(1 - t * t, 0.0)))

    def touching(self, law, a, radius, modulus, stress, end, reach):
        """With contact radius a; `law` is pressure and slope from the gap `end` on, felt up to the gap `reach` [m]."""

        def excess(m):
            return self._solve(law, a, radius, modulus, stress, end, reach, m)[0]

        m = np.geomspace(2e-3, 60, 40)
        alone = [self._solve(None, a, radius, modulus, stress, end, reach, width)[0] for width in m]
        low, high = next((m[i], m[i + 1]) for i in range(len(m) - 1) if alone[i + 1] > 0)
        while excess(low) > 0:
            low /= 1.3
        while excess(high) < 0:
            high *= 1.3
        return self._solve(law, a, radius, modulus, stress, end, reach, brentq(excess, low, high, rtol=1e-10))[1]

    def _solve(self, law, a, radius, modulus, stress, end, reach, m):
        c, far = np.sqrt(1 + m * m), np.sqrt(2 * radius * reach + a * a) / a
        edges = [c, c + 0.12 * (c - 1)]
        while edges[-1] < max(far, 1.5 * c, 7 * c - 6):
            edges.append(edges[-1] + min(1.7 * (edges[-1] - edges[-2]), 0.35 * edges[-1]))
        r, w = _nodes(np.array(edges)) if law else (np.zeros(0), np.zeros(0))
        targets, unit = np.append(c, r), a / modulus
        under = self.r**2 * a * a / (2 * radius) - stress * unit * _disk(self.r, c)
        first, answer = self.inverse @ -under, np.zeros((len(self.inverse), len(r)))
        spread = np.zeros((len(targets), len(r)))
        if law:
            answer = self.inverse @ -_matrix(self.r, np.array(edges), _outside, lambda t: t) * unit
            spread = unit * _matrix(targets, np.array(edges), _outside, lambda t: t)
        inner = np.hstack([self._at(targets), np.ones((len(targets), 1))])
        base = inner @ first + a * a * targets**2 / (2 * radius) - stress * unit * _disk(targets, c)
        p = _pressures(law, base[1:], (spread + inner @ answer)[1:], end) if law else np.zeros(0)
        solution, gap = first + answer @ p, base[0] + (spread + inner @ answer)[0] @ p
        force = a * modulus * (self.load @ solution[:-1]) + a * a * (2 * np.pi * (w * r) @ p - stress * np.pi * c * c)
        return gap / end - 1, Touching(solution[-1], force, m)


def _pressures(law, base, spread, end):
    """g = base + spread p(g) by Newton; inside `end` the law stays."""
    g = np.maximum(base, end)
    for _ in range(100):
        p, slope = law(np.maximum(g, end))
        slope = np.where(g < end, 0.0, slope)
        step = np.linalg.solve(np.eye(len(g)) - spread * slope, g - base - spread @ p)
        g = g - step * min(1.0, np.min(0.7 * np.abs(g) / np.maximum(step, 1e-300)))
        if np.max(np.abs(step) / np.abs(g)) < 1e-9:
            return law(np.maximum(g, end))[0]
    raise ArithmeticError("Newton does not come to an end")
