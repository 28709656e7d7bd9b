# SPDX-License-Identifier: BSD-3-Clause
"""Tip, lever with its chip, and the shadows that they cast. One scene unit is the longer side of the surface."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nanotouch_app.live.arrays import actor_of, points, quads
from nanotouch_app.live.look import Palette, unit

Floats = NDArray[np.float64]

TIP_HEIGHT = 0.28  # of the drawn tip [scene units]
LEVER = (0.6, 0.2, 0.018)  # of the drawn lever from the tip to the chip, its width, its thickness [scene units]
LEVER_POINTS = 24
NOSE, TILT = 0.18, 0.16  # what is before the tip [scene units]; rise towards the chip [-]
CHIP = (0.2, 0.5, 0.09)  # that holds it: length, width, height [scene units]
CAST = (0.6, 0.4)  # of a shadow to the right and back, by height: of the first light
BALL = 300e-9  # a blunter tip is a ball that is glued to a stem [m]
BEND = 0.05  # of the lever under the largest load [scene units]
SHADOW = 0.05  # radius of the soft shadow [scene units]
SHADES, BEAM_SHADES = (1.0, 0.7, 0.4), (1.25, 0.9)  # widths of shadows that lie over each other: they are soft
SHADOW_RINGS, SHADOW_ROUND = 6, 33  # of points that lie on the surface


class Instrument:
    """The actors of one renderer; the tip is made anew when another one is mounted."""

    def __init__(self, vtk: Any, renderer: Any, scale: float) -> None:
        self.vtk, self.renderer, self.unit = vtk, renderer, scale
        self.mounted: tuple[Any, ...] = ()
        self.tip: Any = None
        self.beam = vtk.vtkPolyData()
        self.beam.SetPolys(quads(vtk, LEVER_POINTS + 4, 5))
        self.lever = actor_of(vtk, renderer, self.beam)
        self.lever.GetProperty().SetSpecular(0.2)
        self.lever.GetProperty().SetAmbient(0.2)
        self.lever.VisibilityOff()
        self.shades: list[Any] = []
        self.below_tip = [(share, self._shadow(SHADOW_RINGS, SHADOW_ROUND)) for share in SHADES]
        self.below_beam = [(share, self._shadow(LEVER_POINTS, 3)) for share in BEAM_SHADES]

    def mount(self, radius: float, half_angle: float, kind: str) -> None:
        """A tip of this radius [m] and half angle [rad] in its own proportions."""
        if self.mounted == (radius, half_angle, kind):
            return
        self.mounted = (radius, half_angle, kind)
        if self.tip is not None:
            self.renderer.RemoveActor(self.tip)
        self.tip = actor_of(self.vtk, self.renderer, self._turned(radius / self.unit, half_angle, kind))
        self.tip.GetProperty().SetSpecular(0.35)
        self.tip.GetProperty().SetSpecularPower(25.0)
        self.tip.GetProperty().SetAmbient(0.3)
        self.lever.VisibilityOn()

    def paint(self, palette: Palette) -> None:
        """Light or dark."""
        for one in (self.tip, self.lever):
            if one is not None:
                one.GetProperty().SetColor(*unit(palette.tip))

    def move(self, apex: Floats, above: float, share: float, ground: Callable[[Floats, Floats], Floats]) -> None:
        """To an apex, so far above the surface, under this share of the largest load; ``ground``: places on the
        surface."""
        self.tip.SetPosition(*apex)
        self._bend(apex, BEND * max(-1.5, min(1.5, share)))
        self._cast(apex, above, ground)

    def _turned(self, radius: float, half_angle: float, kind: str) -> Any:
        """Sphere that goes over into a cone, or a ball on a stem; closed above."""
        ball = kind == "sphere" or radius * self.unit > BALL
        last = 0.9 * math.pi if ball else math.pi / 2 - half_angle
        angle = np.linspace(0.0, last, 28)
        r, h = radius * np.sin(angle), radius * (1.0 - np.cos(angle))
        widening = math.tan(half_angle) if last < math.pi / 2 else 0.0
        if h[-1] < TIP_HEIGHT:
            r, h = np.append(r, r[-1] + (TIP_HEIGHT - h[-1]) * widening), np.append(h, TIP_HEIGHT)
        r, h = np.append(r, 0.0), np.append(h, h[-1])
        turn = np.linspace(0.0, 2.0 * math.pi, 41)
        rings = np.stack([np.outer(r, np.cos(turn)), np.outer(r, np.sin(turn)), np.outer(h, np.ones_like(turn))], -1)
        data = self.vtk.vtkPolyData()
        data.SetPoints(points(self.vtk, rings))
        data.SetPolys(quads(self.vtk, *rings.shape[:2]))
        normals = self.vtk.vtkPolyDataNormals()
        normals.SetInputData(data)
        normals.Update()
        return normals.GetOutput()

    def _bend(self, apex: Floats, bend: float) -> None:
        """A beam that is clamped behind, w = zeta (3 s^2 - s^3)/2, with its chip; its nose is before the tip. Rings of
        y, half its width, its lower and its upper side."""
        length, width, thick = LEVER
        back, wide, tall = CHIP
        s = np.linspace(0.0, 1.0, LEVER_POINTS)
        y = apex[1] + length - (length + NOSE) * s
        z = apex[2] + TIP_HEIGHT - bend * (1.0 - 0.5 * (3.0 * s**2 - s**3)) + TILT * (y - apex[1])
        half = 0.5 * width * (1.0 - np.maximum((apex[1] - y) / NOSE - 0.5, 0.0))
        beam = np.stack([y, half, z, z + thick], axis=1)
        chip = [[y[0] + back, 0.0, z[0], z[0]], [y[0] + back, 0.5 * wide, z[0], z[0] + tall],
                [y[0], 0.5 * wide, z[0], z[0] + tall]]  # fmt: skip
        end = [[y[-1], 0.0, z[-1], z[-1]]]
        y, half, low, high = np.concatenate([chip, beam, end]).T[:, :, None]
        x = apex[0] + half * np.array([-1.0, 1.0, 1.0, -1.0, -1.0])
        upper = np.array([0.0, 0.0, 1.0, 1.0, 0.0])
        self._set(self.beam, np.stack([x, y + 0.0 * x, low + (high - low) * upper], axis=-1))

    def _shadow(self, rows: int, columns: int) -> Any:
        data = self.vtk.vtkPolyData()
        data.SetPolys(quads(self.vtk, rows, columns))
        shade = actor_of(self.vtk, self.renderer, data)
        shade.GetProperty().SetColor(0.0, 0.0, 0.0)
        shade.GetProperty().SetOpacity(0.12)
        shade.GetProperty().LightingOff()
        self.shades.append(shade)
        return data

    def _cast(self, apex: Floats, above: float, ground: Callable[[Floats, Floats], Floats]) -> None:
        """The shadows of tip and lever."""
        turn, size = np.linspace(0.0, 2.0 * math.pi, SHADOW_ROUND), SHADOW * (1.0 + 3.0 * above)
        x, y = apex[:2] + above * np.array(CAST)
        for share, data in self.below_tip:
            r = np.linspace(0.0, share * size, SHADOW_RINGS)
            self._set(data, ground(x + np.outer(r, np.cos(turn)), y + np.outer(r, np.sin(turn))))
        x, y = apex[:2] + (above + TIP_HEIGHT) * np.array(CAST)
        for share, data in self.below_beam:
            across = x + 0.5 * share * LEVER[1] * np.array([-1.0, 0.0, 1.0])
            self._set(data, ground(*np.meshgrid(across, y + np.linspace(-NOSE * share, LEVER[0], LEVER_POINTS))))

    def _set(self, data: Any, places: Floats) -> None:
        data.SetPoints(points(self.vtk, places))
        data.Modified()
