# SPDX-License-Identifier: BSD-3-Clause
"""The force of a scene with adhesion whose sample deforms under the tail of that adhesion: apart by
:class:`nanotouch.reference.Deformation`, from far away to the fold of the tail; in contact Maugis-Dugdale. It shares no
code with plans.

Where the tail jumps before adhesion takes hold, contact has all of w and no tail. Where it does not, the force goes on
into contact, as with rigid bodies: it stays there, and what the tail pulls is taken out of w (erratum E5b).

Laws that are no tail, as a double layer, press on the sample around the contact, too: contact and laws are solved
together (`_surrounded`), with all of w; it takes hold where the gap under the apex is that of adhesion, or in a jump.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import contact as contacts
from nanotouch import forces as laws
from nanotouch._arrays import Floats, as_floats
from nanotouch.reference._deformation import Deformation, Deformed
from nanotouch.reference._pressures import Pressure
from nanotouch.reference._scene import (
    History,
    _atomic_distance,
    _capture_gap,
    _contact,
    _has_meniscus,
    _less,
    _potential,
    _touch,
    _work,
)
from nanotouch.reference._soft_scene import _laws, _modulus
from nanotouch.reference._surrounded import Surrounded
from nanotouch.scene import Scene

_CLOSE = 1e-12
"""a minimum gap that is none [m]"""
_CLOSER = 0.8
"""steps of the gap under the apex on the way to a jump"""
_FAR = 60.0
"""times the range of adhesion: no sample bulges there"""


@dataclass
class DeformedScene:
    """A scene with adhesion, its branches and its folds."""

    scene: Scene
    capture_gap: float
    """where the surface jumps or adhesion takes hold [m]"""
    jumps: bool
    """by a fold of the tail"""
    contact: contacts.Contact
    """that acts then"""
    apart: Deformation
    shift: float
    """of the gap to the poles of the tail [m]"""
    kept: float
    """force of the tail that stays in contact [N]"""
    surrounded: Surrounded | None = None
    """contact with the laws around it, where there are such"""

    def force(self, gap: ArrayLike, history: History = "approach") -> Floats:
        """On the tip [N], at gaps [m] in falling order, each reached from far away or from contact."""
        gaps = as_floats(gap, "gap")
        if self.surrounded is not None and self.surrounded.release is not None:
            edge = self.capture_gap if history == "approach" else self.surrounded.release.gap
            return np.array(
                [self.surrounded.at(g).force if g <= edge else self.apart.at(g + self.shift).force for g in gaps]
            )
        held = _touch(self.scene, gaps, self.contact, self.capture_gap, history)
        attached = (gaps <= self.capture_gap) | (held != 0.0)
        return np.array([self._around(g, bool(on)) for g, on in zip(gaps, attached, strict=True)]) + held

    def _around(self, gap: float, attached: bool) -> float:
        if attached and self.jumps:
            return float(_others(self.scene, np.array([gap]))[0])
        if gap <= self.capture_gap:
            return self.kept + float(_others(self.scene, np.array([gap]))[0])
        return self.apart.at(gap + self.shift).force


def deformed_scene(scene: Scene, tolerance: float = 1e-6) -> DeformedScene:
    """Finds where the surface jumps, from far away inwards."""
    whole = _contact(scene, _work(scene))
    range_of_adhesion = _capture_gap(scene, whole)
    shift = _atomic_distance(scene) + 0.5 * scene.sample.roughness
    modulus, _ = _modulus(scene)
    law = _pressure(scene, shift)

    def apart() -> Deformation:
        return Deformation(law, scene.tip.radius, modulus, tolerance=tolerance)

    if _beside(scene):
        return _surrounded_scene(scene, whole, apart, shift)
    jump = _jump(apart(), shift, range_of_adhesion, scene)
    if jump is not None:
        return DeformedScene(scene, jump.gap - shift, True, whole, apart(), shift, 0.0)
    kept = apart().at(range_of_adhesion + shift).force
    tail = kept - float(_others(scene, np.array([range_of_adhesion]))[0])
    left = _less(whole, -tail / (2.0 * np.pi * whole.radius))
    return DeformedScene(scene, range_of_adhesion, False, left, apart(), shift, tail)


def _surrounded_scene(
    scene: Scene, whole: contacts.Contact, apart: Callable[[], Deformation], shift: float
) -> DeformedScene:
    """Contact and the laws around it, as one."""
    assert whole.cohesive_stress is not None
    end_gap, per_area = whole.work_of_adhesion / whole.cohesive_stress, 2.0 * np.pi * scene.tip.radius
    further, beside = _atomic_distance(scene) - end_gap, _beside(scene)

    def pressure(g: Floats) -> Floats:
        return np.asarray(sum(law(np.maximum(g, end_gap) + further).k for law in beside) / per_area)

    def energy(g: Floats) -> Floats:
        return np.asarray(sum(law(np.maximum(g, end_gap) + further).F for law in beside) / per_area)

    law, modulus = Pressure(pressure, energy), whole.effective_modulus
    around = Surrounded(law, whole.radius, modulus, whole.work_of_adhesion, end_gap)
    jkr = (4.5 * np.pi * whole.work_of_adhesion * whole.radius**2 / whole.effective_modulus) ** (1.0 / 3.0)  # no load
    around.find_release(0.6 * jkr)
    captured = _centre_capture(apart(), end_gap + shift)
    return DeformedScene(scene, captured - shift, True, whole, apart(), shift, 0.0, around)


def _centre_capture(sample: Deformation, end_gap: float) -> float:
    """Coming from far away: where the gap of adhesion is left under the apex, or where the surface jumps before."""
    last = _FAR * max(end_gap, 1e-9)
    here = sample.at_centre(last)
    while last > end_gap:
        before, last = here, max(last * _CLOSER, end_gap)
        here = sample.at_centre(last)
        if here.gap > before.gap:
            return sample.jump_in(last, last / _CLOSER**2).gap
    return here.gap


def _jump(sample: Deformation, shift: float, nearest: float, scene: Scene) -> Deformed | None:
    """The fold, where it lies farther out than `nearest` [m]."""
    last = _FAR * max(nearest + shift, 1e-9)
    before = here = sample.at_centre(last)
    while here.gap - shift > nearest:
        before, last = here, last * _CLOSER
        here = sample.at_centre(last)
        if here.gap > before.gap:
            found = sample.jump_in(last, last / _CLOSER**2)
            return found if found.gap - shift > nearest else None
    return None


def _pressure(scene: Scene, shift: float) -> Pressure:
    """Of all laws, as rigid bodies have them, p = k/(2 pi R), over the gap and a shift."""
    per_area = 2.0 * np.pi * scene.tip.radius
    beside = _beside(scene)

    def sums(g: Floats) -> tuple[Floats, Floats]:
        tail = _tail(scene, g)
        found = [law(np.maximum(g - shift, _CLOSE)) for law in beside]
        return sum((law.k for law in found), tail.k), sum((law.F for law in found), tail.F)

    return Pressure(lambda g: sums(g)[0] / per_area, lambda g: sums(g)[1] / per_area, diverges=True)


def _tail(scene: Scene, distance: Floats) -> Any:
    """Of van der Waals, over the distance of the planes that attract."""
    tip, common = scene.tip, {"roughness": 0.0, "minimum_gap": _CLOSE}
    strength: dict[str, Any] = {"radius": tip.radius, "hamaker_constant": scene.adhesion.hamaker_constant}
    if tip.height > 0.0:
        return laws.vdw_tip(distance, half_angle=tip.half_angle, height=tip.height, **strength, **common)
    return laws.vdw(distance, **strength, **common)


def _beside(scene: Scene) -> list[Any]:
    """Laws that are no tail, without their hold; in a liquid those of soft scenes, else that of a potential."""
    bare = scene.copy()
    bare.adhesion.hamaker_constant = 0.0
    if scene.medium.kind == "liquid":
        return _laws(bare)
    potential = _potential(scene)
    if potential == 0.0 or _has_meniscus(scene):  # with a bridge the laws add
        return []
    tip, common = scene.tip, {"radius": scene.tip.radius, "potential": potential, "minimum_gap": _CLOSE}
    if tip.height > 0.0:
        return [lambda g: laws.electrostatic_tip(g, half_angle=tip.half_angle, height=tip.height, **common)]
    return [lambda g: laws.electrostatic(g, **common)]


def _others(scene: Scene, gaps: Floats) -> Floats:
    """What acts in contact beside adhesion, on the undeformed gap."""
    held = np.maximum(gaps, _atomic_distance(scene))
    return np.asarray(sum((law(held).F for law in _beside(scene)), np.zeros(gaps.shape)))
