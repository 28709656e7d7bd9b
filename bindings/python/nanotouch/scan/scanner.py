# SPDX-License-Identifier: BSD-3-Clause
"""An image of a surface: lines there and back at a finite speed, with a z loop that keeps deflection, amplitude or
phase, through the rig's stage."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from nanotouch import _core
from nanotouch._arrays import Floats
from nanotouch.awaiting import each
from nanotouch.errors import InvalidValue, SolverError
from nanotouch.scan.steady import check_accuracy
from nanotouch.scan.tapping import Drive, Lever
from nanotouch.scene import Rig
from nanotouch.scene.plan import Plan

if TYPE_CHECKING:
    from nanotouch._fields import ScanFields
    from nanotouch.images import Paraboloid, RoundedCone, Topography
else:
    from nanotouch.scene.description import Description

    ScanFields = Description

STRIP = 64
"""lines that follow one coming down of the tip; strips go to the cores, with the same result on any number of them"""


Progress = Callable[[float], bool | None]
"""told the share that is done; False ends what goes on"""

UNDONE = "Height, tip undone"
"""channel of the heights without the tip"""


class Scan(ScanFields, core_type=_core.Scan):
    """What is scanned, how fast, what the z loop keeps, and what the read-outs of contact mode take from each other. In
    a file the tables ``[zloop]``, ``[raster]`` and ``[readout]``."""


class LoopMargins(NamedTuple):
    """How far a z loop is from ringing: over a hard sample, and tapping also at its set point over a flat."""

    gain: float
    """K_I may grow by this factor, at least"""
    phase: float
    """[rad]"""
    speed: float
    """where the open loop has gain 1 [rad/s]"""


class Channels(NamedTuple):
    """One direction of an image; arrays (lines, pixels), row 0 at the lower edge."""

    height: Floats
    """that the loop asked for: of the apex [m]"""
    error: Floats
    """set point minus reading [m]; of phase feedback as an amplitude"""
    signal: Floats
    """amplitude, of contact mode deflection [m]"""
    phase: Floats
    """lag behind the drive, 0 in contact mode [rad]"""
    peak_force: Floats
    """largest in the pixel [N]; NaN where nothing measures it: a real rig that taps"""
    lateral: Floats
    """force of the lever on the tip along x, as it is read [N]: against friction and up slopes; 0 in tapping mode"""


class Image(NamedTuple):
    """What a scan gives."""

    trace: Channels
    """there, along +x"""
    retrace: Channels
    """and back"""
    pixel_size: tuple[float, float]
    """(dy, dx) [m]"""
    mode: str
    """``"contact"``, ``"tapping"`` or ``"phase"``"""

    def topography(self, name: str = "scan") -> Topography:
        """The heights of the trace."""
        from nanotouch.images import Topography

        return Topography(self.trace.height, self.pixel_size, name, "Height", "nanotouch/scan")

    def without_tip(self, tip: Paraboloid | RoundedCone, name: str = "scan") -> Topography:
        """The heights of the trace without the tip that took them: a surface to touch."""
        from nanotouch.images import erode

        return replace(erode(self.topography(name), tip)[0], channel=UNDONE)

    def write(self, path: str | os.PathLike[str], tip: Paraboloid | RoundedCone | None = None) -> Path:
        """All channels as ``.gwy``, which :func:`nanotouch.images.read`, Gwyddion and gwyfile open; with a tip the
        heights that it leaves once more without it, :data:`UNDONE`: what to touch next."""
        from nanotouch.images import Plane, write_planes

        taps = self.mode != "contact"
        names = {"height": ("Height", "m"), "signal": ("Amplitude" if taps else "Deflection", "m")}
        names |= {"phase": ("Phase", "rad")} if taps else {}
        names |= {"error": ("Error", "m")}
        names |= {} if np.isnan(self.trace.peak_force).any() else {"peak_force": ("Peak force", "N")}
        names |= {} if taps else {"lateral": ("Lateral force", "N")}
        planes = [
            Plane(f"{name}{direction}", getattr(channels, key), unit, self.pixel_size, "nanotouch/scan")
            for key, (name, unit) in names.items()
            for direction, channels in (("", self.trace), (" retrace", self.retrace))
        ]
        if tip is not None:
            undone = self.without_tip(tip).heights
            planes.append(Plane(UNDONE, undone, "m", self.pixel_size, "nanotouch/scan"))
        return write_planes(path, planes)


def _whole(lines: Sequence[int]) -> int:
    """Lines from the first one on, of so many in each strip."""
    whole = next((number for number, count in enumerate(lines) if count < STRIP), len(lines))
    return STRIP * whole + sum(lines[whole : whole + 1])


class Scanner(Lever):
    """A raster over a plan's surface, prepared.

    Parameters
    ----------
    plan : Plan
        The force, over a surface that its tip has dilated, or a flat.
    scan : Scan, optional
        By default tapping at 0.7 A0, 256 x 256 pixels over 1 um x 1 um, one line per second.
    rig : Rig, optional
        Its probe is the lever, its stage moves it.
    drive : Drive, optional
        Of tapping; by default 20 nm at the base, at the free resonance.
    """

    def __init__(
        self, plan: Plan, scan: Scan | None = None, rig: Rig | None = None, drive: Drive | None = None
    ) -> None:
        plan.refuse_history("a scan")
        super().__init__(plan, rig, drive)
        self.scan = Scan() if scan is None else scan.copy()
        self._core = _core.Scanner(self.scan.core, self.rig.core, self.drive.core, plan.core)

    @property
    def integral(self) -> float:
        """K_I in use [1/s]."""
        return float(self._core.integral)

    @property
    def advised_integral(self) -> float:
        """The largest K_I with a gain margin of 2 and a phase margin of 45 degrees [1/s]."""
        return float(self._core.advised)

    @property
    def noise(self) -> float:
        """Standard deviation of the heights that the noise of the reading leaves on a hard flat [m]."""
        return float(self._core.noise)

    @property
    def margins(self) -> LoopMargins:
        """Of the z loop."""
        return LoopMargins(*self._core.margins)

    @property
    def speed(self) -> float:
        """Of the tip along a line [m/s]."""
        return 2.0 * self.scan["raster.width"] * self.scan["raster.line_rate"]

    @property
    def ratio(self) -> float:
        """Frequency of the drive over the free resonance."""
        return (self.drive["drive.frequency"] or self.rig["probe.resonance"]) / self.rig["probe.resonance"]

    def speed_limit(self, slope: float, error: float) -> float:
        """The fastest scan over a slope [-] that keeps the height within an error [m]: K_I error/slope [m/s]."""
        if not (abs(slope) > 0.0 and error > 0.0):
            raise InvalidValue(f"slope = {slope:g}, error = {error:g} m: neither may be 0")
        return float(self._core.speed(slope, error))

    def parachute(self, height: float, speed: float | None = None) -> float:
        """The way [m] that the tip flies after a step down by a height [m], v H/(K_I (A0 - A)); without a speed [m/s]
        at that of the scan."""
        return float(self._core.parachute(height, self.speed if speed is None else speed))

    def peak_bound(self, at: tuple[float, float], rise: float, height: float) -> float:
        """No tap is harder [N], from whatever motion to whatever other (docs/scan.md): over a place (x, y) [m] of a
        surface that comes up under the tip no faster than ``rise`` [m/s], with a range of ``height`` [m] along a line.
        inf: the tip may stay in the sample."""
        if self.scan.zloop.mode == "contact":
            raise InvalidValue("zloop.mode = contact: a bound is of tapping or phase")
        if not (rise >= 0.0 and height >= 0.0):
            raise InvalidValue(f"rise = {rise:g} m/s, height = {height:g} m: neither may be below 0")
        return float(self._core.peak_bound(*at, rise, height))

    def run(self, seed: int = 1, progress: Progress | None = None, threads: int | None = None) -> Image:
        """Scan all lines.

        Parameters
        ----------
        seed : int
            Of the noise.
        progress : callable, optional
            Told the share that is done, ten times a second at least. False ends the scan: the image has the lines so
            far.
        threads : int, optional
            By default one for each core. The image is the same on any number.
        """
        lines, pixels = (int(self.scan[f"raster.{name}"]) for name in ("lines", "pixels"))
        starts = range(0, lines, STRIP)
        parts = [np.empty((min(STRIP, lines - first), 2, 6, pixels)) for first in starts]
        states = [_core.ScanProgress() for _ in starts]

        def strip(number: int) -> None:
            self._core.strip(starts[number], seed, parts[number], states[number])

        def waits(_: int) -> bool | None:
            return None if progress is None else progress(sum(state.lines for state in states) / lines)

        try:
            each(strip, range(len(starts)), lambda done, _: waits(done), waits, threads)
            done = _whole([state.lines for state in states])
        finally:
            for state in states:
                state.end()
        return self._image(np.concatenate(parts)[:done].transpose(1, 2, 0, 3))

    def steady(
        self,
        accuracy: float = 0.05,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Image:
        """The image that an infinitely slow scan would give: tapping, at each pixel the motion of the set point.

        Speed, gain, noise, drift and stage do not count; trace and retrace are one. Along a line each pixel's motion
        follows from the one before; on the first one the tip comes down.

        Parameters
        ----------
        accuracy : float, optional
            Of the amplitude over A0 and of the peak force over the larger of itself and the pull-off, 1e-6 .. 0.5.
        threads : int, optional
            By default one for each core. The image is the same on any number.
        progress : callable, optional
            Told the share that is done, ten times a second at least. False ends the scan: the image has the lines so
            far.

        Raises
        ------
        SolverError
            With the first place where no motion of the set point repeats each period; :meth:`run` scans it in time.
        """
        check_accuracy(accuracy)
        if self.scan.zloop.mode == "contact":
            raise InvalidValue("zloop.mode = contact: a steady image is of tapping or phase")
        lines, pixels = (int(self.scan[f"raster.{name}"]) for name in ("lines", "pixels"))
        out = np.empty((6, lines, pixels))

        def take(line: int) -> int:
            found, pixel = _core.steady_line(self._core, accuracy, line)
            out[:, line] = found
            return int(pixel)

        def kept(line: int, pixel: int) -> bool | None:
            if pixel >= 0:
                raise SolverError(
                    f"line {line}, pixel {pixel}: no motion of the set point repeats each period there; a scan in time "
                    "(run(), nanotouch scan without --steady) has no such need"
                )
            return waits(line + 1)

        def waits(done: int) -> bool | None:
            return None if progress is None else progress(done / lines)

        done = out[:, : each(take, range(lines), kept, waits, threads)]
        return self._image(np.stack([done, done]))

    def _image(self, out: Floats) -> Image:
        raster = self.scan.raster
        size = raster.height / raster.lines, raster.width / raster.pixels
        return Image(Channels(*out[0]), Channels(*out[1]), size, str(self.scan.zloop.mode))
