# SPDX-License-Identifier: BSD-3-Clause
"""
Why a force has a history
=========================

On the way in the tip jumps where the attraction begins. On the way out it
holds on. The area between both branches is the energy that a cycle loses.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

contact = nt.Contact(radius=1e-6, effective_modulus=5e6, work_of_adhesion=0.05, cohesive_range=1e-9)
gap = np.linspace(150e-9, -60e-9, 1500)
figure, axes = plt.subplots()
axes.plot(gap * 1e9, nt.contact.force("maugis", -gap, contact, "approach") * 1e9, label="in")
axes.plot(gap * 1e9, nt.contact.force("maugis", -gap, contact, "stable") * 1e9, label="out")
axes.set(xlabel="gap (nm)", ylabel="force on the tip (nN)")
axes.legend()
