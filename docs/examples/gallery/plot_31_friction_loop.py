# SPDX-License-Identifier: BSD-3-Clause
"""
Trace and retrace
=================

A tip goes there and back under three loads. It sticks, then slips; the area of the loop is heat.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

contact = nt.Contact(radius=20e-9, effective_modulus=5e9, work_of_adhesion=0.05)
friction = nt.Friction(1e9, lateral_compliance=0.02, shear_strength=100e6, coefficient=0.1)
x = np.concatenate([np.linspace(0, 5e-9, 200), np.linspace(5e-9, -5e-9, 400), np.linspace(-5e-9, 5e-9, 400)])
figure, axes = plt.subplots(layout="constrained")
for force in (-4e-9, 0.0, 20e-9):
    law = nt.contact.evaluate("jkr", nt.contact.indentation("jkr", force, contact), contact)
    path = friction.run(x, 0.0, law.a, nt.friction.compressive_load("jkr", law, contact))
    heat = path.dissipated[-1] - path.dissipated[199]
    axes.plot(1e9 * x, -1e9 * path.force_x, label=f"{1e9 * force:g} nN: {1e18 * heat:.0f} aJ")
figure.legend(title="load: heat of a cycle", loc="outside upper center", ncols=3)
axes.set(xlabel="way of the support (nm)", ylabel="lateral force (nN)")

# %%
# The same in C prints the curves:
#
# .. literalinclude:: ../examples/gallery/plot_31_friction_loop.c
#    :language: c
