# SPDX-License-Identifier: BSD-3-Clause
"""Asylum's pairs of waves, Nanonis' spectra over z, JPK's thermal spectra; made here, and real ones where they are."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
import synthetic
from nanotouch import curves
from nanotouch.errors import InvalidValue, ReadError

pytest.importorskip("afmformats")

KNOWN = synthetic.known_curve(n=200)
K = KNOWN.spring_constant
NAMES = ("Line0003Point0007Defl.ibw", "Line0003Point0007ZSnsr.ibw")


def write_pair(folder: Path, note: str | None = "Indexes", facts: dict[str, object] | None = None) -> Path:
    """Approach, retraction and a rest, one wave each for deflection and height."""
    rest = np.full(40, KNOWN.retract_z[-1]) + 1e-12 * np.arange(40)
    z = np.concatenate([KNOWN.approach_z, KNOWN.retract_z, rest])
    deflection = np.concatenate([KNOWN.approach_force, KNOWN.retract_force, np.zeros(40)]) / K
    ends = np.cumsum([0, KNOWN.approach_z.size, KNOWN.retract_z.size, 40]) - 1
    facts = {"XLVDT": -3e-5, **(facts or {})}
    if note:
        facts[note] = f"0,{','.join(str(end) for end in ends[1:])},"
    for name, values in zip(NAMES, (deflection, -z), strict=True):
        # one dimension: a wave of one channel
        synthetic.write_ibw(folder / name, values, [], note=facts)
    return folder / NAMES[0]


@pytest.mark.parametrize("note", ["Indexes", None])
def test_a_pair_is_one_curve(tmp_path: Path, note: str | None) -> None:
    (curve,) = curves.read(write_pair(tmp_path, note), spring_constant=K)
    roles = ["approach", "retract"] + (["pause"] if note else [])
    assert [segment.role for segment in curve.segments] == roles
    approach, retract = curve.segments[:2]
    assert approach.z_channel == "height (measured)"
    np.testing.assert_allclose(approach.z, KNOWN.approach_z, atol=1e-18)
    np.testing.assert_allclose(approach.force, KNOWN.approach_force, atol=1e-18)  # type: ignore[arg-type]
    np.testing.assert_allclose(retract.z[:200], KNOWN.retract_z, atol=1e-18)
    assert (curve.meta["grid index y"], curve.meta["grid index x"]) == (3, 7)


def test_without_a_spring_constant_it_has_deflections_and_says_so(tmp_path: Path) -> None:
    (curve,) = curves.read(write_pair(tmp_path))
    assert curve.segments[0].force is None
    np.testing.assert_allclose(curve.segments[0].deflection, KNOWN.approach_force / K, atol=1e-18)  # type: ignore[arg-type]
    assert "states no spring constant: deflections alone; give it for forces" in curve.meta["notes"]
    with pytest.raises(InvalidValue, match="spring constant"):
        curves.analyse(curve)


def test_a_pair_in_capitals_that_states_its_calibration(tmp_path: Path) -> None:
    path = write_pair(tmp_path)
    for name in NAMES:
        (tmp_path / name).rename(tmp_path / name.upper())
    (curve,) = curves.read(tmp_path / path.name.upper(), spring_constant=K)
    np.testing.assert_allclose(curve.approach.force, KNOWN.approach_force, atol=1e-18)  # type: ignore[union-attr,arg-type]
    for old in tmp_path.iterdir():
        old.unlink()
    path = write_pair(tmp_path, facts={"SpringConstant": 2.0 * K, "InvOLS": 5e-8})
    (curve,) = curves.read(path)
    assert (curve.spring_constant, curve.meta["sensitivity"]) == (2.0 * K, 5e-8)
    np.testing.assert_allclose(curve.approach.force, 2.0 * KNOWN.approach_force, atol=1e-18)  # type: ignore[union-attr]
    (curve,) = curves.read(path, spring_constant=K, sensitivity=1e-7)
    np.testing.assert_allclose(curve.approach.force, 2.0 * KNOWN.approach_force, atol=1e-18)  # type: ignore[union-attr]


def test_the_half_with_the_heights_is_refused_as_the_curve_would_count_twice(tmp_path: Path) -> None:
    write_pair(tmp_path)
    with pytest.raises(ReadError, match=f"holds the heights of {NAMES[0]}; read that"):
        curves.read(tmp_path / NAMES[1])
    (tmp_path / NAMES[1]).unlink()
    with pytest.raises(ReadError):
        curves.read(tmp_path / NAMES[0])


def test_a_folder_of_pairs_is_fitted_without_the_halves_that_hold_heights(tmp_path: Path) -> None:
    write_pair(tmp_path)
    files = pytest.importorskip("nanotouch.batch.files")
    assert [file.name for file in files._without(files.files_of([tmp_path]), ())] == [NAMES[0]]


@pytest.mark.parametrize("untrusted", [False, True])
def test_endings_in_capitals_and_hdf5(tmp_path: Path, untrusted: bool) -> None:
    """As old Windows disks write them; afmformats knows small letters alone."""
    small = synthetic.write_ibw_curve(tmp_path / "a.ibw", KNOWN)
    (expected,) = curves.read(small)
    curves.write(tmp_path / "b.hdf5", [expected])
    segments = [("extend", KNOWN.approach_z, KNOWN.approach_force), ("retract", KNOWN.retract_z, KNOWN.retract_force)]
    synthetic.write_jpk(tmp_path / "C.JPK-FORCE", segments)
    for name in (small.rename(tmp_path / "A.IBW").name, "b.hdf5", "C.JPK-FORCE"):
        (found,) = curves.read(tmp_path / name, untrusted=untrusted)
        assert found.name == name
        if name != "C.JPK-FORCE":
            np.testing.assert_allclose(found.retract.force, expected.retract.force, rtol=1e-12)  # type: ignore


def test_a_wave_without_a_note_says_what_may_be_missing(tmp_path: Path) -> None:
    (write_pair(tmp_path)).rename(tmp_path / "alone.ibw")
    with pytest.raises(ReadError, match=r"ZSnsr\.ibw, both must lie in one folder"):
        curves.read(tmp_path / "alone.ibw")


def test_an_archive_is_the_curves_of_its_files(tmp_path: Path) -> None:
    pieces = [curves.ForceCurve((curves.Segment("approach", KNOWN.approach_z * 0, KNOWN.approach_z, "height (measured)",
                                                KNOWN.approach_force * factor),), {"spring constant": K})
              for factor in (1.0, 2.0)]  # fmt: skip
    with zipfile.ZipFile(tmp_path / "sent.zip", "w") as archive:
        for number, curve in enumerate(pieces):
            curves.write(tmp_path / f"{number}.tab", [curve])
            archive.write(tmp_path / f"{number}.tab", f"../day/{number}.tab")
        archive.writestr("__MACOSX/x.tab", b"no curve")
    found = curves.read(tmp_path / "sent.zip")
    assert [curve.name for curve in found] == ["0.tab", "1.tab"]
    assert [curve.meta["enum"] for curve in found] == [0, 1]
    for curve, piece in zip(found, pieces, strict=True):
        np.testing.assert_allclose(curve.segments[0].force, piece.segments[0].force, atol=1e-18)  # type: ignore[arg-type]
    with zipfile.ZipFile(tmp_path / "sent.zip", "a") as archive:
        archive.writestr("read me.txt", b"words")
    with pytest.raises(ReadError, match=r"sent\.zip: read me\.txt in it: its content is not that of a \.txt"):
        curves.read(tmp_path / "sent.zip")


def test_a_thermal_spectrum_among_curves_is_named(tmp_path: Path) -> None:
    (tmp_path / "cal.tnd").write_text("# thermal noise data\n1 2\n")
    with pytest.raises(ReadError, match=r"curves\.thermal_spectrum reads it"):
        curves.read(tmp_path / "cal.tnd")


def test_a_chiaro_file_says_its_setpoint_in_newtons(tmp_path: Path) -> None:
    found = sorted((Path(__file__).parents[3] / "shared/data/corpus/curves").glob("*chiaro*.zip"))
    if not found:
        pytest.skip("no Chiaro file at hand")
    (curve,) = curves.read(found[0])
    assert curve.meta["setpoint"] == pytest.approx(50e-9)
    assert curve.meta["speed approach"] == pytest.approx(7e-6)
    assert curve.tip_radius == pytest.approx(27.5e-6)
    assert curve.approach is not None
    assert curve.approach.force is not None
    assert curve.approach.force.max() == pytest.approx(curve.meta["setpoint"], rel=0.05)


def write_chiaro(path: Path, load: str = "Load (uN)") -> Path:
    """Base, bend and indentation in the columns that Optics11's export has, forces in uN, lengths in nm."""
    z = np.concatenate([KNOWN.approach_z, KNOWN.retract_z])
    force = np.concatenate([KNOWN.approach_force, KNOWN.retract_force])
    head = ["Date\t12/05/2025\tTime\t11:20:38\tStatus\tOK", "Piezo position (nm) (Measured)\t-10.3", "k (N/m)\t0.019",
            "Tip radius (um)\t27.500", "", "Device:\tChiaro", "Software version: V3.5.0", "", "Max load (\xb5N)\t0.050",
            "Piezo speed  (\xb5m/s)\t7.000", "",
            f"Time (s)\t{load}\tIndentation (nm)\tCantilever (nm)\tPiezo (nm)\tAuxiliary"]  # fmt: skip
    rows = [f"{1e-3 * n:.6f}\t{1e6 * F:.9f}\t{1e9 * abs(h) / 7:.6f}\t{1e9 * F / 0.019:.6f}\t{-1e9 * h:.6f}\t0"
            for n, (h, F) in enumerate(zip(z, force, strict=True))]  # fmt: skip
    path.write_bytes("\n".join([*head, *rows]).encode("latin-1") + b"\n")
    return path


