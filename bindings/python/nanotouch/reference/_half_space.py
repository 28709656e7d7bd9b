# SPDX-License-Identifier: BSD-3-Clause
"""Axisymmetric pressures on an elastic half-space or on a layer bonded to rigid ground, on a mesh of panels.

By Abel's transform the kernel has no singularity (method of dimensionality reduction, Popov and Hess 2015). With
r^2 = a^2 + s^2 and t^2 = a^2 + tau^2, where a is the radius of contact, 0 where the bodies do not touch:

    q(t) = Int_t^inf p r dr/sqrt(r^2 - t^2) = Int_tau^inf p s ds/sqrt(s^2 - tau^2)
    u(r) = 4/(pi E*) Int_0^r q dt/sqrt(r^2 - t^2)        U_el = 4/E* Int q^2 dt        F = 4 Int q dt

p is a polynomial of x = s^2 on each panel, so that q is exact, and u is what makes U_el stationary.
"""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass

import numpy as np

from nanotouch._arrays import Floats

NODES = 8
"""of Gauss in a panel"""


@functools.cache
def gauss(count: int) -> tuple[Floats, Floats]:
    """Nodes and weights on 0..1."""
    x, w = np.polynomial.legendre.leggauss(count)
    return (x + 1.0) / 2.0, w / 2.0


@functools.cache
def _to_legendre() -> Floats:
    """From values at the nodes of a panel to Legendre coefficients."""
    x, w = np.polynomial.legendre.leggauss(NODES)
    basis = np.polynomial.legendre.legvander(x, NODES - 1)
    return np.asarray((basis * w[:, None]).T * (2.0 * np.arange(NODES) + 1.0)[:, None] / 2.0)


def coefficients(values: Floats) -> Floats:
    """Legendre coefficients of every panel [panels, NODES]."""
    return values.reshape(-1, NODES) @ _to_legendre().T


def interpolate(edges: Floats, values: Floats, x: Floats) -> Floats:
    """Values at the nodes, anywhere; beyond the last edge as 1/r."""
    inside = np.minimum(x, edges[-1])
    panel = np.clip(np.searchsorted(edges, inside, side="right") - 1, 0, edges.size - 2)
    local = 2.0 * (inside - edges[panel]) / (edges[panel + 1] - edges[panel]) - 1.0
    basis = np.polynomial.legendre.legvander(local, NODES - 1)
    found = np.sum(basis * coefficients(values)[panel], axis=1)
    return np.asarray(found * np.sqrt(edges[-1] / np.maximum(x, edges[-1])))


@dataclass(frozen=True)
class Layer:
    """A soft layer bonded to rigid ground."""

    thickness: float
    """[m]"""
    poisson_ratio: float
    share: float = 1.0
    """of the compliance 1/E* that is the layer's; the rest is a half-space's (the tip's)"""

    def spectrum(self) -> tuple[Floats, Floats, Floats]:
        """Wave numbers k [1/m], weights [1/m] and X(k t) - 1 of the compliance, the half-space's being 1."""
        pieces = [0.0, 0.5, 1.5, 3.0, 6.0, 12.0, 20.0]
        y, w = gauss(16)
        kappa = np.concatenate([a + (b - a) * y for a, b in itertools.pairwise(pieces)])
        weight = np.concatenate([(b - a) * w for a, b in itertools.pairwise(pieces)])
        nu = self.poisson_ratio
        top = (3.0 - 4.0 * nu) * np.sinh(2.0 * kappa) - 2.0 * kappa
        bottom = (3.0 - 4.0 * nu) * np.cosh(2.0 * kappa) + 2.0 * kappa**2 + 5.0 - 12.0 * nu + 8.0 * nu**2
        return kappa / self.thickness, weight / self.thickness, top / bottom - 1.0


class Mesh:
    """Panels between `edges` of x = r^2 - a^2 [m^2], and what pressures at their nodes do."""

    def __init__(self, edges: Floats, modulus: float, contact_radius: float = 0.0, layer: Layer | None = None) -> None:
        y, w = gauss(NODES)
        width = np.diff(edges)
        self.edges, self.a = edges, contact_radius
        self.x = (edges[:-1, None] + width[:, None] * y).ravel()
        self.area = np.pi * (width[:, None] * w).ravel()
        roots = np.sqrt(edges)
        y, w = gauss(2 * NODES + 4)
        span = np.diff(roots)[:, None]
        tau = (roots[1:, None] - span * y**2).ravel()
        self.t = np.hypot(tau, self.a)
        self.weight = (2.0 * span * y * w).ravel() * (tau / self.t)  # dt
        self.B = abel(edges, tau)
        self.B0 = abel(edges, np.zeros(1))[0]
        metric = np.diag(self.weight)
        self.rim = np.zeros(self.t.size)
        if layer is not None:
            if self.a > 0.0:
                raise ValueError("contact on a layer")
            k, weight, excess = layer.spectrum()
            waves = np.cos(np.outer(k, self.t)) * self.weight
            metric = metric + 2.0 / np.pi * layer.share * (waves.T * (weight * excess)) @ waves
            self.rim = 2.0 / np.pi * layer.share * (weight * excess) @ waves  # of a unit q at t = 0
        self.metric = metric
        self.K = 8.0 / modulus * (self.B.T @ metric @ self.B) / self.area[:, None]
        # u at r = 0: 2 q(0)/E* of a half-space; of the layer what its waves add there
        self.K0 = 2.0 / modulus * self.B0 + 2.0 / modulus * self.rim @ self.B


def abel(edges: Floats, tau: Floats) -> Floats:
    """Q of unit pressures at the nodes [tau, nodes]: Gauss in sigma, sigma^2 = x - tau^2, is exact."""
    y, w = gauss(NODES)
    low = np.sqrt(np.maximum(edges[None, :-1] - tau[:, None] ** 2, 0.0))
    high = np.sqrt(np.maximum(edges[None, 1:] - tau[:, None] ** 2, 0.0))
    sigma = low[..., None] + (high - low)[..., None] * y
    x = tau[:, None, None] ** 2 + sigma**2
    local = 2.0 * (x - edges[None, :-1, None]) / np.diff(edges)[None, :, None] - 1.0
    basis = np.polynomial.legendre.legvander(local, NODES - 1) @ _to_legendre()
    weights = (high - low)[..., None] * w
    return np.asarray(np.einsum("tpg,tpgn->tpn", weights, basis).reshape(tau.size, -1))
