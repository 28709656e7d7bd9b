# SPDX-License-Identifier: BSD-3-Clause
"""Example 1: the force on a silicon tip over its indentation into silicon, by four contact models, on retraction."""

import nanotouch as nt
import numpy as np
from nanotouch.contact import MODELS

contact = nt.Contact(
    radius=20e-9,
    effective_modulus=76.9e9,
    work_of_adhesion=0.144,
    cohesive_stress=nt.contact.cohesive_stress_atomic(0.144, 0.2e-9),
)
print(
    f"R = {contact.radius * 1e9:.3g} nm, E* = {contact.effective_modulus * 1e-9:.3g} GPa, "
    f"w = {contact.work_of_adhesion:.3g} J/m2, Maugis' lambda = {contact.maugis_lambda:.3g}\n"
)
indentation = np.arange(-4, 9) * 0.1e-9
forces = [nt.contact.force(model, indentation, contact) for model in MODELS]

print(f"{'':8}", *(f"{model:>10}" for model in MODELS))
print(f"{'nm':>8}", *(f"{'nN':>10}" for _ in MODELS))
for delta, *row in zip(indentation, *forces, strict=True):
    print(f"{delta * 1e9:8.2f}", *(f"{force * 1e9:10.3f}" for force in row))
print(f"\n{'pull-off':>8}", *(f"{nt.contact.pull_off_force(model, contact) * 1e9:10.3f}" for model in MODELS))
