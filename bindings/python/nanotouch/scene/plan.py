# SPDX-License-Identifier: BSD-3-Clause
"""What is computed for a scene, and why: :class:`Plan`, made by :meth:`nanotouch.Scene.plan`."""

from __future__ import annotations

import copy
import math
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import LawValue, as_floats, as_law, plain
from nanotouch._io import html
from nanotouch.errors import InvalidValue
from nanotouch.scene import Demand, Rig, Scene
from nanotouch.scene._plan_terms import ROWS as ROWS
from nanotouch.scene._plan_terms import Pressure as Pressure
from nanotouch.scene._plan_terms import Row as Row
from nanotouch.scene._plan_terms import Term as Term
from nanotouch.scene._plan_terms import Warning as Warning
from nanotouch.scene._plan_text import contact_law_of, text_of

if TYPE_CHECKING:  # a plan over a flat loads no images
    from nanotouch.scene.surface import Surface

History = Literal["approach", "retract"]


class Relaxation(NamedTuple):
    """Whether time matters over a sample that relaxes, and with which moduli."""

    springs: int
    """that follow the contact in a session; 0: time does not matter, the contact is elastic"""
    arms: int
    """of each spring"""
    modulus: float
    """Young's modulus that the plan's own contact has: over one period, or the slow one [Pa]"""
    slow_modulus: float
    """at the end of ``range.duration`` [Pa]"""
    error: float
    """part of the bound: of springs and arms, or of leaving time out"""


