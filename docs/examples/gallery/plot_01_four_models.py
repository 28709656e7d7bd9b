# SPDX-License-Identifier: BSD-3-Clause
"""
Four contact models, one contact
================================

Hertz has no adhesion, DMT and JKR are limits, Maugis-Dugdale lies between them.
For this tip the pull-off force is 4.5 nN to 6 nN, depending on the model.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

contact = nt.Contact(radius=20e-9, effective_modulus=3e9, work_of_adhesion=0.048, cohesive_range=0.2e-9)
gap = np.linspace(2e-9, -1.5e-9, 800)
figure, axes = plt.subplots()
for model in ("hertz", "dmt", "jkr", "maugis"):
    axes.plot(gap * 1e9, nt.contact.force(model, -gap, contact) * 1e9, label=model)
    print(f"{model:7} pull-off {nt.contact.pull_off_force(model, contact) * 1e9:.2f} nN")
axes.set(xlabel="gap (nm)", ylabel="force on the tip (nN)", ylim=(-8, 15))
axes.legend()

# %%
# The same in C prints the curves:
#
# .. literalinclude:: ../examples/gallery/plot_01_four_models.c
#    :language: c
