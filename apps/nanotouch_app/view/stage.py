# SPDX-License-Identifier: BSD-3-Clause
"""VTK's actors for a picture. Colours always come from an explicit transfer function: VTK's default table looks
different in a browser."""

from __future__ import annotations

from typing import Any

import numpy as np
from nanotouch.errors import require
from nanotouch.plots import engineering
from numpy.typing import NDArray

from nanotouch_app.view.picture import TIP_HEIGHT, Picture

Floats = NDArray[np.float64]
Colour = tuple[float, float, float]

INK: Colour = (0.12, 0.12, 0.12)
PAPER: Colour = (1.0, 1.0, 1.0)
GOLD: list[Colour] = [(0.25, 0.14, 0.08), (0.52, 0.30, 0.12), (0.82, 0.58, 0.26), (0.98, 0.90, 0.70)]  # low to high
ATTRACTION, NEUTRAL, REPULSION = (0.0, 0.62, 1.0), (1.0, 1.0, 1.0), (0.55, 0.0, 0.65)
TRACE_RADIUS = 0.004  # [scene units]
RING = (0.035, 0.043)  # around a touch at a point, inner and outer radius [scene units]


def build(picture: Picture, height: int, note: str = "") -> Any:
    """A renderer with surface, axes, tip, trace, scales and captions; the camera in front, x to the right.

    `height` of the picture [pixels] decides the size of its letters; `note` goes to the top.
    """
    vtk = require("vtk", "view")
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(*PAPER)
    surface, heights = _surface(vtk, picture)
    renderer.AddActor(surface)
    letters = max(8, height // 56)
    unit, factor = engineering("m", heights.GetRange())
    bars = [_scale(vtk, heights, f"height ({unit})", factor, 0.89)]
    if len(picture.force):
        trace, forces = _trace(vtk, picture)
        renderer.AddActor(trace)
        unit, factor = engineering("N", forces.GetRange())
        bars.append(_scale(vtk, forces, f"force ({unit})", factor, 0.02))
    if len(picture.tip):
        stands = not len(picture.trace) or bool(np.ptp(picture.trace[:, :2], axis=0).max() < 2.0 * RING[1])
        renderer.AddActor(_tip(vtk, picture.tip, 0.25 if stands else 0.55))
        if stands:
            renderer.AddActor(_ring(vtk, picture.tip))
    for bar in bars:
        _plain(bar.GetTitleTextProperty(), letters)
        _plain(bar.GetLabelTextProperty(), letters)
        renderer.AddViewProp(bar)
    for text, place in ((picture.caption, (0.02, 0.02)), (note, (0.02, 0.95))):
        renderer.AddViewProp(_text(vtk, text, place, letters))
    _look(renderer, surface.GetBounds())
    axes = _axes(vtk, picture, surface.GetBounds(), letters)
    axes.SetCamera(renderer.GetActiveCamera())
    renderer.AddActor(axes)
    return renderer


def _surface(vtk: Any, picture: Picture) -> tuple[Any, Any]:
    """The height field as a lit block with walls down to its lowest point, coloured by height [m]; and its colours."""
    low, high = float(picture.heights.min()), float(picture.heights.max())
    rows, columns = picture.heights.shape
    dy, dx = picture.pixel_size / picture.unit
    heights = np.pad(picture.heights, 1, constant_values=low)
    x, y = (np.pad(edge, 1, mode="edge") for edge in np.meshgrid(np.arange(columns) * dx, np.arange(rows) * dy))
    z = heights * picture.exaggeration / picture.unit
    grid = vtk.vtkStructuredGrid()
    grid.SetDimensions(columns + 2, rows + 2, 1)
    grid.SetPoints(_points(vtk, np.stack([x, y, z], axis=-1).reshape(-1, 3)))
    grid.GetPointData().SetScalars(_array(heights.ravel()))
    flat = vtk.vtkDataSetSurfaceFilter()
    flat.SetInputData(grid)
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputConnection(flat.GetOutputPort())
    normals.SetFeatureAngle(60.0)
    colours = _colours(vtk, zip(np.linspace(low, max(high, low + 1e-12), len(GOLD)), GOLD, strict=True))
    actor = _actor(vtk, normals, colours)
    actor.GetProperty().SetAmbient(0.25)
    actor.GetProperty().SetDiffuse(0.8)
    actor.GetProperty().SetSpecular(0.1)
    return actor, colours


def _trace(vtk: Any, picture: Picture) -> tuple[Any, Any]:
    """The path as a tube resting on the surface, coloured by force [N]; and its colours."""
    count = len(picture.trace)
    line = vtk.vtkPolyData()
    line.SetPoints(_points(vtk, picture.trace + np.array([0.0, 0.0, TRACE_RADIUS])))
    cells = vtk.vtkCellArray()
    cells.InsertNextCell(count, list(range(count)))
    line.SetLines(cells)
    line.GetPointData().SetScalars(_array(picture.force))
    tube = vtk.vtkTubeFilter()
    tube.SetInputData(line)
    tube.SetRadius(TRACE_RADIUS)
    tube.SetNumberOfSides(12)
    tube.CappingOn()
    low, high = min(float(picture.force.min()), 0.0), max(float(picture.force.max()), 0.0)
    nodes = [(low, ATTRACTION)] * (low < 0) + [(0.0, NEUTRAL)] + [(high, REPULSION)] * (high > 0)
    colours = _colours(vtk, nodes)
    return _actor(vtk, tube, colours), colours


def _tip(vtk: Any, tip: Floats, opacity: float) -> Any:
    """Sphere that goes over into a cone: the profile of one side, turned around the z axis."""
    x, y, z, radius, half_angle = tip
    angle = np.linspace(0.0, np.pi / 2 - half_angle, 24)
    r, h = radius * np.sin(angle), radius * (1.0 - np.cos(angle))
    top = max(TIP_HEIGHT, 2 * h[-1])
    r, h = np.append(r, r[-1] + (top - h[-1]) * np.tan(half_angle)), np.append(h, top)
    profile = vtk.vtkPolyData()
    profile.SetPoints(_points(vtk, np.stack([r, np.zeros_like(r), h], axis=1)))
    cells = vtk.vtkCellArray()
    cells.InsertNextCell(len(r), list(range(len(r))))
    profile.SetLines(cells)
    turned = vtk.vtkRotationalExtrusionFilter()
    turned.SetInputData(profile)
    turned.SetResolution(60)
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputConnection(turned.GetOutputPort())
    actor = _actor(vtk, normals, None)
    actor.SetPosition(x, y, z)
    actor.GetProperty().SetColor(0.35, 0.42, 0.50)
    actor.GetProperty().SetOpacity(opacity)
    return actor


def _ring(vtk: Any, tip: Floats) -> Any:
    """Around the place of a touch at a point, whose trace stands within the tip."""
    disc = vtk.vtkDiskSource()
    disc.SetInnerRadius(RING[0])
    disc.SetOuterRadius(RING[1])
    disc.SetCircumferentialResolution(60)
    actor = _actor(vtk, disc, None)
    actor.SetPosition(tip[0], tip[1], tip[2] + TRACE_RADIUS)
    actor.GetProperty().SetColor(*REPULSION)
    actor.GetProperty().LightingOff()
    return actor


def _axes(vtk: Any, picture: Picture, bounds: tuple[float, ...], letters: int) -> Any:
    """Axes of x and y at the outer edges; z is read from its colours."""
    axes = vtk.vtkCubeAxesActor()
    axes.SetBounds(bounds)
    axes.SetFlyModeToOuterEdges()
    sizes = (bounds[1] * picture.unit, bounds[3] * picture.unit)
    for name, size in zip("XY", sizes, strict=True):
        unit, factor = engineering("m", size)
        getattr(axes, f"Set{name}AxisRange")(0.0, size * factor)
        getattr(axes, f"Set{name}Title")(f"{name.lower()} ({unit})")
    axes.ZAxisVisibilityOff()
    axes.ZAxisLabelVisibilityOff()
    axes.SetZTitle(" ")  # an empty one would be replaced by a default
    axes.SetUse2DMode(True)  # its 3-D text has no micro sign
    for axis in range(2):
        for properties in (axes.GetTitleTextProperty(axis), axes.GetLabelTextProperty(axis)):
            _plain(properties, letters)
    for name in "XY":
        getattr(axes, f"Get{name}AxesLinesProperty")().SetColor(*INK)
        getattr(axes, f"Set{name}LabelFormat")("{:.3g}")
        getattr(axes, f"{name}AxisMinorTickVisibilityOff")()
    return axes


def _look(renderer: Any, bounds: tuple[float, ...]) -> None:
    """From the front and above, so that x runs to the right and y away; leaves room for the scales."""
    middle = [(bounds[2 * axis] + bounds[2 * axis + 1]) / 2 for axis in range(3)]
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(*middle)
    camera.SetPosition(middle[0] - 0.5, middle[1] - 1.4, middle[2] + 1.0)
    camera.SetViewUp(0.0, 0.0, 1.0)
    renderer.ResetCamera()
    camera.Zoom(1.12)
    camera.SetWindowCenter(0.05, -0.18)


def _scale(vtk: Any, colours: Any, title: str, factor: float, left: float) -> Any:
    """A bar of colours at the edge of the picture, its labels in the unit of its title."""
    scaled = vtk.vtkColorTransferFunction()
    node = [0.0] * 6
    for number in range(colours.GetSize()):
        colours.GetNodeValue(number, node)
        scaled.AddRGBPoint(node[0] * factor, *node[1:4])
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(scaled)
    bar.SetTitle(title)
    bar.SetLabelFormat("{:.3g}")
    bar.SetMaximumNumberOfColors(256)
    bar.SetVerticalTitleSeparation(12)
    bar.SetNumberOfLabels(5)
    bar.UnconstrainedFontSizeOn()
    bar.SetBarRatio(0.3)
    bar.SetPosition(left, 0.3)
    bar.SetWidth(0.08)
    bar.SetHeight(0.45)
    return bar


def _text(vtk: Any, text: str, place: tuple[float, float], letters: int) -> Any:
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedDisplay()
    actor.SetPosition(*place)
    _plain(actor.GetTextProperty(), letters)
    return actor


def _plain(properties: Any, size: int) -> None:
    properties.SetColor(*INK)
    properties.SetFontSize(size)
    properties.ItalicOff()
    properties.BoldOff()
    properties.ShadowOff()


def _actor(vtk: Any, source: Any, colours: Any) -> Any:
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    if colours is None:
        mapper.ScalarVisibilityOff()
    else:
        mapper.SetLookupTable(colours)
        mapper.InterpolateScalarsBeforeMappingOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    return actor


def _colours(vtk: Any, nodes: Any) -> Any:
    colours = vtk.vtkColorTransferFunction()
    for value, colour in nodes:
        colours.AddRGBPoint(float(value), *colour)
    return colours


def _points(vtk: Any, positions: Floats) -> Any:
    points = vtk.vtkPoints()
    points.SetData(_array(np.ascontiguousarray(positions)))
    return points


def _array(values: Floats) -> Any:
    return require("vtkmodules.util.numpy_support", "view").numpy_to_vtk(np.ascontiguousarray(values), deep=True)
