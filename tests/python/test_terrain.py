# SPDX-License-Identifier: BSD-3-Clause
"""A terrain in Python: one plan and one bank, what of it can be reached, refusals."""

from __future__ import annotations

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import surface
from nanotouch.errors import InvalidValue
from nanotouch.scene import Demand
from nanotouch.scene.plan import Reach, make_terrain

SCENE = nt.Scene()
BODY = nt.Surface.touched_by(SCENE, surface.dots(pixels=64))
TERRAIN = make_terrain(SCENE, Demand(), None, surface=BODY)
PATH = [(30e-9, 100e-9), (400e-9, 350e-9), (450e-9, 20e-9)]


def test_the_tip_is_given_once() -> None:
    assert (BODY.tip_radius, BODY.tip_half_angle) == (SCENE.tip.radius, SCENE.tip.half_angle)
    sharp = nt.Scene(tip={"radius": 5e-9})
    with pytest.raises(InvalidValue, match=r"tip\.radius = 5e-09 m: valid is 2e-08"):
        make_terrain(sharp, Demand(), None, surface=BODY)


def test_reach_along_a_path_bounds_dense_samples() -> None:
    reach = Reach.along(TERRAIN, PATH)
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(PATH, axis=0).T))])
    distance = np.union1d(np.linspace(0.0, lengths[-1], 50_001), lengths)
    z = BODY.height(*(np.interp(distance, lengths, np.array(PATH)[:, axis]) for axis in (0, 1)))
    steepest = np.max(np.abs(np.diff(z) / np.diff(distance)))
    assert z.max() - z[0] <= reach.rise <= (z.max() - z[0]) * (1.0 + 1e-4)
    assert np.ptp(z) <= reach.relief <= np.ptp(z) * (1.0 + 1e-4)
    assert steepest * (1.0 - 1e-9) <= reach.slope <= steepest * 1.003


def test_reach_of_all_is_more_than_of_a_part() -> None:
    start, radii = (100e-9, 200e-9), BODY.radius_map.bounds
    every, part = Reach.within(TERRAIN, start), Reach.within(TERRAIN, start, (80e-9, 300e-9, 150e-9, 260e-9))
    along = Reach.along(TERRAIN, [start, (300e-9, 260e-9)])
    assert (every.least_radius, every.largest_radius) == pytest.approx(radii)
    for one, other in ((every, part), (part, along)):
        assert one.rise >= other.rise
        assert one.relief >= other.relief
        assert one.slope >= other.slope * (1.0 - 1e-3)
        assert one.least_radius <= other.least_radius <= other.largest_radius <= one.largest_radius


def test_a_flat_has_a_plan_and_no_relief() -> None:
    flat = make_terrain(SCENE, Demand(), None, surface=None)
    assert Reach.along(flat, PATH) == (0.0, 0.0, 0.0, SCENE.tip.radius, SCENE.tip.radius, 0.0, 0.0, 0.0, 0.0)
    assert flat.plan.as_dict()["bound"] == SCENE.plan().bound


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ([(0.0, 0.0), (1e-3, 0.0)], r"path\.x = 0\.001 m: valid is 0 \.\. 5e-07 m"),
        ([(0.0, float("nan"))], r"path\.y = nan m"),
        (np.empty((0, 2)), r"path\.count = 0"),
    ],
)
def test_a_path_elsewhere_is_refused(path: list[tuple[float, float]], words: str) -> None:
    with pytest.raises(InvalidValue, match=words):
        Reach.along(TERRAIN, path)


def test_an_area_elsewhere_is_refused() -> None:
    with pytest.raises(InvalidValue, match=r"area\.x_max = 0\.001 m"):
        Reach.within(TERRAIN, (0.0, 0.0), (0.0, 1e-3, 0.0, 1e-9))
