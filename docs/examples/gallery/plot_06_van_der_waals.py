# SPDX-License-Identifier: BSD-3-Clause
"""
Van der Waals: the textbook formula and the sum
===============================================

HR/(6h²) holds only for gaps far below the radius. At 10 nm it is 36 % too strong
(erratum E1 of the paper).
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

gap = np.geomspace(0.3e-9, 100e-9, 200)
tip = {"radius": 30e-9, "hamaker_constant": 1e-19}
figure, axes = plt.subplots()
axes.loglog(gap * 1e9, -nt.forces.vdw_derjaguin(gap, **tip).F * 1e9, ":", label="HR/(6h²)")
axes.loglog(gap * 1e9, -nt.forces.vdw(gap, **tip).F * 1e9, label="sphere")
whole = nt.forces.vdw_tip(gap, **tip, half_angle=0.35, height=10e-6)
axes.loglog(gap * 1e9, -whole.F * 1e9, label="sphere and cone")
axes.set(xlabel="gap (nm)", ylabel="attraction (nN)")
axes.legend()

# %%
# The same in C prints the curves:
#
# .. literalinclude:: ../examples/gallery/plot_06_van_der_waals.c
#    :language: c
