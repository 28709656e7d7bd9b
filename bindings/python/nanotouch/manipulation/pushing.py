# SPDX-License-Identifier: BSD-3-Clause
"""A scripted operator: find a particle by two scan lines, push it from behind, look again (docs/manipulation.md).

The bench drifts and is noisy. The operator knows only what its lines show: where the particle is, and how far a mark
has drifted that nobody moves. In between, its map follows the tip.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import permutations
from typing import NamedTuple

import numpy as np

from nanotouch._arrays import Floats, as_floats, check_between
from nanotouch.errors import Error, InvalidValue
from nanotouch.units import in_words

from .lever import AHEAD, Lever, low_of, needed, reach_of
from .particle import Particle, ParticlesState
from .particles import Particles

_SHOWN = 8  # points of a push in the track


class Lost(Error):
    """A look did not find the particle, or it hangs on the tip."""


@dataclass(frozen=True)
class Bench:
    """What disturbs the operator, and how fast it works.

    Parameters
    ----------
    drift : float
        Speed of the sample under the tip [m/s]; its direction wanders.
    height_noise : float
        Standard deviation of each height of a line [m].
    position_noise : float
        Standard deviation of where the tip is, one value for each move and line [m].
    speed : float
        Of the tip [m/s].
    line_time : float
        Of one scan line of ``points`` points [s].
    points : int
        Of a line.
    """

    drift: float = 1e-9
    height_noise: float = 1e-9
    position_noise: float = 2e-9
    speed: float = 2e-6
    line_time: float = 1.0
    points: int = 128

    def __post_init__(self) -> None:
        check_between("speed", self.speed, "m/s", above=0.0)
        check_between("line_time", self.line_time, "s", above=0.0)
        check_between("points", self.points, "", above=15)
        for name, unit in (("drift", "m/s"), ("height_noise", "m"), ("position_noise", "m")):
            if not 0.0 <= getattr(self, name) < np.inf:
                raise InvalidValue(f"{name} = {getattr(self, name):g} {unit}: valid is 0 {unit} and above")


class Track(NamedTuple):
    """Where tip and particle went, of the sample, and what the tip felt; one row per point. Empty for a task without
    moves."""

    time: Floats
    """[s]"""
    tip: Floats
    """x, y, z of its apex [m]"""
    particle: Floats
    """x, y, z of its centre [m]"""
    force: Floats
    """x, y, z, on the tip [N]"""


class Pushed(NamedTuple):
    """How a task ended. Positions are of the sample, without its drift [m]."""

    position: Floats
    """where the particle is, x and y [m]"""
    error: float
    """its distance from the target [m]"""
    believed: float
    """distance that the operator's last look showed [m]"""
    pushes: int
    """moves of the tip against it"""
    lines: int
    """scan lines, those of the mark too"""
    duration: float
    """[s]"""
    looks: Floats
    """where each look found it, x and y [m]"""
    spun: float
    """how far it has turned about the vertical [rad]"""
    track: Track
    """of all moves"""


