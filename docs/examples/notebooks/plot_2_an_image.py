# SPDX-License-Identifier: BSD-3-Clause
"""
An AFM image
============

The second tutorial as a notebook: level an image, count its particles, touch one of them.
"""

# %%
# ``nt.images.read("scan.gwy")`` reads yours. This one is made: quantum dots on a flat, with a tilt as images have it.
import dataclasses

import nanotouch as nt
import numpy as np

true = nt.surface.dots(pixels=128)
rows, columns = np.indices(true.shape)
image = dataclasses.replace(true, heights=true.heights + 0.2e-9 * columns + 0.1e-9 * rows)

# %%
# Levelling says what it took away, and why.
levelled, report = nt.images.level(image)
print(report)
figure = nt.images.draw({"as imaged": image, "levelled": levelled})

# %%
# Each particle is a row: place, size, height.
particles = nt.images.grains(levelled)
print(len(particles), "particles")

# %%
# A surface is an image that a tip can touch. The path holds points in metres.
surface = nt.Surface(levelled, tip_radius=20e-9)
height, width = (pixels * size for pixels, size in zip(levelled.shape, levelled.pixel_size, strict=True))
recording = nt.Session(surface=surface, path=[(width / 2, height / 2)], seed=1).run()
print(f"largest force on the tip {recording.tip_force.max() * 1e9:.0f} nN")
