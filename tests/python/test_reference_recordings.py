# SPDX-License-Identifier: BSD-3-Clause
"""Sessions with explicit seeds against recordings made before the session was rebuilt: the same behaviour. How the
reference was made: tests/reference/recordings.py."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

REFERENCE = Path(__file__).parent.parent / "reference"
spec = importlib.util.spec_from_file_location("recordings", REFERENCE / "recordings.py")
assert spec is not None
assert spec.loader is not None
recordings = importlib.util.module_from_spec(spec)
sys.modules["recordings"] = recordings
spec.loader.exec_module(recordings)

#: rounding differs from one libm to another, and a step of a converter may fall the other way
SHARE = 1e-3


@pytest.mark.filterwarnings("ignore:the session was stopped")
@pytest.mark.parametrize("name", recordings.SESSIONS)
def test_a_session_is_what_it_was(name: str) -> None:
    columns = recordings.SESSIONS[name]()
    with np.load(REFERENCE / "recordings.npz") as reference:
        known = [key.split("/")[1] for key in reference.files if key.startswith(f"{name}/") and key.count("/") == 1]
        differ = [
            column for column in known if recordings.digest(columns[column]) != reference[f"{name}/{column}/digest"]
        ]
        for column in known:
            then, now = reference[f"{name}/{column}"], columns[column][:: recordings.STRIDE]
            scale = float(np.nanmax(np.abs(then))) if then.size else 0.0
            np.testing.assert_allclose(now, then, rtol=0.0, atol=SHARE * scale, err_msg=column)
    if differ:  # on another machine; here a change of bits is a change of behaviour
        print(f"{name}: other bits in {', '.join(differ)}")
