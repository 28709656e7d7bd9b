# SPDX-License-Identifier: BSD-3-Clause
"""Example 3: a JKR retraction with noise, as a cantilever of 0.5 N/m would measure it, and what a fit makes of it."""

import nanotouch as nt
import numpy as np
from nanotouch.curves import ForceCurve, Segment

STIFFNESS, NOISE = 0.5, 50e-12  # [N/m], [N]
truth = {"effective_modulus": 5e6, "work_of_adhesion": 0.05, "contact_point": 300e-9}
contact = nt.Contact(20e-9, truth["effective_modulus"], truth["work_of_adhesion"])

# in contact, from deep to the pull-off; then apart
pull_off = nt.contact.pull_off_force("jkr", contact)
force = np.linspace(10e-9, -0.9999 * pull_off, 4000)
height = truth["contact_point"] - nt.contact.indentation("jkr", force, contact) - force / STIFFNESS
z = np.linspace(height[0], height[-1] + 300e-9, 1500)
measured = np.interp(z, height, force, right=0.0) + NOISE * np.random.default_rng(1).standard_normal(z.size)

time = np.linspace(0.0, 1e-4 * (z.size - 1), z.size)
retract = Segment("retract", time, z, "height (measured)", measured, measured / STIFFNESS)
curve = ForceCurve((retract,), {"spring constant": STIFFNESS}, "synthetic")
result = nt.fit.fit_curve(curve, "jkr", radius=20e-9)

print(f"{'':18} {'fitted':>14} {'sigma':>12} {'true':>14}")
for name, value in truth.items():
    print(f"{name:18} {result.values[name]:14.6g} {result.sigma[name]:12.2g} {value:14.6g} {result.units[name]}")
print(f"pull-off {result.pull_off_force * 1e9:.3f} nN, residual {result.residual_rms * 1e12:.1f} pN")
