# SPDX-License-Identifier: BSD-3-Clause
"""
A double layer, and what salt does
==================================

Salt screens the repulsion: its range is the Debye length, 9.6 nm in 1 mM and 0.96 nm in 100 mM.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

gap = np.linspace(0.5e-9, 40e-9, 300)
figure, axes = plt.subplots()
for millimolar in (1, 10, 100):
    length = nt.forces.debye_length(float(millimolar))  # mol/m^3
    law = nt.forces.double_layer(gap, radius=30e-9, debye_length=length, tip_potential=-0.02, sample_potential=-0.02)
    axes.semilogy(gap * 1e9, law.F * 1e12, label=f"{millimolar} mM, 1/κ = {length * 1e9:.2g} nm")
axes.set(xlabel="gap (nm)", ylabel="repulsion (pN)", ylim=(1e-2, 1e3))
axes.legend()

# %%
# The same in C prints the curves:
#
# .. literalinclude:: ../examples/gallery/plot_10_double_layer.c
#    :language: c
