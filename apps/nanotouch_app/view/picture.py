# SPDX-License-Identifier: BSD-3-Clause
"""What the 3-D view shows, as plain numbers; knows no VTK.

One scene unit is the longer side of the surface. Heights are exaggerated so that the relief can be seen; the tip is
drawn in its own proportions at the lateral scale. Both are stated in the picture."""

from __future__ import annotations

import os
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from nanotouch.images import Topography, mip_levels
from nanotouch.plots import engineering, phases
from nanotouch.touch.record import Recording
from numpy.typing import NDArray

Floats = NDArray[np.float64]

MAX_PIXELS = 512  # per side of the mesh
MAX_TRACE = 2000  # points
RELIEF = 0.12  # height of the drawn relief where it has to be exaggerated [scene units]
TIP_HEIGHT = 0.22  # of the drawn tip [scene units]
TRACE_CEILING = 0.15  # the trace is drawn up to here above the surface [scene units]


@dataclass
class Picture:
    """Positions in scene units; `unit` [m] is one of them, `exaggeration` what heights are multiplied with besides."""

    heights: Floats  # (ny, nx) [m], row 0 at y = 0
    pixel_size: Floats  # (dy, dx) [m]
    unit: float
    exaggeration: float
    tip: Floats  # x, y, z of the apex; radius and half angle [rad]; empty without a recording
    trace: Floats  # (m, 3)
    force: Floats  # (m,) [N]
    caption: str

    @classmethod
    def of(cls, topography: Topography, recording: Recording | None, tip_radius: float | None = None) -> Picture:
        """Prepare the view of a surface and of what was recorded on it."""
        heights, pixel_size = _coarser(topography)
        unit = float(np.max(np.asarray(heights.shape) * pixel_size))
        relief = float(np.ptp(heights)) / unit
        exaggeration = _round(RELIEF / relief) if 0 < relief < RELIEF else 1.0
        tip, trace, force = np.empty(0), np.empty((0, 3)), np.empty(0)
        drawn = "to scale" if exaggeration == 1 else f"{exaggeration:g} times as high"
        lines = [f"{topography.name}: heights drawn {drawn}"]
        if recording is not None and len(recording):
            scale = np.array([1.0, 1.0, exaggeration]) / unit
            tip = _tip(recording, scale, unit, tip_radius)
            trace, force = _trace(recording, scale, float(np.max(heights)))
            lines.append(f"tip: R = {_length(tip[3] * unit)}, in proportion, at the scale of x and y")
            lines.append("trace: measured path of the tip, coloured by the force on it")
        return cls(heights, pixel_size, unit, exaggeration, tip, trace, force, "\n".join(lines))

    def save(self, file: str | os.PathLike[str]) -> None:
        """Write the picture for another process."""
        arrays: dict[str, Any] = {field.name: np.asarray(getattr(self, field.name)) for field in fields(self)}
        np.savez(file, **arrays)

    @classmethod
    def load(cls, file: str | os.PathLike[str]) -> Picture:
        """Read what :meth:`save` wrote."""
        with np.load(file) as stored:
            values = {name: stored[name] for name in stored.files}
        return cls(**{name: value.item() if value.ndim == 0 else value for name, value in values.items()})


def _coarser(topography: Topography) -> tuple[Floats, Floats]:
    """Mean heights and pixel size at the first halving that has at most MAX_PIXELS to a side."""
    shown = next(level for level in mip_levels(topography, smallest=1) if max(level.mean.shape) <= MAX_PIXELS)
    return shown.mean, np.asarray(shown.pixel_size)


def _round(value: float) -> float:
    """The next lower of 1, 1.5, 2, 3, 5, 7 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(max(step for step in (1, 1.5, 2, 3, 5, 7) if step <= value / power * (1 + 1e-12)) * power)


def _tip(recording: Recording, scale: Floats, unit: float, radius: float | None) -> Floats:
    """Apex where the tip turned back, its radius and half angle."""
    shape = recording.metadata.get("scene", {}).get("tip", {})
    row = min(phases(recording)[1], len(recording) - 1)
    apex = np.array([recording.x[row], recording.y[row], recording.tip_height[row]]) * scale
    radius = radius or float(shape.get("radius", 20e-9))
    return np.array([*apex, radius / unit, float(shape.get("half_angle", 0.3))])


def _trace(recording: Recording, scale: Floats, highest: float) -> tuple[Floats, Floats]:
    """Path and force, averaged to MAX_TRACE points; what is far above the surface is left out."""
    length = -(-len(recording) // MAX_TRACE)
    starts = np.arange(0, len(recording), length)
    counts = np.diff([*starts, len(recording)])
    columns = (recording.x, recording.y, recording.tip_height, recording.slave_force)
    x, y, z, force = (np.add.reduceat(column, starts) / counts for column in columns)
    near = z * scale[2] < highest * scale[2] + TRACE_CEILING
    return (np.stack([x, y, z], axis=1) * scale)[near], force[near]


def _length(metres: float) -> str:
    unit, factor = engineering("m", metres)
    return f"{metres * factor:.3g} {unit}"
