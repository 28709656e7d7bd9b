# SPDX-License-Identifier: BSD-3-Clause
"""
From a force curve to modulus and adhesion
==========================================

The truth is 3 GPa and 50 mJ/m². The fit gives both with their uncertainties.
"""

import nanotouch as nt

contact = nt.Contact(20e-9, 3e9, 0.05, cohesive_range=0.2e-9)
curve = nt.curves.synthesize(contact, spring_constant=2.0, depth=20e-9, noise=50e-12)
result = nt.fit.fit_curve(curve, "maugis", radius=20e-9)
print(result)
figure = nt.fit.draw(curve, result)
