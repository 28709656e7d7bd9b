# SPDX-License-Identifier: BSD-3-Clause
"""Bruker NanoScope ramps and force volumes: scale, order, calibration, placeholders, damaged files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import synthetic
from nanotouch import curves
from nanotouch.errors import ReadError

N, RAMP, SENSITIVITY = 256, 300e-9, 40e-9
LSB = 0.000375  # V


def volts(depth: float, n: int = N) -> synthetic.Array:
    """From the deepest point outwards: 40 nm in contact, held down to -depth [m], then free."""
    z = np.arange(n) * RAMP / n
    deflection = 40e-9 - z
    return np.where(deflection > -depth, deflection, 0.0) / SENSITIVITY


def ramp(path: Path, **given: float) -> Path:
    return synthetic.write_nanoscope(
        path, [(volts(3e-9), volts(36e-9, 2 * N))], ramp=RAMP, sensitivity=SENSITIVITY, **given
    )


def test_a_ramp_is_read_in_si_and_in_the_order_of_time(tmp_path: Path) -> None:
    (curve,) = curves.read(ramp(tmp_path / "ramp.000", spring_constant=0.5))
    assert [(s.role, len(s)) for s in curve.segments] == [("approach", N), ("retract", 2 * N)]
    approach, retract = curve.segments
    # Samples stand 1/n of the ramp apart; the deepest are at z = 0.
    np.testing.assert_allclose(approach.z, np.arange(N)[::-1] * RAMP / N, atol=1e-15)
    np.testing.assert_allclose(retract.z, np.arange(2 * N) * RAMP / (2 * N), atol=1e-15)
    half_step = 0.5 * LSB * SENSITIVITY  # rounding to int16
    for segment, expected in ((approach, volts(3e-9)[::-1]), (retract, volts(36e-9, 2 * N))):
        assert segment.deflection is not None
        assert segment.force is not None
        np.testing.assert_allclose(segment.deflection, expected * SENSITIVITY, atol=1.001 * half_step)
        np.testing.assert_allclose(segment.force, 0.5 * segment.deflection, rtol=1e-12)
    # The piezo takes a quarter of a second for the ramp on the way in, half a second on the way out.
    assert approach.time[1] - approach.time[0] == pytest.approx(0.25 / N)
    assert retract.time[0] == pytest.approx(0.25)
    assert retract.time[-1] == pytest.approx(0.75 - 0.5 / (2 * N))
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
    expected = volts(36e-9, 2 * N) * SENSITIVITY
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
    ("old", "new", "message"),
    [
        (b"*File list end", b"*File list xxx", "its header does not end"),
        (b"*Ciao force image list", b"*Ciao xxxxx image list", "without force curves"),
        (b"*Ciao force list", b"*Ciao xxxxx list", "lacks the section 'Ciao force list'"),
        (b"[DeflectionError]", b"[Friction]xxxxxxx", "no deflection among its channels"),
        (b"Bytes/pixel: 2", b"Bytes/pixel: 8", "8 bytes per value"),
        (b"Samps/line: 256 512", b"Samps/line: 256 511", "no whole number of curves of 767 points"),
        (b"Samps/line: 256 512", b"Samps/line: -56 512", "expected whole numbers"),
        (b"Data offset: 4096", b"Data offset: 9096", "it is cut off"),
        (b"DeflSens: V 40.00000 nm/V", b"DeflSens: V 40.00000 lb/V", "no sensitivity 'DeflSens'"),
        (b"DeflSens: V 40.00000 nm/V", b"DeflSens: V 0.000000 nm/V", "sensitivity 0 m/V, expected"),
        (b"Zsens: V 12.18000 nm/V", b"Zsens: V 12180000 um/V", "the base travels"),
        (b"Spring Constant: 0.999", b"Spring Constant: -0.99", "expected a positive number"),
        (b"Spring Constant: 0.999", b"Spring Konstant: 0.999", "lacks 'Spring Constant'"),
        (b"Forward vel.: 9", b"Forward vel.: x", "expected a positive number"),
        (b":Ramp size: V", b":Ramp siez: V", "lacks ':Ramp size'"),
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
    # With the sensitivity from the contact slope, mica yields nothing: slope and spring constant agree.
    assert report.contact_slope == pytest.approx(0.999, rel=0.05)
    if count == 1:
        assert report.pull_off_force / 0.999 == pytest.approx(36e-9, rel=0.03)
