# SPDX-License-Identifier: BSD-3-Clause
"""The force of a scene with every term on and exact, composed in Python from the laws of :mod:`nanotouch.contact`,
:mod:`nanotouch.contact.geometry` and :mod:`nanotouch.forces` by the rules of docs/interaction.md; it
shares no code with plans, but for laws that are in no other place."""

from __future__ import annotations

import dataclasses
import functools
from collections import namedtuple
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import contact as contacts
from nanotouch import forces as laws
from nanotouch._arrays import Floats, as_floats, plain
from nanotouch.contact import geometry
from nanotouch.errors import InvalidValue
from nanotouch.scene import Scene
from nanotouch.scene.plan import ROWS, Plan

History = Literal["approach", "retract"]


#: The terms of a scene at gaps, by the names of the library's laws; each an array [N], 0 where the scene has none such.
SceneForces: Any = namedtuple("SceneForces", [row.name for row in ROWS])  # type: ignore[misc]


def force(scene: Scene, gap: ArrayLike, *, history: History = "approach", radius: float | None = None) -> Any:
    """Force on the tip [N] at gaps [m], each reached from far away (``"approach"``) or from contact (``"retract"``).

    With a ``radius`` [m]: over a place of that effective radius, where contact has it in place of the tip's own and all
    beside contact is proportional to it.
    """
    return plain(np.sum(forces(scene, gap, history=history, radius=radius), axis=0))


def forces(scene: Scene, gap: ArrayLike, *, history: History = "approach", radius: float | None = None) -> SceneForces:
    """The same, term by term."""
    if history not in get_args(History):
        raise InvalidValue(f"history {history!r}: valid are {', '.join(get_args(History))}")
    scene.check()
    return _forces(scene, _work(scene), as_floats(gap, "gap"), history, radius)


def _forces(scene: Scene, work: float, gaps: Floats, history: History, radius: float | None) -> SceneForces:
    whole = _contact(scene, work)
    capture = _capture_gap(scene, whole)
    tail = functools.partial(_vdw, scene, hold=max(capture, 1e-12))
    pulled = -float(tail(0.0)) / (2.0 * np.pi * whole.radius) if whole.work_of_adhesion > 0.0 else 0.0
    left = _less(whole, pulled)
    if radius is not None:
        left = _on_curved(scene, left, radius)
    ratio = left.radius / whole.radius
    terms = {"contact": _touch(scene, gaps, left, capture, history), "vdw": ratio * np.asarray(tail(gaps))}
    for row in ROWS[len(terms) :]:
        law = _BESIDE.get(row.name) or functools.partial(_custom if row.name in _CUSTOM else _planned, row.name)
        terms[row.name] = ratio * np.asarray(law(scene, gaps))
    return SceneForces(**terms)


# ---- contact ----


def _has_meniscus(scene: Scene) -> bool:
    medium = scene.medium
    return bool(medium.kind == "air" and medium.relative_humidity > 0.0 and medium.surface_tension > 0.0)


def _meniscus_radius(scene: Scene) -> float:
    medium = scene.medium
    return float(medium.meniscus_radius) or laws.kelvin_radius(
        medium.relative_humidity,
        surface_tension=medium.surface_tension,
        molar_volume=medium.molar_volume,
        temperature=medium.temperature,
    )


def _least_work(scene: Scene) -> float:
    """w of the solids; of a measured pull-off force, that of rigid bodies [J/m2]."""
    adhesion = scene.adhesion
    if adhesion.given == "pull_off_force":
        return float(adhesion.pull_off_force / (2.0 * np.pi * scene.tip.radius))
    return _work(scene)


def _atomic_distance(scene: Scene) -> float:
    """z0, or the distance, up to a nanometre, at which van der Waals alone would be all of w, of which it is a part."""
    given, hamaker = float(scene.adhesion.equilibrium_distance), scene.adhesion.hamaker_constant
    if _has_meniscus(scene) or scene.tip.shape in ("cone", "punch") or hamaker == 0.0:
        return given
    work = _least_work(scene)
    all_of_it = np.sqrt(hamaker / (12.0 * np.pi * work)) - 0.5 * scene.sample.roughness if work > 0.0 else np.inf
    return float(all_of_it) if given < all_of_it <= 1e-9 else given


def _contact(scene: Scene, work: float) -> contacts.Contact:
    """R, E*, all of w, and its stress."""
    modulus = contacts.effective_modulus(
        scene.tip.youngs_modulus, scene.tip.poisson_ratio, scene.sample.youngs_modulus, scene.sample.poisson_ratio
    )
    if work == 0.0:
        return contacts.Contact(scene.tip.radius, modulus)
    if _has_meniscus(scene):  # the stress is the Laplace pressure over 2 r1 (E12)
        return contacts.Contact(scene.tip.radius, modulus, work, work / (2.0 * _meniscus_radius(scene)))
    stress = contacts.cohesive_stress_atomic(work, _atomic_distance(scene))
    return contacts.Contact(scene.tip.radius, modulus, work, stress)


