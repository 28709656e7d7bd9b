# SPDX-License-Identifier: BSD-3-Clause
"""Contact mode through the hal: a session whose height servo holds the force goes along the lines of a raster. The
slave half may be simulated, a rig file's converters, or any of your own (docs/scan.md)."""

from __future__ import annotations

import math

import numpy as np

from nanotouch._arrays import Floats
from nanotouch.errors import DeviceError, InvalidValue
from nanotouch.scan.scanner import Channels, Image, Scan
from nanotouch.touch.columns import STATES
from nanotouch.touch.operator import Input
from nanotouch.touch.record import Recording
from nanotouch.touch.session import Session

_SETTLE = 5.0  # time constants of the height servo before the first line


def image(session: Session, scan: Scan) -> Image:
    """An image in contact mode, taken by a session on its own rig.

    The session's height servo (``gains.height_gain``, K_I) holds ``zloop.set_force``; the raster is the scan's. Tilt,
    drift and hysteresis are those of the rig, not of the raster. Trace and retrace are sorted into pixels by the
    position that the slave has measured; a pixel is the mean of what falls into it.

    Parameters
    ----------
    session : Session
        In mode ``"topography"``, above the sample.
    scan : Scan
        ``zloop.mode`` is contact; half a line has at least two ticks of the session for each pixel.

    Returns
    -------
    Image
        Heights of the stage as measured, from where the session began; deflection, error and force as measured. The
        lateral force is that of a lever that shows it (``probe.lateral_stiffness``), 0 of others.

    Raises
    ------
    InvalidValue
        The session is in another mode, or the raster does not suit it.
    DeviceError
        The supervisor has held or lifted the tip during the scan: with line, state and reason.
    """
    raster, loop = scan.raster, scan.zloop
    lines, pixels = int(raster.lines), int(raster.pixels)
    ticks = round(0.5 * session.rate / raster.line_rate)
    if session.mode != "topography" or loop.mode != "contact":
        raise InvalidValue(
            f"session.mode = {session.mode}, zloop.mode = {loop.mode}: a scan through the hal needs topography, contact"
        )
    if ticks < 2 * pixels:
        raise InvalidValue(
            f"raster.line_rate = {raster.line_rate:g} Hz: valid is up to {0.25 * session.rate / pixels:g} Hz, for two "
            f"ticks of the session in each of {pixels} pixels"
        )
    _check_range(session, scan)
    if session.settings["gains.set_point"] != loop.set_force:
        session.change("settings", "gains.set_point", loop.set_force)
    ends = _ends(scan)
    settle = 2.0 * session.clearance * session.rig["probe.spring_constant"] / loop.set_force
    _go(session, 0, Input(0.0, ends[0], raster.y, (settle + _SETTLE) / session.settings["gains.height_gain"]))
    out = np.zeros((2, 6, lines, pixels))
    for line in range(lines):
        y = raster.y + line * raster.height / lines
        for back in (0, 1):
            rows = _go(session, line, Input(0.0, ends[1 - back], y, ticks / session.rate))
            out[back, :, line] = _sorted(session, rows, scan)
        if line + 1 < lines:
            _go(session, line, Input(0.0, ends[0], y + raster.height / lines, ticks / session.rate / pixels))
    size = raster.height / lines, raster.width / pixels
    return Image(Channels(*out[0]), Channels(*out[1]), size, "contact")


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


def _go(session: Session, line: int, way: Input) -> Recording:
    """To there; refuses rows in which the supervisor did not run."""
    rows = session.run(operator=[way])
    worst = int(rows.state.max())
    if worst > 0:
        reasons = int(rows.reasons[rows.state == worst][0])
        raise DeviceError(f"line {line}: the supervisor went to {STATES[worst]}, reasons {reasons:#x}: no image")
    return rows


def _sorted(session: Session, rows: Recording, scan: Scan) -> Floats:
    """Means over the pixels, and the largest force, in the order of :class:`Channels`."""
    pixels = int(scan["raster.pixels"])
    pixel = scan["raster.width"] / pixels
    which = np.clip(((rows.x - _ends(scan)[0]) / pixel).astype(int), 0, pixels - 1)
    count = np.bincount(which, minlength=pixels)
    stiffness = session.rig["probe.spring_constant"]
    sideways = session.rig["probe.lateral_stiffness"] * np.asarray(getattr(rows, "deflection_x", np.zeros(which.size)))
    force = np.asarray(rows.slave_force)
    values = {
        0: -np.asarray(rows.stage_position), 1: (scan["zloop.set_force"] - force) / stiffness,
        2: np.asarray(rows.deflection), 5: -sideways,
    }  # fmt: skip
    out = np.zeros((6, pixels))
    peak = np.full(pixels, -math.inf)
    np.maximum.at(peak, which, force)
    out[4] = peak
    for row, value in values.items():
        out[row] = np.bincount(which, value, pixels) / np.maximum(count, 1)
    seen = np.flatnonzero(count)
    missed = np.flatnonzero(count == 0)  # the slave was there between two readings
    for row in range(6):
        out[row, missed] = np.interp(missed, seen, out[row, seen])
    return out
