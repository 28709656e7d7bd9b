# SPDX-License-Identifier: BSD-3-Clause
"""Example 2: touch a flat silicon surface on the simulated rig: approach, press, retract; what tip and hand felt."""

import nanotouch as nt
import numpy as np

session = nt.Session(settings=nt.Settings.for_rig(nt.Rig()))
approach = [nt.Input(0.2, 0.0, 0.0, 0.5), nt.Input(0.2, 0.0, 0.0, 2.5)]
press = [nt.Input(2.0, 0.0, 0.0, 1.5), nt.Input(2.0, 0.0, 0.0, 1.5)]
retract = [nt.Input(-0.3, 0.0, 0.0, 3.0), nt.Input(-0.3, 0.0, 0.0, 1.0)]
recording = session.run(operator=[*approach, *press, *retract])

felt = recording.scaled_slave_force
rest = (recording.time > 5.0) & (recording.time < 6.0)
error = (recording.operator_force - felt)[rest]
print(f"contact law            {session.plan.contact_law}, lambda {session.plan.maugis_lambda:.3g}")
print(f"stability margin of R1 {session.margins().margin:.1f}")
print(f"largest force          {recording.tip_force.max() * 1e9:.1f} nN")
print(
    f"largest attraction     {-recording.tip_force.min() * 1e9:.2f} nN "
    f"(the plan's pull-off: {session.plan.pull_off_force * 1e9:.2f} nN)"
)
print(f"felt at the hand       {-felt.min():.3f} N")
print(f"f_m - alpha_f f_s RMS  {np.sqrt(np.mean(error**2)):.4f} N at rest")
print(f"steps                  {len(recording)}")
