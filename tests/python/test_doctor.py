# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch doctor``: tells what is there, and what to install for what is not; never fails."""

from __future__ import annotations

import argparse
import re
import sys
import tomllib
from pathlib import Path

import nanotouch
import pytest
from nanotouch import _core
from nanotouch.errors import DeviceError
from nanotouch.extras import EXTRAS
from nanotouch_app import view
from nanotouch_app.rigs import doctor

PYPROJECT = Path(__file__).parents[2] / "pyproject.toml"


@pytest.fixture(autouse=True)
def quick_probe(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(view, "probe", lambda: (True, "VTK 9.9, vtkEGLRenderWindow"))


def finding(name: str) -> str:
    (line,) = [line for line in doctor.findings() if line[5:].split(" ")[0] == name]
    return line


def test_status_is_0_and_everything_is_listed(capsys: pytest.CaptureFixture[str]) -> None:
    parser = argparse.ArgumentParser()
    doctor.add_parser(parser.add_subparsers())
    args = parser.parse_args(["doctor"])
    assert args.run(args) == 0
    said = capsys.readouterr().out
    assert said.startswith(f"nanotouch {nanotouch.__version__}, Python {sys.version.split()[0]}, numpy ")
    for name in (*EXTRAS, "core", "fit", "simulated", "gpio", "display", "VTK"):
        assert re.search(rf"^  (ok|--) {name} ", said, re.MULTILINE), name
    assert "ok VTK        VTK 9.9" in said


@pytest.mark.skipif(not PYPROJECT.exists(), reason="needs the source tree")
def test_extras_are_those_of_the_package() -> None:
    extras = tomllib.loads(PYPROJECT.read_text())["project"]["optional-dependencies"]
    declared = {name: {re.split(r"[<>=\[]", need)[0] for need in needs} for name, needs in extras.items()}
    assert {name: set(packages) for name, packages in EXTRAS.items()} == {
        name: declared[name] for name in declared if name not in ("all", "docs", "test", "lint", "mutate")
    }


def test_a_missing_package_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "afmformats", None)
    assert finding("curves") == "  -- curves     afmformats missing, for files of force curves: pip install afmformats"


def test_without_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "nanotouch._fit", None)
    assert "libceres-dev" in finding("fit")
    assert finding("fit").startswith("  --")


def test_gpio(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(_core, "gpio_lines", raising=False)
    assert "install libgpiod 2.1" in finding("gpio")
    monkeypatch.setattr(_core, "gpio_lines", list, raising=False)
    assert "no chip" in finding("gpio")
    lines = [("gpiochip0", 4, "estop", "nanotouch"), ("gpiochip0", 5, "", "")]
    monkeypatch.setattr(_core, "gpio_lines", lambda: lines, raising=False)
    assert finding("gpio") == "  ok gpio       1 chips, 2 lines; named: estop (gpiochip0:4)"

    def broken() -> None:
        raise DeviceError("gpiochip0 went away")

    monkeypatch.setattr(_core, "gpio_lines", broken, raising=False)
    assert finding("gpio") == "  -- gpio       gpiochip0 went away"


def test_display(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setenv("DISPLAY", ":3")
    assert finding("display") == "  ok display    DISPLAY=:3"
    monkeypatch.delenv("DISPLAY")
    assert finding("display").startswith("  -- display")


def test_vtk_that_does_not_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(view, "probe", lambda: (False, "VTK died of SIGSEGV"))
    assert finding("VTK") == "  -- VTK        VTK died of SIGSEGV"
