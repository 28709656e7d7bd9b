# SPDX-License-Identifier: BSD-3-Clause
"""A fitted curve becomes the scene, a fitted map the surface: what is touched is what was measured."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue
from synthetic import DATA

pytest.importorskip("nanotouch._fit", reason="built without Ceres")

from nanotouch import maps

CONTACTS: dict[str, tuple[nt.Contact, float]] = {
    "hertz": (nt.Contact(50e-9, 1e6, 0.0), 0.05),
    "dmt": (nt.Contact(20e-9, 60e9, 0.002), 1.0),
    "jkr": (nt.Contact(20e-9, 2e6, 0.05), 0.5),
    "maugis": (nt.Contact(20e-9, 1e9, 0.05, cohesive_range=0.3e-9), 1.0),
    "cone": (nt.Contact(20e-9, 2e5, 0.0), 0.05),
    "pyramid": (nt.Contact(20e-9, 2e5, 0.0), 0.05),
}


@pytest.mark.parametrize("model", CONTACTS)
def test_a_fitted_curve_is_felt_as_it_was_fitted(model: str) -> None:
    """The scene's exact law at the fitted indentations, over max(|force|, pull-off)."""
    contact, spring = CONTACTS[model]
    given: dict[str, Any] = {"half_angle": 0.35} if model in ("cone", "pyramid") else {}
    curve = nt.curves.synthesize(contact, model, spring_constant=spring, depth=20e-9, **given)
    given |= {"cohesive_range": 0.3e-9} if model == "maugis" else {}
    result = nt.fit.fit_curve(curve, model, radius=contact.radius, **given)
    scene = result.to_scene()
    law = scene.plan(bound="exact")
    there = result.indentation > 0.9 * result.indentation.min()  # JKR's fold is not that of a finite range
    found = law.force(-result.indentation[there], "retract")
    scale = max(law.pull_off_force, 0.01 * result.force.max())
    off = np.abs(found - result.fitted[there]) / np.maximum(np.abs(result.fitted[there]), scale)
    assert off.max() < (0.06 if model == "dmt" else 0.005)
    assert scene.range.maximum_load >= result.force.max()
    if contact.work_of_adhesion > 0.0:
        assert law.pull_off_force == pytest.approx(result.pull_off_force, rel=0.02)
    nt.Session(scene, minimum_margin=0.0)


def test_a_measured_curve_is_touched() -> None:
    file = DATA / "curves" / "fmt-igor-fd_SiN_FD_plot.ibw"
    if not file.exists():
        pytest.skip("no real data here")
    result = nt.fit.fit_curve(nt.curves.read(file)[0], "maugis", radius=20e-9, fixed={"effective_modulus": 50e9})
    plan = result.to_scene().plan()
    assert plan.pull_off_force == pytest.approx(result.pull_off_force, rel=0.02)
    assert plan.pull_off_force > result.measured_pull_off_force > 12e-9


def test_what_is_not_determined_is_no_scene() -> None:
    contact, spring = CONTACTS["maugis"]
    result = nt.fit.fit_curve(nt.curves.synthesize(contact, spring_constant=spring, depth=20e-9), radius=20e-9)
    unknown = dataclasses.replace(result, identifiable={**result.identifiable, "effective_modulus": False})
    with pytest.raises(InvalidValue, match="does not determine effective_modulus: no scene"):
        unknown.to_scene()
    with pytest.raises(InvalidValue, match="none of contact alone"):
        dataclasses.replace(result, model="mine").to_scene()
    hard = dataclasses.replace(result, values={**result.values, "effective_modulus": 1e12})
    with pytest.raises(InvalidValue, match=r"with this tip it stays below 1.53846e\+11 Pa"):
        hard.to_scene()


SOFT, HARD, WEAK, STRONG = 2e8, 1e9, 0.015, 0.04  # Pa, J/m2


def volume(n: int = 12) -> maps.ArrayVolume:
    """Soft on the left, hard on the right; sticky in the upper half; a slope."""
    y, x = np.mgrid[:n, :n] / n
    modulus, work = np.where(x < 0.5, SOFT, HARD), np.where(y < 0.5, WEAK, STRONG)
    return maps.synthesize(
        modulus, work, 3e-9 * x, radius=20e-9, spring_constant=1.0, noise=10e-12, depth=20e-9, points=400
    )


