# SPDX-License-Identifier: BSD-3-Clause
"""Records and events are all that a replay needs: what else a session has done between two ticks is an event, too."""

from __future__ import annotations

import math
import os
import time

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.touch.operator import Hold
from nanotouch.touch.record import Recording

COMMANDS = ("motor_force", "stage_command", "state", "reasons")


class Mouse(nt.hal.Master):
    """A position device that the test moves."""

    z = 0.0

    def read(self) -> nt.hal.Reading:
        return nt.hal.Reading(position=(math.nan, math.nan, self.z))


def replayed(session: nt.Session, *blocks: dict[str, np.ndarray]) -> Recording:
    """What was recorded, after its replay was found the same to the last bit."""
    columns = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    recording = Recording(columns, session.metadata())
    again = recording.replay()
    for name in COMMANDS:
        np.testing.assert_array_equal(again.columns[name], recording.columns[name], err_msg=name)
    return recording


def held(mouse: Mouse) -> nt.Session:
    return nt.Session(rig=nt.Rig(master={"motor": "no", "gauge": "no"}), master=mouse)


def test_a_hand_that_moved_before_the_first_tick_is_replayed() -> None:
    mouse = Mouse()
    session = held(mouse)
    mouse.z = 2e-3
    recording = replayed(session, session.advance(0.05))
    assert np.abs(recording.stage_command).max() < 1e-9
    assert recording.metadata["events"] == [[0, "index", [2e-3]]]


def test_a_hand_that_moved_in_a_pause_is_replayed() -> None:
    mouse = Mouse()
    session = held(mouse)
    session.start("wall")
    time.sleep(0.05)
    session.pause()
    time.sleep(0.05)
    mouse.z = 2e-3
    time.sleep(0.02)
    session.pause(False)
    time.sleep(0.05)
    session.halt()
    recording = replayed(session, session.read(65536))
    assert np.abs(recording.stage_command).max() < 1e-9
    assert [(name, numbers) for _, name, numbers in recording.metadata["events"]] == [
        ("index", [0.0]),
        ("index", [2e-3]),
    ]


def test_a_tip_that_is_led_to_the_border_is_replayed() -> None:
    flat = nt.Surface(nt.surface.flat(pixels=32))
    session = nt.Session(surface=flat, rig=nt.Rig(master={"axes": 3}), path=[(5.99e-6, 3e-6)])
    recording = replayed(session, session.advance(0.5, Hold((9e-3, 0.0, 0.0), math.nan, math.nan, 0.3)))
    assert recording.columns["x"].max() == flat.size[0]
    assert (recording.reasons & (1 << nt.session.REASONS.index("command limited"))).any()


def test_a_change_of_the_scene_after_another_scale_is_replayed() -> None:
    session = nt.Session(minimum_margin=0.0, clearance=20e-9)
    blocks = [session.advance(0.1, nt.Input(1.0, 0.0, 0.0, 0.1))]
    session.rescale(alpha_p=0.3 * session.settings.gains.alpha_p)
    session.change("scene", "sample.youngs_modulus", 5e9)
    session.change("settings", "gains.force_gain", 30.0)
    session.change("scene", "sample.youngs_modulus", 50e9)
    blocks.append(session.advance(1.0))
    recording = replayed(session, *blocks)
    assert (recording.columns["contact_radius"] > 0.0).any()


@pytest.mark.skipif(not os.path.isdir("/dev/shm"), reason="frames need shared memory")
def test_requests_of_one_tick_are_replayed_in_their_order() -> None:
    """A path that a client has asked for, at the lateral speed of then, and another speed."""
    session = nt.Session(surface=nt.Surface(nt.surface.flat(pixels=32)))
    name = f"replay-{os.getpid()}"
    session.publish(name)
    session.start("wall")
    time.sleep(0.05)
    session.pause()
    time.sleep(0.05)
    with nt.commands.attach(name) as client:
        client.lease()
        asked = client.post(1, 0, (4e-6, 3e-6, 0.0, 0.0))
        deadline = time.monotonic() + 10.0
        while client.poll(asked).pending and time.monotonic() < deadline:
            time.sleep(0.01)
        assert client.poll(asked).status == 0
        assert not client.poll(asked).pending
    session.change("settings", "limits.lateral_speed", 0.1 * session.settings.limits.lateral_speed)
    session.pause(False)
    time.sleep(0.2)
    session.halt()
    recording = Recording(session.read(65536), session.metadata())
    (aimed, first, _), (changed, second, _) = recording.metadata["events"]
    assert (first, second) == ("aim", "setting")
    assert aimed == changed
    again = recording.replay()
    for column in COMMANDS:
        np.testing.assert_array_equal(again.columns[column], recording.columns[column], err_msg=column)
