# SPDX-License-Identifier: BSD-3-Clause
"""A type checker knows the fields: it accepts what runs, and refuses misspelt names, wrong words and wrong types."""

from __future__ import annotations

import os
import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest
from nanotouch import Error

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "bindings/python/nanotouch"

RIGHT = """
import nanotouch as nt
scene = nt.Scene(tip={"radius": 30e-9, "shape": "sphere"}, sample={"material": "gold"}, medium={"kind": "liquid"})
radius: float = scene.tip.radius
scene.tip.conducting = False
told: str = scene.tip.conducting
rig = nt.Rig(probe={"spring_constant": 30.0}, master={"gauge": "no"})
axes: float = rig.stage.axes
settings = nt.Settings.for_rig(rig)
settings.gains.rate = 5e3
demand = nt.Demand(demand={"quantity": "stiffness", "relative_accuracy": 0.02})
session = nt.Session(nt.Scene(), mode="point", control="paper", rate=2e4, gains={"force_gain": 1.5}, minimum_margin=0.0)
recording = session.run(0.02, operator=[nt.Input(1.0, *session.path[0], 0.02)])
attraction: float = recording.tip_force.min()
law = nt.contact.force("dmt", 1e-9, nt.Contact(2e-8, 1e11, 0.05))
"""

WRONG = """
scene.tip.raduis
scene.tip.radius = "20 nm"
scene.medium.kind = "watter"
scene.probe
nt.Scene(tip={"radius_nm": 20})
nt.Rig(prob={"spring_constant": 8.0})
settings.gains.rat = 5e3
nt.Demand(demand={"quantity": "torque"})
nt.Session(mode="scann")
nt.Session(foo=3)
nt.Session(control="papr")
nt.Session(gains={"force_gian": 10.0})
nt.Sesion()
recording.tip_forc
nt.forces.vdw_tip(1e-9, radius=2e-8)
"""


@pytest.fixture(scope="module")
def checked(tmp_path_factory: pytest.TempPathFactory) -> dict[int, str]:
    """What mypy says of each line: of those that run, then of each that must be refused."""
    pytest.importorskip("mypy")
    folder = tmp_path_factory.mktemp("checked")
    (folder / "uses.py").write_text(RIGHT + WRONG)
    (folder / "mypy.ini").write_text("[mypy]\nstrict = true\nerror_summary = false\n")
    environment = {**os.environ, "MYPY_CACHE_DIR": str(folder)}
    command = [sys.executable, "-m", "mypy", "uses.py"]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.stderr == ""
    found = re.findall(r"^uses\.py:(\d+): error: (.*)$", done.stdout, re.MULTILINE)
    assert done.stdout.count(" error: ") == len(found), done.stdout  # none of them is in the package
    return {int(line): said for line, said in found}


@pytest.fixture(scope="module")
def names() -> dict[str, object]:
    """Those of the right uses, which run."""
    given: dict[str, object] = {}
    exec(RIGHT, given)
    return given


def test_right_uses_are_accepted(checked: dict[int, str], names: dict[str, object]) -> None:
    assert names["radius"] == 30e-9
    lines = RIGHT.splitlines()
    assert {lines[at - 1]: said for at, said in checked.items() if at <= len(lines)} == {}


@pytest.mark.parametrize("use", WRONG.split("\n")[1:-1])
def test_wrong_uses_are_refused(checked: dict[int, str], names: dict[str, object], use: str) -> None:
    assert (RIGHT + WRONG).splitlines().index(use) + 1 in checked
    with pytest.raises((AttributeError, TypeError, Error)):  # running it refuses it, too: the checker does so earlier
        exec(use, names)


def test_stubs_are_up_to_date() -> None:
    written = runpy.run_path(str(ROOT / "tools/stubs.py"))
    for name, made in (("_fields.pyi", written["fields"]()), ("__init__.pyi", written["names"]())):
        assert (PACKAGE / name).read_text(encoding="utf-8") == made, "run .venv/bin/python tools/stubs.py"
