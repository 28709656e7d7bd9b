# SPDX-License-Identifier: BSD-3-Clause
"""
From pull-off to work of adhesion
=================================

The third tutorial as a notebook: fit a curve whose answer is known, with four models.
"""

# %%
# The truth is 3 GPa and 50 mJ/m². ``nt.curves.read("curve.h5")`` reads yours.
import matplotlib.pyplot as plt
import nanotouch as nt

truth = nt.Contact(20e-9, effective_modulus=3e9, work_of_adhesion=0.05, cohesive_range=0.2e-9)
curve = nt.curves.synthesize(truth, spring_constant=2.0, depth=20e-9, noise=50e-12, seed=1)

# %%
# One fit. Each value has an uncertainty.
result = nt.fit.fit_curve(curve, "maugis", radius=20e-9)
for name in ("effective_modulus", "work_of_adhesion"):
    print(f"{name:20} {result.values[name]:.4g} +- {result.sigma[name]:.2g} {result.units[name]}")

# %%
# What was measured, and what was fitted.
figure, axes = plt.subplots()
axes.plot(result.indentation * 1e9, result.force * 1e9, ".", ms=3, label="curve")
axes.plot(result.indentation * 1e9, result.fitted * 1e9, label="fit")
axes.set(xlabel="indentation (nm)", ylabel="force (nN)")
axes.legend()

# %%
# The same curve under other models. JKR and DMT disagree on w, for the same pull-off force.
for model in ("dmt", "maugis", "jkr"):
    other = nt.fit.fit_curve(curve, model, radius=20e-9)
    w, residual = other.values["work_of_adhesion"], other.residual_rms
    print(f"{model:8} w = {w * 1e3:5.1f} mJ/m², residual {residual * 1e12:.0f} pN")
