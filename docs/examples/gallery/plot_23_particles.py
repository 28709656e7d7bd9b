# SPDX-License-Identifier: BSD-3-Clause
"""
Find particles
==============

24 quantum dots, each with height, diameter and volume.
"""

import nanotouch as nt

dots = nt.surface.dots()
table = nt.images.grains(dots)
print(table)
figure = nt.images.draw(dots, grains=table)
