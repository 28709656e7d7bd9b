# SPDX-License-Identifier: BSD-3-Clause
"""AFM images: read them in SI the right way up, level them without harming their steps, repair, measure.

>>> import nanotouch as nt
>>> topography, report = nt.images.prepare(nt.images.read("scan.ibw"))      # doctest: +SKIP
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .._io.later import at_first_use
from .channel import Channel, Plane
from .parameters import Parameter, parameters
from .reading import channels, read
from .section import Section, histogram, section
from .spectrum import Spectrum, spectrum
from .topography import READY, Topography

if TYPE_CHECKING:
    from .apex import ApexRadius, apex_radius
    from .blind import TipEstimate, estimate_tip
    from .despeckling import DespeckleReport, despeckle
    from .fields import planes, write_planes
    from .filling import fill
    from .filters import gaussian, median
    from .level_report import Candidate, LevelReport, LevelStep
    from .levelling import level, prepare
    from .masking import mask_above, mask_grains, mask_image
    from .moving import moved
    from .particles import GrainTable, grains
    from .pictures import draw
    from .pyramid import MipLevel, mip_levels
    from .scars import ScarReport, repair_scars
    from .statistics import Roughness, roughness
    from .terraces import Terrace
    from .tips import Paraboloid, RoundedCone, dilate, erode
    from .values import ValueMap, read_values
    from .writing import write

__getattr__, __dir__ = at_first_use(
    __name__,
    {
        "apex": "ApexRadius apex_radius",
        "blind": "TipEstimate estimate_tip",
        "despeckling": "DespeckleReport despeckle",
        "fields": "planes write_planes",
        "filling": "fill",
        "filters": "gaussian median",
        "level_report": "Candidate LevelReport LevelStep",
        "levelling": "level prepare",
        "masking": "mask_above mask_grains mask_image",
        "moving": "moved",
        "particles": "GrainTable grains",
        "pictures": "draw",
        "pyramid": "MipLevel mip_levels",
        "scars": "ScarReport repair_scars",
        "statistics": "Roughness roughness",
        "terraces": "Terrace",
        "tips": "Paraboloid RoundedCone dilate erode",
        "values": "ValueMap read_values",
        "writing": "write",
    },
)

__all__ = [
    "READY",
    "ApexRadius",
    "Candidate",
    "Channel",
    "DespeckleReport",
    "GrainTable",
    "LevelReport",
    "LevelStep",
    "MipLevel",
    "Paraboloid",
    "Parameter",
    "Plane",
    "Roughness",
    "RoundedCone",
    "ScarReport",
    "Section",
    "Spectrum",
    "Terrace",
    "TipEstimate",
    "Topography",
    "ValueMap",
    "apex_radius",
    "channels",
    "despeckle",
    "dilate",
    "draw",
    "erode",
    "estimate_tip",
    "fill",
    "gaussian",
    "grains",
    "histogram",
    "level",
    "mask_above",
    "mask_grains",
    "mask_image",
    "median",
    "mip_levels",
    "moved",
    "parameters",
    "planes",
    "prepare",
    "read",
    "read_values",
    "repair_scars",
    "roughness",
    "section",
    "spectrum",
    "write",
    "write_planes",
]
