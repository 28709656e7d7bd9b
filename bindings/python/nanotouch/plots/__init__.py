# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a touch, drawn with matplotlib's object interface: no global state, no display needed.

Every function returns the ``Figure`` and, with ``save=``, also writes it (whole or not at all). Of long records the
extremes of each stretch are drawn, so that a snap-in of one sample stays visible."""

from .._io.drawing import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, new_figure, saved
from ..units import PREFIXES, engineering
from .along_line import line
from .events import Adhesion, adhesion, phases
from .impedance import z_width
from .over_gap import force_curves, force_gap
from .over_time import time
from .panels import LONG, STATE_COLOURS, STRETCHES, envelope

__all__ = [
    "BLUE", "GREEN", "LONG", "ORANGE", "PREFIXES", "PURPLE", "SKY", "STATE_COLOURS", "STRETCHES", "VERMILION",
    "Adhesion", "adhesion", "engineering", "envelope", "force_curves", "force_gap", "line", "new_figure", "phases",
    "saved", "time", "z_width",
]  # fmt: skip
