# SPDX-License-Identifier: BSD-3-Clause
"""libnanotouch: touch, model and teach the nano world. ``import nanotouch as nt`` brings numpy only."""

from __future__ import annotations

import importlib
from types import ModuleType

_CHAPTERS = {"contact", "curves", "errors", "fit", "forces", "images", "plots", "presets", "record", "scene", "session", "surface"}


def __getattr__(name: str) -> ModuleType:
    if name in _CHAPTERS:
        return importlib.import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
