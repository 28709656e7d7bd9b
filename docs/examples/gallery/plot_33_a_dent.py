# SPDX-License-Identifier: BSD-3-Clause
"""
A dent and its loop
===================

A tip presses on gold, harder each time. Above 61 pN the gold yields. What the loops enclose is heat, and a dent stays.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

gold = nt.plasticity.Indentation(radius=20e-9, effective_modulus=77e9, yield_strength=0.35e9)
figure, (loops, section) = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
for load in (50e-9, 100e-9, 200e-9):
    deepest = gold.at_load(load).indentation
    depth = np.concatenate([np.linspace(0, deepest, 200), np.linspace(deepest, 0, 200)])
    path = gold.run(depth)
    loops.plot(1e9 * depth, 1e9 * path.force, label=f"{1e9 * load:.0f} nN: {1e18 * path.dissipated[-1]:.0f} aJ")
    specimen = nt.plasticity.Specimen(np.zeros((256, 256)), 0.2e-9, indentation=gold)
    specimen.indent(25.6e-9, 25.6e-9, load)
    section.plot(0.2 * np.arange(256) - 25.6, 1e9 * specimen.heights[128])
loops.set(xlabel="indentation (nm)", ylabel="force (nN)")
loops.legend(title="load: heat")
section.set(xlabel="place (nm)", ylabel="height that stays (nm)")

# %%
# The same in C prints the curves:
#
# .. literalinclude:: ../examples/gallery/plot_33_a_dent.c
#    :language: c