def _work(scene: Scene) -> float:
    """All of w."""
    adhesion = scene.adhesion
    if adhesion.given == "pull_off_force":
        if adhesion.pull_off_force == 0.0 and not _has_meniscus(scene):
            return 0.0
        return _work_by_pull_off(_Frozen(scene))
    if _has_meniscus(scene):
        return 2.0 * float(scene.medium.surface_tension)
    if adhesion.given == "surface_energies":
        return 2.0 * float(np.sqrt(adhesion.tip_surface_energy * adhesion.sample_surface_energy))
    return float(adhesion.work_of_adhesion)


@functools.lru_cache(maxsize=16)
def _work_by_pull_off(frozen: _Frozen) -> float:
    """The w with which the whole scene pulls off with the measured force."""
    from scipy.optimize import brentq

    scene = frozen.scene

    def excess(log_work: float) -> float:
        try:
            return float(_pull_off(scene, float(np.exp(log_work))) / scene.adhesion.pull_off_force - 1.0)
        except InvalidValue:  # the tail leaves nothing of w
            return -1.0

    return float(np.exp(brentq(excess, np.log(1e-12), np.log(1e2), xtol=1e-15, rtol=1e-15)))


def _pull_off(scene: Scene, work: float) -> float:
    """Largest attraction of the whole on the way out: on a grid of gaps, then between the neighbours of its best."""
    near = np.geomspace(1e-15, 0.1, 800)  # [m]
    gaps = np.concatenate([-near[::-1], [0.0], near])
    for _ in range(12):
        total = np.sum(_forces(scene, work, gaps, "retract", None), axis=0)
        best = int(np.argmin(total))
        gaps = np.linspace(gaps[max(best - 1, 0)], gaps[min(best + 1, len(gaps) - 1)], 41)
    return -float(total[best])


def _shape(scene: Scene) -> geometry.Shape:
    tip = scene.tip
    sizes: dict[str, Any] = {}
    if tip.shape != "cone":
        sizes["radius"] = tip.radius
    if tip.shape in ("cone", "blunted", "truncated"):
        sizes |= {"half_angle": tip.half_angle, "sides": int(tip.sides)}
    return geometry.Shape(tip.shape, **sizes)


def _is_jkr(scene: Scene) -> bool:
    return scene.tip.shape in ("cone", "punch")


def _less(contact: contacts.Contact, pulled: float) -> contacts.Contact:
    """What the tail leaves of w, over the same range (E5b)."""
    w = contact.work_of_adhesion
    if w == 0.0 or pulled == 0.0:
        return contact
    if pulled >= w:
        raise InvalidValue(
            f"adhesion.hamaker_constant: the tail alone pulls as much as w = {pulled:g} J/m2 would, of {w:g} J/m2"
        )
    assert contact.cohesive_stress is not None
    left = w - pulled
    return contacts.Contact(contact.radius, contact.effective_modulus, left, left * contact.cohesive_stress / w)


def _on_curved(scene: Scene, contact: contacts.Contact, radius: float) -> contacts.Contact:
    """The same surfaces and stress over a place of another effective radius."""
    if _is_jkr(scene) or (contact.work_of_adhesion == 0.0 and scene.tip.shape != "paraboloid"):
        raise InvalidValue(f"tip.shape = {scene.tip.shape}: its contact law has no effective radius")
    return dataclasses.replace(contact, radius=radius)


def _capture_gap(scene: Scene, contact: contacts.Contact) -> float:
    """Where adhesion takes hold on approach."""
    if contact.work_of_adhesion == 0.0 or _is_jkr(scene):
        return 0.0
    assert contact.cohesive_stress is not None
    reach = contact.work_of_adhesion / contact.cohesive_stress
    return min(2.0 * scene.medium.film_thickness, reach) if _has_meniscus(scene) else reach


def _touch(scene: Scene, gaps: Floats, contact: contacts.Contact, capture: float, history: History) -> Floats:
    """The contact law where it has been captured and holds."""
    if contact.work_of_adhesion == 0.0:
        shape = (
            _shape(scene) if scene.tip.shape != "paraboloid" else geometry.Shape("paraboloid", radius=contact.radius)
        )
        return np.asarray(geometry.evaluate(shape, -gaps, contact.effective_modulus).F)
    if _is_jkr(scene):
        branch = geometry.jkr(
            _shape(scene), -gaps, contact.effective_modulus, work_of_adhesion=contact.work_of_adhesion
        )
    else:
        branch = contacts.evaluate("maugis", -gaps, contact)
    held = np.asarray(branch.F)
    return held if history == "retract" else np.where(gaps <= capture, held, 0.0)


# ---- beside contact ----