@dataclass
class World:
    """What is true: particles, drift, time. The operator's coordinates are those of the stage."""

    laid: Particles
    bench: Bench
    random: np.random.Generator
    state: ParticlesState
    number: int = 0
    """the particle that is worked on"""
    time: float = 0.0
    lines: int = 0
    drifted: Floats = field(default_factory=lambda: np.zeros(2))
    heading: float = 0.0
    rows: list[Floats] = field(default_factory=list)

    @property
    def particle(self) -> Particle:
        """What each is like."""
        return self.laid.particle

    @property
    def place(self) -> Floats:
        """Where the one that is worked on lies, x and y on the sample [m]."""
        return np.asarray(self.state.positions[self.number, :2])

    def wait(self, duration: float) -> None:
        """The direction of the drift wanders by 3 degrees in a second (root of time)."""
        self.heading += 0.05 * np.sqrt(duration) * self.random.standard_normal()
        way = np.array([np.cos(self.heading), np.sin(self.heading)])
        self.drifted = self.drifted + duration * self.bench.drift * way
        self.time += duration

    def move(self, points: Floats) -> None:
        """Along points x, y, z of the stage; the sample drifts under each part of the way."""
        off = self.bench.position_noise * self.random.standard_normal(2)
        last = self.state.base + np.array([*self.drifted, 0.0])
        for point in points:
            self.wait(float(np.linalg.norm(point - last)) / self.bench.speed)
            x, y = point[:2] - self.drifted + off
            path = self.laid.run(x, y, point[2], state=self.state)
            self.state, last = path.state, point
            there = path.position[-1, self.number]
            self.rows.append(np.array([self.time, *path.tip[-1], *there, *path.force[-1]]))
        if path.happened("lifted")[-1].any():
            raise Lost("the particle hangs on the tip, which holds it more than the substrate does")

    def track(self, first: int = 0) -> Track:
        """Of all moves so far, from a row on."""
        rows = np.array(self.rows[first:]).reshape(-1, 10)
        return Track(rows[:, 0], rows[:, 1:4], rows[:, 4:7], rows[:, 7:])

    def heights(self, centre: Floats, axis: int, at: Floats) -> tuple[Floats, Floats]:
        """Of a line along an axis, through `centre` of the stage, over a sphere that is at `at`: places from the centre
        on, and heights over the middle of the sphere."""
        reach = self.particle.radius + self.particle.tip_radius
        along = np.linspace(-1.3, 1.3, self.bench.points) * reach
        begin = self.drifted
        self.wait(self.bench.line_time)
        self.lines += 1
        share = np.linspace(0.0, 1.0, self.bench.points)[:, None]
        places = np.tile(centre, (self.bench.points, 1))
        places[:, axis] += along
        away = places - begin - share * (self.drifted - begin) - at
        away = away + self.bench.position_noise * self.random.standard_normal(2)
        height = np.sqrt(np.maximum(reach**2 - np.sum(away**2, axis=1), 0.0))  # over the middle of the sphere
        height += self.bench.height_noise * self.random.standard_normal(self.bench.points)
        return along, height

    def line(self, centre: Floats, axis: int, at: Floats) -> float:
        """Where such a line shows the middle of the sphere."""
        reach = self.particle.radius + self.particle.tip_radius
        along, height = self.heights(centre, axis, at)
        seen = height > 0.5 * reach
        if np.count_nonzero(seen) < 8:
            raise Lost(
                f"no particle within {in_words(0.8 * reach, 'm', 3)} of where it should be: a scan of the whole is due"
            )
        unknowns = np.stack([2.0 * along[seen], np.ones(np.count_nonzero(seen))], axis=1)
        middle = np.linalg.lstsq(unknowns, height[seen] ** 2 + along[seen] ** 2, rcond=None)[0][0]
        return float(centre[axis] + middle)

    def look(self, guess: Floats, at: Floats) -> Floats:
        """Two lines: through the guess, then through the middle that the first one showed. Of the stage."""
        found = guess.copy()
        for axis in (1, 0):
            found[axis] = self.line(found, axis, at)
        return found


