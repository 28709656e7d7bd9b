# SPDX-License-Identifier: BSD-3-Clause
"""A recorded hand on another sample, and a recorded touch felt once more."""

from __future__ import annotations

from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import Input, Rig, Scene, Session
from nanotouch.errors import Error, InvalidValue

STILL = [Input(0.0, 0.0, 0.0, 1.2)]
"""nobody pushes but the replayed hand"""


@pytest.fixture(scope="module")
def touched() -> nt.Recording:
    """1.2 s of a hand that presses."""
    return Session(seed=3).run(operator=[Input(0.5, 0.0, 0.0, 1.0), Input(-0.5, 0.0, 0.0, 0.2)])


def again(recording: nt.Recording, **more: Any) -> nt.Recording:
    """With the hand replayed, which nothing holds still for a preflight."""
    return Session(master=nt.hal.Replay(recording), preflight=False, **more).run(operator=STILL)


def test_the_hand_is_what_it_was_on_another_sample(touched: nt.Recording) -> None:
    """What the master measured comes bit by bit, whatever the sample is; the touch differs."""
    soft = again(touched, scene=Scene(sample={"youngs_modulus": 1e9}), seed=4)
    assert np.array_equal(soft.master_position, touched.master_position)
    assert np.array_equal(soft.operator_force, touched.operator_force)
    assert soft.contact_radius.max() > 1.5 * touched.contact_radius.max() > 0.0


def test_a_touch_is_felt_once_more(touched: nt.Recording) -> None:
    """Both halves replayed: the touch step reads the same, so it tells the same."""
    felt = again(touched, slave=nt.hal.Replay(touched))
    for name in ("stage_position", "deflection", "master_position", "motor_force", "stage_command", "state"):
        assert np.array_equal(getattr(felt, name), getattr(touched, name)), name


@pytest.mark.filterwarnings("ignore:the session was stopped")
def test_after_the_last_row_it_holds(touched: nt.Recording) -> None:
    over = again(touched[:5000])
    assert not over.state[:5000].any()
    assert over.state[5010:].all()


def test_it_keeps_the_contract(touched: nt.Recording) -> None:
    for slave in (False, True):
        seen = nt.hal.rehearse(nt.hal.Replay(touched), slave=slave, period=1e-4, duration=0.05, real_time=False)
        assert seen.readings > 100


def test_what_is_no_recording_is_refused(touched: nt.Recording) -> None:
    with pytest.raises(InvalidValue, match="the recording has no row"):
        Session(master=nt.hal.Replay(touched[:0]))
    columns = {name: values for name, values in touched.columns.items() if name != "deflection"}
    with pytest.raises(AttributeError, match="no column 'deflection'"):
        Session(slave=nt.hal.Replay(nt.Recording(columns)))
    stands = touched.columns | {"time": np.zeros(len(touched))}
    with pytest.raises(Error, match="time of a row"):
        Session(master=nt.hal.Replay(nt.Recording(stands)))


def test_a_rig_may_not_claim_more(touched: nt.Recording) -> None:
    """A hand of one axis is no master of three."""
    columns = {name: values for name, values in touched.columns.items() if name not in ("master_x", "master_y")}
    with pytest.raises(InvalidValue, match="axes"):
        Session(rig=Rig(master={"axes": 3}), master=nt.hal.Replay(nt.Recording(columns)))


def test_what_is_no_recording_is_named() -> None:
    with pytest.raises(TypeError, match="Replay: int is no recording"):
        nt.Session(slave=nt.hal.Replay(3))
