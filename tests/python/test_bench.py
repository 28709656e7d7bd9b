# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch bench`` and the clock it shares with ``nanotouch tradeoff``."""

from __future__ import annotations

import itertools
import json
from pathlib import Path

import numpy as np
import pytest
from nanotouch_app.main import main
from nanotouch_app.studies import bench
from nanotouch_app.studies.tradeoff import timing


def test_least_of_turns(monkeypatch: pytest.MonkeyPatch) -> None:
    """A clock that a call moves by what it costs; the first, unmeasured call of each is the dearest."""
    now = 0
    costs = {"a": iter([9000, 500, 300, 400]), "b": iter([9000, 70, 80, 60])}
    order = []

    def spend(name: str) -> None:
        nonlocal now
        order.append(name)
        now += next(costs[name])

    monkeypatch.setattr(timing, "process_time_ns", lambda: now)
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


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """By a clock whose readings are the squares: call j of the first turn seems to take 4 j + 1 ns, later ones more."""
    readings = itertools.count()
    monkeypatch.setattr(timing, "process_time_ns", lambda: next(readings) ** 2)
    out = tmp_path / "bench.json"
    assert main(["bench", "--quick", "--out", str(out)]) == 0
    written = json.loads(out.read_text(encoding="utf-8"))
    assert {"elements", "machine", "numpy", "python", "runs", "unit", "version"} < set(written)
    laws = {(law["computes"], law["law"]): law for law in written["laws"]}
    assert next(readings) == 2 * written["runs"] * len(laws)
    called = [*(("F", name) for name in bench.force_calls()), *(("U, F, k, a", name) for name in bench.law_calls())]
    assert list(laws) == called
    for j, (computes, name) in enumerate(called):
        yardstick = 4 * called.index((computes, bench.YARDSTICKS[computes])) + 1
        assert laws[computes, name]["nanoseconds"] == (4 * j + 1) / timing.ELEMENTS
        assert laws[computes, name]["hertz"] == pytest.approx((4 * j + 1) / yardstick, rel=1e-15)
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
