# SPDX-License-Identifier: BSD-3-Clause
"""Measured force curves: read them in SI with every segment, and see what they show before anything is fitted.

>>> import nanotouch as nt
>>> curve = nt.curves.read("curve.jpk-force")[0]                            # doctest: +SKIP
>>> report = nt.curves.analyse(curve)                                       # doctest: +SKIP
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .._io.later import at_first_use
from .curve import ForceCurve, Segment
from .reading import Stream, read, stream
from .sader import hydrodynamic_function, sader

if TYPE_CHECKING:
    from .adhesion import Adhesion, adhesion_of
    from .analysis import analyse, force_gap, sensitivity
    from .baseline import Baseline, Bend, Wave
    from .batch import CurveBatch, synthesize_batch
    from .calibration import Calibration, CalibrationTable, parse_sensitivity
    from .chain import Chain, chains
    from .events import Rupture
    from .report import CurveReport
    from .snap import Lever, Recalibrated, recalibrate, write_table
    from .synthesis import synthesize
    from .thermal import ThermalTune, thermal_tune
    from .thermal_file import ThermalSpectrum, thermal_spectrum
    from .writing import write

__getattr__, __dir__ = at_first_use(
    __name__,
    {
        "adhesion": "Adhesion adhesion_of",
        "analysis": "analyse force_gap sensitivity",
        "baseline": "Baseline Bend Wave",
        "batch": "CurveBatch synthesize_batch",
        "calibration": "Calibration CalibrationTable parse_sensitivity",
        "chain": "Chain chains",
        "events": "Rupture",
        "report": "CurveReport",
        "snap": "Lever Recalibrated recalibrate write_table",
        "synthesis": "synthesize",
        "thermal": "ThermalTune thermal_tune",
        "thermal_file": "ThermalSpectrum thermal_spectrum",
        "writing": "write",
    },
)

__all__ = [
    "Adhesion",
    "Baseline",
    "Bend",
    "Calibration",
    "CalibrationTable",
    "Chain",
    "CurveBatch",
    "CurveReport",
    "ForceCurve",
    "Lever",
    "Recalibrated",
    "Rupture",
    "Segment",
    "Stream",
    "ThermalSpectrum",
    "ThermalTune",
    "Wave",
    "adhesion_of",
    "analyse",
    "chains",
    "force_gap",
    "hydrodynamic_function",
    "parse_sensitivity",
    "read",
    "recalibrate",
    "sader",
    "sensitivity",
    "stream",
    "synthesize",
    "synthesize_batch",
    "thermal_spectrum",
    "thermal_tune",
    "write",
    "write_table",
]
