# SPDX-License-Identifier: BSD-3-Clause
"""Force curves of known modulus with one defect each, drawn over what laboratories have; no law of the library in them.

A curve is a law F(indentation) on a cantilever, X = indentation + F/k, sampled evenly over the base's travel there and
back, with the detector's noise, offset and tilt, and with a calibration that errs by what the fit is given.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from nanotouch.curves import ForceCurve, Segment
from scipy.special import beta, betainc

Law = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Lab:
    """Ranges of what is drawn, each (lowest, highest); all but the last four are even in the logarithm."""

    radius: tuple[float, float] = (0.5e-6, 1e-5)  # m
    modulus: tuple[float, float] = (2e2, 1e5)  # E* [Pa]
    depth: tuple[float, float] = (0.03, 0.2)  # of R
    bending: tuple[float, float] = (0.1, 4.0)  # of the lever, over the depth
    noise: tuple[float, float] = (2e-4, 8e-3)  # of the load
    points: tuple[float, float] = (400, 4000)
    speed: tuple[float, float] = (5e-7, 3e-5)  # m/s
    free: tuple[float, float] = (1.0, 6.0)  # free travel over that in contact
    flicker: tuple[float, float] = (0.0, 0.3)  # of the variance
    known_to: tuple[float, float] = (0.03, 0.05)  # sensitivity; spring constant and radius


OWN = Lab()
#: looked at only when the rules stood
HELD_OUT = Lab(radius=(3e-8, 2.5e-5), modulus=(5e1, 1e7), depth=(0.02, 0.3), bending=(0.04, 8.0), noise=(1e-4, 1.5e-2),
               points=(250, 8000), free=(0.6, 10.0), flicker=(0.0, 0.6))  # fmt: skip


@dataclass(frozen=True)
class Draw:
    """What a curve is made of; SI."""

    radius: float
    modulus: float
    depth: float
    stiffness: float
    noise: float
    points: int
    speed: float
    free: float
    flicker: float
    rng: np.random.Generator

    @property
    def load(self) -> float:
        """Of Hertz' law at the depth [N]."""
        return 4.0 / 3.0 * self.modulus * np.sqrt(self.radius * self.depth**3)


def draw(lab: Lab, seed: int) -> Draw:
    """The same seed, the same draw."""
    rng = np.random.default_rng(seed)

    def even(pair: tuple[float, float]) -> float:
        return float(np.exp(rng.uniform(*np.log(pair))))

    radius, modulus = even(lab.radius), even(lab.modulus)
    depth = even(lab.depth) * radius
    load = 4.0 / 3.0 * modulus * np.sqrt(radius * depth**3)
    return Draw(radius, modulus, depth, load / (even(lab.bending) * depth), even(lab.noise) * load,
                int(even(lab.points)), even(lab.speed), even(lab.free), rng.uniform(*lab.flicker), rng)  # fmt: skip


@dataclass
class Ideal:
    """Both branches before the detector: height over the contact point [m] falling and rising, force there [N]."""

    down: np.ndarray
    down_force: np.ndarray
    up: np.ndarray
    up_force: np.ndarray
    modulus: float
    gain: float = 1.0  # what the detector reads over what is there


def hertz(d: Draw) -> Law:
    """A paraboloid on a half-space."""
    return lambda x: 4.0 / 3.0 * d.modulus * np.sqrt(d.radius) * np.clip(x, 0.0, None) ** 1.5


def elastic(d: Draw, law: Law, *, free: float | None = None, begin: float = 0.0) -> Ideal:
    """There and back over one law; the ramp begins at `begin` of the contact's travel."""
    x = np.r_[0.0, np.geomspace(1e-6, 1.3, 4000)] * d.depth
    force = law(x)
    deepest = float(np.interp(d.load, force, x + force / d.stiffness)) if force[-1] > d.load else float(x[-1])
    height = np.linspace((d.free if free is None else free) * deepest if not begin else -begin * deepest, -deepest,
                         d.points)  # fmt: skip
    shown = np.interp(-height, x + force / d.stiffness, force, left=0.0)
    return Ideal(height, shown, height[::-1], shown[::-1], d.modulus)


