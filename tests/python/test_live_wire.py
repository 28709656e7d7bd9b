# SPDX-License-Identifier: BSD-3-Clause
"""The wire of a task in the live view: laid, felt, undone, rewound, drawn; its score."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from nanotouch.manipulation import nanowire
from nanotouch_app import view
from nanotouch_app.live import film
from nanotouch_app.live.subject import of_preset
from test_live_balls import go
from test_live_dents import Watched
from touching import newest

WIDTH = 6e-6
START, TARGET = (0.5, 0.4, 0.0), (0.5, 0.5, 0.4)  # of its middle, over the width; angle [rad]


@pytest.fixture
def watched() -> Any:
    """A session on glass."""
    made = Watched("wire_on_glass")
    made.advance(0.05)
    yield made
    made.host.close()


def begun(watched: Watched) -> None:
    """It is laid."""
    watched.answer({"do": "task", "name": "wire", "seed": 1})
    watched.advance(0.05)


def pose(watched: Watched) -> list[float]:
    """Its middle and angle, as it was told last."""
    told = newest(watched.told, "particles")
    return [*told["places"][0][:2], told["angles"][0]]


def test_the_hand_feels_it_and_a_push_is_undone(watched: Watched) -> None:
    """From above, near its right end: it turns, and resists with 2 q c; Z lays it back with its angle."""
    begun(watched)
    wire = watched.host.subject.rod(watched.host.scene)  # type: ignore[misc]
    x, y = START[0] * WIDTH + 0.8e-6, START[1] * WIDTH
    go(watched, x, y + 0.3e-6)
    frames = go(watched, x, y)
    force = max((frame["tip_force"] for frame in frames), key=lambda force: float(force[1]))
    c = math.sqrt(0.8**2 + 1.0) - 0.8
    assert force[1] == pytest.approx(2.0 * wire.friction * c * 1e-6, rel=0.05)
    assert force[2] == pytest.approx(math.tan(0.26) * np.hypot(force[0], force[1]), rel=0.05)
    assert pose(watched)[2] < -0.05
    go(watched, x, y + 0.4e-6)
    assert watched.host.world()["undo"] == 1
    watched.answer({"do": "undo"})
    watched.advance(0.02)
    np.testing.assert_array_equal(pose(watched), [START[0] * WIDTH, START[1] * WIDTH, START[2]])
    assert watched.host.world()["undo"] == 0
    told = [message for message in watched.told if message["tell"] == "particles"]
    assert [event for message in told for event in message["events"]] == ["snap", "tear"]
    assert (told[-1]["length"], told[-1]["angles"]) == (wire.length, [START[2]])


def test_its_ends_may_lie_in_either_ring(watched: Watched) -> None:
    begun(watched)
    session, place = watched.host.session, (TARGET[0] * WIDTH, TARGET[1] * WIDTH + 0.05e-6)
    go(watched, 0.5e-6, 0.5e-6)
    for angle in (TARGET[2], TARGET[2] + math.pi):
        session.lay_rod((*place, angle))
        watched.advance(0.25)
        assert newest(watched.told, "task")["now"].startswith("50.0 nm off")
    watched.answer({"do": "choose", "number": 0})
    task = newest(watched.told, "task")
    assert (task["passed"], task["score"]) == (True, 100.0)


def test_a_task_lays_the_sample_that_it_needs(watched: Watched) -> None:
    """Balls on glass for a wire there are none, and the other way round."""
    watched.answer({"do": "task", "name": "push", "seed": 1})
    assert watched.host.subject.name == "latex_on_glass"
    watched.advance(0.05)
    begun(watched)
    assert watched.host.subject.name == "wire_on_glass"


def test_where_the_tip_is_it_is_not_laid(watched: Watched) -> None:
    go(watched, START[0] * WIDTH, START[1] * WIDTH)
    watched.answer({"do": "task", "name": "wire", "seed": 1})
    assert "move it away first" in newest(watched.told, "refused")["why"]
    assert watched.host.core.state["task"] == ""


def test_the_picture_draws_it() -> None:
    """As long and as thick as it is, at its place and its angle."""
    pytest.importorskip("vtkmodules")
    works, reason = view.probe()
    if not works:
        pytest.skip(reason)
    studio = film.Studio(of_preset("wire_on_glass"))
    studio.host.answer({"do": "task", "name": "wire", "seed": 1})
    balls, wire = studio.picture.stage.balls, nanowire()
    (actor,) = balls.balls
    assert len(balls.rings) == 2
    for angle in (START[2], 0.5):
        studio.host.session.lay_rod((0.5 * WIDTH, 0.3 * WIDTH, angle))
        studio.host.advance(0.02)
        left, right, near, far, low, high = np.array(actor.GetBounds()) * balls.length
        whole, wide = wire.length + 2.0 * wire.radius, 2.0 * wire.radius  # VTK bounds the box that is turned
        assert right - left == pytest.approx(whole * math.cos(angle) + wide * math.sin(angle), rel=0.02)
        assert far - near == pytest.approx(whole * math.sin(angle) + wide * math.cos(angle), rel=0.02)
        assert high - low == pytest.approx(wide, rel=0.02)
        assert 0.5 * (left + right) == pytest.approx(0.5 * WIDTH, rel=1e-3)
    studio.close()
