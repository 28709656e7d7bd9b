# SPDX-License-Identifier: BSD-3-Clause
"""
In and out: the energy of a cycle
=================================

An interaction remembers: here silicon in humid air, on the way in and out.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

scene, _ = nt.presets.silicon_in_air()
gap = np.concatenate([np.linspace(3e-9, -0.5e-9, 500), np.linspace(-0.5e-9, 3e-9, 500)])
law = scene.plan().run(gap)
figure, axes = plt.subplots()
axes.plot(gap[:500] * 1e9, law.F[:500] * 1e9, label="in")
axes.plot(gap[500:] * 1e9, law.F[500:] * 1e9, label="out")
axes.set(xlabel="gap (nm)", ylabel="force (nN)")
axes.legend()
