# SPDX-License-Identifier: BSD-3-Clause
"""Sokolov's model of a cell with a brush of polymers: brush and cell as two springs, one after the other.

Sokolov, Iyer, Subba-Rao, Gaikwad, Woodworth, Appl. Phys. Lett. 91 (2007) 023902; Sokolov, Dokukin, Guz, Methods 60
(2013) 202. The same force goes through both: it presses the brush to a thickness h, and the cell gives by Hertz' i,

    F = F_brush(h)        delta = i(F) - h        i = (9 F^2/(16 E*^2 R))^(1/3)

delta counts from where the tip would meet the bare, undeformed cell; the brush begins at -T. The brush is that of
Alexander and de Gennes by Derjaguin's approximation, as in a scene, where Sokolov takes its exponential approximation:

    F_brush = 2 pi R (kT/s^3) T 4/35 (7 x^(-5/4) + 5 x^(7/4) - 12),   x = h/T

In truth the brush's pressure bends the cell over a width of its own, not Hertz': a cell that is solved for together
with the brush gives less. :func:`series_bias` says by how much, and each fit tells it.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from nanotouch._arrays import Floats, as_floats, check_between

from .models import Model, Parameter

_STEPS = 2  # of Newton, from a start that is right to some 1e-4
BOLTZMANN = 1.380649e-23
ROOM = 298.15  # [K]


class SeriesBias(NamedTuple):
    """What a sample gives under a force through its brush, beyond what a rigid one would."""

    force: float
    """[N]"""
    series: float
    """as springs in series: Hertz' indentation [m]"""
    self_consistent: float
    """of a half-space whose gap and displacement are solved together [m]"""

    @property
    def modulus(self) -> float:
        """E* of a fit in series over the true one, where both give the same at this force."""
        return float((self.series / self.self_consistent) ** 1.5)

    def __str__(self) -> str:
        return (
            f"springs in series err: at {self.force * 1e9:.3g} nN this sample gives by {self.series * 1e9:.4g} nm in "
            f"series, by {self.self_consistent * 1e9:.4g} nm where gap and displacement are solved together; so E* is "
            f"some {self.modulus:.2g} times too high (docs/deformation.md)"
        )


def force_of(indentation: Any, radius: float, effective_modulus: float, thickness: float, pressure: float) -> Floats:
    """Force [N] at indentations [m] from the bare cell; `pressure` is kT/s^3 [Pa]. 0 beyond the brush."""
    delta = as_floats(indentation, "indentation") / thickness
    scale = 2.0 * math.pi * radius * pressure * thickness * 4.0 / 35.0
    give = np.cbrt(9.0 * scale**2 / (16.0 * effective_modulus**2 * radius)) / thickness  # of the cell under it, over T
    u = np.interp(delta, give * _TWO_THIRDS - _LEFT, _TABLE)  # ln(T/h)/4
    for _ in range(_STEPS):
        u = np.maximum(u, _TABLE[1])  # at 0 the slope is 0/0
        force, slope = _brush(u)
        root, left = np.cbrt(force), np.exp(-4.0 * u)
        u -= (give * root * root - left - delta) / (give / 1.5 * slope / root + 4.0 * left)
    return np.where(delta > -1.0, scale * _brush(np.maximum(u, 0.0))[0], 0.0)


def _brush(u: Floats) -> tuple[Floats, Floats]:
    """7 x^(-5/4) + 5 x^(7/4) - 12 at x = exp(-4 u), and its slope by u."""
    more, less = np.expm1(5.0 * u), np.expm1(-7.0 * u)
    return 7.0 * more + 5.0 * less, 35.0 * (more - less)


#: u where a solution is looked for, down to h/T = 1e-16; there the brush's force^(2/3), and h/T
_TABLE = np.concatenate([[0.0], np.geomspace(1e-8, 0.5, 700), np.arange(0.51, 9.22, 0.01)])
_TWO_THIRDS = np.cbrt(_brush(_TABLE)[0]) ** 2
_LEFT = np.exp(-4.0 * _TABLE)


def series_bias(
    force: float, radius: float, effective_modulus: float, *, thickness: float, pressure: float
) -> SeriesBias:
    """What springs in series err by at a force [N], against :class:`~nanotouch.reference.Deformation` with that brush.

    Tip of `radius` [m]; E* [Pa]; brush of `thickness` T [m] and `pressure` kT/s^3 [Pa].
    """
    from nanotouch import reference  # it takes its time to load

    for name, value, unit in (("force", force, "N"), ("radius", radius, "m"), ("thickness", thickness, "m"),
                              ("effective_modulus", effective_modulus, "Pa"),
                              ("pressure", pressure, "Pa")):  # fmt: skip
        check_between(name, value, unit, above=0.0)
    law = reference.brush(pressure, thickness)
    sample = reference.Deformation(law, radius, effective_modulus, tolerance=1e-5)
    gaps = thickness * np.linspace(1e-3, 1.0, 20001) ** 4
    rigid = float(np.interp(-force, -2.0 * math.pi * radius * law.energy(gaps), gaps))
    series = float(np.cbrt(9.0 * force**2 / (16.0 * effective_modulus**2 * radius)))
    return SeriesBias(force, series, rigid - sample.at_force(force, 0.9 * thickness).gap)


def spacing(pressure: float, temperature: float = ROOM) -> float:
    """Distance of grafted chains s [m] of a brush whose kT/s^3 [Pa] was fitted."""
    check_between("pressure", pressure, "Pa", above=0.0)
    return float(np.cbrt(BOLTZMANN * temperature / pressure))


def _told(radius: float, values: dict[str, float], largest_force: float) -> str:
    thickness, pressure = values["brush_thickness"], values["brush_pressure"]
    return str(series_bias(largest_force, radius, values["effective_modulus"], thickness=thickness, pressure=pressure))


SOKOLOV = Model(
    "sokolov",
    force_of,
    (
        Parameter("effective_modulus", "Pa", 1.0, 1e9),
        Parameter("brush_thickness", "m", 1e-9, 1e-5, initial=3e-7),
        Parameter("brush_pressure", "Pa", 1e-2, 1e7, initial=10.0),
    ),
    valid="cell and brush as springs in series, each by its own law; E* comes out too high, as the notes say",
    title="Sokolov's springs in series",
    remark=_told,
)
