# SPDX-License-Identifier: BSD-3-Clause
"""
A sensor fails in mid-touch
===========================

The deflection reads NaN for a millisecond, ten samples. The supervisor lifts the tip and keeps it off.
"""

import matplotlib.pyplot as plt
import nanotouch as nt

faults = nt.Faults().add("nan", "deflection", at=3.0, duration=1e-3)
recording = nt.Session(nt.Scene(), faults=faults).run()
figure, (top, bottom) = plt.subplots(2, sharex=True)
top.plot(recording.time, recording.tip_force * 1e9)
top.set(ylabel="force on the tip (nN)")
bottom.plot(recording.time, recording.state)
bottom.set(xlabel="time (s)", yticks=[0, 1, 2, 3], yticklabels=["RUN", "HOLD", "RETRACT", "LATCHED"])
