# SPDX-License-Identifier: BSD-3-Clause
"""A hand that follows a script."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nanotouch._arrays import as_number, check_between
from nanotouch._io.words import told
from nanotouch.errors import InvalidValue
from nanotouch.touch.operator import Input
from nanotouch.touch.session import Session


def scripted_hand(session: Session, *steps: tuple[float, float]) -> list[Input]:
    """What a hand does at the place where the session begins, for its ``run(operator=...)``: one step after another.

    Parameters
    ----------
    session : Session
        Whose place it is.
    *steps : (force, duration)
        The force goes to this one [N], + towards the sample, on a straight line within this time [s], above 0.
    """
    x, y = session.path[0]
    for step in steps:
        if not isinstance(step, Sequence | np.ndarray) or len(step) != 2:
            raise InvalidValue(f"step {told(step)}: expected (force [N], duration [s])")
        if not np.isfinite(as_number("force", step[0], "N")):
            raise InvalidValue(f"force = {step[0]} N: it must be finite")
        check_between("duration", step[1], "s", above=0.0)
    return [Input(force, x, y, duration) for force, duration in steps]
