# SPDX-License-Identifier: BSD-3-Clause
"""A rod that lies on a flat and is pushed sideways by a tip: it slides and turns in the plane.

Friction is spread along the line of contact: springs that give way at a limit, as those of a particle
(docs/manipulation.md). A step of the tip ends in the minimum of what they store, of what becomes heat, and of the
energy of the tip's contact. All SI.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from nanotouch._arrays import Floats, as_floats, check_between
from nanotouch.errors import Error, InvalidValue

_ROUNDS, _HALVINGS = 3000, 40
_EXACT = 1e-9  # of all forces: how closely they balance
_LONGEST = 0.05  # of the smaller radius: the largest motion in one of Newton's steps


@dataclass(frozen=True)
class Rod:
    """A straight round rod on a substrate, and the tip beside it.

    It adheres as a cylinder does (Chaudhury, Weaver, Hui, Kramer 1996): F/L = pi E* b^2/(4 R) - sqrt(2 pi E* b w), b
    half of the width of the contact. It slides, and does not roll about its axis.

    Parameters
    ----------
    length, radius : float
        L and R [m]; L is 4 R at least.
    effective_modulus, effective_shear_modulus : float
        E* and G* of rod and substrate [Pa].
    work_of_adhesion : float
        w [J/m^2].
    shear_strength : float
        tau, friction per contact area [Pa].
    tip_radius : float
        Of the tip where it touches, seen from above [m].
    tip_stiffness : float
        Of its contact with the rod, without adhesion and friction [N/m].
    elements : int
        Pieces of the line of contact, 8 .. 1000.
    step : float
        Largest step of the tip [m]; longer ways are divided.
    """

    length: float
    radius: float
    effective_modulus: float
    effective_shear_modulus: float
    work_of_adhesion: float
    shear_strength: float
    tip_radius: float = 20e-9
    tip_stiffness: float = 100.0
    elements: int = 100
    step: float = 1e-9

    def __post_init__(self) -> None:
        for name in ("radius", "effective_modulus", "effective_shear_modulus", "work_of_adhesion", "shear_strength",
                     "tip_radius", "tip_stiffness", "step"):  # fmt: skip
            check_between(name, getattr(self, name), "", above=0.0)
        if not 4.0 * self.radius <= self.length < math.inf:
            raise InvalidValue(f"length = {self.length:g} m: valid is {4.0 * self.radius:g} m and above, 4 radii")
        if not 8 <= self.elements <= 1000:
            raise InvalidValue(f"elements = {self.elements}: valid is 8 .. 1000")
        if not self.half_width < 0.5 * self.radius:
            raise InvalidValue(
                f"half_width = {self.half_width:g} m without load: valid is below half of the radius, "
                f"{0.5 * self.radius:g} m"
            )
        least = 4.0 * self.friction * self.length / min(self.radius, self.tip_radius)
        if not self.tip_stiffness >= least:
            raise InvalidValue(
                f"tip_stiffness = {self.tip_stiffness:g} N/m: valid is {least:.3g} N/m and above, so that the tip does "
                "not go through the rod under its friction"
            )

    @property
    def half_width(self) -> float:
        """b0 of the contact without load, b0^3 = 32 R^2 w/(pi E*) [m]."""
        return float(
            (32.0 * self.radius**2 * self.work_of_adhesion / (math.pi * self.effective_modulus)) ** (1.0 / 3.0)
        )

    @property
    def friction(self) -> float:
        """q = 2 b0 tau, of a length [N/m]."""
        return 2.0 * self.half_width * self.shear_strength

    @property
    def stiffness(self) -> float:
        """Of a length before it slides, pi G*/ln(L/b0) [N/m^2]: a strip on a half space, in its middle."""
        return math.pi * self.effective_shear_modulus / math.log(self.length / self.half_width)

    def place(self, x: float, y: float, angle: float, tip: tuple[float, float]) -> RodState:
        """At rest with its middle at (x, y) [m], its axis turned by an angle from x [rad]; the tip must not touch."""
        pose = np.array([*as_floats([x, y, angle], "place")])
        spot = as_floats(tip, "tip")
        if spot.shape != (2,) or not np.isfinite([*pose, *spot]).all():
            raise InvalidValue("place and tip: valid are numbers; tip is x and y [m]")
        if _Touch(self, spot).at(pose)[0] > 0.0:
            raise InvalidValue(f"tip = ({spot[0]:g}, {spot[1]:g}) m touches the rod: begin beside it")
        return RodState(pose, spot, np.zeros((self.elements, 2)), np.zeros(2), 0.0, 0.0, 0.0)

    def run(self, x: ArrayLike, y: ArrayLike, *, state: RodState) -> RodPath:
        """Move the middle of the tip along points [m], straight from one to the next."""
        points = np.stack(
            np.broadcast_arrays(np.atleast_1d(as_floats(x, "x")), np.atleast_1d(as_floats(y, "y"))), axis=-1
        )
        if points.ndim != 2 or not len(points) or not np.isfinite(points).all():
            raise InvalidValue("x, y: valid are numbers in one dimension, one point at least")
        rows = []
        for point in points:
            way = point - state.tip
            steps = max(1, math.ceil(float(np.hypot(*way)) / self.step))
            start = state.tip
            for number in range(1, steps + 1):
                state = self._advance(state, point if number == steps else start + way * (number / steps))
            rows.append(state)
        pose = np.array([row.pose for row in rows])
        force = np.array([row.force for row in rows])
        stored, dissipated, work = np.array([(row.stored, row.dissipated, row.work) for row in rows]).T
        return RodPath(pose[:, :2], pose[:, 2], force, stored, dissipated, work, state)

    @property
    def _places(self) -> Floats:
        """Of the elements along the axis, from the middle [m]."""
        return ((np.arange(self.elements) + 0.5) / self.elements - 0.5) * self.length

    def _advance(self, state: RodState, tip: Floats) -> RodState:
        step = _Step(self, state, tip)
        pose = step.find()
        pulls, given = step.pulled(pose)
        share = self.length / self.elements
        slipped = float(given.sum()) * self.friction * share
        depth, normal, _ = step.touch.at(pose)
        force = -self.tip_stiffness * depth * normal  # on the tip, away from the rod
        stored = 0.5 * float(np.sum(pulls**2)) / (self.stiffness * share) + 0.5 * self.tip_stiffness * depth**2
        ways = [-float(one @ (tip - state.tip)) for one in (state.force, force)]
        kept = stored - state.stored + slipped
        jump = max(min(ways) - kept, 0.0)  # set free when the tip slips off an end
        return RodState(pose, tip, pulls, force, stored, state.dissipated + slipped + jump, state.work + kept + jump)


class RodState(NamedTuple):
    """Where a rod is, and what it remembers: enough to go on from."""

    pose: Floats
    """x and y of its middle [m], angle of its axis from x [rad]"""
    tip: Floats
    """x and y of the tip's middle [m]"""
    pulls: Floats
    """of each element, x and y [N]"""
    force: Floats
    """x and y, on the tip [N]"""
    stored: float
    """[J]"""
    dissipated: float
    """heat so far, never falling [J]"""
    work: float
    """done by the hand so far [J]"""


