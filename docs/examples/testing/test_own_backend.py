# SPDX-License-Identifier: BSD-3-Clause
"""A laboratory's own slave, tested without its hardware: the driver gets a pretended converter card."""

import math

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import testing

TRAVEL = 1e-7  # of the stage per volt [m/V]
SENSITIVITY = 5e-8  # of the detector [m/V]


class LabStage(nt.hal.Slave):
    """The driver under test: a card whose output 0 drives the stage and whose input 0 reads the detector."""

    def __init__(self, card):
        super().__init__()
        self.card = card

    def describe(self):
        return nt.hal.Capabilities(axes=1, feels=True)

    def read(self):
        stage, detector = self.card.inputs()
        return nt.hal.Reading(position=(math.nan, math.nan, TRAVEL * stage),
                              felt=(math.nan, math.nan, SENSITIVITY * detector))  # fmt: skip

    def write(self, action):
        self.card.output(action.target[2] / TRAVEL)

    def disarm(self):
        self.card.output(0.0)


class Card:
    """The pretended card: a stage that follows at once, a hard surface after 0.15 um, a noise of 20 pm."""

    def __init__(self):
        self.volt, self.noise, self.unplugged = 0.0, np.random.default_rng(1), False

    def inputs(self):
        bent = max(0.0, TRAVEL * self.volt - 0.15e-6) + 20e-12 * self.noise.standard_normal()
        return self.volt, math.nan if self.unplugged else bent / SENSITIVITY

    def output(self, volt):
        self.volt = volt


@pytest.fixture
def card():
    return Card()


def opened(nt_session, card):
    return nt_session(rig=nt.Rig(stage={"axes": 1}), slave=LabStage(card))


def test_it_keeps_the_contract(card):
    testing.assert_conforms(LabStage(card), move=1e-7)  # m, away from the sample, and back


def test_a_press_keeps_below_what_the_session_allows(nt_session, card):
    session = opened(nt_session, card)
    touch = session.run(operator=testing.scripted_hand(session, (2.0, 1.0), (-0.3, 0.5)))
    testing.assert_runs(touch)
    assert touch.slave_force.max() > 10e-9  # it touched
    testing.assert_force_below(touch, session.guarantee().force, "slave_force")


def test_an_unplugged_detector_lifts_the_tip(nt_session, card):
    session = opened(nt_session, card)
    session.advance(0.1)
    card.unplugged = True
    session.advance(0.05)
    assert session.state == "RETRACT"
    assert card.volt < 0.0
