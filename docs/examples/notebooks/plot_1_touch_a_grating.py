# SPDX-License-Identifier: BSD-3-Clause
"""
Touch a grating
===============

The first tutorial as a notebook: press a tip on silicon, then feel a line across a grating.
"""

# %%
# A scene is tip, sample and medium. Without arguments it is a silicon tip of 20 nm over silicon, in humid air.
import matplotlib.pyplot as plt
import nanotouch as nt

scene = nt.Scene()
print(scene.plan())

# %%
# A session closes the loop between a hand and the tip. Here the hand is simulated: it lands, presses and lifts.
recording = nt.Session(scene, seed=1).run()
seen = nt.plots.adhesion(recording)
print(f"pull-off {seen.pull_off_force * 1e9:.0f} nN")

# %%
# Force over gap, on the way in and on the way out. The two differ: a neck of water holds on until it tears.
figure, axes = plt.subplots()
near = recording.gap < 12e-9
axes.plot(recording.gap[near] * 1e9, recording.tip_force[near] * 1e9)
axes.set(xlabel="gap (nm)", ylabel="force on the tip (nN)")

# %%
# Now a line. The tip is round, so the edges of the ridges are felt rounded.
surface = nt.Surface(nt.surface.grating(), tip_radius=20e-9)
line = nt.Session(scene, surface=surface, mode="scan", seed=1).run()
figure, axes = plt.subplots()
touching = line.tip_force > 0
axes.plot(line.x[touching] * 1e6, (line.surface_height + line.gap)[touching] * 1e9)
axes.set(xlabel="x (µm)", ylabel="height of the tip (nm)")