def push(
    particle: Particle,
    target: tuple[float, float],
    *,
    start: tuple[float, float] = (0.0, 0.0),
    seen: tuple[float, float] | None = None,
    bench: Bench | None = None,
    tolerance: float = 30e-9,
    longest: float | None = None,
    lever: Lever | None = None,
    most: int = 200,
    seed: int = 0,
    progress: Callable[[Pushed], None] | None = None,
) -> Pushed:
    """Push a particle to a target, until a look shows it there.

    Parameters
    ----------
    particle : Particle
    target, start : tuple of float
        x and y on the sample [m].
    seen : tuple of float, optional
        Where a map shows it [m]: there the operator looks first; by default at ``start``.
    bench : Bench, optional
        What disturbs; the defaults if left out.
    tolerance : float
        Distance that the operator is content with [m].
    longest : float, optional
        Of one push [m]; half the radius of the particle if left out.
    lever : Lever, optional
        On which the tip hangs. It is left out where it gives less than a tenth of the tolerance (``lever.give``), and
        the tip held.
    most : int
        Pushes before it gives up; `believed` is then above the tolerance.
    seed : int
        Of noise and drift.
    progress : callable, optional
        Called after each push with what is done so far.

    Raises
    ------
    nanotouch.manipulation.Lost
        A look did not find the particle, or it hangs on the tip.
    InvalidValue
        The lever is too soft sideways: the last push, over the tolerance, bends it and leaves the particle where it is,
        though the operator goes a fifth of the particle's radius further.
    """
    check_between("tolerance", tolerance, "m", above=0.0)
    check_between("most", most, "", above=0)
    longest = longest if longest is not None else 0.5 * particle.radius
    check_between("longest", longest, "m", above=0.0)
    laid = Particles(particle, lever=needed(lever, particle, min(tolerance, longest)))
    world = world_of(World, laid, bench or Bench(), [start], seed)
    mark = np.array([start[0], start[1] - 10.0 * particle.radius])
    operator = Operator(world, mark, as_floats(target, "target"), longest)
    return operator.work(seen or start, tolerance, most, progress)


def world_of(
    kind: type[World], laid: Particles, bench: Bench, starts: Sequence[tuple[float, float]], seed: int
) -> World:
    """With the tip high above the first of them."""
    random = np.random.default_rng(seed)
    state = laid.place(starts, (*starts[0], 4.0 * laid.particle.radius))
    return kind(laid, bench, random, state, heading=2.0 * np.pi * random.uniform())


@dataclass
class Operator:
    """What it believes: the drift that the mark shows, and by how much the particle springs back."""

    world: World
    mark: Floats
    target: Floats
    longest: float
    ahead: Floats = field(default_factory=lambda: np.zeros(2))
    drift: Floats = field(default_factory=lambda: np.zeros(2))

    def work(
        self,
        seen: tuple[float, float],
        tolerance: float,
        most: int,
        progress: Callable[[Pushed], None] | None = None,
    ) -> Pushed:
        world = self.world
        begun = world.lines, world.time, len(world.rows)
        drift = self.drift_of(self.drift)
        found = self._find(as_floats(seen, "seen") + drift)
        looks, pushes = [found - drift], 0
        while float(np.linalg.norm(self.target - looks[-1])) > tolerance and pushes < most:
            self._push(found, drift)
            guess = found + self._wanted(found - drift) - self.ahead
            pushes += 1
            drift = self.drift_of(drift)
            found = self._find(guess)
            self._learn(looks[-1], found - drift)
            looks.append(found - drift)
            if progress is not None:
                progress(self._done(begun, looks, pushes))
        self.drift = drift
        return self._done(begun, looks, pushes)

    def _done(self, begun: tuple[int, float, int], looks: list[Floats], pushes: int) -> Pushed:
        """What has come of it since lines, time and rows were these."""
        world = self.world
        position = world.place
        error = float(np.linalg.norm(position - self.target))
        left = float(np.linalg.norm(looks[-1] - self.target))
        spun = float(world.laid.run(*world.state.base, state=world.state).turned[-1, world.number, 2])
        lines, duration = world.lines - begun[0], world.time - begun[1]
        return Pushed(position, error, left, pushes, lines, duration, np.array(looks), spun, world.track(begun[2]))

    def drift_of(self, drift: Floats) -> Floats:
        """What the mark shows; the last one helps to find it."""
        return self.world.look(self.mark + drift, self.mark) - self.mark

    def _find(self, guess: Floats) -> Floats:
        return self.world.look(guess, self.world.place)

    def _wanted(self, found: Floats) -> Floats:
        """The way of the next push; what it springs back by is added."""
        left = self.target - found
        length = float(np.linalg.norm(left))
        return left * min(1.0, self.longest / length) + self.ahead * left / length

    def _learn(self, before: Floats, after: Floats) -> None:
        """How much shorter than wanted the particle went, along the push."""
        wanted = self._wanted(before)
        unit = wanted / np.linalg.norm(wanted)
        short = float(np.dot(wanted - (after - before), unit))
        self.ahead = np.clip(0.5 * (self.ahead + short), 0.0, AHEAD * self.world.particle.radius)

    def _push(self, found: Floats, drift: Floats) -> None:
        """Down behind the particle, against it, back, and up. Of the stage."""
        particle, way = self.world.particle, self._wanted(found - drift)
        length = float(np.linalg.norm(way))
        low, high = low_of(particle), 4.0 * particle.radius
        reach = reach_of(particle, low)
        behind = -reach - 0.3 * particle.radius
        against = np.linspace(behind, length - reach, _SHOWN + 1)[1:]
        points = [(behind, high), (behind, low), *((along, low) for along in against), (behind, low), (behind, high)]
        self.world.move(np.array([[*(found + along * way / length), z] for along, z in points]))


