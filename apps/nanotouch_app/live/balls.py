# SPDX-License-Identifier: BSD-3-Clause
"""Particles that a task lays on the surface, spheres or a rod, and rings where they shall lie."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nanotouch_app.live.look import Colour, unit

Floats = NDArray[np.float64]

PARTICLE: Colour = (232, 228, 220)
RING: Colour = (20, 120, 60)
THICK = 0.12  # of a ring, over the radius


class Balls:
    """The actors of one renderer; lengths are drawn over the unit of the stage [m], ``ground`` its height there."""

    def __init__(self, vtk: Any, renderer: Any, length: float, ground: float) -> None:
        self.vtk, self.renderer, self.length, self.ground = vtk, renderer, length, ground
        self.balls: list[Any] = []
        self.rings: list[Any] = []

    def show(self, message: dict[str, Any], origin: Sequence[float] | Floats = (0.0, 0.0)) -> None:
        """Where they are now; ``origin`` is where the surface begins [m]."""
        if len(self.balls) != len(message["places"]) or len(self.rings) != len(message["targets"]):
            self._make(message)
        for actor, place in zip(self.balls, message["places"], strict=True):
            x, y, z = (float(place[0] - origin[0]), float(place[1] - origin[1]), float(place[2]))
            actor.SetPosition(x / self.length, y / self.length, self.ground + z / self.length)
        for actor, angle in zip(self.balls, message.get("angles", ()), strict=False):
            actor.SetOrientation(0.0, 0.0, math.degrees(angle) - 90.0)  # a rod is made along y

    def _make(self, message: dict[str, Any]) -> None:
        for actor in (*self.balls, *self.rings):
            self.renderer.RemoveActor(actor)
        radius = message["radius"] / self.length
        made = self._rod(radius, message["length"] / self.length) if message.get("length") else self._ball(radius)
        self.balls = [self._actor(made, PARTICLE) for _ in message["places"]]
        self.rings = [self._actor(self._ring(radius), RING) for _ in message["targets"]]
        for actor, (x, y) in zip(self.rings, message["targets"], strict=True):
            actor.SetPosition(x / self.length, y / self.length, self.ground + 0.004)
            actor.GetProperty().LightingOff()

    def _ball(self, radius: float) -> Any:
        source = self.vtk.vtkSphereSource()
        source.SetRadius(radius)
        source.SetThetaResolution(48)
        source.SetPhiResolution(32)
        return source

    def _rod(self, radius: float, length: float) -> Any:
        source = self.vtk.vtkCylinderSource()
        source.SetRadius(radius)
        source.SetHeight(length)
        source.SetResolution(48)
        source.CapsuleCapOn()
        return source

    def _ring(self, radius: float) -> Any:
        source = self.vtk.vtkDiskSource()
        source.SetInnerRadius((1.0 - THICK) * radius)
        source.SetOuterRadius(radius)
        source.SetCircumferentialResolution(64)
        return source

    def _actor(self, source: Any, colour: Colour) -> Any:
        mapper = self.vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(source.GetOutputPort())
        actor = self.vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(*unit(colour))
        actor.GetProperty().SetSpecular(0.3)
        self.renderer.AddActor(actor)
        return actor
