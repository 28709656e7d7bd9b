# SPDX-License-Identifier: BSD-3-Clause
"""Scanning: a driven lever that taps, and rasters over a surface with a z loop (docs/scan.md)."""

from __future__ import annotations

from .flow import FlowState, FlowValue, SlowFlow
from .forecast import Forecast, forecast
from .overshoot import peak_bounds, steepest
from .scanner import UNDONE, Channels, Image, LoopMargins, Scan, Scanner
from .steady import TIERS, AmplitudeCurve, Steady, SteadyMotion
from .tapping import Drive, Settled, Tapping, TappingState, TappingValue

__all__ = [
    "TIERS",
    "UNDONE",
    "AmplitudeCurve",
    "Channels",
    "Drive",
    "FlowState",
    "FlowValue",
    "Forecast",
    "Image",
    "LoopMargins",
    "Scan",
    "Scanner",
    "Settled",
    "SlowFlow",
    "Steady",
    "SteadyMotion",
    "Tapping",
    "TappingState",
    "TappingValue",
    "forecast",
    "peak_bounds",
    "steepest",
]