def fitted(source: maps.ArrayVolume) -> Any:
    pytest.importorskip("xarray")
    return maps.fit(source, radius=20e-9, cohesive_range=0.2e-9)


def test_a_fitted_map_is_touched_with_the_modulus_and_adhesion_of_each_place() -> None:
    data = fitted(volume())
    scene = maps.to_scene(data)
    surface = maps.to_surface(data, scene)
    assert surface.size == pytest.approx((600e-9, 600e-9))
    one, tip = 1.0 - scene.sample.poisson_ratio**2, (1.0 - scene.tip.poisson_ratio**2) / scene.tip.youngs_modulus
    for x, y, modulus, work in ((100e-9, 100e-9, SOFT, WEAK), (450e-9, 450e-9, HARD, STRONG)):
        made = surface.properties(x, y)
        assert 1.0 / (tip + one / made.youngs_modulus) == pytest.approx(modulus, rel=0.05)
        assert made.work_of_adhesion == pytest.approx(work, rel=0.05)
    slope = (surface.height(450e-9, 300e-9) - surface.height(100e-9, 300e-9)) / 350e-9
    assert slope == pytest.approx(3e-9 / 600e-9, rel=0.1)
    plan = scene.plan(surface=surface)
    assert plan.explain()["properties"]["work_of_adhesion"] == pytest.approx((WEAK, STRONG), rel=0.25)
    session = nt.Session(scene, surface=surface, path=[(100e-9, 100e-9)], minimum_margin=0.0)
    record = session.run(6.0)  # the soft map allows little force, so the hand comes down slowly
    assert (record.columns["gap"] < 0.0).any()


def test_cells_that_are_not_determined_are_refused_or_filled_as_stated() -> None:
    source = volume()
    source.values[2, 3] = np.nan  # no curve
    data = fitted(source)
    scene = maps.to_scene(data)
    with pytest.raises(InvalidValue, match="144 curves do not determine contact_point of 1, effective_modulus of 1"):
        maps.to_surface(data, scene)
    for fill_by in ("median", "neighbours"):
        if fill_by == "neighbours":
            pytest.importorskip("cv2")
        surface = maps.to_surface(data, scene, fill_by=fill_by)  # type: ignore[arg-type]
        assert surface.topography.mask.sum() == 1
        assert surface.topography.mask[2, 3]
    others = surface.work_of_adhesion[1:4, 2:5][[0, 0, 0, 1, 1, 2, 2, 2], [0, 1, 2, 0, 2, 0, 1, 2]]
    assert surface.work_of_adhesion[2, 3] == pytest.approx(math.exp(np.log(others).mean()))
    with pytest.raises(InvalidValue, match="fill_by 'zero': valid are neighbours, median"):
        maps.to_surface(data, scene, fill_by="zero")  # type: ignore[arg-type]


def test_a_map_without_places_asks_for_its_pixels() -> None:
    data = fitted(volume())
    data = data.assign_coords(x=np.arange(12), y=np.arange(12))
    scene = maps.to_scene(data)
    with pytest.raises(InvalidValue, match="give pixel_size"):
        maps.to_surface(data, scene)
    assert maps.to_surface(data, scene, pixel_size=50e-9, dilate=True).tip_radius == 20e-9


def test_a_measured_map_of_what_relaxes_is_refused_in_words() -> None:
    """Cells: no elastic law describes them, and a scene has no time."""
    file = DATA / "curves" / "map-data-2022.10.29-12.27.34.564.jpk-force-map"
    if not file.exists():
        pytest.skip("no real data here")
    pytest.importorskip("xarray")
    with pytest.raises(InvalidValue, match="no curve of this map determines it"):
        maps.to_scene(maps.fit(file, model="cone", half_angle=0.35))
    with pytest.raises(InvalidValue, match="a scene is elastic"):
        maps.to_scene(maps.fit(file, model="ting_power_cone", half_angle=0.35))
