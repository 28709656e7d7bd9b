# SPDX-License-Identifier: BSD-3-Clause
"""
The force curve inside a touch
==============================

Every recording holds its own force curve: force on the tip over the gap.
"""

import nanotouch as nt

recording = nt.Session(nt.Scene()).run()
figure = nt.plots.force_gap(recording)
