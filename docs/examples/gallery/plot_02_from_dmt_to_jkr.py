# SPDX-License-Identifier: BSD-3-Clause
"""
From DMT to JKR
===============

The pull-off force falls from 2πwR (hard tips) to 1.5πwR (soft ones).
Maugis' λ says where you are.
"""

import matplotlib.pyplot as plt
import numpy as np
from nanotouch.contact import reduced

lam = np.geomspace(1e-2, 1e2, 200)
pull_off = -reduced.folds(lam).pull_off_load
figure, axes = plt.subplots()
axes.semilogx(lam, pull_off)
axes.axhline(2.0, ls=":", label="DMT")
axes.axhline(1.5, ls="--", label="JKR")
axes.set(xlabel="Maugis' λ", ylabel="pull-off force (πwR)")
axes.legend()
