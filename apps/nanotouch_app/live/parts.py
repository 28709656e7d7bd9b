# SPDX-License-Identifier: BSD-3-Clause
"""The parts of VTK that the live view draws with. All of VTK takes three times as long to load."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from nanotouch.errors import require

PARTS = {
    "vtkCommonCore": "vtkLogger vtkPoints vtkPoints2D vtkStringArray VTK_OBJECT",
    "vtkCommonDataModel": "vtkCellArray vtkPolyData",
    "vtkFiltersCore": "vtkPolyDataNormals",
    "vtkFiltersSources": "vtkCylinderSource vtkDiskSource vtkSphereSource",
    "vtkIOImage": "vtkPNGWriter",
    "vtkPythonContext2D": "vtkPythonItem",
    "vtkRenderingContext2D": "vtkContextActor vtkPen",
    "vtkRenderingCore": "vtkActor vtkColorTransferFunction vtkLight vtkPolyDataMapper vtkRenderWindow "
                        "vtkRenderWindowInteractor vtkRenderer vtkWindowToImageFilter",
    "vtkInteractionStyle": "vtkInteractorStyleUser",
}  # fmt: skip
# loaded for what they register: a window, its context, its letters
SILENT = ("vtkRenderingOpenGL2", "vtkRenderingContextOpenGL2", "vtkRenderingFreeType", "vtkRenderingUI")


def load() -> Any:
    """The classes, as attributes; :class:`~nanotouch.errors.MissingExtra` without VTK."""
    for module in SILENT:
        require(f"vtkmodules.{module}", "view")
    found = SimpleNamespace(**{
        name: getattr(require(f"vtkmodules.{module}", "view"), name)
        for module, names in PARTS.items() for name in names.split()
    })  # fmt: skip
    found.vtkLogger.SetStderrVerbosity(found.vtkLogger.VERBOSITY_ERROR)  # it warns of the display that a film needs not
    return found