def arrange(
    particle: Particle,
    starts: Sequence[tuple[float, float]],
    targets: Sequence[tuple[float, float]],
    *,
    bench: Bench | None = None,
    tolerance: float = 30e-9,
    lever: Lever | None = None,
    seed: int = 0,
) -> list[Pushed]:
    """Push up to six particles into a pattern, each to the target that keeps all ways short and clear of the others.

    The order is found by trying. On each way the others stay two diameters away, or the pattern is refused. All lie
    there all the time: what drift or a slip brings into the way is pushed, too. `lever` as in :func:`push`.
    """
    if not 1 <= len(starts) <= 6 or len(starts) != len(targets):
        raise InvalidValue(f"{len(starts)} starts, {len(targets)} targets: valid are as many, 1 .. 6")
    check_between("tolerance", tolerance, "m", above=0.0)
    plan = _clear_plan(as_floats(starts, "starts"), as_floats(targets, "targets"), 4.0 * particle.radius)
    laid = Particles(particle, lever=needed(lever, particle, min(tolerance, 0.5 * particle.radius)))
    world = world_of(World, laid, bench or Bench(), starts, seed)
    low, left = min(y for _, y in starts), min(x for x, _ in starts)
    operator = Operator(world, np.array([left, low - 10.0 * particle.radius]), np.zeros(2), 0.5 * particle.radius)
    done: dict[int, Pushed] = {}
    for one, goal in plan:
        world.number, operator.target, operator.ahead = one, np.array(targets[goal]), np.zeros(2)
        done[one] = operator.work(starts[one], tolerance, 200)
    ends, goals = world.state.positions[:, :2], dict(plan)
    errors = [float(np.linalg.norm(ends[one] - targets[goals[one]])) for one in sorted(done)]
    return [done[one]._replace(position=ends[one], error=error) for one, error in enumerate(errors)]


def _clear_plan(starts: Floats, targets: Floats, room: float) -> list[tuple[int, int]]:
    """Pairs of start and target in the order of work."""
    count = len(starts)
    far = np.linalg.norm(starts[:, None] - targets[None], axis=2)
    for goals in sorted(permutations(range(count)), key=lambda goals: float(far[range(count), goals].sum())):
        order = _order(starts, targets[list(goals)], room)
        if order is not None:
            return [(one, goals[one]) for one in order]
    raise InvalidValue(f"pattern: no order of pushes keeps {room:.3g} m between the particles")


def _order(starts: Floats, goals: Floats, room: float) -> list[int] | None:
    """An order in which no way comes nearer than `room` to where another one is then; a greedy one is enough, for who
    has arrived stays, and who is free to go now is so until another has arrived."""
    left, at, order = set(range(len(starts))), starts.copy(), []
    while left:
        free = [one for one in sorted(left) if _clear(at, one, goals[one], room)]
        if not free:
            return None
        order.append(free[0])
        at[free[0]] = goals[free[0]]
        left.remove(free[0])
    return order


def _clear(at: Floats, one: int, goal: Floats, room: float) -> bool:
    way, others = goal - at[one], np.delete(at, one, axis=0) - at[one]
    share = np.clip(others @ way / max(float(way @ way), 1e-30), 0.0, 1.0)
    return bool(np.all(np.linalg.norm(others - share[:, None] * way, axis=1) >= room))
