# SPDX-License-Identifier: BSD-3-Clause
"""The particles of a recording, beside where the session said that they were; and as they are played."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue
from nanotouch.manipulation import Particles, Recorded, latex
from nanotouch.touch.operator import Hold

R, LOW = 500e-9, 0.3e-6
WAY = ((0.6e-6, 0.0, 0.0), (1.4e-6, 0.1e-6, 0.0), (0.1e-6, -0.2e-6, 0.0), (0.9e-6, 0.4e-6, -0.1e-6))
THINNED = 2e-9  # points of the way are 1 nm apart, and a ball goes no farther than the tip between two [m]


def session(side: float) -> nt.Session:
    scene = nt.Scene(
        tip={"radius": 50e-9, "half_angle": 0.26}, sample={"youngs_modulus": 70e9, "poisson_ratio": 0.22},
        medium={"relative_humidity": 0.0}, adhesion={"work_of_adhesion": 0.01, "hamaker_constant": 3e-20},
        range={"maximum_load": 100e-9},
    )  # fmt: skip
    rig = nt.Rig(probe={"spring_constant": 10.0, "lateral_stiffness": side}, master={"axes": 3.0})
    balls = Particles(latex(R, 50e-9))
    return nt.Session(scene, rig, clearance=LOW, particles=balls, minimum_margin=0.0, path=[(0.0, 0.0)],
                      gains={"alpha_p": 3e-4}, seed=1)  # fmt: skip


def pushed(side: float) -> tuple[nt.Recording, list[tuple[int, np.ndarray]]]:
    """A recording, and where all of them were after some of its rows."""
    of = session(side)
    of.lay(0, (0.8e-6, 0.0))
    of.lay(1, (1.9e-6, 0.1e-6))
    scale, start = of.settings.gains.alpha_p, of.core.master_start
    blocks, truth, rows = [], [], 0
    for x, y, z in WAY:
        held = Hold((x / scale, y / scale, start - z / scale), math.nan, math.nan, 0.4)
        blocks.append(of.advance(0.5, held))
        rows += len(blocks[-1]["time"])
        truth.append((rows - 1, of.particles.positions.copy()))
        if len(blocks) == 3:
            of.lay(2, (0.5e-6, -1.5e-6))
    columns = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    return nt.Recording(columns, of.metadata()), truth


@pytest.mark.parametrize("side", [0.0, 40.0])
def test_they_go_where_they_went(side: float) -> None:
    recording, truth = pushed(side)
    found = Recorded(recording)
    assert found.at(0).shape == (2, 3)
    for row, places in truth:
        np.testing.assert_allclose(found.at(row), places, atol=THINNED)
    assert truth[-1][1][0, 0] - 0.8e-6 > 0.5e-6  # it was pushed
    assert found.at(truth[2][0] + 1).shape == (3, 3)
    back = found.at(truth[0][0])  # a look back computes nothing
    np.testing.assert_allclose(back, truth[0][1], atol=THINNED)


def test_they_survive_a_file(tmp_path: Path) -> None:
    recording, truth = pushed(0.0)
    nt.record.write(tmp_path / "push.mcap", recording)
    read = nt.record.read(tmp_path / "push.mcap")
    np.testing.assert_array_equal(Recorded(read).at(truth[-1][0]), Recorded(recording).at(truth[-1][0]))


def test_a_recording_without_them_says_so() -> None:
    recording = nt.Session(seed=1).run()
    with pytest.raises(InvalidValue, match="holds no particles: it lacks what they are"):
        Recorded(recording)
    whole, _ = pushed(0.0)
    with pytest.raises(InvalidValue, match=r"row 20000: valid is 0 \.\. 19999"):
        Recorded(whole).at(20000)
    bare = nt.Recording({"time": whole.time}, whole.metadata)
    with pytest.raises(InvalidValue, match="it lacks x, y, gap, surface_height"):
        Recorded(bare)
    torn = nt.Recording(whole.columns, whole.metadata | {"particles": {"particle": {}}})
    with pytest.raises(InvalidValue, match="metadata cannot be read"):
        Recorded(torn)


def test_they_are_played() -> None:
    pytest.importorskip("nanotouch_app")
    from nanotouch_app.live import reel

    recording, truth = pushed(0.0)
    played = reel.Reel(recording)
    played.answer({"do": "pause"})
    for row, places in (truth[1], truth[0], truth[2]):  # to and fro on the time line
        played.jump(float(recording.time[row] - recording.time[0]))
        played.read()
        (told,) = (message for message in played.told() if message["tell"] == "particles")
        assert told["radius"] == R
        np.testing.assert_allclose(told["places"], places, atol=THINNED)
    met, corner = reel.surface_of(recording)
    for x, y in ((0.8e-6, 0.0), (1.9e-6, 0.1e-6), (0.5e-6, -1.5e-6)):  # the ground reaches under all of them
        assert corner[0] < x - R
        assert x + R < corner[0] + met.size[0]
        assert corner[1] < y - R
        assert y + R < corner[1] + met.size[1]
    without = nt.Recording(recording.columns, {k: v for k, v in recording.metadata.items() if k != "particles"})
    assert [message["tell"] for message in reel.Reel(without).told()] == ["clock"]


def test_dents_are_played(tmp_path: Path) -> None:
    pytest.importorskip("nanotouch_app")
    from nanotouch_app.live import reel
    from nanotouch_app.live.host import Host
    from nanotouch_app.live.subject import of_preset

    told: list[dict[str, Any]] = []
    host = Host(of_preset("soft_gold"), told.append, out=str(tmp_path / "dent.mcap"), stepped=True)
    host.answer({"do": "press", "on": True})
    host.advance(1.5)
    host.answer({"do": "press", "on": False})
    host.advance(1.0)
    host.close()
    dents = [message for message in told if message["tell"] == "dents" and message["dents"]][-1]  # it has grown
    played = reel.Reel(nt.record.read(tmp_path / "dent.mcap"))
    played.answer({"do": "pause"})
    played.jump(0.0)
    assert [message["tell"] for message in played.told()] == ["clock"]
    played.jump(played.length)
    assert played.told()[-1] == dents
    assert [message["tell"] for message in played.told()] == ["clock"]  # told once
    played.jump(0.0)
    assert played.told()[-1] == {"tell": "dents", "dents": []}