class Plan:
    """What is computed for a scene, and why; see ``print(plan)``. Immutable."""

    def __init__(self, core: _core.Plan, made_from: tuple[Any, ...] | None = None) -> None:
        self.core = core
        self._facts: dict[str, Any] = core.as_dict()
        self._made_from = made_from

    @classmethod
    def make(
        cls, scene: Scene, demand: Demand | None = None, rig: Rig | None = None, surface: Surface | None = None
    ) -> Plan:
        """The cheapest plan that keeps a demand; see :meth:`nanotouch.Scene.plan`."""
        wanted = Demand() if demand is None else demand
        if not isinstance(rig, Rig | None):
            raise TypeError(f"rig must be a Rig, not {type(rig).__name__}")
        own = None if rig is None else rig.copy()
        with scene.naming_terms():
            terrain = make_terrain(scene, wanted, own, surface=surface)
        return cls(terrain.plan, (scene.copy(), wanted.copy(), own, surface))

    @property
    def terms(self) -> list[Term]:
        """The laws that are computed."""
        return [term for term in self._all_terms() if term.included]

    @property
    def omitted(self) -> list[Term]:
        """The laws that the scene has and the plan leaves out, with a bound each."""
        return [term for term in self._all_terms() if not term.included and term.force > 0.0]

    @property
    def friction(self) -> Term:
        """Friction of the contact: computed or not, its largest force, and its bound, which counts by itself: of the
        force sideways over max(\\|F\\|, scale)."""
        return Term(*self._facts["friction"])

    def _all_terms(self) -> list[Term]:
        return [Term(*term) for term in self._facts["terms"]]

    def refuse_history(self, what: str) -> None:
        """Raise `InvalidValue` where the force depends on what was done before: only a session computes that."""
        if self.relaxation is not None and self.relaxation.springs > 0:
            kind = self._made_from[0].plain("rheology.kind") if self._made_from else "not elastic"
            raise InvalidValue(
                f"rheology.kind = {kind}: {what} does not know a sample that relaxes; a Session does, and "
                "Rheology.force computes the curve of any history"
            )
        if self.core.dents:
            raise InvalidValue(f"sample.dents = yes: {what} does not know a sample that keeps dents; a Session does")

    @property
    def relaxation(self) -> Relaxation | None:
        """Of a sample that relaxes, whether time matters; None: the scene's does not."""
        of = self._facts["relaxation"]
        return None if of is None else Relaxation(*of)

    @property
    def bound(self) -> float:
        """Largest error of the demanded quantity over max(\\|it\\|, its scale), all terms together, at gaps that are
        farther than :attr:`fold_distance_m` from a fold and from first touch."""
        return float(self._facts["bound"])

    @property
    def quantity(self) -> str:
        """What is that accurate: ``"force"``, ``"stiffness"``, ``"radius"``, ``"folds"``."""
        return str(self._facts["quantity"])

    @property
    def scale(self) -> float:
        """What small values are compared with [N, N/m or m]: for a force max(pull-off force,
        force_floor/relative_accuracy), a thousandth of the largest load where nothing pulls."""
        return float(self._facts["scale"])

    @property
    def fold_shift_m(self) -> float:
        """How far the folds (jump-in, pull-off under grips) may be off, as a gap [m]."""
        return float(self._facts["fold_shift"])

    @property
    def fold_distance_m(self) -> float:
        """How far from a fold, and from the gap where contact begins with no radius, the bound holds [m]: nearer, force
        and radius change as the root of the distance and stiffness as its inverse root."""
        return float(self._facts["fold_distance"])

    @property
    def model_error(self) -> float:
        """What Maugis-Dugdale itself errs by beside Lennard-Jones; no part of :attr:`bound`; NaN where not known."""
        return float(self._facts["model_error"])

    @property
    def cost(self) -> float:
        """Of one evaluation in contact, in evaluations of Hertz' contact by the same path; where they do not wait for
        each other. The same on every machine: measured on one, and shipped."""
        return float(self._facts["cost"])

    @property
    def latency(self) -> float:
        """The same where each evaluation waits for the last, as in a loop."""
        return float(self._facts["latency"])

    @property
    def contact_law(self) -> str:
        """The law of contact in words, such as ``"Maugis-Dugdale table"``; ``"none"`` where there is no contact."""
        return contact_law_of(self._all_terms()[0])

    @property
    def maugis_lambda(self) -> float:
        """Maugis' parameter of the contact; infinite without adhesion or without its range."""
        return float(self._facts["lambda"])

    @property
    def pull_off_force(self) -> float:
        """Pull-off force under load control, everything on, a positive magnitude [N]."""
        return float(self._facts["pull_off_force"])

    @property
    def minimum_spring(self) -> float:
        """The softest spring that does not jump in [N/m]; infinite where the force itself jumps."""
        return float(self._facts["minimum_spring"])

    @property
    def maximum_stiffness(self) -> float:
        """Stiffness of the contact at the largest load [N/m]."""
        return float(self._facts["maximum_stiffness"])

    @property
    def warnings(self) -> list[Warning]:
        """What the bound does not cover: laws outside their validity, descriptions that disagree, losses."""
        return [Warning(*warning) for warning in self._facts["warnings"]]

    def law(self, term: str, gap: ArrayLike) -> LawValue:
        """One law of the scene alone, in full, whether the plan has it or not, at gaps [m]; of contact what holds on
        the way out, NaN beyond its fold."""
        return as_law(self.core.term_eval(self._number_of(term), as_floats(gap, "gap")))

    def pressure(self, term: str, gap: ArrayLike) -> Pressure:
        """Two flats at gaps above 0 [m] under one law of the scene; NaN for contact and for laws that flats do not
        have."""
        gaps = as_floats(gap, "gap")
        return Pressure(*(plain(column) for column in self.core.term_pressure(self._number_of(term), gaps)))

    def _number_of(self, term: str) -> int:
        names = [known.name for known in self._all_terms()]
        if term not in names:
            raise InvalidValue(f"term {term!r}: there are {', '.join(names)}")
        return names.index(term)

    def cutoff_gap(self, force: float = 0.0) -> float:
        """Beyond this gap \\|F\\| is at most ``force`` [N], whatever the history [m]; infinite if there is none."""
        if not force >= 0.0:
            raise InvalidValue(f"force = {force:g} N: it must be 0 or above")
        return self.core.cutoff_gap(force)

    def stable_step(self, mass: float) -> float:
        """Longest step of an explicit symplectic integrator for a mass [kg] on this force [s]."""
        if not mass > 0.0:
            raise InvalidValue(f"mass = {mass:g} kg: it must be above 0")
        return self.core.stable_step(mass)

    def explain(self) -> dict[str, Any]:
        """The plan as a new dict of numbers, names and lists, SI; ``nanotouch plan --json`` writes it."""
        facts = copy.deepcopy(self._facts)
        facts["terms"] = [term._asdict() for term in self._all_terms()]
        facts["friction"] = self.friction._asdict()
        facts["warnings"] = [warning._asdict() for warning in self.warnings]
        return facts

    def force(self, gap: ArrayLike, history: History = "approach") -> Any:
        """Force on the tip [N] along a path of gaps [m], in their order, starting apart or in contact."""
        return self.run(gap, history).F

    def run(self, gap: ArrayLike, history: History = "approach") -> LawValue:
        """Energy, force, stiffness and contact radius along a path of gaps [m]."""
        contact = _core.Interaction(self.core)
        contact.state = (begins_attached(history), 0.0, 0.0)
        return as_law(contact.run_gaps(as_floats(gap, "gap")))

    def __copy__(self) -> Plan:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Plan:
        return self

    def __reduce__(self) -> Any:
        if self._made_from is None:
            raise TypeError("a session's plan cannot be pickled: make one by scene.plan()")
        return Plan.make, self._made_from

    def __str__(self) -> str:
        return text_of(self._facts)

    def _repr_html_(self) -> str:
        return html.text("Plan", str(self))

    def __repr__(self) -> str:
        forms = ", ".join(f"{term.name}: {term.form}" for term in self.terms)
        return f"Plan({forms}; bound {self.bound:.2g}, cost {self.cost:.3g})"


