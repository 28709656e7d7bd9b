# SPDX-License-Identifier: BSD-3-Clause
"""What a person is to touch: a preset with its surface and what to try there, or what files say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import nanotouch as nt
import numpy as np
from nanotouch import presets

from nanotouch_app import surfaces
from nanotouch_app.live import samples

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
    accuracy: float = 0.01
    """of its forces: where a slider leads to what is less well known, a little less is asked"""


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
    "cell_in_liquid": Preset(
        "A living cell", surfaces.OF_SCENE["cell_in_liquid"],
        "Nothing snaps: feel the fur first, then the cell. Press on the nucleus, then on the rim.",
    ),
}  # fmt: skip


def of_preset(name: str) -> Subject:
    """A preset, its surface made."""
    known = PRESETS[name]
    of = known.scene or name
    scene, rig = getattr(presets, of)()
    return Subject(name, known.title, scene, rig, known.surface(), presets.FELT[of], known.hint,
                   accuracy=known.accuracy)  # fmt: skip
