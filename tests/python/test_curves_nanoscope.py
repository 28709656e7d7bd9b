# SPDX-License-Identifier: BSD-3-Clause
"""Bruker NanoScope ramps and force volumes: scale, order, calibration, placeholders, damaged files."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import synthetic
from nanotouch import curves
from nanotouch.errors import ReadError

N, RAMP, SENSITIVITY = 256, 300e-9, 40e-9
LSB = 0.000375  # V
STEP = RAMP / (2 * N)  # of a ramp whose retraction has twice the samples of its approach, and covers it


def volts(depth: float, n: int = N, step: float = RAMP / N) -> synthetic.Array:
    """From the deepest point outwards: 40 nm in contact, held down to -depth [m], then free."""
    z = np.arange(n) * step
    deflection = 40e-9 - z
    return np.where(deflection > -depth, deflection, 0.0) / SENSITIVITY


def ramp(path: Path, **given: float) -> Path:
    return synthetic.write_nanoscope(
        path, [(volts(3e-9, N, STEP), volts(36e-9, 2 * N, STEP))], ramp=RAMP, sensitivity=SENSITIVITY, **given
    )


def test_a_ramp_is_read_in_si_and_in_the_order_of_time(tmp_path: Path) -> None:
    (curve,) = curves.read(ramp(tmp_path / "ramp.000", spring_constant=0.5))
    assert [(s.role, len(s)) for s in curve.segments] == [("approach", N), ("retract", 2 * N)]
    approach, retract = curve.segments
    # The deepest samples are at z = 0.
    np.testing.assert_allclose(approach.z, np.arange(N)[::-1] * STEP, atol=1e-15)
    np.testing.assert_allclose(retract.z, np.arange(2 * N) * STEP, atol=1e-15)
    half_step = 0.5 * LSB * SENSITIVITY  # rounding to int16
    for segment, expected in ((approach, volts(3e-9, N, STEP)[::-1]), (retract, volts(36e-9, 2 * N, STEP))):
        assert segment.deflection is not None
        assert segment.force is not None
        np.testing.assert_allclose(segment.deflection, expected * SENSITIVITY, atol=1.001 * half_step)
        np.testing.assert_allclose(segment.force, 0.5 * segment.deflection, rtol=1e-12)
    # The piezo takes a quarter of a second for the ramp on the way in, half a second on the way out.
    assert approach.time[1] - approach.time[0] == pytest.approx(0.25 / (2 * N))
    assert retract.time[0] == pytest.approx(0.125)
    assert retract.time[-1] == pytest.approx(0.625 - 0.5 / (2 * N))
    assert curve.meta["sensitivity"] == pytest.approx(SENSITIVITY)
    assert "placeholders" not in curve.meta


def test_the_name_does_not_matter_and_the_calibration_can_be_corrected(tmp_path: Path) -> None:
    path = ramp(tmp_path / "anything.tab")
    as_is, corrected = curves.read(path)[0], curves.read(path, spring_constant=0.2, sensitivity=30e-9)[0]
    assert as_is.retract is not None
    assert corrected.retract is not None
    np.testing.assert_allclose(corrected.retract.deflection, 0.75 * as_is.retract.deflection)  # type: ignore[operator]
    np.testing.assert_allclose(corrected.retract.force, 0.75 * 0.2 / 0.999 * as_is.retract.force)  # type: ignore[operator]
    np.testing.assert_array_equal(corrected.retract.z, as_is.retract.z)


def test_values_of_four_bytes(tmp_path: Path) -> None:
    """From version 9.2 on. Made by the test only: two public readers agree that the count is scaled as it is."""
    (coarse,) = curves.read(ramp(tmp_path / "old.spm", spring_constant=0.5))
    (fine,) = curves.read(ramp(tmp_path / "new.spm", spring_constant=0.5, version="0x09400202"))  # type: ignore[arg-type]
    for old, new in zip(coarse.segments, fine.segments, strict=True):
        assert old.deflection is not None
        assert new.deflection is not None
        np.testing.assert_allclose(new.deflection, old.deflection, atol=0.51 * LSB * SENSITIVITY)
        np.testing.assert_array_equal(new.z, old.z)
    expected = volts(36e-9, 2 * N, STEP) * SENSITIVITY
    np.testing.assert_allclose(fine.segments[1].deflection, expected, atol=LSB / 65536 * SENSITIVITY)  # type: ignore[arg-type]


def test_a_placeholder_is_flagged_until_the_value_is_given(tmp_path: Path) -> None:
    path = ramp(tmp_path / "ramp.000")
    as_is, corrected = curves.read(path)[0], curves.read(path, spring_constant=0.2)[0]
    assert as_is.meta["placeholders"] == ("spring constant",)
    (note,) = curves.analyse(as_is).notes
    assert "spring constant (0.999) is a placeholder" in note
    assert curves.analyse(corrected).notes == ()


def test_a_force_volume_is_a_list_of_curves_with_their_places(tmp_path: Path) -> None:
    depths = [(1 + i) * 1e-9 for i in range(6)]
    path = synthetic.write_nanoscope(
        tmp_path / "map.003", [(volts(0.0), volts(d)) for d in depths], sensitivity=SENSITIVITY
    )
    found = curves.read(path)
    assert [c.meta["enum"] for c in found] == list(range(6))
    assert [(c.meta["grid index x"], c.meta["grid index y"]) for c in found] == [(i % 2, i // 2) for i in range(6)]
    for curve, depth in zip(found, depths, strict=True):
        assert curve.retract is not None
        assert curve.retract.deflection is not None
        # The last point that is held lies within a step of the ramp above the depth.
        assert -depth <= curve.retract.deflection.min() <= -depth + RAMP / N + LSB * SENSITIVITY


@pytest.mark.parametrize(
    ("scan", "size"), [("2000 nm", 2e-6), ("1.5 1.5 ~m", 1.5e-6), ("2 1 ~m", None), ("0 nm", None)]
)
def test_a_force_volume_says_how_large_it_is(tmp_path: Path, scan: str, size: float | None) -> None:
    """Where the pixels are square: a scan that was stopped covers less than it says."""
    path = synthetic.write_nanoscope(tmp_path / "a.003", [(volts(0.2), volts(0.3))] * 4, scan=scan)
    assert curves.read(path)[3].meta.get("grid size x") == (None if size is None else pytest.approx(size))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (b"*File list end", b"*File list xxx", "its header does not end"),
        (b"*Ciao force image list", b"*Ciao xxxxx image list", "without force curves"),
        (b"*Ciao force list", b"*Ciao xxxxx list", "lacks the section 'Ciao force list'"),
        (b"[DeflectionError]", b"[Friction]xxxxxxx", "no deflection among its channels"),
        (b"Bytes/pixel: 2", b"Bytes/pixel: 8", "8 bytes per value"),
        (b"Samps/line: 512 256", b"Samps/line: 511 256", "no whole number of curves of 767 points"),
        (b"Samps/line: 512 256", b"Samps/line: -12 256", "expected whole numbers"),
        (b"Data offset: 4096", b"Data offset: 9096", "it is cut off"),
        (b"DeflSens: V 40.00000 nm/V", b"DeflSens: V 40.00000 lb/V", "'V 40.00000 lb/V', expected a number of nm/V"),
        (b"DeflSens: V 40.00000 nm/V", b"DeflSens: V 0.000000 nm/V", "sensitivity 0 m/V, expected"),
        (b"Zsens: V 12.18000 nm/V", b"Zsens: V 12180000 um/V", "the base travels"),
        (b"Spring Constant: 0.999", b"Spring Constant: -0.99", "expected a positive number"),
        (b"Spring Constant: 0.999", b"Spring Constant: 0.9 V", "expected a positive number"),
        (b"Forward vel.: 9", b"Forward vel.: x", "expected a positive number"),
        (b":Ramp size: V", b":Ramp siez: V", "lacks ':Ramp size'"),
        (b"DeflSens: V 40.00000 nm/V", b"DeflSens: V 1.000000     ", "no sensitivity 'DeflSens'"),
    ],
)
def test_a_damaged_file_is_refused_in_one_sentence(tmp_path: Path, old: bytes, new: bytes, message: str) -> None:
    path = ramp(tmp_path / "ramp.000")
    content = path.read_bytes()
    assert len(old) == len(new)
    assert old in content
    path.write_bytes(content.replace(old, new))
    with pytest.raises(ReadError, match=message) as caught:
        curves.read(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("sign", [0.0, -1.0])
def test_a_scale_that_turns_or_hides_the_force_is_refused(tmp_path: Path, sign: float) -> None:
    path = ramp(tmp_path / "ramp.000")
    (scale,) = re.findall(r"DeflSens\] \(([0-9.]+) V/LSB", path.read_bytes().decode("latin-1"))
    other = f"{sign * float(scale):.16f}"
    with pytest.raises(ReadError, match=r"'Z scale' of .* V/LSB .*expected above 0|lacks ':Z scale' with a scale"):
        curves.read(rewritten(path, (f"DeflSens] ({scale}", f"DeflSens] ({other}")))


def test_without_a_spring_constant_it_has_deflections_and_says_so(tmp_path: Path) -> None:
    path = ramp(tmp_path / "ramp.000", spring_constant=0.5)
    (whole,) = curves.read(path)
    path.write_bytes(path.read_bytes().replace(b"Spring Constant", b"Spring Konstant"))
    (curve,) = curves.read(path)
    assert curve.spring_constant is None
    assert "states no spring constant: deflections alone; give it for forces" in curve.meta["notes"]
    for one, other in zip(curve.segments, whole.segments, strict=True):
        assert one.force is None
        np.testing.assert_array_equal(one.deflection, other.deflection)
    (bent,) = curves.read(path, sensitivity=2.0 * whole.meta["sensitivity"])
    np.testing.assert_allclose(bent.segments[0].deflection, 2.0 * whole.segments[0].deflection)
    (given,) = curves.read(path, spring_constant=0.5)
    np.testing.assert_allclose(given.segments[0].force, whole.segments[0].force, rtol=1e-12)


def rewritten(path: Path, *changes: tuple[str, str]) -> Path:
    """With other lines in the header, which keeps its length."""
    content = path.read_bytes()
    before = 4096 - content.index(b"\x1a") - 1
    for old, new in changes:
        assert old.encode() in content
        content = content.replace(old.encode(), new.encode(), 1)
    header, data = content.split(b"\x1a", 1)
    path.write_bytes((header + b"\x1a").ljust(4096, b"\0") + data[before:])
    return path


@pytest.mark.parametrize(("stated", "value"), [("133.2 mN/m", 0.1332), ("133.2 pN/nm", 0.1332), ("0.1332 N/m", 0.1332)])
def test_a_unit_of_the_spring_constant_counts(tmp_path: Path, stated: str, value: float) -> None:
    path = rewritten(ramp(tmp_path / "a.000"), ("Spring Constant: 0.999", f"Spring Constant: {stated}"))
    assert curves.read(path)[0].meta["spring constant"] == pytest.approx(value, rel=1e-12)


def test_version_9_writes_other_capitals_and_leaves_the_unit_out(tmp_path: Path) -> None:
    old = curves.read(ramp(tmp_path / "old.000"))[0]
    path = ramp(tmp_path / "new.000")
    new = curves.read(
        rewritten(path, (":Ramp size:", ":Ramp Size:"), ("DeflSens: V 40.00000 nm/V", "DeflSens: V 40.00000 "))
    )[0]
    for one, other in zip(old.segments, new.segments, strict=True):
        np.testing.assert_allclose(other.z, one.z)
        np.testing.assert_allclose(other.force, one.force, rtol=1e-12)  # type: ignore[arg-type]
    (told,) = new.meta["notes"]
    assert "DeflSens 40 without a unit: taken as nm/V" in told
    assert told in curves.analyse(new).notes
    assert "notes" not in curves.read(path, sensitivity=40e-9)[0].meta


def test_nobody_calibrated_it_but_the_user(tmp_path: Path) -> None:
    """A bare 1 stands where no sensitivity was measured."""
    path = rewritten(ramp(tmp_path / "ramp.000"), ("DeflSens: V 40.00000 nm/V", "DeflSens: V 1.000000 "))
    with pytest.raises(ReadError, match="no sensitivity 'DeflSens': a bare 1 is a placeholder; give it"):
        curves.read(path)
    given = curves.read(path, sensitivity=SENSITIVITY)[0]
    np.testing.assert_allclose(given.segments[0].deflection, volts(3e-9, N, STEP)[::-1] * SENSITIVITY, atol=1e-11)  # type: ignore[arg-type]


@pytest.mark.parametrize("filler", [0, -32768])
def test_samples_that_were_never_taken_are_no_data(filler: int, tmp_path: Path) -> None:
    """A trigger cut the approach short; its far end and the retraction's hold fillers, the baseline lies at 0.8 V."""
    rng = np.random.default_rng(7)
    near, far = (volts(0.0) + 0.8 + 0.002 * rng.standard_normal(N) for _ in range(2))
    near[-40:], far[-3:] = filler * LSB, filler * LSB
    path = synthetic.write_nanoscope(
        tmp_path / "a.000", [(near, far)], ramp=RAMP, sensitivity=SENSITIVITY, spring_constant=0.1
    )
    (curve,) = curves.read(path)
    assert [len(s) for s in curve.segments] == [N - 40, N - 3]
    assert curve.meta["notes"] == ("43 samples that were never taken (0 or the lowest integer) left out",)
    for segment in curve.segments:
        assert segment.deflection is not None
        assert segment.deflection.min() > 0.7 * SENSITIVITY  # else a snap-in of 3 nN that nobody measured
    assert curve.segments[0].z[0] == pytest.approx((N - 41) * RAMP / N)
    assert curves.analyse(curve).snap_in_force == pytest.approx(0.0, abs=0.05e-9)


