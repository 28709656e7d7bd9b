# SPDX-License-Identifier: BSD-3-Clause
"""Curves that say one thing and hold another: refused or told by name, and what others write is read all the same."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
import synthetic
from nanotouch import curves
from nanotouch.errors import InvalidValue, ReadError

K, S = 0.2, 30e-9
Z = np.linspace(300e-9, 0.0, 256)
FORCE = np.clip(80e-9 - Z, 0.0, None) * K
NAMES = ["Calc_Ramp_Ex_nm", "Calc_Ramp_Rt_nm"]
HEADER = ['"\\*Force file list"', '"\\Version: 0x08150300"', f'"\\Spring Constant: {K}"', '"\\*Ciao force image list"',
          '"\\@Sens. DeflSens: V 30.0 nm/V"', '"\\@4:Image Data: S [DeflectionError] "Deflection Error""',
          '"\\@4:Z scale: V [Sens. DeflSens] (0.000375 V/LSB) 24.576 V"', '"\\*File list end"']  # fmt: skip


def table(path: Path, columns: list[np.ndarray], names: list[str], header: list[str], gap: str = "\t") -> Path:
    rows = [gap.join(f"{value:.6e}" for value in row) for row in np.column_stack(columns)]
    path.write_text("\n".join([*header, gap.join(names), *rows]) + "\n", encoding="latin-1")
    return path


# --- NanoScope --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("quoted", [False, True])
@pytest.mark.parametrize(("unit", "factor"), [("pN", 1e12), ("nm", 1e9 / K), ("V", 1.0 / (K * S))])
def test_nanoscopes_table_without_its_header(tmp_path: Path, unit: str, factor: float, quoted: bool) -> None:
    names = [f'"{name}"' if quoted else name for name in (*NAMES, f"Defl_{unit}_Ex", f"Defl_{unit}_Rt")]
    path = table(tmp_path / "a.txt", [Z * 1e9, Z[::-1] * 1e9, FORCE * factor, FORCE[::-1] * factor * 0.9], names, [])
    (curve,) = curves.read(path, spring_constant=K, sensitivity=S)
    assert [segment.role for segment in curve.segments] == ["approach", "retract"]
    np.testing.assert_allclose(curve.approach.force, FORCE, atol=1e-13)  # type: ignore[union-attr]
    np.testing.assert_allclose(curve.retract.force, 0.9 * FORCE[::-1], atol=1e-13)  # type: ignore[union-attr]
    np.testing.assert_allclose(curve.approach.z, Z, atol=1e-13)  # type: ignore[union-attr]


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("role", ["approach", "retract"])
def test_a_branch_that_was_copied_says_by_its_readings_which_it_is(tmp_path: Path, role: str, sign: float) -> None:
    z, force = (Z, FORCE) if role == "approach" else (Z[::-1], FORCE[::-1])
    path = table(tmp_path / "a.txt", [sign * z * 1e6, force * 1e9], ["    \xb5m         ", "nN"], [])
    (curve,) = curves.read(path)
    (segment,) = curve.segments
    assert segment.role == role
    np.testing.assert_allclose(segment.z - segment.z.min(), z, atol=1e-13)
    np.testing.assert_allclose(segment.force, force, atol=1e-13)  # type: ignore[arg-type]
    assert "its columns do not say which way it is" in curve.meta["notes"][0]
    flat = table(tmp_path / "b.txt", [z * 1e9, 0.0 * z], ["nm", "nN"], [])
    with pytest.raises(ReadError, match="whether they are an approach or a retraction"):
        curves.read(flat)


@pytest.mark.parametrize("header", [HEADER, []])
@pytest.mark.parametrize(("unit", "factor"), [("pN", 1e12), ("V", 1.0 / (K * S))])
def test_fillers_of_nanoscopes_text_are_no_readings(
    tmp_path: Path, header: list[str], unit: str, factor: float
) -> None:
    """-12.288 V is the lowest integer times 0.375 mV, and was a pull of 74 nN."""
    filled = FORCE.copy()
    filled[:5] = -32768 * 0.000375 * S * K
    names = [*NAMES, f"Defl_{unit}_Ex", f"Defl_{unit}_Rt"]
    path = table(tmp_path / "a.txt", [Z * 1e9, Z[::-1] * 1e9, filled * factor, FORCE[::-1] * factor], names, header)
    (curve,) = curves.read(path, spring_constant=K, sensitivity=S)
    np.testing.assert_allclose(curve.approach.force, FORCE[5:], atol=1e-13)  # type: ignore[union-attr]
    assert len(curve.retract) == 256  # type: ignore[arg-type]
    assert any("5 samples at the ends of the approach left out" in note for note in curve.meta["notes"])


def test_a_ramp_that_its_header_cuts_in_two_is_refused(tmp_path: Path) -> None:
    path = synthetic.write_nanoscope(tmp_path / "a.000", [(FORCE[::-1] / (K * S), FORCE[::-1] / (K * S))])
    content = path.read_bytes().replace(b"\\Scan Size", b"\\Scan size")
    content = content.replace(b"\\*Ciao scan list\r\n", b"\\*Ciao scan list\r\n\\Operating mode: Force\r\n")
    content = content.replace(b"Samps/line: 256 256", b"Samps/line: 128 128").replace(b"\0" * 24, b"", 1)
    path.write_bytes(content)
    with pytest.raises(ReadError, match="2 curves of 'Samps/line: 128 128', but its header is that of one ramp"):
        curves.read(path)


@pytest.mark.parametrize(("stated", "right"), [(b"410.00 \xc5/V ", 41e-9), (b".04100 nm/mV", 41e-9)])
def test_more_units_of_nanoscopes_sensitivity(tmp_path: Path, stated: bytes, right: float) -> None:
    path = synthetic.write_nanoscope(tmp_path / "a.000", [(FORCE[::-1] / (K * S), FORCE[::-1] / (K * S))])
    path.write_bytes(path.read_bytes().replace(b"41.00000 nm/V", stated.ljust(13)))
    assert curves.read(path)[0].meta["sensitivity"] == pytest.approx(right)


# --- JPK, Nanonis -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("between", [" = ", ":", " : ", " ", "\t="])
def test_properties_of_jpk_with_any_separator(tmp_path: Path, between: str) -> None:
    known = synthetic.known_curve()
    ways = [("extend", known.approach_z, known.approach_force), ("retract", known.retract_z, known.retract_force)]
    whole, other = synthetic.write_jpk(tmp_path / "a.jpk-force", ways), tmp_path / "b.jpk-force"
    with zipfile.ZipFile(whole) as old, zipfile.ZipFile(other, "w") as new:
        for item in old.infolist():
            content = old.read(item)
            if item.filename.endswith(".properties"):
                content = content.replace(b"=", between.encode())
            new.writestr(item.filename, content)
    one, two = curves.read(whole)[0], curves.read(other)[0]
    for ours, theirs in zip(two.segments, one.segments, strict=True):
        np.testing.assert_array_equal(ours.force, theirs.force)  # type: ignore[arg-type]
        np.testing.assert_array_equal(ours.z, theirs.z)


def test_forces_of_jpks_text_need_no_spring_constant(tmp_path: Path) -> None:
    rows = "\n".join(f"{z:.6e} {force:.6e}" for z, force in zip(Z, FORCE, strict=True))
    head = "# TEXT EXPORT\n# segmentIndex: 0\n# segment: extend\n# columns: height vDeflection\n# units: m {}\n"
    (tmp_path / "a.txt").write_text(head.format("N") + rows + "\n")
    (curve,) = curves.read(tmp_path / "a.txt")
    np.testing.assert_allclose(curve.approach.force, FORCE, atol=1e-13)  # type: ignore[union-attr]
    assert curve.approach.deflection is None  # type: ignore[union-attr]
    (given,) = curves.read(tmp_path / "a.txt", spring_constant=K)
    np.testing.assert_allclose(given.approach.deflection, FORCE / K, atol=1e-13)  # type: ignore[union-attr]
    (tmp_path / "b.txt").write_text(head.format("m") + rows + "\n")
    (bent,) = curves.read(tmp_path / "b.txt")
    assert bent.approach.force is None  # type: ignore[union-attr]
    assert "states no spring constant" in bent.meta["notes"][0]


def nanonis(path: Path, comma: bool = False) -> Path:
    rows = [f"{z:.5E}\t{force:.5E}" for z, force in zip(Z, FORCE, strict=True)]
    text = "Experiment\tZ spectroscopy\n\n[DATA]\nZ (m)\tForce (N)\n" + "\n".join(rows)
    path.write_text(text.replace(".", ",") if comma else text)
    return path


def test_decimal_commas_of_nanonis(tmp_path: Path) -> None:
    (curve,) = curves.read(nanonis(tmp_path / "a.dat", comma=True))
    np.testing.assert_allclose(curve.approach.force, FORCE, atol=1e-13)  # type: ignore[union-attr]


@pytest.mark.parametrize("cut", [1, 3, 5, 8])
def test_a_row_that_is_cut_inside_its_last_number_is_left_out(tmp_path: Path, cut: int) -> None:
    """1.60000E-8 became 1.60000, or 1.6."""
    path = nanonis(tmp_path / "a.dat")
    path.write_text(path.read_text()[:-cut])
    (curve,) = curves.read(path)
    np.testing.assert_allclose(curve.approach.force, FORCE[:-1], atol=1e-13)  # type: ignore[union-attr]
    assert curve.meta["notes"] == ("the last row is cut off and left out",)


# --- what Python is given ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("factor", [2.0, 0.5, 1e9, -1.0])
def test_a_deflection_that_contradicts_the_force_is_refused(factor: float) -> None:
    nothing = np.full(Z.size, np.nan)
    right = curves.Segment("approach", nothing, Z, "height (piezo)", FORCE + 1e-10, FORCE / K)
    wrong = curves.Segment("retract", nothing, Z[::-1], "height (piezo)", FORCE[::-1], factor * FORCE[::-1] / K)
    assert curves.ForceCurve((right,), {"spring constant": K}).approach is right
    for meta in ({"spring constant": K}, {}):
        with pytest.raises(InvalidValue, match=r"in the retract they differ by .* N/m, but the spring .* 0\.2"):
            curves.ForceCurve((right, wrong), meta)


def spectrum(k: float = 0.4, resonance: float = 60e3, quality: float = 100.0) -> tuple[np.ndarray, np.ndarray]:
    f = np.linspace(0.5 * resonance, 1.5 * resonance, 3000)
    mean_square = 0.817 * 1.380649e-23 * 295.0 / k
    height = mean_square / (np.pi * resonance * quality / 2.0)
    return f, height * resonance**4 / ((f**2 - resonance**2) ** 2 + (f * resonance / quality) ** 2) + 1e-30


@pytest.mark.parametrize(("density", "frequency", "name"), [
    (1e24, 1.0, "density"), (1e18, 1.0, "density"), (1e12, 1.0, "density"), (1.0 / 30e-9**2, 1.0, "density"),
    (1e30, 1.0, "density"), (1.0, 1e-3, "frequency"), (1.0, 1e-6, "density"),
])  # fmt: skip
def test_a_spectrum_in_another_unit_is_refused(density: float, frequency: float, name: str) -> None:
    """In pm^2/Hz it gave 4e-25 N/m, over kHz a lever of 3 g."""
    f, S = spectrum()
    assert curves.thermal_tune(f, S, averages=50).spring_constant == pytest.approx(0.4, rel=0.01)
    with pytest.raises(InvalidValue, match=f"^{name}: a .* expected .* k?g?"):
        curves.thermal_tune(f * frequency, S * density, averages=50)
