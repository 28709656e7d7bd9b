# SPDX-License-Identifier: BSD-3-Clause
"""A plan as constants of C: the table against the plan, and the header through compilers."""

from __future__ import annotations

import math
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
import random_scenes
from nanotouch import _core
from nanotouch.errors import Error, InvalidValue
from nanotouch_app.common import scenes
from nanotouch_app.main import main
from nanotouch_app.studies.tradeoff.plans import PRESETS

ROOT = Path(__file__).parents[2]
TOOL = ROOT / "tools" / "single.py"
PLAN_H = ROOT / "apps" / "mcu" / "plan.h"


def bends(plan: nt.Plan) -> list[float]:
    """Where the force may bend or jump."""
    facts = plan.explain()
    return [0.0, facts["capture_gap"], facts["release_gap"]]


def gaps_of(plan: nt.Plan, table: Any, rng: np.random.Generator) -> Any:
    """Floats over the whole range, most of them near where the force bends; none where no bound is stated."""
    deepest = plan.explain()["largest_indentation"]
    far = max(min(table.farthest, 100e-9), 1e-9 - deepest)
    gaps = [rng.uniform(-deepest, far, 150), [-deepest * 10.0 ** -rng.uniform(0, 6) for _ in range(50)]]
    for bend in bends(plan):
        gaps.append(bend + rng.choice([-1.0, 1.0], 80) * 10.0 ** rng.uniform(-15, -9, 80))
    singles = np.concatenate(gaps).astype(np.float32)
    exact = singles.astype(float)
    kept = exact >= -deepest
    for bend in bends(plan):
        kept &= np.abs(exact - bend) >= table.fold_distance
    return singles[kept]


def excess(plan: nt.Plan, table: Any, gaps: Any, attached: bool) -> float:
    """The largest error over the bound, each gap by itself on one history."""
    worst = 0.0
    for gap in gaps:
        force = float(table.run(np.array([gap], dtype=np.float32), attached)[0][0])
        truth = float(plan.force(np.array([float(gap)]), "retract" if attached else "approach")[0])
        worst = float(np.maximum(worst, abs(force - truth) / max(abs(truth), table.scale) / table.bound))
    return worst


