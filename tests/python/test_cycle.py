# SPDX-License-Identifier: BSD-3-Clause
"""What the engine costs, in instructions: counts, not times, so that they stay. tests/bench/instructions.json holds
what was counted; growth of more than 3 % fails, and a change of more than that either way belongs into the file."""

from __future__ import annotations

import importlib.util
import json
import shutil
import subprocess
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
BENCH, BUILT = ROOT / "tests/bench", ROOT / "build/dev/tests/bench"
KEPT: dict[str, Any] = json.loads((BENCH / "instructions.json").read_text())
GROWTH = 1.03


def counter(name: str) -> tuple[ModuleType, str]:
    """The script that counts, and the program whose instructions it counts; skips, with a word, where it cannot."""
    if shutil.which("valgrind") is None:
        pytest.skip("valgrind is not here: instructions are not counted")
    if not (BUILT / name).exists():
        pytest.skip(f"{name} is not built: cmake --build --preset dev --target {name}")
    spec = importlib.util.spec_from_file_location(name, BENCH / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    bench = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(bench)
    return bench, str(BUILT / name)


def compiler() -> str:
    """Name and major version of what built build/dev, with the processor; empty: unknown."""
    cache = ROOT / "build/dev/CMakeCache.txt"
    text = cache.read_text() if cache.exists() else ""
    path = next((line.split("=", 1)[1] for line in text.splitlines() if line.startswith("CMAKE_C_COMPILER:")), "")
    if not path:
        return ""
    said = subprocess.run([path, "-dumpmachine"], capture_output=True, text=True, check=False).stdout.split("-")[0]
    version = subprocess.run([path, "-dumpversion"], capture_output=True, text=True, check=False).stdout.split(".")[0]
    macros = subprocess.run([path, "-dM", "-E", "-x", "c", "/dev/null"], capture_output=True, text=True, check=False)
    return f"{'clang' if '__clang__' in macros.stdout else 'gcc'} {version.strip()} {said.strip()}"


def test_a_period_costs_no_more_than_it_did() -> None:
    """Two runs of different length, so that opening and closing cancel."""
    bench, program = counter("bench_cycle")
    short, long = (bench.count(program, "hertz", periods) for periods in (2000, 4000))
    assert (long - short) / 2000 <= KEPT["period_most"]  # nearer than 3 % of "period"


def test_an_element_costs_no_more_than_it_did() -> None:
    """Of an array of each law, and one exact value alone; all in one run of valgrind."""
    bench, program = counter("bench_element")
    if compiler() != KEPT["compiler"]:
        pytest.skip(f"built by {compiler() or 'an unknown compiler'}: the counts are of {KEPT['compiler']}")
    if "avx2" not in Path("/proc/cpuinfo").read_text():
        pytest.skip("this processor has no AVX2, of which the counts are")
    counted, kept = bench.counts(program), KEPT["element"]
    assert counted.keys() == kept.keys()
    assert {name: count for name, count in counted.items() if count > GROWTH * kept[name]} == {}


def test_the_page_on_speed_is_made_from_the_counts() -> None:
    spec = importlib.util.spec_from_file_location("speed", BENCH / "speed.py")
    assert spec is not None
    assert spec.loader is not None
    speed = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(speed)
    assert (ROOT / "docs/speed.md").read_text(encoding="utf-8") == speed.page(), "run python tests/bench/speed.py"
