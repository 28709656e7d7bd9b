# SPDX-License-Identifier: BSD-3-Clause
"""Spring constant and sensitivity: the algebra of a correction, tables for many files, placeholders."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import synthetic
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("afmformats")

from nanotouch import curves
from nanotouch.curves import calibration as rules
from nanotouch.errors import InvalidValue, ReadError

KNOWN = synthetic.known_curve(n=100)


def curve(k: float | None, s: float | None) -> curves.ForceCurve:
    volts = np.linspace(-1.0, 2.0, 50)
    z = np.linspace(1e-6, 0.0, 50)
    force = volts * (s or 1e-8) * (k or 1.0)
    meta = {key: value for key, value in (("spring constant", k), ("sensitivity", s)) if value is not None}
    return curves.ForceCurve((curves.Segment("approach", z, z, "height (measured)", force),), meta, "a.ibw")


positive = {"k": st.floats(1e-3, 1e3), "s": st.floats(1e-9, 9e-5)}


@settings(max_examples=60, deadline=None)
@given(
    k=positive["k"],
    s=positive["s"],
    new_k=st.none() | st.floats(1e-3, 1e3),
    new_s=st.none() | st.floats(1e-9, 9e-5),
)
def test_force_and_deflection_follow_from_the_volts(
    k: float, s: float, new_k: float | None, new_s: float | None
) -> None:
    """deflection = s u, force = k s u, whichever of the two was corrected; z is that of the base and stays."""
    before = curve(k, s)
    after = rules.calibrated(before, curves.Calibration(new_k, new_s), Path("a.ibw"))
    volts = np.linspace(-1.0, 2.0, 50)
    k, s = new_k or k, new_s or s
    (segment,) = after.segments
    # three products and quotients: a few roundings
    np.testing.assert_allclose(segment.deflection, s * volts, rtol=1e-14)  # type: ignore[arg-type]
    np.testing.assert_allclose(segment.force, k * s * volts, rtol=1e-14)  # type: ignore[arg-type]
    np.testing.assert_array_equal(segment.z, before.segments[0].z)
    assert (after.meta["spring constant"], after.meta["sensitivity"]) == (k, s)
    again = rules.calibrated(after, curves.Calibration(new_k, new_s), Path("a.ibw"))  # the second time changes nothing
    np.testing.assert_allclose(again.segments[0].force, segment.force, rtol=1e-15)  # type: ignore[arg-type]


def test_contact_slope_is_one_with_the_right_sensitivity(tmp_path: Path) -> None:
    """On a stiff sample the tip stays where the sample is: z + deflection is constant in contact only if s is right."""
    path = synthetic.write_ibw_curve(tmp_path / "curve.ibw", KNOWN)  # states 50 nm/V, which is right
    (right,), (wrong,) = curves.read(path), curves.read(path, sensitivity=60e-9)
    for found, slope in ((right, -1.0), (wrong, -1.2)):
        segment = found.approach
        assert segment is not None
        assert segment.deflection is not None
        touching = segment.z < KNOWN.contact_point - 5e-9
        fitted = np.polyfit(segment.z[touching], segment.deflection[touching], 1)[0]
        # tilt of 0.25 nm per um of deflection, noise of 10 pN over 20 nm
        assert fitted == pytest.approx(slope, abs=5e-3)


def test_a_table_corrects_many_files(tmp_path: Path) -> None:
    table_file = tmp_path / "table.csv"
    table_file.write_text(
        "# measured on Monday\nfile, spring_constant, sensitivity\nday1/*.ibw, 0.4 N/m,\n*.ibw,1.6N/m, 25nm/V\n",
        "utf-8",
    )
    table = curves.CalibrationTable.from_csv(table_file)
    (tmp_path / "day1").mkdir()
    first = synthetic.write_ibw_curve(tmp_path / "day1" / "a.ibw", KNOWN)
    second = synthetic.write_ibw_curve(tmp_path / "b.ibw", KNOWN)
    (plain,) = curves.read(second)
    for path, k, s in ((first, 0.4, 50e-9), (second, 1.6, 25e-9)):
        for given_table in (table, table_file):
            (found,) = curves.read(path, calibration=given_table)
            assert found.retract is not None
            assert plain.retract is not None
            assert (found.meta["spring constant"], found.meta["sensitivity"]) == (k, s)
            np.testing.assert_allclose(found.retract.force, plain.retract.force * (k / 0.8) * (s / 50e-9), rtol=1e-12)  # type: ignore[operator,arg-type]
    (direct,) = curves.read(second, spring_constant=2.0, calibration=table)  # what is given directly counts more
    assert (direct.meta["spring constant"], direct.meta["sensitivity"]) == (2.0, 25e-9)
    assert table.of("c.jpk-force") == curves.Calibration()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("file,spring\na,1N/m\n", "columns file, spring; expected"),
        ("", "the file is empty"),
        ("file,spring_constant\n,1N/m\n", "row 1 has no file pattern"),
        ("file,spring_constant\na,1N/m,3,4\n", "more fields than columns"),
        ("file,spring_constant\na,1\n", "row 1: '1' has no unit"),
        ("file,sensitivity\na,1N/m\n", "row 1: '1N/m' has the unit 'N/m'"),
        ("file,sensitivity\na,40nm/V\nb,400000m/V\n", "row 2: sensitivity: 400000.0 m/V, expected"),
    ],
)
def test_a_table_with_a_mistake_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "table.csv"
    path.write_text(text)
    with pytest.raises(ReadError, match=message):
        curves.CalibrationTable.from_csv(path)


@pytest.mark.parametrize(
    ("k", "s", "left"),
    [
        (1.0, 4e-8, ("spring constant",)),
        (0.999, 4e-8, ("spring constant",)),
        (0.5, 1e-7, ("sensitivity",)),
        (1.0, 1.0, ("spring constant", "sensitivity")),
        (0.5, 4e-8, ()),
    ],
)
def test_placeholders_are_named_until_they_are_replaced(k: float, s: float, left: tuple[str, ...]) -> None:
    file = Path("a.ibw")
    assert rules.calibrated(curve(k, s), curves.Calibration(), file).meta.get("placeholders", ()) == left
    full = rules.calibrated(curve(k, s), curves.Calibration(0.3, 3e-8), file)
    assert "placeholders" not in full.meta


def test_a_placeholder_that_makes_the_forces_absurd_is_what_the_refusal_names(tmp_path: Path) -> None:
    segments = [("extend", KNOWN.approach_z, KNOWN.approach_force), ("retract", KNOWN.retract_z, KNOWN.retract_force)]
    path = synthetic.write_jpk(tmp_path / "raw.jpk-force", segments, spring_constant=1.0, sensitivity=1.0)
    scaled = [(role, z, 1e8 * force) for role, z, force in segments]
    absurd = synthetic.write_jpk(tmp_path / "volts.jpk-force", scaled, spring_constant=1.0, sensitivity=1.0)
    (small,) = curves.read(path)
    assert small.meta["placeholders"] == ("spring constant", "sensitivity")
    with pytest.raises(ReadError, match="its spring constant and sensitivity is a placeholder, give it"):
        curves.read(absurd)


@pytest.mark.parametrize(("k", "s", "what"), [(1e-6, 4e-8, "spring constant"), (0.5, 1e-12, "sensitivity")])
def test_an_implausible_calibration_is_refused(k: float, s: float, what: str) -> None:
    with pytest.raises(ReadError, match=rf"{what} .* expected .* give it"):
        rules.calibrated(curve(k, s), curves.Calibration(), Path("a.ibw"))


def test_what_cannot_be_corrected_says_so() -> None:
    with pytest.raises(ReadError, match="states no sensitivity"):
        rules.calibrated(curve(0.5, None), curves.Calibration(sensitivity=3e-8), Path("a.ibw"))
    with pytest.raises(InvalidValue, match=r"spring_constant: 0\.0 N/m, expected"):
        curves.Calibration(spring_constant=0.0)
