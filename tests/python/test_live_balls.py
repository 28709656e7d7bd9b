# SPDX-License-Identifier: BSD-3-Clause
"""Balls of a task in the live view: their force acts on the session's lever, the tip pushes them and they each other,
and a push is undone."""

from __future__ import annotations

import re
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch_app.live import charts, subject
from nanotouch_app.live.subject import RADIUS
from test_live_dents import Watched
from touching import newest, result_of

WIDTH = 10e-6
START = (0.35 * WIDTH, 0.5 * WIDTH)  # of the ball that is pushed


@pytest.fixture
def watched() -> Any:
    """A session on glass."""
    made = Watched("latex_on_glass")
    made.advance(0.05)
    yield made
    made.host.close()


def begun(watched: Watched, name: str = "push") -> None:
    """The balls of a task are laid."""
    watched.answer({"do": "task", "name": name, "seed": 1})
    watched.advance(0.05)


def places(watched: Watched) -> Any:
    """Where they lie, as it was told last."""
    return np.array(newest(watched.told, "particles")["places"])


def go(watched: Watched, x: float, y: float, step: float = 20e-9) -> list[Any]:
    """To a place by small steps; the frames on the way."""
    seen = []
    for _ in range(2000):
        frame = watched.observer.newest()
        way = np.array([x, y]) - frame["tip_position"][:2]
        length = float(np.linalg.norm(way))
        if length < 1e-9:
            return seen
        way = way * min(1.0, step / length)
        watched.answer({"do": "move", "way": (float(way[0]), float(way[1]), 0.0)})
        watched.advance(0.02)
        seen.append(watched.observer.newest())
    raise AssertionError("the tip does not come there")


def test_the_hand_feels_a_ball_until_it_is_lost(watched: Watched) -> None:
    """Against a model of its own kind: rolling takes 4 F_c xi (a/a0)^1.5 / R with the load that the lever shows, at the
    height of the contact; and the lever bends up by what the flank lifts."""
    begun(watched)
    ball = places(watched)[0]
    frames = go(watched, ball[0] + 0.25e-6, ball[1])  # from the right: it was reached, and is rolling
    rolling = 4.0 * 1.5 * np.pi * 0.06 * 0.0084 * RADIUS  # of a ball that bears nothing; pushed at its equator or above
    last = frames[-1]["tip_force"]
    assert last[0] > 0.0
    assert last[2] > 0.0
    assert 0.4 * rolling < last[0] < 4.0 * rolling
    assert abs(last[1]) < 0.05 * abs(last[0])
    stiffness = float(watched.host.session.rig.probe.spring_constant)
    off = [stiffness * frame["deflection"] - frame["tip_force"][2] for frame in frames[-12:]]
    assert abs(np.mean(off)) < 3.0 * np.std(off) / np.sqrt(12.0)  # the reading's noise
    assert places(watched)[0, 0] < ball[0] - 50e-9
    assert watched.host.session.particles.forces[0][0] == pytest.approx(last[0], rel=1e-6)
    watched.answer({"do": "choose", "number": 0})
    assert "take the tip away" in newest(watched.told, "refused")["why"]
    go(watched, ball[0] + 1e-6, ball[1])
    assert watched.observer.newest()["tip_force"][0] == 0.0
    told = [event for message in watched.told if message["tell"] == "particles" for event in message["events"]]
    assert told == ["snap", "tear"]


def test_the_band_stretches_sideways(watched: Watched) -> None:
    begun(watched)
    go(watched, START[0] + 0.25e-6, START[1])
    sideways = watched.seen.sideways
    assert sideways[0] == pytest.approx(watched.observer.newest()["tip_force"][0])
    assert watched.seen.feel().level >= float(np.linalg.norm(sideways)) / watched.seen.load


def test_a_push_is_undone_and_rewound(watched: Watched) -> None:
    begun(watched)
    lay = places(watched)
    assert watched.host.world()["undo"] == 0
    go(watched, lay[0, 0] + 0.25e-6, lay[0, 1])
    watched.answer({"do": "undo"})  # nothing to undo yet: the tip still pushes
    go(watched, lay[0, 0] + 1e-6, lay[0, 1])
    assert places(watched)[0, 0] < lay[0, 0] - 50e-9
    assert watched.host.world()["undo"] == 1
    watched.answer({"do": "undo"})
    watched.advance(0.02)
    np.testing.assert_array_equal(places(watched)[0, :2], lay[0, :2])
    assert watched.host.world()["undo"] == 0


