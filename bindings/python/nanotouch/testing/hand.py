# SPDX-License-Identifier: BSD-3-Clause
"""A hand that follows a script."""

from __future__ import annotations

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
    return [Input(force, x, y, duration) for force, duration in steps]