def curve_of(d: Draw, ideal: Ideal, lab: Lab) -> tuple[ForceCurve, float]:
    """What the instrument records, and the stated radius; calibration errs by what it is known to."""
    rng, n = d.rng, ideal.down.size
    sensitivity, stiffness, radius = np.exp(rng.normal(size=3) * [lab.known_to[0], lab.known_to[1], lab.known_to[1]])
    base = float(ideal.down[-1])
    rate = d.speed / max(abs(float(ideal.down[0] - base)) / n, 1e-15)
    white = rng.normal(size=n + ideal.up.size)
    spectrum = np.fft.rfft(rng.normal(size=white.size))
    spectrum[1:] /= np.sqrt(np.arange(1, spectrum.size))
    pink = np.fft.irfft(spectrum, white.size)
    pink /= pink.std()
    noise = d.noise * (np.sqrt(1.0 - d.flicker) * white + np.sqrt(d.flicker) * pink)
    tilt = rng.normal() * 0.02 * d.load / abs(float(ideal.down[0] - base))
    offset = rng.normal() * d.load

    def part(role: Any, z: np.ndarray, force: np.ndarray, first: int) -> Segment:
        there = force + offset + tilt * (z - base) + noise[first : first + z.size]
        shown = there * ideal.gain * sensitivity * stiffness
        time = (first + np.arange(z.size)) / rate
        return Segment(role, time, z - base, "height (measured)", shown, shown / (d.stiffness * stiffness))

    down = part("approach", ideal.down, ideal.down_force, 0)
    up = part("retract", ideal.up, ideal.up_force, n)
    meta = {"spring constant": d.stiffness * stiffness, "sensitivity": 5e-8}
    return ForceCurve((down, up), meta, "drawn"), d.radius * radius


def clean(d: Draw) -> Ideal:
    return elastic(d, hertz(d))


def layer(d: Draw) -> Ideal:
    """Bonded to rigid ground, incompressible (Garcia and Garcia 2018), a/t 0.25 to 2."""
    over = np.exp(d.rng.uniform(np.log(0.25), np.log(2.0))) / np.sqrt(d.radius * d.depth)

    def law(x: np.ndarray) -> np.ndarray:
        q = np.sqrt(d.radius * x) * over
        return hertz(d)(x) * (1 + 1.133 * q + 1.283 * q**2 + 0.769 * q**3 + 0.0975 * q**4)

    return elastic(replace(d, depth=d.depth), law)


def reads_low(d: Draw) -> Ideal:
    """The detector shows 40 to 80 % of the deflection, on a sample that the lever hardly dents: a reference."""
    d = replace(d, stiffness=d.load / (d.depth * np.exp(d.rng.uniform(np.log(4.0), np.log(40.0)))))
    return replace(elastic(d, hertz(d)), gain=d.rng.uniform(0.4, 0.8))


def jump(d: Draw) -> Ideal:
    """The level of the approach jumps by 3 to 40 % of the load before the contact, either way."""
    made = elastic(d, hertz(d))
    begin = int(np.argmax(made.down < 0.0))
    place = int(begin * d.rng.uniform(0.3, 0.97))
    force = made.down_force.copy()
    force[place:] += np.exp(d.rng.uniform(np.log(0.03), np.log(0.4))) * d.load * d.rng.choice([-1.0, 1.0])
    return replace(made, down_force=force)


def in_contact(d: Draw) -> Ideal:
    """The ramp begins with 3 to 60 % of the contact's travel behind it."""
    return elastic(d, hertz(d), begin=d.rng.uniform(0.03, 0.6))


