# SPDX-License-Identifier: BSD-3-Clause
"""What a session passes on to its simulated rig."""

from __future__ import annotations

from typing import Any, Literal, get_args

from nanotouch._arrays import check_between
from nanotouch.errors import InvalidValue
from nanotouch.touch.faults import Faults

ProbeModel = Literal["auto", "quasi-static", "dynamic"]
PROBE_MODELS: tuple[ProbeModel, ...] = get_args(ProbeModel)


def plant_options(probe_model: ProbeModel, substep: float | None, faults: Faults | None) -> dict[str, Any]:
    """Checked, as the extension takes them; of the faults those from switching on."""
    if probe_model not in PROBE_MODELS:
        raise InvalidValue(f"probe_model {probe_model!r}: valid are {', '.join(PROBE_MODELS)}")
    if substep is not None:
        check_between("substep", substep, "rad", above=0.0, up_to=1e9)
    return {
        "probe_model": PROBE_MODELS.index(probe_model),
        "substep": substep or 0.0,  # 0: the usual one
        "faults": [fault.core for fault in faults or () if fault.at is None],
    }
