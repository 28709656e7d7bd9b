# SPDX-License-Identifier: BSD-3-Clause
"""libnanotouch: touch, model and teach the nano world. ``import nanotouch as nt`` brings numpy only."""

from __future__ import annotations

import importlib
from typing import Any

from nanotouch._core import version as __version__
from nanotouch.errors import Error

#: where each name of the package lives; modules load when they are first used
_HOMES = {
    "Contact": "contact",
    "ForceCurve": "curves",
    "Faults": "faults",
    "FitResult": "fit",
    "Topography": "images",
    "Input": "operator",
    "Recording": "record",
    "Demand": "scene",
    "Interaction": "interaction",
    "Plan": "plan",
    "Rig": "scene",
    "Scene": "scene",
    "Settings": "scene",
    "Session": "session",
    "Supervisor": "supervisor",
    "Surface": "surface",
    "SurfaceFile": "surface_file",
}
_MODULES = (
    "batch", "commands", "contact", "curves", "errors", "faults", "fit", "forces", "frames", "geometry", "hal",
    "images", "interaction", "maps", "margins", "materials", "operator", "plan", "plots", "presets", "record",
    "reference", "rig_file", "scene", "session", "surface", "surface_file", "units", "view",
)  # fmt: skip

__all__ = ["Error", "__version__", *_HOMES, *_MODULES]


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return importlib.import_module(f"{__name__}.{name}")
    if name in _HOMES:
        return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
