# SPDX-License-Identifier: BSD-3-Clause
"""Closed paths of the tip, and the work that the surface does on it: Gauss-Legendre quadrature of the force alone.

The force is smooth between known gaps: those where adhesion takes hold and lets go, where terms are held, and first
touch; it goes like a square root at the fold where contact lets go. The pieces of the quadrature end at these gaps and
become shorter by factors of 4 towards them; along x and y they end at the pixels of the surface.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from nanotouch import Interaction, Plan, Scene, Surface, Topography
from nanotouch._arrays import Floats
from nanotouch.scene.interaction import step
from numpy.typing import NDArray

_AT, _WEIGHT = np.polynomial.legendre.leggauss(8)
_AT, _WEIGHT = (_AT + 1.0) / 2.0, _WEIGHT / 2.0
_GRADES = 4.0 ** -np.arange(1.0, 11.0)


class Balance(NamedTuple):
    """Of many closed paths."""

    work: Floats
    """that the surface did on the tip: never positive [J]"""
    dissipated: Floats
    """that the library has booked [J]"""
    scale: float
    """largest force x extent of the paths [J]"""

    @property
    def net_out(self) -> float:
        """Most that any path gave out, over the scale."""
        return float(self.work.max() / self.scale)

    @property
    def imbalance(self) -> float:
        """Largest difference between hysteresis area and what was booked, over the scale."""
        return float(np.abs(self.work + self.dissipated).max() / self.scale)


def bumpy(scene: Scene, seed: int, pixels: int = 40) -> Surface:
    """Three waves as steep and as curved as a tip can still follow, over a grid of R/4."""
    rng = np.random.default_rng(seed)
    radius = scene.tip.radius
    y, x = np.mgrid[0:pixels, 0:pixels] * 0.25 * radius
    heights = np.zeros_like(x)
    for _ in range(3):
        wave, angle, phase = rng.uniform(5.0, 9.0) * radius, *rng.uniform(0.0, 2.0 * np.pi, 2)
        number = 2.0 * np.pi / wave
        heights += 0.12 / (radius * number**2) * np.sin(number * (x * np.cos(angle) + y * np.sin(angle)) + phase)
    return Surface(Topography(heights, (0.25 * radius, 0.25 * radius)), radius, scene.tip.half_angle)


def made_of(scene: Scene, body: Surface, seed: int, contrast: tuple[float, float] = (30.0, 10.0)) -> Surface:
    """The same body, with a modulus and, where the scene holds, an adhesion that are the scene's and up to so many
    times more: pixel by pixel, in two materials, or in waves."""
    rng = np.random.default_rng(1000 + seed)
    shape = body.topography.shape
    y, x = np.mgrid[0 : shape[0], 0 : shape[1]]

    def pattern() -> Floats:
        phase, turn = rng.uniform(0.0, 2.0 * np.pi, 2)
        wave = 0.5 + 0.5 * np.sin(phase + (x * np.cos(turn) + y * np.sin(turn)) * rng.uniform(0.2, 1.0))
        kinds = (rng.random(shape), wave, (wave > 0.5).astype(float))
        return np.asarray(kinds[int(rng.integers(3))])

    stiff, sticky = (rng.uniform(1.0, most) ** pattern() for most in contrast)
    given = {"youngs_modulus": np.clip(scene.sample.youngs_modulus * stiff, 1e2, 1e13)}
    facts = scene.plan(bound="exact").explain()
    if facts["adhesion_source"] != "none":
        pulled = sum(-scene.plan(bound="exact").law(name, 0.0).F for name in ("vdw",)) / (
            2.0 * np.pi * scene.tip.radius
        )
        given["work_of_adhesion"] = np.clip((facts["work_of_adhesion"] + max(pulled, 0.0)) * sticky, 0.0, 10.0)
    return Surface(body.topography, body.tip_radius, body.tip_half_angle, **given)


def without_radii(surface: Surface) -> Surface:
    """The same heights, their curvature not asked for."""
    return Surface(dataclasses.replace(surface.topography, heights=dilated(surface)))


def dilated(surface: Surface) -> Floats:
    """Heights of the apex at the pixels (ny, nx) [m]."""
    dy, dx = surface.topography.pixel_size
    rows, columns = surface.topography.heights.shape
    y, x = np.mgrid[0:rows, 0:columns]
    return np.asarray(surface.height(x * dx, y * dy))


def far_gap(plan: Plan) -> float:
    """Well beyond where contact lets go, and what a bump rises above the pieces of a path."""
    facts = plan.explain()
    return float(10.0 * max(facts["release_gap"], facts["capture_gap"], 1e-10, 0.002 * facts["radius"]))


def _breaks(plan: Plan, scene: Scene, release: Floats, touch: Floats, deepest: float) -> Floats:
    """Ends of the pieces (n, m), rising, from the deepest gap to far away, for gaps of release and first touch (n,)."""
    facts = plan.explain()
    reach, ones = far_gap(plan), np.ones_like(release)
    singular = [release, touch]
    singular += [
        gap * ones
        for gap in (facts["capture_gap"], scene.adhesion.equilibrium_distance, 0.0, scene.medium.brush_thickness)
    ]
    ends = [deepest * ones, reach * ones, *(0.75**k * deepest * ones for k in range(1, 40))]
    for gap in singular:
        ends += [gap, *(gap + sign * reach * grade for grade in _GRADES for sign in (-1.0, 1.0))]
    return np.sort(np.clip(np.stack(ends, axis=1), deepest, reach), axis=1)


def _line_work(plan: Plan, attached: bool, ends: Floats) -> Floats:
    """Work of the force along polylines (n, m, 3), a piece between two points: (n, m - 1)."""
    contact = Interaction(plan, "retract" if attached else "approach")
    start, way = ends[:, :-1], np.diff(ends, axis=1)
    work, real = np.zeros(way.shape[:2]), (way != 0.0).any(axis=2)  # many pieces have been cut to nothing
    start, way = start[real], way[real]
    value = contact.eval((start[:, None] + _AT[:, None] * way[:, None]).reshape(-1, 3))
    along = [(np.reshape(force, (-1, len(_AT))) @ _WEIGHT) * way[:, axis] for axis, force in enumerate(value[1:4])]
    work[real] = sum(along)
    return work


def _vertical(gaps: Floats, x: Floats, y: Floats, ground: Floats) -> Floats:
    """Points (n, m, 3) over places (n,) at gaps (n, m)."""
    shape = np.ones_like(gaps)
    return np.stack([x[:, None] * shape, y[:, None] * shape, ground[:, None] + gaps], axis=-1)


def release_gaps(plan: Plan, poses: Floats) -> Floats:
    """Where a contact over each place lets go, by bisection of what ``step`` answers; ``poses`` on the surface."""
    held = np.tile([1.0, 0.0, 0.0], (len(poses), 1))
    return _last_gap(plan, poses, lambda there: step(plan, held, there)[0][:, 0] > 0)


def touch_gaps(plan: Plan, poses: Floats) -> Floats:
    """Where a contact over each place has no radius any more, by bisection."""
    contact = Interaction(plan, "retract")
    return _last_gap(plan, poses, lambda there: np.asarray(contact.eval(there).a > 0.0))


def _last_gap(plan: Plan, poses: Floats, holds: Callable[[Floats], NDArray[np.bool_]]) -> Floats:
    low, high = np.full(len(poses), -far_gap(plan)), np.full(len(poses), 1.5 * far_gap(plan))
    for _ in range(70):
        middle = 0.5 * (low + high)
        held = holds(poses + np.stack([0 * middle, 0 * middle, middle], axis=1))
        low, high = np.where(held, middle, low), np.where(held, high, middle)
    return low


def random_walks(plan: Plan, scene: Scene, rng: np.random.Generator, count: int, turns: int = 8) -> Balance:
    """Over a flat: from far away through random gaps and back; each walk has its own state."""
    facts = plan.explain()
    far, deepest = far_gap(plan), -float(facts["largest_indentation"])
    near = max(facts["release_gap"], facts["capture_gap"], -deepest)
    zero = np.zeros(1)
    ends = _breaks(plan, scene, np.array([facts["release_gap"]]), touch_gaps(plan, np.zeros((1, 3))), deepest)
    potential = {}
    for attached in (False, True):
        pieces = _line_work(plan, attached, _vertical(ends, zero, zero, zero))[0]
        potential[attached] = np.concatenate([[0.0], np.cumsum(pieces)])

    def energy(attached: bool, gaps: Floats) -> Floats:
        """Work from the deepest gap to gaps (n,): whole pieces from the table, the last one anew."""
        index = np.clip(np.searchsorted(ends[0], gaps) - 1, 0, ends.shape[1] - 2)
        lines = np.stack([ends[0][index], gaps], axis=1)
        nothing = np.zeros(len(gaps))
        rest = _line_work(plan, attached, _vertical(lines, nothing, nothing, nothing))[:, 0]
        return np.asarray(potential[attached][index] + rest)

    fold = {True: facts["capture_gap"], False: facts["release_gap"]}
    at_fold = {now: {was: energy(was, np.array([gap]))[0] for was in (True, False)} for now, gap in fold.items()}
    states, gap, work = np.zeros((count, 3)), np.full(count, far), np.zeros(count)
    reached = {was: energy(was, gap) for was in (True, False)}
    for turn in range(turns):
        target = np.where(rng.random(count) < 0.3, rng.uniform(deepest, far, count), rng.uniform(-near, near, count))
        target = np.full(count, far) if turn == turns - 1 else np.clip(target, deepest, far)
        before = states[:, 0] > 0
        states, _ = step(plan, states, np.stack([0 * target, 0 * target, target], axis=1))
        after = states[:, 0] > 0
        there = {was: energy(was, target) for was in (True, False)}
        for was in (True, False):
            stays, jumps = (before == was) & (after == was), (before == was) & (after != was)
            work[stays] += (there[was] - reached[was])[stays]
            change = at_fold[not was]
            work[jumps] += (change[was] - reached[was] + there[not was] - change[not was])[jumps]
        gap, reached = target, there
    forces = Interaction(plan, "retract").run(np.linspace(deepest, far, 1000))
    return Balance(work, states[:, 1], float(np.abs(forces).max() * (far - deepest)))


def _across(plan: Plan, attached: bool, surface: Surface, corners: list[Floats]) -> Floats:
    """Work (n,) along x, then y, over the surface: ``corners`` are rows x, y, gap; pieces end at the pixels, and go
    on in parts where the properties change from one to the next."""
    parts = 2 if surface.youngs_modulus is None else 16
    pixel = surface.topography.pixel_size[1]
    work = np.zeros(len(corners[0]))
    for a, b in itertools.pairwise(corners):
        along = 0 if np.any(a[:, 0] != b[:, 0]) else 1
        low, high = np.minimum(a[:, along], b[:, along]), np.maximum(a[:, along], b[:, along])
        lines = np.floor(low / pixel)[:, None] + np.arange(1, 4 * parts + 1) / parts
        stops = np.concatenate(
            [low[:, None], np.clip(lines * pixel, low[:, None], high[:, None]), high[:, None]], axis=1
        )
        share = (stops - low[:, None]) / np.where(high > low, high - low, 1.0)[:, None]
        share = np.where((b[:, along] > a[:, along])[:, None], share, 1.0 - share[:, ::-1])
        points = a[:, None] + share[:, :, None] * (b - a)[:, None]
        points[:, :, 2] += surface.height(points[:, :, 0], points[:, :, 1])
        work += _line_work(plan, attached, points).sum(axis=1)
    return work


def random_laps(plan: Plan, scene: Scene, surface: Surface, rng: np.random.Generator, count: int) -> Balance:
    """Down over one place, in contact to another, up there, back far away."""
    facts = plan.explain()
    far, deepest = far_gap(plan), -float(facts["largest_indentation"])
    pixel = surface.topography.pixel_size[1]
    width = surface.size[0]
    a, way = rng.uniform(0.15 * width, 0.75 * width, (count, 2)), rng.uniform(0.0, 3.0 * pixel, (count, 2))
    b = a + way
    on_a, on_b = (np.column_stack([p, surface.height(p[:, 0], p[:, 1])]) for p in (a, b))
    depths = rng.uniform(deepest, 0.1 * deepest, (count, 2))

    def corner(x: Floats, y: Floats, gap: Floats) -> Floats:
        return np.column_stack([x, y, gap])

    middle, far_off = depths.mean(axis=1), np.full(count, far)
    in_contact = [corner(*a.T, depths[:, 0]), corner(b[:, 0], a[:, 1], middle), corner(*b.T, depths[:, 1])]
    back = [corner(*b.T, far_off), corner(a[:, 0], b[:, 1], far_off), corner(*a.T, far_off)]
    work = _across(plan, True, surface, in_contact) + _across(plan, False, surface, back)
    capture, release = np.full(count, facts["capture_gap"]), release_gaps(plan, on_b)
    for on, depth, fold, sign in ((on_a, depths[:, 0], capture, -1.0), (on_b, depths[:, 1], release, 1.0)):
        ends = _breaks(plan, scene, fold, touch_gaps(plan, on), deepest)
        inside, outside = np.clip(ends, depth[:, None], fold[:, None]), np.maximum(ends, fold[:, None])
        work += sign * _line_work(plan, True, _vertical(inside, *on.T)).sum(axis=1)
        work += sign * _line_work(plan, False, _vertical(outside, *on.T)).sum(axis=1)
    states = np.zeros((count, 3))
    just_inside = release - 1e-9 * np.abs(release)
    for on, gap in ((on_a, depths[:, 0]), (on_b, depths[:, 1]), (on_b, just_inside), (on_b, far_off), (on_a, far_off)):
        states, _ = step(plan, states, on + np.outer(gap, [0.0, 0.0, 1.0]))
    assert (states[:, 0] == 0).all()
    largest = max(plan.pull_off_force, scene.range.maximum_load)
    return Balance(work, states[:, 1], largest * (far - deepest))


def largest_step(plan: Plan, rng: np.random.Generator, count: int, move: float = 1e-12) -> tuple[float, float]:
    """Largest change of force for a move away from folds, and over the larger stiffness at its ends times the move."""
    facts = plan.explain()
    far, deepest = far_gap(plan), -float(facts["largest_indentation"])
    gaps = rng.uniform(deepest, max(0.2 * far, -deepest), count)
    folds = np.array([facts["capture_gap"], facts["release_gap"]])
    gaps = gaps[np.abs(gaps[:, None] - folds).min(axis=1) > 2.0 * move]
    steps, ratio = 0.0, 0.0
    for history in ("approach", "retract"):
        contact = Interaction(plan, history)  # type: ignore[arg-type]
        here, there = (contact.eval(np.outer(g, [0.0, 0.0, 1.0])) for g in (gaps, gaps + move))
        change = np.abs(there.Fz - here.Fz)
        stiff = np.maximum(np.abs(here.k), np.abs(there.k)) * move
        rounding = 1e-15 * max(np.abs(here.Fz).max(), plan.pull_off_force)
        steps = float(np.maximum(steps, change.max()))  # max() may lose a NaN
        ratio = float(np.maximum(ratio, (change / (stiff + rounding)).max()))
    return steps, ratio
