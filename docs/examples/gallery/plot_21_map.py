# SPDX-License-Identifier: BSD-3-Clause
"""
A map of modulus and adhesion
=============================

Every curve of a force volume is fitted. The right half is twice as stiff.
"""

import nanotouch as nt
import numpy as np

stiff = np.broadcast_to(np.where(np.arange(12) < 6, 3e9, 6e9), (12, 12))
volume = nt.maps.synthesize(stiff, 0.05, radius=20e-9, spring_constant=2.0, noise=50e-12, points=400, depth=20e-9)
data = nt.maps.fit(volume, "maugis", radius=20e-9, threads=1)
figure = nt.maps.draw(data)
