# SPDX-License-Identifier: BSD-3-Clause
"""One contact of tip and surface: its history, and the force at a pose as minus the gradient of one energy."""

from __future__ import annotations

from typing import Any, NamedTuple, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import Floats, LawValue, as_floats, as_law
from nanotouch.errors import InvalidValue
from nanotouch.scene.plan import History as History
from nanotouch.scene.plan import Plan, begins_attached

#: size of the history of one contact in the C library [byte]
STATE_SIZE: int = _core.interaction_state_size


_Kind = TypeVar("_Kind", bound="Interaction")


class State(NamedTuple):
    """What a contact remembers: whether it holds, and the energy that it has lost and been given."""

    attached: bool = False
    """in contact, or held by a meniscus or by the attraction that contact has left"""
    dissipated: float = 0.0
    """energy lost in jumps so far [J]"""
    port: float = 0.0
    """energy put in by slow changes of the scene so far [J]"""


class Slide(NamedTuple):
    """What friction remembers; the work of the hand against it is ``stored + dissipated``."""

    placed: bool = False
    """whether the tip was anywhere yet"""
    x: float = 0.0
    """of the tip's support, last [m]"""
    y: float = 0.0
    """[m]"""
    force_x: float = 0.0
    """friction on the tip [N]"""
    force_y: float = 0.0
    """[N]"""
    stiffness: float = 0.0
    """of the contact that sticks, with tip and lever [N/m]"""
    stored: float = 0.0
    """elastic energy [J]"""
    dissipated: float = 0.0
    """heat so far [J]"""
    work: float = 0.0
    """done by the hand so far [J]"""


class Value(NamedTuple):
    """Force on the tip at poses; each a float for one pose, an array (n,) for n."""

    U: Any
    """energy [J]"""
    Fx: Any
    """force [N]"""
    Fy: Any
    Fz: Any
    k: Any
    """dFz/d(indentation) [N/m]"""
    a: Any
    """contact radius [m]"""
    gap: Any
    """gap of the undeformed bodies [m]"""


class Interaction:
    """One contact on a plan.

    ``eval`` is pure and may be asked at trial poses; ``advance`` commits history, once per accepted step, and is the
    one that knows friction: its force is in Fx and Fy, and in :attr:`slide`.
    """

    def __init__(self, plan: Plan, history: History = "approach") -> None:
        plan.refuse_history("an Interaction")
        self.plan = plan
        self._core = _core.Interaction(plan.core)
        self.state = State(attached=begins_attached(history))

    @property
    def state(self) -> State:
        """The history: small, enough to go on from."""
        return State(*self._core.state)

    @state.setter
    def state(self, state: State) -> None:
        """Go on from a history."""
        self._core.state = (state.attached, state.dissipated, state.port)

    @property
    def slide(self) -> Slide:
        """The history of friction; that of a scene without it stays as it began."""
        return Slide(*self._core.slide)

    @slide.setter
    def slide(self, slide: Slide) -> None:
        """Go on from a history."""
        self._core.slide = (slide.placed, slide[1:])

    def eval(self, pose: ArrayLike) -> Value:
        """Energy and force at a pose (x, y, z) or poses (n, 3) [m], on the present history, without friction."""
        rows, single = _rows(pose)
        return _value(self._core.eval(rows), single)

    def advance(self, pose: ArrayLike) -> Value:
        """Move to a pose, or through poses in order, and keep the history; returns what :meth:`eval` gives
        there, and friction in Fx and Fy."""
        rows, single = _rows(pose)
        return _value(self._core.run(rows), single)

    def run(self, gaps: ArrayLike) -> Any:
        """Force on the tip [N] along a path of gaps [m] over a flat, in their order, committing history."""
        return self.run_law(gaps).F

    def run_law(self, gaps: ArrayLike) -> LawValue:
        """Energy, force, stiffness and contact radius along a path of gaps [m]."""
        return as_law(self._core.run_gaps(as_floats(gaps, "gaps")))

    def change(self, plan: Plan, pose: ArrayLike) -> Interaction:
        """This contact on a plan of the changed scene (wear, charging, ageing) at a pose; the energy that the change
        puts in is added to ``state.port``."""
        changed = type(self)(plan)
        rows, single = _rows(pose)
        if not single:
            raise InvalidValue(f"{len(rows)} poses: a change takes place at one")
        self._core.change(changed._core, *rows[0])
        return changed

    def copy(self) -> Self:
        """An independent contact with the same history."""
        return _restore(type(self), self.plan, self.state, self.slide)

    def __copy__(self) -> Self:
        return self.copy()

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self.copy()

    def __reduce__(self) -> Any:
        return _restore, (type(self), self.plan, self.state, self.slide)


def step(plan: Plan, states: ArrayLike, poses: ArrayLike) -> tuple[Floats, Value]:
    """Many contacts of one plan, each with its own history: advance each to its pose.

    Parameters
    ----------
    states : array (n, 3)
        Rows of :class:`State`; zeros for contacts that never touched.
    poses : array (n, 3)
        Where each goes [m].

    Returns
    -------
    states, value : array (n, 3), Value
    """
    rows, _ = _rows(poses)
    history = as_floats(states, "states")
    if history.shape != (len(rows), 3):
        raise InvalidValue(f"states of shape {history.shape}: {len(rows)} poses need ({len(rows)}, 3)")
    after, values = _core.interaction_step(plan.core, history, rows)
    return after, _value(values, False)


def _restore(kind: type[_Kind], plan: Plan, state: State, slide: Slide) -> _Kind:
    made = kind(plan)
    made.state, made.slide = state, slide
    return made


def _rows(pose: ArrayLike) -> tuple[Floats, bool]:
    rows = as_floats(pose, "pose")
    if rows.ndim not in (1, 2) or rows.shape[-1] != 3:
        raise InvalidValue(f"poses of shape {rows.shape}: (3,) or (n, 3) is needed")
    return np.atleast_2d(rows), rows.ndim == 1


def _value(values: Floats, single: bool) -> Value:
    return Value(*(float(v) for v in values[0])) if single else Value(*values.T)
