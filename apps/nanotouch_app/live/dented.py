# SPDX-License-Identifier: BSD-3-Clause
"""A sample that keeps dents, as it is drawn: its law at the place of the tip, the section through the contact, and the
surface with what the tip has left. Law and shapes are those of :mod:`nanotouch.plasticity` (docs/indentation.md)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import plasticity
from nanotouch.errors import InvalidValue
from nanotouch.plasticity import Dent
from nanotouch.scene.view import Curve, Section
from numpy.typing import NDArray

Floats = NDArray[np.float64]
POINTS = 200  # of a part of the law


def law_of(scene: nt.Scene, plan: nt.Plan) -> plasticity.Indentation | None:
    """Tip and sample, of a scene whose sample keeps dents."""
    if scene.sample.dents != "yes":
        return None
    facts = plan.explain()
    return plasticity.Indentation(facts["radius"], facts["effective_modulus"], float(scene.sample.yield_strength))


class Dented:
    """Follows frames, so that it knows how far the contact that is now has yielded."""

    def __init__(self, law: plasticity.Indentation, load: float) -> None:
        self.law, self.load = law, load
        self.dents: tuple[Dent, ...] = ()
        self.began = self.reached = 0.0  # radius of the dent where this contact began, and now [m]

    # --- where it is ---

    def lowered(self, x: float, y: float) -> tuple[float, float]:
        """By how much the dents lower the apex there, and the radius of the one that does [m]."""
        found = (0.0, 0.0)
        for dent in self.dents:
            by = self._lowered_by(dent.imprint, _away(dent.imprint, x, y))
            if by >= found[0] and by > 0.0:
                found = (by, dent.imprint.radius)
        return found

    def _lowered_by(self, of: plasticity.Imprint, s: float) -> float:
        """The tip rests in the paraboloid, or on its rim."""
        a, R = of.radius, self.law.radius
        if not s < a or not of.depth > 0.0:
            return 0.0
        C = 0.5 * a * a / of.depth
        return of.depth - 0.5 * s * s / (C - R) if s * C <= a * (C - R) else 0.5 * (a - s) ** 2 / R

    def follow(self, frames: Any) -> None:
        """The newest frames, in their order."""
        a = frames["contact_radius"]
        apart = np.flatnonzero(~(a > 0.0))
        if len(apart):
            x, y = (float(part) for part in frames["tip_position"][apart[-1], :2])
            self.began = self.reached = self.lowered(x, y)[1]
            a = a[apart[-1] + 1 :]
        self.reached = max(self.reached, float(a.max(initial=0.0)))

    # --- what is drawn ---

    def _first(self, radius: float) -> plasticity.FirstLoading:
        return self.law.at_radius(min(radius, 0.5 * self.law.radius))

    def curve(self, reach: float) -> Curve:
        """Force over gap from the dent that was there, and back from where the contact has come to."""
        began, bottom = self._first(self.began), float(self._first(self.began).residual_depth)
        depths = np.linspace(bottom, max(self.relief, float(began.indentation)), POINTS)
        inside = depths <= began.indentation
        force = np.empty(POINTS)
        force[inside] = self._unloading(self.began, depths[inside])
        force[~inside] = self.law.at_depth(depths[~inside]).force
        way_in = np.stack([bottom - depths, force], axis=1)
        apart = np.concatenate([[[reach, 0.0]], way_in])
        if not self._first(self.reached).residual_depth > 0.0:
            return Curve(apart, apart[:0], apart[:0])
        now = self._first(self.reached)
        depths = np.linspace(float(now.indentation), float(now.residual_depth), POINTS)
        way_out = np.stack([bottom - depths, self._unloading(self.reached, depths)], axis=1)
        return Curve(apart, way_out, apart[:0])

    def _unloading(self, radius: float, depths: Floats) -> Floats:
        """Hertz' contact in a dent, with the radius of tip and dent together."""
        dent = self._first(radius)
        deep = np.maximum(depths - float(dent.residual_depth), 0.0)
        return np.asarray(4.0 / 3.0 * self.law.effective_modulus * np.sqrt(float(dent.effective_radius)) * deep**1.5)

    def stored(self, contact_radius: float) -> float:
        """Elastic energy of the contact that is now [J]: 2/5 F delta, Hertz."""
        if not contact_radius > 0.0:
            return 0.0
        radius = float(self._first(self.reached).effective_radius)
        return 8.0 / 15.0 * self.law.effective_modulus * contact_radius**5 / radius**2

    def section(self, gap: float, r: Floats) -> Section:
        """The tip as it is, the sample under it: the dent, and what gives way elastically around the contact."""
        R = self.law.radius
        bottom, dent = float(self._first(self.began).residual_depth), self._first(self.reached)
        tip = gap - bottom + R - np.sqrt(np.maximum(R * R - r * r, 0.0))
        tip[r > R] = np.inf
        depth = max(bottom - gap, 0.0)
        a, curvature = 0.0, float(dent.effective_radius)
        if depth > float(dent.residual_depth):
            a = min(math.sqrt(curvature * (depth - float(dent.residual_depth))), max(self.reached, 0.0) or math.inf)
        sample = self.left(r) - _sunk(r, a, curvature)
        sample = np.where(r <= a, np.minimum(tip, sample), sample)
        return Section(r, tip, sample, tip, a, a, a > 0.0)

    def left(self, r: Floats) -> Floats:
        """What would stay if the tip let go now, at distances from its axis [m]."""
        dent = self._first(self.reached)
        a, deep = max(self.reached, 1e-15), float(dent.residual_depth)
        return np.where(r < a, -deep * (1.0 - (r / a) ** 2), 0.0)

    def heights(self, flat: Floats, pixel_size: Sequence[float] | Floats, origin: Sequence[float] | Floats) -> Floats:
        """The surface with all dents and their ridges, from its lower left corner on [m].

        Where they overlap the deepest counts; one that is finer than its pixels is left out.
        """
        dy, dx = (float(part) for part in pixel_size)
        edge = self._edge(min(dx, dy))
        way = np.zeros((flat.shape[0] + 2 * edge, flat.shape[1] + 2 * edge))
        specimen = plasticity.Specimen(way, (dy, dx))
        corner = (float(origin[0]) - edge * dx, float(origin[1]) - edge * dy)
        grown = {dent.before for dent in self.dents}
        for number, dent in enumerate(self.dents):
            if number in grown:
                continue
            try:
                event = specimen.take(_moved(dent, corner)._replace(before=None))
            except InvalidValue:
                continue
            so_far, new = way[event.changed], specimen.heights[event.changed]
            pit = (so_far < 0.0) | (new < 0.0)
            way[event.changed] = np.where(pit, np.minimum(so_far, new), np.maximum(so_far, new))
            specimen.undo()
        return flat + way[edge:-edge, edge:-edge]

    def _edge(self, pixel: float) -> int:
        """So many pixels around a map that the widest dent with its ridge lies there wherever its middle does."""
        widest = (1.0 + plasticity.Displacement().ridge_width) * 0.5 * self.law.radius
        return min(math.ceil(widest / pixel), 1000) + 2

    @property
    def relief(self) -> float:
        """How deep it can become [m]."""
        return float(self.law.at_load(min(self.load, self.law.largest_load)).indentation)

    @property
    def words(self) -> str:
        """The law, in a few words."""
        dent = self._first(self.reached)
        if not dent.residual_depth > 0.0:
            return f"elastic up to {1e9 * self.law.yield_load:.3g} nN"
        depth, width = 1e9 * float(dent.residual_depth), 2e9 * self.reached
        return f"dent {depth:.3g} nm deep, {width:.3g} nm wide"


