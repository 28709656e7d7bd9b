# SPDX-License-Identifier: BSD-3-Clause
"""The steps of the paper's work on one sample: scan, touch, push, scan again. Each knows only what the one before it
showed; the truth is kept beside, to judge by."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import nanotouch as nt
import numpy as np
from nanotouch import images, manipulation, scan
from nanotouch.manipulation import Pushed

RADIUS = 250e-9  # of the spheres [m]
TRUE = ((1.2e-6, 2.4e-6), (3.6e-6, 1.2e-6), (3.4e-6, 3.8e-6))  # where the particles lie [m]
TARGET = (3.5e-6, 2.5e-6)  # where the first of them shall go: between the others [m]
SIZE = 4.8e-6  # of the image [m]
SILICA = {"youngs_modulus": 72e9, "poisson_ratio": 0.17}
GLASS = {"youngs_modulus": 70e9, "poisson_ratio": 0.22}
PIXEL_RATE = 2.0  # of the scan, there and back [1/s]
WORK = 0.01  # of adhesion between tip and sphere [J/m^2]: a coated tip; with more it drags them back

HAMAKER = 1e-20  # through that coating [J]


Found = TypeVar("Found")


class Scanned(NamedTuple):
    """An image, and what was found on it."""

    image: scan.Image
    surface: nt.Topography
    """without the tip, levelled by nothing: the simulated scanner has no tilt"""
    particles: images.GrainTable


class Touched(NamedTuple):
    """A force curve on the top of a particle."""

    recording: nt.Recording
    pull_off: float
    """largest adhesion on the way back [N]"""
    predicted: float
    """by the plan [N]"""


def scene() -> nt.Scene:
    """A silicon tip of 20 nm on silica, in dry air."""
    made = nt.Scene(tip={"radius": 20e-9}, medium={"relative_humidity": 0.0})
    made.sample.youngs_modulus, made.sample.poisson_ratio = SILICA["youngs_modulus"], SILICA["poisson_ratio"]
    made.adhesion.work_of_adhesion, made.adhesion.hamaker_constant = WORK, HAMAKER
    return made


def particle() -> nt.Particle:
    """Silica on glass, pushed by that tip; rolls and slides as published for polystyrene."""
    tip = {"youngs_modulus": scene().tip.youngs_modulus, "poisson_ratio": scene().tip.poisson_ratio}
    substrate, flank = _contact(GLASS, 0.06, 0.0084 * RADIUS), _contact(tip, WORK, 0.0084 * scene().tip.radius)
    return nt.Particle(RADIUS, substrate, flank, tip_radius=scene().tip.radius, tip_half_angle=scene().tip.half_angle)


def _contact(other: dict[str, float], work: float, rolling: float) -> nt.ParticleContact:
    bodies = [value for body in (SILICA, other) for value in (body["youngs_modulus"], body["poisson_ratio"])]
    modulus, shear = nt.contact.effective_modulus(*bodies), nt.friction.effective_shear_modulus(*bodies)
    return nt.ParticleContact(modulus, shear, work, shear_strength=12e6, rolling_distance=rolling)


def scanned(places: list[tuple[float, float]], pixels: int, seed: int) -> Scanned:
    """A tapping image of the particles where they are."""
    made, rig = scene(), nt.Rig(probe={"spring_constant": 40.0, "quality": 400.0, "resonance": 300e3})
    sample = nt.surface.spheres(SIZE, round(SIZE / 10e-9), radius=RADIUS, centres=places)
    surface = nt.Surface.touched_by(made, sample)
    settings = nt.Scan(raster={"width": SIZE, "height": SIZE, "pixels": pixels, "lines": pixels}, zloop={"rate": 5e3})
    settings.raster.line_rate = PIXEL_RATE / pixels
    scanner = nt.Scanner(made.plan(0.3, surface=surface), settings, rig, nt.Drive(drive={"free_amplitude": 60e-9}))
    image = scanner.run(seed)
    tip = images.RoundedCone(made.tip.radius, made.tip.half_angle)
    without = image.without_tip(tip)
    return Scanned(image, without, images.grains(without))


def nearest(found: Scanned, place: tuple[float, float]) -> int:
    """Number of the particle that lies nearest to a place, from 1."""
    far = np.hypot(found.particles.x - place[0], found.particles.y - place[1])
    return int(far.argmin()) + 1


def touched(found: Scanned, number: int, seed: int) -> Touched:
    """Approach to and retract from the top of a particle of the map."""
    made, table = scene(), found.particles
    surface = nt.Surface.touched_by(made, found.surface)
    at = (float(table.x[number - 1]), float(table.y[number - 1]))
    session = nt.Session(scene=made, surface=surface, mode="curve", path=[at], seed=seed)
    recording = session.run()
    pull_off = -float(np.min(recording.columns["tip_force"]))
    return Touched(recording, pull_off, float(session.plan.pull_off_force))


def pushed(found: Scanned, number: int, seed: int) -> Pushed:
    """The first particle to the target, from where the map shows it, under drift and noise."""
    seen = float(found.particles.x[number - 1]), float(found.particles.y[number - 1])
    return manipulation.push(particle(), TARGET, start=TRUE[0], seen=seen, seed=seed)


class Work(NamedTuple):
    """The whole of it."""

    first: Scanned
    number: int
    """of the particle that goes"""
    touched: Touched
    pushed: Pushed
    predicted: nt.Topography
    """the first map, with the particle where the operator saw it last"""
    again: Scanned
    """what a scan shows afterwards"""

    def facts(self) -> dict[str, float]:
        """How far each step was from the truth [m], and what it took."""
        first, again = (_offset(one, place) for one, place in ((self.first, TRUE[0]), (self.again, self.target)))
        shown = np.array(_place(self.again, self.target)) - TARGET
        return {
            "map_error_m": first,
            "height_error_m": float(self.first.particles.height[self.number - 1]) - 2.0 * RADIUS,
            "largest_force_N": float(np.max(self.touched.recording.columns["tip_force"])),
            "pull_off_N": self.touched.pull_off,
            "planned_pull_off_N": self.touched.predicted,
            "pushes": self.pushed.pushes,
            "lines": self.pushed.lines,
            "bench_time_s": self.pushed.duration,
            "largest_push_N": float(np.abs(self.pushed.track.force[:, :2]).max()),
            "error_m": self.pushed.error,
            "predicted_error_m": float(np.linalg.norm(self.pushed.looks[-1] - self.pushed.position)),
            "map_error_again_m": again,
            "shown_error_m": float(np.hypot(*shown)),
        }

    @property
    def target(self) -> tuple[float, float]:
        """Where the particle truly is in the end [m]."""
        return float(self.pushed.position[0]), float(self.pushed.position[1])


def work(pixels: int, seed: int, kept: Callable[[str, Any], None] = lambda *_: None) -> Work:
    """All steps, one after another; `kept` is given what each finds, with its name in :class:`Work`."""

    def told(name: str, found: Found) -> Found:
        kept(name, found)
        return found

    first = told("first", scanned(list(TRUE), pixels, seed))
    number = nearest(first, TRUE[0])
    felt = told("touched", touched(first, number, seed))
    done = told("pushed", pushed(first, number, seed))
    believed, true = done.looks[-1], done.position
    predicted = images.moved(first.surface, first.particles, number, (float(believed[0]), float(believed[1])))
    told("predicted", predicted)
    again = told("again", scanned([(float(true[0]), float(true[1])), *TRUE[1:]], pixels, seed + 1))
    return Work(first, number, felt, done, predicted, again)


def _place(found: Scanned, near: tuple[float, float]) -> tuple[float, float]:
    number = nearest(found, near)
    return float(found.particles.x[number - 1]), float(found.particles.y[number - 1])


def _offset(found: Scanned, true: tuple[float, float]) -> float:
    """Between where a map shows a particle and where it is [m]."""
    return float(np.hypot(*(np.array(_place(found, true)) - true)))