def adhesive(d: Draw) -> Ideal:
    """JKR or DMT, of a pull-off force of 5 to 100 % of the load; the tip jumps in and is torn off."""
    pull_off = np.exp(d.rng.uniform(np.log(0.05), 0.0)) * d.load
    if d.rng.random() < 0.5:
        w = pull_off / (1.5 * np.pi * d.radius)
        zero = (9 * np.pi * w * d.radius**2 / (8 * d.modulus)) ** (1 / 3)
        a = np.geomspace(0.2 * zero, 3 * np.sqrt(d.radius * d.depth) + 3 * zero, 20000)
        force = 4 * d.modulus * a**3 / (3 * d.radius) - np.sqrt(8 * np.pi * w * d.modulus * a**3)
        x = a**2 / d.radius - np.sqrt(2 * np.pi * w * a / d.modulus)
    else:
        x = np.r_[0.0, np.geomspace(1e-6, 2.0, 20000)] * d.depth
        force = hertz(d)(x) - pull_off
    base = x + force / d.stiffness
    turn = int(np.argmin(base))
    base, force = base[turn:], force[turn:]
    deepest = float(np.interp(d.load, force, base))
    reach = max(deepest, -float(base[0]))
    height = np.linspace(d.free * reach, -deepest, d.points)
    down = np.where(-height >= 0.0, np.interp(-height, base, force), 0.0)
    up = np.where(-height >= base[0], np.interp(-height, base, force), 0.0)
    return Ideal(height, down, height[::-1], up[::-1], d.modulus)


def cone(d: Draw) -> Ideal:
    """Taken for a sphere; of the same load at the depth for a half angle of 15 to 70 degrees."""
    slope = np.tan(np.radians(d.rng.uniform(15.0, 70.0)))
    modulus = d.load / (2.0 / np.pi * slope * d.depth**2)
    made = elastic(d, lambda x: 2.0 / np.pi * modulus * slope * x**2)
    return replace(made, modulus=modulus)


def wide(d: Draw) -> Ideal:
    """Contact radius 0.7 R to 3 R: a sphere that goes over into a cone of 15 to 40 degrees, exactly (Maugis 1992)."""
    angle = np.radians(d.rng.uniform(15.0, 40.0))
    blend, cot = d.radius * np.cos(angle), 1.0 / np.tan(angle)
    a = np.geomspace(1e-3, 4.0, 6000) * d.radius
    inside = np.minimum(a, blend * (1 - 1e-12))
    # flat Abel sums of the profile's slope: z' = r/sqrt(R^2 - r^2) up to the blend, then cot(angle)
    x, force = np.empty_like(a), np.empty_like(a)
    angles = 0.5 * np.pi * (np.arange(400) + 0.5) / 400
    for i, one in enumerate(a):
        r = one * np.sin(angles)
        slope = np.where(r < inside[i], r / np.sqrt(np.clip(d.radius**2 - r**2, 1e-30, None)), cot)
        slope = np.where(r < blend, slope, cot)
        x[i] = one * np.mean(slope) * 0.5 * np.pi  # a int z'(r)/sqrt(a^2 - r^2) dr
        force[i] = 2.0 * d.modulus * one**2 * np.mean(slope * np.sin(angles) ** 2) * 0.5 * np.pi
    reach = float(np.interp(np.exp(d.rng.uniform(np.log(0.7), np.log(3.0))) * d.radius, a, x))
    deep = replace(d, depth=reach)
    load = float(np.interp(reach, x, force))
    ratio = d.load / (d.stiffness * d.depth)
    deep = replace(deep, stiffness=load / (ratio * reach), noise=d.noise / d.load * load)
    return elastic(deep, lambda u: np.interp(u, np.r_[0.0, x], np.r_[0.0, force]))


def foot(d: Draw) -> Ideal:
    """A soft film that takes up 5 to 40 % of the depth before the sample is felt."""
    film, soft = d.depth * d.rng.uniform(0.05, 0.4), d.load * np.exp(d.rng.uniform(np.log(0.01), np.log(0.3)))
    x = np.r_[0.0, np.geomspace(1e-9, 3.0, 4000)] * d.depth
    force = hertz(d)(x)
    both = x + film * force / (force + soft)
    return elastic(replace(d, depth=d.depth + film), lambda u: np.interp(u, both, force))