class RodPath(NamedTuple):
    """What happens along a path of the tip; one row per point."""

    position: Floats
    """x and y of the rod's middle [m]"""
    angle: Floats
    """of its axis from x [rad]"""
    force: Floats
    """x and y, on the tip [N]"""
    stored: Floats
    """in springs and contact [J]"""
    dissipated: Floats
    """heat since the beginning, never falling [J]"""
    work: Floats
    """done by the hand since the beginning [J]"""
    state: RodState
    """at the end"""


def turning_point(length: float, arm: float) -> float:
    """Where a rod turns that is pushed across its axis: distance from the middle, on the other side than the push [m].

    Friction is spread evenly. Force and torque balance where c = sqrt(arm^2 + L^2/4) - arm; the push is 2 q c. A push
    on the middle does not turn it: L/2 is the limit.
    """
    check_between("length", length, "m", above=0.0)
    if not 0.0 <= arm <= 0.5 * length:
        raise InvalidValue(f"arm = {arm:g} m: valid is 0 .. {0.5 * length:g} m, half of the length")
    return math.sqrt(arm * arm + 0.25 * length * length) - arm


class _Touch:
    """Tip and rod, seen from above: a circle, and a line with round ends."""

    def __init__(self, rod: Rod, tip: Floats) -> None:
        self.rod, self.tip = rod, tip

    def at(self, pose: Floats) -> tuple[float, Floats, float]:
        """How deep they overlap, the normal from the tip to the rod, and the place along the axis."""
        axis = np.array([math.cos(pose[2]), math.sin(pose[2])])
        half = 0.5 * self.rod.length
        along = float(np.clip((self.tip - pose[:2]) @ axis, -half, half))
        away = pose[:2] + along * axis - self.tip
        distance = float(np.hypot(*away))
        depth = self.rod.radius + self.rod.tip_radius - distance
        return max(depth, 0.0), away / distance if distance > 0.0 else np.array([0.0, 1.0]), along