@pytest.mark.parametrize("seed", range(24))
def test_random_plans_keep_the_bound_of_their_table(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scene = (random_scenes.near_preset if seed % 2 else random_scenes.extreme)(rng)
    quantity = str(rng.choice(["force", "force", *random_scenes.QUANTITIES]))
    try:
        plan = scene.plan(10.0 ** rng.uniform(-6, -0.6), quantity=quantity)  # type: ignore[arg-type]
    except Error:
        return  # no such plan
    table = _core.ForceTable(plan.core)
    gaps = gaps_of(plan, table, rng)
    assert len(gaps) > 50
    for attached in (False, True):
        assert excess(plan, table, gaps, attached) <= 1.0


@pytest.mark.parametrize("name", PRESETS + scenes.PAPER)  # one that relaxes has no table
def test_presets_keep_it_and_have_a_header(name: str) -> None:
    scene, rig = getattr(nt.presets, name)()
    plan = scene.plan()
    table = _core.ForceTable(plan.core)
    rng = np.random.default_rng(5)
    for attached in (False, True):
        assert excess(plan, table, gaps_of(plan, table, rng), attached) <= 1.0
    text = nt.c_header.write(plan, rig, name=name)
    assert f"static const ntf_touch {name}_touch" in text
    assert ("friction is not in it" in text) == (plan.friction.form != "off")


def test_a_table_is_no_coarser_than_a_tenth_of_the_demand() -> None:
    for accuracy in (0.1, 0.01, 1e-3, 1e-4):
        table = _core.ForceTable(nt.Scene().plan(relative_accuracy=accuracy).core)
        assert table.bound <= 0.1 * accuracy * 1.051 + 2e-5


def test_a_law_of_ones_own_is_in_the_table() -> None:
    def force(gap: float, strength: float, length: float) -> float:
        return strength * math.exp(-gap / length)

    nt.scene.register(
        "header_gel",
        energy=lambda gap, strength, length: length * force(gap, strength, length),
        force=force,
        stiffness=lambda gap, strength, length: force(gap, strength, length) / length,
        bound=force,
        parameters={"strength": None, "length": 2e-9},
        units={"strength": "N", "length": "m"},
    )
    plan = nt.Scene(terms={"header_gel": {"strength": 5e-9}}).plan()
    table, bare = _core.ForceTable(plan.core), _core.ForceTable(nt.Scene().plan().core)
    gaps = gaps_of(plan, table, np.random.default_rng(7))
    for attached in (False, True):
        assert excess(plan, table, gaps, attached) <= 1.0
    far = np.array([1e-9, 2e-9, 4e-9], dtype=np.float32)
    own = table.run(far, False)[0] - bare.run(far, False)[0]
    np.testing.assert_allclose(own, [force(gap, 5e-9, 2e-9) for gap in far.tolist()], atol=2.5e-3 * table.scale)
    assert "header_gel" in nt.c_header.write(plan)


# --- the header ---


def numbers_of(text: str, name: str) -> list[float]:
    """What is written in the braces of a constant, `name` and pointers left out."""
    block = text.split(f" {name}", 1)[1].split("= {", 1)[1].split("};", 1)[0]
    return [float(n) for n in re.findall(r"(?<![\w.])-?(?:\d[\d.]*(?:e[+-]\d+)?|INFINITY)(?=f?\b)", block)]


def test_numbers_survive_the_writing() -> None:
    plan = nt.Scene().plan()
    table = _core.ForceTable(plan.core)
    text = nt.c_header.write(plan)
    rows = re.findall(r"^    \{(.*)\},$", text, re.MULTILINE)
    assert len(rows) == table.pieces
    first = [np.float32(n) for n in re.findall(r"-?[\d.]+e[+-]\d+", rows[0])]
    gap, _, force, *_ = first
    assert float(table.run(np.array([gap], dtype=np.float32), True)[0][0]) == float(force)
    assert np.float32(re.search(r"(\S+)f, /\* bound", text)[1]) == np.float32(table.bound)  # type: ignore[index]


@pytest.fixture(scope="module")
def single(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("single")
    subprocess.run([sys.executable, TOOL, folder], check=True)
    return folder


COMPILERS = [
    ("gcc", "c", "-std=c11"),
    ("g++", "c++", "-std=c++11"),
    ("clang", "c", "-std=c11"),
    ("clang++", "c++", "-std=c++11"),
]


@pytest.mark.parametrize(("compiler", "language", "standard"), COMPILERS)
def test_a_header_compiles_without_a_warning(
    single: Path, tmp_path: Path, compiler: str, language: str, standard: str
) -> None:
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler}")
    plan, rig = nt.Scene().plan(), nt.Rig(stage={"axes": 1})
    modes: tuple[Any, ...] = ("point", "topography", "curve")
    for mode in modes:
        (tmp_path / f"{mode}.h").write_text(nt.c_header.write(plan, rig, mode=mode, name=mode))
    source = tmp_path / "all.c"
    source.write_text(
        '#include "point.h"\n#include "topography.h"\n#include "curve.h"\nint main(void)\n{\n    int attached = 0;\n'
        "    ntf_touch_state state = ntf_touch_start(&point_touch, 0.0f, 0.0f, 0.0f);\n    (void)state;\n"
        "    const float pull = ntf_force_table_eval(&point_force, &attached, 0.2e-9f).force;\n"
        "    return attached == 1 && pull < -1e-9f && curve_touch.mode == NTF_MODE_CURVE &&\n"
        "           topography_touch.law != 0 ? 0 : 1;\n}\n"
    )
    made = tmp_path / "made"
    strict = ["-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-pedantic", "-Werror", standard, f"-I{single}"]
    subprocess.run([compiler, "-x", language, *strict, "-c", source, "-o", tmp_path / "a.o"], check=True)
    plain = "gcc" if "g" in compiler[:1] else "clang"
    subprocess.run([plain, "-std=c11", "-c", single / "nanotouch_single.c", "-o", tmp_path / "s.o"], check=True)
    subprocess.run([compiler, tmp_path / "a.o", tmp_path / "s.o", "-lm", "-o", made], check=True)
    assert subprocess.run([made]).returncode == 0


def test_the_header_of_apps_mcu_is_up_to_date(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = tmp_path / "plan.h"
    scene = ROOT / "apps" / "mcu" / "scene.toml"
    assert main(["plan", str(scene), "--mode", "approach", "--c-header", str(made)]) == 0
    assert made.read_text() == PLAN_H.read_text(), "run the command that apps/mcu/scene.toml names"
    assert main(["plan", str(scene), "--c-header", str(made)]) == 2
    assert "exists already" in capsys.readouterr().err


# --- what is refused, in words ---


def test_refusals() -> None:
    flat = nt.Scene().plan()
    body = nt.Surface(nt.surface.grating(), tip_radius=20e-9)
    with pytest.raises(InvalidValue, match="a plan over a surface has a force of each place"):
        nt.c_header.write(nt.Scene().plan(surface=body))
    for name in ("", "9", "a b", "Größe", "plan;", "_a"):
        with pytest.raises(InvalidValue, match="name = "):
            nt.c_header.write(flat, name=name)
    settings = nt.Settings()
    settings.limits.force = 1e-5
    with pytest.raises(Error, match=r"limits\.force"):  # that the rig cannot keep
        nt.c_header.write(flat, settings=settings)


def test_what_is_beyond_its_ends() -> None:
    table = _core.ForceTable(nt.Scene().plan().core)
    deep = np.array([-1e-6, -2e-6], dtype=np.float32)
    force, stiffness = table.run(deep, False)
    assert stiffness[0] == stiffness[1] > 0.0
    assert math.isclose(force[1] - force[0], stiffness[0] * 1e-6, rel_tol=1e-5)
    far = np.array([table.farthest * 1.01, math.inf, math.nan], dtype=np.float32)
    force, _ = table.run(far, False)
    assert force[0] == force[1] == 0.0
    assert math.isnan(force[2])
