# SPDX-License-Identifier: BSD-3-Clause
"""What one control period of a simulated session costs, in instructions: counts, not times, so that it stays."""

from __future__ import annotations

import importlib.util
import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/dev/tests/bench/bench_cycle"
MOST = 3700  # 3 688 were counted (gcc 12, -O2)


def test_a_period_costs_no_more_than_it_did() -> None:
    """Two runs of different length, so that opening and closing cancel."""
    if shutil.which("valgrind") is None:
        pytest.skip("valgrind is not here: instructions are not counted")
    if not PROGRAM.exists():
        pytest.skip("bench_cycle is not built: cmake --build --preset dev --target bench_cycle")
    spec = importlib.util.spec_from_file_location("bench_cycle", ROOT / "tests/bench/bench_cycle.py")
    assert spec is not None
    assert spec.loader is not None
    bench = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(bench)
    short, long = (bench.count(str(PROGRAM), "hertz", periods) for periods in (2000, 4000))
    assert (long - short) / 2000 <= MOST
