# SPDX-License-Identifier: BSD-3-Clause
"""Samples that yield under a tip: indentation, the dent that stays, scratches and wear (docs/indentation.md)."""

from __future__ import annotations

from .dents import Dent, dents_of
from .indentation import FirstLoading, Indentation, IndentationPath, IndentationState
from .scratch import Groove, Scratching, worn_flat, worn_volume
from .specimen import Displacement, Event, Imprint, Specimen

__all__ = [
    "Dent",
    "Displacement",
    "Event",
    "FirstLoading",
    "Groove",
    "Imprint",
    "Indentation",
    "IndentationPath",
    "IndentationState",
    "Scratching",
    "Specimen",
    "dents_of",
    "worn_flat",
    "worn_volume",
]
