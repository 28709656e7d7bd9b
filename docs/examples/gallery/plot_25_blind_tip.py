# SPDX-License-Identifier: BSD-3-Clause
"""
Estimate the tip from the image alone
=====================================

The bluntest tip that could have taken the image: no sharper than the true one.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

true = nt.surface.dots(pixels=128)
image = nt.images.dilate(true, nt.images.Paraboloid(15e-9))
estimate = nt.images.estimate_tip(image, 21)
middle = estimate.heights.shape[0] // 2
x = (np.arange(21) - middle) * image.pixel_size[1]
figure, axes = plt.subplots()
axes.plot(x * 1e9, estimate.heights[middle] * 1e9, label="estimate")
axes.plot(x * 1e9, x**2 / 30e-9 * 1e9, ":", label="true")
axes.set(xlabel="x (nm)", ylabel="height above the apex (nm)")
axes.legend()
