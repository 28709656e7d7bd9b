# SPDX-License-Identifier: BSD-3-Clause
"""What a person is to touch: a preset with its surface and what to try there, or what files say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import nanotouch as nt
import numpy as np
from nanotouch import presets
from nanotouch.manipulation import Rod, latex, nanowire

from nanotouch_app.common import surfaces
from nanotouch_app.live import samples
from nanotouch_app.training.push import RADIUS

LEAST_CLEARANCE = 20e-9  # [m]


@dataclass(frozen=True)
class Subject:
    """A scene with its rig and surface."""

    name: str
    title: str
    scene: nt.Scene
    rig: nt.Rig
    topography: nt.Topography
    felt: str = ""
    """what the hand feels, in a sentence"""
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

    def clearance(self) -> float:
        """Where the tip begins above the surface [m]: where it feels next to nothing."""
        plan = self.scene.plan(relative_accuracy=self.accuracy)
        facts = plan.explain()
        reach = plan.cutoff_gap(0.002 * max(float(self.scene.range.maximum_load), plan.pull_off_force))
        release = float(facts["release_gap"])
        return float(max(LEAST_CLEARANCE, 1.5 * min(reach, 1e-6), 2.0 * release if np.isfinite(release) else 0.0))


@dataclass(frozen=True)
class Preset:
    """Beside a scene of :mod:`nanotouch.scene.presets`: where it lies, and what to try."""

    title: str
    surface: Callable[[], nt.Topography]
    hint: str
    scene: str = ""
    """of :mod:`nanotouch.scene.presets`; "": that of its own name"""
    made: Callable[[], tuple[nt.Scene, nt.Rig]] | None = None
    """a scene and rig of its own; None: a preset"""
    felt: str = ""
    """what the hand feels, of a scene of its own"""
    accuracy: float = 0.01
    """of its forces: where a slider leads to what is less well known, a little less is asked"""
    particles: Callable[[nt.Scene], nt.Particles] | None = None
    """that a task may lay there"""
    rod: Callable[[nt.Scene], Rod] | None = None
    """the same of a rod, instead of particles"""


def felt(name: str) -> str:
    """What the hand feels of a preset."""
    known = WINDOW_PRESETS[name]
    return known.felt or presets.FELT[known.scene or name]


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


PRESETS: dict[str, Preset] = {
    "silicon_in_air": Preset(
        "Silicon in air", surfaces.OF_SCENE["silicon_in_air"],
        "Scroll down until the water snaps, then pull up until it tears. Then set the humidity to 0.",
    ),
    "silicon_on_gold": Preset(
        "Silicon on gold", surfaces.OF_SCENE["silicon_on_gold"],
        "Follow a terrace at a steady force and feel its edge.",
    ),
    "mica_in_air": Preset(
        "Mica in dry air", surfaces.OF_SCENE["mica_in_air"],
        "The soft lever jumps in before it touches: go down by single steps and watch its line meet the curve.",
        accuracy=0.03,
    ),
    "polyester": Preset(
        "Polyester", surfaces.OF_SCENE["polyester"],
        "Press, then let go slowly: the way out is not the way in.",
    ),
    "silicone_rubber": Preset(
        "Silicone rubber", surfaces.OF_SCENE["silicone_rubber"],
        "Press deep, then pull: the rubber stretches into a neck before it lets go.",
    ),
    "polystyrene_ball": Preset(
        "Polystyrene ball on glass", surfaces.OF_SCENE["polystyrene_ball"],
        "Press, then draw it sideways: it sticks, and then slips.",
    ),
    "inas_dots": Preset(
        "Quantum dots", surfaces.OF_SCENE["inas_dots"],
        "Find a dot with the lightest touch that you can hold.",
    ),
    "grating": Preset(
        "Calibration grating", lambda: nt.surface.grating(size=12e-6, pixels=384, height=100e-9),
        "Draw the tip along x: the walls are felt before they are seen.", "silicon_in_air",
    ),
    "spikes": Preset(
        "Field of spikes", samples.spikes, "Go over a spike: what you feel is the shape of your own tip.",
        "silicon_in_air",
    ),
    "dna": Preset(
        "DNA on mica", samples.dna, "Find the strand and follow it with the lightest touch.", "mica_in_air",
        accuracy=0.02,
    ),
    "rough": Preset(
        "Rough film", samples.rough, "Pull off on a hill and in a hollow: the pull differs.", "silicon_in_air",
    ),
    "soft_gold": Preset(
        "Soft gold", polished,
        "Press hard, then let go: a dent stays. Press and draw the tip sideways: a groove. Z takes it back.",
        made=soft_gold, felt="It gives way for good: the way out is steeper than the way in.",
    ),
    "latex_on_glass": Preset(
        "Glass for latex balls", glass, "T: push a ball into its ring, or five into a pattern.", made=latex_on_glass,
        felt="Smooth and hard; a ball resists until it rolls, and clicks when the tip touches or loses it.",
        particles=balls,
    ),
    "cell_in_liquid": Preset(
        "A living cell", surfaces.OF_SCENE["cell_in_liquid"],
        "Nothing snaps: feel the fur first, then the cell. Press on the nucleus, then on the rim.",
    ),
}  # fmt: skip

WINDOW_PRESETS = {
    **PRESETS,
    "wire_on_glass": Preset(
        "Glass for a nanowire",
        lambda: glass(6e-6),
        "T: push a wire of zinc oxide into a place, and to an angle.",
        made=lambda: latex_on_glass(20e-9),
        rod=wire,
        felt="Smooth and hard; a wire resists as it slides. Pushed near an end it turns, and resists less.",
    ),
}
"""and those that the window alone can lay: the page in a browser has no rods"""


def of_preset(name: str) -> Subject:
    """A preset, its surface made."""
    known = WINDOW_PRESETS[name]
    of = known.scene or name
    scene, rig = (known.made or getattr(presets, of))()
    return Subject(name, known.title, scene, rig, known.surface(), felt(name), known.hint,
                   accuracy=known.accuracy, particles=known.particles, rod=known.rod)  # fmt: skip
