# SPDX-License-Identifier: BSD-3-Clause
"""Arrays of numpy for VTK and back, loaded when the first one is needed."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np


def _support() -> Any:
    return importlib.import_module("vtkmodules.util.numpy_support")


def to_vtk(values: Any) -> Any:
    """A VTK array of numbers, which keeps its own copy."""
    return _support().numpy_to_vtk(np.ascontiguousarray(values), deep=True)


def points(vtk: Any, rows: Any) -> Any:
    """VTK's points from rows (x, y, z)."""
    made = vtk.vtkPoints()
    made.SetData(to_vtk(np.asarray(rows, dtype=np.float32).reshape(-1, 3)))
    return made


def quads(vtk: Any, rows: int, columns: int) -> Any:
    """The cells of a grid of so many rows and columns of points, row by row."""
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    four = np.stack([np.full_like(corner, 4), corner, corner + 1, corner + columns + 1, corner + columns], axis=1)
    cells = vtk.vtkCellArray()
    cells.ImportLegacyFormat(_support().numpy_to_vtkIdTypeArray(four.ravel(), deep=True))
    return cells


def actor_of(vtk: Any, renderer: Any, data: Any) -> Any:
    """What draws a mesh in a renderer."""
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    made = vtk.vtkActor()
    made.SetMapper(mapper)
    renderer.AddActor(made)
    return made


def pixels(vtk: Any, window: Any) -> Any:
    """What a window shows, rows from the top, as bytes (height, width, 3)."""
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    image = grab.GetOutput()
    width, height, _ = image.GetDimensions()
    return _support().vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[::-1, :, :3]
