# SPDX-License-Identifier: BSD-3-Clause
"""
Electrostatic: apex, cone and lever
===================================

At 100 nm the lever pulls more than sphere and cone together: charge is felt from far away.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

gap = np.geomspace(1e-9, 1e-6, 200)
apex = nt.forces.electrostatic(gap, radius=20e-9, potential=1.0).F
tip = nt.forces.electrostatic_tip(gap, radius=20e-9, half_angle=0.3, height=10e-6, potential=1.0).F
lever = nt.forces.electrostatic_lever(gap, length=125e-6, width=35e-6, tilt=0.2, tip_height=10e-6, potential=1.0).F
figure, axes = plt.subplots()
for name, force in (("sphere", apex), ("apex and cone", tip), ("lever", lever)):
    axes.loglog(gap * 1e9, -force * 1e9, label=name)
axes.set(xlabel="gap (nm)", ylabel="attraction at 1 V (nN)")
axes.legend()
