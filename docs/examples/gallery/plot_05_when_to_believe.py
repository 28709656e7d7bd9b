# SPDX-License-Identifier: BSD-3-Clause
"""
When to believe Hertz
=====================

Hertz takes a sphere for a paraboloid. At a/R = 0.3 the true force is 1 % lower,
at a/R = 0.6 it is 4 % lower.
"""

import matplotlib.pyplot as plt
import numpy as np
from nanotouch import geometry

paraboloid = geometry.Shape("paraboloid", radius=1e-6)
sphere = geometry.Shape("sphere", radius=1e-6)
depth = np.linspace(1e-9, 400e-9, 200)
ratio = geometry.force(sphere, depth, 1e6) / geometry.force(paraboloid, depth, 1e6)
a = geometry.evaluate(sphere, depth, 1e6).a
figure, axes = plt.subplots()
axes.plot(a / 1e-6, 100 * (ratio - 1))
axes.axvline(0.3, ls=":", color="k")
axes.set(xlabel="contact radius a/R", ylabel="sphere against Hertz (%)")
