# SPDX-License-Identifier: BSD-3-Clause
"""Scenes of the paper, ready to touch."""

from __future__ import annotations

from nanotouch.scene import Rig, Scene


def silicon_in_air() -> tuple[Scene, Rig]:
    """Silicon tip (20 nm, 8 N/m) on silicon in air of 40 % humidity: Fig. 9 and 17."""
    return Scene(), Rig()
