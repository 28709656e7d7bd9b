# SPDX-License-Identifier: BSD-3-Clause
"""Other readers of images and curves, each where it is installed, brought to one shape for :mod:`corpus`.

Some are GPL (AFMReader, Gwyddion): they are asked here, in a tool of the tests, and are no part of the package.
"""

from __future__ import annotations

import importlib.util
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

LENGTHS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "μm": 1e-6, "nm": 1e-9, "Å": 1e-10, "A": 1e-10, "pm": 1e-12}
_CHANNELS = ("Height", "Height Sensor", "ZSensor", "HeightTracee", "HeightTrace", "height_trace",
             "measuredheight_trace", "height", "image", "HeightRetrace", "Z Height", "Topography")  # fmt: skip


@dataclass(frozen=True)
class Image:
    """One channel as another reader gives it: heights [m] with row 0 at the lower edge, size (Ly, Lx) [m]."""

    name: str
    heights: NDArray[np.float64]
    size: tuple[float, float] | None


@dataclass(frozen=True)
class Curves:
    """All curves of a file: points of each (0: not told), travel [m] and
    force range [N] of the first; None where not told."""

    points: list[int]
    travel: float | None
    force: float | None


def _surfacetopography(file: Path) -> list[Image]:
    from SurfaceTopography.IO import open_topography

    found = []
    with open_topography(str(file)) as reader:
        if reader.format() in ("hgt", "nms", "npy", "asc"):  # take any numbers for an image
            return []
        for number, info in enumerate(reader.channels):
            if info.dim != 2:
                continue
            topography = reader.topography(channel_index=number)
            unit = topography.unit
            lateral, vertical = unit if isinstance(unit, tuple) else (unit, unit)
            if vertical in LENGTHS and lateral in LENGTHS:
                heights = np.ma.filled(np.ma.asarray(topography.heights(), float), np.nan)
                lx, ly = (float(s) * LENGTHS[lateral] for s in topography.physical_sizes)
                found.append(Image(str(info.name), heights.T[::-1] * LENGTHS[vertical], (ly, lx)))
    return found


def _gwy_fields(file: Path) -> list[Image]:
    import gwyfile

    container = gwyfile.load(str(file))
    found = []
    for key, field in container.items():
        match = re.fullmatch(r"/(\d+)/data", key)
        if match and field.si_unit_z is not None and field.si_unit_z.unitstr == "m":
            name = str(container.get(f"{key}/title", match[1]))
            found.append(Image(name, np.asarray(field.data, float)[::-1], (float(field.yreal), float(field.xreal))))
    return found


def _gwyddion(file: Path) -> list[Image]:
    """Through Gwyddion's own converter; it wants a display, as that of xvfb-run."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.gwy"
        command = ["gwyddion", "--disable-gl", f"--convert-to-gwy={out}", str(file)]
        subprocess.run(command, timeout=60, capture_output=True, check=False)
        return _gwy_fields(out)


def _afmreader(file: Path) -> list[Image]:
    from AFMReader.general_loader import LoadFile

    found = []
    for channel in _CHANNELS:
        try:
            values, nm = LoadFile(file, channel).load()
        except Exception:
            continue
        if nm is None or not isinstance(values, np.ndarray):
            continue
        values = values[0] if values.ndim == 3 else values
        size = (values.shape[0] * nm * 1e-9, values.shape[1] * nm * 1e-9)
        found.append(Image(channel, np.asarray(values, float)[::-1] * 1e-9, size))
    return found


def _afmformats(file: Path) -> Curves:
    import afmformats

    loaded = list(afmformats.load_data(file))
    return Curves([len(data) for data in loaded], *(_span(loaded[0], names) for names in (
        ("height (measured)", "height (piezo)"), ("force",))))  # fmt: skip


def _span(data: Any, names: tuple[str, ...]) -> float | None:
    return next((float(np.ptp(data[name])) for name in names if name in data.columns), None)


def _pyfmreader(file: Path) -> Curves:
    """JPK, NanoScope; it cuts points off, so only scales are compared."""
    from pyfmreader import loadfile

    opened = loadfile(str(file))
    meta = opened.filemetadata
    count = int(meta["Entry_tot_nb_curve"])
    curve = opened.getcurve(0)
    sensitivity = meta["defl_sens_nmbyV"] * 1e-9
    curve.preprocess_force_curve(sensitivity, meta["height_channel_key"])
    listed = sorted([*curve.extend_segments, *curve.pause_segments, *curve.retract_segments], key=lambda s: int(s[0]))
    segments = [segment for _, segment in listed]
    z = np.concatenate([np.asarray(s.zheight, float) for s in segments])
    force = np.concatenate([np.asarray(s.vdeflection, float) for s in segments])
    stiffness = meta.get("spring_const_Nbym")
    return Curves([0] * count, float(np.ptp(z)), None if stiffness is None else float(np.ptp(force)) * stiffness)


def _where(module: str, peer: Callable[[Path], Any]) -> dict[str, Callable[[Path], Any]]:
    return {module: peer} if importlib.util.find_spec(module) else {}


IMAGES: dict[str, Callable[[Path], Any]] = {
    **_where("SurfaceTopography", _surfacetopography),
    **_where("gwyfile", _gwy_fields),
    **_where("AFMReader", _afmreader),
    **({"Gwyddion": _gwyddion} if shutil.which("gwyddion") else {}),
}
CURVES: dict[str, Callable[[Path], Any]] = {
    **_where("afmformats", _afmformats),
    **_where("pyfmreader", _pyfmreader),
}


def installed() -> list[str]:
    """Names of the readers that are asked."""
    return [*IMAGES, *CURVES]