def test_balls_push_each_other(watched: Watched) -> None:
    session = watched.host.session
    x, y = 0.7 * WIDTH, 0.5 * WIDTH
    for number in range(3):
        session.lay(number, (x + number * 2.02 * RADIUS, y))
    before = session.particles.positions
    frames = go(watched, x - 0.1e-6, y)
    after = session.particles
    assert (after.positions[:, 0] > before[:, 0] + 0.1e-6).all()
    assert after.touches == [1, 0, 0]
    assert (np.diff(after.positions[:, 0]) > 2.0 * RADIUS - 2e-9).all()
    assert after.dissipated > 0.0
    assert frames[-1]["tip_force"][0] < 0.0
    go(watched, x - 2e-6, y)
    watched.advance(0.02)
    watched.answer({"do": "undo"})
    watched.advance(0.02)
    np.testing.assert_array_equal(session.particles.positions[:, :2], before[:, :2])


def test_where_the_tip_is_no_ball_is_laid(watched: Watched) -> None:
    go(watched, *START)
    watched.answer({"do": "task", "name": "push", "seed": 1})
    assert "move it away first" in newest(watched.told, "refused")["why"]
    assert watched.host.core.state["task"] == ""
    go(watched, 0.5 * WIDTH, 0.5 * WIDTH)
    watched.answer({"do": "task", "name": "push", "seed": 1})
    watched.answer({"do": "task", "name": "pattern", "seed": 1})  # those of the first task are put aside
    watched.advance(0.02)
    found = places(watched)
    assert len(found) == 5
    assert (found[:, :2] > 0.1 * WIDTH).all()
    assert len(watched.host.session.particles.losses) == 5


@pytest.mark.parametrize("steps", [3.0, 0.01])
def test_a_tip_that_comes_down_on_a_ball_keeps_the_promise(watched: Watched, steps: float) -> None:
    """Fast: the supervisor lifts it. Slowly: the hand gives way before the limit."""
    begun(watched)
    x, y = START
    for _ in range(60):
        watched.answer({"do": "wheel", "steps": -20.0})
        watched.advance(0.02)
        if watched.observer.newest()["tip_position"][2] > 2.1 * RADIUS:
            break
    go(watched, float(x), float(y))
    session = watched.host.session
    observer, largest, states = nt.frames.attach(watched.host.name), 0.0, set()
    for _ in range(700):
        touches = watched.observer.newest()["tip_position"][2] < 2.0 * RADIUS + 400e-9
        watched.answer({"do": "wheel", "steps": steps if touches or steps > 1.0 else 1.0})
        watched.advance(0.02)
        frames = observer.read()
        largest, states = max(largest, float(frames["tip_force"][:, 2].max())), states | set(frames["state"])
        if 2 in states or largest > 0.7 * session.settings.limits.force:
            break
    observer.close()
    assert (2 in states) == (steps > 1.0)
    assert 0.5 * session.settings.limits.force < largest < session.guarantee().force


def test_a_ball_that_is_nowhere_near_its_ring_does_not_pass(watched: Watched) -> None:
    begun(watched)
    watched.answer({"do": "choose", "number": 0})
    task, (figures, _) = newest(watched.told, "task"), result_of(watched.host)
    assert (task["passed"], task["score"]) == (False, 0.0)
    assert float(figures["largest error [m]"]) == pytest.approx(2e-6, rel=1e-6)


def test_balls_are_those_of_the_scene() -> None:
    scene = nt.Scene(tip={"radius": 30e-9})
    balls = subject.balls(scene)
    assert (balls.particle.radius, balls.particle.tip_radius) == (RADIUS, 30e-9)
    with pytest.raises(nt.Error, match="tip_radius"):
        nt.Session(nt.Scene(), particles=balls, minimum_margin=0.0)


def test_what_a_push_costs_is_heat(watched: Watched) -> None:
    """The work of the hand goes into the ball, which gives next to nothing back: rolling friction times way."""
    begun(watched)
    go(watched, START[0] + 0.2e-6, START[1])
    watched.hear(watched.host.clock())
    words = charts._energies(watched.seen)
    found = {
        name: float(value)
        for name, value in re.findall(r"(hand|tip|heat) (?:about )?(-?[\d.]+)", words.replace("- ", "-"))
    }
    hand, _, _, heat = watched.seen.clock["energies"]
    spent = watched.host.session.particles.dissipated
    assert found["heat"] > 0.8 * found["hand"] > 0.0, words
    assert heat == pytest.approx(spent, rel=0.1)
    assert abs(found["tip"]) < 0.2 * found["hand"], words
    assert hand == pytest.approx(spent, rel=0.25)
