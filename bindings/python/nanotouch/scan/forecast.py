# SPDX-License-Identifier: BSD-3-Clause
"""What a scan will do to the sample, and how fast it may be, before it begins."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from nanotouch.errors import SolverError
from nanotouch.scan.flow import FlowState, FlowValue, SlowFlow
from nanotouch.scan.scanner import LoopMargins, Scanner
from nanotouch.scan.tapping import Tapping, TappingState, TappingValue
from nanotouch.scene import Scene
from nanotouch.scene.surface import Surface
from nanotouch.units import in_words

_HEIGHTS = 40
_HALVINGS = 12
_SIGMAS = 5.0  # of the noise of a reading that may not lift the tip
_ELECTRONVOLT = 1.602176634e-19


class Motion(NamedTuple):
    """A steady motion at the set point, over a flat."""

    peak_force: float
    """[N]"""
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
        return (
            f"{side} motion: peak force {in_words(motion.peak_force, 'N', 3)}, phase "
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


def forecast(scanner: Scanner, scene: Scene, surface: Surface | None = None) -> Forecast:
    """What a scanner will do to the sample of a scene: forces by the time domain over a flat, speeds by the rules of
    its loop over a surface."""
    mode = str(scanner.scan.zloop.mode)
    limit, reason = _limit(scene)
    slope, height = (0.0, 0.0) if surface is None else steepest(scanner, surface)
    lag = scanner.speed * slope / scanner.integral
    motions, safe, flank = _contact(scanner, limit, lag) if mode == "contact" else _tapping(scanner, scene, limit, lag)
    return Forecast(
        motions, limit, reason, safe, scanner.margins, scanner.integral, scanner.advised_integral, scanner.speed, slope,
        scanner.speed_limit(slope, 1e-9) if slope > 0.0 else math.inf, height,
        scanner.parachute(height) if height > 0.0 else 0.0, mode, flank, _largest_set_point(scanner, lag),
        scanner.noise,
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
    raster = scanner.scan.raster
    pixel = min(surface.topography.pixel_size[1], raster.width / raster.pixels)
    x = np.linspace(raster.x, raster.x + raster.width, min(int(4 * raster.width / pixel), 20000) + 2)
    y = raster.y + (np.arange(min(int(raster.lines), 64)) + 0.5) * raster.height / min(int(raster.lines), 64)
    z = np.asarray(surface.height(x[None, :], y[:, None])) + raster.tilt_x * x
    return float(np.abs(np.diff(z, axis=1)).max() / (x[1] - x[0])), float(np.ptp(z, axis=1).max())


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
    return (Motion(force, math.nan, 1.0, 0.0, 0.0),), limit, force + lag * scanner.rig["probe.spring_constant"]


def _tapping(scanner: Scanner, scene: Scene, limit: float, lag: float) -> tuple[tuple[Motion, ...], float, float]:
    """Curves of the slow flow, down and up again; the motions at the set point by the time domain."""
    plan = scene.plan()
    flow = SlowFlow(plan, scanner.rig, scanner.drive)
    tapping = Tapping(plan, scanner.rig, scanner.drive, tolerance=1e-7)
    A0 = float(scanner.drive["drive.free_amplitude"])
    heights = [float(h) for h in np.linspace(1.3 * A0, -0.1 * A0, _HEIGHTS)]
    ways: list[list[tuple[FlowState, FlowValue]]] = []
    state: FlowState | None = None
    for order in (heights, heights[::-1]):
        way = []
        for height in order:
            state, value, _ = flow.settle(height, state)
            way.append((state, value))
        ways.append(way)
    ways[1].reverse()
    found = [one for one in (_at_set_point(scanner, flow, heights, way) for way in ways) if one is not None]
    if not found:
        raise SolverError("no height gives the set point: the lever is held, or the set point is out of its reach")
    motions: list[Motion] = []
    for height, state in found:
        begun = TappingState(state.real + state.mean, -state.imaginary * scanner.ratio)
        motion = _motion(tapping.settle(height, begun).value)
        if motion.contact_time < 1.0 and all(abs(motion.phase - other.phase) > 0.05 for other in motions):
            motions.append(motion)
    if not motions:
        raise SolverError(
            "at this set point the sample holds the tip, which no longer taps: a stiffer lever or a larger free "
            "amplitude frees it"
        )
    loud = [value.amplitude / A0 for way in ways for _, value in way if value.peak_force > limit]
    safe = max(loud, default=0.0)
    climbs = _force_at(scanner, ways[0], lag / A0)
    return tuple(motions), math.nan if safe >= 0.99 else safe, max(climbs, motions[0].peak_force)


def _force_at(scanner: Scanner, way: list[tuple[FlowState, FlowValue]], below: float) -> float:
    """The peak force at a reading below the set point, over A0, where the way down meets it."""
    wanted = _wanted(scanner) - below
    for (_, above), (_, under) in pairwise(way):
        high, low = _reading(scanner, above), _reading(scanner, under)
        if low < wanted <= high:
            return float(np.interp(wanted, (low, high), (under.peak_force, above.peak_force)))
    return math.inf


def _wanted(scanner: Scanner) -> float:
    """The set point, as an amplitude over A0."""
    zloop = scanner.scan.zloop
    return math.sin(zloop.set_phase) if zloop.mode == "phase" else float(zloop.set_amplitude)


def _reading(scanner: Scanner, value: FlowValue) -> float:
    """What the z loop compares: an amplitude over A0."""
    if scanner.scan.zloop.mode == "phase":
        sine = math.sin(value.phase)
        return sine if value.phase <= math.pi / 2 else 2.0 - sine
    return value.amplitude / float(scanner.drive["drive.free_amplitude"])


def _at_set_point(
    scanner: Scanner, flow: SlowFlow, heights: list[float], way: list[tuple[FlowState, FlowValue]]
) -> tuple[float, FlowState] | None:
    """Where a curve first falls below the set point from above; halved from there."""
    wanted = _wanted(scanner)
    for i in range(1, len(way)):
        if _reading(scanner, way[i][1]) < wanted <= _reading(scanner, way[i - 1][1]):
            high, low, state = heights[i - 1], heights[i], way[i][0]
            for _ in range(_HALVINGS):
                middle = 0.5 * (high + low)
                after, value, _ = flow.settle(middle, state)
                if _reading(scanner, value) < wanted:
                    low, state = middle, after
                else:
                    high = middle
            return low, state
    return None


def _motion(value: TappingValue) -> Motion:
    return Motion(value.peak_force, -value.lowest_gap, value.contact_time, value.phase, value.tip_loss)
