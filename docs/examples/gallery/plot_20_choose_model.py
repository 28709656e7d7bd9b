# SPDX-License-Identifier: BSD-3-Clause
"""
Which model does the curve prefer?
==================================

The residuals decide, as far as they can.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

contact = nt.Contact(1e-6, 1e6, 0.02)
curve = nt.curves.synthesize(contact, "jkr", spring_constant=0.5, depth=40e-9, noise=30e-12)
choice = nt.fit.choose_model(curve, radius=1e-6)
print(choice)
figure, axes = plt.subplots()
retract = curve.segments[-1]
axes.plot(retract.z * 1e9, np.asarray(retract.force) * 1e9, lw=0.8)
axes.set(xlabel="height of the base (nm)", ylabel="force (nN)", title=f"preferred: {choice.best.model}")
