# SPDX-License-Identifier: BSD-3-Clause
"""scene.plans: each place has the numbers of the plan that is made alone."""

from __future__ import annotations

from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue
from nanotouch.scene import plans

pytest.importorskip("xarray")
RADII, HUMIDITIES = [10e-9, 30e-9, 100e-9], [0.0, 0.5]


def test_every_place_is_the_plan_made_alone() -> None:
    scene, demand = nt.Scene(), nt.Demand(demand={"relative_accuracy": 0.003})
    found = scene.plans({"tip.radius": RADII, "medium.relative_humidity": HUMIDITIES}, demand)
    assert found.sizes == {"tip.radius": 3, "medium.relative_humidity": 2}
    assert found["tip.radius"].attrs["units"] == "m"
    for radius in RADII:
        for humidity in HUMIDITIES:
            alone = scene.copy()
            alone["tip.radius"], alone["medium.relative_humidity"] = radius, humidity
            plan = alone.plan(demand)
            here = found.sel({"tip.radius": radius, "medium.relative_humidity": humidity})
            assert {name: float(here[name]) for name in plans.RESULTS} == {
                name: getattr(plan, name) for name in plans.RESULTS
            }
            assert here["contact_law"].item() == plan.contact_law
            assert here["refused"].item() == ""
    assert scene == nt.Scene()


def test_what_has_no_plan_is_nan_with_its_reason() -> None:
    found = nt.Scene().plans({"tip.radius": [20e-9, -1.0]})
    assert np.isfinite(found["pull_off_force"][0])
    assert np.isnan(found["pull_off_force"][1])
    assert "tip.radius" in found["refused"].item(1)


def test_choices_are_named() -> None:
    scene = nt.Scene()
    name = next(name for name, field in scene.fields.items() if field.choices)
    values = list(scene.fields[name].choices)[:2]
    assert list(scene.plans({name: values})[name].values) == values


@pytest.mark.parametrize(
    ("over", "words"),
    [({"tip.size": [1.0]}, "no field"), ({"tip.radius": 1e-8}, "sequence"), ({"tip.radius": []}, "sequence")],
)
def test_what_is_no_study_is_refused(over: Any, words: str) -> None:
    with pytest.raises(InvalidValue, match=words):
        nt.Scene().plans(over)


def test_a_demand_that_is_none_is_refused_by_name() -> None:
    with pytest.raises(InvalidValue, match=r"demand: expected a nanotouch\.Demand, not 0\.01"):
        nt.Scene().plans({"tip.radius": [1e-8]}, 0.01)  # type: ignore[arg-type]


def test_units_are_refused_not_stripped() -> None:
    """10 with the unit nm was taken for 10 m."""
    radii = pytest.importorskip("xarray").DataArray([10.0, 20.0], attrs={"units": "nm"})
    with pytest.raises(TypeError, match="carries a unit"):
        nt.Scene().plans({"tip.radius": radii})


def test_what_is_no_mapping_is_named() -> None:
    with pytest.raises(InvalidValue, match="expected a mapping"):
        nt.Scene().plans([("tip.radius", [1e-8])])  # type: ignore[arg-type]
