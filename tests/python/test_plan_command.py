# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch plan``: presets, files, demands, words and JSON; refusals in one sentence."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from nanotouch import Demand, Plan, Scene, presets
from nanotouch.touch import host
from nanotouch_app.common import scenes
from nanotouch_app.common.output import as_json
from nanotouch_app.main import main
from nanotouch_app.studies.plan import PAPER, PRESETS

FILE = """
[tip]
radius_nm = 30
material = "silicon"
[sample]
material = "gold"
[medium]
relative_humidity_percent = 0
[adhesion]
given = "surface_energies"
contact_potential_mV = 100
[range]
maximum_load_uN = 1
[probe]
spring_constant_N_per_m = 2
[demand]
relative_accuracy_percent = 5
quantity = "stiffness"
"""


def strict(text: str) -> Any:
    """JSON as the standard has it: without NaN and Infinity."""

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is not JSON")

    return json.loads(text, parse_constant=refuse)


def ask(capsys: pytest.CaptureFixture[str], *arguments: str) -> Any:
    assert main(["plan", *arguments, "--json"]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    return strict(said.out)


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "scene.toml"
    path.write_text(FILE)
    return str(path)


@pytest.mark.parametrize("name", PRESETS)
def test_presets_in_words_and_as_data(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", name]) == 0
    plan = scenes.of_preset(name)[0].plan()
    words, on_this_machine, felt = capsys.readouterr().out.rstrip().rsplit("\n", 2)
    assert (words, felt) == (str(plan), f"felt: {scenes.felt(name)}")
    one, this = (float(number) for number in re.findall(r"(?:takes|plan) ([0-9.]+) ns", on_this_machine))
    assert this == pytest.approx(one * plan.cost, rel=0.02)  # three digits each
    data = ask(capsys, name)
    assert data == as_json(plan.explain())
    assert [term["name"] for term in data["terms"] if term["form"] != "off"] == [term.name for term in plan.terms]
    rigid = 0.0 if data["deforms"] else max(data["rigid_error"], data["around_error"])
    if data["bound"] is None:  # a sample that keeps dents has none
        assert np.isnan(plan.bound)
    else:
        assert sum(term["bound"] for term in data["terms"]) + rigid == pytest.approx(data["bound"], rel=1e-12)
    rubs = data["friction"]["cost"] if data["friction"]["form"] != "off" else 0.0
    assert sum(term["cost"] for term in data["terms"]) + rubs == pytest.approx(data["cost"], rel=1e-12)
    assert [entry["text"] for entry in data["warnings"]] == [warning.text for warning in plan.warnings]


def test_every_preset_is_named() -> None:
    functions = {name for name in vars(presets) if name[0].islower() and name.islower()}
    assert {*scenes.LIBRARY, *PAPER} == functions - {"annotations", "math"}
    rows = host.presets()
    assert [row["name"] for row in rows] == list(PRESETS)  # one list, that of the live view and the page
    assert {row["scene"] for row in rows} == {*scenes.LIBRARY, *scenes.MADE}


def test_numbers_that_json_has_not(capsys: pytest.CaptureFixture[str]) -> None:
    """Silicon: no Lennard-Jones table at lambda 0.04, and no spring holds a meniscus off; both are in the preset."""
    data = ask(capsys, "silicon_in_air")
    assert data["model_error"] is None
    assert data["minimum_spring"] == "inf"
    assert as_json({"a": [math.nan, -math.inf, 1.0], "b": "off", "c": 2}) == {
        "a": [None, "-inf", 1.0],
        "b": "off",
        "c": 2,
    }


def test_demand_of_the_file(file: str, capsys: pytest.CaptureFixture[str]) -> None:
    data = ask(capsys, file)
    assert (data["quantity"], data["radius"]) == ("stiffness", 30e-9)
    assert data["bound"] <= 0.05
    scene, demand = Scene.from_toml(file), Demand.from_toml(file)
    assert data == as_json(Plan.make(scene, demand).explain())


def test_what_is_given_replaces_the_demand_of_the_file(file: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path(file).write_text(FILE.replace('quantity = "stiffness"', 'quantity = "force"\nforce_floor_pN = 2'))
    data = ask(capsys, file, "--relative-accuracy", "1e-7")
    assert (data["quantity"], data["force_floor"]) == ("force", 2e-12)
    rigid = max(data["rigid_error"], data["around_error"])
    assert 0.0 < rigid < data["bound"] <= rigid + 1e-7
    wanted = Scene.from_toml(file).plan(relative_accuracy=1e-7, force_floor=2e-12)
    assert data == as_json(wanted.explain())


def test_rtol_with_and_without_per_cent(capsys: pytest.CaptureFixture[str]) -> None:
    assert ask(capsys, "polyester", "--relative-accuracy", "1%") == ask(
        capsys, "polyester", "--relative-accuracy", "0.01"
    )


def test_probe_of_the_file(file: str, capsys: pytest.CaptureFixture[str]) -> None:
    """A sixth of 50 mV peak to peak at 33 nm/V of a spring of 2 N/m."""
    told, untold = ask(capsys, file, "--probe"), ask(capsys, file)
    assert told.pop("probe_noise") == pytest.approx(2.0 * 33e-9 * 0.05 / 6.0, rel=1e-12)
    assert untold.pop("probe_noise") == 0.0
    assert told == untold


def test_budget_and_bound(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def demand(words: str) -> str:
        file = tmp_path / "demand.toml"
        file.write_text(f"[demand]\n{words}\n")
        return str(file)

    exact = ask(capsys, demand('bound = "exact"'))
    assert exact["cost"] == exact["full_cost"]
    cost = ask(capsys, demand(""))["cost"]
    assert ask(capsys, demand(f"budget = {cost}"))["cost"] == cost
    assert main(["plan", demand(f"budget = {0.9 * cost}")]) == 2
    assert f"plan: demand.budget = {0.9 * cost:g}: valid is {cost:g} .." in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--relative-accuracy", "1e-15"], "plan: demand.relative_accuracy (--relative-accuracy) = 1e-15: valid is 1."),
        (["--relative-accuracy", "60%"], "demand.relative_accuracy = 0.6"),
        (["--relative-accuracy", "1nm"], "the unit 'nm'"),
        (["--relative-accuracy=-1%"], "demand.relative_accuracy = -0.01"),
        (["--relative-accuracy", "little"], "'little' is not a number"),
    ],
)
def test_one_sentence_and_status_2(arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", "silicon_in_air", *arguments]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith("nanotouch plan: ")
    assert words in said.err
    assert said.err.count("\n") == 1


@pytest.mark.parametrize("option", ["--budget", "--bound", "--quantity", "--force-floor", "--youngs-modulus", "--unit"])
def test_an_option_that_is_gone_names_what_takes_its_place(option: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(["plan", "silicon_in_air", option, "10"])
    assert stopped.value.code == 2
    said = capsys.readouterr().err
    assert f"{option} is no option any more: name it in the [" in said
    assert said.count("\n") == 1


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[tip]\nradius_nN = 20\n", "radius_nN"),
        ("[tip]\nradius = 20\n", "radius_nm"),
        ("[tip]\nradius_nm = -1\n", "radius_nm = -1"),
        ("[tipp]\nradius_nm = 20\n", "unknown section [tipp]"),
        ("[demand]\nquantity = 'colour'\n", "valid are force, stiffness, radius, folds"),
        ("[adhesion]\nhamaker_constant_J = 1e-17\n", "alone pulls more than the whole work of adhesion) = 1e-17 J"),
        ("radius = \n", "is not a TOML file"),
    ],
)
def test_wrong_files(text: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(text)
    assert main(["plan", str(path)]) == 2
    error = capsys.readouterr().err
    assert words in error
    assert error.count("\n") == 1


def test_neither_file_nor_preset(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", str(tmp_path / "none.toml")]) == 2
    assert "no such file" in capsys.readouterr().err
    assert main(["plan", "silicon-in-air"]) == 2
    error = capsys.readouterr().err
    assert "did you mean silicon_in_air" in error
    assert "cell_in_liquid" in error


def test_a_file_of_any_name(file: str, capsys: pytest.CaptureFixture[str]) -> None:
    other = Path(file).rename(Path(file).with_suffix(".txt"))
    assert ask(capsys, str(other))["radius"] == 30e-9
