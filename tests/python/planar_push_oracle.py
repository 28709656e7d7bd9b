# SPDX-License-Identifier: BSD-3-Clause
"""A sphere that is pushed in a plane, from the papers' formulas alone: DMT contacts, Mindlin's and Dominik and Tielens'
springs with their limits, balance of two forces and a torque by scipy. Apart from the library: no energies, no
minimum, no vectors."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import root

Array = np.ndarray


@dataclass
class Joint:
    """One contact: springs for sliding and rolling."""

    radius: float
    modulus: float
    shear_modulus: float
    work: float
    strength: float
    rolling: float
    pulls: list[float] = field(default_factory=lambda: [0.0, 0.0])
    stiffness: list[float] = field(default_factory=lambda: [0.0, 0.0])

    def load(self, depth: float) -> tuple[float, float]:
        """Net force and contact radius (Derjaguin, Muller and Toporov 1975); it holds from touch on."""
        if depth <= 0.0:
            return 0.0, 0.0
        a = math.sqrt(self.radius * depth)
        return 4.0 / 3.0 * self.modulus * a**3 / self.radius - 2.0 * math.pi * self.work * self.radius, a

    def rest_depth(self) -> float:
        """Where the net force is 0."""
        return float((1.5 * math.pi * self.work * math.sqrt(self.radius) / self.modulus) ** (2 / 3))

    def springs(self, a: float) -> tuple[list[float], list[float]]:
        """Stiffness and limit: 8 a G*, pi a^2 tau (Mindlin 1949); 4 F_c (a/a0)^1.5 R, xi (Dominik and Tielens 1995)."""
        a0 = math.sqrt(self.radius * self.rest_depth())
        moment = 4.0 * 2.0 * math.pi * self.work * self.radius * (a / a0) ** 1.5
        limits = [math.pi * a**2 * self.strength, moment * self.rolling]
        return [8.0 * a * self.shear_modulus, moment * self.radius], limits

    def settle(self, a: float) -> None:
        """To another contact radius: what grows keeps its pull, what shrinks its stretch, up to the limit."""
        stiffness, limits = self.springs(a)
        for i in range(2):
            if 0.0 < stiffness[i] < self.stiffness[i]:
                self.pulls[i] *= stiffness[i] / self.stiffness[i]
            self.pulls[i] = float(np.clip(self.pulls[i], -limits[i], limits[i]))
        self.stiffness = stiffness

    def stretched(self, ways: tuple[float, float], a: float) -> list[float]:
        """Pulls after a way that slides and one that rolls."""
        limits = self.springs(a)[1]
        return [float(np.clip(self.pulls[i] + self.stiffness[i] * ways[i], -limits[i], limits[i])) for i in range(2)]


@dataclass
class Flat:
    """A sphere on a substrate, a round tip that is led along x at the height of its middle."""

    sphere: float
    tip_radius: float
    height: float
    substrate: Joint
    tip: Joint
    place: float
    """of the tip's middle"""

    def __post_init__(self) -> None:
        self.pose: Array = np.array([0.0, self.sphere - self.substrate.rest_depth(), 0.0])

    def geometry(self, pose: Array, place: float) -> tuple[float, float, float]:
        """Direction from the tip's middle to the sphere's, and how deep they overlap."""
        dx, dz = pose[0] - place, pose[1] - self.height
        far = math.hypot(dx, dz)
        return dx / far, dz / far, self.sphere + self.tip_radius - far

    def step(self, place: float) -> tuple[float, float]:
        """Lead the tip on; the force on it, x and z. Limits and directions are those of where the step begins."""
        n = self.geometry(self.pose, self.place)
        along, radii = (n[1], -n[0]), (self.substrate.load(self.sphere - self.pose[1])[1], self.tip.load(n[2])[1])
        for joint, radius in zip((self.substrate, self.tip), radii, strict=True):
            joint.settle(radius)

        def pulls(move: Array) -> list[list[float]]:
            slid = (move[0] - place + self.place) * along[0] + move[1] * along[1] - self.sphere * move[2]
            ways = (move[0] - self.sphere * move[2], move[2]), (slid, move[2])
            return [
                joint.stretched(way, radius)
                for joint, way, radius in zip((self.substrate, self.tip), ways, radii, strict=True)
            ]

        def from_tip(move: Array, held: float) -> tuple[float, float]:
            nx, nz, deep = self.geometry(self.pose + move, place)
            load = self.tip.load(deep)[0]
            return load * nx - held * along[0], load * nz - held * along[1]

        def balance(move: Array) -> Array:
            (p, turn), (q, other) = pulls(move)
            fx, fz = from_tip(move, q)
            up = self.substrate.load(self.sphere - self.pose[1] - move[1])[0]
            return np.array([fx - p, up + fz, p + q - (turn + other) / self.sphere])

        unit = np.array([1e-9, 1e-9, 1e-9 / self.sphere])
        size = 2.0 * math.pi * self.substrate.work * self.sphere
        found = root(lambda u: balance(u * unit) / size, np.zeros(3), options={"xtol": 1e-12})
        assert np.abs(found.fun).max() < 1e-6  # at the kink of a limit hybr gets no nearer
        move = found.x * unit
        self.substrate.pulls, self.tip.pulls = pulls(move)
        fx, fz = from_tip(move, self.tip.pulls[0])
        self.pose, self.place = self.pose + move, place
        return -fx, -fz
