# SPDX-License-Identifier: BSD-3-Clause
"""
What the hand feels over frequency
==================================

Impedance at the hand, pressed on silicon: a spring below the bandwidth, a mass above it.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

rig = nt.Rig()
settings = nt.Settings.for_rig(rig)
frequency = np.geomspace(0.1, 1000.0, 300)
seen = nt.margins.response(rig, settings, nt.Scene().plan().maximum_stiffness, frequency)
figure, axes = plt.subplots()
axes.loglog(frequency, np.abs(seen.impedance))
axes.set(xlabel="frequency (Hz)", ylabel="impedance at the hand (N s/m)")
