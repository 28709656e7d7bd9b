# SPDX-License-Identifier: BSD-3-Clause
"""The scale of a first touch: the sample's pull-off is clearly felt, within the margins."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import nanotouch as nt
import pytest
from nanotouch import margins
from nanotouch_app.main import main

PRESETS = ("silicon_in_air", "silicon_on_gold", "mica_in_air", "polyester", "silicone_rubber", "cell_in_liquid")


@pytest.mark.parametrize("name", PRESETS)
def test_every_preset_may_be_armed_at_it(name: str) -> None:
    """0.3 N at the hand, or as much as Eq. 19 gives from pull-off to largest load, or, where nothing pulls, the
    largest load as half of that; never less than before."""
    scene, rig = getattr(nt.presets, name)()
    plan, load = scene.plan(), scene.range.maximum_load
    pull_off, settings = plan.pull_off_force, nt.Settings.for_rig(rig)
    alpha_f = margins.felt_alpha_f(rig, settings, plan, load=load)
    assert alpha_f >= settings.gains.alpha_f
    felt = alpha_f * pull_off
    whole = 2.0 * rig.master.max_force
    pulls = pull_off > 1e-3 * load
    assert felt >= 0.3 or (
        alpha_f * (pull_off + load) == pytest.approx(whole) if pulls else alpha_f * load > 0.5 * whole
    )
    session = nt.Session(scene, rig)
    assert session.settings.gains.alpha_f == alpha_f
    assert session.margins().refusal is None
    assert session.calm().is_calm


def test_without_adhesion_the_load_fills_the_hand() -> None:
    scene, rig = (
        nt.Scene(adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0}, medium={"relative_humidity": 0.0}),
        nt.Rig(),
    )
    assert scene.plan().pull_off_force == 0.0
    settings, load = nt.Settings.for_rig(rig), 1e-6
    assert margins.felt_alpha_f(rig, settings, scene.plan(), load=load) == pytest.approx(10.0 / load)


def test_where_the_loop_leaves_less_it_is_as_much_as_is_stable_and_calm() -> None:
    """A link of 5 ms costs nearly all of the margin, a coarse master the calm; 3 % more would be too much."""
    scene = nt.Scene()
    stiffness, plain = scene.plan().maximum_stiffness, nt.Session(scene)
    for rig, options in ((nt.Rig(), {"delay": 5e-3}), (nt.Rig(master={"resolution": 2e-4}), {})):
        session = nt.Session(scene, rig, **options)
        assert session.margins().least >= 3.0
        assert session.calm().is_calm
        more = session.settings.copy()
        more["gains.alpha_f"] = 1.03 * more.gains.alpha_f
        assert more.gains.alpha_f < plain.settings.gains.alpha_f
        judged = margins.compute(rig, more, stiffness)
        assert judged.least < 3.0 or not margins.calm(rig, more, stiffness).is_calm


@pytest.mark.parametrize("topography", [nt.surface.flat, nt.surface.grating, nt.surface.dots])
def test_built_in_surfaces_are_calm_without_a_warning(topography: Callable[[], nt.Topography]) -> None:
    """On dots the steepest hollow is stiffer than the flat, and blunter: neither costs the calm nor warns."""
    scene = nt.Scene()
    session = nt.Session(scene, surface=nt.Surface.touched_by(scene, topography()))
    assert session.calm().is_calm
    assert session.guarantee().warning is None
    assert session.settings.gains.alpha_f * session.plan.pull_off_force > 0.3


def test_touch_is_felt(tmp_path: Path, undrawn: None) -> None:
    """The pull-off of the default touch is at least 0.3 N at the hand, with a margin."""
    assert main(["touch", "--out", str(tmp_path / "out"), "--no-window"]) == 0
    recording = nt.record.read(tmp_path / "out" / "recording.mcap")
    assert -float(recording.parameter("alpha_f") * recording.tip_force.min()) > 0.3
    assert (recording.state == 0).all()


def test_a_file_that_scales_is_left_alone(tmp_path: Path, undrawn: None) -> None:
    file = tmp_path / "scene.toml"
    file.write_text("[gains]\nalpha_f_N_per_N = 2e6\n")
    assert main(["touch", "--scene", str(file), "--out", str(tmp_path / "out"), "--no-window", "--duration", "2s"]) == 0
    assert nt.record.read(tmp_path / "out" / "recording.mcap").parameter("alpha_f") == 2e6
