# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch doctor``: what is installed, what works here, and what to install for the rest."""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import os
import platform
import sys
from importlib import metadata
from typing import Any

import nanotouch
from nanotouch import hal
from nanotouch.errors import Error

from nanotouch_app import view
from nanotouch_app.live import display

# extra -> {distribution: module}; a test compares it with pyproject.toml
EXTRAS = {
    "images": {
        "opencv-python-headless": "cv2",
        "scipy": "scipy",
        "SurfaceTopography": "SurfaceTopography",
        "h5py": "h5py",
        "gwyfile": "gwyfile",
    },
    "curves": {"afmformats": "afmformats"},
    "record": {"mcap": "mcap", "h5py": "h5py"},
    "view": {"vtk": "vtkmodules", "trame": "trame"},
    "app": {"tqdm": "tqdm", "matplotlib": "matplotlib"},
    "maps": {
        "dask": "dask",
        "distributed": "distributed",
        "xarray": "xarray",
        "h5py": "h5py",
        "h5netcdf": "h5netcdf",
    },
}
OK, MISSING = "ok", "--"


def add_parser(subparsers: Any) -> None:
    """Add ``doctor`` to the command's sub-commands."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "doctor",
        help="what is installed and works here, and what to install for the rest",
        description="Say what is installed and works here, and what to install for the rest.",
    )
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Print the findings; status 0 whatever they are."""
    print("\n".join(findings()))
    return 0


def findings() -> list[str]:
    """One line per finding; what is missing says what to install."""
    lines = [
        f"nanotouch {nanotouch.__version__}, Python {platform.python_version()}, numpy {metadata.version('numpy')}, "
        f"{platform.system()} {platform.machine()}",
        f"  {sys.prefix}",
    ]
    sections = {
        "extras": [_extra(name, packages) for name, packages in EXTRAS.items()],
        "compiled parts": [("core", OK, f"nanotouch._core {nanotouch.__version__}"), _fit()],
        "backends": [("simulated", OK, "always there"), _gpio()],
        "view": [_display(), _vtk(), _live()],
    }
    for title, rows in sections.items():
        lines += ["", title]
        lines += [f"  {mark:3}{name:11}{text}" for name, mark, text in rows]
    return lines


def _extra(name: str, packages: dict[str, str]) -> tuple[str, str, str]:
    missing = [package for package, module in packages.items() if not _found(module)]
    if missing:
        return name, MISSING, f"{', '.join(missing)} missing: pip install 'nanotouch[{name}]'"
    return name, OK, ", ".join(f"{package} {_version(package)}" for package in packages)


def _found(module: str) -> bool:
    try:
        return importlib.util.find_spec(module) is not None
    except (ImportError, ValueError):  # ValueError: blocked by None in sys.modules
        return False


def _version(package: str) -> str:
    """The installed version; the same module may come from a distribution of another name."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "(installed under another name)"


def _fit() -> tuple[str, str, str]:
    try:
        importlib.import_module("nanotouch._fit")
    except ImportError as error:
        if _found("nanotouch._fit"):
            return "fit", MISSING, f"does not load: {error}"
        return "fit", MISSING, "built without Ceres: apt-get install libceres-dev, then install nanotouch again"
    return "fit", OK, "nanotouch._fit, on Ceres"


def _gpio() -> tuple[str, str, str]:
    try:
        found = hal.gpio_lines()
    except Error as error:
        return "gpio", MISSING, str(error)
    if not found:
        return "gpio", MISSING, "no chip that may be opened (/dev/gpiochip*): nothing is connected, or no permission"
    named = [f"{line.name} ({line.chip}:{line.offset})" for line in found if line.name]
    chips = len({line.chip for line in found})
    return "gpio", OK, f"{chips} chips, {len(found)} lines; named: {', '.join(named) or 'none'}"


def _display() -> tuple[str, str, str]:
    if not view.has_display():
        return "display", MISSING, "no DISPLAY or WAYLAND_DISPLAY: the view is rendered to a picture, no window opens"
    shown = [f"{name}={os.environ[name]}" for name in ("DISPLAY", "WAYLAND_DISPLAY") if os.environ.get(name)]
    return "display", OK, ", ".join(shown) or platform.system()


def _live() -> tuple[str, str, str]:
    """Whether a window can be opened for a hand, tried out."""
    try:
        display.check()
    except Error as error:
        return "live", MISSING, str(error)
    return "live", OK, "a window can be opened: nanotouch live"


def _vtk() -> tuple[str, str, str]:
    works, reason = view.probe()
    return "VTK", OK if works else MISSING, reason
