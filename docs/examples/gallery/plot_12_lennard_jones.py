# SPDX-License-Identifier: BSD-3-Clause
"""
How good is Maugis-Dugdale itself?
==================================

Against a full Lennard-Jones sphere its pull-off force is at most 5.6 % off, at μ = 0.7.
"""

import matplotlib.pyplot as plt
import numpy as np
from nanotouch import reference
from nanotouch.contact import reduced

mu = np.geomspace(0.06, 5.0, 60)
true = np.array([reference.pull_off(float(m)) for m in mu])
maugis = reduced.folds(1.157 * mu).pull_off_load
figure, axes = plt.subplots()
axes.semilogx(mu, 100 * (np.abs(maugis) / np.abs(true) - 1))
axes.set(xlabel="Tabor's μ", ylabel="Maugis-Dugdale against Lennard-Jones (%)")
