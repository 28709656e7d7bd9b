# SPDX-License-Identifier: BSD-3-Clause
"""Force curves as text: what JPK, NanoScope and Nova export, in every spelling of numbers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import synthetic
from nanotouch import curves, images
from nanotouch._io import text
from nanotouch.errors import InvalidValue, ReadError

K, SENSITIVITY = 0.05, 40e-9
KNOWN = synthetic.known_curve()
WAYS = [
    ("extend", KNOWN.approach_z, KNOWN.approach_force),
    ("pause", KNOWN.approach_z[-50:] * 0, KNOWN.approach_force[-50:]),
    ("retract", KNOWN.retract_z, KNOWN.retract_force),
]


def spelt(number: float, comma: bool = False) -> str:
    return f"{number:.9g}".replace(".", ",") if comma else f"{number:.9g}"


# --- JPK --------------------------------------------------------------------------------------------------------------


def jpk_text(
    path: Path, unit: str = "N", facts: bool = True, comma: bool = False, index: tuple[int, ...] = (0,)
) -> Path:
    factor = {"N": 1.0, "nN": 1e9, "m": 1.0 / K, "V": 1.0 / (K * SENSITIVITY)}[unit]
    lines = ["# TEXT EXPORT", "# data-description.instrument: Made", "# xPosition: 1E-6"]
    for number in index:
        for place, (style, z, force) in enumerate(WAYS):
            lines += [f"# index: {number}", "# force-settings.relative-setpoint: 0.5", f"# segmentIndex: {place}"]
            lines += [f"# segment: {style}", "# columns: smoothedHeight vDeflection height measuredHeight time"]
            lines += [f"# sensitivity: {SENSITIVITY}", f"# springConstant: {K}"] * facts
            lines += [f"# units: m {unit} m m s", "#"]
            rows = zip(z, force * factor, z + 1e-6, z, np.arange(z.size) / 1000.0, strict=True)
            lines += [" ".join(spelt(value, comma) for value in row) for row in rows]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("unit", ["N", "nN", "m", "V"])
def test_jpks_export_is_read_with_the_calibration_that_it_states(tmp_path: Path, unit: str) -> None:
    (curve,) = curves.read(jpk_text(tmp_path / "a.txt", unit))
    assert [segment.role for segment in curve.segments] == ["approach", "pause", "retract"]
    for segment, (_, z, force) in zip(curve.segments, WAYS, strict=True):
        np.testing.assert_allclose(segment.z, z, atol=1e-14)  # nine digits of at most 10 um
        np.testing.assert_allclose(segment.force, force, atol=1e-17)  # type: ignore[arg-type]
        np.testing.assert_allclose(segment.deflection, force / K, atol=1e-15)  # type: ignore[arg-type]
        assert segment.z_channel == "height (measured)"
    assert curve.meta["spring constant"] == K
    assert curve.meta["sensitivity"] == SENSITIVITY
    assert curve.meta["setpoint"] == pytest.approx(0.5 * K * SENSITIVITY)
    assert np.all(np.diff(np.concatenate([segment.time for segment in curve.segments])) > 0.0)
    (corrected,) = curves.read(tmp_path / "a.txt", spring_constant=2 * K)
    assert corrected.meta["setpoint"] == pytest.approx(K * SENSITIVITY)


def test_jpks_export_with_decimal_commas_several_curves_and_no_calibration(tmp_path: Path) -> None:
    found = curves.read(jpk_text(tmp_path / "a.txt", comma=True, index=(3, 4)))
    assert [len(curve.segments) for curve in found] == [3, 3]
    np.testing.assert_allclose(found[1].segments[0].force, WAYS[0][2], atol=1e-17)  # type: ignore[arg-type]
    with pytest.raises(ReadError, match="states no sensitivity; give it"):
        curves.read(jpk_text(tmp_path / "b.txt", "V", facts=False))
    (given,) = curves.read(tmp_path / "b.txt", spring_constant=K, sensitivity=SENSITIVITY)
    np.testing.assert_allclose(given.segments[0].force, WAYS[0][2], atol=1e-17)  # type: ignore[arg-type]
    path = tmp_path / "b.txt"
    path.write_text(path.read_text().replace("m m s", "m V s"))
    with pytest.raises(ReadError, match="'measuredHeight' is in 'V', expected m"):
        curves.read(path, spring_constant=K, sensitivity=SENSITIVITY)


def test_curves_as_text_are_no_image(tmp_path: Path) -> None:
    pytest.importorskip("SurfaceTopography")
    for path in (jpk_text(tmp_path / "a.txt"), nanoscope_text(tmp_path / "b.txt")):
        with pytest.raises(ReadError, match="force curves as text, not an image"):
            images.channels(path)
    with pytest.raises(ReadError, match="3 columns, not an image"):
        images.channels(nova(tmp_path / "c.txt"))


# --- NanoScope --------------------------------------------------------------------------------------------------------


def nanoscope_text(path: Path, height: str = "Calc_Ramp_{}_nm", sign: float = -1.0, force: str = "Defl_pN_{}",
                   stiffness: float | None = K, comma: bool = False) -> Path:  # fmt: skip
    lines = [r'"\?Force file list"', r'"\Version: 0x09200201"', r'"\*Ciao scan list"',
             rf'"\@Sens. DeflSens: V {SENSITIVITY * 1e9:g} nm/V"', r'"\*Ciao force image list"']  # fmt: skip
    lines += [rf'"\Spring Constant: {stiffness}"'] if stiffness else []
    columns = {}
    for way, z, values in (
        ("Ex", KNOWN.approach_z, KNOWN.approach_force),
        ("Rt", KNOWN.retract_z, KNOWN.retract_force),
    ):
        columns[height.format(way)] = sign * z * 1e9
        unit = {"pN": 1e12, "nm": 1e9 / K, "V": 1.0 / (K * SENSITIVITY)}
        columns[force.format(way)] = values * next(unit[key] for key in unit if key in force)
    lines += [r'"\*Force file list end"', "\t".join(columns) + "\t"]
    longest = max(values.size for values in columns.values())
    for row in range(longest):
        cells = [spelt(values[row], comma) if row < values.size else "" for values in columns.values()]
        lines.append("\t".join(cells) + "\t")
    path.write_text("\r\n".join(lines) + "\r\n", encoding="latin-1", newline="")
    return path


VARIANTS = [
    {}, {"height": "PF_Z_Sensor_nm_{}"}, {"height": "Height_Sensor_nm_{}", "sign": 1.0}, {"force": "Defl_nm_{}"},
    {"force": "Defl_V_{}"}, {"comma": True},
]  # fmt: skip


@pytest.mark.parametrize("variant", VARIANTS)
def test_nanoscopes_export(tmp_path: Path, variant: dict[str, object]) -> None:
    """z falls during the approach, whichever way the column counts."""
    (curve,) = curves.read(nanoscope_text(tmp_path / "a.txt", **variant))  # type: ignore[arg-type]
    for segment, z, force in ((curve.approach, KNOWN.approach_z, KNOWN.approach_force),
                              (curve.retract, KNOWN.retract_z, KNOWN.retract_force)):  # fmt: skip
        assert segment is not None
        np.testing.assert_allclose(segment.z, z, atol=1e-14)
        np.testing.assert_allclose(segment.force, force, atol=1e-16)  # type: ignore[arg-type]
    assert (curve.meta["spring constant"], curve.meta["sensitivity"]) == pytest.approx((K, SENSITIVITY))
    assert "notes" not in curve.meta


def test_nanoscopes_export_names_what_it_lacks(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="no ramp and no height sensor among its columns"):
        curves.read(nanoscope_text(tmp_path / "a.txt", height="Time_s_{}"))
    (bare,) = curves.read(nanoscope_text(tmp_path / "b.txt", force="Defl_nm_{}", stiffness=None))
    assert bare.segments[0].force is None
    assert "states no spring constant" in bare.meta["notes"][0]
    path = nanoscope_text(tmp_path / "c.txt", height="{}_Height_nm")
    rows = [line.split("\t") for line in path.read_text().splitlines()]
    turned = [
        [row[0], row[1], row[0], *row[3:]] if len(row) > 4 and row[0][0] in "-0123456789" else row for row in rows
    ]
    path.write_text("\n".join("\t".join(row) for row in turned))
    with pytest.raises(ReadError, match="one direction on both ways"):
        curves.read(path)


# --- Nova -------------------------------------------------------------------------------------------------------------


def nova(path: Path, comma: bool = True, gap: str = "\t", mark: bool = False, turned: bool = False) -> Path:
    z = np.linspace(0.0, 2e-6, 400)
    current = np.clip(3e-7 - z, 0.0, None) / 50.0  # [A] at 50 nm/nA
    rows = np.column_stack([z * 1e9, current * 1e9, 0.5 * current * 1e9])[:: -1 if turned else 1]
    content = "\r\n".join(gap.join(spelt(value, comma) for value in row) for row in rows)
    path.write_text(content, encoding="utf-8-sig" if mark else "utf-8")
    return path


@pytest.mark.parametrize(("place", "row"), [(0, "nan\tnan\tnan"), (-1, "nan\tnan\tnan"), (40, "nan\tnan\tnan")])
def test_rows_of_nova_without_numbers_are_left_out_and_told(tmp_path: Path, place: int, row: str) -> None:
    known = {"spring_constant": 0.05, "sensitivity": 50.0}
    path = nova(tmp_path / "a.txt")
    (whole,) = curves.read(path, **known)  # type: ignore[arg-type]
    lines = path.read_text().splitlines()
    lines.insert(place % (len(lines) + 1), row)
    path.write_text("\n".join(lines) + "\n")
    (curve,) = curves.read(path, **known)  # type: ignore[arg-type]
    for ours, theirs in zip(curve.segments, whole.segments, strict=True):
        np.testing.assert_array_equal(ours.z, theirs.z)
        np.testing.assert_array_equal(ours.force, theirs.force)  # type: ignore[arg-type]
    assert "1 row of the approach without a number left out" in curve.meta["notes"]


def test_rows_of_nova_that_repeat_the_first_reading_are_told(tmp_path: Path) -> None:
    """Padding, or a saturated detector: nobody can tell, and 22 points of contact were gone without a word."""
    path = nova(tmp_path / "a.txt", comma=False)
    lines = [line.split("\t") for line in path.read_text().splitlines()]
    for line in lines[:22]:
        line[1] = lines[21][1]
    path.write_text("\n".join(map("\t".join, lines)) + "\n")
    (curve,) = curves.read(path, spring_constant=0.05, sensitivity=50.0)
    assert len(curve.approach) == 400 - 21  # type: ignore[arg-type]
    assert any(note.startswith("21 rows of the approach that repeat its first reading") for note in curve.meta["notes"])


@pytest.mark.parametrize(("comma", "gap", "mark", "turned"), [
    (True, "\t", False, False), (False, "\t", False, False), (True, ";", True, False), (False, ",", False, True),
    (False, "  ", True, True),
])  # fmt: skip
def test_novas_detector_reads_amperes(tmp_path: Path, comma: bool, gap: str, mark: bool, turned: bool) -> None:
    (curve,) = curves.read(nova(tmp_path / "a.txt", comma, gap, mark, turned), spring_constant=0.05, sensitivity=50.0)
    assert curve.approach is not None
    assert float(curve.approach.force.max()) == pytest.approx(0.05 * 3e-7)  # type: ignore[union-attr]
    assert float(curve.retract.force.max()) == pytest.approx(0.5 * 0.05 * 3e-7)  # type: ignore[union-attr]
    assert len(curve.retract) == 400  # type: ignore[arg-type]


def test_a_sensitivity_of_the_wrong_detector_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidValue, match=r"m/A, expected 0\.1 \.\. 100000 m/A, as the detector of .* reads A"):
        curves.read(nova(tmp_path / "a.txt"), spring_constant=0.05, sensitivity=50e-9)
    with pytest.raises(ReadError, match="states no sensitivity"):
        curves.read(tmp_path / "a.txt", spring_constant=0.05)
    segments = [("extend", KNOWN.approach_z, KNOWN.approach_force)]
    with pytest.raises(InvalidValue, match=r"m/V, expected 1e-10 \.\. 0\.0001 m/V"):
        curves.read(synthetic.write_jpk(tmp_path / "a.jpk-force", segments), sensitivity=50.0)
    assert curves.parse_sensitivity("50nm/nA") == pytest.approx(50.0)
    assert curves.parse_sensitivity("50nm/V") == pytest.approx(50e-9)


# --- tables -----------------------------------------------------------------------------------------------------------

TABLES = {
    "1.5 2\n3 4.5": "1.5\t2\n3\t4.5\n",
    "1,5\t2,0\n3\t4": "1.5\t2.0\n3\t4\n",
    "1,5;2\n3;4;": "1.5\t2\n3\t4\n",
    "1.5,2\n3,4": "1.5\t2\n3\t4\n",
    "1, 2, 3": "1\t2\t3\n",
    "1;;3": "1\tnan\t3\n",
    "# Width: 1,5 um\n1,5 2,5": "# Width: 1.5 um\n1.5\t2.5\n",
    "5,123.5\n1,2.5": "5\t123.5\n1\t2.5\n",
    "-1e-3 nan\r\n2 3": "-1e-3\tnan\n2\t3\n",
}


@pytest.mark.parametrize("content", TABLES)
def test_every_table_becomes_points_and_tabs(content: str) -> None:
    assert text.plain(content) == TABLES[content]


@pytest.mark.parametrize("content", ["1.234,5\t2.345,6", "0,05,0,25"])
def test_commas_that_may_be_either_are_refused(content: str) -> None:
    with pytest.raises(text.NotATable):
        text.plain(content)


def test_encodings() -> None:
    for codec in ("utf-8", "utf-8-sig", "utf-16", "latin-1", "shift-jis"):
        micro = "μ" if codec == "shift-jis" else "µ"
        assert text.decoded(f"1 {micro}m é".replace("é", "e").encode(codec)).replace("μ", "µ") == "1 µm e"
    assert not text.is_text(b"1 2\x00\x01")
