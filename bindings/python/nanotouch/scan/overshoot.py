# SPDX-License-Identifier: BSD-3-Clause
"""How hard a lever may tap on its way from one motion to another, and how to keep it from that (docs/scan.md)."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import product

import numpy as np

from nanotouch._arrays import Floats
from nanotouch.scan.rehearsal import rehearse
from nanotouch.scan.scanner import Scanner
from nanotouch.scan.steady import Steady, SteadyMotion
from nanotouch.scene import Scene
from nanotouch.scene.surface import Surface

_ROUGHLY = 0.3  # accuracy of forces that tell how far the tip sinks in
_ACCURACY = 0.02  # of the curve's motions
_SWINGS = (0.6, 0.36, 0.22, 0.13, 0.08, 0.05)  # of the free amplitude: smaller ones are not advised
_HALVINGS = 4  # between two of them
_LINES = 512
_SHARES = (0.06, 0.98, 96)  # set points over A0 that are tried


def steepest(scanner: Scanner, surface: Surface) -> tuple[float, float]:
    """The steepest slope along a line, and the range of heights [m], of what is scanned."""
    x, y = places(scanner, surface)
    z = np.asarray(surface.height(x[None, :], y[:, None])) + scanner.scan.raster.tilt_x * x
    return float(np.abs(np.diff(z, axis=1)).max() / (x[1] - x[0])), float(np.ptp(z, axis=1).max())


def places(scanner: Scanner, surface: Surface) -> tuple[Floats, Floats]:
    """x along a line and y of the lines, up to 512 of them [m]."""
    raster, lines = scanner.scan.raster, int(scanner.scan.raster.lines)
    x = _fine(surface, raster.x, raster.width, raster.width / raster.pixels)
    taken = np.unique(np.linspace(0, lines - 1, min(lines, _LINES)).round())
    return x, raster.y + taken * raster.height / lines


def _fine(surface: Surface, first: float, length: float, pixel: float) -> Floats:
    """Four places in each pixel of scan or surface."""
    count = 4 * length / min(surface.topography.pixel_size[1], pixel)
    return np.linspace(first, first + length, min(int(count), 20000) + 2)


def _steepest_turn(scanner: Scanner, surface: Surface) -> float:
    """The steepest slope on the way from a line to the next one, at their beginning."""
    raster = scanner.scan.raster
    y = _fine(surface, raster.y, raster.height, raster.height / raster.lines)
    z = np.asarray(surface.height(raster.x, y)) + raster.tilt_y * y
    return float(np.abs(np.diff(z)).max() / (y[1] - y[0]))


def limit_of(scene: Scene) -> tuple[float, str]:
    """The load that the scene allows, or that at which the sample yields: P_y = pi^3 R^2/(6 E*^2) (1.6 Y)^3."""
    most, reason = float(scene["range.maximum_load"]), "the scene's maximum load"
    strength, modulus = float(scene["sample.yield_strength"]), float(scene.plan().explain()["effective_modulus"])
    if strength > 0.0:
        yields = math.pi**3 * scene["tip.radius"] ** 2 / (6.0 * modulus**2) * (1.6 * strength) ** 3
        if yields < most:
            return yields, "there the sample yields"
    return most, reason


def _extremes(scanner: Scanner, surface: Surface) -> list[tuple[float, float]]:
    """Where the contact is widest and narrowest, the sample stiffest and softest, most and least adhesive."""
    x, y = places(scanner, surface)
    found = [(float(x[0]), float(y[0]))]
    for values in _maps(surface, x, y):
        for at in (values.argmax(), values.argmin()):
            j, i = np.unravel_index(at, values.shape)
            found.append((float(x[i]), float(y[j])))
    return found


def _maps(surface: Surface, x: Floats, y: Floats) -> list[Floats]:
    """What of the contact changes from place to place: effective radius, E, w."""
    at = x[None, :], y[:, None]
    radii = [] if surface.tip_radius is None else [surface.radius_map.radius(*at).radius]
    return [np.asarray(values) for values in (*radii, *surface.properties(*at)) if values is not None]


def _sinking(scanner: Scanner, scene: Scene, surface: Surface) -> tuple[float, float]:
    """Slope and range of the heights that a loop sees where the sample gives way by more here than there: it lies lower
    by the difference of the steady motions, over as many pixels as E and w need for their whole range."""
    x, y = places(scanner, surface)
    steepest, given = 0.0, surface.properties(x[None, :], y[:, None])
    ends: dict[str, tuple[float, ...]] = {"sample.youngs_modulus": (), "adhesion.work_of_adhesion": ()}
    for name, values in zip(ends, given, strict=True):
        if values is None or not np.ptp(values) > 0.0:
            continue
        share = np.log(values / values.min()) / np.log(values.max() / values.min())
        turn = np.abs(np.diff(share[:, 0])).max(initial=0.0) / scanner.scan["raster.height"] * scanner.scan.raster.lines
        steepest += max(float(np.abs(np.diff(share, axis=1)).max() / (x[1] - x[0])), float(turn))
        ends[name] = float(values.min()), float(values.max())
    heights: list[float] = []
    for modulus, work in product(*(values or (math.nan,) for values in ends.values())):
        there = scene.copy()
        for name, value in zip(ends, (modulus, work), strict=True):
            if not math.isnan(value):
                there[name] = value
        steady = Steady(there.plan(_ROUGHLY), scanner.rig, scanner.drive, accuracy=_ACCURACY)
        found = (_at_set_point(scanner, steady, lifted) for lifted in (False, True))
        heights += [one.base_height for one in found if one is not None]
    sunk = max(heights, default=0.0) - min(heights, default=0.0) if steepest > 0.0 else 0.0
    return sunk * steepest, sunk


def _at_set_point(scanner: Scanner, steady: Steady, lifted: bool) -> SteadyMotion | None:
    """The motion of the set point."""
    zloop = scanner.scan.zloop
    if zloop.mode == "phase":
        return steady.at_phase(float(zloop.set_phase), lifted)
    return steady.at_amplitude(float(zloop.set_amplitude) * float(scanner.drive["drive.free_amplitude"]), lifted)


def peak_bounds(scanner: Scanner, scene: Scene, surface: Surface | None) -> tuple[float, float]:
    """No tap of a scan is harder [N], where contact and sample are extreme in what is scanned; and the largest
    free amplitude found that keeps this below the limit of :func:`limit_of` [m], with a speed that is smaller by as
    much. A smaller one need not keep it: attraction may hold the tip."""
    if scanner.scan.zloop.mode == "contact":
        return math.nan, math.nan
    raster, limit = scanner.scan.raster, limit_of(scene)[0]
    slope, height = (0.0, 0.0) if surface is None else steepest(scanner, surface)
    spots = [(float(raster.x), float(raster.y))]
    if surface is not None:
        slope = max(slope, _steepest_turn(scanner, surface))
        spots = _extremes(scanner, surface)
        slope, height = np.add((slope, height), _sinking(scanner, scene, surface))
    rise = scanner.speed * slope * (1.0 + 2.0 * raster.hysteresis) + abs(scanner.scan["raster.drift"])

    def bound(of: Scanner, share: float = 1.0) -> float:
        return max(of.peak_bound(at, share * rise, height) for at in spots)

    A0, most = float(scanner.drive["drive.free_amplitude"]), bound(scanner)
    if rehearse(scanner, scene).peak_force > 0.5 * most:
        return math.inf, math.nan

    def keeps(share: float) -> bool:
        drive = scanner.drive.copy()
        drive["drive.free_amplitude"] = share * A0
        return bound(Scanner(scanner.plan, scanner.scan, scanner.rig, drive), share) <= limit

    return most, A0 * (1.0 if most <= limit else _largest(keeps))


def _largest(keeps: Callable[[float], bool]) -> float:
    """The largest share below 1 that keeps the limit; NaN: none found. Sought from above, for small ones may not: there
    attraction may hold the tip."""
    high = 1.0
    for low in _SWINGS:
        if keeps(low):
            break
        high = low
    else:
        return math.nan
    for _ in range(_HALVINGS):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if keeps(middle) else (low, middle)
    return low


def single_set_point(scanner: Scanner, scene: Scene, wanted: float) -> float:
    """The share of A0 nearest to the one that is wanted at which all stable motions over a flat lie on one side of 90
    degrees; NaN: none."""
    curve = Steady(scene.plan(), scanner.rig, scanner.drive, accuracy=_ACCURACY).curve()
    whole = (np.diff(curve.piece) == 0) & curve.stable[1:] & curve.stable[:-1]
    ends = np.stack([curve.amplitude[1:], curve.amplitude[:-1]]) / float(scanner.drive["drive.free_amplitude"])
    attracted = 0.5 * (curve.phase[1:] + curve.phase[:-1]) > math.pi / 2
    shares = np.linspace(*_SHARES)
    meets = whole & (ends.min(axis=0) <= shares[:, None]) & (shares[:, None] <= ends.max(axis=0))
    alone = shares[(meets & attracted).any(axis=1) != (meets & ~attracted).any(axis=1)]
    return float(alone[np.abs(alone - wanted).argmin()]) if len(alone) else math.nan
