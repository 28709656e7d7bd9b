# SPDX-License-Identifier: BSD-3-Clause
"""What a scan will do to the sample, and how fast it may be, before it begins."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from nanotouch.errors import SolverError
from nanotouch.scan.overshoot import limit_of, peak_bounds, places, single_set_point, steepest
from nanotouch.scan.rehearsal import rehearse, rests_slower
from nanotouch.scan.scanner import LoopMargins, Scanner
from nanotouch.scan.steady import Steady, SteadyMotion
from nanotouch.scan.tapping import Tapping
from nanotouch.scene import Scene
from nanotouch.scene.surface import Surface
from nanotouch.units import in_words

_ACCURACY = 0.02  # of amplitude and peak force
_LARGEST, _SMALLEST, _SHARES = 0.98, 0.06, 24  # set points over A0 that are tried
_HALVINGS = 6
_FLAT = 1e-15  # range of heights that rounding leaves of a flat [m]
_SIGMAS = 5.0  # of the noise of a reading that may not lift the tip
_ELECTRONVOLT = 1.602176634e-19
_OUT_OF_REACH = {
    "tapping": "no motion has this amplitude; take a larger zloop.set_amplitude or free amplitude",
    "phase": "attraction or losses keep the lag of a tip that is repelled from it; take a larger free amplitude, a "
    "stiffer lever, a sharper tip or another zloop.set_phase, or hold the amplitude",
}


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
    peak_bound: float
    """tapping: no tap is harder [N], also where the lever goes over from one motion to another; inf: no bound; contact:
    NaN"""
    safe_free_amplitude: float
    """tapping: the largest A0 found, no larger than the one in use, at which that bound keeps below the limit, with a
    speed that is smaller by as much [m]; not every smaller one does; NaN: none found down to a twentieth of it"""
    single_set_point: float
    """tapping: where two motions have the set point, the nearest A/A0 that only one has over a flat; NaN: none, or not
    needed"""
    unrest: float
    """tapping: range of the reading of a z loop that does not come to rest over a flat [m]; 0: it does"""
    rests_slower: bool
    """tapping: whether it comes to rest there with a quarter of the K_I in use"""

    def __str__(self) -> str:
        return "\n".join([*map(self._motion, self.motions), *self._change(), self._safe(), *self._loop()])

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

    def _change(self) -> list[str]:
        if self.mode == "contact":
            return []
        told = self._hardest()
        if len(self.motions) == 1:
            return [told]
        alone = (
            f"a set point of {self.single_set_point:.2g} A0 has one alone"
            if math.isfinite(self.single_set_point)
            else "no set point has one alone: another free amplitude may"
        )
        return [f"bistable at this set point: the lever may jump from one motion to the other; {alone}", told]

    def _hardest(self) -> str:
        if math.isfinite(self.peak_bound):
            told = f"no harder than {in_words(self.peak_bound, 'N', 3)}"
            return f"any tap: {told}, also where the lever goes over from one motion to another"
        if math.isinf(self.flank_force):
            return "any tap: no bound, for up the steepest slope the tip no longer taps, and is pressed on: scan slower"
        return (
            "any tap: no bound, for the tip may stay in the sample where base and surface come together: scan slower; "
            "if that does not help, with a lower K_I"
        )

    def _safe(self) -> str:
        limit = f"{in_words(self.force_limit, 'N', 3)} ({self.limit_reason})"
        if self.mode == "contact":
            return f"safe set point: up to {in_words(self.safe_set_point, 'N', 3)}: then no more than {limit}"
        if math.isnan(self.safe_set_point):
            return f"safe set point: none with this lever and amplitude keeps the peak force below {limit}"
        which = "any" if self.safe_set_point == 0.0 else f"from {self.safe_set_point:.2g} A0 upwards"
        return f"safe set point: {which}, the peak force of its motions stays below {limit}{self._amplitude()}"

    def _amplitude(self) -> str:
        if self.peak_bound <= self.force_limit:
            return ", and so does any tap"
        if math.isnan(self.safe_free_amplitude):
            return "; no smaller free amplitude, as much slower, is known to keep any tap below"
        return f"; any tap does with a free amplitude of {in_words(self.safe_free_amplitude, 'm', 3)}, as much slower"

    def _loop(self) -> list[str]:
        lines = [
            f"z loop: K_I {self.integral:.3g} 1/s, gain margin {self.margins.gain:.3g}, phase margin "
            f"{math.degrees(self.margins.phase):.3g} degrees; advice: up to {self.advised_integral:.3g} 1/s"
        ]
        if self.unrest > 0.0:
            lines.append(self._unrest())
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

    def _unrest(self) -> str:
        swings = f"at rest: no; over a flat the reading goes to and fro by {in_words(self.unrest, 'm', 2)}"
        if self.rests_slower:
            return f"{swings}; with a quarter of this K_I it comes to rest"
        return (
            f"{swings}, and so it does with a quarter of this K_I: the tip is caught and let go from tap to tap, or no "
            "motion has this set point. Take another set point, a larger free amplitude, a stiffer lever or a sharper "
            "tip; dry air, where there is water"
        )

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
        return [f"hollows: peak force {in_words(self.hollow_force, 'N', 3)} in the narrowest one"]


def forecast(scanner: Scanner, scene: Scene, surface: Surface | None = None) -> Forecast:
    """What a scanner will do to the sample of a scene: forces over a flat, to 2 % by the cheapest tier that keeps that
    (:class:`Steady`); speeds by the rules of its loop over a surface."""
    mode = str(scanner.scan.zloop.mode)
    limit, reason = limit_of(scene)
    slope, height = (0.0, 0.0) if surface is None else steepest(scanner, surface)
    if height < _FLAT:
        slope = height = 0.0
    lag = scanner.speed * slope / scanner.integral
    motions, safe, flank = _contact(scanner, limit, lag) if mode == "contact" else _tapping(scanner, scene, limit, lag)
    return Forecast(
        motions, limit, reason, safe, scanner.margins, scanner.integral, scanner.advised_integral, scanner.speed, slope,
        scanner.speed_limit(slope, 1e-9) if slope > 0.0 else math.inf, height,
        scanner.parachute(height) if height > 0.0 else 0.0, mode, flank, _largest_set_point(scanner, lag),
        scanner.noise, _hollow_force(scanner, scene, surface, lag),
        *peak_bounds(scanner, scene, surface),
        single_set_point(scanner, scene, _wanted(scanner)) if len(motions) > 1 else math.nan,
        *_rest(scanner, scene),
    )  # fmt: skip


def _rest(scanner: Scanner, scene: Scene) -> tuple[float, bool]:
    unrest = 0.0 if scanner.scan.zloop.mode == "contact" else rehearse(scanner, scene).unrest
    return unrest, unrest == 0.0 or rests_slower(scanner, scene)


def _largest_set_point(scanner: Scanner, lag: float) -> float:
    """On the way down a slope the reading is off by the lag [m] for good; beyond the surface it can be off by no more
    than A0 - A, or by the set force over k_c."""
    needed = max(lag, _SIGMAS * scanner.scan["zloop.noise"])
    if scanner.scan.zloop.mode == "contact":
        return float(needed * scanner.rig["probe.spring_constant"])
    share = 1.0 - needed / float(scanner.drive["drive.free_amplitude"])
    return share if share > 0.0 else math.nan


def _hollow_force(scanner: Scanner, scene: Scene, surface: Surface | None, lag: float) -> float:
    """Where a sphere lies in a hollow its contact is that of a larger one: the widest of what is scanned, at the
    reading of a loop that lags."""
    if scanner.scan.zloop.mode == "contact" or surface is None or surface.tip_radius is None:
        return 0.0
    x, y = places(scanner, surface)
    widest = float(np.max(surface.radius_map.radius(x[None, :], y[:, None]).radius))
    if widest <= scene["tip.radius"]:
        return 0.0
    hollow = scene.copy()
    hollow.tip.radius = widest
    steady, wanted = Steady(hollow.plan(), scanner.rig, scanner.drive, accuracy=_ACCURACY), _wanted(scanner)
    readings = [one for one in (wanted, wanted - lag / float(scanner.drive["drive.free_amplitude"])) if one > 0.0]
    found = [_of_reading(scanner, steady, one, lifted) for one in readings for lifted in (False, True)]
    return max((_most(one) for one in found if one is not None), default=math.inf)


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
        raise SolverError(f"no height gives the set point: {_OUT_OF_REACH[str(scanner.scan.zloop.mode)]}")
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
