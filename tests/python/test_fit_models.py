# SPDX-License-Identifier: BSD-3-Clause
"""nanotouch.fit: cones, pyramids and models of the user's own."""

from __future__ import annotations

import re
import runpy
import shutil
import subprocess
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue
from nanotouch.fit import Model, Parameter

pytest.importorskip("nanotouch._fit", reason="built without Ceres")

RADIUS, MODULUS, CONTACT, NOISE, ANGLE = 20e-9, 5e6, 3e-7, 20e-12, 0.4


def curve_of(model: Any, **changes: Any) -> Any:
    contact = nt.Contact(RADIUS, MODULUS, 0.0)
    given: dict[str, Any] = {"spring_constant": 0.5, "noise": NOISE, "offset": 1e-9, "tilt": 1e-4}
    return nt.curves.synthesize(contact, model, **({"seed": 0} | given | changes))


def hertz(indentation: Any, radius: float, effective_modulus: float) -> Any:
    return 4 / 3 * effective_modulus * np.sqrt(radius) * np.clip(indentation, 0.0, None) ** 1.5


MODULUS_OF_MINE = Parameter("effective_modulus", "Pa", 1.0, 1e14)
MINE = Model("my_hertz", hertz, (MODULUS_OF_MINE,), valid="as Hertz")


@pytest.mark.parametrize("model", ["cone", "pyramid"])
def test_sharp_tips(model: Any) -> None:
    result = nt.fit.fit_curve(curve_of(model, half_angle=ANGLE), model, half_angle=ANGLE, poisson_ratio=0.5)
    assert abs(result.values["effective_modulus"] - MODULUS) < 4 * result.sigma["effective_modulus"]
    assert abs(result.values["contact_point"] - CONTACT) < 4 * result.sigma["contact_point"]
    assert result.misfit == pytest.approx(1.0, abs=0.25)
    assert not any("radius" in text for text in result.assumptions)
    assumed = nt.fit.fit_curve(curve_of(model, half_angle=ANGLE), model)
    assert any("half angle 20 degrees" in text for text in assumed.assumptions)


def test_a_model_of_ones_own_equals_the_built_in() -> None:
    curve = curve_of("hertz")
    mine = nt.fit.fit_curve(curve, MINE, radius=RADIUS)
    built_in = nt.fit.fit_curve(curve, "hertz", radius=RADIUS)
    # numerical derivatives, and another start: a hundredth of a standard uncertainty
    for name in ("effective_modulus", "contact_point", "sensitivity"):
        assert abs(mine.values[name] - built_in.values[name]) < 0.01 * built_in.sigma[name], name
        assert mine.sigma[name] == pytest.approx(built_in.sigma[name], rel=0.01), name
    assert np.isnan(mine.contact_radius)
    assert "as Hertz" in str(mine)


def test_registered_models_are_found_by_name_and_listed() -> None:
    nt.fit.register(MINE)
    assert "my_hertz" in nt.fit.models()
    assert nt.fit.fit_curve(curve_of("hertz"), "my_hertz", radius=RADIUS).model == "my_hertz"
    with pytest.raises(InvalidValue, match=r"hertz, dmt, jkr, maugis, cone, pyramid.*my_hertz.*register"):
        nt.fit.fit_curve(curve_of("hertz"), "bjerrum")


def test_two_parameters_with_bounds_and_a_start() -> None:
    """F = A (delta/nm)^n on a Hertzian curve: n = 1.5, and a flat punch in disguise at its bound."""

    def power(indentation: Any, radius: float, prefactor: float, exponent: float) -> Any:
        return prefactor * (np.clip(indentation, 0.0, None) / 1e-9) ** exponent

    exponent = Parameter("exponent", "", 0.5, 4.0, initial=1.0)
    model = Model("power", power, (Parameter("prefactor", "N", 1e-14, 1e-6), exponent), valid="anything")
    result = nt.fit.fit_curve(curve_of("hertz"), model)
    assert result.identifiable == {"prefactor": True, "exponent": True, "contact_point": True}
    assert abs(result.values["exponent"] - 1.5) < 4 * result.sigma["exponent"] < 0.5
    assert result.units["prefactor"] == "N"
    held = nt.fit.fit_curve(curve_of("hertz"), model, fixed={"exponent": 1.5})
    assert held.sigma["prefactor"] < result.sigma["prefactor"]
    bound = nt.fit.fit_curve(curve_of("hertz"), model, bounds={"exponent": (1.8, 4.0)})
    assert bound.values["exponent"] == pytest.approx(1.8)
    assert not bound.identifiable["exponent"]


