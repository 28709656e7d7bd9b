# SPDX-License-Identifier: BSD-3-Clause
"""What a task must know of the world that is touched, in SI units, from the message that describes it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import nanotouch as nt
import numpy as np


@dataclass(frozen=True)
class Facts:
    """Numbers of one scene under one spring."""

    scene: nt.Scene
    load: float
    """the largest planned one [N]"""
    pull_off: float
    """of a flat [N]"""
    spring: float
    """that holds the tip: lever, and coupling to the hand where there is one [N/m]"""
    width: float
    """of the surface [m]"""
    accuracy: float = 0.01
    """that the session keeps: plans are made for it"""

    @classmethod
    def of(cls, world: Mapping[str, Any]) -> Facts:
        """From the world that a host tells."""
        scene = nt.Scene(**world["scene"])
        accuracy = float(world["relative_accuracy"])
        load, pull_off = float(scene.range.maximum_load), scene.plan(relative_accuracy=accuracy).pull_off_force
        return cls(scene, load, pull_off, float(world["stiffness"]), float(world["size"][0]), accuracy)

    def contact_stiffness(self, load: float, modulus_ratio: float = 1.0) -> float:
        """k_i = dF/d(indentation) of the contact under a load [N/m], the sample's modulus so many times as high."""
        scene = self.scene.copy()
        scene["sample.youngs_modulus"] = modulus_ratio * self.scene.sample.youngs_modulus
        plan = scene.plan(relative_accuracy=self.accuracy)
        deepest = 1.5 * float(plan.explain()["largest_indentation"])
        gaps = np.linspace(-deepest, 0.0, 4001)
        return float(np.interp(-load, -plan.force(gaps, "retract"), plan.run(gaps, "retract").k))

    def felt_stiffness(self, load: float, modulus_ratio: float = 1.0) -> float:
        """Of contact and spring, one after the other [N/m]: k_i k_c/(k_i + k_c)."""
        k = self.contact_stiffness(load, modulus_ratio)
        return k * self.spring / (k + self.spring)

    def felt_share(self, load: float) -> float:
        """d ln k/d ln E = 2/3 k_c/(k_c + k_i): what of a change of the modulus is felt, 2/3 at most (Hertz)."""
        return 2.0 / 3.0 * self.spring / (self.spring + self.contact_stiffness(load))
