# SPDX-License-Identifier: BSD-3-Clause
"""A rigid paraboloid before and on a sample that deforms under any pressure of the gap: gap and displacement solved
together, with an adaptive mesh and no approximation but its tolerance. What `scene.plan` says of soft samples is
measured against it; it shares no code with plans.

    g(r) = h + r^2/(2 R) + u(r) >= 0        p(r) = p(g) where g > 0        u = K p        F = 2 pi Int p r dr = -dU/dh

In contact the surface follows the tip, so that Abel's transform of the pressure is known there: q(t) = E*/2 (delta -
t^2/R) for t < a. It is continuous at a, since the pressure is finite there (Maugis 1992 with any law in place of
Dugdale's).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from nanotouch._arrays import Floats
from nanotouch.errors import SolverError
from nanotouch.reference._half_space import NODES, Layer, Mesh, coefficients, interpolate
from nanotouch.reference._pressures import Pressure

_PANELS = 120
_FAR = 1e-11  # of the force, that is left beyond the mesh
WIDEST = 30.0  # times R, where the mesh of a law that fades slower ends


class Deformed(NamedTuple):
    """One equilibrium of tip and sample."""

    gap: float
    """h of the undeformed bodies [m]"""
    force: float
    """on the tip, + repulsive [N]"""
    stiffness: float
    """-dF/dh [N/m]"""
    energy: float
    """0 far away [J]"""
    centre_gap: float
    """the gap that is left under the apex [m]"""
    displacement: float
    """by which the sample gives there [m]"""
    contact_radius: float
    """[m]"""
    nodes: int


@dataclass
class _State:
    mesh: Mesh
    h: float
    gaps: Floats


class Deformation:
    """The sample under one tip; states follow each other, so ask for gaps in order, from far away inwards."""

    def __init__(
        self,
        pressure: Pressure,
        radius: float,
        effective_modulus: float,
        layer: Layer | None = None,
        tolerance: float = 1e-8,
    ) -> None:
        self.law, self.R, self.E, self.layer, self.tolerance = pressure, radius, effective_modulus, layer, tolerance
        self._state: _State | None = None
        self.touch: float | None = None
        """the gap of the undeformed bodies where they touch, once they have [m]"""

    def at(self, gap: float) -> Deformed:
        """At a gap of the undeformed bodies [m]."""
        return self._go("gap", gap)

    def at_centre(self, centre_gap: float) -> Deformed:
        """At a gap under the apex [m]: through the folds of an attraction, too."""
        return self._go("centre", centre_gap)

    def touching(self, contact_radius: float) -> Deformed:
        """In contact over a radius [m]."""
        return self._go("contact", contact_radius)

    def curve(self, gaps: Iterable[float]) -> list[Deformed]:
        """Gap after gap, in contact where the bodies touch."""
        return [self._anywhere(gap) for gap in gaps]

    def jump_in(self, nearest: float, farthest: float) -> Deformed:
        """Where an attraction jumps on approach: the smallest gap of its branch, between two gaps under the apex."""
        golden = (math.sqrt(5.0) - 1.0) / 2.0
        low, high = math.log(nearest), math.log(farthest)
        left, right = high - golden * (high - low), low + golden * (high - low)
        at_right, at_left = self.at_centre(math.exp(right)), self.at_centre(math.exp(left))
        while high - low > 1e-4:  # h changes by its square
            if at_left.gap < at_right.gap:
                high, right, at_right = right, left, at_left
                left = high - golden * (high - low)
                at_left = self.at_centre(math.exp(left))
            else:
                low, left, at_left = left, right, at_right
                right = low + golden * (high - low)
                at_right = self.at_centre(math.exp(right))
        return at_left

    def at_force(self, force: float, far: float) -> Deformed:
        """Where a repulsion carries a force [N]: inwards from a gap `far` [m], then Newton."""
        here, step = self._anywhere(far), 0.2 * self._length(far)
        last = here
        while here.force < force:
            last, here = here, self._anywhere(here.gap - step)
            step *= 1.3
        low, high = here.gap, last.gap
        for _ in range(60):
            guess = here.gap + (here.force - force) / here.stiffness
            here = self._anywhere(guess if low < guess < high else (low + high) / 2.0)
            if abs(here.force / force - 1.0) < 1e-10:
                return here
            low, high = (here.gap, high) if here.force > force else (low, here.gap)
        raise SolverError(f"no gap with a force of {force:g} N")

    def _anywhere(self, gap: float) -> Deformed:
        """At a gap, in contact where the bodies touch."""
        if self.touch is None:
            try:
                found = self.at(gap)
            except SolverError:  # so far into the other body that there is no such equilibrium
                if self.law.diverges:
                    raise
            else:
                if found.centre_gap >= 0.0 or self.law.diverges:
                    return found
            self.touch = self.at_centre(0.0).gap
        if gap >= self.touch:
            return self.at(gap)
        low, high = 0.0, math.sqrt(self.R * (self.touch - gap))  # a of Hertz, which deforms less
        f_low, f_high = self.touch - gap, self.touching(high).gap - gap
        while f_high > 0.0:
            low, f_low, high = high, f_high, 1.3 * high
            f_high = self.touching(high).gap - gap
        for _ in range(100):  # Illinois in a^2, of which the gap is almost linear
            square = (low**2 * f_high - high**2 * f_low) / (f_high - f_low)
            found = self.touching(math.sqrt(square))
            error = found.gap - gap
            if abs(error) < 1e-11 * max(abs(gap), self._length(0.0)):
                return found
            if error > 0.0:
                low, f_low, f_high = found.contact_radius, error, f_high / 2.0
            else:
                high, f_high, f_low = found.contact_radius, error, f_low / 2.0
        raise SolverError(f"no contact at a gap of {gap:g} m")

    def _length(self, gap: float) -> float:
        return float(self.law.length(np.array([gap]))[0])

    def _far_edge(self, gap: float) -> float:
        """X = r^2 beyond which the rest of a rigid paraboloid at a gap has no force to speak of."""
        all_of_it = abs(float(self.law.energy(np.array([max(gap, 0.0)]))[0])) + 1e-300
        rise = self._length(max(gap, 0.0))
        while rise < WIDEST * self.R:
            if abs(float(self.law.energy(np.array([max(gap, 0.0) + rise]))[0])) <= _FAR * all_of_it:
                break
            rise *= 1.3
        return 2.0 * self.R * rise

    def _go(self, control: str, value: float) -> Deformed:
        """Newton on a mesh, a finer mesh, ... until the pressure is resolved; half the way first where that fails."""
        start = self._state
        if start is None:
            gap = max(value, 0.0) if control != "contact" else 0.0
            edges = self._first_edges(gap)
            state = _State(Mesh(edges, self.E, 0.0, self.layer), gap, np.empty(0))
            state.gaps = gap + state.mesh.x / (2.0 * self.R)
            self._state = state
        here = self._where(control)
        target = self._within(control, here, value)
        tries = 0
        while True:
            try:
                result = self._solve(control, target)
            except SolverError:
                tries += 1
                if tries > 40:
                    self._state = start
                    raise
                target = (here + target) / 2.0 if math.isfinite(here) else target
                continue
            if target == value:
                return result
            here, target = target, self._within(control, target, value)

    def _within(self, control: str, here: float, value: float) -> float:
        """As far towards a value as one step goes."""
        if control != "contact":
            return value
        return min(value, 1.4 * here + 0.1 * math.sqrt(2.0 * self.R * self._length(0.0)))

    def _where(self, control: str) -> float:
        state = self._state
        assert state is not None
        if control == "gap":
            return state.h
        if control == "contact":
            return state.mesh.a
        return self._centre(state)

    def _centre(self, state: _State) -> float:
        if state.mesh.a > 0.0:
            return 0.0
        return state.h + float(state.mesh.K0 @ self.law.pressure(state.gaps))

    def _first_edges(self, gap: float) -> Floats:
        far, unit = self._far_edge(gap), 2.0 * self.R * self._length(max(gap, 0.0))
        count = max(4, math.ceil(math.log2(far / unit)) + 1)
        return np.concatenate([[0.0], far * 0.5 ** np.arange(count)[::-1]])

    def _solve(self, control: str, value: float) -> Deformed:
        assert self._state is not None
        state = self._state
        a = value if control == "contact" else 0.0
        edges = self._moved_edges(state, a)
        for _ in range(40):
            state = self._newton(self._onto(state, edges, a), control, value)
            finer = self._refined(state)
            if finer is None:
                self._state = state
                return self._report(state, control)
            edges = finer
        raise SolverError("the mesh does not come to an end")

    def _moved_edges(self, state: _State, a: float) -> Floats:
        """Those of the state without what it did not need, as far out as the law reaches."""
        centre = self._centre(state) if state.mesh.a == 0.0 else 0.0
        far = self._far_edge(centre) + 2.0 * self.R * max(centre - state.h, 0.0)
        smooth = self._roughness(state) < 1e-4
        keep = np.concatenate([[True], ~(smooth[1:] & smooth[:-1]), [True]])
        keep[1:-1] |= np.arange(keep.size - 2) % 2 == 0
        edges = state.mesh.edges[keep]
        return np.concatenate([edges[edges < 0.9 * far], [far]])

    def _onto(self, state: _State, edges: Floats, a: float) -> _State:
        old = state.mesh
        mesh = Mesh(edges, self.E, a, self.layer)
        lift = state.gaps - old.a**2 / (2.0 * self.R) - old.x / (2.0 * self.R) - state.h
        x = np.maximum(mesh.x + a * a - old.a**2, 0.0)
        gaps = state.h + (mesh.x + a * a) / (2.0 * self.R) + interpolate(old.edges, lift, x)
        return _State(mesh, state.h, np.maximum(gaps, 1e-3 * self._length(0.0)) if self.law.diverges else gaps)

    def _rim(self, mesh: Mesh, h: float) -> tuple[Floats, Floats]:
        """What the pressure in contact does outside, and its slope in h."""
        a, r = mesh.a, np.sqrt(mesh.a**2 + mesh.x)
        arc = np.arcsin(np.minimum(a / r, 1.0))
        u = 2.0 / np.pi * ((-h - r * r / (2.0 * self.R)) * arc + a / (2.0 * self.R) * np.sqrt(mesh.x))
        return u, -2.0 / np.pi * arc

    def _newton(self, state: _State, control: str, value: float) -> _State:
        mesh, h, g = state.mesh, state.h, state.gaps.copy()
        n = g.size
        if control == "gap":
            h = value
        A, b = np.empty((n + 1, n + 1)), np.empty(n + 1)
        for _ in range(60):
            with np.errstate(over="ignore", invalid="ignore"):  # of a trial too deep: shorter steps follow
                p, slope = self.law.pressure(g), self.law.slope(g)
            if not np.all(np.isfinite(slope)):
                raise SolverError("Newton")
            inside, inside_slope = self._rim(mesh, h) if mesh.a > 0.0 else (0.0, 0.0)
            b[:n] = h + (mesh.a**2 + mesh.x) / (2.0 * self.R) + inside + mesh.K @ p - g
            A[:n, :n] = -mesh.K * slope
            A[range(n), range(n)] += 1.0
            A[:n, n] = -1.0 - inside_slope
            b[n], A[n, :n], A[n, n] = self._control(mesh, control, value, h, p, slope)
            step = np.linalg.solve(A, b)
            if not np.all(np.isfinite(step)):
                raise SolverError("Newton")
            ahead = 1.0
            if self.law.diverges:
                ahead = min(1.0, 0.7 / max(float(np.max(-step[:n] / g)), 0.7))
            g, h = g + ahead * step[:n], h + ahead * step[n]
            if np.abs(step[:n]).max() < 1e-12 * (np.abs(g).max() + abs(h)) and ahead == 1.0:
                return _State(mesh, h, g)
            if np.all(np.abs(step[:n]) < 1e-9 * g) and ahead == 1.0:
                return _State(mesh, h, g)
        raise SolverError("Newton")

    def _control(
        self, mesh: Mesh, control: str, value: float, h: float, p: Floats, slope: Floats
    ) -> tuple[float, Floats, float]:
        """Residual, with a sign, of what is held, and its slopes in the gaps and in h."""
        if control == "gap":
            return value - h, np.zeros(p.size), 1.0
        if control == "centre":
            return value - h - float(mesh.K0 @ p), mesh.K0 * slope, 1.0
        scale = 2.0 / self.E
        return h + mesh.a**2 / self.R + scale * float(mesh.B0 @ p), -scale * mesh.B0 * slope, -1.0

    def _refined(self, state: _State) -> Floats | None:
        """Finer edges where pressure or gap are not resolved, None where all are."""
        mesh, g = state.mesh, state.gaps
        bad = self._roughness(state) > 1.0
        edges = set(mesh.edges)
        middles = (mesh.edges[1:] + mesh.edges[:-1]) / 2.0
        for kink in self.law.kinks:
            crossed = np.flatnonzero((g[1:] >= kink) & (g[:-1] < kink))
            for i in crossed:
                x = self._crossing(state, kink, int(i))
                near = mesh.edges[np.argmin(np.abs(mesh.edges - x))]
                panel = int(np.searchsorted(mesh.edges, x)) - 1
                if abs(near - x) > 1e-5 * x:
                    if abs(near - x) < 0.3 * np.diff(mesh.edges)[min(panel, bad.size - 1)] and near != 0.0:
                        edges.discard(near)
                    edges.add(float(x))
                    bad[max(panel, 0) : panel + 1] = False
        edges |= set(middles[bad])
        p = self.law.pressure(g)
        outer = abs(float(self.law.energy(g[-1:])[0]))
        if outer > 1e3 * _FAR * float(np.abs(p) @ mesh.area) / (2.0 * np.pi * self.R) and mesh.edges[-1] < self.R**2:
            edges.add(1.5 * mesh.edges[-1])
        if edges == set(mesh.edges):
            return None
        if len(edges) > _PANELS:
            raise SolverError("too many panels")
        return np.array(sorted(edges))

    def _roughness(self, state: _State) -> Floats:
        """Of every panel, in what is tolerated: the last coefficients of the pressure and of the gap."""
        p = self.law.pressure(state.gaps)
        force = np.abs(p) @ state.mesh.area / np.pi + 1e-300
        tail = np.abs(coefficients(p)[:, -2:]).max(axis=1) * np.diff(state.mesh.edges) / force
        least = state.gaps.reshape(-1, NODES).min(axis=1)
        bent = np.abs(coefficients(state.gaps)[:, -2:]).max(axis=1) / np.maximum(least, self._length(0.0))
        return np.asarray(np.maximum(tail / self.tolerance, bent / 1e-4))

    def _crossing(self, state: _State, kink: float, i: int) -> float:
        """X at which the gap is that of a kink, between two nodes."""
        mesh = state.mesh
        low, high = mesh.x[i], mesh.x[i + 1]
        for _ in range(60):
            middle = (low + high) / 2.0
            if interpolate(mesh.edges, state.gaps, np.array([middle]))[0] < kink:
                low = middle
            else:
                high = middle
        return float((low + high) / 2.0)

    def _report(self, state: _State, control: str) -> Deformed:
        mesh, g, h = state.mesh, state.gaps, state.h
        a, R, E = mesh.a, self.R, self.E
        p, slope = self.law.pressure(g), self.law.slope(g)
        _, inside_slope = self._rim(mesh, h) if a > 0.0 else (np.zeros(g.size), np.zeros(g.size))
        # tangent along h at fixed a, then along a where the bodies touch
        M = np.eye(g.size) - mesh.K * slope
        by_h = np.linalg.solve(M, 1.0 + inside_slope)
        outer = g[-1]
        rest = 2.0 * np.pi * R * float(self.law.energy(np.array([outer]))[0])
        beyond = self._beyond(outer)
        q = mesh.B @ p
        energy = 4.0 / E * float(q @ mesh.metric @ q) + float(self.law.energy(g) @ mesh.area) + beyond
        force = float(p @ mesh.area) + rest
        if a == 0.0:
            k = -float((slope * by_h) @ mesh.area)
            centre = h + float(mesh.K0 @ p)
            return Deformed(h, force, k, energy, centre, centre - h, 0.0, g.size)
        d = -h
        force = 2.0 * E * (a * d - a**3 / (3.0 * R)) + 4.0 * float(mesh.weight @ q) + rest
        energy += E * (d * d * a - 2.0 / 3.0 * d * a**3 / R + a**5 / (5.0 * R * R))
        energy += math.pi * a * a * float(self.law.energy(np.zeros(1))[0])
        # At fixed h the force does not depend on a in first order, the energy being stationary: k = -dF/dh.
        k = self._contact_stiffness(mesh, slope, np.asarray(by_h))
        return Deformed(h, force, k, energy, 0.0, d, a, g.size)

    def _contact_stiffness(self, mesh: Mesh, slope: Floats, by_h: Floats) -> float:
        """-dF/dh at fixed a: where q is continuous at a, F is stationary in a."""
        dq = mesh.B @ (slope * by_h)
        return 2.0 * self.E * mesh.a - 4.0 * float(mesh.weight @ dq)

    def _beyond(self, gap: float) -> float:
        """2 pi R Int W from a gap on, of a law that has almost ended there [J]."""
        gaps = gap * np.geomspace(1.0, 1e4, 400) if gap > 0.0 else np.zeros(2)
        return float(2.0 * np.pi * self.R * np.trapezoid(self.law.energy(gaps) * gaps, np.log(gaps)))
