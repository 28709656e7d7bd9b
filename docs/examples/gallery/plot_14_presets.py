# SPDX-License-Identifier: BSD-3-Clause
"""
The force curves of the presets
===============================

Seven samples, from silicon to a living cell. ``nanotouch live NAME`` lets you feel each.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

figure, panels = plt.subplots(2, 4, figsize=(11, 5), layout="constrained")
for axes, name in zip(panels.flat, nt.presets.FELT, strict=False):
    scene, _ = getattr(nt.presets, name)()
    plan = scene.plan()
    load, far = scene.range.maximum_load, {"cell_in_liquid": 600e-9}.get(name, 3e-9)
    deep = np.linspace(far, -far, 1500)
    force = plan.run(deep).F
    gap = deep[: np.argmax(force > min(load, 60e-9)) or None]
    axes.plot(gap * 1e9, plan.run(gap).F * 1e9)
    axes.set(title=name, xlabel="gap (nm)", ylabel="force (nN)")
panels.flat[-1].axis("off")
