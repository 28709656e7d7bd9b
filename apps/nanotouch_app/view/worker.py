# SPDX-License-Identifier: BSD-3-Clause
"""The process that runs VTK: ``python -m nanotouch_app.view.worker probe | png OUT W H FILE | window W H FILE``."""

from __future__ import annotations

import sys
from typing import Any

from nanotouch.errors import Error, require

from nanotouch_app.view.picture import Picture
from nanotouch_app.view.stage import build

HELP = "drag: turn   shift + drag: move   wheel: closer   r: reset   q: close"


def main(arguments: list[str]) -> int:
    """Do what the arguments say; one line on stderr and status 1 if it cannot be done."""
    try:
        match arguments:
            case ["probe"]:
                print(_probe())
            case ["png", out, width, height, file]:
                _png(build(Picture.load(file), int(height)), out, (int(width), int(height)))
            case ["window", width, height, file]:
                _window(build(Picture.load(file), int(height), HELP), (int(width), int(height)))
            case _:
                raise Error(f"unknown task: {' '.join(arguments)}")
    except Error as error:
        print(error, file=sys.stderr)
        return 1
    return 0


def _render_window(renderer: Any, size: tuple[int, int], offscreen: bool) -> Any:
    vtk = require("vtk", "view")
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(offscreen)
    window.SetMultiSamples(8)
    window.SetSize(*size)
    window.SetWindowName("nanotouch")
    window.AddRenderer(renderer)
    return window


def _pixels(window: Any) -> Any:
    """The rendered picture as a VTK image; an error if nothing was drawn."""
    vtk = require("vtk", "view")
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    image = grab.GetOutput()
    low, high = image.GetScalarRange()
    if not high > low:
        raise Error("VTK rendered an empty picture")
    return grab


def _probe() -> str:
    vtk = require("vtk", "view")
    source = vtk.vtkSphereSource()
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    renderer = vtk.vtkRenderer()
    renderer.AddActor(actor)
    window = _render_window(renderer, (64, 64), offscreen=True)
    _pixels(window)
    return f"VTK {vtk.vtkVersion.GetVTKVersion()}, {window.GetClassName()}"


def _png(renderer: Any, out: str, size: tuple[int, int]) -> None:
    vtk = require("vtk", "view")
    window = _render_window(renderer, size, offscreen=True)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(out)
    pixels = _pixels(window)  # named: VTK does not keep the producer of a connection alive
    writer.SetInputConnection(pixels.GetOutputPort())
    writer.Write()
    if writer.GetErrorCode():
        raise Error(f"VTK could not write {out}: {vtk.vtkErrorCode.GetStringFromErrorCode(writer.GetErrorCode())}")


def _window(renderer: Any, size: tuple[int, int]) -> None:
    vtk = require("vtk", "view")
    window = _render_window(renderer, size, offscreen=False)
    interactor = vtk.vtkRenderWindowInteractor()
    interactor.SetRenderWindow(window)
    interactor.SetInteractorStyle(vtk.vtkInteractorStyleTrackballCamera())
    interactor.Initialize()
    window.Render()
    interactor.Start()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
