# SPDX-License-Identifier: BSD-3-Clause
"""A rod in a session: what a hand of three axes feels of it, its recording, and what is refused."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import Error, InvalidValue
from nanotouch.manipulation import Recorded, Rod, latex, turning_point
from nanotouch.touch.operator import Hold

L, R, LOW = 2e-6, 100e-9, 60e-9
WIRE = Rod(L, R, 50e9, 11e9, 0.075, 1.05e6, tip_radius=20e-9, tip_half_angle=0.26)
TIP: dict[str, Any] = {"radius": 20e-9, "half_angle": 0.26}
SCENE = nt.Scene(tip=TIP, medium={"relative_humidity": 0.0}, range={"maximum_load": 100e-9})
THINNED = 2e-9  # points of the way are 1 nm apart [m]


def session(side: float = 100.0, **options: Any) -> nt.Session:
    rig = nt.Rig(probe={"spring_constant": 10.0, "lateral_stiffness": side}, master={"axes": 3.0})
    return nt.Session(SCENE, rig, clearance=LOW, minimum_margin=0.0, path=[(0.0, 0.0)], seed=1,
                      gains={"alpha_p": 1e-4}, **{"rod": WIRE, **options})  # fmt: skip


def hold(of: nt.Session, x: float, y: float, duration: float) -> Hold:
    scale = of.settings.gains.alpha_p
    return Hold((x / scale, y / scale, of.core.master_start), math.nan, math.nan, duration)


def test_a_hand_of_three_axes_feels_the_push_the_turn_and_the_loss() -> None:
    """Pushed across at an arm d: 2 q c, and alpha_f times that at the hand; once the tip is past the end, nothing."""
    of = session()
    arm = 0.7e-6
    of.lay_rod((-arm, 0.4e-6, 0.0))
    pushed = of.advance(1.5, hold(of, 0.0, 0.4e-6, 1.4))
    laid, alpha_f = of.particles, of.settings.gains.alpha_f
    assert laid.touches == [1]
    assert laid.angles[0] > 0.05
    c = turning_point(L, arm)
    there = float(np.mean(pushed["tip_force_y"][-500:]))
    assert -there == pytest.approx(2.0 * WIRE.friction * c, rel=0.05)  # it has turned by then, and is pushed elsewhere
    felt = float(np.mean(pushed["motor_force_y"][-500:]))
    assert felt == pytest.approx(alpha_f * there, rel=0.05)
    up = pushed["tip_force"][-1]
    assert up == pytest.approx(math.tan(0.26) * np.hypot(there, pushed["tip_force_x"][-1]), rel=0.02)
    on = of.advance(2.0, hold(of, 0.6e-6, 0.9e-6, 1.8))  # past its end
    assert of.particles.losses == [1]
    assert abs(on["motor_force_y"][-1]) < 1e-3 * abs(felt)
    kinds = [name for _, name, _ in of.metadata()["events"]]
    assert (kinds.count("lay_rod"), kinds.count("pushed"), kinds.count("turned")) == (1, 1, 1)
    assert np.isfinite(on["tip_force"]).all()
    largest = np.hypot(pushed["tip_force_x"], pushed["tip_force_y"]).max()
    assert largest < of.guarantee().lateral_force


def pushed_about(side: float) -> tuple[nt.Recording, list[tuple[int, np.ndarray, float]]]:
    """A recording, and where the rod was after some of its rows."""
    of = session(side)
    of.lay_rod((-0.5e-6, 0.3e-6, 0.1))
    blocks, truth, rows = [], [], 0
    for x, y in ((0.0, 0.4e-6), (0.2e-6, 0.1e-6), (-0.9e-6, 0.05e-6), (-0.9e-6, 0.5e-6)):
        blocks.append(of.advance(0.8, hold(of, x, y, 0.7)))
        rows += len(blocks[-1]["time"])
        truth.append((rows - 1, of.particles.positions.copy(), float(of.particles.angles[0])))
    columns = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    return nt.Recording(columns, of.metadata()), truth


@pytest.mark.parametrize("side", [0.0, 40.0])
def test_its_recording_leads_it_again(side: float, tmp_path: Path) -> None:
    recording, truth = pushed_about(side)
    nt.record.write(tmp_path / "rod.mcap", recording)
    for one in (recording, nt.record.read(tmp_path / "rod.mcap")):
        found = Recorded(one)
        assert (found.radius, found.length) == (R, L)
        assert found.laid == [(0, 0, (-0.5e-6, 0.3e-6, 0.1))]
        for row, places, angle in truth:
            np.testing.assert_allclose(found.at(row), places, atol=THINNED)
            assert found.poses(row)[0, 3] == pytest.approx(angle, abs=2.0 * THINNED / (0.5 * L))
    assert abs(truth[-1][2] - 0.1) > 0.1  # it was turned
    replayed = recording.replay()
    np.testing.assert_array_equal(replayed.motor_force, recording.motor_force)


def test_it_is_played() -> None:
    pytest.importorskip("nanotouch_app")
    from nanotouch_app.live import reel

    recording, truth = pushed_about(0.0)
    played = reel.Reel(recording)
    played.answer({"do": "pause"})
    for row, places, angle in (truth[1], truth[0], truth[3]):  # to and fro on the time line
        played.jump(float(recording.time[row] - recording.time[0]))
        played.read()
        (told,) = (message for message in played.told() if message["tell"] == "particles")
        assert (told["radius"], told["length"]) == (R, L)
        np.testing.assert_allclose(told["places"], places, atol=THINNED)
        assert told["angles"] == [pytest.approx(angle, abs=5e-3)]
    met, corner = reel.surface_of(recording)
    assert corner[0] < -0.5e-6 - 0.5 * L
    assert corner[0] + met.size[0] > -0.5e-6 + 0.5 * L


def test_it_goes_back_by_the_same_bits() -> None:
    of = session(40.0)
    of.lay_rod((-0.5e-6, 0.3e-6, 0.1))
    of.advance(0.4, hold(of, 0.0, 0.25e-6, 0.35))
    kept = of.snapshot()
    once = of.advance(0.5, hold(of, 0.1e-6, 0.5e-6, 0.45))
    where = of.particles
    of.restore(kept)
    again = of.advance(0.5, hold(of, 0.1e-6, 0.5e-6, 0.45))
    assert where.touches == [1]
    for name in once:
        np.testing.assert_array_equal(once[name], again[name])
    np.testing.assert_array_equal(where.positions, of.particles.positions)
    assert (where.angles[0], where.dissipated) == (of.particles.angles[0], of.particles.dissipated)
    other = session(40.0, rod=Rod(L, R, 50e9, 11e9, 0.075, 1.06e6, tip_radius=20e-9, tip_half_angle=0.26))
    with pytest.raises(Error, match="rod"):
        other.restore(kept)


def test_what_cannot_be_is_refused() -> None:
    with pytest.raises(TypeError, match=r"valid is a nt\.manipulation\.Rod"):
        session(rod=WIRE.length)
    with pytest.raises(Error, match="rod beside particles"):
        session(particles=nt.Particles(latex(500e-9, 20e-9, 0.26)))
    with pytest.raises(Error, match=r"rod\.tip_radius \(that of the scene\)"):
        session(rod=Rod(L, R, 50e9, 11e9, 0.075, 1e6, tip_radius=30e-9, tip_half_angle=0.26))
    with pytest.raises(Error, match="does not go through it under the force limit"):
        session(rod=Rod(L, R, 50e9, 11e9, 0.075, 1e6, tip_radius=20e-9, tip_half_angle=0.26, tip_stiffness=8.0))
    of = session()
    with pytest.raises(Error, match="the tip touches it, where it is or where it shall lie"):
        of.lay_rod((0.5e-6, 0.0, 0.0))
    with pytest.raises(InvalidValue, match="NaN"):
        of.lay_rod((math.nan, 0.0, 0.0))
    with pytest.raises(Error, match="without particles"):
        of.lay(0, (0.5e-6, 0.5e-6))
    with pytest.raises(Error, match="without a rod"):
        session(rod=None).lay_rod((0.0, 1e-6, 0.0))
    with pytest.raises(Error, match="without particles and without a rod"):
        _ = session(rod=None).particles
    with pytest.raises(Error, match="holds no particles"):
        Recorded(nt.Session(seed=1).run())
