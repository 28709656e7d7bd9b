# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch bench`` and the clock it shares with ``nanotouch tradeoff``."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from nanotouch_app import bench
from nanotouch_app.main import main
from nanotouch_app.tradeoff import timing


def test_least_of_turns(monkeypatch: pytest.MonkeyPatch) -> None:
    """A clock that a call moves by what it costs; the first, unmeasured call of each is the dearest."""
    now = 0
    costs = {"a": iter([9000, 500, 300, 400]), "b": iter([9000, 70, 80, 60])}
    order = []

    def spend(name: str) -> None:
        nonlocal now
        order.append(name)
        now += next(costs[name])

    monkeypatch.setattr(timing, "perf_counter_ns", lambda: now)
    done: list[float] = []
    found = timing.nanoseconds({name: lambda name=name: spend(name) for name in "ab"}, 3, done.append)
    assert found == {"a": 300 / timing.ELEMENTS, "b": 60 / timing.ELEMENTS}
    assert "".join(order) == "ab" + 3 * "ab"
    assert done[-1] == 1.0


def test_every_call_fills_an_array_with_numbers() -> None:
    for call in (*bench.force_calls().values(), *bench.law_calls().values()):
        found = np.atleast_2d(np.asarray(call()))
        assert found.shape[-1] == timing.ELEMENTS
        assert np.all(np.isfinite(found[0]))
        assert np.ptp(found[0]) > 0.0


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "bench.json"
    assert main(["bench", "--quick", "--out", str(out)]) == 0
    written = json.loads(out.read_text(encoding="utf-8"))
    laws = {(law["computes"], law["law"]): law for law in written["laws"]}
    assert {"elements", "machine", "numpy", "python", "runs", "unit", "version"} < set(written)
    assert all(math.isfinite(law["nanoseconds"]) and law["nanoseconds"] > 0.0 for law in laws.values())
    for computes, yardstick in bench.YARDSTICKS.items():
        assert laws[computes, yardstick]["hertz"] == 1.0
    # measured 200 and 13: a busy machine does not hide it
    assert laws["F", "MD exact"]["hertz"] > 10.0 * laws["F", "MD table"]["hertz"]
    assert laws["U, F, k, a", "maugis exact"]["hertz"] > 2.0 * laws["U, F, k, a", "maugis table"]["hertz"]
    said = capsys.readouterr().out
    assert all(law in said for _, law in laws)


@pytest.mark.parametrize(("out", "says"), [("bench.txt", ".json"), ("none/bench.json", "not a folder")])
def test_one_sentence(out: str, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "--out", str(tmp_path / out)]) == 2
    error = capsys.readouterr().err
    assert error.startswith("nanotouch bench: ")
    assert says in error
    assert error.count("\n") == 1
    assert not list(tmp_path.iterdir())
