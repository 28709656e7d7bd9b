# SPDX-License-Identifier: BSD-3-Clause
"""Maps of force curves: every curve of a force volume or QI map fitted, in threads or on a cluster.

>>> import nanotouch as nt
>>> data = nt.maps.fit("map.jpk-force-map", model="hertz", radius=20e-9, resume="map.blocks")    # doctest: +SKIP
>>> nt.maps.write("map.nc", data); nt.maps.draw(data, save="map.png")                            # doctest: +SKIP

>>> scene = nt.maps.to_scene(data)                                                   # doctest: +SKIP
>>> nt.Session(scene, surface=nt.maps.to_surface(data, scene, fill_by="median")).run()   # doctest: +SKIP

What is stored, how a killed run goes on, how a cluster is used: docs/maps.md.
"""

from .dataset import determined, flag_counts, read, write
from .fields import planes
from .picture import draw
from .run import fit
from .synthesis import synthesize
from .touched import to_scene, to_surface
from .volume import ArrayVolume, CurveVolume

__all__ = [
    "ArrayVolume", "CurveVolume", "determined", "draw", "fit", "flag_counts", "planes", "read", "synthesize",
    "to_scene", "to_surface", "write",
]  # fmt: skip
