# SPDX-License-Identifier: BSD-3-Clause
"""The whole picture: where each panel lies, and one drawing of what is seen. A window shows it; so does a file."""

from __future__ import annotations

from typing import Any

import numpy as np

from nanotouch_app.live import cards, readings
from nanotouch_app.live.charts import ForceGap, History
from nanotouch_app.live.contact import ContactPanel
from nanotouch_app.live.look import DARK, LIGHT, SMALL, Palette, digits, step_up, unit
from nanotouch_app.live.painter import Painter
from nanotouch_app.live.reel import Reel
from nanotouch_app.live.seen import Seen
from nanotouch_app.live.sliders import Sliders
from nanotouch_app.live.stage import Stage
from nanotouch_app.live.subject import of_preset

Frame = tuple[float, float, float, float]
EDGE, TOP, STATUS, CONTROLS = 12.0, 40.0, 56.0, 122.0  # [pixels]
NARROW = 900.0  # below this width the right column goes away
BAND = 0.15  # of the picture's height: the band under the largest planned force
RING, MARGIN = 13.0, 16.0  # [pixels]


class Layout:
    """The panels of a window of a size."""

    def __init__(self, width: float, height: float) -> None:
        self.width, self.height = width, height
        column = 0.0 if width < NARROW else round(0.385 * width)
        left = width - 2 * EDGE - (column + EDGE if column else 0.0)
        self.top: Frame = (EDGE, height - TOP, width - 2 * EDGE, TOP)
        self.status: Frame = (EDGE, EDGE, width - 2 * EDGE, STATUS)
        self.controls: Frame = (EDGE, 2 * EDGE + STATUS, left, CONTROLS)
        floor = 3 * EDGE + STATUS + CONTROLS
        self.view: Frame = (EDGE, floor, left, height - TOP - floor)
        self.bars: Frame = (EDGE + left - 232, floor + 12, 220, 124)
        self.cards: Frame = (EDGE + 12, floor + 8, left - 24, height - TOP - floor - 16)
        self.help: Frame = (EDGE + 40, floor + 20, 520, 70 + 25 * len(readings.HELP))
        base, room = 2 * EDGE + STATUS, height - TOP - 2 * EDGE - STATUS
        shares = (0.36, 0.38, 0.26)
        heights = [share * (room - 2 * EDGE) for share in shares]
        x = width - EDGE - column
        self.history: Frame = (x, base, column, heights[2])
        self.law: Frame = (x, base + heights[2] + EDGE, column, heights[1])
        self.contact: Frame = (x, base + heights[2] + heights[1] + 2 * EDGE, column, heights[0])
        self.column = column > 0.0


