# SPDX-License-Identifier: BSD-3-Clause
"""The whole picture: where each panel lies, and one drawing of what is seen. A window shows it; so does a file."""

from __future__ import annotations

from typing import Any

import numpy as np

from nanotouch_app.live import board, cards, readings
from nanotouch_app.live.charts import ForceGap, History
from nanotouch_app.live.contact import ContactPanel
from nanotouch_app.live.entry import Entry
from nanotouch_app.live.lens import Lens
from nanotouch_app.live.look import DARK, LIGHT, PROPERTY_NAMES, SMALL, Palette, digits, is_still, step_up, unit
from nanotouch_app.live.painter import Painter
from nanotouch_app.live.reel import Reel
from nanotouch_app.live.seen import Seen
from nanotouch_app.live.sliders import Sliders, height_of
from nanotouch_app.live.stage import Stage

Frame = tuple[float, float, float, float]
EDGE, TOP, STATUS, GUIDE = 12.0, 40.0, 56.0, 32.0  # [pixels]
COLUMN = {False: 0.34, True: 0.385}  # of the width: the right column with one chart, with all
NARROW = 900.0  # below this width the right column goes away
BAND = 0.15  # of the picture's height: the band under the largest planned force
ROOMY = 760.0, 520.0  # for the cards [pixels]
RING, MARGIN = 13.0, 16.0  # [pixels]
BAR, COLOURS = 80.0, 120.0  # least length of the scale bar; of the bar of colours [pixels]


class Layout:
    """The panels of a window of a size: one slider and one chart, or all of them."""

    def __init__(self, width: float, height: float, full: bool = False) -> None:
        self.width, self.height, self.full = width, height, full
        column = 0.0 if width < NARROW else round(COLUMN[full] * width)
        left = width - 2 * EDGE - (column + EDGE if column else 0.0)
        self.top: Frame = (EDGE, height - TOP, width - 2 * EDGE, TOP)
        self.status: Frame = (EDGE, EDGE, width - 2 * EDGE, STATUS)
        controls = height_of(left, full)
        self.controls: Frame = (EDGE, 2 * EDGE + STATUS, left, controls)
        floor = 3 * EDGE + STATUS + controls
        self.guide: Frame = (EDGE, height - TOP - GUIDE, left, GUIDE)
        self.view: Frame = (EDGE, floor, left, height - TOP - GUIDE - floor)
        self.bars: Frame = (EDGE + left - 232, floor + 12, 220, 124)
        self.cards: Frame = (EDGE + 12, floor + 8, left - 24, height - TOP - floor - 16)
        if min(self.cards[2] / ROOMY[0], self.cards[3] / ROOMY[1]) < 1.0:  # over all but the status
            self.cards = (EDGE, 2 * EDGE + STATUS, width - 2 * EDGE, height - TOP - STATUS - 3 * EDGE)
        tall = min(readings.HELP_HEAD + readings.HELP_LINE * len(readings.HELP), height - TOP - 2 * EDGE)
        self.help: Frame = (EDGE + 40, min(floor + 20, height - TOP - EDGE - tall), 520, tall)
        base, room = 2 * EDGE + STATUS, height - TOP - 2 * EDGE - STATUS
        shares = (0.36, 0.38, 0.26)
        heights = [share * (room - 2 * EDGE) for share in shares]
        x = width - EDGE - column
        self.history: Frame = (x, base, column, heights[2])
        self.law: Frame = (
            (x, base + heights[2] + EDGE, column, heights[1]) if full else (x, base, column, height - TOP - base)
        )
        self.contact: Frame = (x, base + heights[2] + heights[1] + 2 * EDGE, column, heights[0])
        self.column = column > 0.0