def test_z_of_a_chiaro_file_is_its_piezo(tmp_path: Path) -> None:
    """Not the indentation that it computed: a fit subtracts the deflection itself."""
    pytest.importorskip("afmformats")
    (curve,) = curves.read(write_chiaro(tmp_path / "a.txt"))
    z = np.concatenate([KNOWN.approach_z, KNOWN.retract_z])
    force = np.concatenate([KNOWN.approach_force, KNOWN.retract_force])
    np.testing.assert_allclose(np.concatenate([s.z for s in curve.segments]), z, atol=1e-14)
    np.testing.assert_allclose(np.concatenate([s.force for s in curve.segments]), force, atol=1e-14)  # type: ignore[misc]
    with pytest.raises(ReadError, match=r"a column 'Load \(nN\)' of a Chiaro file, expected 'Load \(uN\)'"):
        curves.read(write_chiaro(tmp_path / "b.txt", "Load (nN)"))


def test_a_last_line_that_is_cut_off_is_no_other_number(tmp_path: Path) -> None:
    pytest.importorskip("afmformats")
    path = write_chiaro(tmp_path / "a.txt")
    path.write_bytes(path.read_bytes().replace(b"\t0\n", b"\t0.125\n")[:-3])
    with pytest.raises(ReadError, match="its last line is cut off: "):
        curves.read(path)


