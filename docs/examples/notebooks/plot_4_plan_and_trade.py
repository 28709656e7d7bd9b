# SPDX-License-Identifier: BSD-3-Clause
"""
Plan, and trade accuracy for speed
==================================

The fourth tutorial as a notebook: ask for an accuracy, see what it costs.
"""

# %%
# A preset is a scene with its rig. The plan says which forces are computed, how, and with which error.
import matplotlib.pyplot as plt
import nanotouch as nt

scene, rig = nt.presets.silicon_on_gold()
print(scene.plan(relative_accuracy=0.01))

# %%
# The tighter the demand, the dearer the plan. A cost of 1 is one evaluation of Hertz' formula.
demands = [0.3, 0.1, 0.03, 0.01]
plans = [scene.plan(relative_accuracy=demand) for demand in demands]
figure, axes = plt.subplots()
axes.semilogx([100 * demand for demand in demands], [plan.cost for plan in plans], "o-")
axes.set(xlabel="accuracy that is asked for (%)", ylabel="cost of a force (Hertz = 1)")
assert all(plan.bound <= demand for plan, demand in zip(plans, demands, strict=True))

# %%
# What cannot be kept is refused, and the message says what can.
try:
    nt.presets.cell_in_liquid()[0].plan(relative_accuracy=1e-6)
except nt.Error as refusal:
    print(refusal)
