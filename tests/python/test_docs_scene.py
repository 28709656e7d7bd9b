# SPDX-License-Identifier: BSD-3-Clause
"""The pages on scenes, plans and interactions say what is so: the example file, the fields, every number."""

from __future__ import annotations

import math
import re
import runpy
from pathlib import Path

import numpy as np
import pytest
from nanotouch import Demand, Rig, Scene, presets
from nanotouch.scene import Quantity
from nanotouch.scene.interaction import STATE_SIZE
from nanotouch.scene.plan import ROWS
from nanotouch_app.common import scenes as named
from nanotouch_app.main import main
from nanotouch_app.studies.plan import PRESETS

ROOT = Path(__file__).resolve().parents[2]


def page(name: str) -> str:
    return (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")


@pytest.fixture
def example(tmp_path: Path) -> Path:
    (text,) = re.findall(r"```toml\n(.*?)```", page("scene"), re.DOTALL)
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_fields_are_up_to_date() -> None:
    written = runpy.run_path(str(ROOT / "tools" / "fields.py"))["page"]()
    assert page("fields") == written, "run .venv/bin/python tools/fields.py > docs/fields.md"


def test_every_field_is_on_the_page() -> None:
    for description in (Scene, Rig, Demand):
        for name in description.fields:
            assert f"| `{name}` |" in page("fields")


def test_example_file(example: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene, rig, demand = Scene.from_toml(example), Rig.from_toml(example), Demand.from_toml(example)
    assert (scene.tip.radius, scene.tip.poisson_ratio, scene.tip.conducting) == (30e-9, 0.28, "yes")
    assert (scene.sample.youngs_modulus, scene.sample.poisson_ratio) == (79e9, 0.44)  # own modulus, gold's ratio
    assert (scene.adhesion.given, scene.adhesion.hamaker_constant) == ("pull_off_force", 2e-19)
    assert (scene.friction.shear_strength, scene.friction.coefficient) == (20e6, 0.1)
    assert (rig.probe.spring_constant, demand.demand.force_floor) == (40.0, 20e-12)
    assert {line.strip("[]") for line in example.read_text().splitlines() if line.startswith("[")} == {
        *scene.sections(), "probe", "demand",
    }  # fmt: skip
    assert main(["plan", str(example)]) == 0
    assert "pull-off 12 nN" in capsys.readouterr().out


@pytest.mark.parametrize("name", ["plan", "scene", "interaction"])
def test_python_of_the_page_runs(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    blocks = re.findall(r"```python\n(.*?)```", page(name), re.DOTALL)
    assert blocks
    for block in blocks:
        exec(compile(block, f"docs/{name}.md", "exec"), {})
    assert capsys.readouterr().out


@pytest.mark.parametrize("name", ["plan", "scene", "interaction", "deformation", "contact"])
def test_no_sentence_is_longer_than_35_words(name: str) -> None:
    """Of running text and of points of a list; code, tables and headings are none."""
    text = re.sub(r"```.*?```", "", page(name), flags=re.DOTALL)
    lines = [line for line in text.splitlines() if not line.startswith(("|", "#", "    ", "      "))]
    paragraphs = re.split(r"\n\s*\n|\n(?=- |\d\. )", "\n".join(lines))
    for paragraph in paragraphs:
        for sentence in re.split(r"(?<=[.:;!?])\s+", re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", paragraph)):
            assert len(sentence.split()) <= 35, sentence


def test_plan_is_printed_as_on_the_page() -> None:
    assert f"```\n{Scene().plan()}\n```" in page("plan")


def test_refusals_are_those_of_the_page(capsys: pytest.CaptureFixture[str]) -> None:
    (block,) = re.findall(r"```\n(\$ nanotouch plan.*?)```", page("plan"), re.DOTALL)
    shown = block.splitlines()
    for command, answer in zip(shown[::2], shown[1::2], strict=True):
        assert main(command.split()[2:]) == 2
        assert capsys.readouterr().err.strip() == answer


def test_laws_are_up_to_date() -> None:
    written = runpy.run_path(str(ROOT / "tools" / "terms.py"))["page"]()
    assert page("terms") == written, "run .venv/bin/python tools/terms.py > docs/terms.md"


def test_costs_are_those_of_the_rows() -> None:
    """Every term of a plan has a cost of its row; all forms that presets and their neighbours come to are asked."""
    told = {(row.name, form.words): (form.name, form.cost) for row in ROWS for form in row.forms}
    scenes = [named.of_preset(name)[0] for name in PRESETS]
    scenes += [Scene(tip={"height": 1e-5}, adhesion={"contact_potential": 1.0}, sample={"charge": 1e-18})]
    scenes += [Scene(medium={"kind": "liquid", "ionic_strength": 10.0, "hydration_energy": 0.01},
                     tip={"surface_potential": 0.02}, sample={"surface_potential": 0.02})]  # fmt: skip
    seen = set()
    for scene in scenes:
        for accuracy in (None, 1e-2, 1e-3, 1e-4, 1e-8):
            try:
                plan = scene.plan(bound="exact") if accuracy is None else scene.plan(accuracy)
            except ValueError:  # refused: nothing to compare
                continue
            if plan.explain()["deforms"] or "springs that relax" in str(plan):  # all terms are computed as one
                continue
            for term in plan.terms:
                assert told[term.name, term.words] == (term.form, term.cost)
                seen.add((term.name, term.words))
    assert len(seen) >= 10


def test_numbers_of_the_plan_page() -> None:
    plan = Scene().plan()
    assert plan.maximum_stiffness == pytest.approx(665, abs=0.5)
    assert plan.cutoff_gap(10e-12) == pytest.approx(5.6e-9, abs=0.05e-9)
    assert plan.stable_step(1e-12) == pytest.approx(78e-9, abs=0.5e-9)
    exact = Scene().plan(bound="exact")
    assert exact.cost == exact.explain()["full_cost"]
    for preset, lam in ((presets.paper_inas, 0.0597), (presets.paper_mica, 5.23)):  # both ends of its table
        found = preset()[0].plan()
        assert found.maugis_lambda == pytest.approx(lam, rel=2e-3)
        assert 0.0 < found.model_error < 0.5
    assert math.isnan(plan.model_error)  # at lambda 0.04


def test_bound_of_each_quantity_is_the_sum_of_its_terms() -> None:
    quantities: tuple[Quantity, ...] = ("force", "stiffness", "radius", "folds")
    for quantity in quantities:
        plan = Scene(adhesion={"contact_potential": 0.5}).plan(relative_accuracy=0.05, quantity=quantity)
        terms = [*plan.terms, *plan.omitted]
        facts = plan.explain()
        deforming = facts["rigid_error"] + facts["around_error"]  # what a sample that is taken as rigid would give way
        total = sum(term.bound for term in terms)
        assert (1.0 - 1e-12) * total <= plan.bound <= (1.0 + 1e-12) * (total + deforming)
        if quantity in ("radius", "folds"):
            assert [term.name for term in plan.terms] == ["contact"]


def test_dry_silicon_steps_by_dugdales_own_fold() -> None:
    """Page on interactions: P = 128 lambda^3/(9 pi) pi w R where the range begins, with what the tail leaves of w."""
    scene = Scene(medium={"relative_humidity": 0.0})
    plan = scene.plan(bound="exact")
    facts = plan.explain()
    lam, w, capture = facts["lambda"], facts["work_of_adhesion"], facts["capture_gap"]
    assert (lam, w) == (pytest.approx(0.166, abs=5e-4), pytest.approx(83e-3, abs=0.5e-3))
    outside, inside = plan.force(capture * np.array([1.0 + 1e-9, 1.0 - 1e-9]))
    assert outside - inside == pytest.approx(128 * lam**3 / (9 * math.pi) * math.pi * w * 20e-9, rel=1e-4)
    assert outside - inside == pytest.approx(0.108e-9, abs=5e-13)
    assert plan.pull_off_force == pytest.approx(12.07e-9, abs=5e-12)
    assert (outside - inside) / plan.pull_off_force == pytest.approx(0.009, abs=2e-4)
    assert scene.plan(relative_accuracy=0.01).minimum_spring == pytest.approx(118, abs=0.5)
    assert math.isinf(scene.plan(relative_accuracy=0.001).minimum_spring)


def test_tail_acts_in_every_state_and_is_held() -> None:
    """With a meniscus, too: near the release gap and far out the force is the tail's, on both histories."""
    plan = Scene().plan(bound="exact")
    facts = plan.explain()
    tail = next(term for term in plan.terms if term.name == "vdw")
    bare = Scene(adhesion={"hamaker_constant": 0.0}).plan(bound="exact").explain()
    left = bare["work_of_adhesion"] - tail.force / (2 * math.pi * 20e-9)
    assert facts["work_of_adhesion"] == pytest.approx(left, rel=1e-12)
    assert bare["work_of_adhesion"] / bare["cohesive_stress"] == pytest.approx(
        left / facts["cohesive_stress"], rel=1e-12
    )
    assert plan.force([1.0001 * facts["capture_gap"]])[0] == pytest.approx(-tail.force, rel=1e-3)
    far = 1.001 * facts["release_gap"]
    assert plan.force([far], "retract")[0] == plan.force([far])[0] < 0.0


def test_state_is_24_bytes() -> None:
    assert STATE_SIZE == 24
    assert "24 bytes" in page("interaction")
