# SPDX-License-Identifier: BSD-3-Clause
"""The channels of a recording: name, type, unit and meaning."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Column:
    """One channel of a recording: its NumPy type (little-endian), unit and meaning."""

    dtype: str
    unit: str
    doc: str


STATES = ("RUN", "HOLD", "RETRACT", "LATCHED")
"""of the column ``state``, by number"""

COLUMNS: dict[str, Column] = {
    "time": Column("<f8", "s", "time since the start"),
    "x": Column("<f8", "m", "lateral position of the tip, to the right"),
    "y": Column("<f8", "m", "lateral position of the tip, up the image"),
    "master_position": Column("<f8", "m", "x_m, + towards the sample"),
    "operator_force": Column("<f8", "N", "f_m as measured, + towards the sample"),
    "stage_position": Column("<f8", "m", "x_s as measured, travel towards the sample"),
    "stage_command": Column("<f8", "m", "x_s as commanded, travel towards the sample"),
    "deflection": Column("<f8", "m", "zeta as measured, + away from the sample"),
    "slave_force": Column("<f8", "N", "f_s = k_c zeta as measured, + repulsive"),
    "motor_force": Column("<f8", "N", "tau_m, + towards the sample"),
    "state": Column("|u1", "", "0 RUN, 1 HOLD, 2 RETRACT, 3 LATCHED"),
    "reasons": Column("<u4", "", "bits that explain the state"),
    "phase": Column("|u1", "", "of an approach or a curve: 0 down, 1 up, 2 done"),
    "age": Column("<f8", "s", "of the sample when it was used"),
    "lateness": Column("<f8", "s", "of the tick against its deadline"),
    "flags": Column("<u4", "", "bits that the rig has set: 1 emergency stop, 2 limit switch, 4 invalid, 8, 16 lost"),
    "gap": Column("<f8", "m", "simulated truth: h = z_t - z_s of the undeformed bodies"),
    "tip_force": Column("<f8", "N", "simulated truth: force on the tip, + repulsive"),
    "contact_radius": Column("<f8", "m", "simulated truth: radius of the contact, 0 when apart"),
    "surface_height": Column("<f8", "m", "simulated truth: tip-dilated surface under the tip"),
}
