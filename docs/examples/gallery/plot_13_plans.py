# SPDX-License-Identifier: BSD-3-Clause
"""
A plan: cheap where it may be
=============================

Ask for less accuracy and the plan takes cheaper models. The cost is in evaluations of Hertz.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

accuracies = np.geomspace(1e-3, 0.3, 25)
figure, axes = plt.subplots()
for name in ("silicon_in_air", "silicon_on_gold", "cell_in_liquid"):
    scene, _ = getattr(nt.presets, name)()
    costs = [scene.plan(relative_accuracy=float(r)).cost for r in accuracies]
    axes.step(100 * accuracies, costs, label=name)
axes.set(xscale="log", xlabel="accuracy demanded (%)", ylabel="cost (Hertz evaluations)")
axes.legend()
