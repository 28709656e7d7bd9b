# SPDX-License-Identifier: BSD-3-Clause
"""Push a rod to a place and to an angle: each of its ends into a ring."""

from __future__ import annotations

from typing import Any

import numpy as np
from nanotouch.manipulation import Laid, nanowire

from nanotouch_app.training.push import Floats, Push
from nanotouch_app.training.task_texts import TEXTS

START = (0.5, 0.4, 0.0)  # of its middle, over the width; angle [rad]
TARGET = (0.5, 0.5, 0.4)


class Wire(Push):
    """Places are those of its two ends: which end lies in which ring does not matter."""

    name, title, preset = "wire", TEXTS["wire.title"], "wire_on_glass"
    pushes, says, radius = "rod", "wire", nanowire().radius
    length = nanowire().length

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        width = self.facts.width
        self.pose = np.array([START[0] * width, START[1] * width, START[2]])
        self.lays, self.count, self.least = self.pose[None], 1, 2  # across, and round
        self.goals = self._ends(np.array([TARGET[0] * width, TARGET[1] * width, TARGET[2]]))[:, :2]
        self.places = self._ends(self.pose)

    def _ends(self, pose: Floats) -> Floats:
        x, y, angle = pose
        half = 0.5 * self.length * np.array([np.cos(angle), np.sin(angle), 0.0])
        middle = np.array([x, y, self.radius])
        return np.stack([middle - half, middle + half])

    def take(self, laid: Laid) -> None:
        """What the session says of it."""
        super().take(laid)
        self.pose = np.array([*laid.positions[0, :2], laid.angles[0]])
        self.places = self._ends(self.pose)

    @property
    def shown(self) -> dict[str, Any]:
        """What a picture needs."""
        middle = [[float(self.pose[0]), float(self.pose[1]), self.radius]]
        return super().shown | {"radius": self.radius, "places": middle, "length": self.length,
                                "angles": [float(self.pose[2])]}  # fmt: skip
