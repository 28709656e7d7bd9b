# SPDX-License-Identifier: BSD-3-Clause
"""The 3-D view of a touch: surface, tip and trace, as a picture or in a window.

VTK runs in a process of its own: where libEGL and OSMesa are missing its wheel dies of a segmentation fault, which
must not take a measurement along. `picture` prepares what is seen, `worker` draws it."""

from __future__ import annotations

import importlib.util
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from nanotouch.errors import Error, missing
from nanotouch.touch.record import Recording, replacing

from nanotouch_app.view.picture import Picture

ADVICE = "apt-get install libegl1 libgl1-mesa-dri"
PROBE_TIME, RENDER_TIME = 60.0, 300.0  # [s]; a cold start on a loaded machine takes some seconds


def probe() -> tuple[bool, str]:
    """Whether VTK can render here, tried out; and with what, or why not."""
    try:
        return True, _work(["probe"], PROBE_TIME).strip()
    except Error as error:
        return False, str(error)


def has_display() -> bool:
    """Whether there is a display to open a window on."""
    if sys.platform in ("win32", "darwin"):
        return True
    return any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))


def render_png(
    topography: Any,
    recording: Recording | None,
    path: str | os.PathLike[str],
    size: tuple[int, int] = (1200, 900),
    tip_radius: float | None = None,
) -> None:
    """Render surface, tip and trace to a PNG, without a display; the file is written whole or not at all.

    `size` in pixels; `tip_radius` [m] by default as in the recording's scene.
    """
    picture = Picture.of(topography, recording, tip_radius)
    with replacing(path) as part:
        _draw(picture, ["png", str(part), *map(str, size)], RENDER_TIME)


def open_window(
    topography: Any,
    recording: Recording | None,
    tip_radius: float | None = None,
    size: tuple[int, int] = (1200, 900),
) -> None:
    """Open a window in which the view can be turned; returns when it is closed."""
    if not has_display():
        raise Error("no display: neither DISPLAY nor WAYLAND_DISPLAY is set; the view can be rendered to a PNG instead")
    _draw(Picture.of(topography, recording, tip_radius), ["window", *map(str, size)], None)


def _draw(picture: Picture, arguments: Sequence[str], time: float | None) -> None:
    with tempfile.TemporaryDirectory(prefix="nanotouch-view-") as folder:
        file = Path(folder) / "picture.npz"
        picture.save(file)
        _work([*arguments, str(file)], time)


def _work(arguments: Sequence[str], time: float | None) -> str:
    """Run the worker; what it prints, or an :class:`Error` that says what to install."""
    if importlib.util.find_spec("vtkmodules") is None:
        raise missing("vtk", "view")
    command = [sys.executable, "-P", "-m", "nanotouch_app.view.worker", *arguments]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    try:
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=time, check=False)
    except subprocess.TimeoutExpired:
        raise Error(f"VTK did not answer within {time:g} s") from None
    if done.returncode < 0:
        name = signal.Signals(-done.returncode).name
        raise Error(f"VTK died of {name} while rendering: it needs OpenGL without a display: {ADVICE}")
    if done.returncode:
        said = done.stderr.strip().splitlines() or ["it said nothing"]
        raise Error(f"VTK could not render: {said[-1]} (if OpenGL is missing: {ADVICE})")
    return done.stdout
