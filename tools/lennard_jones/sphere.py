# SPDX-License-Identifier: BSD-3-Clause
"""A paraboloid on an elastic half-space under the Lennard-Jones 9-3 law, self-consistent.

Units: lengths along z in z0 (the gap at which half-spaces are at equilibrium), radii in sqrt(R z0), pressures in w/z0.
With Tabor's mu = (R w^2/(E*^2 z0^3))^(1/3) the gap is

    H(rho) = 1 - D + rho^2/2 + mu^1.5 G[p(H)],  p(H) = 8/3 (H^-9 - H^-3),  G[p](rho) = 1/pi int p(rho') dA'/|rho - rho'|

where D is the indentation: D = 0 puts the undeformed apex at z0. The load is P = 2 int p rho drho in pi w R.

The gap H0 at the centre falls along the whole curve, through all folds, from far away to deep contact, whereas D and P
turn back. So H0 is given and D is a result: D = 1 - H0 + mu^1.5 G[p](0). Each equilibrium has its own mesh, finest at
the edge of contact, of panels on which p is a polynomial, whose displacement is integrated with the elliptic kernel to
13 digits.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve
from scipy.special import ellipkm1

Floats = NDArray[np.float64]

#: nodes of a panel; between them pressure times rho is a polynomial of one degree less
ORDER = 10
#: nodes that integrate a panel near its logarithmic singularity
NEAR_ORDER = 24
#: end of the mesh [sqrt(R z0)]; what lies beyond adds 1e-7 to P
OUTER = 100.0
MAX_ITERATIONS = 8
#: of H0 in a continuation
SMALLEST_STEP = 1e-7


class NoConvergence(ArithmeticError):
    """Newton's method did not converge from this guess."""


class Mesh(NamedTuple):
    """Gauss nodes of all panels, and what acts on nodal values."""

    edges: Floats
    """of the panels [panels + 1]"""
    nodes: Floats
    """rho [n]"""
    weights: Floats
    """int f drho = weights @ f [n]"""
    influence: Floats
    """G[p] at the nodes = influence @ p [n, n]"""

    @property
    def centre(self) -> Floats:
        """G[p] at rho = 0, exactly: 2 int p drho."""
        return 2.0 * self.weights


class Resolution(NamedTuple):
    """How fine the mesh is: the panel at the edge of contact, and how fast panels grow with the distance from it."""

    finest: float
    growth: float

    def panels(self, mu: float) -> tuple[float, float]:
        """Size of the finest panel [sqrt(R z0)] and growth [-]; the edge is as sharp as mu^-1.5."""
        return self.finest * min(1.0, mu**-1.5), self.growth


COARSE, NORMAL, FINE = Resolution(0.6, 1.0), Resolution(0.3, 0.5), Resolution(0.15, 0.35)


class Point(NamedTuple):
    """An equilibrium and its derivatives with respect to H0."""

    mesh: Mesh
    centre_gap: float
    gap: Floats
    tangent: Floats
    D: float
    P: float
    D_slope: float
    P_slope: float
    U: float
    """energy in pi w R z0: 2 int (mu^1.5 p G[p]/2 + Phi(H)) rho drho; dU/dD = P"""


def kernel(source: Floats, total: Floats, distance: Floats) -> Floats:
    """G at r of a ring of radius s: 4/pi s/total K(m), 1-m = (distance/total)^2, total = r + s, distance = |r - s|."""
    return np.asarray(4.0 / np.pi * source / total * ellipkm1((distance / total) ** 2))


def lagrange(nodes: Floats, points: Floats) -> Floats:
    """Lagrange's polynomials of the nodes at the points [k, points]."""
    rows = []
    for k, node in enumerate(nodes):
        others = np.delete(nodes, k)
        rows.append(np.prod((points[None, :] - others[:, None]) / (node - others)[:, None], axis=0))
    return np.array(rows)


def near_weights(targets: Floats, start: float, end: float, nodes: Floats) -> Floats:
    """int L_k(s) kernel(target, s) ds over a panel that holds or neighbours the targets: log-singular at the target."""
    x, w = np.polynomial.legendre.leggauss(NEAR_ORDER)
    u, w = (x + 1.0) / 2.0, w / 2.0
    result = np.zeros((targets.size, nodes.size))
    for edge, other, sign in ((start, end, 1.0), (end, start, -1.0)):  # the part between each target and the other edge
        reached = sign * (other - targets) > 0.0
        r = targets[reached, None]
        near, far = np.maximum(0.0, sign * (edge - r)), sign * (other - r)
        with np.errstate(divide="ignore", invalid="ignore"):  # np.where discards what divides by near = 0
            ratio = np.log(far / near)  # outside: points graded away from the target; inside: u^5 tames the logarithm
            distance = np.where(near > 0.0, near * np.exp(ratio * u), far * u**5)
            jacobian = np.where(near > 0.0, distance * ratio, 5.0 * far * u**4)
        s = r + sign * distance
        values = w * jacobian * kernel(s, s + r, distance)
        result[reached] += np.einsum("kij,ij->ik", lagrange(nodes, s.ravel()).reshape(nodes.size, *s.shape), values)
    return result


def build_mesh(edges: Floats) -> Mesh:
    """Panels between the edges, and the influence of each on all nodes: exact for polynomials of degree ORDER - 1."""
    x, w = np.polynomial.legendre.leggauss(ORDER)
    half = np.diff(edges)[:, None] / 2.0
    nodes = (edges[:-1, None] + half * (1.0 + x)).ravel()
    weights = (half * w).ravel()
    r = nodes[:, None]
    with np.errstate(invalid="ignore"):  # r = s is replaced below
        influence = kernel(nodes, r + nodes, np.abs(r - nodes)) * weights
    for j, (start, end) in enumerate(itertools.pairwise(edges)):
        columns = slice(j * ORDER, (j + 1) * ORDER)
        near = (nodes > 2.0 * start - end) & (nodes < 2.0 * end - start)
        influence[near, columns] = near_weights(nodes[near], start, end, nodes[columns])
    return Mesh(edges, nodes, weights, influence)


