# SPDX-License-Identifier: BSD-3-Clause
"""
Humidity and the meniscus
=========================

Kelvin's radius grows from 0.3 nm at 20 % to 5 nm at 90 % of humidity.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

humidity = np.linspace(0.1, 0.95, 100)
radius = [nt.forces.kelvin_radius(float(h)) for h in humidity]
figure, axes = plt.subplots()
axes.plot(100 * humidity, np.array(radius) * 1e9)
axes.set(xlabel="relative humidity (%)", ylabel="Kelvin radius (nm)")
