# SPDX-License-Identifier: BSD-3-Clause
"""The work of the hand is what is stored, what the law takes and what becomes heat at the folds."""

from __future__ import annotations

import numpy as np
import pytest
from nanotouch_app.live import charts
from nanotouch_app.live.energy import cycle
from nanotouch_app.live.host import Host
from nanotouch_app.live.seen import Seen
from nanotouch_app.live.subject import of_preset

CLEARANCE = {"silicon_in_air": 20e-9, "mica_in_air": 40e-9, "polyester": 30e-9, "silicone_rubber": 200e-9}  # [m]


@pytest.mark.parametrize("name", list(CLEARANCE))
def test_the_law_balances_over_a_slow_cycle(name: str) -> None:
    subject = of_preset(name)
    plan, spring = subject.scene.plan(), 0.2 * subject.rig.probe.spring_constant
    deepest = 0.8 * float(plan.explain()["largest_indentation"])
    pieces, energies = cycle(plan, spring, deepest, CLEARANCE[name])
    hand, stored, tip, heat = energies
    assert abs(hand - (stored + tip + heat)) < 1e-6 * abs(hand)
    assert heat > 0.0
    assert pieces[0].end > pieces[1].start  # it has jumped in
    assert pieces[3].start > pieces[2].end  # and out


def test_frames_balance_and_the_heat_is_that_of_the_folds() -> None:
    host = Host(of_preset("silicone_rubber"), lambda message: None, stepped=True)
    world = host.world()

    def go(steps: float, count: int) -> None:
        for _ in range(count):
            host.answer({"do": "wheel", "steps": steps})
            host.advance(0.1)

    host.advance(0.1)
    while not host.observer.newest()["contact_radius"] > 0.0:
        go(0.2, 1)
    go(0.3, 60)
    while host.observer.newest()["contact_radius"] > 0.0:
        go(-0.2, 1)
    go(-0.2, 10)
    hand, stored, tip, heat = host.clock()["energies"]
    plan = host.session.plan
    host.close()
    assert abs(hand - (stored + tip + heat)) < 1e-6 * abs(hand)
    assert abs(stored) < 0.02 * hand
    _, slow = cycle(plan, world["stiffness"], 50e-9, 200e-9)
    # the law keeps what its own folds lose within U's jumps: work at the tip and heat together are what was lost
    assert tip + heat == pytest.approx(slow.tip + slow.heat, rel=0.1)
    assert hand == pytest.approx(slow.hand, rel=0.1)


def test_work_over_terraces_is_that_of_all_three_axes() -> None:
    """Pressed and dragged over edges, the hand pays for what the spring takes; the law has what its depth says.

    Places are as read: noise of the stage (0.4 nm) times the force is what a part is known to.
    """
    host = Host(of_preset("silicon_on_gold"), lambda message: None, stepped=True)
    width = host.session.surface.size[0]

    def go(count: int) -> None:
        for _ in range(count):
            host.advance(0.02)

    go(5)
    host.answer({"do": "press", "on": True})
    go(60)
    host.core.ask("release", "", (0.0, 0.0, 0.0))  # holds its height
    go(5)
    hand, stored, tip, _ = host.clock()["energies"]
    spans = []
    for way in (0.02,) * 15 + (-0.02,) * 30:
        host.answer({"do": "move", "way": (way * width, 0.3 * way * width, 0.0)})
        go(1)
        spans.append(np.subtract(host.clock()["energies"], (hand, stored, tip, 0.0)))
    energies, force = host.clock()["energies"], float(host.observer.newest()["tip_force"][2])
    host.close()
    told = 4.0 * force * 0.4e-9  # J, of the noise
    on_hand, in_spring, at_tip, _ = np.transpose(spans)
    assert np.ptp(in_spring) > 3.0 * told  # up and down the terraces
    assert np.abs(at_tip).max() < told
    assert np.abs(on_hand - in_spring).max() < 1.5 * told
    assert abs(energies[0] - sum(energies[1:])) < 1e-6 * abs(energies[0])
    assert energies[3] > 0.0


def pressed_for_a_second() -> tuple[Host, Seen]:
    """A view that has drawn every tick of a press."""
    host, seen = Host(of_preset("silicon_in_air"), lambda message: None, stepped=True), Seen()
    seen.hear(host.world())
    host.answer({"do": "press", "on": True})
    for _ in range(10):
        host.advance(0.1)
        seen.look(host.observer)
    seen.hear(host.clock())
    return host, seen


def test_the_view_shows_where_the_work_goes() -> None:
    host, seen = pressed_for_a_second()
    hand, stored, tip, heat = seen.clock["energies"]
    host.close()
    assert stored > 0.0
    assert abs(hand - (stored + tip + heat)) < 1e-6 * abs(hand)
    assert charts._energies(seen).startswith("work of the hand ")
    assert charts._energies(Seen()) == ""


def test_after_a_stop_the_hand_takes_hold_where_the_tip_is() -> None:
    """The lift is the supervisor's work: the same press asks the same work of the hand before and after."""
    host, seen = Host(of_preset("silicon_on_gold"), lambda message: None, stepped=True), Seen()
    seen.hear(host.world())
    found = []

    def go(count: int) -> None:
        for _ in range(count):
            host.advance(0.02)
            seen.look(host.observer)

    for what in ("press", "stop"):
        if what == "stop":
            host.answer({"do": "press", "on": False})
            go(30)
            host.answer({"do": "stop"})
            go(30)
            assert host.session.state == "LATCHED"
            host.answer({"do": "arm"})
            go(5)
        host.answer({"do": "press", "on": True})
        go(150)
        found.append(host.clock()["energies"])
    host.close()
    before, after = found
    assert before[1] > 0.5e-15
    assert after[1] == pytest.approx(before[1], rel=0.1)
    assert after[0] == pytest.approx(before[0], rel=0.1)


def test_a_balance_with_missed_ticks_is_only_about_right() -> None:
    host, seen = pressed_for_a_second()
    assert seen.clock["missed"] == 0
    host.session.core.advance(5000)  # nobody looks on
    host.advance(0.1)
    seen.hear(host.clock())
    host.close()
    assert charts._energies(seen).startswith("work of the hand about ")


def test_energies_have_the_digits_of_the_largest() -> None:
    assert charts._alike([4.3721, 4.3438, 0.000843, 0.0275]) == [4.37, 4.34, 0.0, 0.03]
    assert charts._alike([-437.21, 0.4, -0.2, 12.6]) == [-437.0, 0.0, 0.0, 13.0]
    assert [f"{value:g}" for value in charts._alike([0.0, -0.0])] == ["0", "0"]
