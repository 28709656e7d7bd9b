# SPDX-License-Identifier: BSD-3-Clause
"""nanotouch.fit: which model, how stable, and how a result shows itself."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue, MissingExtra

pytest.importorskip("nanotouch._fit", reason="built without Ceres")

RADIUS, MODULUS, WORK, RANGE = 20e-9, 5e6, 0.05, 2e-9


def curve_of(model: Any, seed: int = 1, **changes: Any) -> Any:
    contact = nt.Contact(RADIUS, MODULUS, 0.0 if model in ("hertz", "cone") else WORK, cohesive_range=RANGE)
    given: dict[str, Any] = {"spring_constant": 0.5, "noise": 20e-12, "offset": 1e-9, "tilt": 1e-4, "seed": seed}
    return nt.curves.synthesize(contact, model, **(given | changes))


def choose(model: Any, **options: Any) -> nt.fit.Choice:
    return nt.fit.choose_model(curve_of(model), radius=RADIUS, cohesive_range=RANGE, **options)


@pytest.mark.parametrize("model", ["dmt", "jkr"])
def test_evidence_finds_the_model(model: str) -> None:
    choice = choose(model)
    assert model in choice.by_evidence
    assert ("dmt" in choice.by_evidence) != ("jkr" in choice.by_evidence)
    assert "hertz" not in choice.by_evidence
    assert choice.candidates[0].chi_square == pytest.approx(choice.points, rel=0.25)
    assert sum(c.weight for c in choice.candidates) == pytest.approx(1.0)
    assert choice.best.model == choice.candidates[0].model


def test_without_adhesion_the_simplest_is_named_first() -> None:
    choice = choose("hertz")
    assert choice.by_evidence[0] == "hertz"
    assert choice.by_plan == "hertz"
    assert "by plan: hertz" in str(choice)


def test_the_plan_goes_by_lambda() -> None:
    """lambda = 7.1: JKR errs by 0.2 % of the force there (docs of the contact laws), DMT by more than half."""
    choice = choose("jkr")
    assert choice.transition_parameter == pytest.approx(7.1, abs=0.2)
    assert choice.by_plan == "jkr"
    assert choice.errors["jkr"] < 0.01 < choice.errors["dmt"]
    assert choose("jkr", relative_accuracy=1e-4).by_plan == "maugis"


def test_a_cone_beside_a_sphere() -> None:
    curve = curve_of("cone", half_angle=0.4)
    choice = nt.fit.choose_model(curve, ("hertz", "cone"), radius=RADIUS, half_angle=0.4, branch="approach")
    assert choice.by_evidence == ("cone",)
    assert choice.by_plan is None


def test_modulus_is_stable_where_the_model_is_right_and_not_where_it_is_wrong() -> None:
    right = nt.fit.stability(curve_of("hertz"), "hertz", radius=RADIUS, windows=8)
    # the first window that counts knows its modulus to 4 %, the others to better than 1 %
    assert right.spread < 0.04
    assert right.indentation.shape == right.modulus.shape == right.sigma.shape == (8,)
    assert right.modulus[-1] == pytest.approx(right.whole.values["effective_modulus"], rel=0.01)
    # Hertz on a cone, whose force falls faster: about its own contact point the shallow windows look stiffer
    wrong = nt.fit.stability(curve_of("cone", half_angle=0.4), "hertz", radius=RADIUS, windows=8)
    assert wrong.spread > 2 * right.spread
    with pytest.raises(InvalidValue, match="windows"):
        nt.fit.stability(curve_of("hertz"), windows=1)


def test_pictures_are_written(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    curve = curve_of("jkr")
    result = nt.fit.fit_curve(curve, "jkr", radius=RADIUS)
    nt.fit.draw(curve, result, save=tmp_path / "fit.png")
    nt.fit.stability(curve, "jkr", radius=RADIUS, windows=3).draw(save=tmp_path / "stability.png")
    assert all((tmp_path / name).stat().st_size > 10_000 for name in ("fit.png", "stability.png"))


def test_a_result_is_drawn_over_its_indentation() -> None:
    """Force over indentation beside force over position; without noise the points lie on the law."""
    pytest.importorskip("matplotlib")
    curve = curve_of("hertz", noise=0.0)
    result = nt.fit.fit_curve(curve, "hertz", radius=RADIUS)
    position, indentation, _ = result.plot().axes
    assert "base" in position.get_xlabel()
    points, law = indentation.get_lines()[:2]
    depth = np.asarray(points.get_xdata()) * 1e-9  # nm
    assert depth.max() == pytest.approx(result.indentation.max(), rel=1e-6)
    force = 4.0 / 3.0 * MODULUS * np.sqrt(RADIUS) * np.clip(depth, 0.0, None) ** 1.5
    np.testing.assert_allclose(np.asarray(points.get_ydata()) * 1e-9, force, atol=1e-3 * force.max())
    np.testing.assert_allclose(law.get_xdata(), points.get_xdata(), atol=1e-3 * depth.max() * 1e9)


def test_a_result_in_a_line_and_as_a_table(monkeypatch: pytest.MonkeyPatch) -> None:
    pandas = pytest.importorskip("pandas")
    result = nt.fit.fit_curve(curve_of("jkr"), "jkr", radius=RADIUS, poisson_ratio=0.3)
    said = repr(result)
    assert "\n" not in said
    assert len(said) < 250
    for part in ("jkr", result.status, f"youngs_modulus {result.show('youngs_modulus')}"):
        assert part in said
    table = result.to_pandas()
    assert isinstance(table, pandas.DataFrame)
    assert list(table.index) == list(result.values)
    row = table.loc["youngs_modulus"]
    assert (row["value"], row["unit"]) == (result.values["youngs_modulus"], "Pa")
    assert (row["low"], row["high"]) == result.interval["youngs_modulus"]
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(MissingExtra, match=r"pandas is not installed .*notebook"):
        result.to_pandas()


def test_window_in_indentation() -> None:
    curve = curve_of("hertz")
    part = nt.fit.fit_curve(curve, "hertz", radius=RADIUS, window=(5e-9, 20e-9), window_of="indentation")
    # the window is that of the first fit, whose contact point differs by its uncertainty
    assert part.indentation.min() == pytest.approx(5e-9, abs=0.5e-9)
    assert part.indentation.max() == pytest.approx(20e-9, abs=0.5e-9)
    assert abs(part.values["effective_modulus"] - MODULUS) < 4 * part.sigma["effective_modulus"]
    with pytest.raises(InvalidValue, match="points"):
        nt.fit.fit_curve(curve, "hertz", window=(1e-6, 2e-6), window_of="indentation")
    with pytest.raises(InvalidValue, match="window_of"):
        nt.fit.fit_curve(curve, "hertz", window=(0.0, 1.0), window_of="time")  # type: ignore[arg-type]


def test_html_says_what_is_not_determined() -> None:
    curve = curve_of("jkr")
    html = nt.fit.fit_curve(curve, "jkr", radius=RADIUS, poisson_ratio=0.3)._repr_html_()
    for part in ("E of the sample", "E*, of tip and sample together", "MPa", "calibration", "valid for"):
        assert part in html
    bound = nt.fit.fit_curve(curve, "jkr", radius=RADIUS, bounds={"effective_modulus": (1e6, 2e6)})
    assert "not determined" in bound._repr_html_()
    assert "#c0392b" in bound._repr_html_()


def test_the_same_result_in_any_order_and_after_a_bad_curve() -> None:
    """nanite#29: what was fitted before must not show."""
    curves = [curve_of(model, seed) for seed, model in enumerate(("jkr", "dmt", "hertz", "maugis"))]
    flat = curve_of("hertz", noise=1e-12, depth=1e-12)

    def all_of(order: list[int]) -> dict[int, dict[str, float]]:
        return {i: dict(nt.fit.fit_curve(curves[i], "maugis", radius=RADIUS).values) for i in order}

    first = all_of([0, 1, 2, 3])
    with pytest.raises(InvalidValue):
        nt.fit.fit_curve(flat, "maugis", window=(1.0, 2.0))
    again = all_of([3, 1, 0, 2])
    for i, values in first.items():
        np.testing.assert_array_equal(list(values.values()), list(again[i].values()))