def graded_edges(focus: float, finest: float, growth: float) -> Floats:
    """Panel edges from 0 to OUTER, finest at the focus, growing in proportion to the distance from it."""
    count = int(np.ceil(np.log1p((OUTER - focus) * growth / finest) / np.log1p(growth)))
    reach = finest * np.expm1(np.arange(count + 1) * np.log1p(growth)) / growth
    outer = focus + reach * (OUTER - focus) / reach[-1]
    inner = focus - reach[(reach > 0.0) & (reach < focus - finest)]
    return np.concatenate([[0.0], inner[::-1], outer]) if focus > 0.0 else outer


def transfer(mesh: Mesh, values: Floats, points: Floats) -> Floats:
    """Nodal values of a mesh as panel-wise polynomials, at the points [m, points.size] for values [m, n]."""
    result = np.empty((values.shape[0], points.size))
    panel = np.clip(np.searchsorted(mesh.edges, points) - 1, 0, mesh.edges.size - 2)
    for j in np.unique(panel):
        columns = slice(j * ORDER, (j + 1) * ORDER)
        result[:, panel == j] = values[:, columns] @ lagrange(mesh.nodes[columns], points[panel == j])
    return result


def pressure(gap: Floats) -> Floats:
    """The 9-3 law [w/z0], + repulsive."""
    return 8.0 / 3.0 * (gap**-9 - gap**-3)


def solve(mesh: Mesh, mu: float, centre_gap: float, guess: Floats) -> Point:
    """The equilibrium with a given gap at the centre, by Newton's method from a guess of the gap at the nodes."""
    compliance = mu**1.5
    relative = compliance * (mesh.influence - mesh.centre)  # displacement relative to the centre's
    shape = centre_gap + mesh.nodes**2 / 2.0
    gap, identity = guess, np.eye(guess.size)
    for _ in range(MAX_ITERATIONS):
        slope = 8.0 / 3.0 * (3.0 * gap**-4 - 9.0 * gap**-10)
        factors = lu_factor(identity - relative * slope, overwrite_a=True, check_finite=False)
        step = lu_solve(factors, shape + relative @ pressure(gap) - gap, check_finite=False)
        gap = gap + step
        if not (np.all(np.isfinite(gap)) and gap.min() > 0.3):
            break
        if np.abs(step).max() < 1e-9:  # the next step would be its square
            slope = 8.0 / 3.0 * (3.0 * gap**-4 - 9.0 * gap**-10)
            tangent = lu_solve(factors, np.ones_like(gap), check_finite=False)
            return _point(mesh, compliance, centre_gap, gap, tangent, slope)
    raise NoConvergence(f"mu = {mu}, H0 = {centre_gap}")


def _point(mesh: Mesh, compliance: float, centre_gap: float, gap: Floats, tangent: Floats, slope: Floats) -> Point:
    p, ring = pressure(gap), 2.0 * mesh.weights * mesh.nodes
    energy = compliance * p * (mesh.influence @ p) / 2.0 + (gap**-8 - 4.0 * gap**-2) / 3.0
    return Point(
        mesh,
        centre_gap,
        gap,
        tangent,
        D=1.0 - centre_gap + compliance * float(mesh.centre @ p),
        P=float(ring @ p),
        D_slope=compliance * float(mesh.centre @ (slope * tangent)) - 1.0,
        P_slope=float(ring @ (slope * tangent)),
        U=float(ring @ energy),
    )


def edge_of_contact(mesh: Mesh, gap: Floats) -> float:
    """The largest radius where the attraction is strongest (H = 3^(1/6)), 0 while the centre is farther away."""
    inside = np.flatnonzero(gap < 3.0 ** (1.0 / 6.0))
    return float(mesh.nodes[inside[-1]]) if inside.size else 0.0


def advance(last: Point, mu: float, goal: float, resolution: Resolution) -> Point:
    """The equilibrium at another gap of the centre, continued from the last, in small steps where Newton needs them."""
    step = goal - last.centre_gap
    while last.centre_gap != goal:
        if abs(step) < SMALLEST_STEP:
            raise NoConvergence(f"mu = {mu}, H0 = {last.centre_gap}")
        whole = abs(step) >= abs(goal - last.centre_gap)
        there = goal if whole else last.centre_gap + step
        old = last.mesh
        guess = np.maximum(last.gap + (there - last.centre_gap) * last.tangent, there)  # the centre is the narrowest
        mesh = build_mesh(graded_edges(edge_of_contact(old, guess), *resolution.panels(mu)))
        undeformed = there + mesh.nodes**2 / 2.0
        departure = transfer(old, (guess - there - old.nodes**2 / 2.0)[None, :], mesh.nodes)[0]
        try:
            last = solve(mesh, mu, there, np.maximum(undeformed + departure, there))
        except NoConvergence:
            step /= 2.0
        else:
            step *= 2.0
    return last


def curve(mu: float, centre_gaps: Floats, resolution: Resolution = NORMAL) -> Iterator[Point]:
    """Equilibria at falling gaps of the centre, the first so large that the surface is hardly deformed."""
    first = float(centre_gaps[0])
    mesh = build_mesh(graded_edges(0.0, *resolution.panels(mu)))
    last = solve(mesh, mu, first, first + mesh.nodes**2 / 2.0)
    yield last
    for goal in map(float, centre_gaps[1:]):
        last = advance(last, mu, goal, resolution)
        yield last