def test_a_curve_of_a_map_without_data_is_left_out(tmp_path: Path) -> None:
    branches = [(volts(0.0) + 0.5, volts(2e-9) + 0.5) for _ in range(4)]
    branches[2] = (np.zeros(N), np.zeros(N))
    path = synthetic.write_nanoscope(tmp_path / "map.003", branches, sensitivity=SENSITIVITY)
    found = curves.read(path)
    assert [curve.meta["enum"] for curve in found] == [0, 1, 3]
    assert "1 curve of 4 without data left out" in found[0].meta["notes"]


def test_a_capture_is_a_period_of_a_sine(tmp_path: Path) -> None:
    """PeakForce: 2 x 64 samples, 100 nm at 2 kHz, the deepest point at sample 81.6 of 128."""
    n, turn, amplitude = 128, 81.6, 100e-9
    z = -amplitude * np.cos(2 * np.pi * (np.arange(n) - turn) / n)
    deflection = np.maximum(-z - 70e-9, 0.0) + 5e-9  # touches the last 30 nm
    volt = deflection / SENSITIVITY
    branches = [(volt[: n // 2][::-1], volt[n // 2 :])] * 4
    path = synthetic.write_nanoscope(tmp_path / "a.pfc", branches, sensitivity=SENSITIVITY, spring_constant=0.4)
    rewritten(
        path,
        ("*Ciao scan list", "*Ciao scan list\r\n\\Operating mode: Image\r\n\\PeakForce Capture: Allow\r\n"
         "\\Peak Force Amplitude: 100\r\n\\PFT Freq: 2 KHz\r\n\\Sample Points: 128\r\n\\Sync Distance: 60\r\n"
         "\\Sync Distance QNM: 81.6\r\n\\Samps/line: 2\r\n\\Lines: 2"),
        ("Samps/line: 64 64", "Samps/line: 64 10"),  # some state a wrong number for the approach
        ("@4:Ramp size", "@4:Rump size"),
    )  # fmt: skip
    found = curves.read(path)
    assert len(found) == 4
    assert found[3].meta["grid index x"] == found[3].meta["grid index y"] == 1
    approach, retract = found[0].segments
    assert (approach.role, retract.role) == ("approach", "retract")
    assert len(approach) + len(retract) == n
    assert np.all(np.diff(approach.z) < 0)
    assert np.all(np.diff(retract.z) > 0)
    assert "notes" not in found[0].meta
    for segment in (approach, retract):
        expected = np.maximum(-segment.z - 70e-9, 0.0) + 5e-9
        np.testing.assert_allclose(segment.deflection, expected, atol=LSB * SENSITIVITY)  # type: ignore[arg-type]
    assert retract.time[-1] - approach.time[0] == pytest.approx((1 - 1 / n) / 2000)
    moved = curves.read(rewritten(path, ("Sync Distance QNM: 81.6", "Sync Distance QNM: 30.0")))
    assert "samples from the turn that 'Sync Distance QNM' states" in moved[0].meta["notes"][0]


def test_the_height_sensor_is_z_where_no_ramp_is_stated(tmp_path: Path) -> None:
    path = ramp(tmp_path / "a.000", spring_constant=0.5)
    expected = curves.read(path)[0]
    rising = (0.5 - np.concatenate([np.arange(N), np.arange(2 * N)]) * STEP / 900e-9) / LSB  # 900 nm/V, falls outwards
    sensor = np.round(rising).astype("<i2").tobytes()
    section = (
        f"*Ciao force image list\r\n\\Data offset: {4096 + len(sensor)}\r\n\\Data length: {len(sensor)}\r\n"
        f"\\Bytes/pixel: 2\r\n\\Samps/line: {2 * N} {N}\r\n"
        '\\@4:Image Data: S [ZSensor] "Height Sensor"\r\n'
        "\\@4:Z scale: V [Sens. ZsensSens] (0.000375 V/LSB) 2.5 V\r\n\\*File list end"
    )
    rewritten(path, ("@4:Ramp size", "@4:Rump size"), ("*File list end", section),
              ("@Sens. DeflSens", "@Sens. ZsensSens: V 900.0 nm/V\r\n\\@Sens. DeflSens"))  # fmt: skip
    path.write_bytes(path.read_bytes() + sensor)
    (curve,) = curves.read(path)
    for one, other in zip(expected.segments, curve.segments, strict=True):
        assert other.z_channel == "height (measured)"
        np.testing.assert_allclose(other.z, one.z, atol=1.1 * LSB * 900e-9)  # of two roundings
        np.testing.assert_array_equal(other.force, one.force)  # type: ignore[arg-type]


def test_truncated_files_are_refused(tmp_path: Path) -> None:
    path = ramp(tmp_path / "ramp.000")
    content = path.read_bytes()
    for size in (20, 200, 4096, len(content) - 1):
        path.write_bytes(content[:size])
        with pytest.raises(ReadError):
            curves.read(path)


@pytest.mark.parametrize(
    ("name", "points", "count"), [("Test.000", 512, 1), ("Test.001", 3072, 1), ("Test.003", 512, 256)]
)
def test_mica_in_air(name: str, points: int, count: int) -> None:
    path = synthetic.DATA / "curves" / "fsas" / name
    if not path.exists():
        pytest.skip(f"real data not here: {path}")
    found = curves.read(path, sensitivity=30.5e-9)
    assert len(found) == count
    assert [(s.role, len(s)) for s in found[0].segments] == [("approach", points), ("retract", points)]
    assert found[0].meta["placeholders"] == ("spring constant",)
    report = curves.analyse(found[0])
    # With the sensitivity from the contact slope, mica does not deform: slope and spring constant agree.
    assert report.contact_slope == pytest.approx(0.999, rel=0.05)
    if count == 1:
        assert report.pull_off_force / 0.999 == pytest.approx(36e-9, rel=0.03)


def test_a_real_ramp_of_version_9() -> None:
    path = synthetic.DATA / "corpus" / "curves" / "20200904_Egel4-Z1.0_00025.spm"
    if not path.exists():
        pytest.skip(f"real data not here: {path}")
    (curve,) = curves.read(path)
    assert [(s.role, len(s)) for s in curve.segments] == [("approach", 1024), ("retract", 1024)]
    assert curve.meta["sensitivity"] == pytest.approx(27.39e-9)  # as pyfmreader takes it
    assert np.ptp(curve.segments[1].z) == pytest.approx(227.2211 * 13.203e-9, rel=2e-3)
    assert curve.segments[0].force is not None
    assert np.ptp(curve.segments[0].force) == pytest.approx((4264 - 856) * 0.000375 * 27.39e-9 * 0.1332, rel=1e-9)
