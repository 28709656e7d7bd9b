# SPDX-License-Identifier: BSD-3-Clause
"""
A water bridge forms late and breaks late
=========================================

The bridge forms when the films touch and ruptures farther out.
The cycle loses the work of pulling it apart.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

r1 = nt.forces.kelvin_radius(0.4)
down = np.linspace(6e-9, 0.2e-9, 400)
figure, axes = plt.subplots()
path = np.concatenate([down, down[::-1]])
seen = nt.forces.capillary_path(path, radius=30e-9, meniscus_radius=r1, film_thickness=0.5e-9)
axes.plot(path[:400] * 1e9, seen.law.F[:400] * 1e9, label="in")
axes.plot(path[400:] * 1e9, seen.law.F[400:] * 1e9, label="out")
axes.set(xlabel="gap (nm)", ylabel="capillary force (nN)", title=f"meniscus radius {r1 * 1e9:.2f} nm at 40 %")
axes.legend()
