# SPDX-License-Identifier: BSD-3-Clause
"""A sample that relaxes under the hand: the force falls, the dent comes back late, and both views are told of it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from nanotouch_app.live.host import Host
from nanotouch_app.live.seen import Seen
from nanotouch_app.live.subject import of_preset

QUICK, SLOW, TIME = 21e3, 9.3e3, 2.8 / 11.7  # of the chondrocyte: E_0, E_inf [Pa], tau [s]


class Watched:
    def __init__(self, preset: str) -> None:
        self.seen, self.told = Seen(), list[dict[str, Any]]()
        self.host = Host(of_preset(preset), self.hear, stepped=True)
        self.host.report()
        self.advance(0.02)

    def hear(self, message: dict[str, Any]) -> None:
        self.told.append(message)
        self.seen.hear(message)

    def advance(self, duration: float) -> Any:
        self.host.advance(duration)
        self.seen.look(self.host.observer)
        return self.seen.frame

    def push(self, force: float) -> None:
        """By single steps of the wheel, until it is pressed so hard [N]."""
        while float(self.advance(0.01)["tip_force"][2]) < force:
            self.host.answer({"do": "wheel", "steps": 1.0})

    def depth(self) -> float:
        """Of the surface on the axis, as it is drawn [m]."""
        section = self.seen.section(np.zeros(1))
        assert section is not None
        return -float(section.sample[0])


@pytest.fixture
def cell() -> Iterator[Watched]:
    watched = Watched("chondrocyte")
    yield watched
    watched.host.close()


def test_the_force_falls_under_a_hand_that_holds_still(cell: Watched) -> None:
    """Between that of the lever on a sample of E_0 and of E_inf: less than at first, more than E_inf/E_0 of it."""
    cell.push(1e-9)
    first = float(cell.advance(0.03)["tip_force"][2])
    left = float(cell.advance(2.0)["tip_force"][2])
    assert SLOW / QUICK * first < left < 0.9 * first


def test_a_quick_hand_stays_below_the_force_limit(cell: Watched) -> None:
    for _ in range(300):
        cell.host.answer({"do": "wheel", "steps": 5.0})
        frame = cell.advance(0.01)
        assert frame["state"] == 0
    assert float(frame["tip_force"][2]) < cell.host.session.settings.limits.force
    assert float(frame["tip_force"][2]) > 0.5 * cell.host.session.settings.limits.force


def test_the_surface_goes_with_the_tip_and_comes_back_with_the_retardation_time(cell: Watched) -> None:
    """A standard solid without load recovers as exp(-t/(tau E_0/E_inf)), told 20 times a second."""
    cell.push(1.5e-9)
    cell.advance(1.0)
    assert cell.seen.recovery is not None
    assert cell.depth() == pytest.approx(-float(cell.seen.frame["gap"]), rel=1e-6)
    assert -cell.seen.recovery[1][0] == pytest.approx(cell.depth(), rel=0.02)  # its own springs say the same
    cell.host.answer({"do": "retract"})
    while float(cell.advance(0.02)["gap"]) < 5e-9:
        pass
    cell.advance(0.1)
    section = cell.seen.section(np.zeros(1))
    assert section is not None
    assert not section.attached
    before, began = cell.depth(), float(cell.seen.frame["time"])
    assert before > 20e-9
    later = cell.advance(0.5)
    expected = np.exp(-(float(later["time"]) - began) / (TIME * QUICK / SLOW))
    assert cell.depth() / before == pytest.approx(expected, rel=0.1)  # 0.05 s of 0.54 s
    cell.advance(6.0)
    assert cell.seen.recovery is None
    assert cell.depth() == 0.0


def test_sliders_are_those_of_the_kernel() -> None:
    """A modulus that the sample does not have is no slider."""
    fields = {}
    for name in ("chondrocyte", "polymer_gel", "cell_in_liquid"):
        watched = Watched(name)
        rows = next(message for message in watched.told if message["tell"] == "sliders")["sliders"]
        fields[name] = {row["field"] for row in rows if row["field"].split(".")[0] in ("rheology", "sample")}
        watched.host.close()
    arms = {"rheology.equilibrium_modulus", "rheology.arm_modulus_1", "rheology.relaxation_time_1"}
    assert fields["chondrocyte"] == arms
    assert fields["polymer_gel"] == {"rheology.modulus", "rheology.exponent"}
    assert fields["cell_in_liquid"] == {"sample.youngs_modulus"}


def test_another_kernel_begins_relaxed(cell: Watched) -> None:
    cell.push(1e-9)
    assert cell.advance(0.1) is not None
    cell.host.answer({"do": "retract"})
    while float(cell.advance(0.02)["gap"]) < 5e-9:
        pass
    assert cell.seen.recovery is not None
    cell.host.answer({"do": "change", "what": "scene", "field": "rheology.relaxation_time_1", "value": 0.5})
    cell.advance(0.02)
    assert cell.seen.recovery is None
