# SPDX-License-Identifier: BSD-3-Clause
"""
Feel a line over a grating
==========================

The hand follows the surface; the height that it felt lies on the true profile.
"""

import nanotouch as nt

surface = nt.Surface(nt.surface.dots(pixels=256), tip_radius=20e-9)
session = nt.Session(nt.Scene(), surface=surface, mode="topography")
recording = session.run(6.0)
figure = nt.plots.line(recording, surface.topography)
