# SPDX-License-Identifier: BSD-3-Clause
"""AFM images: read them in SI the right way up, level them without harming their steps, remove speckles.

>>> import nanotouch as nt
>>> topography, report = nt.images.prepare(nt.images.read("scan.ibw"))      # doctest: +SKIP
"""

from .channel import Channel, Plane
from .levelling import DespeckleReport, LevelReport, despeckle, level, prepare
from .reading import channels, read
from .scars import ScarReport, repair_scars
from .statistics import Roughness, roughness
from .tips import Paraboloid, RoundedCone, dilate, erode
from .topography import Topography
from .writing import write

__all__ = [
    "Channel",
    "DespeckleReport",
    "LevelReport",
    "Paraboloid",
    "Plane",
    "Roughness",
    "RoundedCone",
    "ScarReport",
    "Topography",
    "channels",
    "despeckle",
    "dilate",
    "erode",
    "level",
    "prepare",
    "read",
    "repair_scars",
    "roughness",
    "write",
]