def test_an_exception_of_the_function_arrives() -> None:
    def broken(indentation: Any, radius: float, effective_modulus: float) -> Any:
        raise RuntimeError("what I did not think of")

    def short(indentation: Any, radius: float, effective_modulus: float) -> Any:
        return indentation[:-1]

    curve = curve_of("hertz")
    with pytest.raises(RuntimeError, match="did not think of"):
        nt.fit.fit_curve(curve, Model("broken", broken, (MODULUS_OF_MINE,), valid="never"))
    with pytest.raises(ValueError, match="one force for each"):
        nt.fit.fit_curve(curve, Model("short", short, (MODULUS_OF_MINE,), valid="never"))
    # and leaves nothing behind
    assert nt.fit.fit_curve(curve, MINE, radius=RADIUS).converged


@pytest.mark.parametrize(
    ("changes", "part"),
    [
        ({"name": "hertz"}, "of the library"),
        ({"name": "no identifier"}, "identifier"),
        ({"parameters": ()}, "1 .. 4"),
        ({"parameters": (MODULUS_OF_MINE,) * 2}, "different"),
        ({"parameters": (Parameter("E", "Pa", 2.0, 1.0),)}, "interval"),
        ({"valid": ""}, "valid"),
        ({"force": None}, "function"),
    ],
)
def test_incomplete_models_are_refused(changes: dict[str, Any], part: str) -> None:
    with pytest.raises(InvalidValue, match=part):
        nt.fit.register(
            Model(**({"name": "mine", "force": hertz, "parameters": (MODULUS_OF_MINE,), "valid": "?"} | changes))
        )


def punched(stiffness: float, seed: int) -> Any:
    """A punch of E* = MODULUS under a lever, in closed form: two springs in series from CONTACT on."""
    rng = np.random.default_rng(seed)
    contact = 2.0 * MODULUS * RADIUS
    above = np.linspace(2e-7, -1e-7, 1500)
    segments = []
    for role, z in (("approach", above), ("retract", above[::-1])):
        force = np.where(z < 0.0, -z * contact * stiffness / (contact + stiffness), 0.0)
        force = force + 3e-10 + 1e-4 * z + NOISE * rng.standard_normal(z.size)
        segments.append(nt.curves.Segment(role, np.full(z.size, np.nan), CONTACT + z, "height", force))  # type: ignore[arg-type]
    return nt.curves.ForceCurve(tuple(segments), {"spring constant": stiffness}, "punch")


@pytest.mark.parametrize("stiffness", [0.05, 0.2, 1.0])
def test_flat_punch(stiffness: float) -> None:
    for seed in range(5):
        result = nt.fit.fit_curve(punched(stiffness, seed), "punch", radius=RADIUS)
        for name, truth in (("effective_modulus", MODULUS), ("contact_point", CONTACT)):
            # 4 sigma: one of 16 000 errors of a right sigma is larger
            assert abs(result.values[name] - truth) < 4 * result.sigma[name], (name, seed)
        assert result.contact_radius == RADIUS
        assert result.contact_stiffness == pytest.approx(2.0 * result.values["effective_modulus"] * RADIUS, rel=1e-12)
    assert "flat punch" in str(result)
    assumed = nt.fit.fit_curve(punched(stiffness, 0), "punch")
    assert any("E* goes as 1/R)" in text for text in assumed.assumptions)
    assert result.to_scene(poisson_ratio=0.5).tip.shape == "punch"


ROOT = Path(__file__).resolve().parents[2]
MODELS = ROOT / "libnanotouch/fit/models"


@pytest.mark.skipif(not MODELS.is_dir() or shutil.which("cc") is None, reason="needs the sources and a C compiler")
def test_a_row_that_lacks_a_field_does_not_compile(tmp_path: Path) -> None:
    head, _, row = (MODELS / "punch.c").read_text(encoding="utf-8").partition("NT_FIT_ROW(punch,")
    fields = re.findall(r"\.[\w.]+ = (?:\"[^\"]*\"|[\w.-]+)", row)
    assert len(fields) == 20

    def compiles(with_fields: list[str]) -> bool:
        source = tmp_path / "punch.c"
        source.write_text(f"{head}NT_FIT_ROW(punch, {', '.join(with_fields)});\n", encoding="utf-8")
        library = ROOT / "libnanotouch"
        command = ["cc", "-std=c11", "-fsyntax-only", f"-I{library}", f"-I{library}/include", str(source)]
        return subprocess.run(command, capture_output=True, check=False).returncode == 0

    assert compiles(fields)
    for field in fields:
        assert not compiles([other for other in fields if other != field]), field


def test_the_page_is_made_from_the_rows() -> None:
    written = runpy.run_path(str(ROOT / "tools" / "models.py"))["page"]()
    page = (ROOT / "docs" / "fit_models.md").read_text(encoding="utf-8")
    assert page == written, "run .venv/bin/python tools/models.py > docs/fit_models.md"
