# SPDX-License-Identifier: BSD-3-Clause
"""
Levelling that keeps a grating
==============================

Row alignment by medians erases lines along the fast axis. ``auto`` keeps them.
"""

import warnings

import nanotouch as nt
import numpy as np

grating = nt.surface.grating(pixels=256)
y, x = np.indices((256, 256)) / 255.0
rows = np.random.default_rng(1).normal(0.0, 1e-9, (256, 1))
raw = nt.Topography(grating.heights.T + 50e-9 * x + rows, grating.pixel_size)
auto, _ = nt.images.level(raw)
with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # it warns of what it does
    medians, _ = nt.images.level(raw, "plane+medians")
figure = nt.images.draw({"as read": raw, "auto": auto, "plane+medians": medians})