class Picture:
    """Renderers of a VTK window, and the item that paints all that is flat."""

    def __init__(self, vtk: Any, window: Any, heights: Any, pixel_size: Any) -> None:
        self.vtk, self.window, self.seen = vtk, window, Seen()
        self.palette: Palette = LIGHT
        self.help = False
        self.reel: Reel | None = None
        self.drawings = 0
        self.layout = Layout(*window.GetSize())
        window.SetNumberOfLayers(3)
        self.back, self.scene, self.front = (vtk.vtkRenderer() for _ in range(3))
        for layer, renderer in enumerate((self.back, self.scene, self.front)):
            renderer.SetLayer(layer)
            window.AddRenderer(renderer)
        self.cards = False
        self.lay(heights, pixel_size)
        self.contact, self.law, self.history = ContactPanel(), ForceGap(), History()
        self._paint_on(self.back, self.background)
        self._paint_on(self.front, self.foreground)
        self.dress(LIGHT)

    def lay(self, heights: Any, pixel_size: Any) -> None:
        """Another surface, before :meth:`dress`."""
        self.scene.RemoveAllViewProps()
        self.stage = Stage(self.vtk, self.scene, np.asarray(heights, dtype=float), np.asarray(pixel_size, dtype=float))
        self.sliders = Sliders()

    def _paint_on(self, renderer: Any, paint: Any) -> None:
        item = self.vtk.vtkPythonItem()
        item.SetPythonObject(_Item(self.vtk, paint))
        actor = self.vtk.vtkContextActor()
        actor.GetScene().AddItem(item)
        renderer.AddActor(actor)

    def dress(self, palette: Palette) -> None:
        """Light or dark."""
        self.palette = palette
        self.back.SetBackground(*unit(palette.paper))
        self.stage.paint(palette)

    def turn_light(self) -> None:
        """From light to dark and back."""
        self.dress(DARK if self.palette is LIGHT else LIGHT)

    def hear(self, message: dict[str, Any]) -> None:
        """What the host tells."""
        self.seen.hear(message)
        if message["tell"] == "preset":
            topography = of_preset(message["name"]).topography
            self.lay(topography.heights, topography.pixel_size)
            self.contact, self.law, self.history = ContactPanel(), ForceGap(), History()
            self.dress(self.palette)
        if message["tell"] == "world":
            self.sliders.take(message)
            tip = message["scene"]["tip"]
            self.stage.mount(float(tip["radius"]), float(tip["half_angle"]), str(tip["shape"]))

    def render(self) -> None:
        """Draw what is seen now."""
        size = self.window.GetSize()
        if (self.layout.width, self.layout.height) != tuple(size):
            self.layout = Layout(*size)
        x, y, width, height = self.layout.view
        self.scene.SetViewport(x / size[0], y / size[1], (x + width) / size[0], (y + height) / size[1])
        self.sliders.frame = self.layout.controls
        if self.seen.frame is not None and self.seen.world:
            self.stage.update(self.seen)
        self.scene.ResetCameraClippingRange()
        self.window.Render()
        self.drawings += 1

    # --- what is flat ---

    def background(self, painter: Painter) -> None:
        """Behind the scene: the panels."""
        seen, palette, layout = self.seen, self.palette, self.layout
        readings.top(painter, palette, layout.top, seen)
        if self.reel is None:
            self.sliders.draw(painter, palette, seen)
        else:
            self._time_line(painter, self.reel)
        readings.status(painter, palette, layout.status, seen, self._about())
        if layout.column:
            self.contact.draw(painter, palette, layout.contact, seen)
            self.law.draw(painter, palette, layout.law, seen)
            self.history.draw(painter, palette, layout.history, seen)

    def _time_line(self, painter: Painter, reel: Reel) -> None:
        """The whole recording: least and largest force of each pixel, and where we are."""
        palette, frame = self.palette, self.layout.controls
        x, y, width, height = frame
        painter.box(frame, palette.panel, palette.line)
        across = width - 2.0 * MARGIN
        low, high = reel.extremes(int(across))
        size = max(float(high.max()), -float(low.min()), 1e-15)
        middle = y + 0.55 * height
        along = x + MARGIN + np.linspace(0.0, across, len(low))
        up = 0.32 * height / size
        painter.area(np.stack([along, middle + up * low - 0.6, middle + up * high + 0.6], axis=1), palette.accent)
        at = x + MARGIN + across * reel.at / max(reel.length, 1e-9)
        painter.line([[at, y + 26], [at, y + height - 8]], palette.hold, 2.0)
        painter.text(x + MARGIN, y + 14, f"{reel.at:.2f} s of {reel.length:.2f} s", palette.ink, SMALL)
        painter.text(x + width - MARGIN, y + 14, "force on the tip over time; drag to go there", palette.quiet, SMALL,
                     "right")  # fmt: skip

    def foreground(self, painter: Painter) -> None:
        """Over the scene: ring and band, scales, bars, help."""
        if self.seen.frame is not None and self.seen.world:
            self._proxy(painter)
            self._scales(painter)
        readings.bars(painter, self.palette, self.layout.bars, self.seen)
        if self.cards:
            cards.draw(painter, self.palette, self.layout.cards, str(self.seen.world.get("title", "")))
        if self.help:
            readings.help_panel(painter, self.palette, self.layout.help)

    def _proxy(self, painter: Painter) -> None:
        """The ring is where the hand is; the band to the tip is as long as what would be felt."""
        seen, palette = self.seen, self.palette
        x, y = self.stage.pixel(self.stage.apex(seen))
        length = BAND * self.layout.view[3] * float(np.clip(seen.force / max(seen.load, 1e-15), -1.5, 1.5))
        colour = palette.repulsion if length >= 0.0 else palette.attraction
        if abs(length) > 1.0:
            painter.line([[x, y], [x, y - length]], colour, 3.0)
        painter.ring(x, y - length, RING, palette.quiet if seen.stale else palette.ink, 2.5)

    def _scales(self, painter: Painter) -> None:
        """A bar along the near edge of the surface, and how much heights are drawn larger."""
        stage, palette, layout = self.stage, self.palette, self.layout
        size = stage.heights.shape[1] * stage.dx * stage.unit
        length = step_up(0.12 * size)
        start = np.array([0.02, 0.0, 0.0])
        a, b = stage.pixel(start), stage.pixel(start + np.array([length / stage.unit, 0.0, 0.0]))
        x, y = layout.view[0] + 18, layout.view[1] + 22
        pixels = float(np.hypot(*(b - a)))
        painter.line([[x, y], [x + pixels, y]], palette.ink, 3.0)
        painter.text(x + pixels + 10, y, digits(length, "m", 1), palette.ink, SMALL)
        relief = float(np.ptp(stage.heights))
        if relief > 0.0:
            self._heights(painter, x, y + 26, relief)

    def _heights(self, painter: Painter, x: float, y: float, relief: float) -> None:
        width, count = 120.0, len(self.palette.heights)
        colours = np.array(self.palette.heights, dtype=float)
        for part in range(24):
            place = part / 23.0 * (count - 1)
            low = min(int(place), count - 2)
            colour = colours[low] + (place - low) * (colours[low + 1] - colours[low])
            painter.box(
                (x + part * width / 24, y - 5, width / 24 + 1, 10), (int(colour[0]), int(colour[1]), int(colour[2]))
            )
        drawn = "" if self.stage.factor == 1.0 else f", drawn {self.stage.factor:g} times as high"
        painter.text(x + width + 10, y, f"heights 0 to {digits(relief, 'm')}{drawn}", self.palette.ink, SMALL)

    def _about(self) -> str:
        """What a slider does, while the pointer is over it."""
        slider = self.sliders.held or self.sliders.hovered
        if slider is None:
            return ""
        ends = " to ".join(slider.told(value) for value in (slider.low, slider.high))
        return f"{slider.about.doc} ({slider.field}): {ends}"


class _Item:
    """What vtkPythonItem calls."""

    def __init__(self, vtk: Any, paint: Any) -> None:
        self.vtk, self.paint = vtk, paint

    def Initialize(self, item: Any) -> bool:
        return True

    def Paint(self, item: Any, context: Any) -> bool:
        self.paint(Painter(context, self.vtk))
        return True


def save(vtk: Any, window: Any, path: str) -> None:
    """Write what the window shows to a PNG."""
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()
