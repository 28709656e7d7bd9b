# SPDX-License-Identifier: BSD-3-Clause
"""What a person is to touch: a preset with its surface and what to try there, or what files say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import presets
from nanotouch.errors import InvalidValue
from nanotouch.manipulation import Rod, latex, nanowire
from nanotouch.touch import host

from nanotouch_app.common import surfaces
from nanotouch_app.live import samples

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
    rod: Callable[[nt.Scene], Rod] | None = None
    """the same of a rod, instead of particles"""

    def touched(self, scene: nt.Scene) -> nt.Surface:
        """The surface for the tip of a scene."""
        return nt.Surface.touched_by(scene, self.topography) if self.surface is None else self.surface(scene)


def soft_gold() -> tuple[nt.Scene, nt.Rig]:
    """A diamond tip on annealed gold, which yields and keeps dents; contact alone."""
    scene = nt.Scene(
        tip={"material": "diamond", "radius": 30e-9},
        sample={"material": "gold", "yield_strength": 0.35e9, "dents": "yes"},
        medium={"relative_humidity": 0.0},
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0, "contact_potential": 0.0},
        range={"maximum_load": 300e-9},
    )
    return scene, nt.Rig(probe={"spring_constant": 40.0, "resonance": 300e3})


def latex_on_glass(tip_radius: float = 50e-9) -> tuple[nt.Scene, nt.Rig]:
    """A coated tip on dry glass, for what a task lays there."""
    scene = nt.Scene(
        tip={"radius": tip_radius, "half_angle": 0.26},
        sample={"youngs_modulus": 70e9, "poisson_ratio": 0.22},
        medium={"relative_humidity": 0.0},
        adhesion={"work_of_adhesion": 0.01, "hamaker_constant": 3e-20},
        range={"maximum_load": 100e-9},
    )
    return scene, nt.Rig(probe={"spring_constant": 10.0})


def balls(scene: nt.Scene) -> nt.Particles:
    """Of polystyrene, under the tip of a scene."""
    return nt.Particles(latex(RADIUS, float(scene.tip.radius), float(scene.tip.half_angle)))


def wire(scene: nt.Scene) -> Rod:
    """Of zinc oxide, under the tip of a scene."""
    return nanowire(tip_radius=float(scene.tip.radius), tip_half_angle=float(scene.tip.half_angle))


def glass(width: float = 10e-6) -> nt.Topography:
    """So much of it, flat [m]."""
    return nt.Topography(heights=np.zeros((128, 128)), pixel_size=2 * (width / 128,), name="glass")


def polished() -> nt.Topography:
    """200 nm of it, flat."""
    return nt.Topography(heights=np.zeros((512, 512)), pixel_size=2 * (200e-9 / 512,), name="polished gold")


SURFACES: dict[str, Callable[[], nt.Topography]] = {
    **surfaces.OF_SCENE,
    "grating": lambda: nt.surface.grating(size=12e-6, pixels=384, height=100e-9),
    "spikes": lambda: nt.surface.spikes(pixels=256),
    "dna": samples.dna,
    "rough": samples.rough,
    "soft_gold": polished,
    "latex_on_glass": glass,
    "wire_on_glass": lambda: glass(6e-6),
}
SCENES: dict[str, Callable[[], tuple[nt.Scene, nt.Rig]]] = {
    "soft_gold": soft_gold,
    "latex_on_glass": latex_on_glass,
    "wire_on_glass": lambda: latex_on_glass(20e-9),
}
"""those that :mod:`nanotouch.scene.presets` does not have"""
PRESETS: dict[str, dict[str, Any]] = {row["name"]: row for row in host.presets()}
"""the list of the C library, as the page has it, too"""


def felt(name: str) -> str:
    """What the hand feels of a preset."""
    row = PRESETS[name]
    return str(row["felt"] or presets.FELT[row["scene"]])


def of_preset(name: str) -> Subject:
    """A preset, its surface made."""
    if name not in PRESETS:
        raise InvalidValue(f"preset {name!r}: valid are {', '.join(PRESETS)}")
    row = PRESETS[name]
    scene, rig = (SCENES.get(row["scene"]) or getattr(presets, row["scene"]))()
    return Subject(name, row["title"], scene, rig, SURFACES[name](), hint=row["hint"], accuracy=row["accuracy"],
                   particles=balls if row["pushed"] == "particles" else None,
                   rod=wire if row["pushed"] == "rod" else None)  # fmt: skip