def _vdw(scene: Scene, gaps: ArrayLike, hold: float) -> Any:
    tip, adhesion = scene.tip, scene.adhesion
    if adhesion.hamaker_constant == 0.0 or _is_jkr(scene):
        return np.zeros(np.shape(gaps))
    common: dict[str, Any] = {
        "radius": tip.radius,
        "hamaker_constant": adhesion.hamaker_constant,
        "roughness": scene.sample.roughness + 2.0 * _atomic_distance(scene),
        "minimum_gap": hold,
    }
    if tip.height > 0.0:
        return laws.vdw_tip(gaps, half_angle=tip.half_angle, height=tip.height, **common).F
    return laws.vdw(gaps, **common).F


def _potential(scene: Scene) -> float:
    """Between bodies that conduct and are connected [V]."""
    tip, sample = scene.tip, scene.sample
    connected = tip.conducting == "yes" and sample.conducting == "yes" and sample.grounded == "yes"
    if not connected or scene.medium.kind == "liquid":
        return 0.0
    known = tip.work_function > 0.0 and sample.work_function > 0.0
    return float(scene.adhesion.contact_potential + (tip.work_function - sample.work_function if known else 0.0))


def _electrostatic(scene: Scene, gaps: Floats) -> Any:
    tip, potential = scene.tip, _potential(scene)
    if potential == 0.0:
        return np.zeros(gaps.shape)
    common: dict[str, Any] = {
        "radius": tip.radius, "potential": potential, "minimum_gap": _atomic_distance(scene),
    }  # fmt: skip
    if tip.height > 0.0:
        return laws.electrostatic_tip(gaps, half_angle=tip.half_angle, height=tip.height, **common).F
    return laws.electrostatic(gaps, **common).F


def _charge(scene: Scene, gaps: Floats) -> Any:
    if scene.tip.conducting == "no" or scene.medium.kind == "liquid":
        return np.zeros(gaps.shape)
    return laws.point_charge(
        gaps,
        radius=scene.tip.radius,
        charge=scene.sample.charge,
        minimum_gap=_atomic_distance(scene),
    ).F


def _double_layer(scene: Scene, gaps: Floats) -> Any:
    medium = scene.medium
    if medium.kind != "liquid" or medium.ionic_strength == 0.0:
        return np.zeros(gaps.shape)

    def potential(body: Any) -> float:
        if medium.ph > 0.0:
            return float(medium.potential_per_ph * (body.isoelectric_point - medium.ph))
        return float(body.surface_potential)

    return laws.double_layer(
        gaps,
        radius=scene.tip.radius,
        debye_length=laws.debye_length(
            medium.ionic_strength,
            relative_permittivity=medium.relative_permittivity,
            temperature=medium.temperature,
        ),
        tip_potential=potential(scene.tip),
        sample_potential=potential(scene.sample),
        relative_permittivity=medium.relative_permittivity,
        minimum_gap=_atomic_distance(scene),
    ).F


def _hydration(scene: Scene, gaps: Floats) -> Any:
    medium = scene.medium
    if medium.kind != "liquid":
        return np.zeros(gaps.shape)
    return laws.hydration(
        gaps,
        radius=scene.tip.radius,
        amplitude=medium.hydration_energy,
        decay_length=medium.hydration_length,
        minimum_gap=_atomic_distance(scene),
    ).F


def _steric(scene: Scene, gaps: Floats) -> Any:
    medium, hold = scene.medium, _atomic_distance(scene)
    if medium.kind != "liquid" or medium.brush_thickness <= hold:
        return np.zeros(gaps.shape)
    return laws.steric(
        gaps,
        radius=scene.tip.radius,
        thickness=medium.brush_thickness,
        spacing=medium.brush_spacing,
        temperature=medium.temperature,
        minimum_gap=hold,
    ).F


_BESIDE = {
    "electrostatic": _electrostatic,
    "charge": _charge,
    "double_layer": _double_layer,
    "hydration": _hydration,
    "steric": _steric,
}


_CUSTOM = [row.name for row in ROWS if row.name.startswith("custom_")]


def _custom(place: str, scene: Scene, gaps: Floats) -> Any:
    """A law of one's own, by its own function."""
    names = list(scene.terms)
    if _CUSTOM.index(place) >= len(names):
        return np.zeros(gaps.shape)
    held = np.maximum(gaps, _atomic_distance(scene))
    return np.vectorize(functools.partial(scene.term_force, names[_CUSTOM.index(place)]), otypes=[float])(held)


def _planned(name: str, scene: Scene, gaps: Floats) -> Any:
    """A law that has no second source here: the library's own, in full; its own test has the second source."""
    return _full_plan(_Frozen(scene)).law(name, gaps).F


@functools.lru_cache(maxsize=16)
def _full_plan(frozen: _Frozen) -> Plan:
    return frozen.scene.plan(bound="exact")


class _Frozen:
    """A scene that a cache can know again, by its fields and its laws of one's own."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene.copy()

    def __hash__(self) -> int:
        return hash(tuple(self.scene.values()))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Frozen) and self.scene == other.scene
