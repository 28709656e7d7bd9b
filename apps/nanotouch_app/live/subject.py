# SPDX-License-Identifier: BSD-3-Clause
"""What a person is to touch: a preset with its surface and what to try there, or what files say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import nanotouch as nt
from nanotouch.errors import InvalidValue
from nanotouch.manipulation import Rod, latex, nanowire

from nanotouch_app.common import scenes, surfaces

PRESETS = scenes.ROWS
RADIUS = 500e-9  # of the balls [m]


@dataclass(frozen=True)
class Subject:
    """A scene with its rig and surface."""

    name: str
    title: str
    scene: nt.Scene
    rig: nt.Rig
    topography: nt.Topography
    said: str = ""
    """what is said of its files, in a sentence"""
    hint: str = ""
    """what to try first"""
    surface: Callable[[nt.Scene], nt.Surface] | None = None
    """what the tip touches; None: the topography, dilated by it"""
    accuracy: float = 0.01
    """what its forces are planned for"""
    particles: Callable[[nt.Scene], nt.Particles] | None = None
    """that a task may lay there, and the tip of a scene pushes"""
    measured: tuple[tuple[float, float, float], ...] = ()
    """of a force curve: gap [m], measured and fitted force [N]"""
    rod: Callable[[nt.Scene], Rod] | None = None
    """the same of a rod, instead of particles"""

    def touched(self, scene: nt.Scene) -> nt.Surface:
        """The surface for the tip of a scene."""
        return nt.Surface.touched_by(scene, self.topography) if self.surface is None else self.surface(scene)


def balls(scene: nt.Scene) -> nt.Particles:
    """Of polystyrene, under the tip of a scene."""
    return nt.Particles(latex(RADIUS, float(scene.tip.radius), float(scene.tip.half_angle)))


def wire(scene: nt.Scene) -> Rod:
    """Of zinc oxide, under the tip of a scene."""
    return nanowire(tip_radius=float(scene.tip.radius), tip_half_angle=float(scene.tip.half_angle))


def of_preset(name: str) -> Subject:
    """A preset, its surface made."""
    if name not in PRESETS:
        raise InvalidValue(f"preset {name!r}: valid are {', '.join(PRESETS)}")
    row = PRESETS[name]
    scene, rig = scenes.of_preset(name)
    return Subject(name, row["title"], scene, rig, surfaces.of_scene(name), hint=row["hint"], accuracy=row["accuracy"],
                   particles=balls if row["pushed"] == "particles" else None,
                   rod=wire if row["pushed"] == "rod" else None)  # fmt: skip
