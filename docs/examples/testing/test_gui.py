# SPDX-License-Identifier: BSD-3-Clause
"""A program with a window that embeds a session: its timer is called by the test, so no second passes on a clock."""

import nanotouch as nt
from nanotouch import testing


class Panel:
    """The program under test. Its window calls `tick` 60 times a second and shows `text`."""

    def __init__(self, session):
        self.session, self.text, self.pressed = session, "", 0.0

    def tick(self):
        x, y = self.session.path[0]
        rows = self.session.advance(1 / 60, nt.Input(self.pressed, x, y, 0.0))
        force = 1e9 * rows["slave_force"][-1]
        stopped = "" if self.session.state == "RUN" else f", stopped: {', '.join(self.session.reasons)}"
        self.text = f"{force:.0f} nN{stopped}"


def test_it_shows_the_force(nt_session):
    panel = Panel(nt_session())
    panel.tick()
    assert abs(float(panel.text.split()[0])) < 10.0  # the noise of the sensor
    panel.pressed = 1.0
    for _ in range(60):
        panel.tick()
    assert float(panel.text.split()[0]) > 20.0


def test_it_says_why_it_was_stopped(nt_session):
    """The sensor fails at 0.5 s of the session's own time: in the 30th tick of the window."""
    panel = Panel(nt_session(faults=nt.Faults().add("nan", "deflection", at=0.5)))
    shown = []
    for _ in range(40):
        panel.tick()
        shown.append(panel.text)
    assert "stopped" not in shown[28]
    assert "stopped: " in shown[29]


def test_the_session_reacts_by_itself(nt_session):
    session = nt_session(faults=nt.Faults().add("emergency-stop", at=0.1))
    columns = session.advance(0.2)
    testing.assert_reacts(nt.Recording(columns, session.metadata()), "LATCHED", after=0.1, within=2e-4)