def _moved(dent: Dent, origin: Sequence[float] | Floats) -> Dent:
    """As seen from a corner."""
    of, (x, y) = dent.imprint, (float(part) for part in origin)
    ends = {"start_x": of.start_x - x, "start_y": of.start_y - y, "end_x": of.end_x - x, "end_y": of.end_y - y}
    return dent._replace(imprint=of._replace(**ends))


def _away(of: plasticity.Imprint, x: float, y: float) -> float:
    """Distance from the middle line of a groove, or the middle of a dent [m]."""
    way = np.array([of.end_x - of.start_x, of.end_y - of.start_y])
    place, length2 = np.array([x - of.start_x, y - of.start_y]), float(way @ way)
    share = min(max(float(place @ way) / length2, 0.0), 1.0) if length2 > 0.0 else 0.0
    return float(np.hypot(*(place - share * way)))


def _sunk(r: Floats, a: float, radius: float) -> Floats:
    """Under Hertz' pressure within a, for a contact of tip and dent with this radius (Johnson 1985, Eq. 3.42)."""
    if not a > 0.0:
        return np.zeros_like(r)
    inner = (2.0 * a * a - r * r) / (2.0 * radius)
    share = np.minimum(a / np.maximum(r, a), 1.0)
    outer = ((2.0 * a * a - r * r) * np.arcsin(share) + a * r * np.sqrt(1.0 - share**2)) / (np.pi * radius)
    return np.where(r <= a, inner, outer)
