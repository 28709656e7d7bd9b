# SPDX-License-Identifier: BSD-3-Clause
"""One hand drives and others watch: the lease of the command queue, and a window that asks through it."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator
from typing import Any

import nanotouch as nt
import pytest
from nanotouch.errors import Error
from nanotouch_app.live.host import Host
from nanotouch_app.live.remote import TAKEN, Lease, Remote
from nanotouch_app.live.subject import of_preset


@pytest.fixture
def led() -> Iterator[tuple[Host, list[dict[str, Any]]]]:
    told: list[dict[str, Any]] = []
    host = Host(of_preset("silicon_in_air"), told.append, stepped=True)
    host.advance(0.05)
    yield host, told
    host.close()


def answered(session: nt.Session, remote: Remote, count: int = 1) -> list[Any]:
    end, found = time.monotonic() + 20.0, []
    while len(found) < count and time.monotonic() < end:
        session.advance(0.001)
        found += remote.answers()
        time.sleep(0.002)
    return found


def test_one_hand_drives(led: tuple[Host, list[dict[str, Any]]]) -> None:
    host, told = led
    other = Lease(host.name)
    other.take()
    before = host.core.state["height"]
    host.answer({"do": "wheel", "steps": 3.0})
    assert "another program drives this session" in told[-1]["why"]
    assert host.core.state["height"] == before
    host.answer({"do": "stop"})  # needs no lease
    host.advance(0.01)
    assert host.session.state == "LATCHED"
    other.close()
    host.answer({"do": "arm"})
    rest = host.core.state["height"]
    host.answer({"do": "wheel", "steps": 3.0})
    assert host.core.state["height"] < rest
    with pytest.raises(Error, match="another program drives"):
        Lease(host.name).take()


def test_a_dead_hand_blocks_nobody(led: tuple[Host, list[dict[str, Any]]]) -> None:
    host, told = led
    other = Lease(host.name)
    other.take()
    time.sleep(1.1)
    host.answer({"do": "wheel", "steps": 1.0})
    assert not [message for message in told if message["tell"] == "refused"]
    other.close()


def test_a_window_that_watches_changes_the_world_through_the_queue() -> None:
    name = f"watched-{os.getpid()}"
    session = nt.Session(seed=1)
    session.publish(name)
    session.advance(0.01)
    remote = Remote(name, nt.frames.attach(name))
    assert remote.news() is not None
    assert remote.news() is None
    for what, field, value in (("scene", "medium.relative_humidity", 0.0), ("settings", "gains.force_gain", 3.0),
                               ("settings", "gains.alpha_f", 1.5e6)):  # fmt: skip
        remote.ask({"do": "change", "what": what, "field": field, "value": value})
        [(message, answer)] = answered(session, remote)
        assert (message["field"], answer.status) == (field, 0)
        assert getattr(session, what)[field] == value
        assert remote.world[what][field.split(".")[0]][field.split(".")[1]] == value
    remote.ask({"do": "change", "what": "scene", "field": "tip.radius", "value": -1.0})
    [(_, answer)] = answered(session, remote)
    assert answer.status != 0
    with pytest.raises(Error, match="this window watches"):
        remote.ask({"do": "wheel", "steps": 1.0})
    remote.ask({"do": "stop"})
    session.advance(0.01)
    assert session.state == "LATCHED"
    remote.ask({"do": "arm"})
    answered(session, remote)
    remote.close()


def test_a_view_outlives_a_session_that_stands_still_and_a_lease_that_is_lost() -> None:
    """It died of the first after a second of silence: "a device is missing or failed"."""
    name = f"still-{os.getpid()}"
    session = nt.Session(seed=1)
    session.publish(name)
    session.advance(0.01)
    remote = Remote(name, nt.frames.attach(name))
    change = {"do": "change", "what": "scene", "field": "medium.relative_humidity", "value": 0.3}
    remote.turn(None)
    remote.ask(change)
    time.sleep(1.05)  # NT_FRAMES_SILENCE
    assert remote.turn(None) == []
    [(message, answer)] = answered(session, remote)
    assert (message, answer.status) == (change, 0)
    remote.turn(None)
    remote.ask(change)
    remote.lease.client.release()
    other = Lease(name)
    other.take()
    session.advance(0.01)
    (told,) = remote.turn(None)
    assert told == {"tell": "refused", "why": f"refused: {TAKEN}", "field": change["field"]}
    other.close()
    remote.close()


def test_the_host_tells_what_another_program_has_changed() -> None:
    told: list[dict[str, Any]] = []
    host = Host(of_preset("silicon_in_air"), told.append)
    remote = Remote(host.name, nt.frames.attach(host.name))
    remote.ask({"do": "change", "what": "scene", "field": "medium.relative_humidity", "value": 0.1})
    end = time.monotonic() + 20.0
    while not [message for message in told if message["tell"] == "world"] and time.monotonic() < end:
        host.clock()
        time.sleep(0.05)
    remote.close()
    host.close()
    world = [message for message in told if message["tell"] == "world"][-1]
    assert world["scene"]["medium"]["relative_humidity"] == 0.1


def test_who_attaches_later_is_told_what_holds_now() -> None:
    """After changes of the session's own and of an observer; with no change of what a recording says it began with."""
    session = nt.Session(seed=1)
    session.publish(f"late-{os.getpid()}")
    session.advance(0.01)
    first = nt.frames.attach(f"late-{os.getpid()}")
    remote = Remote(f"late-{os.getpid()}", first)
    assert remote.news() is not None
    session.rescale(alpha_f=1.5e6)
    session.change("scene", "medium.relative_humidity", 0.2)
    remote.ask({"do": "change", "what": "settings", "field": "gains.force_gain", "value": 3.0})
    answered(session, remote)
    with nt.frames.attach(f"late-{os.getpid()}") as late:
        about = json.loads(late.description)
        assert late.changes == first.changes > 3
    assert about["settings"] == session.settings.to_dict()
    assert about["settings"]["gains"]["force_gain"] == 3.0
    assert about["settings"]["gains"]["alpha_f"] == 1.5e6
    assert about["scene"]["medium"]["relative_humidity"] == 0.2
    assert about["stability_margin"] == session.stability_margin
    assert about["guaranteed_force"] == session.guarantee().force
    world = remote.news()
    assert world is not None
    assert world["scene"] == session.scene.to_dict()
    assert session.metadata()["settings"]["gains"]["alpha_f"] != 1.5e6
    remote.close()
    first.close()


def test_a_change_of_another_program_is_published_by_the_host(led: tuple[Host, list[dict[str, Any]]]) -> None:
    host, _ = led
    remote = Remote(host.name, nt.frames.attach(host.name))
    remote.ask({"do": "change", "what": "scene", "field": "medium.relative_humidity", "value": 0.1})
    end = time.monotonic() + 20.0
    while not remote.answers() and time.monotonic() < end:
        host.advance(0.01)
    host.clock()
    with nt.frames.attach(host.name) as late:
        assert json.loads(late.description)["scene"]["medium"]["relative_humidity"] == 0.1
    remote.close()