def bow(d: Draw) -> Ideal:
    """The free branch is bent by 2 to 30 % of the load over the whole travel, the same on both branches."""
    made = elastic(d, hertz(d))
    size = np.exp(d.rng.uniform(np.log(0.02), np.log(0.3))) * d.load * d.rng.choice([-1.0, 1.0])
    path = np.linspace(0.0, 1.0, made.down.size)
    bent = size * 4.0 * (path - 0.5) ** 2
    return replace(made, down_force=made.down_force + bent, up_force=made.up_force + bent[::-1])


def drift(d: Draw) -> Ideal:
    """The sample moves by up to 10 % of the speed, and the level of the force wanders by up to 20 % of the load."""
    made = elastic(d, hertz(d))
    share, level = d.rng.uniform(-0.1, 0.1), d.rng.uniform(-0.2, 0.2) * d.load
    time = np.linspace(0.0, 1.0, made.down.size + made.up.size)
    wander, n = level * time, made.down.size
    travel = made.down[0] - made.down[-1]
    down = made.down + share * travel * 2.0 * (time[:n] - 0.5)
    up = made.up + share * travel * 2.0 * (time[n:] - 0.5)
    return Ideal(down, made.down_force + wander[:n], up, made.up_force + wander[n:], d.modulus)


def viscous(d: Draw) -> Ideal:
    """A power law of time of exponent 0.05 to 0.5, there (Lee and Radok) and back (Ting), the indentation at an even
    rate; the modulus is that of relaxation after the time of loading."""
    alpha = d.rng.uniform(0.05, 0.5)
    t = np.linspace(0.0, 2.0, 4001)  # of the time of loading
    there = t[t <= 1.0]
    down = there ** (1.5 - alpha)
    back = t[t > 1.0]
    first = back - 2.0 ** (1.0 / (1.0 - alpha)) * (back - 1.0)
    up = back ** (1.5 - alpha) * betainc(1.5, 1.0 - alpha, np.clip(first / back, 0.0, 1.0)) * (first > 0.0)
    scale = d.load * 1.5 * beta(1.5, 1.0 - alpha)  # E(t_c) is the modulus
    x_down, x_up = there * d.depth, (2.0 - back) * d.depth
    down, up = scale * down, scale * up
    base = x_down + down / d.stiffness
    height = np.linspace(d.free * base[-1], -base[-1], d.points)
    shown = np.interp(-height, base, down, left=0.0)
    base_up = np.r_[base[-1], x_up + up / d.stiffness]
    rising = np.interp(-height[::-1], base_up[::-1], np.r_[down[-1], up][::-1], left=0.0)
    return Ideal(height, shown, height[::-1], rising, d.modulus)


def clipped(d: Draw) -> Ideal:
    """The detector ends at 40 to 95 % of the load."""
    made = elastic(d, hertz(d))
    most = d.rng.uniform(0.4, 0.95) * d.load
    return replace(made, down_force=np.minimum(made.down_force, most), up_force=np.minimum(made.up_force, most))


def few(d: Draw) -> Ideal:
    """8 to 40 points in contact, or a free part of 1 to 15 % of the contact's travel."""
    if d.rng.random() < 0.5:
        return elastic(d, hertz(d), free=d.rng.uniform(0.01, 0.15))
    within = int(d.rng.integers(8, 41))
    return elastic(replace(d, points=int(within * (1.0 + d.free)) + 1), hertz(d))


KINDS: dict[str, Callable[[Draw], Ideal]] = {
    "clean": clean, "layer": layer, "reads low": reads_low, "jump": jump, "in contact": in_contact,
    "adhesive": adhesive, "cone": cone, "wide": wide, "foot": foot, "bow": bow, "drift": drift, "viscous": viscous,
    "clipped": clipped, "few": few,
}  # fmt: skip
