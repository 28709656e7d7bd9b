# SPDX-License-Identifier: BSD-3-Clause
"""Where the work of the hand goes: into the spring, into the contact, and, at the folds, into heat.

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
FORCE_Z = 6  # column of a row: stretch, place and force of the tip
QUIET = 1e-3  # of the largest load: below this nothing is touched


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


class Balance:
    """Sums over the frames of the last touch.

    Between two ticks the work of the spring's force (their mean) on both of its ends is what it stores, exactly; what
    the spring does on the tip and the law does not take has become motion, and then heat.
    """

    def __init__(self, spring: float, zero: float, alpha_p: float, load: float) -> None:
        self.spring, self.zero, self.alpha_p, self.load = spring, zero, alpha_p, load
        self.hand = self.tip = self.heat = self.began = self.now = 0.0
        self.last: Any = None
        self.tick = -1
        self.free = self.whole = True
        """whether nothing is touched; whether no tick of this touch was missed"""
        self.shift = 0.0  # of the zero since the hand has let go [m]
        self.stopped = False

    def add(self, frames: Any) -> None:
        """Frames in their order. Outside of RUN the supervisor moves the tip: the hand has let go, and takes hold anew
        where the tip is then."""
        runs = frames["state"] == 0
        turns = np.flatnonzero(np.diff(runs)) + 1
        for part in np.split(frames, turns):
            if len(part) and part["state"][0] == 0:
                self._hold(part)
            elif len(part):
                self.stopped, self.free, self.last, self.tick = True, True, None, -1

    def _hold(self, frames: Any) -> None:
        z_tip = frames["tip_position"][:, 2]
        stretch = z_tip - (self.zero + self.shift - self.alpha_p * frames["master_position"][:, 2])
        if self.stopped:
            moved = stretch[0] - frames["tip_force"][0, 2] / self.spring
            if not np.isfinite(moved):
                return
            self.shift, self.stopped, stretch = self.shift + float(moved), False, stretch - moved
        rows = np.column_stack([stretch, frames["tip_position"], frames["tip_force"]])
        known = np.isfinite(rows).all(axis=1)
        rows, ticks = rows[known], frames["sequence"][known].astype(np.int64)
        if not len(rows):
            return
        quiet = bool((np.abs(rows[:, FORCE_Z]) < QUIET * self.load).all())
        if self.free and not quiet:  # a new touch
            self.hand = self.tip = self.heat = 0.0
            first = rows[0] if self.last is None else self.last
            self.began = 0.5 * self.spring * float(first[0]) ** 2
            self.whole = True
        if self.last is not None:
            rows = np.concatenate([[self.last], rows])
        if not (self.free and quiet):
            self._sum(rows)
            self.whole &= bool((np.diff(ticks, prepend=self.tick if self.tick >= 0 else ticks[0] - 1) == 1).all())
        self.free, self.last, self.tick = quiet, rows[-1], int(ticks[-1])

    def _sum(self, rows: NDArray[np.float64]) -> None:
        stretch, way, mean = rows[:, 0], np.diff(rows[:, 1:4], axis=0), 0.5 * (rows[1:, 4:] + rows[:-1, 4:])
        pull = self.spring * 0.5 * (stretch[1:] + stretch[:-1])  # mean of the spring's force, + up on the hand
        moved, law = way[:, 2], mean[:, 2]
        sideways = float(np.sum(mean[:, :2] * way[:, :2]))
        self.hand -= float(np.sum(pull * (moved - np.diff(stretch)))) + sideways
        self.tip -= float(np.sum(law * moved)) + sideways
        self.heat -= float(np.sum((pull - law) * moved))
        self.now = 0.5 * self.spring * float(stretch[-1]) ** 2

    @property
    def energies(self) -> Energies:
        """Of the last touch."""
        return Energies(self.hand, self.now - self.began, self.tip, self.heat)


class Spent:
    """Of what the law takes in a touch, that which particles make heat of; all of it so far [J]."""

    def __init__(self, now: float = 0.0) -> None:
        self.now = self.before = now
        self.of_touch = 0.0

    def follow(self, touches: bool) -> None:
        """Whether something is touched. After a rewind there is less of it."""
        self.before = min(self.before, self.now)
        if touches:
            self.of_touch = self.now - self.before
        else:
            self.before = self.now

    def counted(self, energies: Energies) -> Energies:
        """As heat, and no longer as work at the tip."""
        return energies._replace(tip=energies.tip - self.of_touch, heat=energies.heat + self.of_touch)


# --- the same from the law alone, for a hand that moves slowly ---


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
