# SPDX-License-Identifier: BSD-3-Clause
"""Which control law a session runs: one of ours by its name, or one's own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, get_args

from nanotouch import _core
from nanotouch.errors import InvalidValue
from nanotouch.scene import Settings

Control = Literal["default", "paper", "impedance"]
CONTROLS: tuple[Control, ...] = get_args(Control)
#: one's own law: from :class:`nanotouch._core.Signals` to motor force [N] and where the stage shall be [m]
ControlLaw = Callable[[_core.Signals], tuple[float, float]]


def choose_control(settings: Settings, control: str | ControlLaw) -> str:
    """The name of the law, which the settings then have too; ``"own"`` for a callable."""
    if callable(control):
        return "own"
    if control not in CONTROLS:
        raise InvalidValue(f"control {control!r}: valid are {', '.join(CONTROLS)} or a callable")
    if control != "default":  # else what the rig asks for
        _core.set_control(settings.core, control)
    return control
