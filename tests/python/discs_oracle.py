# SPDX-License-Identifier: BSD-3-Clause
"""A rigid paraboloid before and on an elastic half-space, by discs: the pressure is piecewise linear, a sum of discs of
even pressure (Johnson, Contact Mechanics, 1985, Eq. 3.29: elliptic integrals). In contact the pressure is unknown, then
-sigma0 as far as the gap is h0 (Maugis 1992), and that of a law outside, as far as it is felt. Two meshes and
Richardson tell what it is worth. Nothing of the library, no transform, no polynomials.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipkm1

_X, _W = np.polynomial.legendre.leggauss(6)
_NEAR, _NEAR_W = np.polynomial.legendre.leggauss(16)


class State(NamedTuple):
    """Gap of the undeformed bodies [m], force [N], radius of contact [m]."""

    gap: float
    force: float
    radius: float


def disc(r, a):
    """u E* at r under an even pressure of 1 on r < a."""
    r, a = np.broadcast_arrays(np.asarray(r, float), np.asarray(a, float))
    inner = 4 * a / np.pi * ellipe(np.minimum(r / np.maximum(a, 1e-300), 1) ** 2)
    far = np.maximum(r, a)
    rest = np.clip((far - a) * (far + a) / far**2, 1e-300, 1)
    outer = 4 * r / np.pi * (ellipe(1 - rest) - rest * ellipkm1(rest))
    return np.where(r <= a, inner, outer)


def edge(n, length, scale):
    """Distances from an edge: as squares at first, for its root, then as powers."""
    return scale * np.sinh(np.arcsinh(np.sqrt(length / scale)) * np.linspace(0, 1, n + 1)) ** 2


class Mesh:
    """u = A p/E* at nodes r; F = load . p."""

    def __init__(self, r):
        self.r, length = r, np.diff(r)
        a = r[:-1, None] + length[:, None] * (_X + 1) / 2
        sums = sum(disc(r[:, None], a[None, :, i]) * _W[i] / 2 for i in range(len(_X)))
        t = (_NEAR + 1) / 2
        for i in range(len(r)):
            for e in (i - 1, i):
                if 0 <= e < len(length):
                    at = r[e] + length[e] * (t**3 if e == i else 1 - t**3)
                    sums[i, e] = np.sum(disc(r[i], at) * _NEAR_W / 2 * 3 * t**2)
        rings = np.pi * (r[1:] ** 3 - r[:-1] ** 3) / 3 / length
        self.A, self.load = np.zeros((len(r), len(r))), np.zeros(len(r))
        for to, sign in ((slice(None, -1), 1), (slice(1, None), -1)):
            self.A[:, to] += sign * sums
            self.load[to] += sign * rings
        self.A[:, -1] += disc(r, r[-1])
        self.load[-1] += np.pi * r[-1] ** 2


def apart(law, gaps, radius, modulus, far, n=160):
    """Forces, and gaps under the apex, at gaps from far inwards; a law (pressure, slope) is felt up to `far`."""
    mesh = Mesh(np.sqrt(2 * radius * far) * np.sinh(3 * np.linspace(0, 1, n + 1)) / np.sinh(3))
    x, spread, found = mesh.r**2 / (2 * radius), mesh.A / modulus, []
    g = gaps[0] + x
    for h in gaps:
        for _ in range(60):
            p, slope = law(g)
            step = np.linalg.solve(np.eye(n + 1) - spread * slope, g - h - x - spread @ p)
            g = g - step * min(1.0, np.min(0.6 * g / np.maximum(step, 1e-300)))
            if np.max(np.abs(step) / g) < 1e-10:
                break
        found.append((mesh.load @ law(g)[0], g[0]))
    return np.array(found).T


class Contact:
    """Where adhesion ends at c = width times the radius of contact."""

    def __init__(self, width, reach, n):
        a, scale = 1 / width, min(0.5, 0.5 * (width - 1))
        t = np.linspace(0, 1, n // 2 + 1)
        inner = a - edge(n, a, scale * a)[::-1]
        inner[0], inner[-1] = 0.0, a
        ring = a + (1 - a) * t**2 / (t**2 + (1 - t) ** 2)
        self.mesh = Mesh(np.concatenate([inner, ring[1:], 1 + edge(n, reach - 1, scale)[1:]]))
        self.inner, self.end = n, n + n // 2

    def at(self, c, law, radius, modulus, stress, range_):
        """At c [m]: the gap that is left there over h0, less 1, and the state."""
        m, i, e = self.mesh, self.inner, self.end
        r, spread, x = m.r * c, m.A * c / modulus, (m.r * c) ** 2 / (2 * radius)
        held = law(np.array([range_]))[0][0]
        step = -stress - held
        under, rows = step * disc(m.r, 1.0) * c / modulus, np.r_[0 : i + 1, e + 1 : len(r)]
        p, h, g = np.zeros(i), -x[i], range_ + x[e + 1 :] - x[e]
        for _ in range(60):
            outer, slope = law(g)
            q = np.concatenate([p - step, np.full(e - i + 1, held), outer])
            u = (spread @ q + under + x + h)[rows]
            u[i + 1 :] -= g
            J = np.hstack([spread[rows, :i], np.ones((len(rows), 1)), spread[rows, e + 1 :] * slope])
            J[i + 1 :, i + 1 :] -= np.eye(len(g))
            d = np.linalg.solve(J, -u)
            share = min(1.0, np.min(0.6 * g / np.maximum(-d[i + 1 :], 1e-300)))
            p, h, g = p + share * d[:i], h + share * d[i], g + share * d[i + 1 :]
            if share == 1 and np.max(np.abs(d[i + 1 :]) / g) < 1e-9:
                break
        q = np.concatenate([p - step, np.full(e - i + 1, held), law(g)[0]])
        left = h + x[e] + (spread @ q + under)[e]
        return left / range_ - 1, State(h, c * c * (m.load @ q + step * np.pi), r[i])


def touching(law, width, guess, radius, modulus, stress, range_, far, n=40):
    """The state at a width c/a, by two meshes."""
    states = []
    for nodes in (n, 2 * n):
        contact = Contact(width, 1 + np.sqrt(2 * radius * far) / guess, nodes)
        args = (law, radius, modulus, stress, range_)
        c = brentq(lambda c: contact.at(c, *args)[0], 0.8 * guess, 1.25 * guess, xtol=1e-11 * guess)  # noqa: B023
        states.append(np.array(contact.at(c, *args)[1]))
    return State(*(states[1] + (states[1] - states[0]) / 3))
