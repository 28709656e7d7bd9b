# SPDX-License-Identifier: BSD-3-Clause
"""Approach and retraction with tethers, drag, squeeze film and bow whose truth is known.

Made apart from the library and from the prototypes it was tuned on: worm-like chains besides plateaus, a Hertz contact
solved point by point, noise with a 1/f part, drag from speed.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from nanotouch import curves

Array = np.ndarray
K_T = 4.11e-21  # J, at 298 K


@dataclass(frozen=True)
class Tether:
    """Holds with `force` [N] until the base has gone `length` [m] beyond contact; a chain if `chain`."""

    force: float
    length: float
    chain: bool = False

    def at(self, distance: Array) -> Array:
        """Its pull, positive [N]."""
        held = (distance > 0.0) & (distance < self.length)
        if not self.chain:
            return np.where(held, self.force, 0.0)
        persistence = 0.4e-9
        contour = self.length * 1.08
        x = np.clip(distance / contour, 0.0, 0.96)
        pull = K_T / persistence * (0.25 / (1 - x) ** 2 - 0.25 + x)
        top = K_T / persistence * (0.25 / (1 - self.length / contour) ** 2 - 0.25 + self.length / contour)
        return np.where(held, self.force * pull / top, 0.0)


@dataclass(frozen=True)
class Made:
    """What is recorded; forces in N, lengths in m, speed in m/s."""

    tethers: tuple[Tether, ...] = ()
    adhesion: float = 0.0
    drag: float = 0.0
    film: float = 0.0
    film_height: float = 100e-9
    bow: float = 0.0
    tilt: float = 5e-5
    noise: float = 10e-12
    flicker: float = 0.0
    modulus: float = 20.0
    travel: float = 3e-6
    depth: float = 5e-7
    points: int = 2000
    speed: float = 2e-6
    stiffness: float = 0.06
    seed: int = 1
    truth: dict[str, float] = field(default_factory=dict)


def _pink(rng: np.random.Generator, count: int) -> Array:
    spectrum = np.fft.rfft(rng.standard_normal(8 * count))
    spectrum[1:] /= np.sqrt(np.arange(1, spectrum.size) / (8 * count) * 2.0)
    spectrum[0] = 0.0
    return np.asarray(np.fft.irfft(spectrum)[:count])


def _contact(above: Array, made: Made) -> Array:
    """Hertz with a spring: the force [N] at the height of the base over first touch, K = `modulus` N/m^1.5."""
    force = np.zeros(above.size)
    depth = np.maximum(-above, 0.0)
    for _ in range(60):
        force = 0.5 * force + 0.5 * made.modulus * 1e-3 * np.maximum(depth - force / made.stiffness, 0.0) ** 1.5 / 1e-3
        force = np.minimum(force, made.stiffness * depth)
    return force


def make(made: Made) -> curves.ForceCurve:
    """The curve; the contact lies at z = 0, the deepest point at -depth. ``meta["pull_off"]`` is the truth [N]."""
    rng = np.random.default_rng(made.seed)
    free = made.travel - made.depth
    dt = made.travel / made.speed / made.points
    z = np.linspace(free, -made.depth, made.points)
    segments = []
    for role, height, sign in (("approach", z, 1.0), ("retract", z[::-1], -1.0)):
        force = _contact(height, made)
        if role == "retract":
            pull = made.adhesion * ((height > 0.0) & (height < made.adhesion / made.stiffness)) * height
            pull = pull / max(made.adhesion / made.stiffness, 1e-30)
            for tether in made.tethers:
                pull = pull + np.minimum(tether.at(height), made.stiffness * np.maximum(height, 0.0))
            force = force - pull
        gap = np.maximum(height, 0.0) / made.film_height
        force = force + sign * (made.drag + made.film / (1.0 + gap))
        force = force + made.tilt * height + made.bow * (height / free) ** 2 + 30e-12
        noise = made.noise * rng.standard_normal(height.size) + made.flicker * _pink(rng, height.size)
        time = (np.arange(height.size) + (0 if role == "approach" else height.size)) * dt
        segments.append(curves.Segment(role, time, height, "height (measured)", force + noise))  # type: ignore[arg-type]
    distance = np.linspace(1e-12, free, 20_000)
    pull = np.zeros(distance.size)
    for tether in made.tethers:
        pull = pull + np.minimum(tether.at(distance), made.stiffness * distance)
    meta = {"spring constant": made.stiffness, "pull_off": max(float(pull.max()), made.adhesion)}
    return curves.ForceCurve(tuple(segments), meta, "tethers")
