# SPDX-License-Identifier: BSD-3-Clause
"""A rigid paraboloid before an elastic half-space that deforms under any pressure of the gap, by rings.

The kernel of rings is the complete elliptic integral of Johnson, Contact Mechanics (1985), Sec. 3.8. It is integrated
over Legendre polynomials on panels with a substitution that takes its logarithm out. No transform of Abel, no adaptive
mesh, nothing of the library: a second source beside `nanotouch.reference.Deformation`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.special import ellipkm1

_N = 8  # nodes a panel
_X, _W = np.polynomial.legendre.leggauss(_N)
_Y, _WY = np.polynomial.legendre.leggauss(28)
_Y, _WY = (_Y + 1) / 2, _WY / 2
_INVERSE = np.linalg.inv(np.polynomial.legendre.legvander(_X, _N - 1))

Law = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Pressure and its slope at gaps [Pa, Pa/m]."""


class State(NamedTuple):
    """One equilibrium: gap of undeformed bodies [m], force [N], stiffness [N/m], displacement under the apex [m]."""

    gap: float
    force: float
    stiffness: float
    displacement: float


def _ring(t, s, apart):
    return s / (t + s) * ellipkm1(np.maximum((apart / (t + s)) ** 2, 1e-300))


class Rings:
    """Panels of one width out to `extent`, then growing to 2000; radii in units of any length."""

    def __init__(self, width: float = 0.8, extent: float = 12.0, ratio: float = 0.24) -> None:
        edges = list(np.arange(0.0, extent + width / 2, width))
        while edges[-1] < 2e3:
            edges.append(edges[-1] + max(width, ratio * edges[-1]))
        low, high = np.array(edges[:-1]), np.array(edges[1:])
        self.r = (low[:, None] + (high - low)[:, None] * (_X + 1) / 2).ravel()
        self.w = ((high - low)[:, None] * _W / 2).ravel()
        targets = np.append(0.0, self.r)
        kernel = np.zeros((len(targets), len(self.r)))
        for j, (a, b) in enumerate(zip(low, high, strict=True)):
            part = slice(j * _N, j * _N + _N)
            near = np.maximum(a - targets, targets - b) < 2.5 * (b - a)
            t = targets[~near, None]
            kernel[~near, part] = self.w[part] * _ring(t, self.r[part], self.r[part] - t)
            kernel[near, part] = _near(targets[near], a, b)
        self.under, self.kernel = kernel[0] * 4 / np.pi, kernel[1:] * 4 / np.pi

    def state(self, law: Law, radius: float, modulus: float, length: float, centre: float) -> State:
        """With a gap `centre` left under the apex; `length` over which the pressure falls [m]."""
        scale = np.sqrt(2 * radius * length)
        under = self.under * scale / modulus
        lifted = self.kernel * scale / modulus - under
        base = centre + (self.r * scale) ** 2 / (2 * radius)
        g, one = base.copy(), np.eye(len(base))
        for _ in range(60):
            p, slope = law(g)
            step = np.linalg.solve(one - lifted * slope, g - base - lifted @ p)
            g = g - step * min(1.0, 2 * length / max(step.max(), 1e-300))
            if np.max(np.abs(step) / g) < 1e-11:
                break
        else:
            raise ArithmeticError("Newton does not come to an end")
        p, slope = law(g)
        tangent = slope * np.linalg.solve(one - lifted * slope, np.ones(len(base)))
        area = 2 * np.pi * self.w * self.r * scale**2
        return State(centre - under @ p, area @ p, -(area @ tangent) / (1 - under @ tangent), under @ p)


def _near(targets, a, b):
    """Rings of a panel at targets in or beside it: the logarithm goes with the fourth power."""
    part = np.zeros((len(targets), _N))
    start = np.clip(targets, a, b)[:, None]
    t = targets[:, None]
    for end in (a, b):
        s = start + (end - start) * _Y**4
        weight = np.abs(end - start) * 4 * _Y**3 * _WY
        values = np.where(s > 0, _ring(t, s + 1e-280, (end - start) * _Y**4 + start - t), 0.0) * weight
        shape = np.polynomial.legendre.legvander((2 * s - a - b) / (b - a), _N - 1) @ _INVERSE
        part += np.einsum("ik,ikn->in", values, shape)
    return part
