# SPDX-License-Identifier: BSD-3-Clause
"""
What the tip does to an image, and back
=======================================

A tip of 30 nm broadens the dots. Erosion takes back what can be known.
"""

import nanotouch as nt

true = nt.surface.dots(pixels=128)
image = nt.images.dilate(true, nt.images.Paraboloid(30e-9))
back, certain = nt.images.erode(image, nt.images.Paraboloid(30e-9))
print(f"{100 * certain.mean():.0f} % of the surface is certain")
figure = nt.images.draw({"true": true, "imaged": image, "eroded": back})
