# SPDX-License-Identifier: BSD-3-Clause
"""What a scan will do to the sample, and how fast it may be, before it begins."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from nanotouch._arrays import Floats
from nanotouch.errors import SolverError
from nanotouch.scan.scanner import LoopMargins, Scanner
from nanotouch.scan.steady import Steady, SteadyMotion
from nanotouch.scan.tapping import Tapping
from nanotouch.scene import Scene
from nanotouch.scene.surface import Surface
from nanotouch.units import in_words

_ACCURACY = 0.02  # of amplitude and peak force
_LARGEST, _SMALLEST, _SHARES = 0.98, 0.06, 24  # set points over A0 that are tried
_HALVINGS = 6
_SIGMAS = 5.0  # of the noise of a reading that may not lift the tip
_ELECTRONVOLT = 1.602176634e-19


class Motion(NamedTuple):
    """A steady motion at the set point, over a flat."""

    peak_force: float
    """[N]"""
    force_bound: float
    """by how much the peak force may be wrong [N]; 0 by the time domain, and in contact mode; NaN where no motion of
    the set point repeats, and the other values are those of Q periods"""
    indentation: float
    """[m]; below 0: the tip turns back before contact"""
    contact_time: float
    """share of the period; 1 in contact mode"""
    phase: float
    """[rad]; pi/2 free, less in repulsion; 0 in contact mode"""
    loss: float
    """energy that a tap leaves in the contact [J]"""


class Forecast(NamedTuple):
    """What is known before a scan; as text a paragraph."""

    motions: tuple[Motion, ...]
    """at the set point: coming down first, then the other one where two coexist"""
    force_limit: float
    """that the sample or the scene allows [N]"""
    limit_reason: str
    """which of them"""
    safe_set_point: float
    """tapping: the least A/A0 that keeps below the limit, 0: any; NaN where none does; contact: largest force [N]"""
    margins: LoopMargins
    """of the z loop"""
    integral: float
    """K_I in use [1/s]"""
    advised_integral: float
    """largest one with a gain margin of 2 and 45 degrees [1/s]"""
    speed: float
    """of the tip [m/s]"""
    slope: float
    """steepest along a line, of the surface as the tip sees it [-]"""
    speed_limit: float
    """that keeps 1 nm there [m/s]; inf over a flat"""
    height: float
    """range of the surface [m]"""
    parachute: float
    """way that the tip flies after a step down by that height, at the speed [m]"""
    mode: str
    """``"contact"``, ``"tapping"`` or ``"phase"``"""
    flank_force: float
    """peak force where the tip climbs the steepest slope at the speed of the scan [N]; inf: it no longer taps there"""
    largest_set_point: float
    """tapping: the largest A/A0 with which the tip follows that slope down, and noise does not lift it; contact: the
    least force for the same [N]; NaN where none does"""
    noise: float
    """standard deviation of the heights by the noise of the reading [m]"""
    hollow_force: float
    """tapping: peak force in the narrowest hollow of the surface, where the contact is widest [N]; inf: it no longer
    taps there; 0 without a hollow, and in contact mode"""

    def __str__(self) -> str:
        return "\n".join([*map(self._motion, self.motions), self._safe(), *self._loop()])

    def _motion(self, motion: Motion) -> str:
        if self.mode == "contact":
            return f"force: {in_words(motion.peak_force, 'N', 3)} at the set point"
        side = "repulsive" if motion.phase < math.pi / 2 else "attractive"
        depth = (
            f"the tip goes {in_words(motion.indentation, 'm', 3)} in, {100 * motion.contact_time:.2g} % of the period"
            if motion.contact_time > 0.0
            else f"the tip turns back {in_words(-motion.indentation, 'm', 3)} before contact"
        )
        if math.isnan(motion.force_bound):
            return (
                "no steady motion: from tap to tap the tip is caught or not; in Q periods the peak force is "
                f"{in_words(motion.peak_force, 'N', 3)}"
            )
        within = f" within {in_words(motion.force_bound, 'N', 3)}" if motion.force_bound > 0.0 else ""
        return (
            f"{side} motion: peak force {in_words(motion.peak_force, 'N', 3)}{within}, phase "
            f"{math.degrees(motion.phase):.3g} degrees, {motion.loss / _ELECTRONVOLT:.3g} eV lost in a tap; {depth}"
        )

    def _safe(self) -> str:
        limit = f"{in_words(self.force_limit, 'N', 3)} ({self.limit_reason})"
        if self.mode == "contact":
            return f"safe set point: up to {in_words(self.safe_set_point, 'N', 3)}: then no more than {limit}"
        if math.isnan(self.safe_set_point):
            return f"safe set point: none with this lever and amplitude keeps the peak force below {limit}"
        if self.safe_set_point == 0.0:
            return f"safe set point: any, the peak force stays below {limit}"
        return f"safe set point: from {self.safe_set_point:.2g} A0 upwards the peak force stays below {limit}"

    def _loop(self) -> list[str]:
        lines = [
            f"z loop: K_I {self.integral:.3g} 1/s, gain margin {self.margins.gain:.3g}, phase margin "
            f"{math.degrees(self.margins.phase):.3g} degrees; advice: up to {self.advised_integral:.3g} 1/s"
        ]
        if math.isfinite(self.speed_limit):
            lines.append(
                f"speed: {in_words(self.speed, 'm', 3)}/s; the steepest slope, {self.slope:.3g}, is followed within "
                f"1 nm up to {in_words(self.speed_limit, 'm', 3)}/s, at this speed within "
                f"{in_words(1e-9 * self.speed / self.speed_limit, 'm', 2)}"
            )
            lines.append(self._flank())
            lines += self._hollow()
            lines.append(
                f"parachuting: after a step down by {in_words(self.height, 'm', 3)} the tip flies "
                f"{in_words(self.parachute, 'm', 3)} far"
            )
        lines.append(f"noise: {in_words(self.noise, 'm', 2)} rms in the heights of a flat; it grows as the root of K_I")
        return lines

    def _flank(self) -> str:
        climbs = (
            f"peak force {in_words(self.flank_force, 'N', 3)} up that slope"
            if math.isfinite(self.flank_force)
            else "up that slope the tip no longer taps at this speed"
        )
        if math.isnan(self.largest_set_point):
            return f"flanks: {climbs}; down it no set point keeps the tip at the surface"
        point = (
            f"a set point of {in_words(self.largest_set_point, 'N', 3)} and more"
            if self.mode == "contact"
            else f"a set point up to {self.largest_set_point:.2g} A0"
        )
        return f"flanks: {climbs}; down it {point} keeps the tip at the surface"

    def _hollow(self) -> list[str]:
        if not self.hollow_force > 0.0:
            return []
        if math.isinf(self.hollow_force):
            return ["hollows: in the narrowest one the sample may hold the tip, which no longer taps"]
        over = "; a tap is harder still where the lever goes over to the repulsive motion" * (len(self.motions) > 1)
        return [f"hollows: peak force {in_words(self.hollow_force, 'N', 3)} in the narrowest one{over}"]


def forecast(scanner: Scanner, scene: Scene, surface: Surface | None = None) -> Forecast:
    """What a scanner will do to the sample of a scene: forces over a flat, to 2 % by the cheapest tier that keeps that
    (:class:`Steady`); speeds by the rules of its loop over a surface."""
    mode = str(scanner.scan.zloop.mode)
    limit, reason = _limit(scene)
    slope, height = (0.0, 0.0) if surface is None else steepest(scanner, surface)
    lag = scanner.speed * slope / scanner.integral
    motions, safe, flank = _contact(scanner, limit, lag) if mode == "contact" else _tapping(scanner, scene, limit, lag)
    return Forecast(
        motions, limit, reason, safe, scanner.margins, scanner.integral, scanner.advised_integral, scanner.speed, slope,
        scanner.speed_limit(slope, 1e-9) if slope > 0.0 else math.inf, height,
        scanner.parachute(height) if height > 0.0 else 0.0, mode, flank, _largest_set_point(scanner, lag),
        scanner.noise, _hollow_force(scanner, scene, surface, lag),
    )  # fmt: skip


def _largest_set_point(scanner: Scanner, lag: float) -> float:
    """On the way down a slope the reading is off by the lag [m] for good; beyond the surface it can be off by no more
    than A0 - A, or by the set force over k_c."""
    needed = max(lag, _SIGMAS * scanner.scan["zloop.noise"])
    if scanner.scan.zloop.mode == "contact":
        return float(needed * scanner.rig["probe.spring_constant"])
    share = 1.0 - needed / float(scanner.drive["drive.free_amplitude"])
    return share if share > 0.0 else math.nan


def steepest(scanner: Scanner, surface: Surface) -> tuple[float, float]:
    """The steepest slope along a line, and the range of heights [m], of what is scanned."""
    x, y = _places(scanner, surface)
    z = np.asarray(surface.height(x[None, :], y[:, None])) + scanner.scan.raster.tilt_x * x
    return float(np.abs(np.diff(z, axis=1)).max() / (x[1] - x[0])), float(np.ptp(z, axis=1).max())


def _places(scanner: Scanner, surface: Surface) -> tuple[Floats, Floats]:
    """x along a line and y of up to 64 lines [m]."""
    raster = scanner.scan.raster
    pixel = min(surface.topography.pixel_size[1], raster.width / raster.pixels)
    x = np.linspace(raster.x, raster.x + raster.width, min(int(4 * raster.width / pixel), 20000) + 2)
    lines = min(int(raster.lines), 64)
    return x, raster.y + (np.arange(lines) + 0.5) * raster.height / lines


def _hollow_force(scanner: Scanner, scene: Scene, surface: Surface | None, lag: float) -> float:
    """Where a sphere lies in a hollow its contact is that of a larger one: the widest of what is scanned, at the
    reading of a loop that lags."""
    if scanner.scan.zloop.mode == "contact" or surface is None or surface.tip_radius is None:
        return 0.0
    x, y = _places(scanner, surface)
    widest = float(np.max(surface.radius_map.radius(x[None, :], y[:, None]).radius))
    if widest <= scene["tip.radius"]:
        return 0.0
    hollow = scene.copy()
    hollow.tip.radius = widest
    steady, wanted = Steady(hollow.plan(), scanner.rig, scanner.drive, accuracy=_ACCURACY), _wanted(scanner)
    readings = [one for one in (wanted, wanted - lag / float(scanner.drive["drive.free_amplitude"])) if one > 0.0]
    found = [_of_reading(scanner, steady, one, lifted) for one in readings for lifted in (False, True)]
    return max((_most(one) for one in found if one is not None), default=math.inf)


def _limit(scene: Scene) -> tuple[float, str]:
    """The load that the scene allows, or that at which the sample yields: P_y = pi^3 R^2/(6 E*^2) (1.6 Y)^3."""
    most, reason = float(scene["range.maximum_load"]), "the scene's maximum load"
    strength, modulus = float(scene["sample.yield_strength"]), float(scene.plan().explain()["effective_modulus"])
    if strength > 0.0:
        yields = math.pi**3 * scene["tip.radius"] ** 2 / (6.0 * modulus**2) * (1.6 * strength) ** 3
        if yields < most:
            return yields, "there the sample yields"
    return most, reason


def _contact(scanner: Scanner, limit: float, lag: float) -> tuple[tuple[Motion, ...], float, float]:
    force = float(scanner.scan["zloop.set_force"])
    flank = force + lag * scanner.rig["probe.spring_constant"]
    return (Motion(force, 0.0, math.nan, 1.0, 0.0, 0.0),), limit, flank


def _tapping(scanner: Scanner, scene: Scene, limit: float, lag: float) -> tuple[tuple[Motion, ...], float, float]:
    """Steady motions, to an accuracy: at the set point, those that are too loud, and one where the tip climbs."""
    A0 = float(scanner.drive["drive.free_amplitude"])
    steady = Steady(scene.plan(), scanner.rig, scanner.drive, accuracy=_ACCURACY)
    wanted = _wanted(scanner)
    motions: list[Motion] = []
    for lifted in (False, True):
        found = _of_reading(scanner, steady, wanted, lifted)
        if found is not None and all(abs(found.phase - other.phase) > 0.05 for other in motions):
            motions.append(
                Motion(found.peak_force, found.force_bound, -found.lowest_gap, found.contact_time, found.phase,
                       found.tip_loss)
            )  # fmt: skip
    if not motions:
        motions.append(_to_and_fro(scanner, steady, wanted * A0))
    reading = wanted - lag / A0
    climbing = [_of_reading(scanner, steady, reading, lifted) for lifted in (False, True)] if reading > 0.0 else []
    climbs = max((_most(one) for one in climbing if one is not None), default=math.inf)
    return tuple(motions), _safe(steady, A0, limit), max(climbs, *(one.peak_force for one in motions))


def _to_and_fro(scanner: Scanner, steady: Steady, height: float) -> Motion:
    """Where no motion of the set point repeats: what happens in Q periods near the height that a hard sample would
    have."""
    tapping = Tapping(steady.plan, scanner.rig, scanner.drive, tolerance=1e-7)
    settled = tapping.settle(height)
    if settled.value.contact_time > 0.999:
        raise SolverError(
            "at this set point the sample holds the tip, which no longer taps: a stiffer lever or a larger free "
            "amplitude frees it"
        )
    if settled.settled:
        raise SolverError("no height gives the set point: it is out of the lever's reach")
    value = tapping.run(settled.state, height, math.ceil(scanner.rig["probe.quality"]))[1]
    return Motion(value.peak_force, math.nan, -value.lowest_gap, value.contact_time, value.phase, value.tip_loss)


def _most(motion: SteadyMotion) -> float:
    """The peak force that a motion may have [N]."""
    return motion.peak_force + motion.force_bound


def _safe(steady: Steady, A0: float, limit: float) -> float:
    """The least A/A0 from which on no motion exceeds the limit [N]; NaN where even the largest one does."""

    def is_loud(share: float) -> bool:
        found = (steady.at_amplitude(share * A0, lifted) for lifted in (False, True))
        return any(one is not None and _most(one) > limit for one in found)

    shares = np.linspace(_LARGEST, _SMALLEST, _SHARES)
    for above, share in pairwise((math.nan, *map(float, shares))):
        if is_loud(share):
            low, high = share, above
            for _ in range(_HALVINGS if math.isfinite(above) else 0):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if is_loud(middle) else (low, middle)
            return high
    return 0.0


def _wanted(scanner: Scanner) -> float:
    """The set point, as an amplitude over A0."""
    zloop = scanner.scan.zloop
    if zloop.mode == "phase":
        sine = math.sin(zloop.set_phase)
        return sine if zloop.set_phase <= math.pi / 2 else 2.0 - sine
    return float(zloop.set_amplitude)


def _of_reading(scanner: Scanner, steady: Steady, reading: float, lifted: bool) -> SteadyMotion | None:
    """The motion of what the z loop compares, an amplitude over A0: of phase feedback A0 sin phi, beyond 90 degrees
    A0 (2 - sin phi)."""
    if scanner.scan.zloop.mode == "phase":
        return steady.at_phase(
            math.asin(reading) if reading <= 1.0 else math.pi - math.asin(max(2.0 - reading, 0.0)), lifted
        )
    return steady.at_amplitude(reading * float(scanner.drive["drive.free_amplitude"]), lifted)
