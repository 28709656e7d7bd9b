# SPDX-License-Identifier: BSD-3-Clause
"""The optional packages: which extra has which, and how to install what is missing.

What is told works today, whether or not an index has nanotouch itself: the packages are named, not an extra of it.
"""

from __future__ import annotations

from collections.abc import Iterable

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
    "view": {"vtk": "vtkmodules"},
    "browser": {"aiohttp": "aiohttp"},
    "app": {"tqdm": "tqdm", "matplotlib": "matplotlib", "argcomplete": "argcomplete"},
    "maps": {
        "dask": "dask",
        "distributed": "distributed",
        "xarray": "xarray",
        "h5py": "h5py",
        "h5netcdf": "h5netcdf",
    },
    "notebook": {"pandas": "pandas", "xarray": "xarray", "matplotlib": "matplotlib", "anywidget": "anywidget"},
    "hands": {"pysdl2": "sdl2", "pysdl2-dll": "sdl2dll", "hidapi": "hid"},
    "forcedimension": {"forcedimension-core": "forcedimension_core"},
    "geomagic": {"pyopenhaptics": "pyOpenHaptics"},
    "wheel": {"evdev": "evdev"},
}
ADDS = {
    "images": "AFM images",
    "curves": "files of force curves",
    "record": "recordings: nanotouch touch",
    "view": "the 3-D view: nanotouch live",
    "browser": "nanotouch live --browser",
    "app": "pictures and progress bars of the command",
    "maps": "force maps, also on a cluster",
    "notebook": "tables and pictures in notebooks",
    "hands": "gamepad and SpaceMouse",
    "forcedimension": "haptic devices of Force Dimension, with the maker's SDK",
    "geomagic": "3D Systems Touch, with the maker's OpenHaptics",
    "wheel": "wheels with force feedback",
}
"""what each extra adds"""


def advice(extra: str, packages: Iterable[str] | None = None) -> str:
    """The command that installs the packages of an extra, or some of them."""
    return f"pip install {' '.join(EXTRAS[extra] if packages is None else packages)}"
