# SPDX-License-Identifier: BSD-3-Clause
"""The channels of a recording: name, type, unit and meaning."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nanotouch.errors import InvalidValue


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
    "master_age": Column("<f8", "s", "of the master's reading when it was used"),
    "lateness": Column("<f8", "s", "of the tick against its deadline"),
    "flags": Column("<u4", "", "bits that the rig has set: 1 emergency stop, 2 limit switch, 4 invalid, 8, 16 lost"),
    "gap": Column("<f8", "m", "simulated truth: h = z_t - z_s of the undeformed bodies"),
    "tip_force": Column("<f8", "N", "simulated truth: force on the tip, + repulsive"),
    "contact_radius": Column("<f8", "m", "simulated truth: radius of the contact, 0 when apart"),
    "surface_height": Column("<f8", "m", "simulated truth: tip-dilated surface under the tip"),
    "master_x": Column("<f8", "m", "lateral position of a master of three axes, to the right"),
    "master_y": Column("<f8", "m", "lateral position of a master of three axes, up the image"),
    "operator_force_x": Column("<f8", "N", "f_m sideways as measured"),
    "operator_force_y": Column("<f8", "N", "f_m sideways as measured"),
    "motor_force_x": Column("<f8", "N", "tau_m sideways"),
    "motor_force_y": Column("<f8", "N", "tau_m sideways"),
    "tip_force_x": Column("<f8", "N", "simulated truth: force on the tip, to the right"),
    "tip_force_y": Column("<f8", "N", "simulated truth: force on the tip, up the image"),
    "deflection_x": Column("<f8", "m", "of a lever that gives way sideways, at the tip, to the right"),
    "deflection_y": Column("<f8", "m", "of a lever that gives way sideways, at the tip, up the image"),
    "amplitude": Column("<f8", "m", "of a lever that taps, at the drive's frequency, as measured"),
    "lag": Column("<f8", "rad", "of a lever that taps, of the deflection behind the drive, as measured"),
}


def checked(columns: Mapping[str, ArrayLike]) -> dict[str, NDArray[Any]]:
    """The columns in the order and type of COLUMNS, or the first thing that is wrong with them."""
    unknown = set(columns) - set(COLUMNS)
    if unknown:
        raise InvalidValue(f"unknown column {min(unknown)!r}; a recording has: {', '.join(COLUMNS)}")
    if "time" not in columns:
        raise InvalidValue("a recording needs the column 'time' [s]")
    arrays = {name: _converted(name, columns[name]) for name in COLUMNS if name in columns}
    rows = len(arrays["time"])
    for name, values in arrays.items():
        if len(values) != rows:
            raise InvalidValue(f"column {name!r} has {len(values)} rows, 'time' has {rows}")
    return arrays


def _converted(name: str, values: ArrayLike) -> NDArray[Any]:
    if hasattr(values, "units") or hasattr(values, "unit"):
        raise InvalidValue(f"column {name!r} carries a unit; convert it to {COLUMNS[name].unit or 'a number'}")
    array = np.asarray(values)
    if array.ndim != 1 or array.dtype.kind not in "fiub" or isinstance(values, np.ma.MaskedArray):
        raise InvalidValue(f"column {name!r} must be an unmasked array of real numbers with one dimension")
    with np.errstate(invalid="ignore"):  # NaN in an integer column: caught by the comparison
        converted = np.ascontiguousarray(array, dtype=COLUMNS[name].dtype)
    if converted.dtype.kind == "u" and not np.array_equal(converted, array):
        raise InvalidValue(f"column {name!r} must hold integers from 0 to {np.iinfo(converted.dtype).max}")
    return converted


TAPPING = ("amplitude", "lag")
"""columns of a session in mode tapping, and of no other"""

SIDEWAYS = tuple(name for name in COLUMNS if name.endswith(("_x", "_y")))
"""columns of a rig whose master has more than one axis or whose lever gives way sideways, and of no other"""
