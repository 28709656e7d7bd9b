# SPDX-License-Identifier: BSD-3-Clause
"""
Which way a particle gives
==========================

A smooth tip pushes a sphere of 5 µm by 3 µm, for many shear strengths and rolling distances. Does it roll or slide?
Dots: polystyrene on glass, as Sumer and Sitti (2008) found it. Line: where both limits are the same force.
"""

import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np

RADIUS, E, G = 5e-6, 3.63e9, 0.85e9
smooth = nt.ParticleContact(E, G)
strengths, distances = np.geomspace(1e5, 1e8, 13), np.geomspace(1e-8, 2e-6, 13)


def particle(strength: float, distance: float) -> nt.Particle:
    substrate = nt.ParticleContact(E, G, 0.06, shear_strength=strength, rolling_distance=distance)
    return nt.Particle(RADIUS, substrate, smooth, step=20e-9)


def share_rolled(strength: float, distance: float) -> float:
    path = particle(strength, distance).run(np.array([-6.1e-6, -3e-6]), 0.0, 2e-6)
    slid, rolled, _ = path.given[-1, :3]
    return float(rolled / max(slid + rolled, 1e-30))


rolled = np.array([[share_rolled(strength, distance) for distance in distances] for strength in strengths])
figure, axes = plt.subplots(layout="constrained")
shown = axes.pcolormesh(1e9 * distances, 1e-6 * strengths, rolled, cmap="coolwarm", shading="gouraud", vmin=0, vmax=1)
figure.colorbar(shown, label="share of rolling in what gives way")
one = particle(12e6, 42e-9)
area, torque = np.pi * one.rest_radius("substrate") ** 2, one.limit("substrate", "roll", one.rest_radius("substrate"))
axes.plot(1e9 * distances, 1e-6 * torque / 42e-9 * distances / RADIUS / area, color="black")
axes.plot([42, 42, 42], [9, 12, 15], "o", color="black")
axes.set(xscale="log", yscale="log", ylim=(0.1, 100))
axes.set(xlabel="critical rolling distance (nm)", ylabel="shear strength (MPa)")
