# SPDX-License-Identifier: BSD-3-Clause
"""
A touch over time
=================

The hand presses; the probe meets the surface; the force comes back, scaled.
"""

import matplotlib.pyplot as plt
import nanotouch as nt

recording = nt.Session(nt.Scene()).run()
figure, (top, bottom) = plt.subplots(2, sharex=True)
top.plot(recording.time, recording.master_position * 1e3)
top.set(ylabel="hand (mm)")
bottom.plot(recording.time, recording.tip_force * 1e9)
bottom.set(xlabel="time (s)", ylabel="force on the tip (nN)")
