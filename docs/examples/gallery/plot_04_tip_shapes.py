# SPDX-License-Identifier: BSD-3-Clause
"""
Cone, punch, sphere, pyramid
============================

The same depth, four shapes: the exponent of force over depth is the shape.
"""

import matplotlib.pyplot as plt
import numpy as np
from nanotouch import geometry

shapes = {
    "sphere": geometry.Shape("sphere", radius=1e-6),
    "cone": geometry.Shape("cone", half_angle=0.6),
    "pyramid": geometry.Shape("cone", half_angle=0.6, sides=4),
    "punch": geometry.Shape("punch", radius=0.2e-6),
}
depth = np.linspace(1e-9, 300e-9, 200)
figure, axes = plt.subplots()
for name, shape in shapes.items():
    axes.loglog(depth * 1e9, geometry.force(shape, depth, 10e3) * 1e12, label=name)
axes.set(xlabel="indentation (nm)", ylabel="force (pN)")
axes.legend()
