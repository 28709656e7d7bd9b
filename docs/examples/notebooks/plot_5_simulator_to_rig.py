# SPDX-License-Identifier: BSD-3-Clause
"""
From the simulator to a rig
===========================

The fifth tutorial as a notebook: margins before motion, a promise in numbers, and a fault.
"""

# %%
# Margins say how close the loop is to instability. 1 is the limit; below 1.5 a session is refused.
import matplotlib.pyplot as plt
import nanotouch as nt

session = nt.Session(seed=1)
margins = session.margins()
print(f"margin {margins.least:.1f}, limited by {margins.rule}")

# %%
# The guarantee says what the sample may have to bear.
print(session.guarantee())

# %%
# Run it in steps, and change a gain in between. A change that leaves too little margin is refused.
session.advance(0.5)
session.change("settings", "gains.force_gain", 2.0)
block = session.advance(0.5)
print(len(block["time"]), "ticks")

# %%
# A whole touch, against what was promised.
recording = nt.Session(seed=1).run()
figure, axes = plt.subplots()
axes.plot(recording.time, recording.tip_force * 1e9)
axes.axhline(session.guarantee().force * 1e9, color="k", ls="--", label="promised")
axes.set(xlabel="time (s)", ylabel="force on the tip (nN)")
axes.legend()
