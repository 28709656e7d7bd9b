# SPDX-License-Identifier: BSD-3-Clause
"""The film: on the left the map with the tip over it, on the right what the hand would feel."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import images
from nanotouch.errors import require

from nanotouch_app.studies.workflow.steps import TARGET, Scanned, Work

RATE = 6  # pictures per second
SCANNING, TOUCHING, PUSHING, LAST = 12, 12, 56, 12  # pictures of each part
COLOURS = "afmhot"


class _Sheet:
    """A map and a graph, drawn anew for each picture."""

    def __init__(self, done: Work) -> None:
        self.done = done
        self.figure = require("matplotlib.figure", "app").Figure(figsize=(9.6, 4.6), dpi=80)
        require("matplotlib.backends.backend_agg", "app").FigureCanvasAgg(self.figure)
        self.map, self.graph = self.figure.subplots(1, 2)
        self.figure.subplots_adjust(left=0.07, right=0.98, bottom=0.13, top=0.9, wspace=0.22)
        self.top = 1e9 * float(done.first.surface.heights.max())

    def clear(self, title: str) -> None:
        self.map.clear()
        self.graph.clear()
        self.figure.suptitle(title, x=0.02, ha="left")

    def show(self, topography: nt.Topography, rows: int | None = None) -> None:
        """Heights, of the lowest rows alone where a scan goes on."""
        heights, (height, width), (dy, dx) = 1e9 * topography.heights, topography.size, topography.pixel_size
        shown = heights.copy()
        if rows is not None:
            shown[rows:] = np.nan
        ends = -0.5 * dx, width - 0.5 * dx, -0.5 * dy, height - 0.5 * dy  # a pixel stands for its middle
        extent = tuple(1e6 * end for end in ends)
        self.map.imshow(shown, origin="lower", extent=extent, cmap=COLOURS, vmin=0.0, vmax=self.top)
        self.map.plot(1e6 * TARGET[0], 1e6 * TARGET[1], "+", color="tab:cyan", markersize=12)
        self.map.set(xlim=extent[:2], ylim=extent[2:], xlabel="x (µm)", ylabel="y (µm)")
        self.map.set_facecolor("0.85")

    def tip(self, x: float, y: float) -> None:
        self.map.plot(1e6 * x, 1e6 * y, "v", color="tab:green", markersize=8)


def write(done: Work, path: Path, progress: Callable[[float], None]) -> None:
    """All parts as one GIF."""
    animation = require("matplotlib.animation", "app")
    sheet = _Sheet(done)
    writer = animation.PillowWriter(fps=RATE)
    total = 2 * SCANNING + TOUCHING + PUSHING + LAST
    with writer.saving(sheet.figure, str(path), dpi=80):
        for number, _ in enumerate(_pictures(sheet), 1):
            writer.grab_frame()
            progress(number / total)


def _pictures(sheet: _Sheet) -> Iterator[Any]:
    done = sheet.done
    yield from _scanning(sheet, done.first, "1. Scan: tapping mode, the tip undone")
    yield from _touching(sheet)
    yield from _pushing(sheet)
    yield from _scanning(sheet, done.again, "4. Scan again: where is it now?")
    facts = done.facts()
    for _ in range(LAST):
        sheet.clear("The particle lies between the others")
        sheet.show(done.again.surface)
        sheet.graph.axis("off")
        sheet.graph.text(0.0, 0.5, _summary(facts), va="center", fontsize="large", linespacing=1.8)
        yield


def _summary(facts: dict[str, float]) -> str:
    return (
        f"{facts['pushes']} pushes, {facts['bench_time_s']:.0f} s, drift 1 nm/s\n"
        f"{1e9 * facts['error_m']:.0f} nm from the target\n"
        f"the map followed within {1e9 * facts['predicted_error_m']:.0f} nm\n"
        f"the scan shows it within {1e9 * facts['map_error_again_m']:.0f} nm"
    )


def _scanning(sheet: _Sheet, found: Scanned, title: str) -> Iterator[Any]:
    lines, pixels = found.surface.shape
    (dy, dx), x = found.surface.pixel_size, 1e6 * found.surface.pixel_size[1] * np.arange(pixels)
    for part in range(1, SCANNING + 1):
        line = part * lines // SCANNING - 1
        sheet.clear(title)
        sheet.show(found.surface, line + 1)
        sheet.tip((pixels - 1) * dx, line * dy)
        sheet.graph.plot(x, 1e9 * found.image.trace.height[line], label="there")
        sheet.graph.plot(x, 1e9 * found.image.retrace.height[line], "--", label="back")
        sheet.graph.set(xlabel="x (µm)", ylabel="height of the apex (nm)", ylim=(-20.0, 1.15 * sheet.top))
        sheet.graph.legend(loc="upper right", frameon=False)
        yield


def _touching(sheet: _Sheet) -> Iterator[Any]:
    done, columns = sheet.done, sheet.done.touched.recording.columns
    table, number = done.first.particles, done.number
    gap, force = 1e9 * columns["gap"], 1e9 * columns["tip_force"]
    near = np.flatnonzero(gap < 20.0)
    first, count = int(near[0]), int(near[-1] - near[0])
    for part in range(1, TOUCHING + 1):
        rows = slice(first, first + part * count // TOUCHING + 1)
        sheet.clear("2. Touch: a force curve on its top")
        sheet.show(done.first.surface)
        sheet.tip(float(table.x[number - 1]), float(table.y[number - 1]))
        sheet.graph.plot(gap[rows], force[rows], color="tab:orange")
        sheet.graph.set(xlim=(min(gap.min(), 0.0) - 1.0, 20.0), ylim=(1.5 * force.min() - 2.0, 1.1 * force.max()))
        sheet.graph.set(xlabel="gap (nm)", ylabel="force on the tip (nN)")
        yield


def _pushing(sheet: _Sheet) -> Iterator[Any]:
    done, track = sheet.done, sheet.done.pushed.track
    rows = np.linspace(0, len(track.time) - 1, PUSHING).astype(int)
    limit = 1.2e9 * np.abs(track.force).max()
    for row in rows:
        x, y = (float(value) for value in track.particle[row, :2])
        sheet.clear("3. Push: the map follows the particle")
        sheet.show(images.moved(done.first.surface, done.first.particles, done.number, (x, y)))
        sheet.map.plot(*(1e6 * track.particle[: row + 1, :2].T), color="tab:cyan", linewidth=1)
        sheet.tip(float(track.tip[row, 0]), float(track.tip[row, 1]))
        for axis, name in enumerate("xyz"):
            sheet.graph.plot(track.time[: row + 1], 1e9 * track.force[: row + 1, axis], label=f"along {name}")
        sheet.graph.set(
            xlim=(0.0, track.time[-1]), ylim=(-limit, limit), xlabel="time (s)", ylabel="force on the tip (nN)"
        )
        sheet.graph.legend(loc="upper right", frameon=False, ncols=3)
        yield
