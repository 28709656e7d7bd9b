# SPDX-License-Identifier: BSD-3-Clause
"""What a sample is made of as it was measured (E*, pull-off force) becomes what a surface carries (E, w), for the tip
and the laws of a scene."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from nanotouch._arrays import Floats, as_floats
from nanotouch.errors import InvalidValue, require
from nanotouch.images import Topography, ValueMap

if TYPE_CHECKING:
    from nanotouch.scene import Scene

PAIRS = {"youngs_modulus": "effective_modulus", "work_of_adhesion": "pull_off_force"}
"""what a surface carries, and what stands for it"""
UNITS = {"youngs_modulus": "Pa", "work_of_adhesion": "J/m^2", "effective_modulus": "Pa", "pull_off_force": "N"}
_LEAST_NODES, _NODES = 4, 10  # along each axis of the table
_STEPS = 60
_OTHERS = 0.1  # of the pull-off, at least, is that of w
#: pull-off force [N] of a plan over a level surface of w and E
PullOff = Callable[[float, float | None], float]
_Over = Callable[[Floats, Floats | None], Floats]


def on_pixels(name: str, given: Any, topography: Topography) -> Floats:
    """One number above 0 for each height, read-only; numbers that are none are refused with their place."""
    if isinstance(given, ValueMap):
        if given.quantity != name:
            raise InvalidValue(f"{name}: {given.name} was read as {given.quantity}")
        given = given.on(topography)
    values = as_floats(given, name)
    if values.shape != topography.shape:
        raise InvalidValue(f"{name}: shape {values.shape}, expected that of the heights, {topography.shape}")
    wrong = ~(values > 0.0) | ~np.isfinite(values)
    if wrong.any():
        row, column = (int(i) for i in np.argwhere(wrong)[0])
        raise InvalidValue(
            f"{name}[{row}, {column}] = {values[row, column]:g} {UNITS[name]}: it must be above 0 at each place "
            f"({int(wrong.sum())} of {wrong.size} are not)"
        )
    values = values.copy()
    values.flags.writeable = False
    return values


def for_scene(
    scene: Scene, topography: Topography, given: Mapping[str, Any], pull_off: Callable[[Scene], PullOff]
) -> dict[str, Floats]:
    """E and w at the pixels; ``effective_modulus`` and ``pull_off_force`` as those with which the scene has them."""
    for name, stand_in in PAIRS.items():
        if given.get(name) is not None and given.get(stand_in) is not None:
            raise InvalidValue(f"{name} and {stand_in} of each place: give one of them")
    found = {name: on_pixels(name, one, topography) for name, one in given.items() if one is not None}
    if "effective_modulus" in found:
        found["youngs_modulus"] = _youngs(scene, found.pop("effective_modulus"))
    if "pull_off_force" in found:
        forces, moduli = found.pop("pull_off_force"), found.get("youngs_modulus")
        found["work_of_adhesion"] = _work(float(scene.tip.radius), forces, moduli, pull_off(scene))
    return found


def _youngs(scene: Scene, effective: Floats) -> Floats:
    """With the scene's tip and Poisson ratio."""
    tip = (1.0 - scene.tip.poisson_ratio**2) / scene.tip.youngs_modulus
    stiffest = float(effective.max())
    if not stiffest * tip < 1.0:
        raise InvalidValue(
            f"effective_modulus = {stiffest:g} Pa: with this tip it stays below {1.0 / tip:g} Pa; raise "
            "tip.youngs_modulus"
        )
    return np.asarray((1.0 - scene.sample.poisson_ratio**2) / (1.0 / effective - tip))


def _work(radius: float, forces: Floats, moduli: Floats | None, pull_off: PullOff) -> Floats:
    """w whose plan pulls off with these forces: Newton's method on F over w, which is almost a line, out of a table."""
    low, high = float(forces.min()) / (2.2 * np.pi * radius), float(forces.max()) / (1.4 * np.pi * radius)
    stiff = _nodes(float(moduli.min()), float(moduli.max())) if moduli is not None else np.array([np.nan])
    works, table = _table(_nodes(_OTHERS * low, high), stiff, pull_off)
    at, slope = _spline(works, np.log(stiff), table)
    beside = None if moduli is None else np.log(moduli)
    found = np.clip(forces / (1.75 * np.pi * radius), works[0], works[-1])
    for _ in range(_STEPS):
        before = found
        found = np.clip(found + (forces - at(found, beside)) / slope(found, beside), works[0], works[-1])
        if np.abs(found - before).max() < 1e-12 * works[-1]:
            break
    off = np.abs(at(found, beside) / forces - 1.0)
    if not off.max() < 1e-6:
        row, column = (int(i) for i in np.argwhere(off == off.max())[0])
        raise InvalidValue(
            f"pull_off_force[{row}, {column}] = {forces[row, column]:g} N: no work of adhesion makes it beside the "
            f"other forces of the scene; those of {works[0]:.3g} .. {works[-1]:.3g} J/m^2 pull off with "
            f"{table.min():.3g} .. {table.max():.3g} N"
        )
    return found


def _table(works: Floats, stiff: Floats, pull_off: PullOff) -> tuple[Floats, Floats]:
    """From the largest w down to where a plan refuses it, as a tail alone pulls more."""
    rows: list[list[float]] = []
    for work in works[::-1]:
        try:
            rows.append([pull_off(work, None if math.isnan(one) else one) for one in stiff])
        except InvalidValue as refusal:
            if len(rows) < _LEAST_NODES:
                raise InvalidValue(
                    f"pull_off_force: a scene of such work of adhesion is refused, {refusal}"
                ) from refusal
            break
    return works[::-1][: len(rows)][::-1], np.array(rows[::-1])


def _nodes(low: float, high: float) -> Floats:
    count = 1 if high <= low else min(_LEAST_NODES + int(np.ceil(2.0 * np.log10(high / low))), _NODES)
    return np.geomspace(low, high, count)


def _spline(x: Floats, y: Floats, values: Floats) -> tuple[_Over, _Over]:
    """Value and slope with x."""
    interpolate = require("scipy.interpolate", "images")
    if len(y) == 1:
        along = interpolate.CubicSpline(x, values[:, 0])
        slope = along.derivative()
        return lambda at, _: np.asarray(along(at)), lambda at, _: np.asarray(slope(at))
    both = interpolate.RectBivariateSpline(x, y, values)
    return (
        lambda at, beside: np.asarray(both(at, beside, grid=False)),
        lambda at, beside: np.asarray(both(at, beside, dx=1, grid=False)),
    )
