# SPDX-License-Identifier: BSD-3-Clause
"""
What can happen at worst
========================

The force limit, and all that can be added before a stop takes effect.
"""

import matplotlib.pyplot as plt
import nanotouch as nt

guarantee = nt.Session(nt.Scene()).guarantee()
parts = {"limit": guarantee.limit}
for name in ("calibration", "motion", "ringing", "snap_in", "noise"):
    parts[name] = getattr(guarantee, name)
figure, axes = plt.subplots()
left = 0.0
for name, force in parts.items():
    axes.barh(0, force * 1e9, left=left, label=name)
    left += force * 1e9
axes.set(xlabel="force on the sample (nN)", yticks=[])
axes.legend(ncols=3, loc="upper center")
