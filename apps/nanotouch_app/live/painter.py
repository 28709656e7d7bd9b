# SPDX-License-Identifier: BSD-3-Clause
"""What the flat panels draw with: a thin hand over VTK's 2-D context. Pixels, y upwards."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from nanotouch_app.live.arrays import to_vtk
from nanotouch_app.live.look import TEXT, Colour

MOST_WIDTHS = 2000
_WIDTHS: dict[tuple[str, int, bool], float] = {}  # of texts that were measured [pixels]


class Painter:
    """One context during one drawing."""

    def __init__(self, context: Any, vtk: Any) -> None:
        self.context, self.vtk = context, vtk

    def box(self, frame: tuple[float, float, float, float], fill: Colour, edge: Colour | None = None) -> None:
        """A rectangle x, y, width, height."""
        x, y, width, height = frame
        self._pen(edge, 1.0)
        self.context.GetBrush().SetColor(*fill, 255)
        self.context.DrawRect(x, y, width, height)

    def area(self, points: ArrayLike, fill: Colour, opacity: int = 255) -> None:
        """A filled strip: rows (x, lower, upper)."""
        rows = np.asarray(points, dtype=float)
        if len(rows) < 2:
            return
        self._pen(None, 1.0)
        self.context.GetBrush().SetColor(*fill, opacity)
        corners = np.empty((2 * len(rows), 2), dtype=np.float32)
        corners[0::2] = rows[:, [0, 1]]
        corners[1::2] = rows[:, [0, 2]]
        self.context.DrawQuadStrip(self._points(corners))

    def line(self, points: ArrayLike, colour: Colour, width: float = 1.5, dashed: bool = False) -> None:
        """A line through rows (x, y)."""
        rows = np.asarray(points, dtype=np.float32)
        if len(rows) < 2:
            return
        self._pen(colour, width, dashed)
        self.context.DrawPoly(self._points(rows))

    def dot(self, x: float, y: float, radius: float, fill: Colour, edge: Colour | None = None) -> None:
        """A disc."""
        self._pen(edge, 1.5)
        self.context.GetBrush().SetColor(*fill, 255)
        self.context.DrawEllipse(x, y, radius, radius)

    def ring(self, x: float, y: float, radius: float, colour: Colour, width: float = 2.0, opacity: int = 255) -> None:
        """A circle."""
        self._pen(colour, width, opacity=opacity)
        self.context.GetBrush().SetColor(0, 0, 0, 0)
        self.context.DrawEllipse(x, y, radius, radius)

    def scale(self, left: float, right: float, y: float, colour: Colour) -> None:
        """A length between two ticks."""
        self.line([[left, y], [right, y]], colour, 2.0)
        for end in (left, right):
            self.line([[end, y - 4.0], [end, y + 4.0]], colour, 2.0)

    def text(self, x: float, y: float, words: str, colour: Colour, size: int = TEXT, align: str = "left",
             bold: bool = False) -> None:  # fmt: skip
        """A line of text whose middle is at the height y; align: left, centre, right."""
        if not words:
            return
        properties = self.context.GetTextProp()
        properties.SetColor(*(part / 255.0 for part in colour))
        properties.SetFontSize(size)
        properties.SetBold(bold)
        properties.SetFontFamilyToArial()
        properties.SetVerticalJustificationToCentered()
        getattr(properties, {"left": "SetJustificationToLeft", "centre": "SetJustificationToCentered",
                             "right": "SetJustificationToRight"}[align])()  # fmt: skip
        self.context.DrawString(x, y, words)

    def width_of(self, words: str, size: int = TEXT, bold: bool = False) -> float:
        """Width of a text [pixels]."""
        key = (words, size, bold)
        if key not in _WIDTHS:
            if len(_WIDTHS) > MOST_WIDTHS:
                _WIDTHS.clear()
            properties = self.context.GetTextProp()
            properties.SetFontSize(size)
            properties.SetBold(bold)
            properties.SetFontFamilyToArial()
            bounds = self.vtk.vtkPoints2D()
            bounds.SetNumberOfPoints(2)
            self.context.ComputeStringBounds(words, bounds)
            _WIDTHS[key] = float(bounds.GetPoint(1)[0])
        return _WIDTHS[key]

    def fitted(self, words: str, room: float, size: int = TEXT) -> str:
        """The words, or as many of their letters as have room [pixels], with dots at the end."""
        if self.width_of(words, size) <= room:
            return words
        kept = words[: max(0, int(len(words) * room / max(self.width_of(words, size), 1.0)))]
        while kept and self.width_of(f"{kept.rstrip()} ...", size) > room:
            kept = kept[:-1]
        return f"{kept.rstrip()} ..." if kept else ""

    def _pen(self, colour: Colour | None, width: float, dashed: bool = False, opacity: int = 255) -> None:
        pen = self.context.GetPen()
        pen.SetColorF(0.0, 0.0, 0.0)
        if colour is None:
            pen.SetLineType(self.vtk.vtkPen.NO_PEN)
            return
        pen.SetColor(*colour, opacity)
        pen.SetWidth(width)
        pen.SetLineType(self.vtk.vtkPen.DASH_LINE if dashed else self.vtk.vtkPen.SOLID_LINE)

    def _points(self, rows: Any) -> Any:
        points = self.vtk.vtkPoints2D()
        points.SetData(to_vtk(np.asarray(rows, dtype=np.float32)))
        return points
