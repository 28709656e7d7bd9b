# SPDX-License-Identifier: BSD-3-Clause
"""Hands and eyes of the tests of a live session, as an operator has them: wheel, press, let go."""

from __future__ import annotations

import csv
from typing import Any


class Operator:
    """Before a stepped host, or what has its answer, advance and observer."""

    def __init__(self, rig: Any, load: float) -> None:
        self.rig, self.load = rig, load

    def wait(self, duration: float = 0.02) -> Any:
        """Let time pass; the newest frame."""
        self.rig.advance(duration)
        return self.rig.observer.newest()

    def wheel(self, steps: float) -> Any:
        """Down by so many steps, or up."""
        self.rig.answer({"do": "wheel", "steps": steps})
        return self.wait()

    def down_to(self, force: float) -> Any:
        """Touch, then press with a force [N]."""
        frame = self.wheel(0.0)
        while not touches(frame):
            frame = self.wheel(0.3)
        while frame["tip_force"][2] < force:
            frame = self.wheel(min(1.0, 0.1 + 20.0 * (force - frame["tip_force"][2]) / self.load))
        return frame

    def up(self) -> None:
        """Let go."""
        while touches(self.wheel(-1.0)):
            pass
        for _ in range(5):
            self.wheel(-0.5)


def touches(frame: Any) -> bool:
    """A contact, or further down than the surfaces."""
    return bool(frame["contact_radius"] > 0.0 or frame["gap"] < 0.0)


def result_of(host: Any) -> tuple[dict[str, str], list[list[str]]]:
    """What the file of a task's result says: its head, and its rows."""
    lines = host.core.result().splitlines()
    head = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
    return head, list(csv.reader(lines[len(head) :]))


def newest(told: list[dict[str, Any]], kind: str) -> dict[str, Any]:
    """The last message of a kind."""
    return next(message for message in reversed(told) if message["tell"] == kind)
