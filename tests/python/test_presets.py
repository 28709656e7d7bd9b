# SPDX-License-Identifier: BSD-3-Clause
"""The presets: a first touch warns of nothing that can be helped, and what is said to be felt is felt."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from nanotouch import Rheology, Scene, Session, Surface, Topography, presets, surface
from nanotouch.errors import InvalidValue
from nanotouch.scene.interaction import Interaction
from nanotouch_app.common import scenes, surfaces
from nanotouch_app.main import main
from nanotouch_app.studies.plan import PAPER, PRESETS

SCENE_PAGE = Path(__file__).resolve().parents[2] / "docs" / "scene.md"


# a sample that yields, and glass whose van der Waals forces exceed its work of adhesion, warn of that
QUIET = [name for name in PRESETS if name not in scenes.MADE]
IN_LIQUID = ("cell_in_liquid", "chondrocyte", "polymer_gel")  # whose drag is left out


@pytest.mark.parametrize("name", [name for name in QUIET if name not in IN_LIQUID])
def test_a_first_touch_warns_of_nothing(name: str) -> None:
    """Neither as planned nor in a session; the session keeps to the largest load, and its plan is that of the scene."""
    scene, rig = scenes.of_preset(name)
    assert scene.plan().warnings == []
    session = Session(scene, rig)
    assert session.plan.warnings == []
    assert session.settings.limits.force == scene.range.maximum_load
    assert session.settings.gains.set_point <= 0.5 * scene.range.maximum_load
    assert str(session.plan) == str(scene.plan(rig=rig))


@pytest.mark.parametrize("name", QUIET)
def test_a_first_touch_of_its_surface_warns_of_nothing(name: str) -> None:
    """As `nanotouch touch --scene NAME` does it. In liquid it is told that drag is left out, and that a sample that
    deforms, or relaxes, is solved for the radius of the tip alone."""
    scene, rig = scenes.of_preset(name)
    session = Session(scene, rig, surface=Surface.touched_by(scene, surfaces.of_scene(name)))
    left_out = ("viscous drag at the fastest approach, left out", "curvature of the surface, which this tip's law")
    said = [warning.text for warning in session.plan.warnings if not warning.text.startswith(left_out)]
    assert said == []
    assert name in IN_LIQUID or session.plan.warnings == []
    assert session.guarantee().warning is None
    assert session.calm().is_calm


def test_the_default_touch_warns_of_nothing() -> None:
    session = Session()
    assert session.plan.warnings == []
    recording = session.run()
    assert np.max(recording.tip_force) < session.settings.limits.force


@pytest.mark.parametrize("made", [surface.grating, surface.dots])
def test_edges_of_a_step_are_no_warning(made: Callable[[], Topography]) -> None:
    """A map with steps has pixels whose curvature it does not resolve; most of it has not."""
    scene = Scene()
    plan = scene.plan(surface=Surface.touched_by(scene, made()))
    assert plan.warnings == []


@pytest.mark.parametrize("name", PRESETS)
def test_what_is_felt_is_told(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", name]) == 0
    felt = scenes.felt(name)
    assert capsys.readouterr().out.splitlines()[-1] == f"felt: {felt}"
    assert f"| `{name}` | {felt} |" in SCENE_PAGE.read_text(encoding="utf-8")


@pytest.mark.parametrize("name", PAPER)
def test_the_papers_scenes_stay(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Up to the 2.2 uN of the paper's rig, beyond small contacts."""
    scene, _ = getattr(presets, name)()
    assert scene.range.maximum_load == 2.2e-6
    assert main(["plan", name]) == 0
    assert "warning: contact radius over tip radius at the largest load" in capsys.readouterr().out


def test_plastic_contact_is_refused_and_names_the_load() -> None:
    """The paper's polyester with the Y of PET: 2.2 uN on a tip of 20 nm press with far more than 3 Y."""
    scene, _ = presets.paper_polyester()
    scene.sample.yield_strength = 0.07e9
    with pytest.raises(InvalidValue, match=r"range.maximum_load \(mean pressure above 3 times the yield strength"):
        scene.plan()


class Facts(NamedTuple):
    """What the sentences say."""

    snap: float
    """where the probe's spring gives way on approach [m]"""
    pull_off: float
    """[N]"""
    stiffness: float
    """at the largest load [N/m]"""
    depth: float
    """there [m]"""


FACTS = {
    "silicon_in_air": Facts(0.7e-9, 18e-9, 665.0, 0.93e-9),
    "silicon_on_gold": Facts(0.86e-9, 54.5e-9, 850.0, 0.845e-9),
    "mica_in_air": Facts(0.59e-9, 3.4e-9, 366.0, 0.83e-9),
    "polyester": Facts(0.195e-9, 444e-9, 374.6, 4.16e-9),
    "silicone_rubber": Facts(0.195e-9, 746.4e-9, 18.42, 144.1e-9),
    "polystyrene_ball": Facts(0.195e-9, 568e-9, 631.3, 3.873e-9),
    "inas_dots": Facts(0.7e-9, 17.9e-9, 420.1, 1.220e-9),
}


