# SPDX-License-Identifier: BSD-3-Clause
"""nanotouch.curves.read: every segment, in SI, z away from the sample; one clear error for everything else."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
import synthetic

pytest.importorskip("afmformats")

from nanotouch import curves
from nanotouch.errors import InvalidValue, ReadError

KNOWN = synthetic.known_curve(n=200)


def jpk(path: Path, *, spring_constant: float | None = KNOWN.spring_constant, sensitivity: float = 6e-8) -> Path:
    segments = [("extend", KNOWN.approach_z, KNOWN.approach_force), ("retract", KNOWN.retract_z, KNOWN.retract_force)]
    return synthetic.write_jpk(path, segments, spring_constant=spring_constant, sensitivity=sensitivity)


def tab(path: Path, **replaced: object) -> Path:
    columns = {
        "force": np.concatenate([KNOWN.approach_force, KNOWN.retract_force]),
        "height (measured)": np.concatenate([KNOWN.approach_z, KNOWN.retract_z]),
        "segment": np.repeat([0, 1], [KNOWN.approach_z.size, KNOWN.retract_z.size]),
    }
    columns.update(replaced)  # type: ignore[arg-type]
    return synthetic.write_tab(path, columns, {"imaging mode": "force-distance", "spring constant": 0.8})


def test_asylum_one_run_of_points_is_cut_at_the_deepest(tmp_path: Path) -> None:
    (curve,) = curves.read(synthetic.write_ibw_curve(tmp_path / "curve.ibw", KNOWN))
    assert [s.role for s in curve.segments] == ["approach", "retract"]
    assert curve.approach is curve.segments[0]
    assert curve.retract is curve.segments[1]
    # z: ZSnsr grows towards the sample in the file, z away from it here; force: + repulsive
    joined = np.concatenate([s.z for s in curve.segments])
    np.testing.assert_array_equal(joined, np.concatenate([KNOWN.approach_z, KNOWN.retract_z]))
    assert curve.approach.z[-1] == joined.min()
    np.testing.assert_allclose(curve.approach.force, KNOWN.approach_force[: len(curve.approach)], rtol=1e-12)
    np.testing.assert_allclose(curve.approach.deflection, curve.approach.force / 0.8, rtol=1e-12)
    assert curve.approach.z_channel == "height (measured)"
    assert np.isnan(curve.approach.time).all()  # the file records no time, so none is invented
    assert curve.spring_constant == curve.meta["spring constant"] == 0.8
    assert curve.meta["sensitivity"] == 5e-8


def test_jpk(tmp_path: Path) -> None:
    (curve,) = curves.read(jpk(tmp_path / "curve.jpk-force"))
    assert [s.role for s in curve.segments] == ["approach", "retract"]
    # integers of 32 bit over the range
    np.testing.assert_allclose(curve.approach.z, KNOWN.approach_z, rtol=0, atol=1e-15)
    np.testing.assert_allclose(curve.retract.force, KNOWN.retract_force, rtol=0, atol=1e-17)
    np.testing.assert_allclose(curve.approach.time, np.arange(200) / 200, rtol=1e-12)
    assert curve.retract.time[0] == pytest.approx(1.0)
    assert curve.meta["instrument"] == "Synthetic"


def test_a_pause_is_kept(tmp_path: Path) -> None:
    rest = np.linspace(2.80e-7, 2.79e-7, 50)
    segments = [
        ("extend", KNOWN.approach_z, KNOWN.approach_force),
        ("pause", rest, np.full(50, 1.6e-8)),
        ("retract", KNOWN.retract_z, KNOWN.retract_force),
    ]
    (curve,) = curves.read(synthetic.write_jpk(tmp_path / "creep.jpk-force", segments))
    assert [(s.role, len(s)) for s in curve.segments] == [("approach", 200), ("pause", 50), ("retract", 200)]
    assert curve.retract is curve.segments[2]


def test_every_pause_is_a_pause(tmp_path: Path) -> None:
    """Whatever order the segments have: after the approach without a retraction, before it, and after it."""
    approach, retract = (KNOWN.approach_z, KNOWN.approach_force), (KNOWN.retract_z, KNOWN.retract_force)
    low = (np.linspace(2.80e-7, 2.79e-7, 50), np.full(50, 1.6e-8))
    high = (np.full(40, 8e-7), np.full(40, -3e-9))
    for segments, roles in (
        ([approach, low], ["approach", "pause"]),
        ([low, retract], ["pause", "retract"]),
        ([high, approach, low, retract, high], ["pause", "approach", "pause", "retract", "pause"]),
        ([approach, retract, approach, retract], ["approach", "retract", "approach", "retract"]),
    ):
        marks = np.repeat(np.arange(len(segments)), [z.size for z, _ in segments])
        z, force = (np.concatenate(columns) for columns in zip(*segments, strict=True))
        (curve,) = curves.read(tab(tmp_path / "curve.tab", force=force, segment=marks, **{"height (measured)": z}))
        assert [s.role for s in curve.segments] == roles
        assert [len(s) for s in curve.segments] == [z.size for z, _ in segments]


def test_an_approach_alone_is_one_segment(tmp_path: Path) -> None:
    n = KNOWN.approach_z.size
    path = tab(
        tmp_path / "in.tab", force=KNOWN.approach_force, segment=np.zeros(n), **{"height (measured)": KNOWN.approach_z}
    )
    (curve,) = curves.read(path)
    assert [s.role for s in curve.segments] == ["approach"]
    assert curve.retract is None


def test_calibration_is_corrected_consistently(tmp_path: Path) -> None:
    path = jpk(tmp_path / "curve.jpk-force")
    (plain,) = curves.read(path)
    (stiffer,) = curves.read(path, spring_constant=1.6)
    np.testing.assert_allclose(stiffer.retract.force, 2 * plain.retract.force, rtol=1e-12)
    np.testing.assert_allclose(stiffer.retract.deflection, plain.retract.deflection, rtol=1e-12)
    (finer,) = curves.read(path, sensitivity=3e-8)
    np.testing.assert_allclose(finer.retract.force, plain.retract.force / 2, rtol=1e-12)
    np.testing.assert_allclose(finer.retract.deflection, plain.retract.deflection / 2, rtol=1e-12)
    assert (stiffer.meta["spring constant"], finer.meta["sensitivity"]) == (1.6, 3e-8)
    for curve in (stiffer, finer):
        np.testing.assert_array_equal(curve.retract.z, plain.retract.z)  # the base does not move for it
    # the same for a format whose reader knows no corrections
    (asylum,) = curves.read(synthetic.write_ibw_curve(tmp_path / "curve.ibw", KNOWN), spring_constant=0.4)
    np.testing.assert_allclose(asylum.retract.force[-50:], KNOWN.retract_force[-50:] / 2, rtol=1e-12)


def asylum(path: Path, change: tuple[bytes, bytes] = (b"", b"")) -> Path:
    """An Asylum curve with other bytes of the same length; igor2 does not look at the checksum of the note."""
    content = synthetic.write_ibw_curve(path, KNOWN).read_bytes()
    assert change[0] in content
    path.write_bytes(content.replace(*change, 1))
    return path


def test_the_note_of_a_wave_is_read_as_it_is_written(tmp_path: Path) -> None:
    stiffness = f"SpringConstant: {KNOWN.spring_constant}\r".encode()
    (curve,) = curves.read(asylum(tmp_path / "a.ibw", (stiffness, stiffness.replace(b": ", b":") + b"\n")))
    assert curve.spring_constant == KNOWN.spring_constant
    (curve,) = curves.read(
        asylum(tmp_path / "b.ibw", (stiffness, b"SpringConstant: x" + b" " * (len(stiffness) - 18) + b"\r"))
    )
    assert "the spring constant 'x' is no number in N/m: give it for forces" in curve.meta["notes"]
    second = b"Version: 1\rDate: 2020-02-01\r"
    (curve,) = curves.read(
        asylum(tmp_path / "c.ibw", (second, b"SpringConstant: 0.123456".ljust(len(second) - 1) + b"\r"))
    )
    (told,) = (note for note in curve.meta["notes"] if "spring constant" in note)
    assert told == f"states its spring constant as {KNOWN.spring_constant} and as 0.123456: the first is taken"


def test_a_wave_of_no_lengths_or_with_an_empty_end(tmp_path: Path) -> None:
    z = np.concatenate([KNOWN.approach_z, KNOWN.retract_z])
    bent = np.concatenate([KNOWN.approach_force, KNOWN.retract_force]) / KNOWN.spring_constant
    labels, note = ["Raw", "Defl", "ZSnsr"], {"ImagingMode": "Contact", "SpringConstant": KNOWN.spring_constant}
    wave = np.stack([-z, bent, -z], axis=-1)
    wave[-7:] = 0.0
    (curve,) = curves.read(synthetic.write_ibw(tmp_path / "a.ibw", wave, labels, note=note))
    assert "7 samples of 0 in z and deflection at the end, never taken, left out" in curve.meta["notes"]
    assert len(curve.retract) == KNOWN.retract_z.size - 7
    (again,) = curves.read(synthetic.write_ibw(tmp_path / "b.ibw", 1e9 * wave, labels, note=note, unit="nm"))
    np.testing.assert_allclose(again.retract.z, curve.retract.z, rtol=1e-9)
    with pytest.raises(ReadError, match="its data are in 'V', expected a length in m"):
        curves.read(synthetic.write_ibw(tmp_path / "c.ibw", wave, labels, note=note, unit="V"))


def test_an_uncalibrated_file_asks_for_what_it_needs(tmp_path: Path) -> None:
    path = jpk(tmp_path / "raw.jpk-force", spring_constant=None, sensitivity=6e-8)
    with pytest.raises(ReadError, match="states no spring constant; give it"):
        curves.read(path)
    (curve,) = curves.read(path, spring_constant=0.05)
    np.testing.assert_allclose(curve.retract.force, KNOWN.retract_force, rtol=0, atol=1e-17)


@pytest.mark.parametrize(("name", "value"), [("spring_constant", 0.0), ("spring_constant", 1e5), ("sensitivity", 1.0)])
def test_corrections_out_of_range(tmp_path: Path, name: str, value: float) -> None:
    with pytest.raises(InvalidValue, match=rf"{name}: .* expected"):
        curves.read(jpk(tmp_path / "curve.jpk-force"), **{name: value})  # type: ignore[arg-type]


def test_a_file_replaced_under_the_same_name_is_read_anew(tmp_path: Path) -> None:
    path = tmp_path / "curve.jpk-force"
    (first,) = curves.read(jpk(path))
    doubled = ("extend", KNOWN.approach_z, 2 * KNOWN.approach_force)
    retract = ("retract", KNOWN.retract_z, KNOWN.retract_force)
    synthetic.write_jpk(path, [doubled, retract], spring_constant=KNOWN.spring_constant)
    (second,) = curves.read(path)
    np.testing.assert_allclose(second.approach.force, 2 * first.approach.force, rtol=0, atol=1e-16)


def _reversed_sign(path: Path) -> None:
    tab(path, **{"height (measured)": -np.concatenate([KNOWN.approach_z, KNOWN.retract_z])})


def _not_finite(path: Path) -> None:
    force = np.concatenate([KNOWN.approach_force, KNOWN.retract_force])
    force[17] = np.nan
    tab(path, force=force)


def _in_micrometres(path: Path) -> None:
    tab(path, **{"height (measured)": 1e6 * np.concatenate([KNOWN.approach_z, KNOWN.retract_z])})


def _absurd_force(path: Path) -> None:
    tab(path, force=np.ones(400))


def _no_force(path: Path) -> None:
    columns = {"height (measured)": KNOWN.approach_z, "time": KNOWN.approach_z}
    synthetic.write_tab(path, columns, {"imaging mode": "force-distance"})


def _prose(path: Path) -> None:
    path.write_text("Call me Ishmael.\n")


def _empty(path: Path) -> None:
    path.write_bytes(b"")


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (_reversed_sign, "sign of its height is reversed"),
        (_not_finite, "1 of 400 values of force are not finite"),
        (_in_micrometres, "the base travels"),
        (_absurd_force, "force of 1 N, expected up to"),
        (_no_force, "lacks a height or a force"),
        (_prose, "its content is not that of a .tab force curve file"),
        (_empty, "the file is empty"),
    ],
)
def test_what_cannot_be_trusted_is_refused_in_one_sentence(tmp_path: Path, spoil: object, message: str) -> None:
    path = tmp_path / "file.tab"
    spoil(path)  # type: ignore[operator]
    with pytest.raises(ReadError, match=message) as caught:
        curves.read(path)
    assert "\n" not in str(caught.value)


def test_other_refusals(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ReadError, match="no such file"):
        curves.read(tmp_path / "nothing.ibw")
    unknown = tmp_path / "curve.xyz"
    unknown.write_text("1 2 3\n")
    with pytest.raises(ReadError, match=r"not a force curve file that afmformats reads \(.csv, "):
        curves.read(unknown)
    image = synthetic.write_ibw_image(tmp_path / "image.ibw", {"HeightTrace": synthetic.asymmetric()}, 1e-7)
    with pytest.raises(ReadError, match="a stack of pictures, not a force curve"):
        curves.read(image)
    cut = tmp_path / "cut.jpk-force"
    cut.write_bytes(jpk(tmp_path / "whole.jpk-force").read_bytes()[:2000])
    with pytest.raises(ReadError):
        curves.read(cut)
    captured = capfd.readouterr()
    assert captured.err == ""  # afmformats logs tracebacks; none may reach the user


def test_a_bomb_is_refused_before_it_is_unpacked(tmp_path: Path) -> None:
    path = tmp_path / "bomb.jpk-force"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for number in range(5):
            with archive.open(f"segments/{number}", "w", force_zip64=True) as stream:
                stream.write(bytes(1 << 20))
    raw = path.read_bytes()  # the sizes the directory states are what counts: state 600 MiB for each
    stated = raw.replace((1 << 20).to_bytes(4, "little"), (600 << 20).to_bytes(4, "little"))
    path.write_bytes(stated)
    with pytest.raises(ReadError, match="unpacks to 3000 MiB"):
        curves.read(path)


@pytest.mark.parametrize("kind", ["tab", "jpk-force", "ibw"])
def test_damaged_files_give_a_read_error_or_a_plausible_curve(tmp_path: Path, kind: str) -> None:
    writers = {"tab": tab, "jpk-force": jpk, "ibw": lambda path: synthetic.write_ibw_curve(path, KNOWN)}
    whole = bytearray(writers[kind](tmp_path / f"whole.{kind}").read_bytes())  # type: ignore[operator]
    rng = np.random.default_rng(7)
    path, refused = tmp_path / f"damaged.{kind}", 0
    for _ in range(40):
        damaged = whole.copy()
        for place in rng.integers(0, min(len(whole), 1500), 4):
            damaged[place] = rng.integers(256)
        path.write_bytes(damaged)
        try:
            for curve in curves.read(path):
                for segment in curve.segments:
                    assert np.isfinite(segment.z).all()
                    assert np.isfinite(segment.force).all()
                    assert np.ptp(segment.z) <= 1e-3
        except ReadError:
            refused += 1
    assert refused > 0  # the damage was felt


def test_segments_check_themselves() -> None:
    z = np.linspace(1e-6, 0, 20)
    with pytest.raises(InvalidValue, match="role"):
        curves.Segment("dwell", z, z, "height (measured)", force=z)  # type: ignore[arg-type]
    with pytest.raises(InvalidValue, match="neither force nor deflection"):
        curves.Segment("approach", z, z, "height (measured)")
    with pytest.raises(InvalidValue, match=r"force: shape \(19,\)"):
        curves.Segment("approach", z, z, "height (measured)", force=z[1:])


REAL = [
    # file, number of curves, segments of the first, spring constant [N/m]: from the data's description
    ("fmt-igor-fd_SiN_FD_plot.ibw", 1, [("approach", 1009), ("retract", 1007)], 1.184),
    ("fmt-jpk-fd_qi-data-2021.04.13.jpk-qi-series", 1, [("approach", 1000), ("retract", 1000)], 35.0),
    (
        "fmt-jpk-cc_pr14-polymergel-2021.06.30.jpk-force",
        1,
        [("approach", 3000), ("pause", 3000), ("retract", 3000)],
        0.061,
    ),
    ("fmt-jpk-fd_spot3-0192.jpk-force", 1, [("approach", 2000), ("retract", 2000)], 0.0435),
    ("map-data-2022.10.29-12.27.34.564.jpk-force-map", 16, [("approach", 4000), ("retract", 4000)], 0.191),
]


@pytest.mark.parametrize(("name", "count", "segments", "stiffness"), REAL)
def test_real_curves(name: str, count: int, segments: list[tuple[str, int]], stiffness: float) -> None:
    path = synthetic.DATA / "curves" / name
    if not path.exists():
        pytest.skip(f"real data not here: {path}")
    found = curves.read(path)
    assert len(found) == count
    assert [(s.role, len(s)) for s in found[0].segments] == segments
    assert found[0].spring_constant == pytest.approx(stiffness, rel=2e-3)