class _Step:
    """One step of the tip: the minimum over the pose."""

    def __init__(self, rod: Rod, state: RodState, tip: Floats) -> None:
        self.rod, self.state = rod, state
        self.touch = _Touch(rod, tip)
        share = rod.length / rod.elements
        self.k, self.limit = rod.stiffness * share, rod.friction * share
        self.places = rod._places
        self.before = self._spots(state.pose)
        self.arm = 0.5 * rod.length  # a turn counts as a length by it

    def _spots(self, pose: Floats) -> Floats:
        axis = np.array([math.cos(pose[2]), math.sin(pose[2])])
        return np.asarray(pose[:2] + self.places[:, None] * axis)

    def _stretched(self, pose: Floats) -> tuple[Floats, Floats]:
        stretch = self.state.pulls / self.k + self._spots(pose) - self.before
        return stretch, np.hypot(stretch[:, 0], stretch[:, 1])

    def pulled(self, pose: Floats) -> tuple[Floats, Floats]:
        """Pulls, and the way by which each has given."""
        stretch, length = self._stretched(pose)
        given = np.maximum(length - self.limit / self.k, 0.0)
        pulls = np.where(given[:, None] > 0.0, self.limit / np.maximum(length, 1e-300)[:, None], self.k) * stretch
        return pulls, given

    def cost(self, pose: Floats) -> tuple[float, Floats, Floats, float]:
        """Energy and heat, their gradient, second derivative, and the size of all forces; turns times arm."""
        stretch, length = self._stretched(pose)
        gives = self.k * length > self.limit
        safe = np.maximum(length, 1e-300)
        each = np.where(gives, self.limit * (length - 0.5 * self.limit / self.k), 0.5 * self.k * length**2)
        across = np.where(gives, self.limit / safe, self.k)
        unit = stretch / safe[:, None]
        turn = np.stack([-math.sin(pose[2]) * self.places, math.cos(pose[2]) * self.places], axis=-1) / self.arm
        ways = np.stack(
            [np.broadcast_to([1.0, 0.0], turn.shape), np.broadcast_to([0.0, 1.0], turn.shape), turn], axis=1
        )
        pulls = across[:, None] * stretch
        gradient = np.einsum("ijk,ik->j", ways, pulls)
        tangent = across[:, None, None] * (np.eye(2) - gives[:, None, None] * unit[:, :, None] * unit[:, None, :])
        hessian = np.einsum("ijk,ikl,iml->jm", ways, tangent, ways)
        depth, normal, along = self.touch.at(pose)
        stiff = self.rod.tip_stiffness
        if depth > 0.0:
            side = np.array([-math.sin(pose[2]), math.cos(pose[2])])
            lever = np.array([normal[0], normal[1], along * float(side @ normal) / self.arm])
            gradient -= stiff * depth * lever
            hessian += stiff * np.outer(lever, lever)
            if abs(along) < 0.5 * self.rod.length:  # a side that turns moves its normal, too
                bend = stiff * depth / self.arm * float(np.sign(side @ normal))
                hessian[:2, 2] += bend * np.array([side[1], -side[0]])
                hessian[2, :2] = hessian[:2, 2]
                hessian[2, 2] += stiff * depth * (self.rod.radius + self.rod.tip_radius - depth) / self.arm**2
        size = float(np.abs(pulls).sum()) + stiff * depth
        return float(each.sum()) + 0.5 * stiff * depth**2, gradient, hessian, size

    def find(self) -> Floats:
        """Newton's steps that go down."""
        pose, damping = self.state.pose.copy(), 1e-12
        cost, gradient, hessian, size = self.cost(pose)
        scale = np.array([1.0, 1.0, self.arm])
        longest = _LONGEST * min(self.rod.radius, self.rod.tip_radius)
        for _ in range(_ROUNDS):
            if float(np.abs(gradient).max()) <= _EXACT * size + 1e-18:
                return pose
            for _ in range(_HALVINGS):
                way = -np.linalg.solve(hessian + damping * np.trace(hessian) * np.eye(3), gradient)
                if not float(gradient @ way) < 0.0:
                    damping *= 8.0
                    continue
                way *= min(1.0, longest / float(np.abs(way).max()))
                trial = pose + way / scale
                found = self.cost(trial)
                closer = float(np.abs(found[1]).max()) < 0.9 * float(np.abs(gradient).max())
                if found[0] <= cost + 1e-4 * float(gradient @ way) or (closer and found[0] <= cost * (1.0 + 1e-13)):
                    pose, (cost, gradient, hessian, size), damping = trial, found, max(damping / 100.0, 1e-12)
                    break
                damping *= 8.0
            else:
                break
        if float(np.abs(gradient).max()) <= 1e-5 * size + 1e-18:
            return pose
        raise Error("rod: the forces do not balance; a smaller step may help")
