# SPDX-License-Identifier: BSD-3-Clause
"""libnanotouch: touch, model and teach the nano world. ``import nanotouch as nt`` brings numpy only."""

from __future__ import annotations

import importlib
from typing import Any

from nanotouch._core import version as __version__
from nanotouch.errors import Error

#: where each class of the package lives; modules load when they are first used
_HOMES = {
    "Contact": "contact",
    "Corrugation": "friction",
    "ForceCurve": "curves",
    "Faults": "touch.faults",
    "Friction": "friction",
    "FitResult": "fit",
    "Topography": "images",
    "Input": "touch.operator",
    "Recording": "touch.record",
    "Demand": "scene",
    "Drive": "scan.tapping",
    "Interaction": "scene.interaction",
    "Particle": "manipulation",
    "ParticleContact": "manipulation",
    "Particles": "manipulation",
    "Plan": "scene.plan",
    "Rheology": "rheology",
    "Rig": "scene",
    "Scan": "scan.scanner",
    "Scanner": "scan.scanner",
    "Scene": "scene",
    "Settings": "scene",
    "Session": "touch.session",
    "Sessions": "touch.sessions",
    "SlowFlow": "scan.flow",
    "Steady": "scan.steady",
    "Supervisor": "touch.supervisor",
    "Surface": "scene.surface",
    "SurfaceFile": "scene.surface_file",
    "Tapping": "scan.tapping",
}
#: the public modules by their rooms; all are names of the package: ``nt.margins`` is ``nanotouch.touch.margins``
_ROOMS = {
    "": "batch contact curves errors fit forces friction images lateral "
    "manipulation maps plasticity plots reference rheology scan scene testing touch ufuncs units",
    "contact.": "geometry",
    "scan.": "flow scanner steady tapping",
    "scene.": "interaction materials plan presets surface surface_file view",
    "touch.": "c_header commands faults frames hal mailbox margins operator raster record rig_file session sessions",
}
_MODULES = {name: room + name for room, names in _ROOMS.items() for name in names.split()}

__all__ = ["Error", "__version__", *_HOMES, *_MODULES]


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return importlib.import_module(f"{__name__}.{_MODULES[name]}")
    if name in _HOMES:
        return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
