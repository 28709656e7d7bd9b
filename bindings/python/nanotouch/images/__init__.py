# SPDX-License-Identifier: BSD-3-Clause
"""AFM images: read them in SI the right way up, level them without harming their steps, repair, measure.

>>> import nanotouch as nt
>>> topography, report = nt.images.prepare(nt.images.read("scan.ibw"))      # doctest: +SKIP
"""

from .apex import ApexRadius, apex_radius
from .blind import TipEstimate, estimate_tip
from .channel import Channel, Plane
from .despeckling import DespeckleReport, despeckle
from .fields import planes, write_planes
from .filling import fill
from .filters import gaussian, median
from .level_report import Candidate, LevelReport, LevelStep
from .levelling import level, prepare
from .masking import mask_above, mask_grains, mask_image
from .moving import moved
from .parameters import Parameter, parameters
from .particles import GrainTable, grains
from .pictures import draw
from .pyramid import MipLevel, mip_levels
from .reading import channels, read
from .scars import ScarReport, repair_scars
from .section import Section, histogram, section
from .spectrum import Spectrum, spectrum
from .statistics import Roughness, roughness
from .terraces import Terrace
from .tips import Paraboloid, RoundedCone, dilate, erode
from .topography import READY, Topography
from .values import ValueMap, read_values
from .writing import write

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
