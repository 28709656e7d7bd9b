# SPDX-License-Identifier: BSD-3-Clause
"""The commands that push a particle and indent a sample: what they say beside what they have written."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import nanotouch as nt
import pytest
from nanotouch import manipulation, plasticity, record
from nanotouch_app.main import main


def test_push_tells_what_the_library_does(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "pushed"
    assert main(["push", "--to", "1um,0.5um", "--seed", "3", "--out", str(out)]) == 0
    facts = json.loads((out / "push.json").read_text())
    done = manipulation.push(manipulation.latex(500e-9), (1e-6, 0.5e-6), seed=3)
    assert facts["error_m"] == done.error
    assert facts["lines"] == done.lines
    assert f"{done.pushes} pushes" in capsys.readouterr().out
    lines = [line for line in (out / "push.csv").read_text().splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    assert float(rows[-1]["particle x [m]"]) == pytest.approx(done.position[0], rel=1e-6)
    assert (out / "push.png").stat().st_size > 10_000


def test_push_on_a_lever(tmp_path: Path, capsys: pytest.CaptureFixture[str], undrawn: None) -> None:
    out = tmp_path / "hung"
    assert main(["push", "--to", "0.4um,0um", "--seed", "3", "--lever", "1N/m,1N/m,0.5N/m", "--out", str(out)]) == 0
    facts = json.loads((out / "push.json").read_text())
    soft = manipulation.Lever((1.0, 1.0, 0.5))
    done = manipulation.push(manipulation.latex(500e-9), (0.4e-6, 0.0), seed=3, lever=soft)
    assert facts["error_m"] == done.error
    push = float(abs(done.track.force[:, 0]).max())
    assert facts["lever_give_m"] == pytest.approx(push / 1.0, rel=0.3)  # along x; z gives less than twice its force
    assert "the lever gives way by" in capsys.readouterr().out


def test_push_that_does_not_arrive_has_status_1(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], undrawn: None
) -> None:
    """Closer than the noise of a look allows in 200 pushes. It says so."""
    assert main(["push", "--to", "0.2um,0um", "--tolerance", "1pm", "--out", str(tmp_path / "a")]) == 1
    told = "it did not arrive: given up after 200 pushes, without a look within 1 pm of the target"
    assert told in capsys.readouterr().out


def test_indent_leaves_the_dent_of_its_load(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "indented"
    assert main(["indent", "100nN", "--out", str(out)]) == 0
    facts = json.loads((out / "indent.json").read_text())
    (dent,) = record.read(out / "recording.mcap").dents
    scene = nt.Scene(tip={"material": "diamond"}, sample={"material": "gold"})
    modulus = nt.contact.effective_modulus(
        float(scene.tip.youngs_modulus), float(scene.tip.poisson_ratio),
        float(scene.sample.youngs_modulus), float(scene.sample.poisson_ratio),
    )  # fmt: skip
    made = plasticity.Indentation(20e-9, modulus, 0.35e9).at_load(facts["largest_force_N"])
    assert facts["largest_force_N"] == pytest.approx(100e-9, rel=0.3)  # it turns where the noisy lever shows it
    assert dent.imprint.depth == pytest.approx(float(made.residual_depth), rel=0.01)
    assert facts["heat_J"] == pytest.approx(float(made.dissipated), rel=0.01)
    assert "nm wide" in capsys.readouterr().out
    assert (out / "indent.png").stat().st_size > 10_000


def test_indent_that_stays_elastic_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--scene", "silicon_in_air", "--out", str(tmp_path / "a")]
    assert main(["indent", "20nN", *options]) == 0
    assert "it stayed elastic: no dent" in capsys.readouterr().out


def test_a_touch_tells_the_dents_that_it_leaves(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], undrawn: None
) -> None:
    scene = tmp_path / "soft.toml"
    scene.write_text(
        '[tip]\nmaterial = "diamond"\n[sample]\nmaterial = "gold"\nyield_strength_GPa = 0.35\ndents = "yes"\n'
        "[medium]\nrelative_humidity = 0\n[adhesion]\nwork_of_adhesion_J_per_m2 = 0\nhamaker_constant_zJ = 0\n"
        "[range]\nmaximum_load_nN = 150\n"
    )
    out = tmp_path / "touched"
    assert main(["touch", "--scene", str(scene), "--surface", "flat", "--no-window", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    (dent,) = json.loads((out / "summary.json").read_text())["dents"]
    assert dent["depth_m"] == record.read(out / "recording.mcap").dents[0].imprint.depth
    assert f"1, the deepest {1e9 * dent['depth_m']:.3g} nm" in said
    assert "model error not known" in said


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("push --lever 1uN/m,1uN/m,1uN/m", ["stiffness = 1e-06 N/m sideways", "N/m and above"]),
        ("push --radius 50nm --lever 1N/m,1N/m,1uN/m", ["stiffness = 1e-06 N/m along z: the tip clings", "is enough"]),
        ("push --radius 1nm", ["--radius 1nm", "50nm .. 20um"]),
        ("push --to 0um,0um", ["--to 0um,0um", "above 0, up to 500 µm, 1000 radii"]),
        ("push --to 5um", ["1 lengths instead of 2"]),
        ("push --tolerance 0nm", ["tolerance"]),
        ("push --seed -1", ["'-1'", "0 .. 2^32 - 1"]),
        ("push --lever 1N/m", ["--lever 1N/m", "three stiffnesses"]),
        ("push --lever 1N/m,0N/m,1N/m", ["stiffness = 0 N/m"]),
        ("indent 0nN", ["LOAD 0nN", "above 11 nN"]),
        ("indent 3nN", ["LOAD 3nN", "times the noise of the lever"]),
        ("indent 10uN", ["range.maximum_load"]),
        ("push --drift -1nm/s", ["drift = -1e-09 m/s", "0 m/s and above"]),
        ("scan --lines 3", ["'3'", "4 .. 8192"]),
        ("scan --seed -1", ["'-1'", "0 .. 2^64 - 1"]),
        ("scan --mode contact --set-point -5nN", ["zloop.set_force", "-5e-09 N"]),
        ("indent 5", ["'5' has no unit"]),
        ("indent 10nN --scene silicon_on_gold", ["--yield-strength"]),
        ("indent 10nN --piled-up 2", ["piled_up"]),
    ],
)
def test_wrong_input_is_named(
    line: str, words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    try:
        status = main(line.split())
    except SystemExit as end:
        status = int(str(end.code))
    assert status == 2
    said = capsys.readouterr().err
    assert all(word in said for word in words), said
    assert "Traceback" not in said
