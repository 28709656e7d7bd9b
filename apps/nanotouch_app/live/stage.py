# SPDX-License-Identifier: BSD-3-Clause
"""Surface, tip, lever, shadow and trace in three dimensions. The surface is sent once, with the first picture: that the
tip moves only changes which of its tiles are shown fine. One scene unit is the longer side of the surface."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nanotouch_app.live.arrays import actor_of, points, quads, to_vtk
from nanotouch_app.live.balls import Balls
from nanotouch_app.live.instrument import Instrument
from nanotouch_app.live.look import LIGHT, PROPERTY_COLOURS, Colour, Palette, unit
from nanotouch_app.live.relief import RELIEF, coarse, exaggeration, step_below, stepped
from nanotouch_app.live.seen import TRACE, Seen
from nanotouch_app.live.tiles import MOST_FINE, Tiles

Floats = NDArray[np.float64]

FLOOR = 0.05  # of the block whose top the surface is, below its lowest point [scene units]
LIGHTS = (((-1.3, -0.9, 2.1), 0.85), ((1.2, 1.6, 1.2), 0.3))  # from where to the middle, how strong
FAR = 0.14  # no tip is drawn higher above the surface than this [scene units]
LIFTED = 0.004  # what is laid on the surface is drawn so much above it [scene units]
RAISED = 0.1  # of what the camera looks at, over the middle of the surface [scene units]
ZOOM, CLOSEST = 1.25, 16.0  # how many times as large by a step, and at most
VIEWS = {"0": (0.0, 32.0, 1.86), "1": (0.0, 32.0, 1.86), "2": (0.0, 89.0, 1.7), "3": (-55.0, 28.0, 1.86),
         "4": (0.0, 22.0, 0.75), "5": (0.0, 8.0, 1.5)}  # fmt: skip  # turn, height [degrees], distance [scene units]


class Stage:
    """The actors of one renderer."""

    def __init__(self, vtk: Any, renderer: Any, heights: Floats, pixel_size: Floats) -> None:
        self.vtk, self.renderer = vtk, renderer
        self.pixel_size = pixel_size
        self.maps: dict[str, Floats] = {}
        self.shown, self.dark = "height", False
        self.colours = vtk.vtkColorTransferFunction()
        self.coarse: dict[tuple[int, int], Any] = {}
        self.fine: dict[tuple[int, int], Any] = {}
        self._spread(heights)
        self.palette = LIGHT
        self.instrument = Instrument(vtk, renderer, self.unit)
        self.trace, self.trace_data = self._line()
        self.origin = np.zeros(2)  # of the surface in the frame of the tip [m]
        self.balls = Balls(vtk, renderer, self.unit, -self.lowest * float(self.scale[2]))
        self._light()
        self.camera("0")

    def _light(self) -> None:
        self.renderer.RemoveAllLights()
        for place, strength in LIGHTS:
            light = self.vtk.vtkLight()
            light.SetLightTypeToSceneLight()
            light.SetPosition(*np.add(place, (0.5, 0.5, 0.0)))
            light.SetFocalPoint(0.5, 0.5, 0.0)
            light.SetIntensity(strength)
            self.renderer.AddLight(light)

    # --- made once, and anew where the surface has changed ---

    def _spread(self, heights: Floats, relief: float = 0.0) -> None:
        """The surface in tiles."""
        self.heights, merged = coarse(heights, MOST_FINE)
        dy, dx = self.pixel_size * merged
        seen, more = coarse(self.heights)
        self.unit = float(max(heights.shape * np.asarray(self.pixel_size)))
        self.dx, self.dy = dx / self.unit, dy / self.unit
        self.factor = self.built = exaggeration(seen, (dy * more, dx * more), self.unit)
        if relief > 0.0:
            self.factor = self.built = step_below(RELIEF * self.unit / max(relief, float(np.ptp(seen))))
        self.scale = np.array([1.0, 1.0, self.factor]) / self.unit
        self.lowest = float(self.heights.min())
        self.centre = np.array([0.5 * self.dx * self.heights.shape[1], 0.5 * self.dy * self.heights.shape[0], 0.0])
        self.maps["height"] = self.heights
        self.tiles = Tiles(self.vtk, self.heights - self.lowest, (self.dy, self.dx), float(self.scale[2]))
        self.tiles.colour(self.maps[self.shown])
        self.coarse = {tile: self._tile(mesh) for tile, mesh in self.tiles.coarse.data.items()}
        self.fine = {tile: self._tile(mesh) for tile, mesh in self.tiles.fine.data.items()}
        self.near: set[tuple[int, int]] | None = None  # what is shown fine; None: nothing is drawn yet
        self.walls = self._walls()

    def _walls(self) -> Any:
        """Of the block whose top the surface is, down to a floor."""
        rows, columns = self.heights.shape
        across, along = np.arange(columns), np.arange(rows)
        i = np.concatenate([across, np.full(rows - 1, columns - 1), across[-2::-1], np.zeros(rows - 1, dtype=int)])
        j = np.concatenate([np.zeros(columns, dtype=int), along[1:], np.full(columns - 1, rows - 1), along[-2::-1]])
        top = (self.heights[j, i] - self.lowest) * float(self.scale[2])
        rim = np.stack([(i + 0.5) * self.dx, (j + 0.5) * self.dy, top], axis=1)
        floor = rim * [1.0, 1.0, 0.0] - [0.0, 0.0, FLOOR]
        data = self.vtk.vtkPolyData()
        data.SetPoints(points(self.vtk, np.stack([rim, floor])))
        data.SetPolys(quads(self.vtk, 2, len(rim)))
        actor = actor_of(self.vtk, self.renderer, data)
        actor.GetProperty().SetAmbient(0.28)
        return actor

    def reshape(self, heights: Floats, relief: float) -> None:
        """The tip has changed the surface, or may change it by a relief [m]."""
        for actor in self.block:
            self.renderer.RemoveActor(actor)
        self._spread(heights, relief)
        self.paint(self.palette)
        self._show(set())

    def _tile(self, mesh: Any) -> Any:
        actor = actor_of(self.vtk, self.renderer, mesh)
        actor.GetMapper().SetLookupTable(self.colours)
        actor.GetMapper().InterpolateScalarsBeforeMappingOn()
        actor.GetProperty().SetAmbient(0.28)
        actor.GetProperty().SetDiffuse(0.8)
        actor.GetProperty().SetSpecular(0.12)
        return actor

    @property
    def surface(self) -> list[Any]:
        """The actors of all tiles."""
        return [*self.coarse.values(), *self.fine.values()]

    @property
    def block(self) -> list[Any]:
        """The surface with its walls."""
        return [*self.surface, self.walls]

    def _line(self) -> tuple[Any, Any]:
        data = self.vtk.vtkPolyData()
        actor = actor_of(self.vtk, self.renderer, data)
        actor.GetProperty().SetLineWidth(4.0)
        actor.GetProperty().LightingOff()
        return actor, data

    def paint(self, palette: Palette) -> None:
        """Light or dark."""
        self.palette = palette
        low, high = self.ends
        self.colours.RemoveAllPoints()
        table = self.table
        for value, colour in zip(np.linspace(low, high, len(table)), table, strict=True):
            self.colours.AddRGBPoint(float(value), *unit(colour))
        for actor in self.surface:
            actor.GetMapper().SetScalarRange(low, high)
        self.renderer.SetBackground(*unit(palette.panel))
        self.instrument.paint(palette)
        self.walls.GetProperty().SetColor(*unit(palette.heights[1]))

    def lights(self, on: bool) -> None:
        """Whether surface, shadow and trace are seen."""
        if self.dark is not on:
            return
        self.dark = not on
        for actor in (self.trace, self.walls, *self.instrument.shades):
            actor.SetVisibility(on)
        self._show(self.near or set())

    def _show(self, near: set[tuple[int, int]]) -> None:
        """These tiles fine, the others coarse; none in the dark."""
        self.near = near
        for tile, actor in self.coarse.items():
            actor.SetVisibility(not self.dark and tile not in near)
        for tile, actor in self.fine.items():
            actor.SetVisibility(not self.dark and tile in near)

    @property
    def ends(self) -> tuple[float, float]:
        """Of what is shown by colour [m], [Pa], [J/m^2]; never equal."""
        shown = self.maps[self.shown]
        low = float(shown.min())
        return low, max(float(shown.max()), low + max(1e-12, 1e-9 * abs(low)))

    @property
    def table(self) -> tuple[Colour, ...]:
        """Colours from low to high."""
        return PROPERTY_COLOURS.get(self.shown, self.palette.heights)

    def give(self, maps: dict[str, Floats]) -> None:
        """Properties of each place, of the shape of the heights that were given; they may be shown by colour."""
        self.maps |= {name: coarse(np.asarray(values, dtype=float), MOST_FINE)[0] for name, values in maps.items()}

    def colour_by_next(self) -> str:
        """Height, then each property there is; its name."""
        names = list(self.maps)
        self.shown = names[(names.index(self.shown) + 1) % len(names)]
        self.tiles.colour(self.maps[self.shown])
        self.paint(self.palette)
        return self.shown

    def raise_heights(self, up: bool) -> None:
        """Draw heights one step higher or lower; the surface that was sent is stretched, not sent again."""
        self.factor = stepped(self.factor, up, float(np.ptp(self.heights)) / self.unit)
        self.scale[2] = self.factor / self.unit
        for actor in self.block:
            actor.SetScale(1.0, 1.0, self.factor / self.built)

    def mount(self, radius: float, half_angle: float, kind: str) -> None:
        """A tip of this radius [m] and half angle [rad]."""
        self.instrument.mount(radius, half_angle, kind)
        self.instrument.paint(self.palette)

    # --- what moves ---

    def apex(self, seen: Seen) -> Floats:
        """Where the tip is drawn: over the drawn surface, at the gap that is true."""
        x, y = self._place(seen)
        z = float(seen.frame["tip_position"][2])
        gap = float(seen.frame["gap"])
        ground = float(self._ground(x, y))
        above = (gap if math.isfinite(gap) else max(z - ground, 0.0)) * self.scale[2]
        drawn = FAR * math.tanh(above / FAR) if above > 0.0 else above  # a tip far away stays in the picture
        return np.array([x / self.unit, y / self.unit, (ground - self.lowest) * self.scale[2] + drawn])

    def _place(self, seen: Seen) -> tuple[float, float]:
        """Of the tip, from the corner of the surface [m]."""
        x, y = np.asarray(seen.frame["tip_position"][:2]) - self.origin
        return float(x), float(y)

    def _pixels(self, x: Any, y: Any) -> tuple[Any, Any]:
        """Row and column of a place [m]."""
        return np.asarray(y) / self.unit / self.dy - 0.5, np.asarray(x) / self.unit / self.dx - 0.5

    def _ground(self, x: Any, y: Any) -> Any:
        """Height of the surface as it is drawn near the tip [m], linear between its points."""
        return self.tiles.fine.lattice.at(*self._pixels(x, y)) + self.lowest

    def update(self, seen: Seen) -> None:
        """Move tip, lever, shadow and trace; never the surface, of which other tiles are shown fine."""
        self._look_at(self.apex(seen))
        if self.near is None and self.fine:
            self.near = set()  # with this picture all tiles are sent
        elif (near := self.tiles.near(*self._pixels(*self._place(seen)))) != self.near:
            self._show(near)
        apex = self.apex(seen)
        ground = (self._ground(*self._place(seen)) - self.lowest) * self.scale[2]
        share = seen.force / seen.load if seen.load > 0.0 else 0.0
        self.instrument.move(apex, max(float(apex[2] - ground), 0.0), share, self._on)
        self._draw_trace(seen)

    def _on(self, x: Floats, y: Floats) -> Floats:
        """Places on the surface, as it rises and falls there; beyond its edge those at the edge."""
        rim = 2.0 * self.centre
        x = np.clip(x, 0.5 * self.dx, rim[0] - 0.5 * self.dx)
        y = np.clip(y, 0.5 * self.dy, rim[1] - 0.5 * self.dy)
        z = self.tiles.cover(*self._pixels(x * self.unit, y * self.unit)) * self.scale[2] + LIFTED
        return np.stack([x, y, z], axis=-1)

    def _draw_trace(self, seen: Seen) -> None:
        rows = np.array(seen.trace)
        if len(rows) < 2:
            self.trace_data.Initialize()
            return
        rows[:, 1:3] -= self.origin
        now = rows[-1, 0]
        ground = self.tiles.cover(*self._pixels(rows[:, 1], rows[:, 2]))
        places = np.stack([rows[:, 1], rows[:, 2], ground], axis=1) * self.scale + [0.0, 0.0, LIFTED]
        cells = self.vtk.vtkCellArray()
        cells.InsertNextCell(len(rows), list(range(len(rows))))
        share = np.clip(rows[:, 4] / max(seen.load, 1e-15) * 3.0, -1.0, 1.0)
        pull = np.clip(rows[:, 4] / max(seen.plan.pull_off_force, 1e-15), -1.0, 0.0)
        ends = np.where((share > 0.0)[:, None], self.palette.repulsion, self.palette.attraction)
        strength = np.maximum(np.abs(share), np.abs(pull))[:, None]
        colour = strength * ends + (1.0 - strength) * np.array(self.palette.paper)
        fade = 255.0 * np.clip(1.0 - (now - rows[:, 0]) / TRACE, 0.0, 1.0) * (strength[:, 0] > 0.01)
        rgba = np.concatenate([colour, fade[:, None]], axis=1).astype(np.uint8)
        self.trace_data.SetPoints(points(self.vtk, places))
        self.trace_data.SetLines(cells)
        self.trace_data.GetPointData().SetScalars(to_vtk(rgba))
        self.trace_data.Modified()

    # --- the camera ---

    def camera(self, view: str, at: Floats | None = None) -> None:
        """One of the views 0 .. 5; 4 looks at the tip."""
        turn, height, distance = VIEWS[view]
        self.middle = at if at is not None and view == "4" else self.centre
        self.distance, self.magnification = distance, 1.0
        turn, height = math.radians(turn), math.radians(height)
        away = (math.sin(turn) * math.cos(height), -math.cos(turn) * math.cos(height), math.sin(height))
        camera = self.renderer.GetActiveCamera()
        camera.SetViewAngle(36.0)
        camera.SetFocalPoint(0.0, 0.0, 0.0)
        camera.SetPosition(*away)
        camera.SetViewUp(0.0, 1.0 if view == "2" else 0.0, 0.0 if view == "2" else 1.0)
        self._look_at(self.middle)
        self.renderer.ResetCameraClippingRange()

    def magnify(self, steps: float) -> float:
        """By steps of the wheel, about the tip; how many times as large as the view was chosen. A drag over the picture
        leads the tip by so much less."""
        self.magnification = min(max(self.magnification * ZOOM**steps, 1.0), CLOSEST)
        return self.magnification

    def turn(self, right: float, up: float) -> None:
        """By angles [degrees]."""
        camera = self.renderer.GetActiveCamera()
        camera.Azimuth(-right)
        camera.Elevation(-up)
        camera.OrthogonalizeViewUp()

    def _look_at(self, apex: Floats) -> None:
        """The picture grows about the tip, which is seen where it was."""
        camera, share = self.renderer.GetActiveCamera(), 1.0 / self.magnification
        focus = apex + share * (self.middle - apex) + np.array([0.0, 0.0, RAISED * share])
        away = np.array(camera.GetPosition()) - np.array(camera.GetFocalPoint())
        camera.SetFocalPoint(*focus)
        camera.SetPosition(*(focus + self.distance * share / np.linalg.norm(away) * away))

    def pixel(self, place: Floats) -> Floats:
        """Where a place in scene units is on the window [pixels]."""
        self.renderer.SetWorldPoint(*place, 1.0)
        self.renderer.WorldToDisplay()
        return np.array(self.renderer.GetDisplayPoint()[:2])

    def dragged(self, place: Floats, pixels: Floats) -> tuple[float, float]:
        """The way in x and y [m] that a drag by so many pixels means at this place."""
        step = 1e-3
        here = self.pixel(place)
        ways = np.stack([(self.pixel(place + step * axis) - here) / step for axis in np.eye(3)[:2]], axis=1)
        moved = np.linalg.lstsq(ways, pixels, rcond=1e-3)[0] * self.unit
        return float(moved[0]), float(moved[1])