def write_dat(path: Path, columns: dict[str, np.ndarray], experiment: str = "Z spectroscopy") -> Path:
    rows = ["\t".join(f"{value:.9E}" for value in row) for row in zip(*columns.values(), strict=True)]
    header = [f"Experiment\t{experiment}\t", "Saved Date\t20.04.2023 14:55:09\t", "X (m)\t153.514E-9\t", "", "[DATA]"]
    path.write_text("\n".join([*header, "\t".join(columns), *rows]) + "\n")
    return path


@pytest.mark.parametrize("signal", ["Deflection (m)", "Deflection (V)", "Force (N)"])
def test_a_nanonis_spectrum_over_z(tmp_path: Path, signal: str) -> None:
    """The way back stands at the z of the way there, against the order of time."""
    z = KNOWN.approach_z
    back = np.interp(z[::-1], KNOWN.retract_z, KNOWN.retract_force)[::-1]
    factor = {"Deflection (m)": K, "Deflection (V)": K * 5e-8, "Force (N)": 1.0}[signal]
    columns = {"Z rel (m)": z, "Current (A)": 0 * z, signal: KNOWN.approach_force / factor,
               signal.replace(" (", " [bwd] ("): back / factor, signal.replace(" (", " [filt] ("): 0 * z}  # fmt: skip
    path = write_dat(tmp_path / "a.dat", columns)
    given = {"sensitivity": 5e-8} if "V" in signal else {}
    (curve,) = curves.read(path, spring_constant=K, **given)
    assert [segment.role for segment in curve.segments] == ["approach", "retract"]
    approach, retract = curve.segments
    np.testing.assert_allclose(approach.force, KNOWN.approach_force, atol=1e-15)  # type: ignore[arg-type]
    np.testing.assert_allclose(retract.z, z[::-1], atol=1e-15)
    np.testing.assert_allclose(retract.force, back[::-1], atol=1e-15)  # type: ignore[arg-type]
    if "V" in signal:
        with pytest.raises(ReadError, match="in V, and it states no sensitivity; give it"):
            curves.read(path)


