# SPDX-License-Identifier: BSD-3-Clause
"""Where the work of a hand goes that moves slowly: into the spring, into the contact, and, at the folds, into heat. A
session sums the same over its ticks (libnanotouch/host/energy.c).

The hand holds the far end of a spring K at the height z, the tip at the gap h stands at its near end: F = K (h - z).
On the way the hand does the work W = -integral of F dz; the spring stores F^2/(2 K); the law takes U(h). Both balance
but where the tip jumps: there z stands, and what E(h) = (h - z)^2 K/2 + U(h) loses is heat. In x and y no spring lies
between: what the hand does there against the sideways force of a slope, -F_x dx - F_y dy, the law takes at once."""

from __future__ import annotations

from typing import Any, NamedTuple

import nanotouch as nt
import numpy as np
from numpy.typing import NDArray

PANELS, ORDER = 400, 12  # of Gauss' quadrature over each stable piece of the law


class Energies(NamedTuple):
    """[J]"""

    hand: float
    """work of the hand, + what it has put in"""
    stored: float
    """in the spring"""
    tip: float
    """work at the tip: what the law has taken"""
    heat: float
    """lost where the tip has jumped"""


class Piece(NamedTuple):
    """A stretch over which the tip follows the hand: gaps from where to where, and its law's history."""

    start: float
    end: float
    history: Any


def _law(plan: nt.Plan, gap: Any, history: Any) -> Any:
    return plan.run(np.asarray(gap), history)


def cycle(plan: nt.Plan, spring: float, deepest: float, farthest: float) -> tuple[list[Piece], Energies]:
    """Slowly down from a gap to a depth and back [m]: the stable pieces, and the balance, summed independently: the
    work by quadrature of F dz, the rest from the law's energies."""
    way_in = _follow(plan, spring, np.linspace(farthest, -deepest, 40_001), "approach")
    landed = _landing(plan, spring, way_in, "retract", (-deepest, way_in.end))
    pressed = Piece(landed, -deepest, "retract")
    way_out = _follow(plan, spring, np.linspace(-deepest, farthest, 40_001), "retract")
    freed = _landing(plan, spring, way_out, "approach", (way_out.end, farthest))
    pieces = [way_in, pressed, way_out, Piece(freed, farthest, "approach")]
    hand = sum(_work(plan, spring, piece) for piece in pieces)
    drops = [_energy(plan, spring, a.end, a.history) - _energy(plan, spring, b.start, b.history)
             for a, b in ((pieces[0], pieces[1]), (pieces[2], pieces[3]))]  # fmt: skip
    start, end = (_law(plan, farthest, "approach"), _law(plan, farthest, "approach"))
    stored = float(end.F**2 - start.F**2) / (2.0 * spring)
    return pieces, Energies(hand, stored, float(end.U - start.U), sum(drops))


def _energy(plan: nt.Plan, spring: float, gap: float, history: Any) -> float:
    law = _law(plan, gap, history)
    return float(law.F**2 / (2.0 * spring) + law.U)


def _follow(plan: nt.Plan, spring: float, gaps: NDArray[np.float64], history: Any) -> Piece:
    """From the first gap on as long as the tip follows the hand: dz/dh = 1 + k/K > 0, and the law goes on smoothly."""
    law = _law(plan, gaps, history)
    way = np.diff(gaps - law.F / spring) / np.diff(gaps)
    unstable = np.flatnonzero(way <= 0.0)
    return Piece(float(gaps[0]), float(gaps[unstable[0]]) if len(unstable) else float(gaps[-1]), history)


def _landing(plan: nt.Plan, spring: float, piece: Piece, history: Any, ends: tuple[float, float]) -> float:
    """The gap between two ends at which the other branch has the same height of the hand; by bisection."""
    height = piece.end - float(_law(plan, piece.end, piece.history).F) / spring
    low, high = ends
    for _ in range(100):
        middle = 0.5 * (low + high)
        if middle - float(_law(plan, middle, history).F) / spring < height:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def _work(plan: nt.Plan, spring: float, piece: Piece) -> float:
    """-integral of F dz over a stable piece, dz = (1 + k/K) dh."""
    places, weights = np.polynomial.legendre.leggauss(ORDER)
    edges = np.linspace(piece.start, piece.end, PANELS + 1)
    half = 0.5 * np.diff(edges)[:, None]
    gaps = 0.5 * (edges[1:, None] + edges[:-1, None]) + half * places
    law = _law(plan, gaps, piece.history)
    return -float(np.sum(law.F * (1.0 + law.k / spring) * weights * half))