def hertz_nanoseconds() -> float:
    """What the unit of all costs takes on this machine [ns]: one of many evaluations of Hertz' contact, the least of
    several runs of half a millisecond."""
    scene = Scene()
    scene.medium.relative_humidity = scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0
    contact = _core.Interaction(scene.plan().core)
    gaps = np.linspace(-0.3e-9, -0.01e-9, 16384)
    best = math.inf
    for _ in range(7):
        start = time.perf_counter_ns()
        contact.run_gaps(gaps)
        best = min(best, (time.perf_counter_ns() - start) / gaps.size)
    return best


def begins_attached(history: History) -> bool:
    """Whether a path with this history starts in contact."""
    if history not in get_args(History):
        raise InvalidValue(f"history {history!r}: valid are {', '.join(get_args(History))}")
    return history == "retract"


def make_terrain(scene: Scene, demand: Demand, rig: Rig | None, *, surface: Surface | None) -> _core.Terrain:
    """Surface, effective radii, bank of tables and plan of a scene, each made once (docs/surface.md). A surface that no
    tip has dilated has no radii."""
    parts = (None, None, None) if surface is None else surface.parts
    return _core.Terrain(scene.core, demand.core, None if rig is None else rig.core, *parts)


class Reach(NamedTuple):
    """What of a terrain can be reached: bounds between the pixels, too (docs/surface.md)."""

    rise: float
    """highest place above the start [m]"""
    relief: float
    """highest less lowest place [m]"""
    slope: float
    """steepest: along a path in its direction, in an area in any direction"""
    least_radius: float
    """bound of the effective radius of the contact [m]"""
    largest_radius: float
    """[m]"""
    least_modulus: float
    """bound of E of the sample [Pa]; 0: the scene's everywhere"""
    largest_modulus: float
    """[Pa]"""
    least_work: float
    """bound of w [J/m^2]; 0: the scene's everywhere"""
    largest_work: float
    """[J/m^2]"""

    @classmethod
    def along(cls, terrain: _core.Terrain, path: Sequence[tuple[float, float]]) -> Reach:
        """Straight from point to point (x, y) [m], the start first."""
        return cls(*terrain.reach_path(as_floats(path, "path")))

    @classmethod
    def within(
        cls,
        terrain: _core.Terrain,
        start: tuple[float, float],
        rectangle: tuple[float, float, float, float] | None = None,
    ) -> Reach:
        """Wherever a tip may go from a start (x, y) [m] in a rectangle (x_min, x_max, y_min, y_max) [m], by default all
        of the surface."""
        return cls(*terrain.reach_area(*start, rectangle))
