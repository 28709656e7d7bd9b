# SPDX-License-Identifier: BSD-3-Clause
"""The scale of a first touch: the sample's pull-off is clearly felt, within the margins."""

from __future__ import annotations

from pathlib import Path

import nanotouch as nt
import pytest
from nanotouch import margins
from nanotouch_app.main import main

PRESETS = ("silicon_in_air", "silicon_on_gold", "mica_in_air", "polyester", "silicone_rubber", "cell_in_liquid")


@pytest.mark.parametrize("name", PRESETS)
def test_every_preset_may_be_armed_at_it(name: str) -> None:
    """0.3 N at the hand, or as much as Eq. 19 gives from pull-off to largest load; never less than before."""
    scene, rig = getattr(nt.presets, name)()
    pull_off, load = scene.plan().pull_off_force, scene.range.maximum_load
    settings = nt.Settings.for_rig(rig)
    alpha_f = margins.felt_alpha_f(rig, settings, pull_off, load)
    assert alpha_f >= settings.gains.alpha_f
    felt = alpha_f * pull_off
    assert felt >= 0.3 or alpha_f * (pull_off + load) == pytest.approx(2.0 * rig.master.max_force)
    assert nt.Session(scene, rig, gains={"alpha_f": alpha_f}).margins().refusal is None


def test_without_adhesion_the_load_fills_the_hand() -> None:
    rig = nt.Rig()
    assert margins.felt_alpha_f(rig, nt.Settings.for_rig(rig), 0.0, 1e-7) == pytest.approx(10.0 / 1e-7)


def test_touch_is_felt(tmp_path: Path) -> None:
    """The pull-off of the default touch is at least 0.3 N at the hand, with a margin."""
    assert main(["touch", "--out", str(tmp_path / "out"), "--no-window"]) == 0
    recording = nt.record.read(tmp_path / "out" / "recording.mcap")
    assert -float(recording.parameter("alpha_f") * recording.tip_force.min()) > 0.3
    assert (recording.state == 0).all()


def test_a_file_that_scales_is_left_alone(tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text("[gains]\nalpha_f_N_per_N = 2e6\n")
    assert main(["touch", "--scene", str(file), "--out", str(tmp_path / "out"), "--no-window", "--duration", "2s"]) == 0
    assert nt.record.read(tmp_path / "out" / "recording.mcap").parameter("alpha_f") == 2e6
