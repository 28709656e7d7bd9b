# SPDX-License-Identifier: BSD-3-Clause
"""The numbered example programs run, on the public interface only, and print what is true."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAMS = Path(__file__).parent.parent.parent / "apps/python"


def run(name: str) -> str:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    command = [sys.executable, "-W", "error", str(PROGRAMS / name)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def number(pattern: str, text: str) -> float:
    found = re.search(pattern, text)
    assert found, text
    return float(found[1])


def test_force_curve() -> None:
    said = run("01_force_curve.py")
    rows = {line.split()[0]: line.split()[1:] for line in said.splitlines() if line.strip()}
    # lambda of the paper's silicon with a 0.2 nm atomic range; DMT 2 pi w R, JKR 1.5 pi w R
    assert number(r"lambda = ([\d.]+)", said) == pytest.approx(0.25, abs=0.05)
    assert rows["pull-off"][:3] == ["0.000", "18.096", "13.572"]
    assert rows["0.80"][0] == f"{4 / 3 * 76.9e9 * 20e-9**0.5 * 0.8e-9**1.5 * 1e9:.3f}"
    assert len(rows) == 17


def test_touch_simulated() -> None:
    said = run("02_touch_simulated.py")
    assert re.search(r"contact law +Maugis-Dugdale table, lambda 0\.0401\n", said)
    attraction = number(r"attraction +([\d.]+) nN", said)
    share = attraction / number(r"pull-off: ([\d.]+) nN", said)
    assert 0.92 < share < 1.0  # what a tick of the stage leaves of it: test_session.py
    assert number(r"RMS +([\d.]+) N at rest", said) < 0.05
    assert number(r"steps +(\d+)", said) == 100_000


def test_fit() -> None:
    pytest.importorskip("nanotouch._fit", reason="built without Ceres")
    said = run("03_fit.py")
    for name in ("effective_modulus", "work_of_adhesion", "contact_point"):
        value, sigma, true = (number(rf"{name} +{column}([-+.\de]+)", said) for column in ("", r"\S+ +", r"\S+ +\S+ +"))
        assert 0.0 < sigma < 0.1 * true
        assert value == pytest.approx(true, abs=4 * sigma)  # a noise drawn once, with a fixed seed
    assert number(r"residual ([\d.]+) pN", said) == pytest.approx(50.0, rel=0.15)


@pytest.mark.parametrize("file", sorted(PROGRAMS.glob("*.py")), ids=lambda file: file.name)
def test_only_public_names(file: Path) -> None:
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Attribute):
            assert not node.attr.startswith("_")
        if isinstance(node, ast.ImportFrom):
            assert not any(name.startswith("_") for name in (node.module or "").split("."))


def test_same_numbers_as_in_c() -> None:
    c = {file.stem for file in (PROGRAMS.parent / "c").glob("*.c")}
    assert {file.stem for file in PROGRAMS.glob("*.py")} <= c  # C has more, one for each way of use
