# SPDX-License-Identifier: BSD-3-Clause
"""
The surface under the tip
=========================

Contact deforms the sample. The section is to scale at a load of 20 nN.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

scene, _ = nt.presets.mica_in_air()
plan = scene.plan()
gap = np.linspace(0.5e-9, -1e-9, 2000)
force = plan.run(gap).F
here = int(np.argmin(np.abs(force - 20e-9)))
r = np.linspace(0.0, 15e-9, 200)
section = nt.view.section(plan, scene, float(gap[here]), float(force[here]), r)
figure, axes = plt.subplots()
axes.plot(r * 1e9, section.sample * 1e9, label="sample")
axes.plot(r * 1e9, section.tip * 1e9, label="tip")
axes.plot(r * 1e9, section.rigid_tip * 1e9, ":", label="tip, if rigid")
axes.set(xlabel="r (nm)", ylabel="z (nm)")
axes.legend()