@pytest.mark.parametrize("name", FACTS)
def test_the_numbers_of_what_is_felt(name: str) -> None:
    """By the plan that is exact, everything on."""
    scene, rig = getattr(presets, name)()
    plan, facts = scene.plan(bound="exact"), FACTS[name]
    gaps = np.geomspace(1e-7, 1e-10, 20001)
    law = plan.run(gaps)
    gives_way = (-law.k > rig.probe.spring_constant) | (np.diff(law.F, prepend=0.0) < -0.2 * plan.pull_off_force)
    assert gaps[np.argmax(gives_way)] == pytest.approx(facts.snap, rel=0.02)
    assert plan.pull_off_force == pytest.approx(facts.pull_off, rel=0.01)
    assert plan.maximum_stiffness == pytest.approx(facts.stiffness, rel=0.01)
    assert plan.explain()["largest_indentation"] == pytest.approx(facts.depth, rel=0.02)


@pytest.mark.parametrize("name", FACTS)
def test_a_touch_from_air_to_air(name: str) -> None:
    """The default script presses, is held by all of the adhesion, comes free, and nothing stops it."""
    session = Session(*getattr(presets, name)())
    recording = session.run()
    limit = session.settings.limits.force
    assert not recording.columns["state"].any()
    pressed = 2.0 / session.settings.gains.alpha_f  # the script's push at the hand, where half the limit is not less
    assert min(0.4 * limit, 0.9 * pressed) < np.max(recording.tip_force) < limit
    assert -np.min(recording.tip_force) == pytest.approx(session.plan.pull_off_force, rel=0.05)
    assert abs(recording.tip_force[-1]) < 1e-3 * limit


def test_the_noise_of_the_lever_is_as_said() -> None:
    for name, times in (("silicon_in_air", 8.2), ("mica_in_air", 12.3)):
        scene, rig = getattr(presets, name)()
        plan = scene.plan(rig=rig)
        assert plan.pull_off_force / plan.explain()["probe_noise"] == pytest.approx(times, abs=0.1)
    gold = presets.silicon_on_gold()[0].plan(bound="exact")
    assert -float(gold.law("electrostatic", 0.0).F) == pytest.approx(0.525e-9, rel=0.01)


def test_a_ball_that_is_rubbed_slips_as_said() -> None:
    """Rubbed over 0.4 um at the largest load: the lever shows tau0 pi a^2, and the hand would have 1.7 N of it."""
    scene, rig = presets.polystyrene_ball()
    plan = scene.plan(rig=rig, bound="exact")
    assert plan.friction.force == pytest.approx(0.55e-6, rel=0.03)
    rubbed = Interaction(plan)
    x = np.linspace(0.0, 0.4e-6, 401)
    found = rubbed.advance(np.column_stack([x, 0 * x, np.full_like(x, -3.873e-9)]))
    assert -found.Fx[-1] == pytest.approx(plan.friction.force, rel=0.01)
    session = Session(scene, rig)
    assert session.sideways().least > 1.5
    assert session.settings.gains.alpha_f * plan.friction.force == pytest.approx(1.7, rel=0.05)


def test_the_cell_feels_as_fur_over_jelly() -> None:
    plan = presets.cell_in_liquid()[0].plan()
    for gap, force in ((357e-9, 10e-12), (-3e-9, 0.3e-9), (-232.7e-9, 0.9e-9)):
        assert float(plan.force(gap)) == pytest.approx(force, rel=0.03)
    assert plan.pull_off_force < 1e-14
    assert "deforms under all forces" in str(plan)


CHONDROCYTE = (21e3, 9.3e3, 2.8e3)  # at once, in the end [Pa], viscosity [Pa s]: the abstract of Nguyen et al. (2010)


def test_the_chondrocyte_has_the_moduli_of_its_source() -> None:
    """And sinks in as said: Hertz by hand, 4/3 E/(1 - nu^2) sqrt(R) delta^(3/2), to the sphere's few per cent."""
    rheology = presets.chondrocyte()[0].rheology
    quick, slow, viscosity = CHONDROCYTE
    kernel = Rheology.standard_linear_solid(
        rheology.equilibrium_modulus, rheology.arm_modulus_1, rheology.relaxation_time_1
    )
    at = kernel.relaxation(np.array([1e-6, 2.0]))
    assert at[0] == pytest.approx(quick, rel=1e-4)
    assert at[1] == pytest.approx(slow, rel=1e-3)
    assert rheology.arm_modulus_1 * rheology.relaxation_time_1 == pytest.approx(viscosity, rel=1e-12)
    for modulus, depth in ((quick, 0.17e-6), (slow, 0.29e-6)):
        hertz = (4e-9 / (16.0 / 9.0 * modulus * np.sqrt(2.5e-6))) ** (2.0 / 3.0)
        assert hertz == pytest.approx(depth, rel=0.03)
    assert slow / quick == pytest.approx(0.44, abs=0.005)


def test_the_gel_sinks_in_as_said() -> None:
    """Under a steady load delta^(3/2) goes as J(t): a decade of time gives 10^(2 beta/3) - 1, a tenth."""
    scene = presets.polymer_gel()[0]
    gel = Rheology.power_law(scene.rheology.modulus, scene.rheology.exponent)
    depth = (1e-9 * gel.creep(np.array([1.0, 10.0, 100.0])) / (16.0 / 9.0 * np.sqrt(2.5e-6))) ** (2.0 / 3.0)
    assert depth[0] == pytest.approx(0.35e-6, rel=0.02)
    assert depth[1:] / depth[:-1] == pytest.approx(1.1, abs=0.02)


@pytest.mark.parametrize("name", ["chondrocyte", "polymer_gel"])
def test_a_sample_that_relaxes_gives_way_under_a_hand_that_holds_still(name: str) -> None:
    scene, rig = getattr(presets, name)()
    session = Session(scene, rig)
    recording = session.run()
    assert not recording.columns["state"].any()
    assert session.plan.bound < 0.01
