# SPDX-License-Identifier: BSD-3-Clause
"""
A sample that relaxes
=====================

The seventh tutorial as a notebook: approach, pause and retraction of a gel in one fit.
"""

# %%
# The truth is 1.2 kPa at 1 s and an exponent of 0.2. ``nt.curves.read("gel.h5")`` reads yours.
import matplotlib.pyplot as plt
import nanotouch as nt
import numpy as np
from nanotouch.contact.geometry import Shape

time = np.arange(2500) / 1000.0
base = np.interp(time, [0.0, 1.0, 1.5, 2.5], [-1e-6, 1e-6, 1e-6, -1e-6])
gel = nt.Rheology.power_law(1.2e3, 0.2)
force = gel.force(time, base, Shape("paraboloid", radius=2.5e-6), spring_constant=0.06).force
force = force + 10e-12 * np.random.default_rng(7).standard_normal(time.size)
height, deflection = "height (measured)", force / 0.06
approach = nt.curves.Segment("approach", time[:1000], -base[:1000], height, force[:1000], deflection[:1000])
rest = nt.curves.Segment("pause", time[1000:1500], -base[1000:1500], height, force[1000:1500], deflection[1000:1500])
back = nt.curves.Segment("retract", time[1500:], -base[1500:], height, force[1500:], deflection[1500:])
curve = nt.curves.ForceCurve((approach, rest, back), {"spring constant": 0.06}, "gel")

# %%
# An elastic law says that the sample relaxes.
print(nt.fit.fit_curve(curve, "hertz", radius=2.5e-6, poisson_ratio=0.5).reason)

# %%
# All of the curve in one fit over time.
result = nt.fit.fit_curve(curve, "ting_power", radius=2.5e-6, poisson_ratio=0.5)
print(result.answer)

# %%
# The modulus as the pause shows it, with its uncertainty, and the fitted power law.
(pause,) = nt.fit.pauses(curve, result)
figure, axes = plt.subplots()
axes.errorbar(pause.time, pause.modulus, pause.modulus_sigma, fmt="o", label="pause")
axes.loglog(pause.time, result.rheology.relaxation(pause.time), label="fit")
axes.set(xlabel="time (s)", ylabel="E (Pa)")
axes.legend()
