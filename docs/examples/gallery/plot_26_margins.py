# SPDX-License-Identifier: BSD-3-Clause
"""
How fast must the loop be?
==========================

The stability margin against the rate of the loop, on silicon. Below 1 it oscillates.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

rig, settings = nt.Rig(), nt.Settings.for_rig(nt.Rig())
stiffness = nt.Scene().plan().maximum_stiffness
rates = np.geomspace(300.0, 30e3, 40)
margins = []
for rate in rates:
    settings["gains.rate"] = float(rate)
    margins.append(nt.margins.compute(rig, settings, stiffness).margin)
figure, axes = plt.subplots()
axes.loglog(rates, margins)
axes.axhline(1.0, ls=":", color="k")
axes.set(xlabel="rate of the loop (Hz)", ylabel="stability margin (R1)")

# %%
# The same in C prints the curves:
#
# .. literalinclude:: ../examples/gallery/plot_26_margins.c
#    :language: c
