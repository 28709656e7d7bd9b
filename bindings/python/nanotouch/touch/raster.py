# SPDX-License-Identifier: BSD-3-Clause
"""Images through the hal: a session whose height servo holds the force, or the amplitude of a lever that taps, goes
along the lines of a raster. The slave half may be simulated, a rig file's converters, or any of your own
(docs/scan.md)."""

from __future__ import annotations

import math
from collections.abc import Generator
from contextlib import closing

import numpy as np

from nanotouch._arrays import Floats
from nanotouch.errors import DeviceError, InvalidValue
from nanotouch.scan.scanner import Channels, Image, Progress, Scan
from nanotouch.touch._path import Mode
from nanotouch.touch._play import BLOCK_TICKS, Columns, joined, played
from nanotouch.touch.columns import STATES
from nanotouch.touch.operator import Input, core_input
from nanotouch.touch.session import REASONS, Session

MODES: dict[str, Mode] = {"contact": "topography", "tapping": "tapping", "phase": "tapping"}
"""of the session, for a mode of the z loop"""
_KEPT = {"contact": ("gains.set_point", "set_force"), "tapping": ("tap.set_amplitude", "set_amplitude"),
         "phase": ("tap.set_phase", "set_phase")}  # fmt: skip
"""setting of the session that holds a set point"""
_SETTLE = 5.0  # time constants of the height servo before the first line


class Ended(DeviceError):
    """The supervisor or the loop has ended a scan.

    Attributes
    ----------
    image : Image
        The lines before that, maybe none.
    """

    def __init__(self, message: str, image: Image) -> None:
        super().__init__(message)
        self.image = image


class _Stop(Exception):
    """Somebody has asked for the end."""


def image(session: Session, scan: Scan, progress: Progress | None = None) -> Image:
    """An image in contact or tapping mode or by phase feedback, taken by a session on its own rig.

    The session's height servo (``gains.height_gain``, K_I) holds ``zloop.set_force``, or ``zloop.set_amplitude`` of the
    session's own ``tap.free_amplitude``, or ``zloop.set_phase``; the raster is the scan's. Tilt, drift and hysteresis
    are those of the rig, not of the raster. Trace and retrace are sorted into pixels by the position that the slave has
    measured; a pixel is the mean of what falls into it.

    Parameters
    ----------
    session : Session
        In mode ``"topography"`` for contact, else ``"tapping"``, with ``tap.hold`` as what is kept, above the sample.
    scan : Scan
        Half a line has at least two ticks of the session for each pixel.
    progress : callable, optional
        Told the share that is done, some 20 times a second. False ends the scan: the image has the whole lines so far.

    Returns
    -------
    Image
        Heights of the stage as measured, from where the session began; deflection, error and force as measured. The
        lateral force is that of a lever that shows it (``probe.lateral_stiffness``), 0 of others. Tapping: amplitude,
        error and lag as measured, of phase feedback the error as an amplitude; the peak force, which no rig measures,
        is NaN, and the lateral force 0.

    Raises
    ------
    InvalidValue
        The session is in another mode, or the raster does not suit it.
    Ended
        The supervisor has held or lifted the tip during the scan: with line, state and reason. Or the loop has ended.
        Its ``image`` has the lines before.
    """
    raster, loop = scan.raster, scan.zloop
    lines, pixels = int(raster.lines), int(raster.pixels)
    ticks = round(0.5 * session.rate / raster.line_rate)
    if MODES.get(str(loop.mode)) != session.mode:
        raise InvalidValue(
            f"session.mode = {session.mode}, zloop.mode = {loop.mode}: a scan through the hal needs topography with "
            "contact, or tapping with tapping or phase"
        )
    held = {"tapping": "amplitude", "phase": "phase"}.get(str(loop.mode))
    if held is not None and session.settings.tap.hold != held:
        raise InvalidValue(f"tap.hold = {session.settings.tap.hold}, zloop.mode = {loop.mode}: open it with {held}")
    if ticks < 2 * pixels:
        raise InvalidValue(
            f"raster.line_rate = {raster.line_rate:g} Hz: valid is up to {0.25 * session.rate / pixels:g} Hz, for two "
            f"ticks of the session in each of {pixels} pixels"
        )
    of_its_own = [f"{name} = {scan[name]:g}" for name in scan if name.startswith("readout.") and scan[name] != 0.0]
    if of_its_own:
        raise InvalidValue(f"{', '.join(of_its_own)}: of the simulated scanner; a session reads what its slave shows")
    _check_range(session, scan)
    kept, field = _KEPT[str(loop.mode)]
    if session.settings[kept] != scan[f"zloop.{field}"]:
        session.change("settings", kept, scan[f"zloop.{field}"])
    ways = _ways(session, scan, ticks)
    for _, _, way in ways:
        session.core.check(core_input(way))
    out, done = np.zeros((2, 6, lines, pixels)), 0
    size = raster.height / lines, raster.width / pixels

    def so_far() -> Image:
        return Image(Channels(*out[0, :, :done]), Channels(*out[1, :, :done]), size, str(loop.mode))

    try:
        with closing(played(session, [way for _, _, way in ways])) as comes:  # one script: the loop goes on to its end
            for line, back, way in ways:
                rows = _rows(comes, round(way.duration * session.rate), line, progress)
                if back is not None:
                    out[back, :, line] = _sorted(session, rows, scan)
                    done = line + back  # a line is whole when the tip is back
    except _Stop:
        pass
    except DeviceError as error:
        raise Ended(f"{error}: the scan ended there", so_far()) from error
    return so_far()


