# SPDX-License-Identifier: BSD-3-Clause
"""
A polymer brush pushes long before contact
==========================================

A brush of 50 nm is felt at 50 nm. The exponential fit of textbooks has no such edge.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

gap = np.linspace(5e-9, 70e-9, 300)
brush = {"radius": 1e-6, "thickness": 50e-9, "spacing": 5e-9}
figure, axes = plt.subplots()
axes.semilogy(gap * 1e9, nt.forces.steric(gap, **brush).F * 1e9, label="Alexander - de Gennes")
axes.semilogy(gap * 1e9, nt.forces.steric(gap, **brush, exponential=True).F * 1e9, ":", label="exponential")
axes.set(xlabel="gap (nm)", ylabel="repulsion (nN)", ylim=(1e-3, None))
axes.legend()