class Picture:
    """Renderers of a VTK window, and the item that paints all that is flat."""

    def __init__(self, vtk: Any, window: Any, heights: Any, pixel_size: Any) -> None:
        self.vtk, self.window, self.seen = vtk, window, Seen()
        self.palette: Palette = LIGHT
        self.help = self.menu = self.full = False
        self.entry: Entry | None = None
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
        self._begin()
        self._paint_on(self.back, self.background)
        self._paint_on(self.front, self.foreground)
        self.dress(LIGHT)

    def lay(self, heights: Any, pixel_size: Any) -> None:
        """Another surface, before :meth:`dress`."""
        self.scene.RemoveAllViewProps()
        self.heights, self.pixel_size = np.asarray(heights, dtype=float), np.asarray(pixel_size, dtype=float)
        self.stage = Stage(self.vtk, self.scene, self.heights, self.pixel_size)
        self.sliders = Sliders()
        self.sliders.full = self.full

    def _begin(self) -> None:
        """Charts of another sample."""
        self.contact, self.law, self.history, self.lens = ContactPanel(), ForceGap(), History(), Lens(is_still())

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
        if message["tell"] == "laid":
            with np.load(message["path"]) as stored:
                self.lay(stored["heights"], stored["pixel_size"])
                self.stage.give({name: stored[name] for name in stored.files if name in PROPERTY_NAMES})
            self._begin()
            self.dress(self.palette)
        if message["tell"] == "dents" and self.seen.dented is not None:
            dented = self.seen.dented
            self.stage.reshape(dented.heights(self.heights, self.pixel_size, self.stage.origin), dented.relief)
        if message["tell"] == "particles":
            self.stage.balls.show(message, self.stage.origin)
        if message["tell"] == "properties":
            with np.load(message["path"]) as stored:
                self.stage.give({name: stored[name] for name in stored.files})
        if message["tell"] == "world":
            self.sliders.take(message)
            tip = message["scene"]["tip"]
            self.stage.mount(float(tip["radius"]), float(tip["half_angle"]), str(tip["shape"]))

    def magnify(self, steps: float) -> None:
        """Draw the tip's surroundings larger, by steps of the wheel."""
        self.hear({"tell": "note", "text": f"{self.stage.magnify(steps):.3g} times as large"})

    def render(self) -> None:
        """Draw what is seen now."""
        size = self.window.GetSize()
        if (self.layout.width, self.layout.height, self.layout.full) != (*size, self.full):
            self.layout = Layout(size[0], size[1], self.full)
            self.sliders.full = self.full
        x, y, width, height = self.layout.view
        self.scene.SetViewport(x / size[0], y / size[1], (x + width) / size[0], (y + height) / size[1])
        self.sliders.frame = self.layout.controls
        if self.seen.frame is not None and self.seen.world:
            self.stage.update(self.seen)
            self.stage.lights("surface" not in self.seen.hides)
        self.scene.ResetCameraClippingRange()
        self.window.Render()
        self.drawings += 1

    # --- what is flat ---

    def background(self, painter: Painter) -> None:
        """Behind the scene: the panels."""
        seen, palette, layout = self.seen, self.palette, self.layout
        readings.top(painter, palette, layout.top, seen, self.full)
        readings.guide(painter, palette, layout.guide, seen)
        if self.reel is None and "sliders" in seen.hides:
            self._hidden(painter, layout.controls, "the sliders: hidden during this task")
        elif self.reel is None:
            self.sliders.draw(painter, palette, seen)
        else:
            self._time_line(painter, self.reel)
        readings.status(painter, palette, layout.status, seen, self._about(), self.full)
        if layout.column:
            panels: list[tuple[str, str, ContactPanel | ForceGap, Frame]] = [("law", "the law", self.law, layout.law)]
            if self.full:
                panels.append(("contact", "the section", self.contact, layout.contact))
            for name, words, panel, frame in panels:
                if name in seen.hides:
                    self._hidden(painter, frame, f"{words}: hidden during this task")
                elif name == "contact" and seen.is_blind:
                    self._hidden(painter, frame, f"{words}: not known of a real slave, which measures a force alone")
                else:
                    panel.draw(painter, palette, frame, seen)
            if self.full:
                self.history.draw(painter, palette, layout.history, seen)

    def _hidden(self, painter: Painter, frame: Frame, words: str) -> None:
        x, y, width, height = frame
        painter.box(frame, self.palette.panel, self.palette.line)
        painter.text(x + 0.5 * width, y + 0.5 * height, words, self.palette.quiet, SMALL, "centre")

    @property
    def board(self) -> dict[str, Any]:
        """What stands on the board: the list of tasks, the task, or {} for nothing."""
        return board.menu() if self.menu else self.seen.task

    @property
    def corner(self) -> tuple[float, float]:
        """Of the board: its upper left."""
        x, y, _, height = self.layout.view
        return x + 8.0, y + height - 8.0

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
            if not {"contact", "surface"} & set(self.seen.hides) and not self.seen.is_blind:
                tip = self.stage.pixel(self.stage.apex(self.seen))
                self.lens.draw(painter, self.palette, self.layout.view, tip, self.seen)
        if self.full:
            readings.bars(painter, self.palette, self.layout.bars, self.seen)
        if self.board:
            typed = self.entry.shown if self.entry is not None and self.entry.slider is None else ""
            board.draw(painter, self.palette, self.board, self.corner, typed)
        if self.cards:
            cards.draw(painter, self.palette, self.layout.cards, str(self.seen.world.get("title", "")))
        if self.help:
            readings.help_panel(painter, self.palette, self.layout.help)

    def _proxy(self, painter: Painter) -> None:
        """The ring is where the hand is; the band to the tip is as long as what would be felt."""
        seen, palette = self.seen, self.palette
        apex = self.stage.apex(seen)
        x, y = self.stage.pixel(apex)
        full = BAND * self.layout.view[3] / max(seen.load, 1e-15)
        length = float(np.clip(full * seen.force, *self._longest))
        across, along = self._sideways(apex, full)
        colour = palette.repulsion if length >= 0.0 else palette.attraction
        if np.hypot(across, along - length) > 1.0:
            painter.line([[x, y], [x + across, y + along - length]], colour, 3.0)
        painter.ring(x + across, y + along - length, RING, palette.quiet if seen.stale else palette.ink, 2.5)

    @property
    def _longest(self) -> tuple[float, float]:
        """Of the band, either way [px]."""
        longest = 1.5 * BAND * self.layout.view[3]
        return -longest, longest

    def _sideways(self, apex: Any, full: float) -> tuple[float, float]:
        """What holds the tip sideways stretches the band, as it is seen: the ring is ahead of it."""
        force = self.seen.sideways
        size = float(np.linalg.norm(force))
        if not size > 0.0:
            return 0.0, 0.0
        ahead = np.append(-force / size, 0.0)
        seen = self.stage.pixel(apex + 1e-3 * ahead) - self.stage.pixel(apex)
        length = min(full * size, self._longest[1]) / max(float(np.hypot(*seen)), 1e-12)
        return float(length * seen[0]), float(length * seen[1])

    def _scales(self, painter: Painter) -> None:
        """A bar at the depth of what the camera looks at, and how much heights are drawn larger."""
        stage, palette, layout = self.stage, self.palette, self.layout
        camera = self.scene.GetActiveCamera()
        place = np.array(camera.GetFocalPoint())
        across = np.cross(camera.GetDirectionOfProjection(), camera.GetViewUp())
        step = 1e-3 * across / np.linalg.norm(across)
        per_metre = float(np.hypot(*(stage.pixel(place + step) - stage.pixel(place)))) / (1e-3 * stage.unit)
        length = step_up(BAR / per_metre)
        pixels = length * per_metre
        told, drawn = self._heights_told()
        has_heights = float(np.ptp(stage.heights)) > 0.0 or len(stage.maps) > 1
        room = painter.width_of(f"{told}, {drawn}", SMALL) <= layout.bars[0] - layout.view[0] - COLOURS - 46
        if room:
            told, drawn = ", ".join(filter(None, (told, drawn))), ""
        x, y = layout.view[0] + 18, layout.view[1] + 22
        second = max(COLOURS, pixels + 60) + 10
        wide = max(pixels + 10 + painter.width_of(digits(length, "m", 1), SMALL),
                   has_heights * (COLOURS + 10 + painter.width_of(told, SMALL)),
                   bool(drawn) * (second + painter.width_of(drawn, SMALL)))  # fmt: skip
        painter.box((x - 10, y - 13, wide + 20, 52 if has_heights else 26), palette.panel, palette.line)
        painter.line([[x, y], [x + pixels, y]], palette.ink, 3.0)
        painter.text(x + pixels + 10, y, digits(length, "m", 1), palette.ink, SMALL)
        if has_heights:
            self._colours(painter, x, y + 26)
            painter.text(x + COLOURS + 10, y + 26, told, palette.ink, SMALL)
            painter.text(x + second, y, drawn, palette.ink, SMALL)

    def _colours(self, painter: Painter, x: float, y: float) -> None:
        table = np.array(self.stage.table, dtype=float)
        for part, place in enumerate(np.linspace(0.0, len(table) - 1.0, 24)):
            colour = [int(np.interp(place, np.arange(len(table)), table[:, one])) for one in range(3)]
            painter.box((x + part * COLOURS / 24, y - 5, COLOURS / 24 + 1, 10), (colour[0], colour[1], colour[2]))

    def _heights_told(self) -> tuple[str, str]:
        """What the colours mean, and how much higher than they are heights are drawn."""
        stage = self.stage
        told = f"heights 0 to {digits(float(np.ptp(stage.heights)), 'm')}"
        if stage.shown in PROPERTY_NAMES:
            name, unit_name = PROPERTY_NAMES[stage.shown]
            told = f"{name} {' to '.join(digits(end, unit_name) for end in stage.ends)}"
        drawn = "" if stage.factor == 1.0 else f"drawn {stage.factor:g} times as high"
        return told + ("   K: next" if len(stage.maps) > 1 else ""), drawn

    def _about(self) -> str:
        """What is typed for a slider; what it does, while the pointer is over it."""
        if self.entry is not None and self.entry.slider is not None:
            return self.entry.shown
        slider = self.sliders.held or self.sliders.hovered
        if slider is None or self.reel is not None:
            return ""
        row = slider.row
        ends = " to ".join(row.told(value) for value in (row.low, row.high))
        return f"{row.doc} ({row.field}): {ends}"


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
