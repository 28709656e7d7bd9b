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
figure, axes = plt.subplots()
for exponential, line, label in ((False, "-", "Alexander - de Gennes"), (True, ":", "exponential")):
    law = nt.forces.steric(gap, radius=1e-6, thickness=50e-9, spacing=5e-9, exponential=exponential)
    axes.semilogy(gap * 1e9, law.F * 1e9, line, label=label)
axes.set(xlabel="gap (nm)", ylabel="repulsion (nN)", ylim=(1e-3, None))
axes.legend()