def _ways(session: Session, scan: Scan, ticks: int) -> list[tuple[int, int | None, Input]]:
    """Down to the surface, then there (0) and back (1) on each line, and over to the next one (None)."""
    raster, rate = scan.raster, session.rate
    lines, ends = int(raster.lines), _ends(scan)
    error = session.settings["tap.free_amplitude"] - _held(session, scan)  # beyond the surface [m]
    if scan.zloop.mode == "contact":
        error = scan["zloop.set_force"] / session.rig["probe.spring_constant"]
    settle = 2.0 * session.clearance / error
    down = (settle + _SETTLE) / session.settings["gains.height_gain"]
    ways: list[tuple[int, int | None, Input]] = [(0, None, Input(0.0, ends[0], raster.y, down))]
    for line in range(lines):
        y = raster.y + line * raster.height / lines
        ways += [(line, back, Input(0.0, ends[1 - back], y, ticks / rate)) for back in (0, 1)]
        if line + 1 < lines:
            over = Input(0.0, ends[0], y + raster.height / lines, ticks / rate / scan.raster.pixels)
            ways.append((line, None, over))
    return ways


def _held(session: Session, scan: Scan) -> float:
    """What is kept while the lever taps, as an amplitude [m]."""
    phase = scan.zloop.mode == "phase"
    share = math.sin(scan["zloop.set_phase"]) if phase else scan["zloop.set_amplitude"]
    return float(share * session.settings["tap.free_amplitude"])


def _swing(session: Session, rows: Columns, scan: Scan) -> Floats:
    """What is read, as an amplitude [m]: a lag counts as that of a contact without loss (docs/scan.md)."""
    if scan.zloop.mode == "tapping":
        return np.asarray(rows["amplitude"])
    sine = np.sin(rows["lag"])
    return np.where(np.cos(rows["lag"]) >= 0.0, sine, 2.0 - sine) * float(session.settings["tap.free_amplitude"])


def _check_range(session: Session, scan: Scan) -> None:
    """A target beyond a slave's range would end there, and the image with it."""
    raster = scan.raster
    for row in session.halves.slave.channels:
        if not row.driven or row.axis > 1:
            continue
        first, last = _ends(scan) if row.axis == 0 else (raster.y, raster.y + raster.height)
        if first < row.minimum or last > row.maximum:
            raise InvalidValue(
                f"the raster goes from {'xy'[row.axis]} = {first:g} to {last:g} m: {row.name} has {row.minimum:g} .. "
                f"{row.maximum:g} m"
            )


def _ends(scan: Scan) -> tuple[float, float]:
    """Of a line: half a pixel beyond the places of its first and last one."""
    half = 0.5 * scan["raster.width"] / scan["raster.pixels"]
    return scan["raster.x"] - half, scan["raster.x"] + scan["raster.width"] - half


def _rows(comes: Generator[tuple[Columns, float]], ticks: int, line: int, progress: Progress | None) -> Columns:
    """Those of a way; refuses rows in which the supervisor did not run."""
    blocks = []
    for _ in range(-(-ticks // BLOCK_TICKS)):
        block, share = next(comes, ({"state": np.zeros(0)}, 1.0))
        if not len(block["state"]):
            raise DeviceError(f"line {line}: the loop has ended")
        worst = int(block["state"].max())
        if worst > 0:
            reasons = int(block["reasons"][block["state"] == worst][0])
            why = ", ".join(name for bit, name in enumerate(REASONS) if reasons >> bit & 1)
            raise DeviceError(f"line {line}: the supervisor went to {STATES[worst]} ({why})")
        blocks.append(block)
        if progress is not None and progress(share) is False:
            raise _Stop
    return joined(blocks) if blocks else {}


def _sorted(session: Session, rows: Columns, scan: Scan) -> Floats:
    """Means over the pixels, and the largest force, in the order of :class:`Channels`."""
    pixels = int(scan["raster.pixels"])
    pixel = scan["raster.width"] / pixels
    which = np.clip(((rows["x"] - _ends(scan)[0]) / pixel).astype(int), 0, pixels - 1)
    count = np.bincount(which, minlength=pixels)
    out = np.zeros((6, pixels))
    if scan.zloop.mode == "contact":
        values = _of_contact(session, rows, scan)
        out[4] = -math.inf
        np.maximum.at(out[4], which, rows["slave_force"])
    else:
        error = _held(session, scan) - _swing(session, rows, scan)
        values = {0: -rows["stage_position"], 1: error, 2: rows["amplitude"], 3: rows["lag"]}
        out[4] = math.nan
    for row, value in values.items():
        out[row] = np.bincount(which, value, pixels) / np.maximum(count, 1)
    seen = np.flatnonzero(count)
    missed = np.flatnonzero(count == 0)  # the slave was there between two readings
    for row in range(6):
        out[row, missed] = np.interp(missed, seen, out[row, seen])
    return out


def _of_contact(session: Session, rows: Columns, scan: Scan) -> dict[int, Floats]:
    """What is a mean over a pixel, by its place in Channels."""
    stiffness = session.rig["probe.spring_constant"]
    sideways = session.rig["probe.lateral_stiffness"] * rows.get("deflection_x", np.zeros(rows["x"].size))
    error = (scan["zloop.set_force"] - rows["slave_force"]) / stiffness
    return {0: -rows["stage_position"], 1: error, 2: rows["deflection"], 5: -sideways}
