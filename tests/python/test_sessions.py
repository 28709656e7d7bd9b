# SPDX-License-Identifier: BSD-3-Clause
"""Sessions side by side: each records what it would record alone, whatever the number of threads."""

from __future__ import annotations

from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue
from nanotouch.touch.operator import Hold, Input

MODULI, NOISE = (2e6, 5e7, 7e10), (0.0, 0.05, 0.1)
VARY = {"sample.youngs_modulus": MODULI, "rig.probe.noise": NOISE}


def alone(i: int, seed: int, **given: Any) -> nt.Session:
    scene, rig = nt.Scene(), nt.Rig()
    scene["sample.youngs_modulus"], rig["probe.noise"] = MODULI[i], NOISE[i]
    return nt.Session(scene, rig, seed=seed, **given)


@pytest.fixture(scope="module")
def recorded() -> Any:
    return nt.Sessions(vary=VARY, seed=7, threads=1).run(0.12)


def test_threads_change_nothing(recorded: Any) -> None:
    two = nt.Sessions(vary=VARY, seed=7, threads=2).run(0.12)
    assert recorded.identical(two)
    assert dict(recorded.sizes) == {"session": 3, "time": len(recorded.time)}
    assert list(recorded["rig.probe.noise"].values) == list(NOISE)
    assert recorded["sample.youngs_modulus"].attrs["units"] == "Pa"
    assert list(recorded.seed.values) == [7, 8, 9]


@pytest.mark.parametrize("i", range(3))
def test_each_is_what_it_is_alone(recorded: Any, i: int) -> None:
    """Own scripts differ by some ticks, as presses and approaches of soft and stiff samples do."""
    one = alone(i, 7 + i).run(0.12)
    rows = len(one)
    assert rows <= recorded.sizes["time"]
    for name in recorded.data_vars:
        np.testing.assert_array_equal(recorded[name].values[i, :rows], one.columns[name], err_msg=str(name))


def test_noise_differs_and_is_the_seeds() -> None:
    """The same sample under three seeds: noise that has nothing in common, of the stated size."""
    many = nt.Sessions(count=3, seed=3)
    noise = many.advance(0.1)["deflection"]
    assert noise.shape == (3, 1000)
    assert np.abs(np.corrcoef(noise) - np.eye(3)).max() < 0.15  # 5 sigma of 1000 numbers
    stated = many[0].rig["probe.noise"] * many[0].rig["probe.sensitivity"]  # peak to peak: 6 sigma
    assert np.std(noise, axis=1) == pytest.approx(stated / 6, rel=0.15)


def test_inputs_of_each() -> None:
    """One for each, one for all, over a block's end; as alone."""
    many = nt.Sessions(vary=VARY, seed=2, threads=2)
    pushes = [Input(force, 0.0, 0.0, 0.01) for force in (0.1, 0.2, 0.3)]
    blocks = [many.advance(0.06, pushes), many.advance(0.001), many.advance(0.01, Hold(0.001, 0.0, 0.0, 0.005))]
    one = alone(2, 4)
    for block, given in zip(blocks, (pushes[2], None, Hold(0.001, 0.0, 0.0, 0.005)), strict=True):
        expected = one.advance(block["time"].shape[1] / one.rate, given)
        for name, values in expected.items():
            np.testing.assert_array_equal(block[name][2], values)
    assert many[2].metadata()["events"] == one.metadata()["events"]


def test_a_scan_over_one_surface() -> None:
    """What they share does not change: surface, radii."""
    heights = 5e-9 * np.sin(np.linspace(0, 12, 32))[None, :] * np.ones((32, 1))
    scene = nt.Scene()
    surface = nt.Surface.touched_by(scene, heights, pixel_size=20e-9)
    given: Any = {"surface": surface, "mode": "scan", "path": [(1e-7, 3e-7), (5e-7, 3e-7)]}
    many = nt.Sessions(scene, count=2, seed=5, threads=2, **given).run(0.1)
    one = nt.Session(scene, seed=6, **given).run(0.1)
    np.testing.assert_array_equal(many.tip_force.values[1, : len(one)], one.columns["tip_force"])


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, "give vary, or count"),
        ({"count": 0}, "count = 0: valid is a whole number from 1 on"),
        ({"count": 2, "threads": 0}, "threads = 0: valid is a whole number, 1 .. 1024"),
        ({"vary": {"sample.modulus": [1.0]}}, "'sample.modulus' is no field of a scene"),
        ({"vary": {"rig.tip.radius": [1.0]}}, "'rig.tip.radius' is no field"),
        ({"vary": {"tip.radius": 1e-8}}, "one value for each session"),
        ({"vary": {"tip.radius": [1e-8, 2e-8]}, "count": 3}, "disagree: tip.radius 2, count 3"),
        ({"vary": {"tip.radius": [1e-8, -2e-8]}}, "radius = -2e-08"),
        ({"count": 2, "recorded": False}, "recorded"),
        ({"count": 2, "seed": -1}, "seed"),
    ],
)
def test_what_is_refused(given: Any, words: str) -> None:
    with pytest.raises(InvalidValue, match=words.replace("(", r"\(")):
        nt.Sessions(**given)


def test_wrong_inputs_move_nothing() -> None:
    many = nt.Sessions(count=2, seed=1)
    with pytest.raises(InvalidValue, match="3 of them for 2 sessions"):
        many.advance(0.01, [Input(0.1, 0.0, 0.0, 0.0)] * 3)
    with pytest.raises(InvalidValue, match="session 1, operator input"):
        many.advance(0.01, [Input(0.1, 0.0, 0.0, 0.0), Input(0.1, 0.0, 0.0, -1.0)])
    with pytest.raises(InvalidValue, match="duration = -1 s"):
        many.advance(-1)
    assert many.advance(0.0001)["time"].tolist() == [[0.0], [0.0]]
    many[0].advance(0.001)  # on its own, and read
    many[1].core.advance(5)  # and not read
    with pytest.raises(nt.Error, match="session 1: it has been run on its own"):
        many.advance(0.01)


def test_a_unit_is_refused_not_stripped() -> None:
    """5 with the unit nm would be 5 m; a masked value would be taken as measured."""
    for radii in (
        np.ma.masked_array([1e-8, 2e-8], [0, 1]),
        pytest.importorskip("xarray").DataArray([10.0], attrs={"units": "nm"}),
    ):
        with pytest.raises(TypeError, match=r"tip\.radius"):
            nt.Sessions(vary={"tip.radius": radii})
