# SPDX-License-Identifier: BSD-3-Clause
"""What a call from Python costs before it is in C: bytecode instructions and calls into C, counted by the interpreter,
which neither a clock nor another program changes. What it costs in C is counted in test_cycle.py. As there, the numbers
stand in tests/bench/instructions.json, for one version of Python, and may grow by 3 %."""

from __future__ import annotations

import json
import platform
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any, SupportsFloat

import nanotouch as nt
import pytest
from nanotouch.touch.operator import Hold, Input

KEPT: dict[str, Any] = json.loads((Path(__file__).parents[1] / "bench/instructions.json").read_text())["python"]
MAUGIS = nt.Contact(20e-9, 5e6, 0.05, 1e7)
GROWTH = 1.03


def counted(call: Callable[[], object]) -> dict[str, int]:
    """Bytecode instructions of all Python frames of a call, itself left out, and its calls into C."""
    found = {"instructions": 0, "c_calls": 0}
    own = call.__code__

    def trace(frame: FrameType, event: str, _: object) -> Any:
        frame.f_trace_opcodes, frame.f_trace_lines = True, False
        found["instructions"] += event == "opcode" and frame.f_code is not own
        return trace

    def profile(frame: FrameType, event: str, what: object) -> None:
        found["c_calls"] += event == "c_call" and what not in (sys.setprofile, sys.settrace)

    call()  # what is made once
    tracing, profiling = sys.gettrace(), sys.getprofile()
    try:
        sys.settrace(trace)
        call()
        sys.settrace(tracing)
        sys.setprofile(profile)
        call()
    finally:
        sys.settrace(tracing)
        sys.setprofile(profiling)
    return found


def calls() -> dict[str, Callable[[], object]]:
    """What a user calls in a loop."""
    law, session = MAUGIS.law("maugis"), nt.Session(recorded=False)
    push, hold = Input(0.5, 0.0, 0.0, 0.0), Hold(0.0, 0.0, 0.0, 0.0)
    return {
        "law.force(float)": lambda: law.force(1e-9),
        "contact.force(float)": lambda: nt.contact.force("maugis", 1e-9, MAUGIS),
        "session.step(Input)": lambda: session.step(push),
        "session.step(Hold)": lambda: session.step(hold),
        "session.step()": lambda: session.step(),
    }


def test_the_way_into_c_is_no_longer_than_it_was() -> None:
    found = {name: counted(call) for name, call in calls().items()}
    assert found.keys() == KEPT["calls"].keys()
    if f"{platform.python_implementation()} {sys.version_info[0]}.{sys.version_info[1]}" != KEPT["version"]:
        pytest.skip(f"the counts are of {KEPT['version']}")
    grown = {
        f"{name}: {what}": number
        for name, numbers in found.items()
        for what, number in numbers.items()
        if number > GROWTH * KEPT["calls"][name][what]
    }
    assert grown == {}


def test_what_is_counted() -> None:
    """A protocol that is asked at run time, which cost 15 us in every step once, is seen."""

    def plain() -> float:
        return abs(-1.0)

    assert counted(lambda: plain())["c_calls"] == 1
    assert 4 <= counted(lambda: plain())["instructions"] <= 9
    assert counted(lambda: isinstance("", SupportsFloat))["instructions"] > 50