def test_nanonis_columns_count_in_their_units(tmp_path: Path) -> None:
    """Each with a prefix of its own, the way back, too; a comment that speaks of [DATA] is none."""
    z = KNOWN.approach_z
    columns = {"Z rel (\xb5m)": 1e6 * z, "Z (\xc5)": 2e10 * z, "Force (nN)": 1e9 * KNOWN.approach_force,
               "Force [bwd] (pN)": 1e12 * KNOWN.approach_force}  # fmt: skip
    path = write_dat(tmp_path / "a.dat", columns)
    path.write_text(path.read_text().replace("X (m)", "Comment01\tsee [DATA] below\nX (m)"))
    (curve,) = curves.read(path, spring_constant=K)
    approach, retract = curve.segments
    np.testing.assert_allclose(approach.z, 2.0 * z, rtol=1e-8)
    for segment in (approach.force, retract.force[::-1]):  # type: ignore[index]
        np.testing.assert_allclose(segment, KNOWN.approach_force, atol=1e-15)  # type: ignore[arg-type]
    (told,) = (note for note in curve.meta["notes"] if "disagree" in note)
    assert told.startswith("Z over")
    assert told.endswith("disagree: Z is taken")


def test_a_nanonis_row_that_is_cut_off_is_told(tmp_path: Path) -> None:
    z = np.linspace(1e-6, 0.0, 60)
    path = write_dat(tmp_path / "a.dat", {"Z rel (m)": z, "Current (A)": z, "Force (N)": 1e-3 * z})
    whole = path.read_text()
    path.write_text(whole[: whole.rindex("\t")])
    (curve,) = curves.read(path, spring_constant=K)
    assert len(curve.segments[0]) == 59
    assert "the last row is cut off and left out" in curve.meta["notes"]


def test_other_nanonis_spectra_are_refused_with_what_they_hold(tmp_path: Path) -> None:
    bias = np.linspace(-1.0, 1.0, 50)
    path = write_dat(tmp_path / "a.dat", {"Bias calc (V)": bias, "Current (A)": bias}, "bias spectroscopy")
    message = r"bias spectroscopy without a z and a deflection or force .* it holds Bias calc \(V\), Current \(A\)"
    with pytest.raises(ReadError, match=message):
        curves.read(path)


def write_tnd(path: Path, frequency: np.ndarray, density: np.ndarray) -> Path:
    head = [
        "# thermal noise data", "# sensitivity: 20.0 nm/V", "# spring constant: 40.0 mN/m",
        "# settings.method: Contact-free",
        "# Channels: 'Frequency' 'Vertical Deflection' 'average' ", "# Units: 'Hz' 'V²/Hz' 'V²/Hz'", "",
    ]  # fmt: skip
    rows = [f"{f!r} {d!r} 0.0" for f, d in zip(frequency.tolist(), density.tolist(), strict=True)]
    path.write_text("\n".join(head + rows) + "\n", encoding="utf-8")
    return path


def test_a_thermal_spectrum_gives_its_spring_constant(tmp_path: Path) -> None:
    """An oscillator of 0.04 N/m at 293 K, written as JPK writes it."""
    k, resonance, q = 0.04, 24e3, 3.0
    f = np.arange(0.0, 1e5, 12.0)
    mean_square = 1.380649e-23 * 293.0 / k
    peak = 2.0 * mean_square / (np.pi * resonance * q)
    density = peak * resonance**4 / ((f**2 - resonance**2) ** 2 + (f * resonance / q) ** 2) + 1e-27
    found = curves.thermal_spectrum(write_tnd(tmp_path / "a.tnd", f, density / (20e-9) ** 2))
    assert (found.sensitivity, found.spring_constant) == pytest.approx((20e-9, 0.04))
    assert found.frequency[0] == 12.0  # not 0 Hz
    assert found.facts["settings.method"] == "Contact-free"
    tune = curves.thermal_tune(found.frequency, found.density, averages=1000, temperature=293.0, correction=1.0)
    assert tune.spring_constant == pytest.approx(k, rel=0.01)
    text = (tmp_path / "a.tnd").read_text(encoding="utf-8")
    (tmp_path / "c.tnd").write_text(text.replace("V²", "V^2") + "1e5 2e-9", encoding="utf-8")  # its last row is cut
    (tmp_path / "d.tnd").write_text(text, encoding="latin-1")
    for name in ("c.tnd", "d.tnd"):
        np.testing.assert_array_equal(curves.thermal_spectrum(tmp_path / name).density, found.density)
    for old, new in (("# thermal", "# cold"), ("'Frequency'", "'Time'"), ("24.0 ", "24.0 7 "), ("nm/V", "furlong")):
        (tmp_path / "b.tnd").write_text(text.replace(old, new, 1), encoding="utf-8")
        with pytest.raises(ReadError):
            curves.thermal_spectrum(tmp_path / "b.tnd")


