# SPDX-License-Identifier: BSD-3-Clause
"""
Scan, rub, push
===============

The sixth tutorial as a notebook: an image in tapping mode, a friction loop, and a particle that is pushed.
"""

# %%
# What a scan will do is told before it begins.
import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

scene = nt.Scene()
surface = nt.Surface.touched_by(scene, nt.surface.dots())
rig = nt.Rig(probe={"resonance": 300e3}, stage={"resonance": 20e3, "quality": 5.0})
settings = nt.Scan(raster={"width": 500e-9, "height": 500e-9, "pixels": 32, "lines": 32, "line_rate": 1.0})
scanner = nt.Scanner(scene.plan(surface=surface), settings, rig)
print(nt.scan.forecast(scanner, scene, surface))

# %%
# The image, and the peak force of each pixel.
image = scanner.run()
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.5), layout="constrained")
for axes, values, label in ((left, image.trace.height, "height (nm)"), (right, image.trace.peak_force, "force (nN)")):
    figure.colorbar(axes.imshow(values * 1e9, origin="lower", extent=(0, 500, 0, 500)), label=label)
    axes.set(xlabel="x (nm)", ylabel="y (nm)")

# %%
# A friction loop in contact mode: half of what lies between the two ways is friction.
rubbed = nt.Scene(friction={"coefficient": 0.2}, medium={"relative_humidity": 0.0})
line = nt.Scan(
    zloop={"mode": "contact", "set_force": 50e-9}, raster={"width": 500e-9, "pixels": 64, "lines": 1, "line_rate": 1.0}
)
seen = nt.Scanner(rubbed.plan(), line, rig).run()
x = (np.arange(64) + 0.5) / 64 * 500e-9
loop = nt.lateral.loop(x, seen.trace.lateral[0], seen.retrace.lateral[0])
figure, axes = plt.subplots()
axes.plot(x * 1e9, seen.trace.lateral[0] * 1e9, x * 1e9, seen.retrace.lateral[0] * 1e9)
axes.set(xlabel="x (nm)", ylabel="lateral force (nN)", title=f"friction {loop.half_width * 1e9:.1f} nN")

# %%
# A latex ball that is pushed: the force rises until it rolls.
ball = nt.manipulation.latex(500e-9)
way = np.linspace(-0.65e-6, -0.55e-6, 101)
path = ball.run(way, 0.0, 0.3e-6)
figure, axes = plt.subplots()
axes.plot(way * 1e9, path.force[:, 0] * 1e9)
axes.set(xlabel="place of the tip (nm)", ylabel="force on the tip along x (nN)")
