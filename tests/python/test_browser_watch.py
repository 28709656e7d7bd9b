# SPDX-License-Identifier: BSD-3-Clause
"""A session that a device or another program leads, in browsers: `--browser` beside `--hand` or a rig file."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch_app.main import main

pytest.importorskip("aiohttp", reason="pip install 'nanotouch[browser]'")
from nanotouch_app.browser.watch import Watcher

LONG = 60.0  # on a loaded machine [s]
MOUSE = {"motor": "no", "gauge": "no"}  # no loop closes through such a hand
Told = list[dict[str, Any]]


class Watched:
    """A session that is advanced by hand, and what its pages are told."""

    def __init__(self, session: nt.Session, **leads: bool) -> None:
        self.session = session
        self.name = f"watched-{os.getpid()}-{time.monotonic_ns()}"
        session.publish(self.name)
        session.advance(0.01)
        self.told: Told = []
        self.watcher = Watcher(self.name, self.told.append, **leads)
        self.watcher.report()

    def of(self, kind: str) -> dict[str, Any]:
        """The last message of a kind."""
        return next(message for message in reversed(self.told) if message["tell"] == kind)

    def ask(self, do: str, **more: Any) -> None:
        """As a page asks; then what was asked is taken."""
        self.watcher.answer({"do": do, **more})
        end = time.monotonic() + LONG
        while self.watcher.remote.asked and time.monotonic() < end:
            self.session.advance(0.001)
            self.watcher.tick()
        self.session.advance(0.1)
        self.watcher.tick()


@pytest.fixture
def watched(request: pytest.FixtureRequest) -> Iterator[Callable[..., Watched]]:
    made: list[Watched] = []

    def begin(session: nt.Session, **leads: bool) -> Watched:
        made.append(Watched(session, **leads))
        return made[-1]

    yield begin
    for one in made:
        one.watcher.close()


def test_a_page_is_told_what_it_draws_and_changes_what_has_a_slider(watched: Callable[..., Watched]) -> None:
    one = watched(nt.Session(seed=1, recorded=False))
    kinds = [message["tell"] for message in one.told]
    assert kinds[:3] == ["sliders", "world", "guide"]
    world, (sliders,) = one.of("world"), [message["sliders"] for message in one.told if message["tell"] == "sliders"]
    assert world["leads"] == ""
    assert world["name"] == one.name
    for row in sliders:
        assert len(row["stops"]) == 201
        assert row["stops"][0][0] < row["stops"][-1][0]
        assert world["shown"][row["field"]]
    one.ask("change", what="scene", field="medium.relative_humidity", value=0.2)
    assert one.of("world")["scene"]["medium"]["relative_humidity"] == 0.2
    assert one.of("world")["shown"]["medium.relative_humidity"] == "20 %"
    assert sum(message["tell"] == "sliders" for message in one.told) == 1  # their ends stay
    for what, more in (("wheel", {"steps": 1.0}), ("pause", {}), ("preset", {"name": "mica_in_air"})):
        one.told.clear()
        one.ask(what, **more)
        assert "watches" in one.of("refused")["why"]
    one.told.clear()
    one.ask("device", name="wheel")
    one.ask("press", on=False)  # a page that is closed
    assert not [message for message in one.told if message["tell"] == "refused"]
    one.ask("stop")
    assert one.session.state == "LATCHED"


@pytest.mark.parametrize(("leads", "axis"), [("leads", 2), ("sideways", 0)])
def test_a_page_leads_what_no_device_leads(leads: str, axis: int, watched: Callable[..., Watched]) -> None:
    surface = nt.Surface.touched_by(nt.Scene(), nt.surface.flat(size=4e-6, pixels=64))
    rig = nt.Rig(master=MOUSE) if leads == "leads" else nt.Rig()
    one = watched(nt.Session(rig=rig, surface=surface, path=[(2e-6, 2e-6)], seed=1, recorded=False), **{leads: True})
    before = one.watcher.frame["tip_position"].copy()
    if leads == "leads":
        one.ask("wheel", steps=2.0)
    else:
        one.ask("move", way=[0.4e-6, 0.0, 0.0])
        one.ask("wheel", steps=2.0)
        assert "leads the height" in one.of("refused")["why"]
    way = one.watcher.frame["tip_position"] - before
    assert abs(way[axis]) > 1e-9
    assert abs(way[axis]) == pytest.approx(float(np.abs(way).max()))


def test_options_that_would_do_nothing_beside_a_device_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    for words, told in (
        (("--browser", "--dark"), "--dark cannot be used with it"), (("--port", "8000"), "--port cannot be used"),
        (("--browser", "--task", "find"), "--task cannot be used with it"),
        (("--browser", "--page", "none.html"), "none.html: no such file"),
    ):  # fmt: skip
        assert main(["live", "--hand", "forcedimension", *words]) == 2
        assert told in capsys.readouterr().err