def test_real_files() -> None:
    folder = synthetic.DATA / "corpus" / "curves"
    if not folder.is_dir():
        pytest.skip(f"real data not here: {folder}")
    (curve,) = curves.read(folder / "asylum-pairs" / "Line0000Point0000Defl.ibw")
    assert [(s.role, len(s)) for s in curve.segments] == [("approach", 2488), ("retract", 2528), ("pause", 199)]
    spectrum = curves.thermal_spectrum(next(folder.glob("*.tnd")))
    assert spectrum.spring_constant == pytest.approx(45.8785e-3)
    near = (spectrum.frequency > 3e3) & (spectrum.frequency < 150e3)
    tune = curves.thermal_tune(
        spectrum.frequency[near], spectrum.density[near], averages=50, temperature=298.0, correction=1.0
    )
    assert tune.resonance == pytest.approx(24.25e3, rel=0.15)  # the instrument's own fit


def asylum(path: Path, dwell: int, facts: dict[str, object]) -> Path:
    """Down, a dwell with the noise of a sensor, and back."""
    way, bent = np.linspace(1e-6, 0.0, 300), np.linspace(0.0, 1e-8, 300)
    rest = 1e-11 * np.random.default_rng(3).standard_normal(dwell)
    z, deflection = np.concatenate([way, rest, way[::-1]]), np.concatenate([bent, np.full(dwell, 1e-8), bent[::-1]])
    note = {"InvOLS": 5e-8, "SpringConstant": 0.1} | facts
    return synthetic.write_ibw(path, np.stack([-z, deflection, -z], axis=-1), ["Raw", "Defl", "ZSnsr"], note=note)


@pytest.mark.parametrize("facts", [
    {}, {"Indexes": "0,150,719,"}, {"Indexes": "0,299,719,", "DwellTime": 0.2}, {"Indexes": "0,299,598"},
])  # fmt: skip
def test_a_dwell_of_an_asylum_curve_is_a_pause_whatever_its_note_says(facts: dict[str, object], tmp_path: Path) -> None:
    """It was part of the approach or of the retraction. Indexes that z contradicts were believed."""
    (curve,) = curves.read(asylum(tmp_path / "a.ibw", 120, facts))
    assert [segment.role for segment in curve.segments] == ["approach", "pause", "retract"]
    assert [len(segment) for segment in curve.segments] == pytest.approx([300, 120, 300], abs=4)
    if "Indexes" in facts:
        assert any("contradict z" in note for note in curve.meta["notes"])


def test_a_turn_without_a_dwell_is_no_pause(tmp_path: Path) -> None:
    (curve,) = curves.read(asylum(tmp_path / "a.ibw", 0, {}))
    assert [len(segment) for segment in curve.segments] == pytest.approx([300, 300], abs=1)
    z = -0.5e-6 * (1.0 - np.cos(np.linspace(0.0, 2.0 * np.pi, 800)))  # as PeakForce moves
    wave = np.stack([-z, 0.0 * z, -z], axis=-1)
    facts: dict[str, object] = {"InvOLS": 5e-8, "SpringConstant": 0.1}
    path = synthetic.write_ibw(tmp_path / "b.ibw", wave, ["Raw", "Defl", "ZSnsr"], note=facts)
    (curve,) = curves.read(path)
    assert [segment.role for segment in curve.segments] == ["approach", "retract"]


def test_heights_that_count_the_other_way_are_refused_whatever_the_indexes(tmp_path: Path) -> None:
    """Both ends of such a curve are its deepest place, which is no dwell."""
    way = np.linspace(0.0, 1e-6, 300)
    z = np.concatenate([way, way[::-1]])
    wave = np.stack([-z, 0.0 * z, -z], axis=-1)
    note: dict[str, object] = {"InvOLS": 5e-8, "SpringConstant": "0,1", "Indexes": "0,299,599", "Direction": "NaN,1,-1"}
    path = synthetic.write_ibw(tmp_path / "a.ibw", wave, ["Raw", "Defl", "ZSnsr"], note=note)
    with pytest.raises(ReadError, match="the sign of its height is reversed"):
        curves.read(path)
    path = synthetic.write_ibw(tmp_path / "b.ibw", -wave, ["Raw", "Defl", "ZSnsr"], note=note)
    assert curves.read(path)[0].spring_constant == 0.1
